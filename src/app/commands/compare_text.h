#pragma once
// The text that `etendue compare` prints.

#include <string>

#include "check/compare/analysis.h"

namespace etendue {

std::string compare_text(const comparing::Results&);

}  // namespace etendue
