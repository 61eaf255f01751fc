// Render: the steps, the loop over them, and their progress reports.

#include "etendue/render/render.h"

#include <fmt/format.h>

#include "describe/guard.h"
#include "etendue/render/tells_choice.h"
#include "render_members.h"
#include "surface_step.h"

namespace etendue {
namespace {

thread_local const Render::Members* within = nullptr;

}  // namespace

// ---- locking ---------------------------------------------------------------------------------------------------------------

BetweenSteps::BetweenSteps(const Render::Members& m, bool interrupt) {
  if (within == &m)
    throw Error("a render can neither be changed nor replayed from within its own step: do it from another thread");
  {
    const std::lock_guard lock(m.turn);
    ++m.waiting;
  }
  if (interrupt) m.give_up = true;
  lock_ = std::unique_lock(m.description);
  const std::lock_guard lock(m.turn);
  if (--m.waiting == 0) m.give_up = m.abort.load();
  m.turned.notify_all();
}

WithinStep::WithinStep(const Render::Members& m) : before_(std::exchange(within, &m)) {}
WithinStep::~WithinStep() { within = before_; }
bool WithinStep::of(const Render::Members& m) { return within == &m; }

// ---- construction ----------------------------------------------------------------------------------------------------------

Render::Render(Ref<Job> job, RenderSettings settings)
    : members_(std::make_unique<Members>(std::move(job), std::move(settings))) {
  if (!members_->job) throw Error("there is no job to render");
  prepare_tree(*members_->job);
  members_->film = std::make_unique<Film>(*members_->job->image, members_->job->renderer->estimator());
  members_->surfaces = std::make_unique<SurfaceFilm>(*members_->job->image);
  members_->step_size = members_->samples_per_step();
}
Render::~Render() = default;

const Job& Render::job() const { return *members_->job; }
const RenderSettings& Render::settings() const { return members_->settings; }
Film& Render::film() { return *members_->film; }
const Film& Render::film() const { return *members_->film; }

std::uint32_t Render::Members::samples_per_step() const {
  const std::uint32_t usual = etendue::samples_per_step(job->image->area());
  return std::max(job->renderer->samples_per_step(usual), 1u);
}

std::uint32_t Render::samples_per_step() const {
  const std::shared_lock sharing(members_->description);
  return members_->samples_per_step();
}

IndexRange Render::Members::wanted() const {
  const auto samples = std::uint32_t(job->renderer->samples);
  const std::optional<IndexRange>& some = settings.steps;
  if (!some) return {0, samples};
  const std::uint64_t step = samples_per_step(), count = (samples + step - 1) / step;
  if (some->begin >= some->end)
    throw Error(fmt::format("passes {}:{} are none: the second number is the first pass left out", some->begin, some->end));
  if (some->end > count)
    throw Error(fmt::format("there are no passes {}:{}: {} samples per pixel are {} pass{} of {} each", some->begin, some->end,
                            samples, count, count == 1 ? "" : "es", step));
  return {std::uint32_t(some->begin * step), std::uint32_t(std::min<std::uint64_t>(some->end * step, samples))};
}

std::unique_ptr<RenderProcess> Render::Members::fresh_process() const {
  return rendering(*job, [&] { return job->renderer->start(context()); });
}

/// Saves the state of the process and destroys it, because what it refers to is about to change.
void Render::Members::park_process() {
  if (process) process_state = process->save_state();
  process.reset();
}

void Render::Members::note_choice() {
  const auto* tells = dynamic_cast<const TellsChoice*>(process.get());
  choice = tells ? tells->told() : std::string();
}

void Render::Members::empty() {
  before_short_step.reset();
  process.reset();
  process_state.clear();
  const std::lock_guard lock(counts);
  film->clear();
  surfaces->clear();
  done.clear();
  some_done = false;
  loaded_from.clear();
  choice.clear();
  seconds = error = 0;
}

void Render::restart(std::optional<std::uint64_t> seed) {
  const BetweenSteps alone(*members_, true);
  if (seed) {
    members_->job->seed = *seed;
    members_->assembled = false;
  }
  members_->empty();
}

void Render::select_steps(std::optional<IndexRange> steps) {
  const BetweenSteps alone(*members_, true);
  members_->settings.steps = steps;
}

// ---- one step --------------------------------------------------------------------------------------------------------------

/// Renders the samples of a step: their light, and what they see, if the picture has such layers.
void Render::Members::render_step(Schedule& schedule, const Step& at) {
  process->prepare_step(schedule, at);
  process->step(schedule, at);
  if (!surfaces->wanted()) return;
  if (!names) names = std::make_unique<const ObjectNames>(*job->scene);
  surfaces->take(surfaces_of_step(schedule, context(), *job->renderer, at, *names, job->groups));
}

std::optional<Ended> Render::Members::step(Schedule& schedule) {
  while (true) {
    {
      std::unique_lock lock(turn);
      turned.wait(lock, [&] { return waiting == 0; });
      // A request to give up from an earlier run, or from a thread that was waited for, is cleared: it would abort every later
      // step. Requests after this line are seen by the check of `abort` below or within the step.
      give_up = false;
    }
    const std::shared_lock sharing(description);
    if (abort.load()) return Ended::aborted;
    if (!broken.empty()) throw Error(broken);
    assemble();
    const IndexRange part = wanted();
    if (!process) {
      process = fresh_process();
      if (!process_state.empty()) process->load_state(process_state);
    }
    const std::uint32_t size = samples_per_step();
    if (before_short_step && !done.empty() && part.end > done.back().end) {
      std::unique_ptr<RenderProcess> again = fresh_process();
      again->load_state(before_short_step->renderer);
      const std::lock_guard lock(counts);
      film->load_state(before_short_step->image);
      surfaces->load_state(before_short_step->surfaces);
      process = std::move(again);
      drop_short_pass(done, size);
      before_short_step.reset();
    }
    const std::vector<IndexRange> rest = missing(done, part);
    if (rest.empty()) return Ended::samples;
    const IndexRange samples{rest.front().begin, std::min(rest.front().end, (rest.front().begin / size + 1) * size)};
    if (job->renderer->steps_depend() && !missing(done, {0, samples.begin}).empty())
      job->renderer->fail({}, "learns from one pass to the next, so passes cannot be rendered without those before them");
    process_state = process->save_state();
    const bool is_short = samples.end % size != 0 && samples.end == part.end;
    std::optional<Checkpoint::State> before;
    if (is_short) before = Checkpoint::State{film->save_state(), process_state, surfaces->save_state()};
    {
      const std::lock_guard lock(counts);
      at_hand = samples;
      part_at_hand = 0;
      step_began = std::chrono::steady_clock::now();
    }
    // A step that is not finished leaves nothing behind, whatever ends it.
    struct AtHand {
      Members& m;
      bool finished = false;
      ~AtHand() {
        const std::lock_guard lock(m.counts);
        m.at_hand = {};
        if (finished) return;
        if (m.settings.team) m.settings.team->drop_step();
        m.film->drop_step();
        m.surfaces->drop_step();
        m.process.reset();  // the process may be anywhere within the step
      }
    } guard{*this};
    const WithinStep no_edits(*this);
    rendering(*job, [&] {
      const Step at{samples.begin / size, samples};
      if (settings.team) settings.team->begin_step(at, process_state);
      render_step(schedule, at);
    });
    if (give_up.load()) {
      if (abort.load()) return Ended::aborted;
      if (stop.load() && settings.team && !done.empty()) return Ended::interrupted;
      continue;
    }
    if (settings.team) settings.team->end_step(process->save_state());
    const std::lock_guard lock(counts);
    film->end_step();
    surfaces->end_step();
    insert(done, samples);
    some_done = true;
    loaded_from.clear();
    seconds += seconds_since(step_began);
    note_choice();
    before_short_step = std::move(before);
    guard.finished = true;
    break;
  }
  return {};
}

namespace {

/// Clears the requests to stop at the end of a run, so that they do not affect the next one.
struct Forgotten {
  Render::Members& m;
  ~Forgotten() { m.stop = m.abort = m.give_up = false; }
};

}  // namespace

std::optional<Ended> Render::step() {
  const Forgotten forgotten{*members_};
  if (members_->stop.load()) return Ended::interrupted;
  const std::unique_ptr<Schedule> schedule = members_->make_schedule();
  return members_->step(*schedule);
}

// ---- all steps -------------------------------------------------------------------------------------------------------------

std::optional<Ended> Render::Members::reason_to_stop() {
  const std::shared_lock sharing(description);
  const double now = job->error_limit > 0 ? film->relative_error() : 0;
  const std::lock_guard lock(counts);
  error = now;
  if (missing(done, wanted()).empty()) return Ended::samples;
  if (stop.load()) return Ended::interrupted;
  if (job->time_limit > 0 && seconds >= job->time_limit) return Ended::time;
  if (job->error_limit > 0 && error <= job->error_limit) return Ended::error;
  return {};
}

Ended Render::run() {
  const Forgotten forgotten{*members_};
  if (Team* const team = members_->settings.team; team && !team->leads()) return members_->follow_leader();
  const bool keeps = !members_->settings.checkpoint_file.empty();
  {
    const std::shared_lock sharing(members_->description);
    members_->wanted();
    if (keeps) {
      members_->identity.reset();  // hashes the files as they are now
      members_->identity_now();
      remove_leftovers(members_->settings.checkpoint_file);
    }
  }
  using Clock = std::chrono::steady_clock;
  Clock::time_point shown = Clock::now(), kept = shown;
  const auto report = [&](bool finished) {
    if (!members_->settings.on_progress || (!finished && seconds_since(shown) < members_->settings.progress_interval)) return;
    shown = Clock::now();
    Progress p = progress();
    p.finished = finished;
    members_->settings.on_progress(p);
  };
  const std::unique_ptr<Schedule> schedule = members_->make_schedule([&](std::uint64_t item, std::uint64_t count) {
    const WithinStep no_edits(*members_);
    {
      const std::lock_guard lock(members_->counts);
      members_->part_at_hand = double(item) / double(count);
    }
    report(false);
  });
  std::optional<Ended> ended;
  bool written = false;
  if (!samples_done().empty()) {
    ended = members_->reason_to_stop();
    written = keeps && members_->loaded_from == members_->settings.checkpoint_file;
  }
  while (!ended) {
    try {
      ended = members_->step(*schedule);
    } catch (const LostProcess&) {  // what there is would be lost with it
      if (keeps && !written) members_->keep();
      throw;
    }
    if (ended == Ended::aborted) {
      if (keeps && !written && members_->some_done) members_->keep();
      return *ended;
    }
    if (ended) break;
    written = false;
    ended = members_->reason_to_stop();
    if (keeps && !ended && seconds_since(kept) >= members_->settings.checkpoint_interval) {
      members_->keep();
      kept = Clock::now();
      written = true;
    }
  }
  if (keeps && !written) members_->keep();
  report(true);
  return *ended;
}

// A team drops its step, as mpirun gives one second between the signal to end and the kill: but not the first one, without
// which there would be nothing, and not where a page stops it.
void Render::stop() {
  members_->stop.store(true);
  const Team* const team = members_->settings.team;
  if (team && !team->follows_edits() && members_->some_done.load()) members_->give_up.store(true);
}
void Render::abort() {
  members_->abort.store(true);
  members_->give_up.store(true);
}

}  // namespace etendue
