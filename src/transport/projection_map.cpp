#include "etendue/transport/projection_map.h"

#include <algorithm>

#include "etendue/core/warp.h"
#include "etendue/shader.h"

namespace etendue {
namespace {

constexpr Lobes mirrors = specular_reflection | specular_transmission;
constexpr size_t most_spheres = 64;

/// Whether an object, or one inside it, has specular lobes and so casts caustics. `instead`: the shader that replaces those of
/// all objects inside; null: their own.
bool specular_within(const SceneObject& object, const Shader* instead) {
  const Shader* shader = instead ? instead : object.shader.get();
  if (const Scene* inner = scene_within(object)) {
    const bool replaces = inner != &object;
    for (const Ref<SceneObject>& each : inner->objects)
      if (specular_within(*each, replaces ? shader : instead)) return true;
    return false;
  }
  return shader && (shader->possible_lobes() & mirrors);
}

}  // namespace

bool casts_caustics(const SceneObject& object) { return specular_within(object, nullptr); }

ProjectionMap::ProjectionMap(const Scene& scene) {
  for (const Ref<SceneObject>& object : scene.objects) {
    if (object->infinite() || object->delta() || !casts_caustics(*object)) continue;
    if (object->unbounded()) return;
    const Bounds3 bounds = object->bounds();
    if (!bounds.empty()) spheres_.push_back({bounds.centre(), length(bounds.diagonal()) / 2});
  }
  if (spheres_.empty()) return;
  std::vector<Sphere> all;
  std::swap(all, spheres_);
  share(all, 0, all.size(), most_spheres);
  float sum = 0;
  for (const Sphere& s : spheres_) up_to_.push_back(sum += square(s.radius));
  useful_ = sum > 0 && (scene.unbounded() || sum < square(scene.radius()));
}

/// Halves the list at the median of its longest extent, with half of the `most` spheres for each half, until a half has no more
/// spheres than that. A half with `most` = 1 gets one bounding sphere.
void ProjectionMap::share(std::vector<Sphere>& spheres, size_t begin, size_t end, size_t most) {
  Bounds3 bounds, centres;
  for (size_t i = begin; i < end; ++i) {
    const Sphere& s = spheres[i];
    const Vector3 r{s.radius, s.radius, s.radius};
    bounds.add(s.centre - r);
    bounds.add(s.centre + r);
    centres.add(s.centre);
  }
  if (end - begin <= most) {
    spheres_.insert(spheres_.end(), spheres.begin() + std::ptrdiff_t(begin), spheres.begin() + std::ptrdiff_t(end));
  } else if (most == 1) {
    spheres_.push_back({bounds.centre(), length(bounds.diagonal()) / 2});
  } else {
    const Vector3 d = centres.diagonal();
    const int axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    const size_t middle = begin + (end - begin) / 2;
    std::nth_element(spheres.begin() + std::ptrdiff_t(begin), spheres.begin() + std::ptrdiff_t(middle),
                     spheres.begin() + std::ptrdiff_t(end),
                     [axis](const Sphere& a, const Sphere& b) { return a.centre[axis] < b.centre[axis]; });
    share(spheres, begin, middle, most / 2);
    share(spheres, middle, end, most / 2);
  }
}

/// A point on the disc of a sphere, uniform over all discs together, with its pdf: it counts the discs that contain the point.
Point3 ProjectionMap::place(Point2 u, const Vector3& direction, float& pdf) const {
  const float sum = up_to_.back(), at = u.x * sum;
  const size_t k = std::min(size_t(std::ranges::upper_bound(up_to_, at) - up_to_.begin()), spheres_.size() - 1);
  const float below = k == 0 ? 0 : up_to_[k - 1];
  const Point2 p = warp::disc({clamp((at - below) / (up_to_[k] - below), 0, one_minus_epsilon), u.y});
  const Frame frame((Normal3(direction)));
  const Point3 through = spheres_[k].centre + spheres_[k].radius * (p.x * frame.s + p.y * frame.t);
  pdf = float(met_by(through, direction, false)) / (pi * sum);
  return through;
}

/// A direction towards a sphere from a point of a luminaire, or one sampled by its emission shader, with the pdf of the
/// mixture.
Vector3 ProjectionMap::direction(const SurfacePoint& from, Point2 u, float& pdf) const {
  const EmissionShader& emission = *from.object->emission;
  // 1 - cosine of the half angle under which each sphere is seen; 2 from inside.
  static thread_local std::vector<float> opening;
  opening.clear();
  float sum = 0;
  for (const Sphere& s : spheres_) {
    const float sine2 = square(s.radius) / length_squared(s.centre - from.position);
    opening.push_back(sine2 < 1 ? sine2 / (1 + std::sqrt(1 - sine2)) : 2);
    sum += opening.back();
  }
  Vector3 to;
  if (u.x < 0.5f) {
    const DirectionSample d = emission.sample(from, {2 * u.x, u.y});
    if (!(d.pdf > 0)) return pdf = 0, to;
    to = d.direction;
  } else {
    float rest = (2 * u.x - 1) * sum;
    size_t k = 0;
    while (k + 1 < spheres_.size() && rest >= opening[k]) rest -= opening[k++];
    const Vector3 axis = opening[k] < 2 ? normalize(spheres_[k].centre - from.position) : Vector3{0, 0, 1};
    to = Frame(Normal3(axis)).to_world(warp::cone({clamp(rest / opening[k], 0, one_minus_epsilon), u.y}, opening[k]));
  }
  pdf = 0.5f * emission.pdf(from, to) + 0.5f * float(met_by(from.position, to, true)) / (2 * pi * sum);
  return to;
}

/// The number of spheres that a line hits; with `ahead_alone` a ray that starts at the point.
int ProjectionMap::met_by(const Point3& p, const Vector3& direction, bool ahead_alone) const {
  int met = 0;
  for (const Sphere& s : spheres_) {
    const Vector3 to = s.centre - p;
    const float beyond = 1 + 1e-5f;  // rounding: a direction sampled in a cone must count as a hit
    const bool within = ahead_alone && length_squared(to) <= square(s.radius);
    const bool ahead = !ahead_alone || dot(to, direction) > 0;
    met += within || (ahead && length_squared(cross(to, direction)) <= square(s.radius) * beyond);
  }
  return met;
}

bool ProjectionMap::sample_emitted_light(const Scene& scene, const LightSampler& lights, const Wavelengths& w, float time,
                                         NumberStream& numbers, EmittedLight& light) const {
  const float which = numbers.next();
  const Point2 u = numbers.next_pair(), v = numbers.next_pair();
  if (!choose_luminaire(lights, which, time, light)) return false;
  const SceneObject& luminaire = *light.luminaire;
  if (luminaire.infinite()) {
    const SurfaceSample s = luminaire.sample_visible(scene.centre(), v, time);
    if (!(s.pdf > 0)) return false;
    light.pdf_direction = s.pdf;
    const Point3 through = place(u, s.direction, light.pdf_position);
    if (!(light.pdf_position > 0) || !emit_from_infinity(scene, through, s, w, light)) return false;
  } else {
    const SurfaceSample s = luminaire.sample_area(u, time);
    if (!(s.pdf > 0)) return false;
    light.pdf_position = s.pdf;
    const Vector3 to = direction(s.point, v, light.pdf_direction);
    if (!(light.pdf_direction > 0)) return false;
    emit_from_point(scene, s, to, w, light);
  }
  return !light.radiance.black();
}

}  // namespace etendue
