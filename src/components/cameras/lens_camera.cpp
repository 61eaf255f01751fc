// LensCamera: a camera that traces rays through the surfaces of a lens.

#include <fmt/format.h>

#include "etendue/core/warp.h"
#include "lens_pupils.h"
#include "pose.h"

namespace etendue {
namespace {

// A ray is given by a point of the film, uniform over the film's area A, and a point of the rectangle of area B that contains
// the exit pupil, on the plane of the rear vertex at distance z from the film. The lens refracts the ray or blocks it. In air a
// bundle of rays has the same étendue dG = dA cos(theta) dw in front of a lens and behind it, whatever its glass (étendue is
// conserved). On the film, with theta the angle to the axis at the film,
//     dG = dA dB cos^4(theta) / z^2,
// so a ray that leaves the lens was sampled with the pdf  p = z^2 / (A B cos^4(theta))  per dG, and per area and solid angle
// with the pdf p cos(theta'), theta' in front of the lens. The irradiance of the film is the integral of L cos(theta) dw over
// the pupil: with the ray's weight cos^4(theta) B / z^2 [sr], the mean over rays is the irradiance. Divided by E_0, the
// irradiance in the middle of the film for radiance 1, a pixel in the middle has the radiance that it sees, and pixels at the
// edges are darker as with such a lens. Hence
//     W_e = weight * p = 1 / (A E_0)
// for all rays that reach the film (or 1 / A when irradiance is measured).
//
// Connections from the scene sample a disc that all transmitted rays cross (LensPupils), and are traced inwards. Glass is
// assumed to reflect and absorb nothing, as is nearly true of coated glass.
class LensCamera final : public Camera {
 public:
  static void describe(Description<LensCamera>& d) {
    d.summary(
         "A camera with a real lens, given by its surfaces: with its depth of field, distortion, vignetting and blur. Right in "
         "the "
         "picture is the viewing direction times up.",
         "Kolb, Mitchell & Hanrahan 1995, A realistic camera model for computer graphics; Steinert, Dammertz, Hanika & Lensch "
         "2011, "
         "General spectral camera lens simulation")
        .group("Placement")
        .member<&LensCamera::from>("from", "m", "where the middle of the film is; the lens is before it")
        .member<&LensCamera::to>("to", "m", "a point in the middle of the picture")
        .member<&LensCamera::up>("up", "1", "a direction that points upwards in the picture")
        .member<&LensCamera::transform>("transform", "",
                                        "moves and turns the camera as from, to and up have placed it; may change with time")
        .group("Lens")
        .member<&LensCamera::file>("file", "",
                                   "a table of the lens (.dat), as text: for each surface, from the front to the film, its "
                                   "radius of curvature (positive "
                                   "when its centre is on the film's side, 0 of a plane), the distance to the next surface, "
                                   "the index of refraction of "
                                   "what is between, and its diameter; # begins a comment. None: the numbers below")
        .member<&LensCamera::surfaces>(
            "surfaces", "1",
            "the same numbers, four for each surface; a plane with the same index on both sides is the stop. The default is "
            "a double Gauss lens of 50 mm, f/2, by Tronnier",
            unless("file"))
        .member<&LensCamera::unit>("unit", "m", "what lengths of the table are given in", more_than(0), soft(1e-4, 2e-3))
        .member<&LensCamera::aperture_diameter>("aperture_diameter", "m", "of the stop; 0: as the table says", at_least(0),
                                                soft(1e-3, 0.05), logarithmic)
        .member<&LensCamera::focus_distance>("focus_distance", "m",
                                             "distance from the film, along the axis, of what is sharp; 0: at the point `to`",
                                             at_least(0), soft(0.25, 100), logarithmic)
        .group("Film")
        .member<&LensCamera::film_diagonal>("film_diagonal", "m", "of the film; the default is that of 35 mm film",
                                            more_than(0), soft(0.005, 0.06))
        .member<&LensCamera::measures>(
            "measures", "",
            "what a pixel is; radiance: in the middle of the picture as bright as what is seen, whatever the stop; "
            "irradiance: that of the film, in W m^-2 nm^-1, which grows with the opening of the stop",
            choices("radiance", "irradiance"));
  }

  std::optional<Place> place() const override { return Place{transform.written(shutter_open)(from), length(to - from)}; }

  void prepare() override {
    check_shutter(*this);
    placement_.set(*this, from, to, up, transform);
    if (!std::isfinite(film_diagonal)) fail("film_diagonal", "must be finite");
    if (!std::isfinite(unit)) fail("unit", "must be finite");
    const char* member = file.empty() ? "surfaces" : "file";
    try {
      std::vector<LensSurface> list = lens_surfaces(file.empty() ? surfaces : read_lens_file(file.resolved()), double(unit));
      if (aperture_diameter > 0) set_stop(list);
      lens_.set(list);
      member = "focus_distance";
      lens_.focus(focus_distance > 0 ? double(focus_distance) : length(to - from));
      member = file.empty() ? "surfaces" : "file";
      pupils_.find(lens_, double(film_diagonal) / 2);
    } catch (const Error& e) {
      const std::string reason = e.what(), path = file.empty() ? "" : file.resolved();
      fail(member, reason.find(path) == std::string::npos ? fmt::format("'{}': {}", path, reason) : reason);
    }
    lens_pdf_ = float(1 / (exact_pi * squared(pupils_.disc_radius())));
    update();
  }
  void set_film(int width, int height) override {
    columns_ = float(width);
    rows_ = float(height);
    update();
  }

  bool sample_ray(Point2 film, Point2 lens, float time, Wavelengths&, CameraRay& sample) const override {
    Sent sent;
    if (!send(film, lens, sent)) return false;
    sample.ray = placed(sent.ray, time);
    sample.weight = Spectrum(sent.weight);
    return true;
  }

  // If the lens blocks the ray: the ray through the middle of the pupil, or if that is blocked too, the ray of a pinhole camera
  // with the same image distance.
  Ray ray(Point2 film, Point2 lens, float time) const override {
    Sent sent;
    if (send(film, lens, sent) || send(film, {0.5f, 0.5f}, sent)) return placed(sent.ray, time);
    const DoublePoint3 at = on_film(film);
    const DoubleVector3 way{-at.x, -at.y, lens_.image_distance()};
    return placed({{0, 0, lens_.front()}, (1 / length(way)) * way}, time);
  }
  // Rays begin in front of the lens, whereas lens points lie on the disc, which may be behind the front of the lens.
  Reach reach(const Ray& r) const override { return {nearest(dot(placement_.at(r.time).forward, r.direction)), infinity}; }

  std::optional<Point2> film_point(const Ray& r) const override {
    const Seen seen = look(r);
    return seen.on_film ? std::optional(seen.film) : std::nullopt;
  }

  std::optional<LensSample> sample_lens(const Point3& point, float time, Point2 u) const override {
    const Pose pose = placement_.at(time);
    const Point2 l = warp::disc(u);
    const float radius = float(pupils_.disc_radius());
    const Vector3 offset{radius * l.x, radius * l.y, float(pupils_.disc_z())};
    const Vector3 to_point = pose.to_camera(point - pose.position) - offset;
    LensSample s;
    s.distance = length(to_point);
    const float cosine = to_point.z / s.distance;
    if (!(offset.z + to_point.z > float(lens_.front()))) return std::nullopt;
    Ray back;
    back.origin = s.lens = pose.position + pose.to_world(offset);
    back.direction = pose.to_world(1 / s.distance * to_point);
    back.time = time;
    const Seen seen = look(back);
    if (!seen.on_film) return std::nullopt;
    s.direction = -back.direction;
    s.pdf = square(s.distance) * lens_pdf_ / cosine;
    s.importance = importance_;
    s.film = seen.film;
    s.nearest = nearest(cosine);
    return s;
  }

  float importance(const Ray& r) const override { return look(r).on_film ? importance_ : 0; }
  CameraPdf pdf(const Ray& r) const override {
    const Seen seen = look(r);
    if (!seen.on_film) return {};
    const double per_extent = squared(lens_.rear()) / (double(area_) * seen.box * squared(squared(seen.film_cosine)));
    return {lens_pdf_, float(per_extent * seen.cosine / double(lens_pdf_))};
  }

  DoublePoint3 from{0, 0, 0}, to{0, 0, 1};
  Vector3 up{0, 1, 0};
  AnimatedTransform transform;
  FilePath file;
  // Kolb et al. 1995, table 1, scaled by a half (US patent 2 673 491).
  std::vector<double> surfaces{29.475, 3.76,  1.67,    25.2,    84.83, 0.12,  1,     25.2,   19.275, 4.025, 1.67,
                               23,     40.77, 3.275,   1.699,   23,    12.75, 5.705, 1,      18,     0,     4.5,
                               1,      17.1,  -14.495, 1.18,    1.603, 17,    40.77, 6.065,  1.658,  20,    -20.385,
                               0.19,   1,     20,      437.065, 3.22,  1.717, 20,    -39.73, 0,      1,     20};
  float unit = 1e-3f, aperture_diameter = 0, focus_distance = 0, film_diagonal = 0.0432666f;
  enum class Measures : std::uint8_t { radiance, irradiance };
  Measures measures = Measures::radiance;

 private:
  static constexpr double exact_pi = 3.14159265358979323846;
  static constexpr double squared(double x) { return x * x; }

  struct Sent {
    LensRay ray;
    float weight = 0;
  };
  struct Seen {
    bool on_film = false;
    Point2 film;
    double cosine = 0, film_cosine = 0;  ///< of the angle to the axis, in front of the lens and at the film
    double box = 0;                      ///< area of the pupil's rectangle [m^2]
  };

  void set_stop(std::vector<LensSurface>& list) {
    bool any = false;
    for (size_t i = 0; i < list.size(); ++i) {
      if (!is_stop(list, i)) continue;
      any = true;
      if (double(aperture_diameter) > list[i].diameter * 1.0001)
        warn("the stop opens to " + std::to_string(list[i].diameter) + " m at most", location_of("aperture_diameter"));
      list[i].diameter = std::min(list[i].diameter, double(aperture_diameter));
    }
    if (!any) fail("aperture_diameter", "the lens has no stop: a plane (radius 0) with the same index on both sides");
  }

  void update() {
    const float diagonal = std::hypot(columns_, rows_);
    width_ = film_diagonal * columns_ / diagonal;
    height_ = film_diagonal * rows_ / diagonal;
    area_ = width_ * height_;
    importance_ = 1 / area_ / (measures == Measures::radiance ? float(pupils_.solid_angle()) : 1);
  }

  /// The image on the film is upside down.
  DoublePoint3 on_film(Point2 film) const {
    return {(0.5 - double(film.x / columns_)) * double(width_), (double(film.y / rows_) - 0.5) * double(height_), 0};
  }

  /// Traces a ray from a film point through a point of the pupil's rectangle, which is rotated to the film point's azimuth.
  bool send(Point2 film, Point2 u, Sent& sent) const {
    const DoublePoint3 at = on_film(film);
    const double r = std::hypot(at.x, at.y), c = r > 0 ? at.x / r : 1, s = r > 0 ? at.y / r : 0;
    const LensPupils::Box box = pupils_.box(r);
    if (!(box.area() > 0)) return false;
    const double x = box.low + double(u.x) * (box.high - box.low), y = (2 * double(u.y) - 1) * box.half_height;
    const DoubleVector3 way{x * c - y * s - at.x, x * s + y * c - at.y, lens_.rear()};
    sent.ray = {at, (1 / length(way)) * way};
    sent.weight = float(box.area() * squared(squared(sent.ray.direction.z)) / squared(lens_.rear()));
    if (measures == Measures::radiance) sent.weight /= float(pupils_.solid_angle());
    return lens_.outwards(sent.ray);
  }

  /// The ray in world space, beginning at the plane of the front vertex.
  Ray placed(const LensRay& ray, float time) const {
    const Pose pose = placement_.at(time);
    Ray r;
    r.origin = pose.position + pose.to_world(Vector3(ray.at(lens_.front()) - DoublePoint3{}));
    r.direction = normalize(pose.to_world(Vector3(ray.direction)));
    r.time = time;
    r.spread = width_ / columns_ / float(lens_.image_distance());
    return r;
  }

  float nearest(float cosine) const { return float(lens_.front() - pupils_.disc_z()) / cosine; }

  /// The film point that light reaches which enters the lens against the direction of a camera ray.
  Seen look(const Ray& r) const {
    Seen seen;
    const Pose pose = placement_.at(r.time);
    const DoubleVector3 out(pose.to_camera(r.direction));
    if (!(out.z > 0)) return seen;
    LensRay ray{DoublePoint3{} + DoubleVector3(pose.to_camera(r.origin - pose.position)), (-1 / length(out)) * out};
    seen.cosine = -ray.direction.z;
    if (!lens_.inwards(ray)) return seen;
    const DoublePoint3 at = ray.at(0);
    seen.film_cosine = -ray.direction.z;
    seen.box = pupils_.box(std::hypot(at.x, at.y)).area();
    seen.film = {float(0.5 - at.x / double(width_)) * columns_, float(0.5 + at.y / double(height_)) * rows_};
    seen.on_film = seen.box > 0 && seen.film.x >= 0 && seen.film.x < columns_ && seen.film.y >= 0 && seen.film.y < rows_;
    return seen;
  }

  Placement placement_;
  LensSystem lens_;
  LensPupils pupils_;
  float columns_ = 1, rows_ = 1;             // of the picture, in pixels
  float width_ = 1, height_ = 1, area_ = 1;  // of the film
  float lens_pdf_ = 1, importance_ = 1;      // over the disc [1/m^2]; W_e [1/(m^2 sr)]
};

const Register<LensCamera> registered;

}  // namespace
}  // namespace etendue
