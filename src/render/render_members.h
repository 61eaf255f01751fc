#pragma once
// What a Render holds, and who may touch it when.
//
// A step and a look share the description, which an edit, a load, an addition or a replay has alone (`description`). What shows
// pictures (tone map, outputs) is apart from it (`look`), so that showing waits for no step. What is counted (`done`,
// `seconds`, …) changes under `counts`, together with the film's ends of steps. Locks are taken in this order: editing,
// description, look, counts, the film's.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <shared_mutex>

#include "checkpoint.h"
#include "consequences.h"
#include "etendue/render/render.h"
#include "parallel_schedule.h"

namespace etendue {

struct Render::Members {
  Members(Ref<Job> j, RenderSettings s) : job(std::move(j)), settings(std::move(s)) {}

  const Ref<Job> job;
  const RenderSettings settings;
  std::unique_ptr<Film> film;

  mutable std::shared_mutex description;
  mutable std::shared_mutex look;
  mutable std::mutex counts;

  // Under `description`, by who steps.
  std::unique_ptr<RenderProcess> process;
  /// Its state when the last step began, or when it was put away: where there is no process, one goes on from here.
  std::vector<std::byte> process_state;
  /// The state before the last step, when that was shorter than others: more samples go on from there (Checkpoint).
  std::optional<Checkpoint::State> before_short_step;
  mutable std::optional<Identity> identity;  ///< of the job; files are read for it, so it is found when it is needed
  std::uint32_t step_size = 1;               ///< samples per step, before the next edit
  std::string loaded_from;                   ///< the file whose state it still has; empty: none
  std::string broken;                        ///< why nothing can be rendered: an edit could be neither made nor undone

  std::mutex editing;                ///< edits come one after the other
  std::unique_ptr<Holders> holders;  ///< of the job's parts, for edits; found when it is needed

  // Under `counts`.
  std::vector<IndexRange> done;
  double seconds = 0;  ///< spent on whole steps
  IndexRange at_hand;
  std::chrono::steady_clock::time_point step_began;
  double part_at_hand = 0;  ///< of the step at hand
  double error = 0;
  std::string checkpoint_failure;

  // Who wants to come between two steps is let in before the next one begins.
  mutable std::mutex turn;
  mutable std::condition_variable turned;
  mutable int waiting = 0;
  mutable std::atomic<bool> give_up{false};  ///< the step at hand
  std::atomic<bool> stop{false}, abort{false};

  RenderContext context() const { return {*job->scene, *job->camera, *job->image, *job->wavelengths, job->seed}; }
  IndexRange wanted() const;
  std::uint32_t samples_per_step() const;
  std::unique_ptr<RenderProcess> fresh_process() const;
  std::unique_ptr<RenderProcess> process_at(std::uint32_t sample) const;
  void park_process();
  void follow(const Consequences&);
  void empty();
  std::optional<Ended> step(ParallelSchedule&);
  std::optional<Ended> reason_to_stop();
  Progress progress_now() const;  ///< `counts` is held
  const Identity& identity_now() const;
  Checkpoint checkpoint() const;
  Checkpoint state_now() const;  ///< at the end of the last step; `description` is held, and no step at hand
  void require_continuable(const Checkpoint&, const std::string& whose) const;
  void take_over(Checkpoint&&);
  void keep();
};

inline double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Does something in which any part of the job may throw: those of plugins whatever they like.
template <class Work>
auto rendering(const Job& job, Work work) {
  try {
    return work();
  } catch (...) {
    blame(job, "rendering");
  }
}

/// Has the description alone while it lives: no step is at hand. With `interrupt`, one that is is given up.
class BetweenSteps {
 public:
  BetweenSteps(const Render::Members&, bool interrupt);

 private:
  std::unique_lock<std::shared_mutex> lock_;
};

/// While it lives, whoever wants to come between two steps from this thread would wait for itself, and is refused.
class WithinStep {
 public:
  explicit WithinStep(const Render::Members&);
  ~WithinStep();
  WithinStep(const WithinStep&) = delete;
  WithinStep& operator=(const WithinStep&) = delete;
  /// Whether this thread is in one.
  static bool of(const Render::Members&);

 private:
  const Render::Members* before_;
};

}  // namespace etendue
