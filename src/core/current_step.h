#pragma once
// What code far below a step, such as a shader's program, may ask of it.

#include <atomic>

namespace etendue {

/// The request to give up the step of which this thread computes an item; null: it computes none. What runs long should look at
/// it: the results of the item are then dropped.
const std::atomic<bool>* abort_of_current_step();

}  // namespace etendue
