// Points on surfaces as Python sees them: arrays of what is known about them, parts of them, and rays that leave them.

#include "points.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include "etendue/transport/boundaries.h"

namespace etendue::python {

RayRows::RayRows(const nb::tuple& given)
    : origin(nb::cast<Array<double>>(given[0])),
      direction(nb::cast<Array<float>>(given[1])),
      maximum(nb::cast<Array<float>>(given[2])),
      time(nb::cast<Array<float>>(given[3])),
      width(nb::cast<Array<float>>(given[4])),
      spread(nb::cast<Array<float>>(given[5])),
      of_camera(nb::cast<Array<bool>>(given[6])),
      media(given[7].is_none() ? nullptr : nb::cast<const RayMedia*>(given[7])) {}

bool RayRows::at(size_t i, const Snapshot& scene, Ray& ray) const {
  ray.origin = scene.from_world(origin[i]);
  ray.direction = vector_at(direction, i);
  ray.maximum = maximum.at(i);
  ray.time = time.at(i);
  ray.width = width.at(i);
  ray.spread = spread.at(i);
  ray.of_camera = of_camera.at(i);
  return make_unit(ray.direction) && is_finite(ray.origin) && ray.maximum > 0 && std::isfinite(ray.time);
}

namespace {

template <class T, class Get>
nb::object column(const Points& points, size_t width, const Get& get) {
  Answers<T> values = width == 1 ? Answers<T>({points.count}) : Answers<T>({points.count, width});
  for_all(points.count, [&](size_t i, Arena&) { get(i, values); });
  return values.take();
}

/// A column of three floats, NaN where a ray hit nothing.
template <class Get>
nb::object vectors(const Points& points, const Get& get) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  return column<float>(points, 3, [&](size_t i, Answers<float>& to) {
    if (points.at[i].exists())
      to.set(i, get(points.at[i].point));
    else
      to.set(i, Vector3{nan, nan, nan});
  });
}

nb::object positions(const Points& points) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return column<double>(points, 3, [&](size_t i, Answers<double>& to) {
    to.set(i, points.at[i].exists() ? points.world(i) : DoublePoint3{nan, nan, nan});
  });
}

nb::object objects(const Points& points) {
  return column<std::int32_t>(points, 1, [&](size_t i, Answers<std::int32_t>& to) {
    const SceneObject* object = points.at[i].exists() ? points.at[i].point.object : nullptr;
    to.set(i, object && points.scene ? points.scene->index_of(*object) : -1);
  });
}

nb::object column_named(const Points& points, const std::string& name) {
  const auto number = [&](auto get) {
    return column<float>(points, 1, [&](size_t i, Answers<float>& to) { to.set(i, get(points.at[i])); });
  };
  if (name == "hit") return column<bool>(points, 1, [&](size_t i, Answers<bool>& to) { to.set(i, points.at[i].exists()); });
  if (name == "position") return positions(points);
  if (name == "distance") return number([](const FoundPoint& p) { return p.distance; });
  if (name == "error") return number([](const FoundPoint& p) { return p.point.error; });
  if (name == "time") return number([](const FoundPoint& p) { return p.point.time; });
  if (name == "footprint") return number([](const FoundPoint& p) { return p.point.footprint; });
  if (name == "normal") return vectors(points, [](const SurfacePoint& p) { return Vector3(p.normal); });
  if (name == "shading_normal") return vectors(points, [](const SurfacePoint& p) { return Vector3(p.shading_normal); });
  if (name == "object_position") return vectors(points, [](const SurfacePoint& p) { return p.object_position - Point3{}; });
  if (name == "object_normal") return vectors(points, [](const SurfacePoint& p) { return Vector3(p.object_normal); });
  if (name == "ray_direction")
    return column<float>(points, 3, [&](size_t i, Answers<float>& to) { to.set(i, points.at[i].point.ray_direction); });
  if (name == "uv")
    return column<float>(points, 2, [&](size_t i, Answers<float>& to) {
      to[i][0] = points.at[i].point.uv.x;
      to[i][1] = points.at[i].point.uv.y;
    });
  if (name == "primitive")
    return column<std::uint32_t>(points, 1,
                                 [&](size_t i, Answers<std::uint32_t>& to) { to.set(i, points.at[i].point.primitive); });
  if (name == "object") return objects(points);
  if (name == "dpdu" || name == "dpdv") {
    return vectors(points, [u = name == "dpdu"](SurfacePoint p) {
      if (p.object && p.dpdu == Vector3{} && p.dpdv == Vector3{}) p.object->tangents(p);
      return u ? p.dpdu : p.dpdv;
    });
  }
  throw Error("points have no '" + name + "'");
}

/// The points at some places, which Python has checked.
Points* taken(const Points& from, const Array<std::int64_t>& places) {
  const size_t count = places.shape(0);
  auto points = std::make_unique<Points>(count, from.scene, bool(from.media));
  points->own_origin = from.own_origin;
  for_all(count, [&](size_t i, Arena&) {
    const auto k = size_t(places.data()[i]);
    new (&points->at[i]) FoundPoint(from.at[k]);
    if (!from.media) return;
    new (&points->media[i]) MediumStack(from.media[k]);
    points->at[i].point.media = &points->media[i];
  });
  return points.release();
}

/// Points without an object. Positions are in world space, and object space is the same. `origin`: that of the points' floats;
/// it must be (0, 0, 0) for points that shaders and maps read.
Points* made(size_t count, const Array<double>& position, const Array<float>& normal, const Array<float>& shading_normal,
             const Array<float>& uv, const Array<float>& dpdu, const Array<float>& dpdv, const Array<float>& time,
             const std::array<double, 3>& origin) {
  auto points = std::make_unique<Points>(count, nullptr, false);
  points->own_origin = {origin[0], origin[1], origin[2]};
  const Rows<double> positions(position);
  const Rows<float> normals(normal), shading_normals(shading_normal), uvs(uv), dpdus(dpdu), dpdvs(dpdv), times(time);
  for_all(count, [&](size_t i, Arena&) {
    FoundPoint& found = *new (&points->at[i]) FoundPoint;
    SurfacePoint& p = found.point;
    const double* const at = positions[i];
    p.object_position = Point3(DoublePoint3{at[0], at[1], at[2]});
    p.position = {float(at[0] - origin[0]), float(at[1] - origin[1]), float(at[2] - origin[2])};
    Vector3 n = vector_at(normals, i), ns = vector_at(shading_normals, i);
    found.distance = make_unit(n) && make_unit(ns) && is_finite(p.position) ? 0 : infinity;
    p.normal = p.object_normal = Normal3(n);
    p.shading_normal = Normal3(ns);
    p.uv = point2_at(uvs, i);
    p.dpdu = vector_at(dpdus, i);
    p.dpdv = vector_at(dpdvs, i);
    if (p.dpdu == Vector3{} && p.dpdv == Vector3{}) {
      const Frame frame(p.normal);
      p.dpdu = frame.s;
      p.dpdv = frame.t;
    }
    p.time = times.at(i);
  });
  return points.release();
}

/// Rays that leave the points: a tuple of the arrays of RayRows. `lobe` and `transmitted` as in ScatterSample; 0 where the
/// direction is just given.
nb::tuple leaving(const Points& points, size_t count, const Array<float>& directions, const Array<std::uint8_t>& lobes) {
  const Rows<float> direction(directions);
  const Rows<std::uint8_t> lobe(lobes);
  Answers<double> origin({count, 3});
  Answers<float> unit({count, 3}), maximum({count}), time({count}), width({count}), spread({count});
  Answers<bool> of_camera({count});
  auto media = std::make_unique<RayMedia>();
  if (points.media) {
    media->count = count;
    media->scene = points.scene;
    media->stacks = Block<MediumStack>(count);
  }
  const DoubleVector3 shift = points.origin() - DoublePoint3{};
  for_all(count, [&](size_t i, Arena&) {
    const FoundPoint& from = points.row(i);
    Vector3 d = vector_at(direction, i);
    const bool goes = make_unit(d) && from.exists();
    const bool straight = lobe.at(i) == null_scattering;
    unit.set(i, goes ? d : Vector3{});
    origin.set(i, DoublePoint3(from.point.exit(d)) + shift);
    maximum.set(i, !goes ? 0 : straight ? from.remaining : infinity);
    time.set(i, from.point.time);
    width.set(i, from.point.footprint);
    spread.set(i, from.spread);
    of_camera.set(i, straight && from.of_camera);
    if (!points.media) return;
    MediumStack& stack = *new (&media->stacks[i]) MediumStack(*from.point.media);
    if (goes && from.point.object && (lobe.at(i) & transmission_lobes))
      cross_boundary(stack, *from.point.object, from.point.normal, d);
  });
  return nb::make_tuple(origin.take(), unit.take(), maximum.take(), time.take(), width.take(), spread.take(), of_camera.take(),
                        points.media ? nb::cast(media.release(), nb::rv_policy::take_ownership) : nb::none());
}

RayMedia* taken_media(const RayMedia& from, const Array<std::int64_t>& places) {
  auto media = std::make_unique<RayMedia>();
  media->count = places.shape(0);
  media->scene = from.scene;
  media->stacks = Block<MediumStack>(media->count);
  for (size_t i = 0; i < media->count; ++i) new (&media->stacks[i]) MediumStack(from.stacks[size_t(places.data()[i])]);
  return media.release();
}

}  // namespace

void bind_points(nb::module_& m) {
  nb::class_<RayMedia>(m, "RayMedia").def("__len__", [](const RayMedia& r) { return r.count; });
  nb::class_<Points>(m, "Points")
      .def("__len__", [](const Points& p) { return p.count; })
      .def_prop_ro("made_by_hand", [](const Points& p) { return !p.scene; });
  m.def("points_column", &column_named);
  m.def("points_parts", [](const Points& points) {
    nb::list parts;
    if (points.scene)
      for (const Ref<Component>& object : points.scene->objects()) parts.append(wrap(object));
    return nb::tuple(parts);
  });
  m.def("points_take", &taken, nb::rv_policy::take_ownership);
  m.def("points_make", &made, nb::rv_policy::take_ownership);
  m.def("points_leave", &leaving);
  m.def("media_take", &taken_media, nb::rv_policy::take_ownership);
}

}  // namespace etendue::python
