#pragma once
// LightTree: a bounding volume hierarchy of emitters for many-light sampling: it chooses an emitter approximately in proportion
// to its contribution at a point. Conty Estevez & Kulla 2018, "Importance sampling of many lights with adaptive tree
// splitting".

#include <cstdint>
#include <span>
#include <vector>

#include "etendue/scene_object.h"

namespace etendue {

/// An emitter's bounding box, cone of emission normals, and power.
struct LightBounds {
  Bounds3 bounds;
  NormalCone normals;  ///< of the surface's normals, on the side that emits
  bool both_sides = false;
  float power = 0;  ///< in any unit common to all emitters; not negative

  bool empty() const { return bounds.empty(); }
  void add(const LightBounds&);
};

// The importance of a cluster of power P for a point p with normal n is an estimate of its contribution at p,
//     I = P mean over q of  E[max(cos(theta), 0)] |cos(theta_i)| / |p - q|^2,
// over the eight points q of the Gauss-Legendre rule in its bounds; theta_i is the angle between n and the direction to q. E is
// the mean over the cluster's normals: with the angle theta between the axis of their cone and the direction to p, and the
// cone's half angle theta_o, the cosines lie between cos(theta + theta_o) and cos(theta - theta_o) and are assumed to be
// uniform there (exact for a hemisphere and a sphere: 1/2 and 1/4). An emitter with two sides has half its power on each. An
// upper bound of the contribution (section 4.1 of the paper) identifies clusters that contribute nothing; all others keep at
// least a thousandth of P / |p - q|^2. The upper bound alone as importance overestimates round clusters and distant ones seen
// from the side, so that others are undersampled: nine times the variance in a hall with ten thousand lamps. Surfaces are
// assumed to emit up to 90 degrees from their normals.
//
// One child of each node is chosen in proportion to their importances, down to a single emitter; the probability of an emitter
// is the product of the probabilities along the path from the root.
class LightTree {
 public:
  void build(std::span<const LightBounds>);
  bool empty() const { return nodes_.empty(); }

  struct Choice {
    std::uint32_t emitter = 0;
    float probability = 0;  ///< 0: no emitter sends light to the point
  };
  /// Chooses an emitter for a point with a normal (zero: light from all directions counts equally). `u` is rescaled so that it
  /// can be reused as a random number in [0, 1).
  Choice sample(const Point3&, const Normal3&, double& u) const;
  float probability(const Point3&, const Normal3&, std::uint32_t emitter) const;

 private:
  struct Node {
    Point3 centre;
    Vector3 half;  ///< half the diagonal of the bounding box
    Vector3 axis;
    float cosine = -1;  ///< cosine of the half angle of the cone of normals
    float power = 0;
    std::uint32_t parent = 0;
    std::uint32_t right = 0;  ///< the second child, or the emitter if the node is a leaf; the first child follows its parent
    bool leaf = false, both_sides = false;
  };
  struct Item {
    LightBounds light;
    std::uint32_t emitter;
  };

  static float importance(const Node&, const Point3&, const Normal3&);
  static float bound(const Node&, const Point3&, const Normal3&);
  static float mean(const Node&, const Point3&, const Normal3&);
  LightBounds split(std::span<Item> items, std::uint32_t parent, int depth);
  static size_t partition(std::span<Item> items, int depth);
  void place(Node&, const LightBounds&) const;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaves_;  ///< the leaf node of each emitter
};

}  // namespace etendue
