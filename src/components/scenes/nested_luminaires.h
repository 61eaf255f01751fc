#pragma once
// NestedLuminaires: the luminaires of nested scenes, as luminaires of the outermost scene.

#include <deque>
#include <unordered_map>

#include "placed_luminaire.h"

namespace etendue {

/// Whether an object emits light: it has an emission and is not empty.
bool shines(const SceneObject&);

/// One PlacedLuminaire for each placement of a luminaire of a nested scene, and a hash table to find the one of a hit.
class NestedLuminaires {
 public:
  /// The largest number of luminaires, as memory is limited: each takes some 370 bytes here, and 250 more in a light sampler.
  static constexpr size_t most = size_t(1) << 22;

  /// The nested luminaires of a scene; null: there are none. Throws Error if there are too many.
  static std::shared_ptr<NestedLuminaires> of(const Scene&);

  const std::vector<Ref<PlacedLuminaire>>& all() const { return all_; }
  /// The PlacedLuminaire of a hit's object in the hit's nested scenes; null: there is none.
  const PlacedLuminaire* find(const Hit&) const;

  /// Sets the sphere around all finite objects, for luminaires at infinity.
  void enclose(const Point3& centre, float radius) {
    centre_ = centre;
    radius_ = radius;
  }
  Point3 centre() const { return centre_; }
  float radius() const { return radius_; }

  /// The distribution of normals of an object in a nested scene, for its area in moving placements that are not similarities;
  /// null: it was not needed.
  const NormalSpread* spread(const SceneObject& inner) const;

 private:
  struct Contents;
  class Finder;

  void add(const SceneObject& light, const Placement&);
  void make_table();
  static std::uint64_t hash(const PlacedLuminaire&);

  std::deque<Placement> placements_;
  std::vector<Ref<PlacedLuminaire>> all_;
  std::vector<std::uint32_t> slots_;  // hash table of indices in `all_` plus 1; 0: empty. Its size is a power of two
  std::unordered_map<const SceneObject*, NormalSpread> spreads_;
  Point3 centre_{0, 0, 0};
  float radius_ = 1;
};

}  // namespace etendue
