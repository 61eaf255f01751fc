#include "parts_rays.h"

#include <fmt/format.h>

#include <nanobind/ndarray.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include <cmath>

#include "etendue/transport/ray_tree.h"

namespace etendue::python {

namespace {

// ---- arrays ---------------------------------------------------------------------------------------------------------------

/// An array that owns its numbers: shape (rows,) or (rows, width); `rows` forces the latter.
template <class T>
nb::object array_of(std::vector<T> values, size_t width, bool rows = false) {
  auto* const data = new std::vector<T>(std::move(values));
  const nb::capsule owner(data, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  const size_t shape[2] = {data->size() / std::max<size_t>(width, 1), width};
  return nb::cast(nb::ndarray<nb::numpy, T>(data->data(), rows || width > 1 ? 2 : 1, shape, owner), nb::rv_policy::reference);
}

/// An array of truth values, shape (rows,).
nb::object truths(const std::vector<std::uint8_t>& values) {
  auto* const data = new std::vector<std::uint8_t>(values);
  const nb::capsule owner(data, [](void* p) noexcept { delete static_cast<std::vector<std::uint8_t>*>(p); });
  const size_t shape[1] = {data->size()};
  return nb::cast(nb::ndarray<nb::numpy>(data->data(), 1, shape, owner, nullptr, nb::dtype<bool>()), nb::rv_policy::reference);
}

nb::object spectra(const std::vector<Spectrum>& values) {
  std::vector<float> numbers(values.size() * spectrum_size);
  for (size_t i = 0; i < values.size(); ++i)
    for (int k = 0; k < spectrum_size; ++k) numbers[i * spectrum_size + size_t(k)] = values[i][k];
  return array_of(std::move(numbers), spectrum_size);
}

template <class Get>
nb::object vectors(size_t count, const Get& get) {
  std::vector<float> numbers(3 * count);
  for (size_t i = 0; i < count; ++i) {
    const auto v = get(i);
    numbers[3 * i] = v.x, numbers[3 * i + 1] = v.y, numbers[3 * i + 2] = v.z;
  }
  return array_of(std::move(numbers), 3);
}

template <class Get>
nb::object numbers_of(size_t count, const Get& get) {
  std::vector<float> numbers(count);
  for (size_t i = 0; i < count; ++i) numbers[i] = get(i);
  return array_of(std::move(numbers), 1);
}

using Directions = nb::ndarray<const float, nb::numpy, nb::c_contig, nb::shape<-1, 3>>;

Vector3 direction_at(const Directions& directions, size_t i) {
  const float* v = directions.data() + 3 * i;
  const Vector3 given{v[0], v[1], v[2]};
  const float squared = length_squared(given);
  if (!(std::abs(squared - 1) < 1e-3f))
    throw Error(fmt::format("direction {} is not a unit vector: its length is {}", i, std::sqrt(squared)));
  return 1 / std::sqrt(squared) * given;
}

const Batch& open(const Batch& batch) {
  if (!batch->open)
    throw Error("rays, surfaces and samples can be used only within the call of radiance that they were made for");
  return batch;
}

void require_count(const Batch& batch, size_t count) {
  if (count != batch->size())
    throw Error(fmt::format("expects {} directions, one for each path, not {}", batch->size(), count));
}

// ---- surfaces -------------------------------------------------------------------------------------------------------------

/// The surfaces that the rays of a list hit.
struct SurfaceList {
  RayList arrived;  // the rays that found them, as they ended
  std::vector<SurfacePoint> points;
  std::vector<float> distances;
  std::vector<std::uint8_t> hit;
  std::vector<const Scatter*> scatters;  // null where nothing is scattered

  const Batch& batch() const { return arrived.batch; }
  size_t size() const { return points.size(); }
  Vector3 out(size_t i) const { return -arrived.rays[i].direction; }
  MediumStack* media(size_t i) { return arrived.media.empty() ? nullptr : &arrived.media[i]; }
};

/// Calls `work(i)` for each path with a ray, without the interpreter's lock.
template <class Work>
void for_each_alive(const RayList& rays, const Work& work) {
  const nb::gil_scoped_release without;
  for (size_t i = 0; i < rays.rays.size() && !rays.batch->aborted(); ++i)
    if (rays.alive[i]) work(i);
}
template <class Work>
void for_each_hit(const SurfaceList& s, const Work& work) {
  for_each_alive(s.arrived, [&](size_t i) {
    if (s.hit[i]) work(i);
  });
}

SurfaceList intersect(const RayList& rays) {
  PathBatch& batch = *open(rays.batch);
  const Scene& scene = batch.context.scene;
  const size_t n = rays.rays.size();
  SurfaceList s{rays, std::vector<SurfacePoint>(n), std::vector<float>(n, infinity), std::vector<std::uint8_t>(n, 0),
                std::vector<const Scatter*>(n, nullptr)};
  for_each_alive(rays, [&](size_t i) {
    Ray& ray = s.arrived.rays[i];
    const Point3 from = ray.origin;
    Hit hit;
    if (!meet_surface(scene, ray, s.media(i), hit, s.points[i])) return;
    s.hit[i] = 1;
    s.distances[i] = distance(from, s.points[i].position);
    s.scatters[i] = scattering_at(s.points[i], s.out(i), batch.wavelengths[i], batch.arena);
  });
  return s;
}

nb::object occluded(const RayList& rays) {
  const PathBatch& batch = *open(rays.batch);
  std::vector<std::uint8_t> any(rays.rays.size(), 0);
  for_each_alive(rays, [&](size_t i) { any[i] = batch.context.scene.any(rays.rays[i]) ? 1 : 0; });
  return truths(any);
}

nb::object emitted(SurfaceList& s) {
  const PathBatch& batch = *open(s.batch());
  std::vector<Spectrum> light(s.size());
  for_each_alive(s.arrived, [&](size_t i) {
    const Wavelengths& w = batch.wavelengths[i];
    if (s.hit[i]) {
      if (s.points[i].object->luminaire()) light[i] = s.points[i].object->emission->radiance(s.points[i], s.out(i), w);
      return;
    }
    const Ray& ray = s.arrived.rays[i];
    for (const SceneObject* far : batch.context.scene.infinite_luminaires(ray)) {
      SurfacePoint x;
      far->surface_point(ray, {}, x);
      light[i] += far->emission->radiance(x, s.out(i), w);
    }
  });
  return spectra(light);
}

/// One sample of next event estimation, as in src/components/renderers/simple_path_tracer.cpp.
Spectrum direct_light(PathBatch& batch, const SurfaceList& s, size_t i) {
  const Scene& scene = batch.context.scene;
  const SurfacePoint& x = s.points[i];
  NumberStream& numbers = batch.numbers[i];
  const LightChoice choice = batch.light_sampler.choose(x.position, x.normal, numbers.next());
  const Point2 u = numbers.next_pair();
  LuminaireSample light;
  if (!choice.luminaire || !sample_luminaire(scene, &batch.light_sampler, *choice.luminaire, x, batch.wavelengths[i], u, light))
    return {};
  const Spectrum f_cos = s.scatters[i]->evaluate(s.out(i), light.direction, {.lobes = smooth_lobes});
  if (f_cos.black() || scene.any(light.shadow)) return {};
  return f_cos * light.radiance / (choice.probability * light.pdf);
}

nb::object direct(SurfaceList& s) {
  PathBatch& batch = *open(s.batch());
  std::vector<Spectrum> light(s.size());
  for_each_hit(s, [&](size_t i) {
    if (s.scatters[i]) light[i] = direct_light(batch, s, i);
  });
  return spectra(light);
}

nb::tuple scatter(SurfaceList& s) {
  PathBatch& batch = *open(s.batch());
  RayList on = s.arrived;
  std::vector<Spectrum> weights(s.size());
  std::vector<std::uint8_t> specular(s.size(), 0);
  std::fill(on.alive.begin(), on.alive.end(), std::uint8_t(0));
  for_each_hit(s, [&](size_t i) {
    if (!s.scatters[i]) return;
    const float lobe = batch.numbers[i].next();
    const std::optional<ScatterSample> next = s.scatters[i]->sample(s.out(i), lobe, batch.numbers[i].next_pair());
    if (!next || enters_subsurface(s.points[i], *next)) return;
    weights[i] = next->weight;
    if (next->dispersive) weights[i] *= batch.wavelengths[i].drop_secondary();
    specular[i] = next->specular() ? 1 : 0;
    on.alive[i] = 1;
    go_on(s.points[i], *next, on.rays[i], on.media.empty() ? nullptr : &on.media[i]);
  });
  return nb::make_tuple(nb::cast(std::move(on)), spectra(weights), truths(specular));
}

nb::tuple evaluate(SurfaceList& s, const Directions& directions) {
  open(s.batch());
  require_count(s.batch(), directions.shape(0));
  std::vector<Spectrum> values(s.size());
  std::vector<float> pdfs(s.size(), 0);
  for_each_hit(s, [&](size_t i) {
    if (!s.scatters[i]) return;
    const ScatterValue f = s.scatters[i]->value_and_pdf(s.out(i), direction_at(directions, i));
    values[i] = f.value;
    pdfs[i] = f.pdf;
  });
  return nb::make_tuple(spectra(values), array_of(std::move(pdfs), 1));
}

nb::object albedo(SurfaceList& s) {
  open(s.batch());
  std::vector<Spectrum> values(s.size());
  for_each_hit(s, [&](size_t i) {
    if (s.scatters[i]) values[i] = s.scatters[i]->albedo(s.out(i));
  });
  return spectra(values);
}

RayList leave(SurfaceList& s, const Directions& directions, float maximum) {
  require_count(open(s.batch()), directions.shape(0));
  if (!(maximum > 0)) throw Error("the length of rays must be more than 0");
  RayList on = s.arrived;
  std::fill(on.alive.begin(), on.alive.end(), std::uint8_t(0));
  for_each_hit(s, [&](size_t i) {
    const Vector3 direction = direction_at(directions, i);
    const SurfacePoint& x = s.points[i];
    const bool through = (dot(x.normal, direction) > 0) != (dot(x.normal, s.out(i)) > 0);
    if (through && !on.media.empty()) cross_boundary(on.media[i], *x.object, x.normal, direction);
    x.leave(direction, on.rays[i]);
    on.rays[i].maximum = maximum;
    on.rays[i].of_camera = false;
    on.rays[i].width = x.footprint;
    on.alive[i] = 1;
  });
  return on;
}

// ---- samples --------------------------------------------------------------------------------------------------------------

struct SampleList {
  Batch batch;
};

nb::object uniform(SampleList& samples, int count) {
  PathBatch& batch = *open(samples.batch);
  if (count < 1 || count > 1024)
    throw Error(fmt::format("samples.uniform: takes 1 to 1024 numbers for each path, not {}", count));
  std::vector<float> numbers(batch.size() * size_t(count));
  {
    const nb::gil_scoped_release without;
    for (size_t i = 0; i < batch.size(); ++i) {
      float* to = &numbers[i * size_t(count)];
      int k = 0;
      for (; k + 1 < count; k += 2) {
        const Point2 pair = batch.numbers[i].next_pair();
        to[k] = pair.x, to[k + 1] = pair.y;
      }
      if (k < count) to[k] = batch.numbers[i].next();
    }
  }
  return array_of(std::move(numbers), size_t(count), true);
}

nb::object wavelengths_of(const SampleList& samples) {
  const PathBatch& batch = *open(samples.batch);
  std::vector<float> lambda(batch.size() * spectrum_size);
  for (size_t i = 0; i < batch.size(); ++i)
    for (int k = 0; k < spectrum_size; ++k) lambda[i * spectrum_size + size_t(k)] = batch.wavelengths[i][k];
  return array_of(std::move(lambda), spectrum_size);
}

nb::object film_of(const SampleList& samples) {
  const PathBatch& batch = *open(samples.batch);
  std::vector<float> points;
  for (const Point2 p : batch.film) points.insert(points.end(), {p.x, p.y});
  points.resize(2 * batch.size(), std::nanf(""));
  return array_of(std::move(points), 2);
}

/// `context` of the method.
struct BatchContext {
  Batch batch;
};

const MethodName radiance_name("radiance");

std::vector<Spectrum> checked(nb::handle returned, size_t count, const Called& called) {
  nb::ndarray<const float, nb::numpy, nb::c_contig, nb::ndim<2>> light;
  if (!nb::ndarray_check(returned) || !nb::try_cast(returned, light) || light.shape(0) != count ||
      light.shape(1) != size_t(spectrum_size))
    called.refuse(returned, fmt::format("an array of shape ({}, {}): the radiance along each ray, at each wavelength", count,
                                        spectrum_size));
  std::vector<Spectrum> values(count);
  for (size_t i = 0; i < count; ++i)
    for (int k = 0; k < spectrum_size; ++k) {
      const float x = light.data()[i * spectrum_size + size_t(k)];
      if (!std::isfinite(x))
        throw Error(
            fmt::format("{} returned {} for ray {} at wavelength {}; it must return finite numbers", called.text(), x, i, k));
      values[i].set(k, x);
    }
  return values;
}

}  // namespace

RayList camera_rays(const Batch& batch, std::vector<Ray> rays) {
  RayList list{batch, std::move(rays), {}, std::vector<std::uint8_t>(batch->size(), 1)};
  const Scene& scene = batch->context.scene;
  if (!scene.has_interiors()) return list;
  list.media.resize(batch->size());
  for (size_t i = 0; i < list.rays.size(); ++i) media_around(scene, list.rays[i], list.media[i]);
  return list;
}

std::vector<Spectrum> python_radiance(const PythonPart& part, RayList rays) {
  const Batch batch = rays.batch;
  const size_t count = batch->size();
  struct Close {
    PathBatch& batch;
    ~Close() { batch.open = false; }
  } const close{*batch};
  const PartCall call(part, radiance_name);
  const nb::object context = nb::cast(BatchContext{batch}), list = nb::cast(std::move(rays)),
                   samples = nb::cast(SampleList{batch});
  return checked(call(context, list, samples), count, call.called);
}

void bind_rays(nb::module_& m) {
  using namespace nb::literals;
  nb::class_<RayList>(m, "Rays", "One ray for each path. Paths that have ended are not alive: they have no ray.")
      .def("__len__", [](const RayList& r) { return r.rays.size(); })
      .def_prop_ro(
          "origin", [](const RayList& r) { return vectors(r.rays.size(), [&](size_t i) { return r.rays[i].origin; }); },
          "Shape (N, 3) [m], in rendering space.")
      .def_prop_ro(
          "direction", [](const RayList& r) { return vectors(r.rays.size(), [&](size_t i) { return r.rays[i].direction; }); },
          "Shape (N, 3), unit vectors.")
      .def_prop_ro(
          "maximum", [](const RayList& r) { return numbers_of(r.rays.size(), [&](size_t i) { return r.rays[i].maximum; }); },
          "Shape (N,): the rays' lengths [m].")
      .def_prop_ro(
          "time", [](const RayList& r) { return numbers_of(r.rays.size(), [&](size_t i) { return r.rays[i].time; }); },
          "Shape (N,) [s].")
      .def_prop_ro(
          "alive", [](const RayList& r) { return truths(r.alive); }, "Shape (N,), truth values.")
      .def(
          "end",
          [](RayList& r, const nb::ndarray<const bool, nb::numpy, nb::c_contig, nb::ndim<1>>& which) {
            if (which.shape(0) != r.alive.size())
              throw Error(fmt::format("rays.end: expects {} truth values, not {}", r.alive.size(), which.shape(0)));
            for (size_t i = 0; i < r.alive.size(); ++i)
              if (which.data()[i]) r.alive[i] = 0;
          },
          "which"_a, "Ends paths, given by an array of truth values of shape (N,).");
  nb::class_<SurfaceList>(m, "Surfaces", "The surface points that rays hit, one for each path.")
      .def("__len__", &SurfaceList::size)
      .def_prop_ro(
          "hit", [](const SurfaceList& s) { return truths(s.hit); }, "Shape (N,): whether the ray hit a surface.")
      .def_prop_ro(
          "distance", [](const SurfaceList& s) { return array_of(s.distances, 1); },
          "Shape (N,): from the ray's origin [m]; infinity without a hit.")
      .def_prop_ro(
          "position", [](const SurfaceList& s) { return vectors(s.size(), [&](size_t i) { return s.points[i].position; }); },
          "Shape (N, 3) [m], in rendering space.")
      .def_prop_ro(
          "normal", [](const SurfaceList& s) { return vectors(s.size(), [&](size_t i) { return s.points[i].normal; }); },
          "Shape (N, 3): geometric normals, unit; zero without a hit.")
      .def_prop_ro(
          "shading_normal",
          [](const SurfaceList& s) { return vectors(s.size(), [&](size_t i) { return s.points[i].shading_normal; }); },
          "Shape (N, 3): interpolated or perturbed normals, unit; zero without a hit.")
      .def_prop_ro(
          "out", [](const SurfaceList& s) { return vectors(s.size(), [&](size_t i) { return s.out(i); }); },
          "Shape (N, 3): unit directions from the surfaces to where the rays came from.")
      .def_prop_ro(
          "uv",
          [](const SurfaceList& s) {
            std::vector<float> uv;
            for (const SurfacePoint& p : s.points) uv.insert(uv.end(), {p.uv.x, p.uv.y});
            return array_of(std::move(uv), 2);
          },
          "Shape (N, 2): surface coordinates.")
      .def("emitted", &emitted,
           "The radiance that luminaires emit against the rays, shape (N, 8): of the surfaces that were hit, or from infinity.")
      .def(
          "direct", [](SurfaceList& s, const SampleList&) { return direct(s); }, "samples"_a,
          "Next event estimation, shape (N, 8): one sample of the light that comes to each surface straight from luminaires "
          "and "
          "is scattered against the ray, shadows included. Without specular lobes.")
      .def(
          "scatter", [](SurfaceList& s, const SampleList&) { return scatter(s); }, "samples"_a,
          "Samples the direction in which each path goes on. Returns the rays, their weights f |cos| / pdf of shape (N, 8), "
          "and "
          "an array of shape (N,): whether the lobe was specular. Paths that are absorbed are no longer alive, with weight 0.")
      .def(
          "evaluate", &evaluate, "incident"_a,
          "The scattering f |cos| [1/sr] of shape (N, 8) for unit directions of shape (N, 3), and the pdf [1/sr] of shape (N,) "
          "with which scatter samples them. Without specular lobes.")
      .def("albedo", &albedo, "Shape (N, 8): the fraction of uniform light that is scattered against the ray.")
      .def(
          "leave", &leave, "directions"_a, "maximum"_a = infinity,
          "Rays that leave the surfaces in given unit directions of shape (N, 3), of a length [m]; not alive where nothing was "
          "hit.");
  nb::class_<SampleList>(m, "Samples", "The random numbers of the paths.")
      .def("__len__", [](const SampleList& s) { return s.batch->size(); })
      .def("uniform", &uniform, "count"_a = 1,
           "The next numbers of each path, uniform in [0, 1): shape (N, count). They are functions of seed, pixel, sample and "
           "how "
           "many were taken, and well distributed over the samples of a pixel: take them instead of numpy.random.")
      .def_prop_ro("wavelengths", &wavelengths_of, "Shape (N, 8) [nm]: those of each path.")
      .def_prop_ro("film", &film_of, "Shape (N, 2) [pixels]: the film points of the paths.");
  nb::class_<BatchContext>(m, "RenderContext", "What is rendered.")
      .def(
          "intersect", [](const BatchContext& c, const RayList& rays) { return open(c.batch), intersect(rays); }, "rays"_a,
          "The surfaces that rays hit.")
      .def(
          "occluded", [](const BatchContext& c, const RayList& rays) { return open(c.batch), occluded(rays); }, "rays"_a,
          "Whether anything lies on the rays, shape (N,).")
      .def_prop_ro(
          "scene",
          [](const BatchContext& c) { return wrap(Ref<Component>(const_cast<Scene*>(&open(c.batch)->context.scene))); },
          "The scene as a part.")
      .def_prop_ro(
          "camera",
          [](const BatchContext& c) { return wrap(Ref<Component>(const_cast<Camera*>(&open(c.batch)->context.camera))); },
          "The camera as a part.")
      .def_prop_ro("seed", [](const BatchContext& c) { return c.batch->context.seed; });
}

}  // namespace etendue::python
