// The area of an implicit surface, and uniform sampling of points on it.
//
// A surface element dS with unit normal n projects to |n_k| dS on the cross section of lines along axis k. So with weights
// h_k(n) that add up to 1 over the axes, the area is an integral over lines along the three axes (Cauchy-Crofton),
//   A = sum_k integral over lines sum over crossings h_k(n) / |n_k|.
// With h_k = n_k^2 a crossing contributes |n_k|. With h_k = n_k^4 / sum_j n_j^4 a crossing contributes less at grazing angles,
// and the integrand is continuous at silhouettes: a regular grid of lines converges fast. (The difference between the two
// estimates the error of the second.)
//
// The same lines give samples with a pdf of exactly 1 / A, whatever the error of the computed A: choose an axis and a line
// uniformly, and each of the line's crossings with probability |n_k| / W; otherwise reject and try again. Then the pdf is
// proportional to sum_k |n_k| |n_k| = 1. W must be no less than the sum of |n_k| on any line. To reject seldom, lines are
// sampled per cell that the surface may cross; each cell has its own W and is chosen with probability proportional to W * cross
// section, which leaves the pdf unchanged. W is estimated from lines through the cell and its neighbours, with a margin.
//
// Faces at the border of the box are sampled in two dimensions: a point of a cell's face is accepted if it is in the solid.

#include "implicit_area.h"

namespace etendue {
namespace {

constexpr int lines = 3;        // lines through a cell: this number squared for each axis
constexpr int face_lines = 12;  // lines across a cell's face
constexpr int bins = 24;        // bins of normals along the edge of a cube face

double square(double x) { return x * x; }

/// Accumulates areas by normal, in bins on the faces of a cube.
class NormalCells {
 public:
  void add(const Place& n, double area) {
    int k = 0;
    for (int i = 1; i < 3; ++i)
      if (std::abs(n[size_t(i)]) > std::abs(n[size_t(k)])) k = i;
    const double largest = std::abs(n[size_t(k)]);
    const auto bin = [&](int axis) { return std::clamp(int((n[size_t(axis)] / largest + 1) / 2 * bins), 0, bins - 1); };
    auto& sum = sums_[size_t(((2 * k + (n[size_t(k)] > 0)) * bins + bin((k + 1) % 3)) * bins + bin((k + 2) % 3))];
    for (size_t i = 0; i < 3; ++i) sum[i] += area * n[i];
    sum[3] += area;
  }
  void list(std::vector<std::pair<Normal3, float>>& to) const {
    for (const auto& s : sums_)
      if (s[3] > 0)
        to.emplace_back(normalize(Normal3(float(s[0] / s[3]), float(s[1] / s[3]), float(s[2] / s[3]))), float(s[3]));
  }

 private:
  std::vector<std::array<double, 4>> sums_ = std::vector<std::array<double, 4>>(6 * bins * bins);
};

}  // namespace

const ImplicitObject::Table& ImplicitObject::table() const {
  std::call_once(lazy_->once, [&] { tabulate(lazy_->table); });
  return lazy_->table;
}

void ImplicitObject::tabulate(Table& table) const {
  NormalCells normals;
  double half[2]{}, other = 0, faces = 0, faces_off = 0;
  const auto cross_section = [&](int axis) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    return (high_[a] - low_[a]) / count_[a] * (high_[b] - low_[b]) / count_[b];
  };
  // The largest sum of |n_k| on a line, by cell and axis.
  std::vector<std::array<float, 3>> largest(size_t(count_[0] * count_[1] * count_[2]));
  const auto index = [&](int i, int j, int k) { return size_t((k * count_[1] + j) * count_[0] + i); };
  for (const Cell& cell : crossed_)
    for (int k = 0; k < 3; ++k) {
      const double each = cross_section(k) / (lines * lines);
      for (int i = 0; i < lines * lines; ++i) {
        double sum = 0;
        visit_line(cell, k, (i % lines + 0.5) / lines, (i / lines + 0.5) / lines, [&](const Place&, const Place& n) {
          const double cosine = std::abs(n[k]);
          const double area =
              each * cosine * square(cosine) / (square(square(n[0])) + square(square(n[1])) + square(square(n[2])));
          half[i % 2] += area;
          other += each * cosine;
          sum += cosine;
          normals.add(n, area);
        });
        float& most = largest[index(cell[0], cell[1], cell[2])][size_t(k)];
        most = std::max(most, float(sum));
      }
    }

  double until = 0;
  const auto add = [&](const Cell& cell, int axis, float bound, double cross) {
    until += double(bound) * cross;
    table.patches.push_back({cell, std::uint8_t(axis), bound, until});
  };
  for (const Cell& cell : crossed_)
    for (int k = 0; k < 3; ++k) {
      float most = 0;
      for (int z = std::max(cell[2] - 1, 0); z <= std::min(cell[2] + 1, count_[2] - 1); ++z)
        for (int y = std::max(cell[1] - 1, 0); y <= std::min(cell[1] + 1, count_[1] - 1); ++y)
          for (int x = std::max(cell[0] - 1, 0); x <= std::min(cell[0] + 1, count_[0] - 1); ++x)
            most = std::max(most, largest[index(x, y, z)][size_t(k)]);
      add(cell, k, 1.1f * most + 0.05f, cross_section(k));
    }
  if (capped_)
    visit_borders([&](const Cell& cell, int face, bool) {
      add(cell, 3 + face, 1, cross_section(face / 2));
      const double area = face_area(cell, face, faces_off);
      Place n{};
      n[size_t(face / 2)] = face % 2 ? 1 : -1;
      if (area > 0) normals.add(n, area);
      faces += area;
    });
  const double smooth = half[0] + half[1];
  // Of nine lines, five have an even index.
  const double uneven = std::abs(half[0] * 9 / 5 - half[1] * 9 / 4) / 2;
  table.area = smooth + faces;
  table.error = table.area > 0 ? 1e-6 + (uneven + std::abs(smooth - other) + std::abs(faces_off)) / table.area : 0;
  normals.list(table.facing);
}

/// The area [m^2] of the part of a cell's face that is in the solid, from the lengths inside the solid of lines along both
/// edges; half the difference of the two estimates is added to `off`.
double ImplicitObject::face_area(const Cell& cell, int face, double& off) const {
  const int axis = face / 2;
  Place low, high;
  cell_box(cell, low, high);
  double areas[2]{};
  for (int turn = 0; turn < 2; ++turn) {
    const int along = (axis + 1 + turn) % 3, across = (axis + 2 - turn) % 3;
    for (int i = 0; i < face_lines; ++i) {
      DoubleRay r{Ray{}};
      r.origin[axis] = face % 2 ? high_[axis] : low_[axis];
      r.origin[along] = low[along];
      r.origin[across] = low[across] + (high[across] - low[across]) * (i + 0.5) / face_lines;
      for (int k = 0; k < 3; ++k) r.direction[k] = k == along ? high[k] - low[k] : 0;
      bool inside = field({r.origin[0], r.origin[1], r.origin[2]}) < 0;
      double begin = 0, last = 0, t = 0, length = 0;
      for (int n = 0; n < 1000 && begin < 1 && next_crossing(r, begin, 1, inside, t); ++n) {
        if (!inside) length += t - last;
        last = t;
        begin = t + 1e-9;
      }
      if (inside) length += 1 - last;
      areas[turn] += length / face_lines;
    }
    areas[turn] *= (high[along] - low[along]) * (high[across] - low[across]);
  }
  off += (areas[1] - areas[0]) / 2;
  return (areas[0] + areas[1]) / 2;
}

double ImplicitObject::local_area() const { return lazy_ ? table().area : 0; }

float ImplicitObject::local_pdf(const SurfacePoint&) const { return float(1 / table().area); }

// Overridden because the base class integrates over local_sample, which is discontinuous here.
float ImplicitObject::area(float time) const {
  const Transform t = transform.at(time);
  const Table& own = table();
  if (const float s = similarity_scale(t); s > 0) return float(own.area * double(s) * double(s));
  double sum = 0;
  for (const auto& [normal, area] : own.facing) sum += double(area) * double(t.area_stretch(normal));
  return float(sum);
}

float ImplicitObject::area_error(float time) const {
  constexpr double of_bins = 1e-3;
  return float(table().error + (similarity_scale(transform.at(time)) > 0 ? 0 : of_bins));
}

bool ImplicitObject::try_patch(const Patch& patch, double a, double b, double v, LocalPoint& p) const {
  if (patch.axis >= 3) {
    const int face = patch.axis - 3, k = face / 2;
    Place low, high, x;
    cell_box(patch.cell, low, high);
    x[k] = face % 2 ? high_[k] : low_[k];
    x[(k + 1) % 3] = low[(k + 1) % 3] + a * (high[(k + 1) % 3] - low[(k + 1) % 3]);
    x[(k + 2) % 3] = low[(k + 2) % 3] + b * (high[(k + 2) % 3] - low[(k + 2) % 3]);
    if (!(field(x) < 0)) return false;
    point_at(x, first_face + face, p);
    return true;
  }
  double left = v * double(patch.bound);
  Place chosen{};
  visit_line(patch.cell, patch.axis, a, b, [&](const Place& x, const Place& n) {
    if (left < 0) return;
    left -= std::abs(n[patch.axis]);
    if (left < 0) chosen = x;
  });
  if (left >= 0) return false;
  point_at(chosen, 0, p);
  return true;
}

float ImplicitObject::local_sample(Point2 u, LocalPoint& p) const {
  if (!lazy_) return 0;
  const Table& own = table();
  if (own.patches.empty()) return 0;
  // The first try uses u for the patch and for one coordinate across it. Further random numbers are hashed from u.
  std::uint64_t state = mix_bits(std::uint64_t(std::bit_cast<std::uint32_t>(u.x)) << 32 | std::bit_cast<std::uint32_t>(u.y));
  const auto random = [&] { return double(mix_bits(state += 0x9e3779b97f4a7c15ull) >> 11) * 0x1p-53; };
  constexpr int tries = 4000;  // about one in three succeeds
  for (int i = 0; i < tries; ++i) {
    const double place = i == 0 ? double(u.x) + 0x1p-24 * random() : random();
    const double across = i == 0 ? double(u.y) + 0x1p-24 * random() : random();
    auto patch = std::upper_bound(own.patches.begin(), own.patches.end(), place * own.patches.back().until,
                                  [](double x, const Patch& q) { return x < q.until; });
    if (patch == own.patches.end()) --patch;
    const double b = random(), v = random();
    if (try_patch(*patch, std::min(across, 1.0), b, v, p)) return float(1 / own.area);
  }
  return 0;
}

}  // namespace etendue
