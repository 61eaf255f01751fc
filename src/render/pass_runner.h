#pragma once
// Runs the items of a pass over all threads and merges their tiles in order.

#include <atomic>
#include <functional>

#include "etendue/film/film.h"
#include "etendue/render/renderer.h"

namespace etendue {

/// How many samples per pixel a pass of a picture of this size takes: few of large pictures, many of small ones. A function of
/// the size alone, so that passes are the same however a render is stopped or continued; and a power of two, so that those of
/// a crop are made of those of the whole picture.
std::uint32_t samples_per_pass(const PixelArea&);

class PassRunner final : public Pass {
 public:
  /// `abort` ends a pass early; `tick(done, count)` is called from one thread at a time.
  PassRunner(Film& film, int threads, const std::atomic<bool>& abort, std::function<void(std::uint64_t, std::uint64_t)> tick);
  ~PassRunner() override;

  using Pass::run;
  void run(std::uint64_t count, Work work, void* self) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace etendue
