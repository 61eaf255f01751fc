// The area of CSG solids, and area sampling of their surfaces.

#include <bit>

#include "csg.h"
#include "geometry/geometry.h"

// No formula gives the parts of the operands' surfaces that remain in a solid, and a point sampled on an operand may have been
// cut away. So points are sampled by chords: lines along one of the axes, through a point sampled on that side of the bounding
// box; one of the chord's N crossings with the solid is chosen. A surface element dA whose normal has the component n_k along
// axis k projects to |n_k| dA on the side. With axis k chosen in proportion to its side's area S_k, and S the sum of these, the
// pdf [1/m^2] is
//     p(x) = sum_k S_k / S  1 / S_k  |n_k| / N_k(x)  =  1 / S  sum_k |n_k| / N_k(x),
// where N_k is found by tracing the chord along k through x. This holds for any operands and can be evaluated at any point.
//
// A chord that misses the solid would give no point. Then the next chord is tried, whose position v on the side follows by a
// shift
//     T(v) = v + a   (mod the side),
// which is a bijection. A chord is thus reached from its own position and from each position of the run of misses that precedes
// it under T:
//     p(x) = 1 / S  sum_k |n_k| (1 + m_k(x)) / N_k(x),
// with m_k the length of the run of misses T^-1(v), T^-2(v), ... before the position v of x on side k. The shift a is that of
// the R2 low-discrepancy sequence (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences"), so runs are short.
// Positions are integers, so that T and its inverse are exact.
//
// The area follows from the same chords. With w_k = |n_k| the weights sum_k |n_k| w_k are 1 everywhere, so
//     A = sum_k int over side k of (sum of |n_k| at the chord's crossings).
// The integrals are computed by quadrature over a Fibonacci lattice (Niederreiter & Sloan 1994, "Integration of nonperiodic
// functions of two variables by Fibonacci lattice rules").

namespace etendue {
namespace {

/// Largest number of chords tried for a sample; after a run of misses this long the sample fails.
constexpr int most_tries = 1 << 12;

double unit_of(std::uint32_t n) { return (double(n) + 0.5) * 0x1p-32; }

std::uint32_t integer_of(double x) { return std::uint32_t(std::clamp(x, 0.0, 1 - 0x1p-32) * 0x1p32); }

float stretch_of_area(const Transform& t, const Normal3& n) { return t.identity() ? 1 : t.area_stretch(n); }

}  // namespace

/// A position on the side of axis k, along the two axes after k.
struct Csg::Place {
  // 2^32 times the inverses of the plastic number and of its square.
  static constexpr std::uint32_t along_x = 3242174889u, along_y = 2447445413u;
  std::uint32_t x = 0, y = 0;
  Place next() const { return {x + along_x, y + along_y}; }
  Place previous() const { return {x - along_x, y - along_y}; }
};

Csg::Place Csg::lattice_place(int i, int chords, int step) {
  const auto part = [&](std::int64_t k) { return integer_of((double(k % chords) + 0.5) / chords); };
  return {part(i), part(std::int64_t(i) * step)};
}

double Csg::side_area(int axis) const {
  const Vector3 size = own_bounds_.diagonal();
  return double(size[(axis + 1) % 3]) * double(size[(axis + 2) % 3]);
}

Ray Csg::chord(const Place& place, int axis, float time) const {
  const Vector3 size = own_bounds_.diagonal();
  const Point3& low = own_bounds_.low;
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  Ray ray;
  ray.origin[axis] = low[axis] - (0.01f * size[axis] + 1e-5f * std::abs(low[axis]));
  ray.origin[a] = float(double(low[a]) + double(size[a]) * unit_of(place.x));
  ray.origin[b] = float(double(low[b]) + double(size[b]) * unit_of(place.y));
  ray.direction = {};
  ray.direction[axis] = 1;
  ray.time = time;
  return ray;
}

Csg::Place Csg::place_of(const Point3& p, int axis) const {
  const Vector3 size = own_bounds_.diagonal();
  const auto along = [&](int k) {
    return size[k] > 0 ? integer_of((double(p[k]) - double(own_bounds_.low[k])) / double(size[k])) : 0;
  };
  return {along((axis + 1) % 3), along((axis + 2) % 3)};
}

int Csg::crossings(const Ray& ray) const {
  CsgWalk walk(combined_, least_weight_, ray);
  int n = 0;
  while (walk.next()) ++n;
  return n;
}

double Csg::own_pdf(const Point3& p, const Normal3& normal, float time) const {
  double sum = 0, all_sides = 0;
  for (int axis = 0; axis < 3; ++axis) {
    all_sides += side_area(axis);
    if (normal[axis] == 0) continue;
    Place place = place_of(p, axis);
    const int n = crossings(chord(place, axis, time));
    if (n == 0) continue;
    int ways = 1;
    for (; ways < most_tries; ++ways) {
      place = place.previous();
      const Ray ray = chord(place, axis, time);
      if (CsgWalk(combined_, least_weight_, ray).next()) break;
    }
    sum += std::abs(double(normal[axis])) * ways / n;
  }
  return sum / all_sides;
}

SurfaceSample Csg::sample_area(Point2 u, float time) const {
  SurfaceSample s;
  if (own_bounds_.empty()) return s;
  const double areas[3] = {side_area(0), side_area(1), side_area(2)};
  double x = double(u.x) * (areas[0] + areas[1] + areas[2]);
  int axis = 0;
  for (; axis < 2 && x >= areas[axis]; ++axis) x -= areas[axis];
  Place place{integer_of(x / areas[axis]), integer_of(double(u.y))};
  Ray ray;
  int n = 0;
  for (int i = 0; i < most_tries && n == 0; ++i, place = place.next()) {
    ray = chord(place, axis, time);
    n = crossings(ray);
  }
  if (n == 0) return s;
  // The crossing is chosen by a hash of all bits of u; the dependence on the position is too irregular to be visible.
  const std::uint64_t bits = std::uint64_t(std::bit_cast<std::uint32_t>(u.x)) << 32 | std::bit_cast<std::uint32_t>(u.y);
  const auto which = int(mix_bits(bits + 0x9e3779b97f4a7c15ull) % std::uint64_t(n));
  CsgWalk walk(combined_, least_weight_, ray);
  const CsgCrossing* crossing = nullptr;
  for (int i = 0; i <= which; ++i) crossing = walk.next();
  if (!crossing) return s;
  Hit hit;
  own_hit(*crossing, hit);
  own_point(ray, hit, s.point);
  Transform scratch;
  const Transform& t = placed(transform, time, scratch);
  if (!t.identity()) carry_out(t, s.point);
  s.pdf = area_pdf(s.point);
  return s;
}

float Csg::area_pdf(const SurfacePoint& p) const {
  Transform scratch;
  const Transform& t = placed(transform, p.time, scratch);
  return float(own_pdf(t.back(p.position), p.object_normal, p.time)) / stretch_of_area(t, p.object_normal);
}

double Csg::chord_area(const Transform& t, float time, int chords, int step) const {
  double area = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double sum = 0;
    for (int i = 0; i < chords; ++i) {
      const Ray ray = chord(lattice_place(i, chords, step), axis, time);
      CsgWalk walk(combined_, least_weight_, ray);
      while (const CsgCrossing* const crossing = walk.next()) {
        Hit hit;
        own_hit(*crossing, hit);
        SurfacePoint p;
        own_point(ray, hit, p);
        sum += double(std::abs(p.normal[axis]) * stretch_of_area(t, p.normal));
      }
    }
    area += side_area(axis) * sum / chords;
  }
  return area;
}

const Csg::Areas& Csg::areas() const {
  Areas& areas = *areas_;
  std::call_once(areas.made, [&] {
    // Two consecutive Fibonacci numbers each: the number of chords, and the step of the lattice.
    struct Lattice {
      int chords, step;
    };
    const bool moving = times_.size() > 1;
    const Lattice fine = moving ? Lattice{2584, 1597} : Lattice{17711, 10946};
    const Lattice coarse = moving ? Lattice{987, 610} : Lattice{6765, 4181};
    if (moving) {
      const size_t steps = std::max<size_t>(8, 32 / (times_.size() - 1));
      for (size_t key = 0; key + 1 < times_.size(); ++key)
        for (size_t i = 0; i < steps; ++i) areas.times.push_back(lerp(float(i) / float(steps), times_[key], times_[key + 1]));
      areas.times.push_back(times_.back());
    } else {
      areas.times.push_back(times_.empty() ? 0 : times_.front());
    }
    for (size_t i = 0; i < areas.times.size(); ++i) {
      const float time = areas.times[i];
      const Transform t = transform.at(time);
      const double value = own_bounds_.empty() ? 0 : chord_area(t, time, fine.chords, fine.step);
      areas.values.push_back(float(value));
      if (i > 0) {  // error of linear interpolation between two times, estimated from the difference
        const double larger = std::max(areas.values[i], areas.values[i - 1]);
        if (larger > 0)
          areas.error = std::max(areas.error, float(0.5 * std::abs(value - double(areas.values[i - 1])) / larger));
        continue;
      }
      const double other = own_bounds_.empty() ? 0 : chord_area(t, time, coarse.chords, coarse.step);
      areas.error = value > 0 ? float(2 * std::abs(other - value) / value + 5.0 / fine.chords) : 0;
    }
  });
  return areas;
}

float Csg::area(float time) const {
  const Areas& known = areas();
  const auto after = std::upper_bound(known.times.begin(), known.times.end(), time);
  if (after == known.times.begin()) return known.values.front();
  if (after == known.times.end()) return known.values.back();
  const auto i = size_t(after - known.times.begin());
  return lerp((time - known.times[i - 1]) / (known.times[i] - known.times[i - 1]), known.values[i - 1], known.values[i]);
}

float Csg::area_error(float) const { return areas().error; }

bool Csg::something_left() const {
  if (own_bounds_.empty()) return false;
  // For most solids few chords suffice; only if they miss the solid, many are traced.
  for (const int chords : {89, 28657})
    for (size_t i = 0; i < std::max<size_t>(times_.size(), 1); ++i)
      for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < chords; ++k) {
          const Ray ray = chord(lattice_place(k, chords, chords == 89 ? 55 : 17711), axis, times_.empty() ? 0 : times_[i]);
          if (CsgWalk(combined_, least_weight_, ray).next()) return true;
        }
  return false;
}

}  // namespace etendue
