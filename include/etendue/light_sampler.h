#pragma once
// LightSampler (of the same name in pbrt; part of Scene::sample_emitter in Mitsuba): chooses a luminaire for next event
// estimation or for the start of a light path, with a probability.
//
// A new light sampler must implement `build`, and `choose` with `probability` for a point and by power. One that knows more
// about a luminaire than the luminaire itself, such as what hides it, also overrides `sample` with `pdf`.

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/scene.h"

namespace etendue {

struct LightChoice {
  const SceneObject* luminaire = nullptr;  ///< null: no luminaire was chosen
  float probability = 0;
};

class LightSampler : public Component {
 public:
  using Interface = LightSampler;
  using Parent = Component;
  static void describe(Description<LightSampler>&);

  /// Builds the data structure from the scene's luminaires (Scene::luminaires). Called when a render process starts, before its
  /// first step.
  virtual void build(const Scene&) = 0;
  /// Chooses a luminaire for next event estimation at a point with a normal (zero: a point in a volume). The probabilities of
  /// all luminaires sum to 1.
  virtual LightChoice choose(const Point3&, const Normal3&, float u) const = 0;
  virtual float probability(const Point3&, const Normal3&, const SceneObject& luminaire) const = 0;
  /// Chooses a luminaire by power alone, for paths that start at luminaires.
  virtual LightChoice choose(float u) const = 0;
  virtual float probability(const SceneObject& luminaire) const = 0;

  /// Samples a point of a chosen luminaire for next event estimation, with its pdf [1/sr] at `from`; by default the luminaire
  /// itself does (SceneObject::sample_visible).
  virtual SurfaceSample sample(const SceneObject& luminaire, const Point3& from, const Normal3& normal, Point2 u,
                               float time) const;
  /// The pdf [1/sr] with which `sample` returns a point of a luminaire that is seen from `from` in `direction` (unit).
  virtual float pdf(const SceneObject& luminaire, const Point3& from, const Normal3& normal, const Vector3& direction,
                    const SurfacePoint&) const;
};

}  // namespace etendue
