#pragma once
// Restrictions of processes that read files with libraries that have, or may have, security faults.

#include <cstdint>

namespace etendue::apart {

/// Limits memory [bytes] and CPU time [s], closes all files except the standard ones, and forbids network access and the
/// execution of other programs.
void limit_process(std::uint64_t memory, std::uint64_t seconds);

}  // namespace etendue::apart
