// OrthographicCamera: a camera with parallel rays.

#include "pose.h"

namespace etendue {
namespace {

// The film is a rectangle of area A through `from`; all rays from its points have the same direction. A pixel's value is the
// mean radiance over its part of the film: W_e is 1 / A times a delta distribution in direction, of which only 1 / A is
// returned; film points have the pdf 1 / A [1/m^2] and directions the probability 1.
class OrthographicCamera final : public Camera {
 public:
  static void describe(Description<OrthographicCamera>& d) {
    d.summary("A camera whose rays are parallel. Right in the picture is the viewing direction times up.")
        .group("Placement")
        .member<&OrthographicCamera::from>("from", "m", "the middle of the film")
        .member<&OrthographicCamera::to>("to", "m", "a point in the middle of the picture")
        .member<&OrthographicCamera::up>("up", "1", "a direction that points upwards in the picture")
        .member<&OrthographicCamera::transform>(
            "transform", "", "moves and turns the camera as from, to and up have placed it; may change with time")
        .group("View")
        .member<&OrthographicCamera::width>("width", "m", "width of what is seen; the height follows from the picture's shape",
                                            more_than(0), soft(0.01, 100), logarithmic);
    describe_clip<&OrthographicCamera::near_clip, &OrthographicCamera::far_clip>(d);
  }

  std::optional<Place> place() const override { return Place{transform.written(shutter_open)(from), length(to - from)}; }
  void prepare() override {
    check_shutter(*this);
    clip_.set(*this, near_clip, far_clip);
    placement_.set(*this, from, to, up, transform);
    update();
  }
  void set_film(int width_in_pixels, int height_in_pixels) override {
    columns_ = float(width_in_pixels);
    rows_ = float(height_in_pixels);
    update();
  }

  Ray ray(Point2 film, Point2, float time) const override {
    const Pose pose = placement_.at(time);
    Ray r;
    r.origin = pose.position + pose.to_world({(film.x - columns_ / 2) * pixel_, (rows_ / 2 - film.y) * pixel_, 0});
    r.direction = pose.forward;
    r.time = time;
    r.width = pixel_;
    clip_.cut(r, 1);
    return r;
  }
  Reach reach(const Ray&) const override { return clip_.reach(1); }

  bool has_lens() const override { return false; }

  bool parallel() const override { return true; }
  std::optional<Point2> film_point(const Ray& r) const override {
    const Pose pose = placement_.at(r.time);
    // Only rays that the camera itself generated have its direction.
    const Vector3 direction = pose.to_camera(normalize(r.direction));
    if (!(direction.z > 0) || std::abs(direction.x) + std::abs(direction.y) > 1e-5f) return std::nullopt;
    return project(pose.to_camera(r.origin - pose.position));
  }

  std::optional<LensSample> sample_lens(const Point3& point, float time, Point2) const override {
    const Pose pose = placement_.at(time);
    const Vector3 seen = pose.to_camera(point - pose.position);
    if (!(seen.z > 0) || !clip_.holds(seen.z)) return std::nullopt;
    const std::optional<Point2> film = project(seen);
    if (!film) return std::nullopt;
    LensSample s;
    s.lens = pose.position + pose.to_world({seen.x, seen.y, 0});
    s.direction = -pose.forward;
    s.distance = seen.z;
    s.pdf = 1;
    s.importance = pdf_;
    s.film = *film;
    s.nearest = clip_.reach(1).nearest;
    return s;
  }

  float importance(const Ray& r) const override { return film_point(r) ? pdf_ : 0; }
  CameraPdf pdf(const Ray& r) const override { return film_point(r) ? CameraPdf{pdf_, 1} : CameraPdf{}; }

  DoublePoint3 from{0, 0, 0}, to{0, 0, 1};
  Vector3 up{0, 1, 0};
  AnimatedTransform transform;
  float width = 1;
  float near_clip = 0, far_clip = 0;

 private:
  void update() {
    pixel_ = width / columns_;
    pdf_ = 1 / (square(pixel_) * columns_ * rows_);
  }
  std::optional<Point2> project(const Vector3& v) const {
    const Point2 film{v.x / pixel_ + columns_ / 2, rows_ / 2 - v.y / pixel_};
    if (film.x >= 0 && film.x < columns_ && film.y >= 0 && film.y < rows_) return film;
    return std::nullopt;
  }

  Placement placement_;
  Clip clip_;
  float columns_ = 1, rows_ = 1;  // of the picture, in pixels
  float pixel_ = 1;               // width of a pixel [m]
  float pdf_ = 1;                 // 1 / area of the film [1/m^2]
};

const Register<OrthographicCamera> registered;

}  // namespace
}  // namespace etendue
