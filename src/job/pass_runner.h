#pragma once
// Runs the items of a pass over all threads and merges their tiles in order.

#include <atomic>
#include <functional>

#include "etendue/renderer.h"

namespace etendue {

class PassRunner final : public Pass {
 public:
  /// `stop` at 2 ends a pass early; `tick(done, count)` is called from one thread at a time.
  PassRunner(ImageBuffer& image, int threads, const std::atomic<int>& stop,
             std::function<void(std::uint64_t, std::uint64_t)> tick);
  ~PassRunner() override;

  using Pass::run;
  void run(std::uint64_t count, Work work, void* self) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace etendue
