#pragma once
// The text that `etendue compare` prints.

#include <string>

#include "analysis.h"

namespace etendue::comparing {

std::string results_text(const Results&);

}  // namespace etendue::comparing
