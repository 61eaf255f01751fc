#pragma once
// A schedule over the cores of this machine.

#include <atomic>
#include <functional>
#include <memory>

#include "etendue/film/film.h"
#include "etendue/render/schedule.h"

namespace etendue {

/// How many samples per pixel a step of a picture of this size takes: few of large pictures, many of small ones. A function of
/// the size alone, so that steps are the same however a render is stopped or continued; and a power of two, so that those of
/// a crop are made of those of the whole picture.
std::uint32_t samples_per_step(const PixelArea&);

class ParallelSchedule final : public Schedule {
 public:
  /// `threads`: 0 for all cores. `abort` lets what is done be thrown away; `tick(done, count)` is called from one thread at a
  /// time, for items of the film.
  ParallelSchedule(Film& film, int threads, const std::atomic<bool>& abort,
                   std::function<void(std::uint64_t, std::uint64_t)> tick = {});
  ~ParallelSchedule() override;

 private:
  void film_items(std::uint64_t count, FilmWork work, void* self) override;
  void items(std::uint64_t count, Results&) override;

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace etendue
