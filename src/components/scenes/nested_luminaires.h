#pragma once
// NestedLuminaires: the luminaires of nested scenes, as the outermost scene sees them.

#include <deque>
#include <unordered_map>

#include "placed_luminaire.h"

namespace etendue {

/// Whether light comes from an object: it emits, and there is something of it.
bool shines(const SceneObject&);

/// One PlacedLuminaire for each place in which a luminaire of a nested scene stands, and a table that finds it for a hit.
class NestedLuminaires {
 public:
  /// More than this would fill the memory: each takes some 370 bytes here, and 250 more in a light sampler.
  static constexpr size_t most = size_t(1) << 22;

  /// Those of a scene; null: there are none. Throws an Error when there are too many.
  static std::shared_ptr<NestedLuminaires> of(const Scene&);

  const std::vector<Ref<PlacedLuminaire>>& all() const { return all_; }
  /// What stands for the object that a hit names in its place; null: nothing does.
  const PlacedLuminaire* find(const Hit&) const;

  /// Tells those at infinity the sphere around all finite objects.
  void enclose(const Point3& centre, float radius) {
    centre_ = centre;
    radius_ = radius;
  }
  Point3 centre() const { return centre_; }
  float radius() const { return radius_; }

  /// Of an object in a nested scene that moves; null: it is not needed.
  const NormalSpread* spread(const SceneObject& inner) const;

 private:
  struct Contents;
  class Finder;

  void add(const SceneObject& light, const Placement&);
  void make_table();
  static std::uint64_t hash(const PlacedLuminaire&);

  std::deque<Placement> placements_;
  std::vector<Ref<PlacedLuminaire>> all_;
  std::vector<std::uint32_t> slots_;  // places in `all_` plus 1, by hash; 0: empty. A power of two of them
  std::unordered_map<const SceneObject*, NormalSpread> spreads_;
  Point3 centre_{0, 0, 0};
  float radius_ = 1;
};

}  // namespace etendue
