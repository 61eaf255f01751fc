#pragma once
// What processes may do that read files by libraries whose faults are known, or may be there.

#include <cstdint>

namespace etendue::apart {

/// Limits memory [bytes] and the processor's time, closes all but the standard files, and forbids the network and other
/// programs.
void limit_process(std::uint64_t memory, std::uint64_t seconds);

}  // namespace etendue::apart
