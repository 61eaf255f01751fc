#include "etendue/transport/luminaires.h"

#include "etendue/core/warp.h"

namespace etendue {
namespace {

/// The origin of light from infinity that passes `p`; `outward` is unit, against the light. All bounded objects lie behind p,
/// but light may hit unbounded surfaces before p: the origin lies beyond the last of them. False: there is no last one.
bool begin_before_all(const Scene& scene, const Point3& p, const Vector3& outward, float time, Point3& origin) {
  constexpr int most = 1000;
  Ray ray;
  ray.origin = origin = p;
  ray.direction = outward;
  ray.time = time;
  SurfacePoint point;
  for (int i = 0; i < most; ++i) {
    Hit hit;
    if (!scene.nearest(ray, hit)) return true;
    scene.locate(ray, hit, point);
    // So far that rounding over the long distance has no effect.
    origin = point.position + (scene.radius() + 1e-3f * length(point.position - p)) * outward;
    ray.origin = point.exit(outward);
  }
  return false;
}

}  // namespace

Point2 EmissionPlane::sample(Point2 u) const {
  if (!endless_) {
    const Point2 p = warp::disc(u);
    return {radius_ * p.x, radius_ * p.y};
  }
  if (u.x < 0.5f) {
    const Point2 p = warp::disc({2 * u.x, u.y});
    return {radius_ * p.x, radius_ * p.y};
  }
  const float r = radius_ / (2 - 2 * u.x);
  float sine = 0, cosine = 0;
  sin_cos_turn(u.y, sine, cosine);
  return {r * cosine, r * sine};
}

bool emit_from_infinity(const Scene& scene, const Point3& through, const SurfaceSample& s, const Wavelengths& w,
                        EmittedLight& light) {
  light.infinite = true;
  light.point = s.point;
  light.ray.direction = -s.direction;
  light.ray.origin = through + (scene.radius() - dot(through - scene.centre(), s.direction)) * s.direction;
  if (scene.unbounded() && !begin_before_all(scene, light.ray.origin, s.direction, light.ray.time, light.ray.origin))
    return false;
  if (const SurroundingObject* around = scene.surroundings()) {
    Ray back;
    back.origin = light.ray.origin;
    back.direction = s.direction;
    const float reach = around->reach(back);
    if (std::isfinite(reach)) light.ray.origin = light.ray.origin + reach * s.direction;
  }
  light.radiance = s.point.object->emission->radiance(s.point, light.ray.direction, w);
  return true;
}

void emit_from_point(const Scene& scene, const SurfaceSample& s, const Vector3& direction, const Wavelengths& w,
                     EmittedLight& light) {
  light.point = s.point;
  light.radiance = s.point.object->emission->radiance(s.point, direction, w);
  if (!scene.in_front(light.point, direction)) light.radiance = {};
  if (s.point.normal == Normal3{}) {
    light.ray.origin = s.point.position;
    light.ray.direction = direction;
  } else {
    light.radiance *= std::abs(dot(s.point.normal, direction));
    const float time = light.ray.time;
    light.point.leave(direction, light.ray);
    light.ray.time = time;
  }
}

bool choose_luminaire(const LightSampler& lights, float which, float time, EmittedLight& light) {
  const LightChoice choice = lights.choose(which);
  if (!choice.luminaire || !(choice.probability > 0)) return false;
  light.luminaire = choice.luminaire;
  light.probability = choice.probability;
  light.infinite = light.placed = false;
  light.ray = {};
  light.ray.time = time;
  return true;
}

bool sample_emitted_light(const Scene& scene, const LightSampler& lights, const Wavelengths& w, float time,
                          NumberStream& numbers, EmittedLight& light) {
  const float which = numbers.next();
  const Point2 position = numbers.next_pair(), direction = numbers.next_pair();
  if (!choose_luminaire(lights, which, time, light)) return false;
  const SceneObject& luminaire = *light.luminaire;
  if (luminaire.infinite()) {
    const EmissionPlane front(scene);
    const SurfaceSample s = luminaire.sample_visible(front.centre(), direction, time);
    if (!(s.pdf > 0)) return false;
    const Frame frame(Normal3(-s.direction));
    const Point2 across = front.sample(position);
    const Point3 through = front.centre() + across.x * frame.s + across.y * frame.t;
    light.pdf_direction = s.pdf;
    light.pdf_position = front.pdf(through, s.direction);
    if (!emit_from_infinity(scene, through, s, w, light)) return false;
  } else {
    const SurfaceSample s = luminaire.sample_area(position, time);
    if (!(s.pdf > 0)) return false;
    light.placed = true;
    light.point = s.point;
    light.pdf_position = s.pdf;
    const DirectionSample d = luminaire.emission->sample(s.point, direction);
    if (!(d.pdf > 0)) return false;
    light.pdf_direction = d.pdf;
    emit_from_point(scene, s, d.direction, w, light);
  }
  return !light.radiance.black();
}

}  // namespace etendue
