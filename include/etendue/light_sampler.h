#pragma once
// LightSampler (of the same name in pbrt; part of Scene::sample_emitter in Mitsuba): chooses a luminaire for next event
// estimation or for the start of a light path, with a probability.
//
// A new light sampler must implement all functions: `build`, and `choose` with `probability` for a point and by power.

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
};

}  // namespace etendue
