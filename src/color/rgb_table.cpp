#include "rgb_table.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "etendue/describe/bands.h"
#include "sigmoid_fit.h"

namespace etendue {

namespace {

constexpr int levels = 40, ratios = 32;
constexpr double darkest = 1e-3;         // z of the lowest level
constexpr int quadrature_step = 3;       // nm
constexpr double coarse_error = 3.5e-4;  // RGB error at the centre of a cell above which the cell is marked as coarse
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
/// Calls `work(item)` for all items, on all cores. Isolated: a thread that waits for others here must not take up other work,
/// which could ask for the same table and wait for itself.
template <class Work>
void in_parallel(int items, const Work& work) {
  tbb::this_task_arena::isolate([&] { tbb::parallel_for(0, items, work); });
}

/// Whether a cell, given by its lowest corner, overlaps the half of the cube that is used in look-ups.
bool needed(int level, int iy, int ix) { return level_z(level) * (1 + node_ratio(std::max(0, std::min(ix, iy)))) <= 1; }

}  // namespace

void RgbTable::compute(const RgbSpace& space) {
  fit_ = std::make_unique<SigmoidFit>(space, quadrature_step);
  storage_.resize(size_t(3 * levels * ratios * ratios));
  in_parallel(3 * ratios, [&](int item) {
    const int largest = item / ratios, iy = item % ratios;
    for (int ix = 0; ix < ratios; ++ix) {
      const auto solve = [&](int level, Coefficients& c) {
        const double z = level_z(level);
        fit_->solve(rgb_of(largest, z, node_ratio(ix), node_ratio(iy)), c, 2e-5, 20);
        Node& node = storage_[node_index(largest, level, iy, ix)];
        for (size_t i = 0; i < 3; ++i) node.c[i] = float(c[i] * std::sqrt(z));
      };
      // From the middle level, where the fit is easiest, to both ends; each level starts from the solution of the one before.
      Coefficients middle{}, c;
      solve(levels / 2, middle);
      c = middle;
      for (int level = levels / 2 - 1; level >= 0; --level) solve(level, c);
      c = middle;
      for (int level = levels / 2 + 1; level < levels && needed(level - 1, iy - 1, ix - 1); ++level) solve(level, c);
    }
  });

  in_parallel(3 * (levels - 1), [&](int item) {
    const int largest = item / (levels - 1), level = item % (levels - 1);
    for (int iy = 0; iy < ratios - 1; ++iy)
      for (int ix = 0; ix < ratios - 1; ++ix) {
        if (!needed(level, iy, ix)) continue;
        const double z = (level_z(level) + level_z(level + 1)) / 2;
        Node& corner = storage_[node_index(largest, level, iy, ix)];
        const RgbCoefficients found = between(&corner, ratios, size_t(ratios * ratios), 0.5f, 0.5f, 0.5f, float(z));
        Coefficients c{double(found.c0), double(found.c1), double(found.c2)};
        if (fit_->solve(rgb_of(largest, z, node_ratio(ix + 0.5), node_ratio(iy + 0.5)), c, 0, 0) > coarse_error)
          corner.coarse = 1;
      }
  });
  divided_ = std::make_unique<std::atomic<const Divided*>[]>(storage_.size());
  nodes_.store(storage_.data(), std::memory_order_release);
}

RgbTable::~RgbTable() {
  if (divided_)
    for (size_t i = 0; i < storage_.size(); ++i) delete divided_[i].load();
}

struct RgbTable::Place {
  int largest, ix, iy, level;
  float x, y, z;  // from 0 to 1 in the cell
  size_t index() const { return node_index(largest, level, iy, ix); }
};

RgbTable::Place RgbTable::place_of(const float rgb[3]) {
  int largest = rgb[1] > rgb[0] ? 1 : 0;
  if (rgb[2] > rgb[largest]) largest = 2;
  const float z = rgb[largest], inverse = 1 / z;
  const auto split = [](float position, int count, int& cell) {
    cell = std::clamp(int(position), 0, count - 2);
    return position - float(cell);
  };
  Place place{largest, 0, 0, 0, 0, 0, 0};
  place.x = split(rgb[(largest + 1) % 3] * inverse * float(ratios - 1), ratios, place.ix);
  place.y = split(rgb[(largest + 2) % 3] * inverse * float(ratios - 1), ratios, place.iy);
  place.z = split(z * float(levels - 1), levels, place.level);
  return place;
}

/// Interpolates between the eight nodes of a cell, whose neighbours along y and z are `row` and `sheet` nodes away. `largest`
/// is the value of the largest component.
RgbCoefficients RgbTable::between(const Node* corner, size_t row, size_t sheet, float x, float y, float z, float largest) {
  using Row = float __attribute__((vector_size(16)));
  const auto along_x = [&](const Node* node) {
    Row p, q;
    __builtin_memcpy(&p, node, sizeof p);
    __builtin_memcpy(&q, node + 1, sizeof q);
    return p + x * (q - p);
  };
  const auto along_y = [&](const Node* node) {
    const Row p = along_x(node), q = along_x(node + row);
    return p + y * (q - p);
  };
  const Row low = along_y(corner), high = along_y(corner + sheet);
  const Row c = (low + z * (high - low)) * (1 / std::sqrt(largest));
  return {c[0], c[1], c[2]};
}

/// If two threads subdivide a cell at the same time, the results are equal and one of them is kept.
const RgbTable::Divided& RgbTable::divided(const Node* nodes, const Place& place) {
  std::atomic<const Divided*>& slot = divided_[place.index()];
  if (const Divided* there = slot.load(std::memory_order_acquire)) return *there;
  std::unique_ptr<Divided> made = divide(nodes, place);
  const Divided* kept = nullptr;
  if (slot.compare_exchange_strong(kept, made.get(), std::memory_order_acq_rel)) kept = made.release();
  return *kept;
}

std::unique_ptr<RgbTable::Divided> RgbTable::divide(const Node* nodes, const Place& place) const {
  auto made = std::make_unique<Divided>();
  const Node* const corner = nodes + place.index();
  const double low = level_z(place.level), high = level_z(place.level + 1);
  const auto rgb_at = [&](double x, double y, double z) {
    return rgb_of(place.largest, low + z * (high - low), node_ratio(place.ix + x), node_ratio(place.iy + y));
  };
  for (int k = 0; k < divided_nodes; ++k) {
    const double x = (k % side) / double(parts), y = (k / side % side) / double(parts), z = (k / (side * side)) / double(parts);
    const std::array<double, 3> rgb = rgb_at(x, y, z);
    const double largest = rgb[size_t(place.largest)];
    const RgbCoefficients found =
        between(corner, ratios, size_t(ratios * ratios), float(x), float(y), float(z), float(largest));
    Coefficients c{double(found.c0), double(found.c1), double(found.c2)};
    fit_->solve(rgb, c, 2e-5, 20);
    for (size_t i = 0; i < 3; ++i) made->nodes[k].c[i] = float(c[i] * std::sqrt(largest));
  }
  for (int k = 0; k < divided_nodes; ++k) {
    const int ix = k % side, iy = k / side % side, iz = k / (side * side);
    if (ix == parts || iy == parts || iz == parts) continue;
    const std::array<double, 3> rgb = rgb_at((ix + 0.5) / parts, (iy + 0.5) / parts, (iz + 0.5) / parts);
    const RgbCoefficients found =
        between(&made->nodes[k], side, side * side, 0.5f, 0.5f, 0.5f, float(rgb[size_t(place.largest)]));
    Coefficients c{double(found.c0), double(found.c1), double(found.c2)};
    if (fit_->solve(rgb, c, 0, 0) > improved_error) made->nodes[k].coarse = 1;
  }
  return made;
}

RgbCoefficients RgbTable::find(const RgbSpace& space, float r, float g, float b) {
  if (std::isnan(r + g + b)) return {0, 0, std::numeric_limits<float>::quiet_NaN()};
  float rgb[3] = {clamp(r, 0, 1), clamp(g, 0, 1), clamp(b, 0, 1)};
  const float largest = std::max({rgb[0], rgb[1], rgb[2]}), smallest = std::min({rgb[0], rgb[1], rgb[2]});
  if (largest == smallest) return {0, 0, float(flat_coefficients(double(largest))[2])};
  const bool bright = largest + smallest > 1;
  if (bright)
    for (float& x : rgb) x = 1 - x;
  // Black, and values without a finite reciprocal. (Bright colours have 1 - rgb well above this.)
  if (!bright && largest < std::numeric_limits<float>::min()) return {0, 0, -1e9f};
  // Computed only here: greys do without the table, which takes longer to compute than many a small scene to render.
  const Node* nodes = nodes_.load(std::memory_order_acquire);
  if (!nodes) {
    std::call_once(once_, [&] { compute(space); });
    nodes = nodes_.load(std::memory_order_acquire);
  }
  const RgbCoefficients found = look_up(nodes, rgb);
  if (bright) return {-found.c0, -found.c1, -found.c2};
  return found;
}

/// Looks up a colour whose largest and smallest component sum to at most 1.
RgbCoefficients RgbTable::look_up(const Node* nodes, const float rgb[3]) {
  const Place place = place_of(rgb);
  const Node* const corner = nodes + place.index();
  const float z = rgb[place.largest];
  if (corner->coarse == 0) return between(corner, ratios, size_t(ratios * ratios), place.x, place.y, place.z, z);
  const Divided& cell = divided(nodes, place);
  // Below the lowest level the coefficients scale as z^-1/2, as at the cell's lowest nodes.
  const float at[3] = {
      place.x * parts, place.y * parts,
      clamp((z - float(level_z(place.level))) / float(level_z(place.level + 1) - level_z(place.level)), 0, 1) * parts};
  int of[3];
  float within[3];
  for (int i = 0; i < 3; ++i) {
    of[i] = std::clamp(int(at[i]), 0, parts - 1);
    within[i] = at[i] - float(of[i]);
  }
  const Node* const inner = &cell.nodes[(of[2] * side + of[1]) * side + of[0]];
  const RgbCoefficients found = between(inner, side, side * side, within[0], within[1], within[2], z);
  if (inner->coarse == 0) return found;
  Coefficients c{double(found.c0), double(found.c1), double(found.c2)};
  fit_->solve({double(rgb[0]), double(rgb[1]), double(rgb[2])}, c, improved_error, 30);
  return {float(c[0]), float(c[1]), float(c[2])};
}

RgbCoefficients rgb_coefficients(const RgbSpace& space, float r, float g, float b) { return space.table->find(space, r, g, b); }

Spectrum RgbCoefficients::evaluate(const Wavelengths& wavelengths) const {
  if (in_bands(wavelengths)) [[unlikely]] {
    const Coefficients c{double(c0), double(c1), double(c2)};
    return projected([&](float lambda) { return evaluate_sigmoid(c, double(lambda)); }, ColorUse::reflectance, wavelengths);
  }
  return evaluate_sigmoid(c0, c1, c2, wavelengths);
}

Spectrum rgb_spectrum(const RgbSpace& space, float r, float g, float b, ColorUse use, const Wavelengths& wavelengths) {
  if (in_bands(wavelengths)) [[unlikely]]
    return rgb_in_bands(space, r, g, b, use, wavelengths);
  if (use == ColorUse::reflectance) return rgb_coefficients(space, r, g, b).evaluate(wavelengths);
  const float scale = 2 * std::max({r, g, b});
  if (scale < std::numeric_limits<float>::min()) return Spectrum();
  const float inverse = 1 / scale;
  const Spectrum s = scale * rgb_coefficients(space, r * inverse, g * inverse, b * inverse).evaluate(wavelengths);
  return use == ColorUse::radiance ? s * space.illuminant->evaluate(wavelengths, use) : s;
}

}  // namespace etendue
