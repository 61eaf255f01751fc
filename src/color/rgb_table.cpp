#include "rgb_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sigmoid_fit.h"

namespace etendue {

namespace {

constexpr int levels = 40, ratios = 32;
constexpr double darkest = 1e-3;         // z of the first level
constexpr int quadrature_step = 3;       // nm
constexpr double coarse_error = 3.5e-4;  // of RGB, in the middle of a cell, that marks it
constexpr double improved_error = 1e-4;

double level_z(int level) { return std::max(double(level) / (levels - 1), darkest); }
double node_ratio(double i) { return i / (ratios - 1); }
size_t node_index(int largest, int level, int iy, int ix) {
  return size_t(((largest * levels + level) * ratios + iy) * ratios + ix);
}
std::array<double, 3> rgb_of(int largest, double z, double x, double y) {
  std::array<double, 3> rgb;
  rgb[size_t(largest)] = z;
  rgb[size_t((largest + 1) % 3)] = z * x;
  rgb[size_t((largest + 2) % 3)] = z * y;
  return rgb;
}
/// Whether a cell, given by its lowest corner, has a part in the half of the cube that is looked up.
bool needed(int level, int iy, int ix) { return level_z(level) * (1 + node_ratio(std::max(0, std::min(ix, iy)))) <= 1; }

}  // namespace

void RgbTable::compute(const RgbSpace& space) {
  fit_ = std::make_unique<SigmoidFit>(space, quadrature_step);
  storage_.resize(size_t(3 * levels * ratios * ratios));
  for (int largest = 0; largest < 3; ++largest)
    for (int iy = 0; iy < ratios; ++iy)
      for (int ix = 0; ix < ratios; ++ix) {
        const auto solve = [&](int level, Coefficients& c) {
          const double z = level_z(level);
          fit_->solve(rgb_of(largest, z, node_ratio(ix), node_ratio(iy)), c, 2e-5, 20);
          Node& node = storage_[node_index(largest, level, iy, ix)];
          for (size_t i = 0; i < 3; ++i) node.c[i] = float(c[i] * std::sqrt(z));
        };
        // From the middle, which is the easiest, to both ends, each from the solution before.
        Coefficients middle{}, c;
        solve(levels / 2, middle);
        c = middle;
        for (int level = levels / 2 - 1; level >= 0; --level) solve(level, c);
        c = middle;
        for (int level = levels / 2 + 1; level < levels && needed(level - 1, iy - 1, ix - 1); ++level) solve(level, c);
      }

  for (int largest = 0; largest < 3; ++largest)
    for (int level = 0; level < levels - 1; ++level)
      for (int iy = 0; iy < ratios - 1; ++iy)
        for (int ix = 0; ix < ratios - 1; ++ix) {
          if (!needed(level, iy, ix)) continue;
          const double z = (level_z(level) + level_z(level + 1)) / 2;
          const std::array<double, 3> rgb = rgb_of(largest, z, node_ratio(ix + 0.5), node_ratio(iy + 0.5));
          const float floats[3] = {float(rgb[0]), float(rgb[1]), float(rgb[2])};
          bool coarse = false;
          const RgbCoefficients found = interpolate(storage_.data(), floats, coarse);
          Coefficients c{double(found.c0), double(found.c1), double(found.c2)};
          if (fit_->solve(rgb, c, 0, 0) > coarse_error) storage_[node_index(largest, level, iy, ix)].coarse = 1;
        }
  nodes_.store(storage_.data(), std::memory_order_release);
}

RgbCoefficients RgbTable::interpolate(const Node* nodes, const float rgb[3], bool& coarse) {
  int largest = rgb[1] > rgb[0] ? 1 : 0;
  if (rgb[2] > rgb[largest]) largest = 2;
  const float z = rgb[largest], inverse = 1 / z;
  const auto split = [](float position, int count, int& cell) {
    cell = std::clamp(int(position), 0, count - 2);
    return position - float(cell);
  };
  int ix, iy, iz;
  const float fx = split(rgb[(largest + 1) % 3] * inverse * float(ratios - 1), ratios, ix);
  const float fy = split(rgb[(largest + 2) % 3] * inverse * float(ratios - 1), ratios, iy);
  const float fz = split(z * float(levels - 1), levels, iz);
  const Node* corner = nodes + node_index(largest, iz, iy, ix);

  using Row = float __attribute__((vector_size(16)));
  const auto row = [&](const Node* node) {
    Row p, q;
    __builtin_memcpy(&p, node, sizeof p);
    __builtin_memcpy(&q, node + 1, sizeof q);
    return p + fx * (q - p);
  };
  const auto sheet = [&](const Node* node) {
    const Row p = row(node), q = row(node + ratios);
    return p + fy * (q - p);
  };
  const Row low = sheet(corner), high = sheet(corner + ratios * ratios);
  const Row c = (low + fz * (high - low)) * (1 / std::sqrt(z));
  coarse = corner->coarse != 0;
  return {c[0], c[1], c[2]};
}

RgbCoefficients RgbTable::find(const RgbSpace& space, float r, float g, float b) {
  const Node* nodes = nodes_.load(std::memory_order_acquire);
  if (!nodes) {
    std::call_once(once_, [&] { compute(space); });
    nodes = nodes_.load(std::memory_order_acquire);
  }
  if (std::isnan(r + g + b)) return {0, 0, std::numeric_limits<float>::quiet_NaN()};
  float rgb[3] = {clamp(r, 0, 1), clamp(g, 0, 1), clamp(b, 0, 1)};
  const float largest = std::max({rgb[0], rgb[1], rgb[2]}), smallest = std::min({rgb[0], rgb[1], rgb[2]});
  if (largest == smallest) return {0, 0, float(flat_coefficients(double(largest))[2])};
  const bool bright = largest + smallest > 1;
  if (bright)
    for (float& x : rgb) x = 1 - x;
  // Black, and what has no finite reciprocal; bright ones have 1 - rgb well above that.
  if (!bright && largest < std::numeric_limits<float>::min()) return {0, 0, -1e9f};
  bool coarse = false;
  RgbCoefficients found = interpolate(nodes, rgb, coarse);
  if (coarse) {
    Coefficients c{double(found.c0), double(found.c1), double(found.c2)};
    fit_->solve({double(rgb[0]), double(rgb[1]), double(rgb[2])}, c, improved_error, 30);
    found = {float(c[0]), float(c[1]), float(c[2])};
  }
  if (bright) return {-found.c0, -found.c1, -found.c2};
  return found;
}

RgbCoefficients rgb_coefficients(const RgbSpace& space, float r, float g, float b) { return space.table->find(space, r, g, b); }

Spectrum RgbCoefficients::evaluate(const Wavelengths& wavelengths) const { return evaluate_sigmoid(c0, c1, c2, wavelengths); }

Spectrum rgb_spectrum(const RgbSpace& space, float r, float g, float b, ColorUse use, const Wavelengths& wavelengths) {
  if (use == ColorUse::reflectance) return rgb_coefficients(space, r, g, b).evaluate(wavelengths);
  const float scale = 2 * std::max({r, g, b});
  if (scale < std::numeric_limits<float>::min()) return Spectrum();
  const float inverse = 1 / scale;
  const Spectrum s = scale * rgb_coefficients(space, r * inverse, g * inverse, b * inverse).evaluate(wavelengths);
  return use == ColorUse::radiance ? s * space.illuminant->evaluate(wavelengths, use) : s;
}

}  // namespace etendue
