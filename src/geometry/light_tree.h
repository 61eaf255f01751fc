#pragma once
// LightTree: a hierarchy of emitters, for choosing one in proportion to a bound of what it may send to a point.
// Conty Estevez & Kulla 2018, "Importance sampling of many lights with adaptive tree splitting".

#include <cstdint>
#include <span>
#include <vector>

#include "etendue/scene_object.h"

namespace etendue {

/// Where an emitter is, which way it sends light, and how much.
struct LightBounds {
  Bounds3 bounds;
  NormalCone normals;  ///< of the surface, on the side that emits
  bool both_sides = false;
  float power = 0;  ///< in any unit that is the same for all; not negative

  bool empty() const { return bounds.empty(); }
  void add(const LightBounds&);
};

// The importance of a cluster of power P for a point p with normal n is an estimate of what it sends there,
//     I = P mean over q of  E[max(cos(theta), 0)] |cos(theta_i)| / |p - q|^2,
// over the eight points q of the Gauss-Legendre rule in its bounds; theta_i is the angle between n and the direction to q. E is
// over the cluster's normals: the angle theta between their axis and the direction to p and the half angle theta_o of their
// cone leave cosines between cos(theta + theta_o) and cos(theta - theta_o), taken to be spread evenly (exact for a half and a
// whole sphere, 1/2 and 1/4). What emits on both sides has half its power on each. A bound of the same from above (section 4.1
// there) tells which clusters send nothing; all others keep a thousandth of P / |p - q|^2 at least. The bound alone as
// importance gives distant clusters, seen from the side, and round ones so much that others starve: nine times the variance in
// a hall with ten thousand lamps. Surfaces emit to 90 degrees from their normals.
//
// One child of each node is chosen in proportion to their importances, down to a single emitter; the probability of an
// emitter is the product of those on the way.
class LightTree {
 public:
  void build(std::span<const LightBounds>);
  bool empty() const { return nodes_.empty(); }

  struct Choice {
    std::uint32_t emitter = 0;
    float probability = 0;  ///< 0: no emitter sends light to the point
  };
  /// For a point with a normal (zero: light from all directions counts alike). `u` becomes a fresh number in [0, 1).
  Choice sample(const Point3&, const Normal3&, double& u) const;
  float probability(const Point3&, const Normal3&, std::uint32_t emitter) const;

 private:
  struct Node {
    Point3 centre;
    Vector3 half;  ///< of the size of the bounds
    Vector3 axis;
    float cosine = -1;  ///< of the half angle of the cone of normals
    float power = 0;
    std::uint32_t parent = 0;
    std::uint32_t right = 0;  ///< the second child, or of a leaf the emitter; the first child follows its parent
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
  std::vector<std::uint32_t> leaves_;  ///< by emitter
};

}  // namespace etendue
