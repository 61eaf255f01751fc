#pragma once
// ParallelSchedule: a Schedule that uses the cores of this machine.

#include <atomic>
#include <functional>
#include <memory>

#include "etendue/film/film.h"
#include "etendue/render/schedule.h"

namespace etendue {

/// The samples per pixel of a step for a picture of this size: few for large pictures, many for small ones. Depends on the size
/// alone, so that steps are the same however a render is interrupted or continued. It is a power of two, so that the steps of a
/// crop consist of whole steps of the full picture.
std::uint32_t samples_per_step(const PixelArea&);

class ParallelSchedule final : public Schedule {
 public:
  /// `threads`: 0 for all cores. If `abort` becomes true, remaining items are skipped and the results will be dropped.
  /// `tick(done, count)` is called from one thread at a time, after each item of the film.
  ParallelSchedule(Film& film, int threads, const std::atomic<bool>& abort,
                   std::function<void(std::uint64_t, std::uint64_t)> tick = {});
  ~ParallelSchedule() override;

  /// How many threads it uses.
  int threads() const;
  /// Calls a function on as many of its threads as are free, at most once on each, with that thread's arena; it must do all
  /// there is to do even if it is called only once.
  void on_threads(const std::function<void(Arena&)>&);
  void run(const Items&, Work&) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace etendue
