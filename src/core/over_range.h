#pragma once
// A loop over many small things on several threads.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace etendue {

/// Does f(begin, end) for parts of [0, count), on several threads where there are many. Nothing else is begun by them
/// meanwhile: who calls may hold a lock.
template <class F>
void over_range(std::size_t count, F f, std::size_t grain = std::size_t(1) << 14) {
  if (count <= 2 * grain) return f(std::size_t(0), count);
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const auto& range) { f(range.begin(), range.end()); });
  });
}

}  // namespace etendue
