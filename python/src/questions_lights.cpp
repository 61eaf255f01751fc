// Emission, and the choice of luminaires.

#include <nanobind/stl/optional.h>

#include "etendue/transport/direct_light.h"
#include "points.h"

namespace etendue::python {

namespace {

using Asked = std::shared_ptr<const Snapshot>;

// ---- luminaires of a scene
// ---------------------------------------------------------------------------------------------------

/// The radiance that each point emits in a direction; without directions, towards the origin of the ray that found the point,
/// where a ray that hit nothing sees the luminaires at infinity.
nb::object emitted(nb::handle part, const Points& points, size_t count, const std::optional<Array<float>>& directions,
                   const nb::tuple& wavelengths) {
  const Asked snapshot = snapshot_of<Scene>(part, "a scene");
  require_present(points, snapshot);
  const Scene& scene = snapshot->as<Scene>();
  const WavelengthRows rows = wavelength_rows(wavelengths);
  std::optional<Rows<float>> given;
  if (directions) given.emplace(*directions);
  Answers<float> values({count, rows.count()});
  for_all(count, [&](size_t i, Arena&) {
    const FoundPoint& found = points.row(i);
    Vector3 out = given ? vector_at(*given, i) : -found.point.ray_direction;
    const bool usable = make_unit(out);
    rows.fill(i, values[i], [&](const Wavelengths& w) {
      Spectrum sum;
      if (!usable) return sum;
      if (const SceneObject* object = found.point.object; found.exists()) {
        if (object && object->luminaire()) sum = object->emission->radiance(found.point, out, w);
      } else if (!given) {
        const Ray ray = found.escaped();
        for (const SceneObject* far : scene.infinite_luminaires(ray)) {
          SurfacePoint x;
          far->surface_point(ray, {}, x);
          sum += far->emission->radiance(x, out, w);
        }
      }
      return sum;
    });
  });
  return values.take();
}

/// Next event estimation without the scattering: for each point a point on a luminaire. Direction, distance, radiance, pdf, the
/// luminaire, whether it is a delta light, and the origin, direction and length of the shadow ray.
nb::tuple sample_light(nb::handle part, const Points& points, size_t count, const Array<float>& u, const nb::tuple& wavelengths,
                       nb::handle light_sampler) {
  const Asked snapshot = snapshot_of<Scene>(part, "a scene");
  require_present(points, snapshot);
  const Scene& scene = snapshot->as<Scene>();
  const LightSampler& lights = snapshot->light_sampler(light_sampler);
  const WavelengthRows rows = wavelength_rows(wavelengths);
  const Rows<float> us(u);
  const Vector3 shift = Vector3(points.origin() - snapshot->origin());
  Answers<float> direction({count, 3}), distance({count}), radiance({count, rows.count()}), pdf({count});
  Answers<std::int32_t> luminaire({count});
  Answers<bool> delta({count});
  Answers<double> shadow_origin({count, 3});
  Answers<float> shadow_direction({count, 3}), shadow_maximum({count}), time({count});
  for_all(count, [&](size_t i, Arena&) {
    SurfacePoint x = points.row(i).point;
    x.position = x.position + shift;
    const float* const n = us[i];
    const LightChoice choice = points.row(i).exists() ? lights.choose(x.position, x.normal, n[0]) : LightChoice{};
    SurfaceSample on;
    if (choice.luminaire) on = choice.luminaire->sample_visible(x.position, {n[1], n[2]}, x.time);
    const bool found = on.pdf > 0 && scene.in_front(on.point, -on.direction);
    const Ray shadow = !found ? Ray{} : on.infinite ? x.leave(on.direction) : x.towards(on.point);
    direction.set(i, found ? on.direction : Vector3{});
    distance.set(i, !found ? 0 : on.infinite ? infinity : on.distance);
    pdf.set(i, found ? choice.probability * on.pdf : 0);
    luminaire.set(i, found ? snapshot->index_of(*choice.luminaire) : -1);
    delta.set(i, found && on.delta);
    shadow_origin.set(i, snapshot->to_world(shadow.origin));
    shadow_direction.set(i, shadow.direction);
    shadow_maximum.set(i, found ? shadow.maximum : 0);
    time.set(i, x.time);
    rows.fill(i, radiance[i], [&](const Wavelengths& w) {
      return found ? choice.luminaire->emission->radiance(on.point, -on.direction, w) : Spectrum();
    });
  });
  return nb::make_tuple(direction.take(), distance.take(), radiance.take(), pdf.take(), luminaire.take(), delta.take(),
                        shadow_origin.take(), shadow_direction.take(), shadow_maximum.take(), time.take());
}

/// The pdf [1/sr] with which sample_light finds the point on a luminaire that a ray from another point has hit: for multiple
/// importance sampling. 0 where the point found is on no luminaire, or the ray left the scene to none.
nb::object light_pdf(nb::handle part, const Points& from, const Points& found, size_t count, nb::handle light_sampler) {
  const Asked snapshot = snapshot_of<Scene>(part, "a scene");
  require_present(from, snapshot);
  require_present(found, snapshot);
  const Scene& scene = snapshot->as<Scene>();
  const LightSampler& lights = snapshot->light_sampler(light_sampler);
  const Vector3 shift = Vector3(from.origin() - snapshot->origin());
  Answers<float> pdfs({count});
  for_all(count, [&](size_t i, Arena&) {
    const SurfacePoint& begin = from.row(i).point;
    const Point3 position = begin.position + shift;
    const FoundPoint& end = found.row(i);
    const Vector3& direction = end.point.ray_direction;
    float sum = 0;
    if (!from.row(i).exists()) {
    } else if (!end.exists()) {
      const Ray ray = end.escaped();
      for (const SceneObject* far : scene.infinite_luminaires(ray)) {
        SurfacePoint x;
        far->surface_point(ray, {}, x);
        sum += next_event_direction_pdf(lights, position, begin.normal, direction, x);
      }
    } else if (end.point.object && end.point.object->luminaire()) {
      sum = next_event_direction_pdf(lights, position, begin.normal, direction, end.point);
    }
    pdfs.set(i, sum);
  });
  return pdfs.take();
}

nb::tuple luminaires(nb::handle part) {
  const Asked snapshot = snapshot_of<Scene>(part, "a scene");
  nb::list parts;
  for (const SceneObject* luminaire : snapshot->as<Scene>().luminaires())
    parts.append(wrap(snapshot->objects().at(size_t(snapshot->index_of(*luminaire)))));
  return nb::tuple(parts);
}

/// Which luminaire a light sampler chooses at each point, as a place among the scene's objects, and its probability.
nb::tuple choose(nb::handle light_sampler, nb::handle part, const Points& points, size_t count, const Array<float>& u) {
  const Asked snapshot = snapshot_of<Scene>(part, "a scene");
  require_present(points, snapshot);
  const LightSampler& lights = snapshot->light_sampler(light_sampler);
  const Vector3 shift = Vector3(points.origin() - snapshot->origin());
  const Rows<float> us(u);
  Answers<std::int32_t> object({count});
  Answers<float> probability({count});
  for_all(count, [&](size_t i, Arena&) {
    const SurfacePoint& x = points.row(i).point;
    const LightChoice c = points.row(i).exists() ? lights.choose(x.position + shift, x.normal, us.at(i)) : LightChoice{};
    object.set(i, c.luminaire ? snapshot->index_of(*c.luminaire) : -1);
    probability.set(i, c.luminaire ? c.probability : 0);
  });
  return nb::make_tuple(object.take(), probability.take());
}

// ---- emission shaders
// --------------------------------------------------------------------------------------------------------

nb::object radiance(nb::handle part, const Points& points, size_t count, const Array<float>& directions,
                    const nb::tuple& wavelengths) {
  const Asked asked = snapshot_of<EmissionShader>(part, "an emission");
  const auto& emission = asked->as<EmissionShader>();
  const WavelengthRows rows = wavelength_rows(wavelengths);
  const Rows<float> given(directions);
  Answers<float> values({count, rows.count()});
  for_all(count, [&](size_t i, Arena&) {
    Vector3 d = vector_at(given, i);
    const bool usable = make_unit(d) && points.row(i).exists();
    rows.fill(i, values[i],
              [&](const Wavelengths& w) { return usable ? emission.radiance(points.row(i).point, d, w) : Spectrum(); });
  });
  return values.take();
}

nb::tuple sample_emission(nb::handle part, const Points& points, size_t count, const Array<float>& u) {
  const Asked asked = snapshot_of<EmissionShader>(part, "an emission");
  const Rows<float> us(u);
  Answers<float> direction({count, 3}), pdf({count});
  for_all(count, [&](size_t i, Arena&) {
    const DirectionSample s =
        points.row(i).exists() ? asked->as<EmissionShader>().sample(points.row(i).point, point2_at(us, i)) : DirectionSample{};
    direction.set(i, s.direction);
    pdf.set(i, s.pdf);
  });
  return nb::make_tuple(direction.take(), pdf.take());
}

nb::object emission_pdf(nb::handle part, const Points& points, size_t count, const Array<float>& directions) {
  const Asked asked = snapshot_of<EmissionShader>(part, "an emission");
  const Rows<float> given(directions);
  return answer_numbers(count, [&](size_t i) {
    Vector3 d = vector_at(given, i);
    const bool usable = make_unit(d) && points.row(i).exists();
    return usable ? asked->as<EmissionShader>().pdf(points.row(i).point, d) : 0;
  });
}

nb::tuple sample_incident(nb::handle part, size_t count, const Array<float>& u) {
  const Asked asked = snapshot_of<EmissionShader>(part, "an emission");
  const Rows<float> us(u);
  Answers<float> direction({count, 3}), pdf({count});
  for_all(count, [&](size_t i, Arena&) {
    const DirectionSample s = asked->as<EmissionShader>().sample_incident(point2_at(us, i));
    direction.set(i, s.direction);
    pdf.set(i, s.pdf);
  });
  return nb::make_tuple(direction.take(), pdf.take());
}

nb::object incident_pdf(nb::handle part, size_t count, const Array<float>& directions) {
  const Asked asked = snapshot_of<EmissionShader>(part, "an emission");
  const Rows<float> given(directions);
  return answer_numbers(count, [&](size_t i) {
    Vector3 d = vector_at(given, i);
    return make_unit(d) ? asked->as<EmissionShader>().incident_pdf(d) : 0;
  });
}

/// The power of an object that emits, with the emission it has.
nb::object power(nb::handle object, const nb::tuple& wavelengths, size_t count) {
  const Asked asked = snapshot_of<SceneObject>(object, "an object");
  const auto& luminaire = asked->as<SceneObject>();
  if (!luminaire.emission) throw Error(luminaire.class_info().name + ": the object has no emission");
  return answer_spectra(count, wavelengths,
                        [&](size_t, const Wavelengths& w) { return luminaire.emission->power(luminaire, w); });
}

}  // namespace

void bind_light_questions(nb::module_& m) {
  using namespace nb::literals;
  m.def("scene_emitted", &emitted, "scene"_a, "points"_a, "count"_a, "directions"_a.none(), "wavelengths"_a);
  m.def("scene_sample_light", &sample_light, "scene"_a, "points"_a, "count"_a, "u"_a, "wavelengths"_a,
        "light_sampler"_a.none());
  m.def("scene_light_pdf", &light_pdf, "scene"_a, "from"_a, "found"_a, "count"_a, "light_sampler"_a.none());
  m.def("scene_luminaires", &luminaires);
  m.def("light_sampler_choose", &choose);
  m.def("emission_radiance", &radiance);
  m.def("emission_sample", &sample_emission);
  m.def("emission_pdf", &emission_pdf);
  m.def("emission_sample_incident", &sample_incident);
  m.def("emission_incident_pdf", &incident_pdf);
  m.def("emission_power", &power);
}

}  // namespace etendue::python
