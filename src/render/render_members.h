#pragma once
// The members of a Render, and the locks that protect them.
//
// `description`: a step or a query holds it shared; an edit, a load, an addition or a replay holds it exclusively. `look`
// protects the display part of the description (tone map, outputs), so that displaying does not wait for a step. `counts`
// protects the counters (`done`, `seconds`, …), which change together with the film's ends of steps. The order of locking is:
// editing, description, look, counts, the film's mutex.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <shared_mutex>

#include "checkpoint.h"
#include "consequences.h"
#include "etendue/render/render.h"
#include "film/surface_film.h"
#include "parallel_schedule.h"
#include "team.h"
#include "transport/object_names.h"

namespace etendue {

struct Render::Members {
  Members(Ref<Job> j, RenderSettings s) : job(std::move(j)), settings(std::move(s)) {}

  const Ref<Job> job;
  RenderSettings settings;  // only `steps` changes, by select_steps
  std::unique_ptr<Film> film;
  std::unique_ptr<SurfaceFilm> surfaces;  ///< beside the film

  mutable std::shared_mutex description;
  mutable std::shared_mutex look;
  mutable std::mutex counts;

  // Protected by `description`, for the thread that steps.
  std::unique_ptr<RenderProcess> process;
  /// The state of `process` when the last step began, or when the process was destroyed: a fresh process continues from it.
  std::vector<std::byte> process_state;
  /// The state before the last step, if that step was shorter than the others: more samples continue from it (Checkpoint).
  std::optional<Checkpoint::State> before_short_step;
  mutable std::optional<Identity> identity;  ///< of the job; computed on demand, since it reads files
  std::uint32_t step_size = 1;               ///< samples per step, until the next edit
  std::unique_ptr<const ObjectNames> names;  ///< of the scene, for layers of surfaces; made on demand
  std::string loaded_from;                   ///< the checkpoint file whose state the render still has; empty: none
  bool assembled = false;                    ///< the processes of the team have met for this render, as it is now
  bool announced = false;                    ///< the team was told of it, as it is now or was before an edit
  std::string broken;                        ///< why nothing can be rendered: an edit could be neither made nor undone

  std::mutex editing;                ///< serializes edits
  std::unique_ptr<Holders> holders;  ///< of the job's components, for edits; computed on demand

  // Protected by `counts`.
  std::vector<IndexRange> done;
  std::atomic<bool> some_done{false};  ///< whether there is a whole step; for signal handlers
  double seconds = 0;                  ///< spent on whole steps
  IndexRange at_hand;
  std::chrono::steady_clock::time_point step_began;
  double part_at_hand = 0;  ///< finished fraction of the current step
  double error = 0;
  std::string checkpoint_failure;
  std::string choice;  ///< TellsChoice::told of the process at the end of the last step

  // Threads that wait for a moment between two steps get their turn before the next step begins.
  mutable std::mutex turn;
  mutable std::condition_variable turned;
  mutable int waiting = 0;
  mutable std::atomic<bool> give_up{false};  ///< aborts the current step
  std::atomic<bool> stop{false}, abort{false};

  RenderContext context() const { return {*job->scene, *job->camera, *job->image, *job->wavelengths, job->seed}; }
  IndexRange wanted() const;
  std::uint32_t samples_per_step() const;
  std::unique_ptr<RenderProcess> fresh_process() const;
  std::unique_ptr<RenderProcess> process_at(std::uint32_t sample) const;
  void park_process();
  void note_choice();  ///< requires that `counts` is held
  void follow(const Consequences&);
  void empty();
  std::optional<Ended> step(Schedule&);
  void render_step(Schedule&, const Step&);
  std::unique_ptr<Schedule> make_schedule(std::function<void(std::uint64_t, std::uint64_t)> tick = {});
  void assemble();
  Ended follow_leader();
  std::optional<Ended> reason_to_stop();
  Progress progress_now() const;  ///< requires that `counts` is held
  const Identity& identity_now() const;
  Checkpoint checkpoint() const;
  Checkpoint state_now() const;  ///< at the end of the last step; requires that `description` is held and no step is running
  void require_continuable(const Checkpoint&, const std::string& whose) const;
  void take_over(Checkpoint&&);
  void keep();
};

inline double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Runs work in which any component of the job may throw; components of plugins may throw exceptions of any type.
template <class Work>
auto rendering(const Job& job, Work work) {
  try {
    return work();
  } catch (const LostProcess&) {
    throw;
  } catch (...) {
    blame(job, "rendering");
  }
}

/// Holds the description exclusively while it exists, so that no step is running. With `interrupt`, a running step is aborted.
class BetweenSteps {
 public:
  BetweenSteps(const Render::Members&, bool interrupt);

 private:
  std::unique_lock<std::shared_mutex> lock_;
};

/// Marks the thread as being within a step while it exists. A BetweenSteps on this thread would wait for itself; it throws
/// Error.
class WithinStep {
 public:
  explicit WithinStep(const Render::Members&);
  ~WithinStep();
  WithinStep(const WithinStep&) = delete;
  WithinStep& operator=(const WithinStep&) = delete;
  /// Whether this thread is within a step of this render.
  static bool of(const Render::Members&);

 private:
  const Render::Members* before_;
};

}  // namespace etendue
