// Von Kries' rule: the responses of three kinds of cones, linear in X, Y, Z, are scaled so that those of one white become those
// of the other. The methods differ in the cones, A = M^-1 diag(M w' / M w) M:
//   von_kries: Hunt, Pointer and Estevez's cones, scaled to D65 (Fairchild 2013, Color Appearance Models, eq. 9.14);
//   bradford: Lam 1985, in its linear form, as in ICC profiles (ISO 15076-1, annex E);
//   cat16: Li et al. 2017, Comprehensive color solutions: CAM16, CAT16, and CAM16-UCS.

#include "white_balance.h"

#include <algorithm>

#include "etendue/core/error.h"

namespace etendue {
namespace {

using Matrix = std::array<double, 9>;

struct Method {
  const char* name;
  Matrix cones;
};

constexpr std::array<Method, 3> methods = {{
    {"von_kries", {0.40024, 0.7076, -0.08081, -0.2263, 1.16532, 0.0457, 0, 0, 0.91822}},
    {"bradford", {0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296}},
    {"cat16", {0.401288, 0.650173, -0.051461, -0.250268, 1.204414, 0.045854, -0.002079, 0.048952, 0.953127}},
}};

std::array<double, 3> times(const Matrix& m, const std::array<double, 3>& v) {
  std::array<double, 3> r{};
  for (size_t i = 0; i < 3; ++i) r[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
  return r;
}

/// By cofactors.
Matrix inverse(const Matrix& m) {
  Matrix r{};
  const auto cofactor = [&](size_t i, size_t j) {
    const size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    return m[3 * a + c] * m[3 * b + d] - m[3 * a + d] * m[3 * b + c];
  };
  const double determinant = m[0] * cofactor(0, 0) + m[1] * cofactor(0, 1) + m[2] * cofactor(0, 2);
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) r[3 * j + i] = cofactor(i, j) / determinant;
  return r;
}

}  // namespace

std::vector<std::string> adaptation_names() {
  std::vector<std::string> names;
  for (const Method& method : methods) names.emplace_back(method.name);
  return names;
}

Matrix adaptation_matrix(const std::string& name, const Xyz& from, const Xyz& to) {
  const auto* method = std::ranges::find(methods, name, &Method::name);
  if (method == methods.end())
    throw Error("there is no chromatic adaptation '" + name + "'" + suggestion(name, adaptation_names()));
  const std::array<double, 3> before = times(method->cones, {from.x, from.y, from.z}),
                              after = times(method->cones, {to.x, to.y, to.z});
  const Matrix back = inverse(method->cones);
  Matrix result{};
  for (size_t k = 0; k < 3; ++k) {
    if (!(before[k] > 0) || !(after[k] > 0)) throw Error("the white is so saturated that nothing can be adapted to it");
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j) result[3 * i + j] += back[3 * i + k] * (after[k] / before[k]) * method->cones[3 * k + j];
  }
  return result;
}

Image white_balanced(const Image& xyz, const std::string& method, const Xyz& from, const Xyz& to) {
  const Matrix matrix = adaptation_matrix(method, from, to);
  std::array<size_t, 3> at{};
  for (size_t c = 0; c < 3; ++c) {
    at[c] = size_t(std::ranges::find(xyz.channels, std::string(1, "XYZ"[c])) - xyz.channels.begin());
    if (at[c] == xyz.channels.size()) throw Error("the picture has no X, Y and Z");
  }
  Image result = xyz;
  for (size_t i = 0; i < xyz.values.size(); i += xyz.channels.size()) {
    const std::array<double, 3> seen = times(matrix, {xyz.values[i + at[0]], xyz.values[i + at[1]], xyz.values[i + at[2]]});
    for (size_t c = 0; c < 3; ++c) result.values[i + at[c]] = seen[c];
  }
  result.metadata["white_balance"] = method;
  return result;
}

}  // namespace etendue
