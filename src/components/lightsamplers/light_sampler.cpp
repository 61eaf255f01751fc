// LightSampler, the base class of all light samplers.

#include "etendue/light_sampler.h"

namespace etendue {

void LightSampler::describe(Description<LightSampler>& d) { d.summary("Chooses the luminaire that is asked for light."); }

static const Register<LightSampler> registered;

SurfaceSample LightSampler::sample(const SceneObject& luminaire, const Point3& from, const Normal3&, Point2 u,
                                   float time) const {
  return luminaire.sample_visible(from, u, time);
}
float LightSampler::pdf(const SceneObject& luminaire, const Point3& from, const Normal3&, const Vector3& direction,
                        const SurfacePoint& point) const {
  return luminaire.visible_pdf(from, direction, point);
}

}  // namespace etendue
