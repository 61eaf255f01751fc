// What a Render displays: its progress, its picture, single samples.

#include "etendue/render/render.h"

#include "denoising.h"
#include "render_members.h"

namespace etendue {

// ---- progress and pictures -------------------------------------------------------------------------------------------------

Progress Render::Members::progress_now() const {
  const bool stepping = at_hand.begin < at_hand.end;
  const double pixels = double(job->image->area().width()) * job->image->area().height();
  Progress p;
  p.samples = count(done);
  std::vector<IndexRange> all = done;
  insert(all, settings.steps ? wanted() : IndexRange{0, std::uint32_t(job->renderer->samples)});
  p.samples_wanted = count(all);
  p.seconds = seconds + (stepping ? seconds_since(step_began) : 0);
  p.error = error;
  const double samples = p.samples + (stepping ? part_at_hand * (at_hand.end - at_hand.begin) : 0);
  p.samples_per_second = samples * pixels / std::max(p.seconds, 1e-9);
  p.fraction = samples / p.samples_wanted;
  if (job->time_limit > 0) p.fraction = std::max(p.fraction, p.seconds / job->time_limit);
  // The error falls with the square root of the number of samples.
  if (job->error_limit > 0 && error > 0 && std::isfinite(error))
    p.fraction = std::max(p.fraction, (job->error_limit / error) * (job->error_limit / error));
  p.fraction = std::min(p.fraction, 1.0);
  p.seconds_left = p.fraction > 0 ? p.seconds * (1 - p.fraction) / p.fraction : -1;
  return p;
}

namespace {

/// Locks the description shared, unless this thread is within a step, which already holds the lock.
std::shared_lock<std::shared_mutex> share(const Render::Members& m) {
  return WithinStep::of(m) ? std::shared_lock<std::shared_mutex>() : std::shared_lock(m.description);
}

}  // namespace

Progress Render::progress() const {
  const std::shared_lock sharing = share(*members_);
  const std::lock_guard lock(members_->counts);
  return members_->progress_now();
}

RenderSnapshot Render::snapshot() const {
  const std::shared_lock sharing = share(*members_);
  const std::lock_guard lock(members_->counts);
  std::map<std::string, std::string> metadata = picture_metadata(*members_->job, count(members_->done));
  if (!members_->choice.empty()) metadata["choice"] = members_->choice;
  return {members_->film->snapshot(), members_->progress_now(), std::move(metadata), members_->surfaces->snapshot()};
}

std::vector<IndexRange> Render::samples_done() const {
  const std::lock_guard lock(members_->counts);
  return members_->done;
}

Image Render::display(const Image& picture) const {
  const std::shared_lock sharing(members_->look);
  return members_->job->tone_map ? members_->job->tone_map->apply(picture) : picture;
}

std::vector<std::string> Render::write_outputs(const std::string& default_stem) const {
  const Image picture = this->picture();
  const std::shared_lock sharing(members_->look);
  std::vector<std::string> written;
  for (const Ref<Output>& output : members_->job->outputs)
    written.push_back(write_output(*members_->job, *output, picture, default_stem));
  std::vector<Error> errors;
  for (std::string& path :
       write_denoised(*members_->job, members_->job->outputs, picture, default_stem, members_->settings.threads, errors))
    written.push_back(std::move(path));
  if (!errors.empty()) throw Errors(std::move(errors));
  return written;
}

// ---- single samples ---------------------------------------------------------------------------------------------------------

/// Starting a process builds the light sampler, which other processes use: none of them may be running.
std::unique_ptr<RenderProcess> Render::Members::process_at(std::uint32_t sample) const {
  const std::uint32_t step = samples_per_step(), begin = sample / step * step;
  Film unseen(*job->image);  // collects the light of the earlier steps, which is not used
  const std::atomic<bool> never{false};
  ParallelSchedule schedule(unseen, settings.threads, never);
  return rendering(*job, [&] {
    std::unique_ptr<RenderProcess> at = job->renderer->start(context());
    for (std::uint32_t first = job->renderer->steps_depend() ? 0 : begin;; first += step) {
      const Step one{first / step, {first, first + step}};
      at->prepare_step(schedule, one);
      if (first == begin) return at;
      at->step(schedule, one);
    }
  });
}

std::unique_ptr<RenderProcess> Render::start_at(std::uint32_t sample) const {
  const BetweenSteps alone(*members_, false);
  return members_->process_at(sample);
}

Point2 Render::replay(int x, int y, std::uint32_t sample, PathRecord& record) const {
  const BetweenSteps alone(*members_, false);
  if (!members_->job->image->sampled_area().contains(x, y))
    throw Error("there is no pixel " + std::to_string(x) + "," + std::to_string(y) + " in the picture");
  const std::unique_ptr<RenderProcess> process = members_->process_at(sample);
  Arena arena;
  PathSink sink;
  sink.record = &record;
  const Point2 film = rendering(*members_->job, [&] { return process->sample(x, y, sample, arena, sink); }).film;
  record.to_world_space(members_->job->rendering_origin());
  return film;
}

}  // namespace etendue
