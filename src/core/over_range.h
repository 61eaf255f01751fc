#pragma once
// A parallel loop over many small items.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace etendue {

/// Calls f(begin, end) for parts of [0, count), on several threads if count is large. The threads take up no other work
/// meanwhile, so the caller may hold a lock.
template <class F>
void over_range(std::size_t count, F f, std::size_t grain = std::size_t(1) << 14) {
  if (count <= 2 * grain) return f(std::size_t(0), count);
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const auto& range) { f(range.begin(), range.end()); });
  });
}

}  // namespace etendue
