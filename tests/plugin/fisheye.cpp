// A camera out of tree: a fisheye, whose picture is a disc in which the distance from the middle is the angle from the axis.
#include "etendue/camera.h"

using namespace etendue;

// The equidistant projection (Miyamoto 1964, Fish eye lens): a direction at the angle t from the axis has its film point at the
// distance r = f t [pixels] from the middle of the film, f = R / (fov / 2), R the radius of the picture's disc. The area
// element of the film is r dr dphi = f^2 t dt dphi and the solid angle is sin(t) dt dphi, so that film points uniform over the
// w h pixels of the film have the pdf
//     p = f^2 t / (w h sin(t))  [1/sr].
// A pixel's value is the mean radiance of its rays. The pinhole faces all directions alike, without a cosine: W_e = p. Its area
// pdf is 1; seen from a point at distance d, the pinhole has the pdf d^2 [1/sr].
class FisheyeCamera final : public Camera {
  DoublePoint3 from{0, 0, 0}, to{0, 0, 1};
  Vector3 up{0, 1, 0};
  float fov = 180;
  bool full_frame = false;

 public:
  static void describe(Description<FisheyeCamera>& d) {
    d.summary("A fisheye: all directions up to an angle from the axis, in a disc.", "Miyamoto 1964, Fish eye lens")
        .member<&FisheyeCamera::from>("from", "m", "where the camera is")
        .member<&FisheyeCamera::to>("to", "m", "a point in the middle of the picture")
        .member<&FisheyeCamera::up>("up", "1", "a direction that points upwards in the picture")
        .member<&FisheyeCamera::fov>("fov", "deg", "angle across the disc", Range{0, 360, true})
        .member<&FisheyeCamera::full_frame>("full_frame", "",
                                            "whether the disc reaches to the corners, not to the nearer edges");
  }
  std::optional<Place> place() const override { return Place{from, length(to - from)}; }
  void prepare() override {
    if (!is_finite(from)) fail("from", "must be finite");
    const DoubleVector3 way = to - from;
    if (!is_finite(to) || !(length(way) > 0)) fail("to", "must be finite, and another point than from");
    forward_ = Vector3(1 / length(way) * way);
    if (!is_finite(up) || !(length(cross(forward_, up)) > 1e-5f * length(up))) fail("up", "must not be along the axis");
    if (!(shutter_close >= shutter_open)) fail("shutter_close", "must not be before shutter_open");
    if (shutter_opening + shutter_closing > 1.00001f * (shutter_close - shutter_open))
      fail("shutter_closing", "opening and closing must not take longer than the shutter is open");
    right_ = normalize(cross(forward_, up));
    up_ = cross(right_, forward_);
    position_ = Point3(DoublePoint3{} + (from - rendering_origin));
  }
  void set_film(int width, int height) override { w_ = float(width), h_ = float(height); }

  Ray ray(Point2 film, Point2, float time) const override {
    const float x = film.x - w_ / 2, y = h_ / 2 - film.y, r = std::hypot(x, y), t = std::min(r / scale(), pi);
    const float sine = r > 0 ? std::sin(t) / r : 0;
    Ray ray;
    ray.origin = position_;
    ray.direction = normalize(sine * x * right_ + sine * y * up_ + std::cos(t) * forward_);
    ray.time = time;
    ray.spread = std::sqrt(1 / (density(t) * w_ * h_));  // the side of a square pixel
    return ray;
  }
  bool sample_ray(Point2 film, Point2 lens, float time, Wavelengths&, CameraRay& sample) const override {
    sample.ray = ray(film, lens, time);
    return std::hypot(film.x - w_ / 2, film.y - h_ / 2) <= radius();  // outside the disc the picture is black
  }
  bool has_lens() const override { return false; }
  std::optional<Point2> film_point(const Ray& r) const override { return film_of(r.direction); }
  std::optional<LensSample> sample_lens(const Point3& point, float, Point2) const override {
    const Vector3 v = point - position_;
    const float d = length(v);
    const std::optional<Point2> film = d > 0 ? film_of(v) : std::nullopt;
    if (!film) return std::nullopt;
    return LensSample{position_, v / -d, d, d * d, density(angle(v)), *film, 0};
  }
  float importance(const Ray& r) const override { return film_of(r.direction) ? density(angle(r.direction)) : 0; }
  CameraPdf pdf(const Ray& r) const override { return {film_of(r.direction) ? 1.0f : 0.0f, importance(r)}; }

 private:
  float radius() const { return (full_frame ? std::hypot(w_, h_) : std::min(w_, h_)) / 2; }  // R [pixels]
  float scale() const { return radius() / (radians(fov) / 2); }                              // f [pixels/rad]
  float angle(const Vector3& v) const { return std::atan2(std::hypot(dot(v, right_), dot(v, up_)), dot(v, forward_)); }
  float density(float t) const { return square(scale()) / (w_ * h_) * (t > 0 ? t / std::max(std::sin(t), 1e-6f) : 1); }
  std::optional<Point2> film_of(const Vector3& v) const {
    const float x = dot(v, right_), y = dot(v, up_), sine = std::hypot(x, y), r = scale() * angle(v);
    if (r > radius()) return std::nullopt;
    const Point2 film = sine > 0 ? Point2{w_ / 2 + r * x / sine, h_ / 2 - r * y / sine} : Point2{w_ / 2, h_ / 2};
    return film.x >= 0 && film.x < w_ && film.y >= 0 && film.y < h_ ? std::optional(film) : std::nullopt;
  }

  Point3 position_;
  Vector3 right_{-1, 0, 0}, up_{0, 1, 0}, forward_{0, 0, 1};
  float w_ = 1, h_ = 1;  // size of the film [pixels]
};

static const Register<FisheyeCamera> registered;
