// PerspectiveCamera: a camera with a pinhole or a thin lens.

#include "etendue/core/warp.h"
#include "pose.h"

namespace etendue {
namespace {

// Film points stand for points of a rectangle at distance 1 in front of the lens' centre, of area A. A film point and a
// lens point give the ray from the lens point to the film point's image, `focus_distance` times farther along the ray
// through the centre.
//
// Pdfs. Film points uniform over A are, on the plane of focus at distance d, uniform over A d^2. From a lens point, in a
// direction at the angle theta to the axis, the plane of focus is at distance d / cos: the pdf per solid angle is
// (d / cos)^2 / (A d^2 cos) = 1 / (A cos^3) for all lens points. Lens points have the pdf 1 / A_lens.
//
// Importance (Veach 1997, section 8.2.2; Pharr, Jakob & Humphreys, section 16.1.1): a pixel's value is the mean radiance
// of its rays, so for the whole film  1 = integral of W_e cos dw dA  with  W_e cos = p_direction p_position:
// W_e = 1 / (A A_lens cos^4); for a pinhole the same without A_lens.

enum class Axis : std::uint8_t { smaller, larger, width, height, diagonal };

class PerspectiveCamera final : public Camera {
 public:
  static void describe(Description<PerspectiveCamera>& d) {
    d.summary("A camera with a pinhole or a thin lens. Right in the picture is the viewing direction times up.",
              "Kolb, Mitchell & Hanrahan 1995, A realistic camera model for computer graphics, section 2 (thin lens)")
        .group("Placement")
        .member<&PerspectiveCamera::from>("from", "m", "where the camera is")
        .member<&PerspectiveCamera::to>("to", "m", "a point in the middle of the picture")
        .member<&PerspectiveCamera::up>("up", "1", "a direction that points upwards in the picture")
        .member<&PerspectiveCamera::transform>(
            "transform", "", "moves and turns the camera as from, to and up have placed it; may change with time")
        .group("View")
        .member<&PerspectiveCamera::fov>("fov", "deg", "angle of view", Range{0, 179, true}, soft(10, 120),
                                         unless("focal_length"))
        .member<&PerspectiveCamera::fov_axis>(
            "fov_axis", "", "the side of the picture the angle of view, or the size of the sensor, is measured across",
            choices("smaller", "larger", "width", "height", "diagonal"))
        .member<&PerspectiveCamera::focal_length>(
            "focal_length", "m",
            "instead of an angle: the distance from the lens to a sensor that is as large as `sensor_size` says, as cameras "
            "state it; 0: `fov` counts",
            at_least(0), soft(0.01, 0.2), logarithmic)
        .member<&PerspectiveCamera::sensor_size>("sensor_size", "m",
                                                 "of the sensor across fov_axis; the default is the diagonal of 35 mm film",
                                                 more_than(0), soft(0.005, 0.06), when("focal_length"))
        .member<&PerspectiveCamera::principal_point>(
            "principal_point", "1",
            "where the axis meets the picture, from its middle: to the right in parts of its width, downwards in parts of its "
            "height, as of a lens that is shifted")
        .group("Lens")
        .member<&PerspectiveCamera::lens_radius>("lens_radius", "m", "radius of the lens; 0: a pinhole, all is sharp",
                                                 at_least(0), soft(0.0005, 0.1), logarithmic)
        .member<&PerspectiveCamera::focus_distance>(
            "focus_distance", "m", "distance of the plane of sharp focus, along the axis; 0: at the point `to`", at_least(0),
            soft(0.1, 100), logarithmic, when("lens_radius"));
    describe_clip<&PerspectiveCamera::near_clip, &PerspectiveCamera::far_clip>(d);
  }

  std::optional<Place> place() const override { return Place{transform.written(shutter_open)(from), length(to - from)}; }
  void prepare() override {
    check_shutter(*this);
    clip_.set(*this, near_clip, far_clip);
    if (!(std::isfinite(principal_point.x) && std::isfinite(principal_point.y)))
      fail("principal_point", "must be finite numbers");
    if (!std::isfinite(focal_length)) fail("focal_length", "must be finite");
    if (!std::isfinite(sensor_size)) fail("sensor_size", "must be finite");
    placement_.set(*this, from, to, up, transform);
    focus_ = focus_distance > 0 ? focus_distance : float(length(to - from));
    update();
  }
  void set_film(int width, int height) override {
    width_ = float(width);
    height_ = float(height);
    update();
  }

  Ray ray(Point2 film, Point2 lens, float time) const override {
    const Pose pose = placement_.at(time);
    Vector3 direction{(2 * (film.x / width_ - principal_point.x) - 1) * half_width_,
                      (1 - 2 * (film.y / height_ - principal_point.y)) * half_height_, 1};
    Ray r;
    r.origin = pose.position;
    if (lens_radius > 0) {
      const Point2 l = warp::disc(lens);
      const Vector3 offset{lens_radius * l.x, lens_radius * l.y, 0};
      r.origin = r.origin + pose.to_world(offset);
      direction = direction - offset / focus_;
    }
    const float inverse_length = inverse_sqrt(length_squared(direction));
    r.direction = pose.to_world(inverse_length * direction);
    r.time = time;
    r.spread = pixel_ * inverse_length;
    clip_.cut(r, inverse_length);
    return r;
  }
  Reach reach(const Ray& r) const override { return clip_.reach(dot(placement_.at(r.time).forward, r.direction)); }

  bool has_lens() const override { return lens_radius > 0; }

  std::optional<Point2> film_point(const Ray& r) const override {
    const Seen seen = look(r);
    return seen.on_film ? std::optional(seen.film) : std::nullopt;
  }

  std::optional<LensSample> sample_lens(const Point3& point, float time, Point2 u) const override {
    const Pose pose = placement_.at(time);
    const Point2 l = lens_radius > 0 ? warp::disc(u) : Point2{};
    const Vector3 offset{lens_radius * l.x, lens_radius * l.y, 0};
    const Vector3 to_point = pose.to_camera(point - pose.position) - offset;
    if (!(to_point.z > 0) || !clip_.holds(to_point.z)) return std::nullopt;
    Seen seen;
    project(offset, to_point, seen);
    if (!seen.on_film) return std::nullopt;
    LensSample s;
    s.lens = pose.position + pose.to_world(offset);
    s.distance = length(to_point);
    s.direction = pose.to_world(-1 / s.distance * to_point);
    const float cosine = to_point.z / s.distance;
    s.pdf = square(s.distance) * lens_pdf_ / cosine;
    s.importance = importance_of(cosine);
    s.film = seen.film;
    s.nearest = clip_.reach(cosine).nearest;
    return s;
  }

  float importance(const Ray& r) const override {
    const Seen seen = look(r);
    return seen.on_film ? importance_of(seen.cosine) : 0;
  }
  CameraPdf pdf(const Ray& r) const override {
    const Seen seen = look(r);
    if (!seen.on_film) return {};
    return {lens_pdf_, 1 / (area_ * seen.cosine * square(seen.cosine))};
  }

  DoublePoint3 from{0, 0, 0}, to{0, 0, 1};
  Vector3 up{0, 1, 0};
  AnimatedTransform transform;
  float fov = 40;
  Axis fov_axis = Axis::smaller;
  float focal_length = 0, sensor_size = 0.0432666f;  // the diagonal of 36 mm by 24 mm
  Vector2 principal_point{0, 0};
  float lens_radius = 0, focus_distance = 0;
  float near_clip = 0, far_clip = 0;

 private:
  struct Seen {
    bool on_film = false;
    Point2 film;
    float cosine = 0;
  };

  void update() {
    const bool across_width = fov_axis == Axis::width || (fov_axis == Axis::smaller && width_ <= height_) ||
                              (fov_axis == Axis::larger && width_ >= height_);
    const float across = focal_length > 0 ? sensor_size / (2 * focal_length) : std::tan(radians(fov) / 2),
                side = across_width ? width_ : height_,
                half = fov_axis == Axis::diagonal ? across * side / std::hypot(width_, height_) : across;
    half_width_ = across_width ? half : half * width_ / height_;
    half_height_ = across_width ? half * height_ / width_ : half;
    area_ = 4 * half_width_ * half_height_;
    pixel_ = 2 * half_width_ / width_;
    lens_pdf_ = lens_radius > 0 ? 1 / (pi * square(lens_radius)) : 1;
  }

  float importance_of(float cosine) const { return lens_pdf_ / (area_ * square(square(cosine))); }

  /// The film point of a ray from a point of the lens, in camera coordinates.
  void project(const Vector3& lens, const Vector3& direction, Seen& seen) const {
    const float x = direction.x / direction.z + lens.x / focus_, y = direction.y / direction.z + lens.y / focus_;
    seen.film = {((x / half_width_ + 1) / 2 + principal_point.x) * width_,
                 ((1 - y / half_height_) / 2 + principal_point.y) * height_};
    seen.on_film = seen.film.x >= 0 && seen.film.x < width_ && seen.film.y >= 0 && seen.film.y < height_;
  }

  /// The film point of a ray that leaves the lens. For a pinhole the ray is assumed to pass through the pinhole.
  Seen look(const Ray& r) const {
    Seen seen;
    const Pose pose = placement_.at(r.time);
    const Vector3 direction = pose.to_camera(r.direction);
    if (!(direction.z > 0)) return seen;
    Vector3 lens;
    if (lens_radius > 0) {
      const Vector3 start = pose.to_camera(r.origin - pose.position);
      lens = start - (start.z / direction.z) * direction;
      lens.z = 0;
      if (length_squared(lens) > square(lens_radius * 1.0001f)) return seen;
    }
    project(lens, direction, seen);
    seen.cosine = direction.z / length(direction);
    return seen;
  }

  Placement placement_;
  Clip clip_;
  float width_ = 1, height_ = 1;            // of the picture, in pixels
  float half_width_ = 1, half_height_ = 1;  // of the film at distance 1
  float area_ = 4, pixel_ = 1;              // of the film, and width of a pixel, at distance 1
  float focus_ = 1;                         // [m]
  float lens_pdf_ = 1;                      // [1/m^2]; 1 for a pinhole
};

const Register<PerspectiveCamera> registered;

}  // namespace
}  // namespace etendue
