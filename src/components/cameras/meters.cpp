// IrradianceMeter and RadianceMeter: cameras whose mean over the picture is the measured quantity.

#include "etendue/meter.h"
#include "pose.h"

namespace etendue {
namespace {

constexpr double exact_pi = 3.14159265358979323846;

/// A position in the unit disc.
struct DiscPoint {
  double x, y;
};

// The concentric map of Shirley & Chiu 1997 from the square [-1, 1]^2 to the disc, and back. Equal areas stay equal.
DiscPoint to_disc(double a, double b) {
  if (a == 0 && b == 0) return {0, 0};
  if (std::abs(a) > std::abs(b)) return {a * std::cos(exact_pi / 4 * b / a), a * std::sin(exact_pi / 4 * b / a)};
  return {b * std::sin(exact_pi / 4 * a / b), b * std::cos(exact_pi / 4 * a / b)};
}
DiscPoint to_square(DiscPoint d) {
  const double r = std::hypot(d.x, d.y);
  if (r == 0) return {0, 0};
  if (std::abs(d.x) > std::abs(d.y)) {
    const double a = std::copysign(r, d.x);
    return {a, a * std::atan(d.y / d.x) * 4 / exact_pi};
  }
  const double b = std::copysign(r, d.y);
  return {b * std::atan(d.x / d.y) * 4 / exact_pi, b};
}

// A meter at a point looks along an axis. The picture is a square that the concentric map takes to the unit disc, so that
// uniform film points are uniform in the disc. Subclasses map the radius r in the disc to the angle theta from the axis:
//   IrradianceMeter: sin(theta) = r. The disc's area element is r dr dphi = cos(theta) dw, so film points have the pdf
//     p = cos(theta) / pi [1/sr], and the picture's mean is int p L dw = E / pi with the irradiance E = int L cos(theta) dw.
//   RadianceMeter: 1 - cos(theta) = r^2 (1 - cos(alpha)) with the cone's half angle alpha: p = 1 / (2 pi (1 - cos(alpha))) is
//     constant, and the picture's mean is the mean radiance over the cone.
// As for the SphericalCamera, a pixel's value is the mean radiance of its rays, W_e = p, and the factor from area at a scene
// point to solid angle at the meter is contained in LensSample::pdf = d^2. There is no cosine at the pinhole: p contains it.
class PointMeter : public Camera, public Meter {
 public:
  using Parent = Camera;

  std::optional<Place> place() const override { return Place{transform.written(shutter_open)(from), 1}; }
  void set_film(int width, int height) override {
    width_ = width;
    height_ = height;
  }

  Ray ray(Point2 film, Point2, float time) const override {
    const Pose pose = placement_.at(time);
    const DiscPoint d = to_disc(2 * double(film.x) / width_ - 1, 2 * double(film.y) / height_ - 1);
    const double r = std::min(std::hypot(d.x, d.y), 1.0), z = cosine_at(r);
    const double sine = std::sqrt(std::max((1 - z) * (1 + z), 0.0)), scale = r > 0 ? sine / r : 0;
    const Vector3 local{float(scale * d.x), float(-scale * d.y), float(z)};
    Ray sent;
    sent.origin = pose.position;
    sent.direction = pose.to_world(normalize(local));
    sent.time = time;
    // The side of a square with the solid angle of a pixel; towards the horizon of a hemisphere at most a right angle.
    sent.spread = std::min(std::sqrt(1 / (std::max(pdf_of(local), 1e-6f) * float(width_) * float(height_))), 1.0f);
    return sent;
  }

  bool has_lens() const override { return false; }
  std::optional<Point2> film_point(const Ray& r) const override { return film_of(local_direction(r)); }

  std::optional<LensSample> sample_lens(const Point3& point, float time, Point2) const override {
    const Pose pose = placement_.at(time);
    const Vector3 to_point = point - pose.position;
    LensSample s;
    s.distance = length(to_point);
    if (!(s.distance > 0)) return std::nullopt;
    s.lens = pose.position;
    s.direction = -1 / s.distance * to_point;
    s.pdf = square(s.distance);
    const Vector3 local = pose.to_camera(-s.direction);
    const std::optional<Point2> film = film_of(local);
    if (!film) return std::nullopt;
    s.importance = pdf_of(local);
    s.film = *film;
    return s;
  }

  // The ray is assumed to pass through the pinhole.
  float importance(const Ray& r) const override { return pdf(r).direction; }
  CameraPdf pdf(const Ray& r) const override {
    const Vector3 local = local_direction(r);
    return film_of(local) ? CameraPdf{1, pdf_of(local)} : CameraPdf{};
  }

  DoublePoint3 from{0, 0, 0};
  AnimatedTransform transform;

 protected:
  /// The cosine of the angle from the axis at a radius in the disc.
  virtual double cosine_at(double r) const = 0;
  /// The radius in the disc of a unit direction in the meter's coordinates; empty: it is not seen.
  virtual std::optional<double> radius_of(const Vector3& local) const = 0;
  /// The pdf of a direction that is seen [1/sr].
  virtual float pdf_of(const Vector3& local) const = 0;

  void place_along(const DoublePoint3& to) {
    check_shutter(*this);
    // How the picture is turned about the axis does not matter for its mean; up is upwards unless the axis is vertical.
    const Vector3 axis(to - from);
    const bool vertical = length(axis) > 0 && std::abs(axis.y) > 0.99f * length(axis);
    placement_.set(*this, from, to, vertical ? Vector3{0, 0, 1} : Vector3{0, 1, 0}, transform);
  }

 private:
  Vector3 local_direction(const Ray& r) const { return placement_.at(r.time).to_camera(normalize(r.direction)); }

  std::optional<Point2> film_of(const Vector3& d) const {
    const std::optional<double> radius = radius_of(d);
    if (!radius) return std::nullopt;
    const double sine = std::hypot(double(d.x), double(d.y)), scale = sine > 0 ? std::min(*radius, 1.0) / sine : 0;
    const DiscPoint square = to_square({scale * double(d.x), -scale * double(d.y)});
    const auto pixel = [](double a, int count) {
      // Points on the right and lower edge of the picture are moved into the last pixel.
      return std::clamp(float((a + 1) / 2 * count), 0.0f, std::nextafter(float(count), 0.0f));
    };
    return Point2{pixel(square.x, width_), pixel(square.y, height_)};
  }

  Placement placement_;
  int width_ = 1, height_ = 1;  // of the picture, in pixels
};

class IrradianceMeter final : public PointMeter {
 public:
  static void describe(Description<IrradianceMeter>& d) {
    d.summary(
         "Measures the irradiance at a point of a plane: `etendue measure` prints it in W/m2 and lux. As a camera it sees a "
         "hemisphere, each pixel with the same projected solid angle; the mean over the picture times pi is the irradiance.",
         "Nusselt 1928, Graphische Bestimmung des Winkelverhältnisses bei der Wärmestrahlung; Shirley & Chiu 1997, A low "
         "distortion map between disk and square")
        .group("Placement")
        .member<&IrradianceMeter::from>("from", "m", "the point, a little above the surface if it lies on one")
        .member<&IrradianceMeter::normal>("normal", "1", "the plane's normal: the light from its side counts")
        .member<&IrradianceMeter::transform>("transform", "", "moves and turns the meter; may change with time");
  }
  void prepare() override {
    if (!is_finite(normal) || !(length(normal) > 0)) fail("normal", "must be a direction other than zero");
    const Vector3 unit = normalize(normal);
    place_along(from + DoubleVector3(unit));
  }
  MeterQuantity measures() const override { return {"irradiance", "illuminance", exact_pi, "W/m2", "lx"}; }

  Vector3 normal{0, 1, 0};

 protected:
  double cosine_at(double r) const override { return std::sqrt(std::max((1 - r) * (1 + r), 0.0)); }
  std::optional<double> radius_of(const Vector3& d) const override {
    if (!(d.z > 0)) return std::nullopt;
    return std::hypot(double(d.x), double(d.y));
  }
  float pdf_of(const Vector3& d) const override { return float(double(d.z) / exact_pi); }
};

class RadianceMeter final : public PointMeter {
 public:
  static void describe(Description<RadianceMeter>& d) {
    d.summary(
         "Measures the mean radiance in a cone of directions, as a spot meter does: `etendue measure` prints it in W/(m2 sr) "
         "and cd/m2. As a camera it sees the cone, each pixel with the same solid angle.",
         "Shirley & Chiu 1997, A low distortion map between disk and square")
        .group("Placement")
        .member<&RadianceMeter::from>("from", "m", "the tip of the cone")
        .member<&RadianceMeter::to>("to", "m", "a point on the cone's axis")
        .member<&RadianceMeter::transform>("transform", "", "moves and turns the meter; may change with time")
        .group("View")
        .member<&RadianceMeter::angle>("angle", "deg", "between opposite sides of the cone", range(0.01, 360));
  }
  void prepare() override {
    // 1 - cos(alpha) = 2 sin^2(alpha / 2) keeps its digits for narrow cones.
    const double half = std::sin(double(angle) * exact_pi / 720);
    opening_ = 2 * half * half;
    place_along(to);
  }
  MeterQuantity measures() const override { return {"radiance", "luminance", 1, "W/(m2 sr)", "cd/m2"}; }

  DoublePoint3 to{0, 0, 1};
  float angle = 1;  // [deg]

 protected:
  double cosine_at(double r) const override { return 1 - r * r * opening_; }
  std::optional<double> radius_of(const Vector3& d) const override {
    const double sine2 = double(d.x) * double(d.x) + double(d.y) * double(d.y), z = double(d.z);
    const double less = z > 0 ? sine2 / (1 + z) : 1 - z;  // 1 - cos(theta)
    if (!(less <= opening_)) return std::nullopt;
    return std::sqrt(less / opening_);
  }
  float pdf_of(const Vector3&) const override { return float(1 / (2 * exact_pi * opening_)); }

 private:
  double opening_ = 1;  // 1 - cos(alpha)
};

const Register<IrradianceMeter> irradiance_meter;
const Register<RadianceMeter> radiance_meter;

}  // namespace
}  // namespace etendue
