// SphericalCamera: a pinhole camera whose picture covers all directions.

#include "geometry/equal_area_square.h"
#include "pose.h"

namespace etendue {
namespace {

constexpr double exact_pi = 3.14159265358979323846;

// The picture covers the whole sphere; u goes from 0 to 1 across the picture, v from 0 to 1 downwards.
//   equirectangular: the longitude is 2 pi (u - 1/2), from the viewing direction to the right, and the angle from the top pi v.
//     The solid angle is dw = sin(theta) dtheta dphi = 2 pi^2 sin(theta) du dv, so uniform film points have the pdf
//     p = 1 / (2 pi^2 sin(theta)) [1/sr].
//   equal_area: the mapping of equal_area_square.h, with the viewing direction in the middle; p = 1 / (4 pi) everywhere.
//
// The pinhole faces all directions equally, so there is no cosine. A pixel's value is the mean radiance of its rays, so
// W_e = p: its integral over directions is 1. For a point at distance d, the factor from area at the point to solid angle at
// the pinhole is contained in LensSample::pdf = d^2.
class SphericalCamera final : public Camera {
 public:
  static void describe(Description<SphericalCamera>& d) {
    d.summary("A camera that sees in all directions, from one place. Such a picture can be the file of an EnvironmentEmission.",
              "Clarberg 2008, Fast equal-area mapping of the (hemi)sphere using SIMD")
        .group("Placement")
        .member<&SphericalCamera::from>("from", "m", "where the camera is")
        .member<&SphericalCamera::to>("to", "m", "a point in the middle of the picture")
        .member<&SphericalCamera::up>("up", "1", "a direction that points upwards in the picture")
        .member<&SphericalCamera::transform>(
            "transform", "", "moves and turns the camera as from, to and up have placed it; may change with time")
        .group("View")
        .member<&SphericalCamera::mapping>(
            "mapping", "",
            "how directions lie in the picture; equirectangular: in longitude and latitude, with what is above along the top "
            "edge, "
            "for pictures twice as wide as high; equal_area: so that all pixels have the same solid angle, with what is behind "
            "in the corners, for square pictures",
            choices("equirectangular", "equal_area"));
  }

  std::optional<Place> place() const override { return Place{transform.written(shutter_open)(from), length(to - from)}; }
  void prepare() override {
    check_shutter(*this);
    placement_.set(*this, from, to, up, transform);
  }
  void set_film(int width, int height) override {
    width_ = width;
    height_ = height;
  }

  Ray ray(Point2 film, Point2, float time) const override {
    const Pose pose = placement_.at(time);
    const double u = double(film.x) / width_, v = double(film.y) / height_;
    Vector3 local;
    if (mapping == Mapping::equal_area) {
      const SquareDirection d = equal_area_direction({u, v});
      local = Vector3{float(d.x), float(-d.y), float(d.z)};
    } else {
      const double longitude = 2 * exact_pi * (u - 0.5), theta = exact_pi * v, sine = std::sin(theta);
      local = Vector3{float(sine * std::sin(longitude)), float(std::cos(theta)), float(sine * std::cos(longitude))};
    }
    Ray r;
    r.origin = pose.position;
    r.direction = pose.to_world(normalize(local));
    r.time = time;
    r.spread = std::sqrt(1 / (pdf_of(local) * float(width_) * float(height_)));  // the side of a square pixel
    return r;
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
    s.importance = pdf_of(local);
    s.film = film_of(local);
    return s;
  }

  // The ray is assumed to pass through the pinhole.
  float importance(const Ray& r) const override { return pdf_of(local_direction(r)); }
  CameraPdf pdf(const Ray& r) const override { return {1, pdf_of(local_direction(r))}; }

  DoublePoint3 from{0, 0, 0}, to{0, 0, 1};
  Vector3 up{0, 1, 0};
  AnimatedTransform transform;
  enum class Mapping : std::uint8_t { equirectangular, equal_area };
  Mapping mapping = Mapping::equirectangular;

 private:
  Vector3 local_direction(const Ray& r) const { return placement_.at(r.time).to_camera(normalize(r.direction)); }

  /// The pdf of a unit direction in camera coordinates [1/sr].
  float pdf_of(const Vector3& d) const {
    if (mapping == Mapping::equal_area) return 1 / (4 * pi);
    const float sine = std::hypot(d.x, d.z);
    return float(1 / (2 * exact_pi * exact_pi)) / std::max(sine, 1e-12f);
  }

  Point2 film_of(const Vector3& d) const {
    double u = 0, v = 0;
    if (mapping == Mapping::equal_area) {
      const SquarePlace p = equal_area_place({double(d.x), -double(d.y), double(d.z)});
      u = p.x, v = p.y;
    } else {
      u = 0.5 + std::atan2(double(d.x), double(d.z)) / (2 * exact_pi);
      v = std::atan2(std::hypot(double(d.x), double(d.z)), double(d.y)) / exact_pi;
    }
    // Points on the right and lower edge of the picture are moved into the last pixel.
    return {std::min(float(u * width_), std::nextafter(float(width_), 0.0f)),
            std::min(float(v * height_), std::nextafter(float(height_), 0.0f))};
  }

  Placement placement_;
  int width_ = 1, height_ = 1;  // of the picture, in pixels
};

const Register<SphericalCamera> registered;

}  // namespace
}  // namespace etendue
