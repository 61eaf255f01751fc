#include "osl_emission.h"

#include "etendue/core/warp.h"
#include "etendue/scene_object.h"
#include "osl_part.h"

namespace etendue::osl {

namespace {

constexpr int pattern_size = 1024;

/// Four numbers of the R sequence (Roberts 2018): i times powers of the inverse of the root of x^5 = x + 1, modulo 1.
std::array<float, 4> pattern(int i) {
  constexpr double root = 1.1673039782614187;
  std::array<float, 4> u{};
  double step = 1;
  for (float& x : u) {
    step /= root;
    x = std::min(float(std::fmod(0.5 + step * (i + 1), 1.0)), one_minus_epsilon);
  }
  return u;
}

}  // namespace

Spectrum GroupEmission::radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths& w) const {
  if (!emits(p, direction)) return {};
  SurfacePoint seen = p;
  seen.ray_direction = -direction;
  const Run run(*this, seen, &w);
  return light_of(run.Ci(), space(), w);
}

DirectionSample GroupEmission::sample(const SurfacePoint& p, Point2 u) const {
  if (p.normal == Normal3{}) return {warp::sphere(u), warp::sphere_pdf};
  float side = sides == Sides::back ? -1.0f : 1.0f;
  if (sides == Sides::both) {
    side = u.x < 0.5f ? 1.0f : -1.0f;
    u.x = std::min(u.x < 0.5f ? 2 * u.x : 2 * u.x - 1, one_minus_epsilon);
  }
  const Vector3 direction = side * Frame(p.normal).to_world(warp::cosine_hemisphere(u));
  return {direction, pdf(p, direction)};
}

float GroupEmission::pdf(const SurfacePoint& p, const Vector3& direction) const {
  if (p.normal == Normal3{}) return warp::sphere_pdf;
  if (!emits(p, direction)) return 0;
  return (sides == Sides::both ? 0.5f : 1.0f) * inverse_pi * std::abs(dot(p.normal, direction));
}

Spectrum GroupEmission::power(const SceneObject& object, const Wavelengths& w) const {
  Spectrum sum;
  for (int i = 0; i < pattern_size; ++i) {
    const std::array<float, 4> u = pattern(i);
    if (object.infinite()) {
      Ray ray;
      ray.direction = warp::sphere({u[0], u[1]});
      SurfacePoint p;
      object.surface_point(ray, {}, p);
      sum += radiance(p, -ray.direction, w) * (object.area() * pi);
      continue;
    }
    const SurfaceSample at = object.sample_area({u[0], u[1]}, 0);
    const DirectionSample s = sample(at.point, {u[2], u[3]});
    if (!(at.pdf > 0) || !(s.pdf > 0)) continue;
    const float cosine = object.delta() ? 1 : std::abs(dot(at.point.normal, s.direction));
    sum += radiance(at.point, s.direction, w) * (cosine / (at.pdf * s.pdf));
  }
  return sum / float(pattern_size);
}

namespace {

/// Light of one shader, and of the maps that its members are.
class OslEmission final : public GroupEmission, public OslPart {
 public:
  explicit OslEmission(const ClassInfo& info) : OslPart(info) {}
  const ClassInfo& class_info() const override { return info(); }
  const Component& component() const override { return *this; }
  void prepare() override {
    Network network;
    const std::string layer = network.add(*this);
    build_group(*this, std::move(network), layer, {});
  }
};

}  // namespace

Ref<etendue::Component> make_emission(const ClassInfo& info) {
  return Ref<etendue::Component>(etendue::make<OslEmission>(info));
}

}  // namespace etendue::osl
