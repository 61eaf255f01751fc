#pragma once
// Numbers and times as a person reads them.

#include <cstdint>
#include <string>

namespace etendue {

/// 1234567 as "1,234,567".
std::string grouped(std::uint64_t);
/// "4.2 s", "3 m 07 s", "2 h 05 m".
std::string duration_text(double seconds);

}  // namespace etendue
