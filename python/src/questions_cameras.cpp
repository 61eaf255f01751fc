// Cameras in both directions: rays of film points, and film points of rays and of points of a scene.

#include <nanobind/stl/optional.h>

#include "etendue/camera.h"
#include "points.h"

namespace etendue::python {

namespace {

using Asked = std::shared_ptr<const Snapshot>;

/// A camera that has been asked for a film of this size.
Asked camera_snapshot(nb::handle part, int width, int height) { return snapshot_of<Camera>(part, "a camera", {width, height}); }

/// The arrays of RayRows; then, if wavelengths are given, the weights of the rays, and whether their secondary wavelengths are
/// dropped.
nb::tuple rays(nb::handle part, int width, int height, size_t count, const Array<float>& film, const Array<float>& lens,
               const Array<float>& time, const nb::object& wavelengths) {
  const Asked asked = camera_snapshot(part, width, height);
  const auto& camera = asked->as<Camera>();
  const Rows<float> films(film), lenses(lens), times(time);
  std::optional<WavelengthRows> rows;
  if (!wavelengths.is_none()) rows.emplace(wavelength_rows(nb::cast<nb::tuple>(wavelengths)));
  Answers<double> origin({count, 3});
  Answers<float> direction({count, 3}), maximum({count}), spent({count}), widths({count}), spread({count});
  Answers<float> weights({rows ? count : 0, rows ? rows->count() : 1});
  Answers<bool> of_camera({count}), dropped({count});
  for_all(count, [&](size_t i, Arena&) {
    CameraRay sampled;
    bool passes = true;
    dropped.set(i, false);
    if (rows) {
      Wavelengths w = rows->at(i);
      passes = camera.sample_ray(point2_at(films, i), point2_at(lenses, i), times.at(i), w, sampled);
      dropped.set(i, w.single());
      rows->store(passes ? sampled.weight : Spectrum(), 0, weights[i]);
    } else {
      sampled.ray = camera.ray(point2_at(films, i), point2_at(lenses, i), times.at(i));
    }
    const Ray& ray = sampled.ray;
    origin.set(i, asked->to_world(ray.origin));
    direction.set(i, passes ? ray.direction : Vector3{});
    maximum.set(i, passes ? ray.maximum : 0);
    spent.set(i, ray.time);
    widths.set(i, ray.width);
    spread.set(i, ray.spread);
    of_camera.set(i, true);
  });
  return nb::make_tuple(origin.take(), direction.take(), maximum.take(), spent.take(), widths.take(), spread.take(),
                        of_camera.take(), rows ? weights.take() : nb::none(), rows ? dropped.take() : nb::none());
}

/// For rays from the lens outward: the film point, NaN where there is none, the importance, and the pdfs of position and
/// direction.
nb::tuple film_points(nb::handle part, int width, int height, size_t count, const nb::tuple& given) {
  const Asked asked = camera_snapshot(part, width, height);
  const auto& camera = asked->as<Camera>();
  const RayRows rows(given);
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  Answers<float> film({count, 2}), importance({count}), position({count}), direction({count});
  for_all(count, [&](size_t i, Arena&) {
    Ray ray;
    const bool usable = rows.at(i, *asked, ray);
    const std::optional<Point2> found = usable ? camera.film_point(ray) : std::nullopt;
    film[i][0] = found ? found->x : nan;
    film[i][1] = found ? found->y : nan;
    importance.set(i, usable ? camera.importance(ray) : 0);
    const CameraPdf pdf = usable ? camera.pdf(ray) : CameraPdf{};
    position.set(i, pdf.position);
    direction.set(i, pdf.direction);
  });
  return nb::make_tuple(film.take(), importance.take(), position.take(), direction.take());
}

/// For points of a scene: a point on the lens, direction, distance, pdf, importance, film point, nearest, and the transmittance
/// of the lens.
nb::tuple sample_lens(nb::handle part, int width, int height, size_t count, const Array<double>& points, const Array<float>& u,
                      const Array<float>& time, const nb::object& wavelengths) {
  const Asked asked = camera_snapshot(part, width, height);
  const auto& camera = asked->as<Camera>();
  const Rows<double> froms(points);
  const Rows<float> us(u), times(time);
  std::optional<WavelengthRows> rows;
  if (!wavelengths.is_none()) rows.emplace(wavelength_rows(nb::cast<nb::tuple>(wavelengths)));
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  Answers<double> lens({count, 3});
  Answers<float> direction({count, 3}), distance({count}), pdf({count}), importance({count}), film({count, 2}),
      nearest({count});
  Answers<float> weights({rows ? count : 0, rows ? rows->count() : 1});
  for_all(count, [&](size_t i, Arena&) {
    const Point3 from = asked->from_world(froms[i]);
    const std::optional<LensSample> s =
        is_finite(from) ? camera.sample_lens(from, times.at(i), point2_at(us, i)) : std::nullopt;
    lens.set(i, s ? asked->to_world(s->lens) : DoublePoint3{double(nan), double(nan), double(nan)});
    direction.set(i, s ? s->direction : Vector3{});
    distance.set(i, s ? s->distance : 0);
    pdf.set(i, s ? s->pdf : 0);
    importance.set(i, s ? s->importance : 0);
    film[i][0] = s ? s->film.x : nan;
    film[i][1] = s ? s->film.y : nan;
    nearest.set(i, s ? s->nearest : 0);
    if (rows) rows->fill(i, weights[i], [&](const Wavelengths& w) { return s ? camera.lens_weight(*s, w) : Spectrum(); });
  });
  return nb::make_tuple(lens.take(), direction.take(), distance.take(), pdf.take(), importance.take(), film.take(),
                        nearest.take(), rows ? weights.take() : nb::none());
}

nb::object shutter_times(nb::handle part, size_t count, const Array<float>& u) {
  const Asked asked = camera_snapshot(part, 1, 1);
  const Rows<float> us(u);
  Answers<float> times({count});
  for_all(count, [&](size_t i, Arena&) { times.set(i, asked->as<Camera>().shutter_time(us.at(i))); });
  return times.take();
}

}  // namespace

void bind_camera_questions(nb::module_& m) {
  using namespace nb::literals;
  m.def("camera_rays", &rays, "camera"_a, "width"_a, "height"_a, "count"_a, "film"_a, "lens"_a, "time"_a,
        "wavelengths"_a.none());
  m.def("camera_film_points", &film_points);
  m.def("camera_sample_lens", &sample_lens, "camera"_a, "width"_a, "height"_a, "count"_a, "points"_a, "u"_a, "time"_a,
        "wavelengths"_a.none());
  m.def("camera_shutter_times", &shutter_times);
}

}  // namespace etendue::python
