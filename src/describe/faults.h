#pragma once
// What may be wrong with a description: found when a class is registered, not when it is used.

#include <string>

#include "etendue/describe/registry.h"

namespace etendue {

/// What is wrong with a class as it was described; empty when nothing is.
std::string fault(const ClassInfo&);

}  // namespace etendue
