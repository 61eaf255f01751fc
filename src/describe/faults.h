#pragma once
// Faults in the descriptions of classes, which are found when a class is registered, not when it is used.

#include <string>

#include "etendue/describe/registry.h"

namespace etendue {

/// The first fault in the description of a class; empty: there is none.
std::string fault(const ClassInfo&);

}  // namespace etendue
