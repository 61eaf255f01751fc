#pragma once
// Along a ray through operands that are combined: where the surface of the combination is crossed.

#include <span>

#include "etendue/scene_object.h"

namespace etendue {

/// A closed object that takes part in a combination, and how: a point is inside the combination when the weights of all
/// operands that it is inside of add up to at least a given number.
struct CsgOperand {
  const SceneObject* object = nullptr;
  Bounds3 bounds;  ///< in the coordinates of the combination, over all times
  int weight = 1;  ///< 1, or -1 when the object is taken away
  int index = 0;   ///< place in the list
};

/// An operand's next crossing on a ray.
struct CsgCrossing {
  const CsgOperand* operand = nullptr;
  double t = 0;  ///< along the whole ray; infinite: there is none
  Hit hit;       ///< on `rest`

  // How the walk goes on.
  Ray rest;          // begins behind the operand's last crossing
  double start = 0;  // where on the whole ray that is
  bool located = false;
  bool leaving = false;  // goes out of the operand
  bool passed = false;   // belongs to the last place where something was crossed
  float error = 0;       // of the operand's surface here [m]
  float across = 0;      // |normal . direction|: t times this is the distance from the surface
  Point3 exit;           // just behind the surface
};

/// The crossings of a combination on a ray, one after the other (Roth 1982, "Ray casting for modeling solids"), found as they
/// are asked for.
class CsgWalk {
 public:
  CsgWalk(std::span<const CsgOperand>, int least_weight, const Ray&);
  ~CsgWalk();
  CsgWalk(const CsgWalk&) = delete;
  CsgWalk& operator=(const CsgWalk&) = delete;

  /// The next crossing with t in (0, ray.maximum), which says what operand's surface it is; null: there is none. Valid until
  /// the next call.
  const CsgCrossing* next();

 private:
  void find(CsgCrossing&) const;
  void locate(CsgCrossing&) const;
  void advance(CsgCrossing&) const;
  CsgCrossing* nearest() const;

  const Ray& ray_;
  const int least_weight_;
  int turns_ = 0;                        // of next()
  std::vector<CsgCrossing>& crossings_;  // of the operands whose bounds the ray meets, in their order
};

}  // namespace etendue
