// Torus: a ring with a round cross-section, about the z axis.

#include "etendue/placed_object.h"
#include "geometry/double_ray.h"
#include "geometry/geometry.h"

namespace etendue {
namespace {

/// The root of a function between two points at which it has different signs: Newton's method, safeguarded by bisection. `f(x,
/// slope)` returns the value and its derivative.
template <class F>
double bracketed_root(double low, double high, bool rising, const F& f) {
  double x = 0.5 * (low + high);
  for (int i = 0; i < 80; ++i) {
    double slope = 0;
    const double value = f(x, slope);
    if (value == 0) return x;
    ((value < 0) == rising ? low : high) = x;
    const double newton = x - value / slope;
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);  // also if newton is NaN
    if (std::abs(next - x) < 1e-15 || high - low < 1e-15) return next;
    x = next;
  }
  return x;
}

// With the ring's radius as the unit of length, k the tube's radius, and a ray q + s d with |d| = 1 and q.d = 0, points of
// the surface (|p|^2 + 1 - k^2)^2 = 4 (x^2 + y^2) have
//   f(s) = s^4 + A s^2 + B s + C = 0,
//   A = 2 (|q|^2 + 1 - k^2) - 4 (1 - dz^2),  B = -8 (qx dx + qy dy),  C = (|q|^2 + 1 - k^2)^2 - 4 (qx^2 + qy^2).
// Between the roots of f' it is monotonic, and so is f' between those of f''; so every root is bracketed, and none is lost for
// grazing rays. f is positive at both ends of the range: crossings come in pairs. f has the sign of
//   g(s) = (sqrt(x^2 + y^2) - 1)^2 + z^2 - k^2,
// which is evaluated instead: in f, the digits of a thin tube would be lost in the fourth power of the ring's radius.
struct Quartic {
  double q[3], d[3], k;
  double a, b;

  Quartic(const double (&from)[3], const double (&along)[3], double tube) : k(tube) {
    std::copy_n(from, 3, q);
    std::copy_n(along, 3, d);
    const double m = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
    a = 2 * (m + 1 - k * k) - 4 * (1 - d[2] * d[2]);
    b = -8 * (q[0] * d[0] + q[1] * d[1]);
  }
  double g(double s, double& slope) const {
    const double x = q[0] + s * d[0], y = q[1] + s * d[1], z = q[2] + s * d[2], r = std::sqrt(x * x + y * y);
    slope = 2 * ((r - 1) * (x * d[0] + y * d[1]) / r + z * d[2]);
    return (r - 1) * (r - 1) + z * z - k * k;
  }
  /// f'(s).
  double f1(double s, double& slope) const {
    slope = 12 * s * s + 2 * a;
    return (4 * s * s + 2 * a) * s + b;
  }

  /// The ends of the intervals in which f is monotonic; returns their number.
  int monotonic(double low, double high, double (&ends)[5]) const {
    double turns[4];
    int n = 0, count = 0;
    turns[n++] = low;
    if (a < 0)
      for (const double s : {-std::sqrt(-a / 6), std::sqrt(-a / 6)})
        if (s > low && s < high) turns[n++] = s;
    turns[n++] = high;
    ends[count++] = low;
    double slope = 0, left = f1(low, slope);
    for (int i = 1; i < n; ++i) {
      const double right = f1(turns[i], slope);
      if ((left < 0) != (right < 0))
        ends[count++] =
            bracketed_root(turns[i - 1], turns[i], left < 0, [this](double s, double& slope1) { return f1(s, slope1); });
      left = right;
    }
    ends[count++] = high;
    return count;
  }
};

class Torus final : public PlacedObject {
 public:
  static void describe(Description<Torus>& d) {
    d.summary(
         "A torus about the z axis: a ring with a round cross-section. u goes around the axis from +x towards +y, v around "
         "the tube from its outermost circle over +z.",
         "area sampling: Williamson 1987, \"Random selection of points distributed on curved surfaces\"")
        .group("Shape")
        .member<&Torus::radius>("radius", "m", "from the middle of the ring to the middle of the tube", more_than(0),
                                Effect::rebuild, soft(0.01, 100), logarithmic)
        .member<&Torus::tube_radius>("tube_radius", "m", "of the tube; smaller than `radius`", more_than(0), Effect::rebuild,
                                     soft(0.01, 100), logarithmic);
  }

  void prepare() override {
    if (!(radius > 0 && radius < infinity)) fail("radius", "must be positive and finite");
    if (!(tube_radius > 0 && tube_radius < radius))
      fail("tube_radius", "must be positive and smaller than `radius`, or the ring would cut itself");
    place();
  }

  bool closed() const override { return true; }

  float radius = 1, tube_radius = 0.25f;

 protected:
  Bounds3 local_bounds() const override {
    const float reach = radius + tube_radius;
    Bounds3 box;
    box.add(Point3{-reach, -reach, -tube_radius});
    box.add(Point3{reach, reach, tube_radius});
    return box;
  }

  bool local_intersect(const Ray& ray, Hit& hit) const override {
    const DoubleRay r(ray);
    const double scale = double(radius), k = double(tube_radius) / scale, reach = 1 + k;
    // The ray is parametrized from its point nearest to the centre.
    const double dd = r.direction[0] * r.direction[0] + r.direction[1] * r.direction[1] + r.direction[2] * r.direction[2];
    const double od = r.origin[0] * r.direction[0] + r.origin[1] * r.direction[1] + r.origin[2] * r.direction[2];
    const double middle = -od / dd, speed = std::sqrt(dd) / scale;  // s = (t - middle) speed
    double q[3], d[3], m = 0;
    for (int i = 0; i < 3; ++i) {
      q[i] = r.at(middle, i) / scale;
      d[i] = r.direction[i] / (scale * speed);
      m += q[i] * q[i];
    }
    if (!(m < reach * reach)) return false;
    // All intersections lie in this interval, which is widened so that it certainly begins and ends outside.
    double high = std::sqrt(reach * reach - m), low = -high;
    if (std::abs(d[2]) > 1e-12) {
      const double s0 = (-k - q[2]) / d[2], s1 = (k - q[2]) / d[2];
      low = std::max(low, std::min(s0, s1));
      high = std::min(high, std::max(s0, s1));
    } else if (std::abs(q[2]) > k) {
      return false;
    }
    if (!(low < high)) return false;
    low -= 1e-4;
    high += 1e-4;
    if (middle + high / speed <= 0 || middle + low / speed >= r.maximum) return false;

    const Quartic f(q, d, k);
    double ends[5], slope = 0;
    const int n = f.monotonic(low, high, ends);
    double left = f.g(ends[0], slope);
    for (int i = 1; i < n; ++i) {
      const double right = f.g(ends[i], slope);
      const bool crossed = (left < 0) != (right < 0);
      const bool rising = left < 0;
      left = right;
      if (!crossed || middle + ends[i] / speed <= 0) continue;
      const double s = bracketed_root(ends[i - 1], ends[i], rising, [&f](double x, double& slope1) { return f.g(x, slope1); });
      const float t = float(middle + s / speed);
      if (!(t > 0)) continue;
      if (!(t < ray.maximum)) return false;
      hit.distance = t;
      hit.primitive = 0;
      hit.u = 0;
      hit.v = 0;
      return true;
    }
    return false;
  }

  void local_point(const Ray& ray, const Hit& hit, LocalPoint& p) const override {
    const DoubleRay r(ray);
    const double t = double(hit.distance), x = r.at(t, 0), y = r.at(t, 1), z = r.at(t, 2);
    const double out = std::sqrt(x * x + y * y), away = out - double(radius), tube = std::sqrt(away * away + z * z);
    if (!(out > 0 && tube > 0)) return point_at(1, 0, 1, 0, p);  // only if, in float precision, the tube has no thickness
    point_at(x / out, y / out, away / tube, z / tube, p);
  }

  double local_area() const override { return 4 * M_PI * M_PI * double(radius) * double(tube_radius); }

  // The area element is r (R + r cos psi) dphi dpsi. The fraction of the area up to psi is (psi + k sin psi) / (2 pi) with k =
  // r / R: Kepler's equation.
  float local_sample(Point2 u, LocalPoint& p) const override {
    const double k = double(tube_radius) / double(radius), phi = 2 * M_PI * double(u.x), mean = 2 * M_PI * double(u.y);
    const double psi = bracketed_root(mean - k, mean + k, true, [=](double x, double& slope) {
      slope = 1 + k * std::cos(x);
      return x + k * std::sin(x) - mean;
    });
    point_at(std::cos(phi), std::sin(phi), std::cos(psi), std::sin(psi), p);
    return float(1 / local_area());
  }

 private:
  /// Fills the point at an angle around the axis and an angle around the tube, given by their cosines and sines.
  void point_at(double cos_around, double sin_around, double cos_tube, double sin_tube, LocalPoint& p) const {
    const double out = double(radius) + double(tube_radius) * cos_tube, turn = 2 * M_PI, tube = turn * double(tube_radius);
    p.position = {float(out * cos_around), float(out * sin_around), float(double(tube_radius) * sin_tube)};
    p.normal = {float(cos_tube * cos_around), float(cos_tube * sin_around), float(sin_tube)};
    p.uv = {positive_atan2(float(sin_around), float(cos_around)) / (2 * pi),
            positive_atan2(float(sin_tube), float(cos_tube)) / (2 * pi)};
    p.dpdu = {float(-turn * out * sin_around), float(turn * out * cos_around), 0};
    p.dpdv = {float(-tube * sin_tube * cos_around), float(-tube * sin_tube * sin_around), float(tube * cos_tube)};
    // Rounding of the position and of an offset ray origin; intersection itself is in double.
    p.error = rounding_bound(3) * (along(p.normal, abs(p.position - Point3{})) + tube_radius);
  }
};

const Register<Torus> registered;

}  // namespace
}  // namespace etendue
