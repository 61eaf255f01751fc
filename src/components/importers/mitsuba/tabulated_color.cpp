#include "tabulated_color.h"

#include <algorithm>
#include <cmath>

#include "color/sigmoid_fit.h"
#include "etendue/describe/color.h"

namespace etendue::mitsuba {

namespace {

// Jakob & Hanika 2019, "A low-dimensional function space for efficient spectral upsampling", section 4: the coefficients of the
// sigmoid's quadratic are tabulated at 64^3 nodes of a cube, one cube for each choice of the largest component. The axes are
// that component, z, whose nodes are dense at both ends, and the ratios x and y of the next two components to it. Between nodes
// the coefficients are interpolated linearly.
constexpr int nodes = 64;

double smoothstep(double x) { return x * x * (3 - 2 * x); }
double node_z(int i) { return smoothstep(smoothstep(double(i) / (nodes - 1))); }

struct Cell {
  int first;
  double part;  ///< interpolation parameter in [0, 1] towards the next node
};

Cell cell_of_ratio(double ratio) {
  const double place = ratio * (nodes - 1);
  const int first = std::clamp(int(place), 0, nodes - 2);
  return {first, place - first};
}

Cell cell_of_largest(double z) {
  int first = 0;
  while (first < nodes - 2 && node_z(first + 1) <= z) ++first;
  return {first, (z - node_z(first)) / (node_z(first + 1) - node_z(first))};
}

}  // namespace

// The error of the linear interpolation is visible only near white, where the coefficients change fast: for (0.99, 0.999, 0.99)
// the table returns a spectrum of colour (0.998, 0.998, 0.997), which absorbs a fifth of the red light. Multiple scattering in
// a medium shows it. The fit that replaces the table's nodes here is exact, while the table's own is optimized to a tolerance;
// where the result is used, the difference is within 0.0004.
std::array<double, 3> tabulated_color(const std::array<double, 3>& rgb) {
  const size_t largest = size_t(std::max_element(rgb.begin(), rgb.end()) - rgb.begin());
  const size_t next = (largest + 1) % 3, last = (largest + 2) % 3;
  if (!(rgb[largest] > 0) || (rgb[next] == rgb[largest] && rgb[last] == rgb[largest])) return rgb;
  static const SigmoidFit fit(rgb_space("srgb"), 1);
  const Cell x = cell_of_ratio(rgb[next] / rgb[largest]), y = cell_of_ratio(rgb[last] / rgb[largest]),
             z = cell_of_largest(rgb[largest]);
  Coefficients sum{};
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
    const double weight = (dx ? x.part : 1 - x.part) * (dy ? y.part : 1 - y.part) * (dz ? z.part : 1 - z.part);
    if (!(weight > 0)) continue;
    std::array<double, 3> node;
    node[largest] = node_z(z.first + dz);
    node[next] = node[largest] * (x.first + dx) / (nodes - 1);
    node[last] = node[largest] * (y.first + dy) / (nodes - 1);
    Coefficients at_node = fit.solve(node);
    // White has no finite coefficients; the table's come from a fit that stops before them.
    for (double& c : at_node) c = std::clamp(c, -300.0, 300.0);
    for (size_t i = 0; i < 3; ++i) sum[i] += weight * at_node[i];
  }
  return fit.rgb_of(sum);
}

}  // namespace etendue::mitsuba
