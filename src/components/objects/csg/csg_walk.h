#pragma once
// CsgWalk: finds the crossings of a ray with the surface of a CSG combination.

#include <span>

#include "etendue/scene_object.h"

namespace etendue {

/// A closed object in a combination, with its weight: a point is inside the combination if the weights of all operands that
/// contain it add up to at least a given number.
struct CsgOperand {
  const SceneObject* object = nullptr;
  Bounds3 bounds;  ///< in the coordinates of the combination, over all times
  int weight = 1;  ///< 1, or -1 for a subtracted object
  int index = 0;   ///< index in the list of operands
};

/// An operand's next crossing on a ray.
struct CsgCrossing {
  const CsgOperand* operand = nullptr;
  double t = 0;  ///< parameter on the whole ray; infinite if there is none
  Hit hit;       ///< on `rest`

  // State of the walk.
  Ray rest;          // the remaining ray, which begins behind the operand's last crossing
  double start = 0;  // parameter on the whole ray at which `rest` begins
  bool located = false;
  bool leaving = false;  // the ray exits the operand here
  bool passed = false;   // belongs to the last group of coincident crossings, which has been processed
  float error = 0;       // error of the operand's surface here [m]
  float across = 0;      // |normal . direction|: a distance along the ray times this is the distance from the surface
  Point3 exit;           // just behind the surface
};

/// Iterates over the crossings of a ray with a combination, in order (Roth 1982, "Ray casting for modeling solids"). Crossings
/// are computed lazily.
class CsgWalk {
 public:
  CsgWalk(std::span<const CsgOperand>, int least_weight, const Ray&);
  ~CsgWalk();
  CsgWalk(const CsgWalk&) = delete;
  CsgWalk& operator=(const CsgWalk&) = delete;

  /// The next crossing with t in (0, ray.maximum), with the operand whose surface is crossed; null if there is none. Valid
  /// until the next call.
  const CsgCrossing* next();

 private:
  void find(CsgCrossing&) const;
  void locate(CsgCrossing&) const;
  void advance(CsgCrossing&) const;
  CsgCrossing* nearest() const;

  const Ray& ray_;
  const int least_weight_;
  int turns_ = 0;                        // iterations of next() so far
  std::vector<CsgCrossing>& crossings_;  // of the operands whose bounding boxes the ray hits, in the order of the operands
};

}  // namespace etendue
