#pragma once
// LightSampler: which luminaire to ask for light, and with what probability.

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/scene.h"

namespace etendue {

struct LightChoice {
  const SceneObject* luminaire = nullptr;  ///< null: there is none
  float probability = 0;
};

class LightSampler : public Component {
 public:
  using Interface = LightSampler;
  using Parent = Component;
  static void describe(Description<LightSampler>&);

  /// Looks at the scene's luminaires before rendering: when a process is started, while no step is at hand.
  virtual void build(const Scene&) = 0;
  /// A luminaire for a point with a normal (zero: a point in a volume); probabilities sum to 1.
  virtual LightChoice choose(const Point3&, const Normal3&, float u) const = 0;
  virtual float probability(const Point3&, const Normal3&, const SceneObject& luminaire) const = 0;
  /// A luminaire by power alone, for paths that start there.
  virtual LightChoice choose(float u) const = 0;
  virtual float probability(const SceneObject& luminaire) const = 0;
};

}  // namespace etendue
