// Cameras that are written in Python, in world coordinates.

#include "etendue/camera.h"
#include "parts_points.h"

namespace etendue::python {

namespace {

const MethodName set_film_name("set_film"), ray_name("ray"), film_point_name("film_point"), sample_lens_name("sample_lens"),
    importance_name("importance"), pdf_name("pdf"), place_name("place"), has_lens_name("has_lens"), parallel_name("parallel");

/// The entries of a tuple.
nb::handle entry(nb::handle tuple, Py_ssize_t i) { return PyTuple_GetItem(tuple.ptr(), i); }
bool is_tuple(nb::handle object, Py_ssize_t least, Py_ssize_t most) {
  return PyTuple_Check(object.ptr()) && PyTuple_Size(object.ptr()) >= least && PyTuple_Size(object.ptr()) <= most;
}

class PythonCamera final : public PartOf<Camera> {
 public:
  using PartOf::PartOf;

  void prepare() override {
    PartOf::prepare();
    has_lens_ = truth_of(*this, has_lens_name, true);
  }
  bool has_lens() const override { return has_lens_; }
  bool parallel() const override { return truth_of(*this, parallel_name, false); }

  std::optional<Place> place() const override {
    if (!defines(place_name)) return std::nullopt;
    const PartCall call(*this, place_name);
    const nb::object returned = call();
    if (!is_tuple(returned, 2, 2)) call.called.refuse(returned, "a position [m] and a distance [m]: ((x, y, z), distance)");
    std::array<double, 3> p{};
    to_numbers(entry(returned, 0), p, call.called, "a position of three finite numbers [m]");
    return Place{{p[0], p[1], p[2]}, to_number(entry(returned, 1), call.called)};
  }

  void set_film(int width, int height) override {
    const PartCall call(*this, set_film_name);
    call(nb::int_(width), nb::int_(height));
  }

  Ray ray(Point2 film, Point2 lens, float time) const override {
    const PartCall call(*this, ray_name);
    const nb::object returned = call(tuple_of(film), tuple_of(lens), number(double(time)));
    if (!is_tuple(returned, 2, 3))
      call.called.refuse(returned, "an origin [m], a unit direction and the ray's spread: ((x, y, z), (x, y, z), spread)");
    Ray ray;
    ray.origin = point_of(entry(returned, 0), call.called);
    ray.direction = to_vector(entry(returned, 1), call.called, "a direction of three finite numbers");
    const float squared = length_squared(ray.direction);
    if (std::abs(squared - 1) > 1e-3f) call.called.refuse(entry(returned, 1), "a direction of unit length");
    ray.direction = 1 / std::sqrt(squared) * ray.direction;
    ray.time = time;
    if (PyTuple_Size(returned.ptr()) > 2) {
      const double spread = to_number(entry(returned, 2), call.called);
      if (spread < 0) call.called.refuse(entry(returned, 2), "a spread that is not negative");
      ray.spread = float(spread);
    }
    return ray;
  }

  std::optional<Point2> film_point(const Ray& ray) const override {
    const PartCall call(*this, film_point_name);
    const nb::object returned = call(world(ray.origin), tuple_of(ray.direction));
    if (returned.is_none()) return std::nullopt;
    return film_of(returned, call.called);
  }

  std::optional<LensSample> sample_lens(const Point3& from, float time, Point2 u) const override {
    const PartCall call(*this, sample_lens_name);
    const nb::object returned = call(world(from), number(double(time)), tuple_of(u));
    if (returned.is_none()) return std::nullopt;
    if (!is_tuple(returned, 4, 4))
      call.called.refuse(returned,
                         "None, or a point of the lens, its pdf, the importance and the film point: "
                         "((x, y, z), pdf, importance, (x, y))");
    LensSample s;
    s.lens = point_of(entry(returned, 0), call.called);
    s.distance = distance(from, s.lens);
    if (!(s.distance > 0)) return std::nullopt;
    s.direction = 1 / s.distance * (s.lens - from);
    s.pdf = float(to_number(entry(returned, 1), call.called));
    s.importance = float(to_number(entry(returned, 2), call.called));
    s.film = film_of(entry(returned, 3), call.called);
    return s;
  }

  float importance(const Ray& ray) const override {
    const PartCall call(*this, importance_name);
    return float(to_number(call(world(ray.origin), tuple_of(ray.direction)), call.called));
  }

  CameraPdf pdf(const Ray& ray) const override {
    const PartCall call(*this, pdf_name);
    std::array<double, 2> pdfs{};
    to_numbers(call(world(ray.origin), tuple_of(ray.direction)), pdfs, call.called,
               "two finite numbers: the pdfs of the lens point [1/m^2] and of the direction [1/sr]");
    return {float(pdfs[0]), float(pdfs[1])};
  }

 private:
  /// Python's points are those of the world; the library's are relative to the origin of rendering space, which a camera
  /// without a place does not have.
  nb::object world(const Point3& p) const {
    const DoublePoint3& o = rendering_origin;
    return nb::make_tuple(o.x + double(p.x), o.y + double(p.y), o.z + double(p.z));
  }
  Point3 point_of(nb::handle object, const Called& called) const {
    std::array<double, 3> p{};
    to_numbers(object, p, called, "a point of three finite numbers [m]");
    const DoublePoint3& o = rendering_origin;
    return {float(p[0] - o.x), float(p[1] - o.y), float(p[2] - o.z)};
  }
  static Point2 film_of(nb::handle object, const Called& called) {
    std::array<double, 2> p{};
    to_numbers(object, p, called, "None, or a film point of two finite numbers [pixels]");
    return {float(p[0]), float(p[1])};
  }

  bool has_lens_ = true;
};

}  // namespace

PartInterface camera_interface() {
  return {
      "Camera",
      make_part<PythonCamera>,
      {{"set_film", "self, width, height", "called with the size of the whole picture [pixels]"},
       {"ray", "self, film, lens, time",
        "origin [m], unit direction, and the growth of the width of a pixel's cone per distance (optional)"},
       {"film_point", "self, origin, direction", "the film point of a ray away from the lens, None if it misses the film"},
       {"sample_lens", "self, point, time, u",
        "a point of the lens [m], its pdf [1/sr] at the point of the scene, the importance and the film point; None: unseen"},
       {"importance", "self, origin, direction", "W_e of a ray [1/(m^2 sr)], of a pinhole [1/sr]; 0 outside of the film"},
       {"pdf", "self, origin, direction",
        "the pdfs of a ray's lens point [1/m^2] (1 for a pinhole) and of its direction [1/sr]"},
       {"place", "self", "position [m] and approximate distance of what is in view [m], for precision far from the origin"},
       {"has_lens", "self", "False for a pinhole; True by default"},
       {"parallel", "self", "whether all rays are parallel; False by default"},
       prepare_method},
      {{"set_film"}, {"ray"}, {"film_point"}, {"sample_lens"}, {"importance"}, {"pdf"}}};
}

}  // namespace etendue::python
