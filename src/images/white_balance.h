#pragma once
// Chromatic adaptation: colours seen in the light of one white, as they look in that of another.

#include <array>
#include <string>
#include <vector>

#include "etendue/core/image.h"
#include "etendue/core/spectrum.h"

namespace etendue {

/// "von_kries", "bradford", "cat16".
std::vector<std::string> adaptation_names();

/// The matrix, row major, from X Y Z under a white to X Y Z under another (complete adaptation): the white itself becomes the
/// other. Throws Error for an unknown method, and for a white that excites no cone.
std::array<double, 9> adaptation_matrix(const std::string& method, const Xyz& from, const Xyz& to);

/// An image in X Y Z under another white; further channels and metadata are kept.
Image white_balanced(const Image& xyz, const std::string& method, const Xyz& from, const Xyz& to);

}  // namespace etendue
