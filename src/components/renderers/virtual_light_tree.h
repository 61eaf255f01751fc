#pragma once
// A binary tree over virtual lights, each node a group of lights near one another, and cuts through it.
//
// A cut contains each light once, in one of its nodes. For a shading point z the cut begins with the root. The node with the
// largest upper bound of its contribution,
//     e = Phi / max(d_min^2, r^2),
// with Phi the power of the group and d_min the distance of z from its bounding box, is replaced by its two children until the
// cut has the requested number of nodes (Walter et al. 2005, "Lightcuts: a scalable approach to illumination"; 1 / r^2 is the
// bound of a virtual light's geometry term, so e is clamped as the light is). One light is sampled from each node, by
// descending the tree. A child is chosen with a probability in proportion to Phi / (D^2 + R^2), D being the distance of its
// centre and R its radius (Conty Estevez & Kulla 2018, "Importance sampling of many lights with adaptive tree splitting"). The
// contribution of the light over its probability is the estimate of the node (Yuksel 2019, "Stochastic lightcuts").

#include "etendue/render/virtual_lights.h"

namespace etendue {

class VirtualLightTree {
 public:
  void build(std::span<const VirtualLight>);

  /// A shading point.
  struct Place {
    Point3 position;
    Vector3 normal;     ///< lights behind the surface do not contribute; 0: light may come from both sides
    float nearest = 0;  ///< r [m]
  };
  static Place place(const PathVertex&, float nearest);

  /// A light that was sampled from a node of the cut, and its probability within that node.
  struct Sample {
    std::uint32_t light = 0;
    double probability = 0;
  };
  /// Samples one light from each node of a cut of at most so many nodes.
  void cut(const Place&, size_t nodes, NumberStream&, std::vector<Sample>&) const;

 private:
  struct Node {
    Point3 low, high;
    float power = 0;
    std::uint32_t parts = 0;  ///< the first of two children side by side; 0: a leaf, one light
    std::uint32_t light = 0;
  };
  std::vector<Node> nodes_;

  void build(std::uint32_t node, std::span<std::uint32_t> lights, std::span<const VirtualLight> all);
  static double bound(const Node&, const Place&);
  static double likely(const Node&, const Place&);
};

}  // namespace etendue
