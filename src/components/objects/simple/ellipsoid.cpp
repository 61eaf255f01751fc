// Ellipsoid: a sphere, stretched along the axes.

#include "etendue/core/warp.h"
#include "geometry/placed_object.h"
#include "geometry/visible_directions.h"

namespace etendue {
namespace {

/// Carlson's symmetric integral R_G of the second kind, of positive numbers, to about 1e-14. By duplication (Carlson 1995,
/// "Numerical computation of real or complex elliptic integrals"): the theorem brings the arguments of R_F and R_D
/// together, where a Taylor series holds. With the middle argument as z no term of
///   2 R_G = z R_F - (x - z) (y - z) R_D / 3 + sqrt(x y / z)                                      (DLMF 19.21.10)
/// is negative.
double carlson_g(double x, double z, double y) {
  if (x > z) std::swap(x, z);
  if (z > y) std::swap(z, y);
  if (x > z) std::swap(x, z);
  double fx = x, fy = y, fz = z, sum = 0, factor = 1;
  double xf = 0, yf = 0, zf = 0, mean_f = 1, xd = 0, yd = 0, zd = 0, mean_d = 1;
  for (int i = 0; i < 200; ++i) {
    mean_f = (fx + fy + fz) / 3;
    mean_d = (fx + fy + 3 * fz) / 5;
    xf = 1 - fx / mean_f, yf = 1 - fy / mean_f, zf = -xf - yf;
    xd = 1 - fx / mean_d, yd = 1 - fy / mean_d, zd = -(xd + yd) / 3;
    if (std::max({std::abs(xd), std::abs(yd), std::abs(zd)}) < 1e-3) break;
    const double sx = std::sqrt(fx), sy = std::sqrt(fy), sz = std::sqrt(fz), lambda = sx * sy + sy * sz + sz * sx;
    sum += factor / (sz * (fz + lambda));
    factor /= 4;
    fx = (fx + lambda) / 4;
    fy = (fy + lambda) / 4;
    fz = (fz + lambda) / 4;
  }
  const double e2f = xf * yf - zf * zf, e3f = xf * yf * zf;
  const double rf = (1 - e2f / 10 + e3f / 14 + e2f * e2f / 24 - 3 * e2f * e3f / 44) / std::sqrt(mean_f);
  const double xy = xd * yd, zz = zd * zd;
  const double e2 = xy - 6 * zz, e3 = (3 * xy - 8 * zz) * zd, e4 = 3 * (xy - zz) * zz, e5 = xy * zz * zd;
  const double series = 1 - 3 * e2 / 14 + e3 / 6 + 9 * e2 * e2 / 88 - 3 * e4 / 22 - 9 * e2 * e3 / 52 + 3 * e5 / 26;
  const double rd = factor * series / (mean_d * std::sqrt(mean_d)) + 3 * sum;
  return 0.5 * (z * rf - (x - z) * (y - z) * rd / 3 + std::sqrt(x / z * y));
}

// Points are centre + radii * s with s on the unit sphere; most is done there.
class Ellipsoid final : public PlacedObject {
 public:
  static void describe(Description<Ellipsoid>& d) {
    d.summary(
         "An ellipsoid with its axes along x, y and z. Surface coordinates are those of the sphere it is stretched from: u "
         "around "
         "z from +x towards +y, v from the pole at -z to that at +z.",
         "area: Carlson 1995, \"Numerical computation of real or complex elliptic integrals\"; the cone in which it is seen: "
         "Heitz "
         "2017, \"Analytical calculation of the solid angle subtended by an arbitrarily positioned ellipsoid to a point "
         "source\"")
        .group("Shape")
        .member<&Ellipsoid::centre>("centre", "m", "its centre", Effect::rebuild)
        .member<&Ellipsoid::radii>("radii", "m", "its half axes along x, y and z", Effect::rebuild);
  }

  void prepare() override {
    if (!is_finite(centre)) fail("centre", "must be finite");
    for (int k = 0; k < 3; ++k)
      if (!(radii[k] > 0 && radii[k] < infinity)) fail("radii", "all must be positive and finite");
    transform.count_from(transform.outer(), centre);
    area_ = area_under(Transform());
    if (!(float(area_) > 0 && float(area_) < infinity)) fail("radii", "the ellipsoid is too small or too large");
    const double a = double(radii.x), b = double(radii.y), c = double(radii.z), sum = a * b + b * c + c * a;
    share_[0] = b * c / sum;
    share_[1] = c * a / sum;
    share_[2] = a * b / sum;
    flat_ = std::max({a, b, c}) > 2 * std::min({a, b, c});
    placed_area_ = float(area_under(transform.still()));
    place();
  }

  bool closed() const override { return true; }

  float area(float time) const override { return transform.animated() ? float(area_under(transform.at(time))) : placed_area_; }
  float area_error(float) const override { return 0; }

  // Directions are uniform in the cone in which the unit sphere is seen from where the inverse of the stretch brings the
  // asking point. A linear map M of directions w -> M w / |M w| enlarges solid angles by |det M| / |M w|^3, and |M w| is the
  // distance outside over that inside.
  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override {
    Transform scratch;
    const Transform& t = placed(transform, time, scratch);
    const Cone cone = seen(t.back(from));
    if (!cone.usable) return sample_by_both(*this, cone.directions(), from, u, time, none, no_density);
    // As for Sphere: alpha is the angle, at the centre, from the axis back to the asking point to the point seen.
    const double h = double(u.x) * cone.one_minus_cosine, sin2 = h * (2 - h);
    const double cos_alpha =
        std::min(1.0, sin2 * cone.distance + (1 - h) * std::sqrt(std::max(0.0, 1 - sin2 * cone.distance * cone.distance)));
    const double sin_alpha = std::sqrt(1 - cos_alpha * cos_alpha), phi = 2 * M_PI * double(u.y);
    const Frame axis(Normal3(float(cone.x / cone.distance), float(cone.y / cone.distance), float(cone.z / cone.distance)));
    const auto x = float(sin_alpha * std::cos(phi)), y = float(sin_alpha * std::sin(phi));
    const Vector3 unit = x * axis.s + y * axis.t + float(cos_alpha) * Vector3(axis.n);
    OwnPoint own;
    point_at(double(unit.x), double(unit.y), double(unit.z), own);
    SurfaceSample s;
    carry(own, time, s.point);
    complete_by_angle(s, from, 1);
    s.density *= cone_density(cone, t, s.distance, s.direction, s.point);
    return s;
  }

  float visible_density(const Point3& from, const Vector3& direction, const SurfacePoint& p) const override {
    Transform scratch;
    const Transform& t = placed(transform, p.time, scratch);
    const Cone cone = seen(t.back(from));
    if (!cone.usable) return density_by_both(cone.directions(), from, direction, p, no_density);
    return cone_density(cone, t, distance(p.position, from), direction, p);
  }

  DoublePoint3 centre{0, 0, 0};
  Vector3 radii{1, 1, 1};

 protected:
  Bounds3 own_bounds() const override {
    Bounds3 box;
    box.add(Point3{} - radii);
    box.add(Point3{} + radii);
    return box;
  }

  bool own_intersect(const Ray& ray, Hit& hit) const override {
    // From the point nearest to the centre, where the discriminant is no difference of large numbers.
    double o[3], d[3], along = 0, dd = 0;
    for (int k = 0; k < 3; ++k) {
      const double inverse = 1 / double(radii[k]);
      o[k] = double(ray.origin[k]) * inverse;
      d[k] = double(ray.direction[k]) * inverse;
      along += o[k] * d[k];
      dd += d[k] * d[k];
    }
    const double middle = -along / dd;
    double rest = 1;
    for (int k = 0; k < 3; ++k) rest -= (o[k] + middle * d[k]) * (o[k] + middle * d[k]);
    if (!(rest > 0)) return false;
    const double half = std::sqrt(rest / dd);
    const float near = float(middle - half), far = float(middle + half), t = near > 0 ? near : far;
    if (!(t > 0 && t < ray.maximum)) return false;
    hit.distance = t;
    hit.primitive = 0;
    hit.u = float((near > 0 ? middle - half : middle + half) - double(t));  // what the float lacks
    hit.v = 0;
    return true;
  }

  void own_point(const Ray& ray, const Hit& hit, OwnPoint& p) const override {
    const DoubleRay r(ray);
    const double t = double(hit.distance) + double(hit.u);
    double s[3];
    for (int k = 0; k < 3; ++k) s[k] = r.at(t, k) / double(radii[k]);
    point_at(s[0], s[1], s[2], p);
  }

  double own_area() const override { return area_; }

  // A nearly round one has its points uniform on the unit sphere. On a flat or long one these would crowd at the rim or the
  // tips; area there is sqrt(sum (w_k s_k)^2) as large, with weights w = (bc, ca, ab), and a mixture of three cosines,
  // sum w_k |s_k|, is between one and sqrt(3) times that.
  float own_sample(Point2 u, OwnPoint& p) const override {
    Vector3 s = warp::sphere(u);
    if (flat_) {
      int k = 0;
      double x = double(u.x);
      while (k < 2 && x >= share_[k]) x -= share_[k++];
      x = std::clamp(2 * x / share_[k], 0.0, 2.0);
      const bool front = x < 1;
      const Vector3 lobe = warp::cosine_hemisphere({std::min(float(front ? x : x - 1), one_minus_epsilon), u.y});
      s[k] = front ? lobe.z : -lobe.z;
      s[(k + 1) % 3] = lobe.x;
      s[(k + 2) % 3] = lobe.y;
    }
    point_at(double(s.x), double(s.y), double(s.z), p);
    return density_at(p.normal);
  }
  float own_density(const SurfacePoint& p) const override { return density_at(p.object_normal); }

 private:
  /// The unit sphere as seen from a point, which is (x, y, z) where the sphere is.
  struct Cone {
    double x = 0, y = 0, z = 0, distance = 0, one_minus_cosine = 0;
    bool usable = false;  ///< not from inside, nor from too close to tell
    DirectionShare directions() const { return {1, distance < 1}; }
  };
  /// What sample_by_both asks for points by area, of which there are none.
  static bool none(Point2, SurfaceSample&) { return false; }
  static float no_density(const SurfacePoint&) { return 0; }

  Cone seen(const Point3& own) const {
    Cone c;
    c.x = double(own.x) / double(radii.x);
    c.y = double(own.y) / double(radii.y);
    c.z = double(own.z) / double(radii.z);
    const double d2 = c.x * c.x + c.y * c.y + c.z * c.z, sin2 = 1 / d2;
    c.distance = std::sqrt(d2);
    c.usable = sin2 < 0.9999;
    if (c.usable) c.one_minus_cosine = sin2 / (1 + std::sqrt(1 - sin2));
    return c;
  }

  /// [1/sr], of a point at a distance [m] outside.
  float cone_density(const Cone& cone, const Transform& t, float distance, const Vector3& direction,
                     const SurfacePoint& p) const {
    if (!(dot(p.normal, direction) < 0)) return 0;  // its far side
    const Vector3 s = t.back(p.position) - Point3{};
    const double x = double(s.x) / double(radii.x) - cone.x, y = double(s.y) / double(radii.y) - cone.y,
                 z = double(s.z) / double(radii.z) - cone.z;
    const double stretch = double(distance) / std::sqrt(x * x + y * y + z * z);
    const double volume = double(std::abs(linear_determinant(t))) * double(radii.x) * double(radii.y) * double(radii.z);
    return float(stretch * stretch * stretch / (volume * 2 * M_PI * cone.one_minus_cosine));
  }

  /// The density of own_sample at a unit normal n here. On the unit sphere area is |radii * n| / (abc) as large, and the
  /// normal along radii * n.
  float density_at(const Normal3& n) const {
    const double x = double(n.x) * double(radii.x), y = double(n.y) * double(radii.y), z = double(n.z) * double(radii.z);
    const double volume = double(radii.x) * double(radii.y) * double(radii.z);
    const double cosines = share_[0] * std::abs(x) + share_[1] * std::abs(y) + share_[2] * std::abs(z);
    return float((flat_ ? cosines / 2 : std::sqrt(x * x + y * y + z * z) / 4) / (M_PI * volume));
  }

  /// The area after a transform, for any affine image is an ellipsoid: 4 pi R_G of the squares of the products of its half
  /// axes, two by two (DLMF 19.33.1). These are the eigenvalues of C^T C, where C has the cofactors of the map from the
  /// unit sphere; by trigonometry (Smith 1961, "Eigenvalues of a symmetric 3 x 3 matrix").
  double area_under(const Transform& t) const {
    const Transform::Matrix& m = t.matrix();
    double l[3][3], c[3][3], g[3][3], scale = 0;
    for (size_t i = 0; i < 3; ++i)
      for (size_t k = 0; k < 3; ++k) {
        l[i][k] = double(m[4 * i + k]) * double(radii[int(k)]);
        scale = std::max(scale, std::abs(l[i][k]));
      }
    for (size_t i = 0; i < 3; ++i)
      for (size_t k = 0; k < 3; ++k) {
        const size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        c[i][k] = (l[i1][k1] / scale) * (l[i2][k2] / scale) - (l[i1][k2] / scale) * (l[i2][k1] / scale);
      }
    for (size_t i = 0; i < 3; ++i)
      for (size_t k = 0; k < 3; ++k) g[i][k] = c[0][i] * c[0][k] + c[1][i] * c[1][k] + c[2][i] * c[2][k];
    const double mean = (g[0][0] + g[1][1] + g[2][2]) / 3, off = g[0][1] * g[0][1] + g[1][2] * g[1][2] + g[2][0] * g[2][0];
    const double x = g[0][0] - mean, y = g[1][1] - mean, z = g[2][2] - mean;
    const double spread = std::sqrt((x * x + y * y + z * z + 2 * off) / 6);
    double high = mean, low = mean;
    if (spread > 1e-15 * mean) {
      const double determinant = x * (y * z - g[1][2] * g[1][2]) - g[0][1] * (g[0][1] * z - g[1][2] * g[2][0]) +
                                 g[2][0] * (g[0][1] * g[1][2] - y * g[2][0]);
      const double angle = std::acos(std::clamp(determinant / (2 * spread * spread * spread), -1.0, 1.0)) / 3;
      high = mean + 2 * spread * std::cos(angle);
      low = mean + 2 * spread * std::cos(angle + 2 * M_PI / 3);
    }
    const double least = 1e-20 * high, middle = 3 * mean - high - low;
    return 4 * M_PI * scale * scale * carlson_g(std::max(low, least), std::max(middle, least), high);
  }

  void point_at(double x, double y, double z, OwnPoint& p) const {
    const double l = 1 / std::sqrt(x * x + y * y + z * z), a = double(radii.x), b = double(radii.y), c = double(radii.z);
    x *= l;
    y *= l;
    z *= l;
    const double nx = x / a, ny = y / b, nz = z / c, support = 1 / std::sqrt(nx * nx + ny * ny + nz * nz);
    p.position = {float(x * a), float(y * b), float(z * c)};
    p.normal = {float(nx * support), float(ny * support), float(nz * support)};
    const double around = std::sqrt(x * x + y * y);
    p.uv = {positive_atan2(float(y), float(x)) / (2 * pi), positive_atan2(float(around), float(-z)) * inverse_pi};
    if (around > 1e-6) {
      p.dpdu = {float(-2 * M_PI * y * a), float(2 * M_PI * x * b), 0};
      const double s = M_PI * z / around;
      p.dpdv = {float(-s * x * a), float(-s * y * b), float(M_PI * around * c)};
    } else {  // at a pole u has no direction: any will do
      p.dpdu = {float(2 * M_PI * a), 0, 0};
      p.dpdv = {0, float(z > 0 ? M_PI * b : -M_PI * b), 0};
    }
    p.primitive = 0;
    // Rounding of the position and of a leaving ray's origin; intersection is in double. `support` is the distance of the
    // tangent plane from the centre: the thickness here.
    const Vector3 here{std::abs(p.position.x), std::abs(p.position.y), std::abs(p.position.z)};
    p.error = rounding_bound(3) * (along(p.normal, here) + float(support));
  }

  double area_ = 4 * M_PI;                      // before the transform [m^2]
  float placed_area_ = 4 * pi;                  // after it, when it is still [m^2]
  double share_[3]{1.0 / 3, 1.0 / 3, 1.0 / 3};  // weights of the three cosines
  bool flat_ = false;                           // or long
};

const Register<Ellipsoid> registered;

}  // namespace
}  // namespace etendue
