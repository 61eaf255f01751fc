#pragma once

#include <string>
#include <vector>

#include "etendue/core/spectral_function.h"

namespace etendue {

/// table_spectrum() of color.h, with this expression; throws Error for an invalid table.
Color make_table_spectrum(std::vector<float> wavelengths, std::vector<float> values, std::string expression);
/// `spectrum([400, 500], [0.1, 0.2])`
std::string table_expression(const std::vector<float>& wavelengths, const std::vector<float>& values);

}  // namespace etendue
