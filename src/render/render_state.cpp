// The state of a Render: saving, loading, adding.

#include <fmt/format.h>

#include <istream>
#include <ostream>

#include "render_members.h"

namespace etendue {

const Identity& Render::Members::identity_now() const {
  if (!identity) identity = identity_of(*job);
  return *identity;
}

Checkpoint Render::Members::checkpoint() const {
  const std::shared_lock sharing(look);
  return empty_checkpoint(*job, identity_now(), samples_per_step());
}

Checkpoint Render::Members::state_now() const {
  Checkpoint c = checkpoint();
  const std::lock_guard lock(counts);
  c.done = done;
  c.seconds = seconds;
  c.state = {film->save_state(), process ? process->save_state() : process_state, surfaces->save_state()};
  c.before_short_pass = before_short_step;
  return c;
}

// ---- saving -----------------------------------------------------------------------------------------------------------------

void Render::Members::keep() {
  std::string failure;
  try {
    const std::shared_lock sharing(description);
    write_checkpoint(state_now(), settings.checkpoint_file);
  } catch (const Error& e) {  // a full disk must not end a render that may still write its picture
    failure = e.what();
    warn(failure);
  }
  const std::lock_guard lock(counts);
  checkpoint_failure = std::move(failure);
}

std::string Render::checkpoint_failure() const {
  const std::lock_guard lock(members_->counts);
  return members_->checkpoint_failure;
}

void Render::save(std::ostream& to) const {
  const BetweenSteps alone(*members_, false);
  write_checkpoint(members_->state_now(), to);
}

void Render::save(const std::string& file) const {
  const BetweenSteps alone(*members_, false);
  write_checkpoint(members_->state_now(), file);
}

// ---- loading ----------------------------------------------------------------------------------------------------------------

void Render::Members::require_continuable(const Checkpoint& from, const std::string& whose) const {
  const Checkpoint own = checkpoint();
  std::string reason = mismatch(from, "the checkpoint", own, "this job");
  if (reason.empty() && !from.done.empty() && from.done.back().end > own.samples_wanted)
    reason = fmt::format("it holds {} of each pixel, but only {} are wanted", samples_text(from.done), own.samples_wanted);
  if (!reason.empty()) throw Error(fmt::format("cannot continue from {}: {}", whose, reason));
}

void Render::Members::take_over(Checkpoint&& from) {
  std::unique_ptr<RenderProcess> next = fresh_process();
  next->load_state(from.state.renderer);
  auto seen = std::make_unique<SurfaceFilm>(*job->image);
  seen->load_state(from.state.surfaces);
  film->load_state(from.state.image);
  surfaces = std::move(seen);
  process = std::move(next);
  process_state = std::move(from.state.renderer);
  before_short_step = std::move(from.before_short_pass);
  const std::lock_guard lock(counts);
  done = std::move(from.done);
  some_done = !done.empty();
  seconds = from.seconds;
  error = 0;
  note_choice();
  loaded_from.clear();
}

void Render::load(std::istream& stream) {
  Checkpoint from = read_checkpoint(stream);
  const BetweenSteps alone(*members_, true);
  members_->require_continuable(from, "this state");
  members_->take_over(std::move(from));
}

void Render::load(const std::string& file) {
  Checkpoint from = read_checkpoint(file);
  const BetweenSteps alone(*members_, true);
  members_->identity.reset();  // hashes the files as they are now
  members_->require_continuable(from, "'" + file + "'");
  members_->take_over(std::move(from));
  members_->loaded_from = file;
}

void Render::add(std::istream& stream) {
  const Checkpoint from = read_checkpoint(stream);
  const BetweenSteps alone(*members_, false);
  std::string reason = mismatch(from, "the state", members_->checkpoint(), "this job");
  if (reason.empty() && (members_->job->renderer->steps_depend() || !from.state.renderer.empty()))
    reason = members_->job->renderer->class_info().name + " learns from one pass to the next, so its passes belong together";
  std::vector<IndexRange> all;
  {
    const std::lock_guard lock(members_->counts);
    all = members_->done;
  }
  for (const IndexRange& range : from.done) {
    if (const std::vector<IndexRange> fresh = missing(all, range); reason.empty() && fresh != std::vector{range})
      reason = fmt::format("both hold some of {}", samples_text({range}));
    insert(all, range);
  }
  if (!reason.empty()) throw Error("cannot add this state: " + reason);
  const std::lock_guard lock(members_->counts);
  SurfaceFilm(*members_->job->image).load_state(from.state.surfaces);  // throws Error before anything changes
  members_->film->add_state(from.state.image);
  members_->surfaces->add_state(from.state.surfaces);
  members_->done = std::move(all);
  members_->some_done = !members_->done.empty();
  members_->seconds += from.seconds;
  members_->loaded_from.clear();
  members_->before_short_step.reset();
}

}  // namespace etendue
