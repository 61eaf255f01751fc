#include "etendue/transport/medium.h"

#include "transport/medium_interval.h"

#include <vector>

#include "etendue/shader.h"
#include "etendue/transport/boundaries.h"

namespace etendue {
namespace {

/// exp(-s d) with 0 * infinity = 0: full transmittance without extinction.
Spectrum exponential(const Spectrum& extinction, float distance) {
  return map(extinction, [distance](float s) { return s > 0 ? std::exp(-s * distance) : 1.0f; });
}

// For a homogeneous medium: int_0^d e exp(-s t) dt = e (1 - exp(-s d)) / s, and e d where s = 0.
Spectrum emitted_along(const VolumeCoefficients& c, float distance) {
  const Spectrum extinction = c.extinction();
  Spectrum light;
  for (int i = 0; i < spectrum_size; ++i) {
    const float s = extinction[i];
    if (c.emission[i] > 0) light.set(i, c.emission[i] * (s > 0 ? -std::expm1(-s * distance) / s : distance));
  }
  return light;
}

/// Probabilities w_k of the wavelengths, in proportion to the walk's throughput.
Spectrum shares(const Spectrum& throughput) {
  const float sum = throughput.average() * spectrum_size;
  return sum > 0 ? throughput / sum : Spectrum(1.0f / spectrum_size);
}

FreeFlight through_homogeneous(const VolumeCoefficients& c, float reach, const Spectrum& throughput, NumberStream& numbers) {
  const Spectrum extinction = c.extinction();
  const float choice = numbers.next(), u = numbers.next();
  // Without scattering there is no distance to sample.
  if (c.scattering.black()) return {false, reach, exponential(extinction, reach)};

  const Spectrum weights = shares(throughput);
  int k = 0;
  for (float rest = choice - weights[0]; rest >= 0 && k + 1 < spectrum_size; rest -= weights[k]) ++k;
  while (k > 0 && !(weights[k] > 0)) --k;  // after rounding: back to the last wavelength with a positive probability

  const float distance = extinction[k] > 0 ? -std::log1p(-u) / extinction[k] : infinity;
  const bool scattered = distance < reach;
  const Spectrum t = exponential(extinction, scattered ? distance : reach);
  const Spectrum pdfs = scattered ? extinction * t : t;
  float pdf = 0;
  for (int i = 0; i < spectrum_size; ++i) pdf += weights[i] * pdfs[i];
  if (!(pdf > 0)) return {false, reach, {}};
  return {scattered, scattered ? distance : reach, (scattered ? c.scattering * t : t) / pdf};
}

/// Below this weight Russian roulette is applied: media may be infinite.
constexpr float small = 0.05f;

/// Delta tracking: calls `at(t, coefficients)` at each tentative collision until it returns false, or the ray ends. `local` is
/// the ray in object space, `m` the majorant of the extinction [1/m]. Returns whether the end of the ray was reached.
template <class At>
bool collide(const VolumeShader& volume, const Ray& local, float reach, float m, const Wavelengths& w, NumberStream& numbers,
             const At& at) {
  if (!(m > 0)) return true;
  // In double: far along the ray a step through a dense medium would be lost to rounding in a float, and the loop would never
  // end.
  for (double along = 0;;) {
    along -= double(std::log1p(-numbers.next())) / double(m);
    if (!(along < double(reach))) return true;
    const auto t = float(along);
    if (!at(t, volume.coefficients(local(t), local.time, w))) return false;
  }
}

/// The null-scattering coefficient n = m - s. m must be an upper bound of the extinction, otherwise energy is created;
/// `conform` tests the majorants of media.
Spectrum left_of(float m, const VolumeCoefficients& c) { return max(Spectrum(m) - c.extinction(), 0); }

/// Minimum mean number of tentative collisions along a ray through a medium that emits.
constexpr float collisions_for_light = 4;

FreeFlight through_heterogeneous(const VolumeShader& volume, const Ray& local, float reach, const Spectrum& throughput,
                                 const Wavelengths& w, NumberStream& numbers) {
  float m = volume.majorant(w).maximum();
  // Emission is estimated at collisions, so there must be some even if the medium is thin, or has emission only.
  if (volume.emits() && std::isfinite(reach) && reach > 0) m = std::max(m, collisions_for_light / reach);
  FreeFlight flight{false, reach, Spectrum(1.0f)};
  collide(volume, local, reach, m, w, numbers, [&](float t, const VolumeCoefficients& c) {
    flight.emitted += flight.weight * c.emission / m;
    const Spectrum null = left_of(m, c), weights = shares(throughput * flight.weight);
    const float scatters = (weights * c.scattering).average(), passes = (weights * null).average();
    if (!(scatters + passes > 0)) {
      flight.weight = {};
      return false;
    }
    const float p = scatters / (scatters + passes);
    if (numbers.next() < p) {
      flight.weight *= c.scattering / (m * p);
      flight.scattered = true;
      flight.distance = t;
      return false;
    }
    flight.weight *= null / (m * (1 - p));
    const float most = flight.weight.maximum();
    if (most < small) {  // Russian roulette: most of the light was absorbed
      if (numbers.next() >= most)
        flight.weight = {};
      else
        flight.weight /= most;
    }
    return !flight.weight.black();
  });
  return flight;
}

/// The reach of a ray if a surface ends it, otherwise the distance to the end of the medium: beyond that there may be no matter
/// at all, and delta tracking would never end.
float reach_within(const Medium& medium, const Ray& ray, float reach) {
  return std::isfinite(reach) ? reach : within_object(medium, ray);
}

}  // namespace

MediumInterval medium_interval(const Medium& medium, const Ray& ray, float reach) {
  if (!medium.object || !medium.object->surrounds()) return {0, reach_within(medium, ray, reach)};
  const float far = surroundings_of(*medium.object).reach(ray);
  if (!std::isfinite(far)) return {0, reach};
  // The near end of the surroundings: a ray from the far end backwards gives the length inside, and the rest of the distance
  // lies before it.
  Ray back = ray;
  back.origin = ray(far);
  back.direction = -ray.direction;
  const float begin = std::max(far - surroundings_of(*medium.object).reach(back), 0.0f);
  return {std::min(begin, reach), std::min(far, reach)};
}

float within_object(const Medium& medium, const Ray& ray) {
  if (medium.object && medium.object->surrounds()) return surroundings_of(*medium.object).reach(ray);
  if (!medium.object || medium.object->unbounded() || medium.object->infinite()) return infinity;
  const Bounds3 box = medium.object->bounds();
  float end = infinity;
  for (int axis = 0; axis < 3; ++axis) {
    const float d = ray.direction[axis];
    if (d != 0) end = std::min(end, ((d > 0 ? box.high : box.low)[axis] - ray.origin[axis]) / d);
  }
  return std::max(end, 0.0f);
}

Point3 Medium::own(const Point3& p, float time) const { return object->transform.from_origin(time).back(p); }

Ray Medium::own(const Ray& ray) const {
  const Transform placed = object->transform.from_origin(ray.time);
  Ray local = ray;
  local.origin = placed.back(ray.origin);
  local.direction = placed.back(ray.direction);
  return local;
}

Spectrum transmittance(const Medium& medium, const Ray& ray, float distance, const Wavelengths& w, NumberStream& numbers) {
  const VolumeShader& volume = *medium.volume;
  const MediumInterval there = medium_interval(medium, ray, distance);
  if (volume.homogeneous()) return exponential(volume.coefficients(ray.origin, ray.time, w).extinction(), there.length());
  const float m = volume.majorant(w).maximum();
  Spectrum fraction(1.0f);
  collide(volume, medium.own(there.within(ray)), there.length(), m, w, numbers, [&](float, const VolumeCoefficients& c) {
    fraction *= left_of(m, c) / m;
    const float most = fraction.maximum();
    if (most < small) {
      if (numbers.next() >= most)
        fraction = {};
      else
        fraction /= most;
    }
    return !fraction.black();
  });
  return fraction;
}

Spectrum weighting_transmittance(const Medium& medium, const Ray& ray, float distance, const Wavelengths& w) {
  const VolumeShader& volume = *medium.volume;
  const MediumInterval there = medium_interval(medium, ray, distance);
  const float length = there.length();
  if (volume.homogeneous()) return exponential(volume.coefficients(ray.origin, ray.time, w).extinction(), length);
  if (!std::isfinite(length)) return Spectrum(1.0f);
  // The optical depth by the midpoint rule, whose points are the same from both ends.
  constexpr int points = 8;
  const Ray local = medium.own(there.within(ray));
  Spectrum depth;
  for (int i = 0; i < points; ++i)
    depth += volume.coefficients(local(length * (float(i) + 0.5f) / points), ray.time, w).extinction();
  // Bounded from below, so that no strategy gets the pdf 0.
  return max(exponential(depth, length / points), 1e-6f);
}

FreeFlight sample_free_flight(const Medium& medium, const Ray& ray, float reach, const Spectrum& throughput,
                              const Wavelengths& w, NumberStream& numbers) {
  const VolumeShader& volume = *medium.volume;
  const MediumInterval there = medium_interval(medium, ray, reach);
  FreeFlight flight;
  if (volume.homogeneous()) {
    const VolumeCoefficients c = volume.coefficients(ray.origin, ray.time, w);
    flight = through_homogeneous(c, there.length(), throughput, numbers);
    if (volume.emits()) flight.emitted = emitted_along(c, there.length());
  } else {
    flight = through_heterogeneous(volume, medium.own(there.within(ray)), there.length(), throughput, w, numbers);
  }
  flight.distance = flight.scattered ? there.begin + flight.distance : there.end;
  return flight;
}

// A ray from the point to infinity crosses the surfaces of all objects around the point. The crossings are then applied in
// reverse order, from outside, where the stack is empty, to the point: the objects are entered and left as by a path on that
// ray.
void media_at_slowly(const Scene& scene, const Point3& p, float time, MediumStack& media) {
  struct Crossing {
    const SceneObject* object;
    Normal3 normal;
  };
  static thread_local std::vector<Crossing> crossings;
  crossings.clear();
  constexpr size_t most = 1000;

  Ray ray;
  ray.origin = p;
  ray.direction = normalize(Vector3{0.3713906f, 0.8571673f, 0.3565862f});
  ray.time = time;
  Hit hit;
  SurfacePoint point;
  while (crossings.size() < most && scene.nearest(ray, hit)) {
    scene.locate(ray, hit, point);
    crossings.push_back({point.object, point.normal});
    HitList others;
    Ray probe;
    coincident_hits(scene, ray, hit, point, probe, others);
    for (int i = 0; i < others.size; ++i) {
      scene.locate(probe, others.hits[i], point);
      crossings.push_back({point.object, point.normal});
    }
    if (others.size > 0) {
      scene.locate(ray, hit, point);
      point.error = std::max(point.error, length(probe.origin - point.position));
    }
    ray.origin = point.exit(ray.direction);
    hit = {};
  }
  for (size_t i = crossings.size(); i-- > 0;) {
    const SceneObject& object = *crossings[i].object;
    if (enterable(object)) cross_boundary(media, object, crossings[i].normal, -ray.direction);
  }
}

}  // namespace etendue
