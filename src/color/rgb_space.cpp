// RGB spaces: primaries, white point, and the matrices and illuminant that follow from them.

#include <cmath>
#include <memory>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "named.h"
#include "rgb_table.h"
#include "tables.h"

namespace etendue {

namespace {

using Matrix = std::array<double, 9>;

Matrix inverse(const Matrix& m, const std::string& space) {
  Matrix r;
  const auto minor = [&](int a, int b, int c, int d) { return m[size_t(a)] * m[size_t(d)] - m[size_t(b)] * m[size_t(c)]; };
  r = {minor(4, 5, 7, 8),  -minor(1, 2, 7, 8), minor(1, 2, 4, 5),   //
       -minor(3, 5, 6, 8), minor(0, 2, 6, 8),  -minor(0, 2, 3, 5),  //
       minor(3, 4, 6, 7),  -minor(0, 1, 6, 7), minor(0, 1, 3, 4)};
  const double determinant = m[0] * r[0] + m[1] * r[3] + m[2] * r[6];
  if (!(std::abs(determinant) > 1e-9)) throw Error("the primaries of RGB space '" + space + "' lie on a line");
  for (double& x : r) x /= determinant;
  return r;
}

/// An illuminant with Y = 1 and this white point. If the chromaticity of a tabulated illuminant is within 3e-4, it is returned;
/// otherwise the nearest of them times exp(a t + b t^2), t = (lambda - 595 nm) / 235 nm: this is smooth and positive, and for
/// any real white point there are a and b that match x and y (Newton's method).
Color white_spectrum(const std::array<double, 2>& white, const std::string& space) {
  Color nearest;
  double nearest_distance = 1e9;
  for (const char* name : {"D65", "D50", "E", "A"}) {
    Color light = illuminant_spectrum(name);
    const Xyz c = to_xyz(*light, ColorUse::radiance);
    const double sum = c.x + c.y + c.z;
    const double distance = std::hypot(c.x / sum - white[0], c.y / sum - white[1]);
    if (distance < nearest_distance) {
      nearest_distance = distance;
      nearest = light;
    }
  }
  if (nearest_distance < 3e-4) return nearest;

  double a = 0, b = 0, y_scale = 1;
  const auto power = [&](int i, double a_, double b_) {
    const double t = (i - 235) / 235.0;
    return double(nearest->at(wavelength_low + float(i), ColorUse::radiance)) * std::exp((a_ + b_ * t) * t);
  };
  const auto error = [&](double a_, double b_) {
    Xyz c;
    for (int i = 0; i < tables::size; ++i) {
      const auto& o = tables::observer[i];
      c += power(i, a_, b_) * Xyz{o[0], o[1], o[2]};
    }
    y_scale = observer_y_integral() / c.y;
    return std::array{c.x / (c.x + c.y + c.z) - white[0], c.y / (c.x + c.y + c.z) - white[1]};
  };
  auto e = error(a, b);
  for (int i = 0; i < 100 && std::hypot(e[0], e[1]) > 1e-12; ++i) {
    constexpr double h = 1e-6;
    const auto ea = error(a + h, b), eb = error(a, b + h);
    const double j00 = (ea[0] - e[0]) / h, j01 = (eb[0] - e[0]) / h, j10 = (ea[1] - e[1]) / h, j11 = (eb[1] - e[1]) / h;
    const double determinant = j00 * j11 - j01 * j10;
    const double da = -(e[0] * j11 - e[1] * j01) / determinant, db = -(j00 * e[1] - j10 * e[0]) / determinant;
    if (!std::isfinite(da) || !std::isfinite(db)) break;
    double length = 1;
    auto next = e;
    do {
      next = error(a + length * da, b + length * db);
      length *= 0.5;
    } while (!(std::hypot(next[0], next[1]) < std::hypot(e[0], e[1])) && length > 1e-6);
    if (!(std::hypot(next[0], next[1]) < std::hypot(e[0], e[1]))) break;
    a += 2 * length * da;
    b += 2 * length * db;
    e = next;
  }
  e = error(a, b);
  if (!(std::hypot(e[0], e[1]) < 1e-6)) throw Error("no light has the white of RGB space '" + space + "'");
  std::vector<float> wavelengths, values;
  for (int i = 0; i < tables::size; ++i) {
    wavelengths.push_back(wavelength_low + float(i));
    values.push_back(float(y_scale * power(i, a, b)));
  }
  return table_spectrum(std::move(wavelengths), std::move(values));
}

struct Known {
  const char* name;
  std::array<std::array<double, 2>, 3> primaries;
  std::array<double, 2> white;
};
constexpr std::array<double, 2> d65{0.3127, 0.3290}, aces_white{0.32168, 0.33767};
constexpr Known known_spaces[] = {
    {"srgb", {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}}, d65},                      // IEC 61966-2-1
    {"display_p3", {{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}}}, d65},          // SMPTE EG 432-1, white D65
    {"rec2020", {{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}}, d65},             // ITU-R BT.2020
    {"adobe_rgb", {{{0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}}}, d65},                 // Adobe RGB (1998)
    {"aces2065-1", {{{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}}}, aces_white},  // SMPTE ST 2065-1
    {"acescg", {{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}}}, aces_white},       // Academy S-2014-004
    {"xyz", {{{1, 0}, {0, 1}, {0, 0}}}, {1.0 / 3, 1.0 / 3}},
};

}  // namespace

RgbSpace make_rgb_space(const std::string& name, const std::array<std::array<double, 2>, 3>& primaries,
                        const std::array<double, 2>& white) {
  // Columns are the primaries' chromaticities (x, y, 1 - x - y), each times the amount that makes (1, 1, 1) the white.
  if (!(white[1] > 0 && white[0] >= 0 && white[0] + white[1] <= 1))
    throw Error("the white of RGB space '" + name + "' is no colour");
  RgbSpace space;
  space.name = name;
  space.primaries = primaries;
  space.white = white;
  Matrix p;
  for (size_t i = 0; i < 3; ++i) {
    p[i] = primaries[i][0];
    p[3 + i] = primaries[i][1];
    p[6 + i] = 1 - primaries[i][0] - primaries[i][1];
  }
  const Matrix q = inverse(p, name);
  const double w[3] = {white[0] / white[1], 1, (1 - white[0] - white[1]) / white[1]};
  for (size_t i = 0; i < 3; ++i) {
    const double amount = q[3 * i] * w[0] + q[3 * i + 1] * w[1] + q[3 * i + 2] * w[2];
    for (size_t row = 0; row < 3; ++row) space.to_xyz[3 * row + i] = p[3 * row + i] * amount;
  }
  space.from_xyz = inverse(space.to_xyz, name);
  space.illuminant = white_spectrum(white, name);
  space.table = std::make_shared<RgbTable>();
  return space;
}

const RgbSpace& rgb_space(const std::string& name) {
  static const std::vector<RgbSpace> spaces = [] {
    std::vector<RgbSpace> all;
    for (const Known& k : known_spaces) all.push_back(make_rgb_space(k.name, k.primaries, k.white));
    return all;
  }();
  for (const RgbSpace& space : spaces)
    if (is_named(name, space.name, space.name == "srgb" ? "rec709" : "")) return space;
  fail_unknown("RGB space", name, rgb_space_names());
}

std::vector<std::string> rgb_space_names() {
  std::vector<std::string> names;
  for (const Known& k : known_spaces) names.emplace_back(k.name);
  names.insert(names.begin() + 1, "rec709");
  return names;
}

}  // namespace etendue
