// RGB spaces from chromaticities, black bodies and spectral lines.

#include "color_system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "etendue/describe/color.h"

namespace etendue::osl {

namespace {

using Row3 = std::array<double, 3>;
using Matrix3 = std::array<Row3, 3>;

Matrix3 inverse(const Matrix3& a) {
  Matrix3 r;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      r[j][i] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
    }
  const double determinant = a[0][0] * r[0][0] + a[0][1] * r[1][0] + a[0][2] * r[2][0];
  for (Row3& row : r)
    for (double& x : row) x /= determinant;
  return r;
}

Triple clamped_to_zero(const Triple& c) { return {std::max(c.x, 0.0f), std::max(c.y, 0.0f), std::max(c.z, 0.0f)}; }

/// The matching functions of the CIE 1931 observer in the usual short table, of four decimals, at 380, 385, ... 780 nm: that of
/// Walker's program "Colour Rendering of Spectra" (fourmilab.ch/documents/specrend), whose numbers the reference implementation
/// has.
constexpr int table_size = 81;
const std::array<Triple, table_size>& matching_functions() {
  static const auto table = [] {
    std::array<Triple, table_size> rows;
    const auto rounded = [](double x) { return float(std::floor(x * 1e4 + 0.5) * 1e-4); };
    for (int i = 0; i < table_size; ++i) {
      const Xyz c = observer(380 + 5 * float(i));
      rows[std::size_t(i)] = {rounded(c.x), rounded(c.y), rounded(c.z)};
    }
    return rows;
  }();
  return table;
}

/// Planck's law, 2 pi h c^2 / lambda^5 / (exp(h c / (lambda k T)) - 1), summed over the table [W/m^2]. The constants are those
/// of the reference implementation: 2 pi h c^2 = 3.74183e-16 W m^2 and h c / k = 1.4388e-2 m K.
Triple blackbody_xyz(double kelvin) {
  Triple sum;
  for (int i = 0; i < table_size; ++i) {
    const double metres = (380 + 5 * i) * 1e-9;
    const double exitance = 3.74183e-16 * std::pow(metres, -5) / std::expm1(1.4388e-2 / (metres * kelvin));
    sum += float(exitance) * 5e-9f * matching_functions()[std::size_t(i)];
  }
  return sum;
}

// Black bodies up to 12,000 K are interpolated in a table of fifth roots at the temperatures 800 K + 2 K i^(3/2), which has an
// error below 0.1 % (the scheme of the reference implementation, so that values agree).
constexpr float coldest = 800, hottest_of_table = 12000, spacing = 2;

}  // namespace

ColorSystem::ColorSystem(Chromaticity red, Chromaticity green, Chromaticity blue, Chromaticity white) {
  const Chromaticity of[3] = {red, green, blue};
  Matrix3 primaries;  // a column for each
  for (std::size_t j = 0; j < 3; ++j) {
    const double x = double(of[j].x), y = double(of[j].y);
    primaries[0][j] = x, primaries[1][j] = y, primaries[2][j] = 1 - x - y;
  }
  const double x = double(white.x), y = double(white.y);
  const Row3 target{x / y, 1, (1 - x - y) / y};
  const Matrix3 solve = inverse(primaries);
  Matrix3 to;
  for (std::size_t j = 0; j < 3; ++j) {
    const double scale = solve[j][0] * target[0] + solve[j][1] * target[1] + solve[j][2] * target[2];
    for (std::size_t i = 0; i < 3; ++i) to[i][j] = scale * primaries[i][j];
  }
  const Matrix3 from = inverse(to);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      to_xyz_[j][i] = float(to[std::size_t(i)][std::size_t(j)]);
      from_xyz_[i][j] = float(from[std::size_t(i)][std::size_t(j)]);
    }
  for (int i = 0;; ++i) {
    const float root = std::sqrt(float(i)), kelvin = root * root * root * spacing + coldest;
    const Triple c = clamped_to_zero(from_xyz(blackbody_xyz(double(kelvin))));
    blackbodies_.push_back({std::pow(c.x, 0.2f), std::pow(c.y, 0.2f), std::pow(c.z, 0.2f)});
    if (kelvin > hottest_of_table) break;
  }
}

const ColorSystem& ColorSystem::rec709() { return *named("Rec709"); }

const ColorSystem* ColorSystem::named(std::string_view name) {
  static constexpr Chromaticity c{0.3101f, 0.3162f}, d65{0.3127f, 0.3291f}, e{0.33333333f, 0.33333333f},
      d60{0.32168f, 0.33767f};
  struct Known {
    std::string_view name;
    Chromaticity red, green, blue, white;
  };
  static constexpr Known known[] = {
      {"Rec709", {0.64f, 0.33f}, {0.30f, 0.60f}, {0.15f, 0.06f}, d65},
      {"sRGB", {0.64f, 0.33f}, {0.30f, 0.60f}, {0.15f, 0.06f}, d65},
      {"NTSC", {0.67f, 0.33f}, {0.21f, 0.71f}, {0.14f, 0.08f}, c},
      {"EBU", {0.64f, 0.33f}, {0.29f, 0.60f}, {0.15f, 0.06f}, d65},
      {"PAL", {0.64f, 0.33f}, {0.29f, 0.60f}, {0.15f, 0.06f}, d65},
      {"SECAM", {0.64f, 0.33f}, {0.29f, 0.60f}, {0.15f, 0.06f}, d65},
      {"SMPTE", {0.630f, 0.340f}, {0.310f, 0.595f}, {0.155f, 0.070f}, d65},
      {"HDTV", {0.670f, 0.330f}, {0.210f, 0.710f}, {0.150f, 0.060f}, d65},
      {"CIE", {0.7355f, 0.2645f}, {0.2658f, 0.7243f}, {0.1669f, 0.0085f}, e},
      {"AdobeRGB", {0.64f, 0.33f}, {0.21f, 0.71f}, {0.15f, 0.06f}, d65},
      {"XYZ", {1.0f, 0.0f}, {0.0f, 1.0f}, {0.0f, 0.0f}, e},
      {"ACES2065-1", {0.7347f, 0.2653f}, {0.0f, 1.0f}, {0.0001f, -0.077f}, d60},
      {"ACEScg", {0.713f, 0.293f}, {0.165f, 0.83f}, {0.128f, 0.044f}, d60},
  };
  static const auto systems = [] {
    std::vector<ColorSystem> all;
    for (const Known& k : known) all.emplace_back(k.red, k.green, k.blue, k.white);
    return all;
  }();
  for (std::size_t i = 0; i < std::size(known); ++i)
    if (known[i].name == name) return &systems[i];
  return nullptr;
}

Triple ColorSystem::to_xyz(const Triple& rgb) const { return rgb.x * to_xyz_[0] + rgb.y * to_xyz_[1] + rgb.z * to_xyz_[2]; }

Triple ColorSystem::from_xyz(const Triple& xyz) const {
  return {dot(from_xyz_[0], xyz), dot(from_xyz_[1], xyz), dot(from_xyz_[2], xyz)};
}

float ColorSystem::luminance(const Triple& rgb) const {
  return rgb.x * to_xyz_[0].y + rgb.y * to_xyz_[1].y + rgb.z * to_xyz_[2].y;
}

Triple ColorSystem::blackbody(float kelvin) const {
  if (!(kelvin >= coldest)) return {1e-6f, 0, 0};
  if (kelvin >= hottest_of_table) return clamped_to_zero(from_xyz(blackbody_xyz(double(kelvin))));
  const float root = std::cbrt((kelvin - coldest) / spacing), at = root * root;
  const std::size_t i = std::min(std::size_t(at), blackbodies_.size() - 2);
  const float t = at - float(i);
  const Triple c = (1 - t) * blackbodies_[i] + t * blackbodies_[i + 1];
  const Triple square = c * c;
  return square * square * c;
}

Triple ColorSystem::wavelength(float nanometres) const {
  const float at = (nanometres - 380) / 5;
  if (!(at >= 0 && at < float(table_size - 1))) return {};
  const std::size_t i = std::size_t(at);
  const Triple &a = matching_functions()[i], &b = matching_functions()[i + 1];
  // The scale, of the reference implementation, keeps all components below one.
  return clamped_to_zero(from_xyz(a + (at - float(i)) * (b - a)) * float(1 / 2.52));
}

}  // namespace etendue::osl
