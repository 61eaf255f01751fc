#pragma once
// A binary tree over virtual lights, each node a group of lights near one another, and cuts through it.
//
// A cut holds each light once, in one of its nodes. For a place z it begins with the root, and the node that may bring most,
//     e = Phi / max(d_min^2, r^2),
// Phi being the group's power and d_min the distance of z from its box, is replaced by its two parts until there are as many
// nodes as wanted (Walter et al. 2005, "Lightcuts: a scalable approach to illumination"; r keeps e within what a light can
// bring). Of each node one light is taken, going down from part to part with probabilities in proportion to Phi / (D^2 + R^2),
// D and R being the distance of the part's middle and its radius (Conty Estevez & Kulla 2018, "Importance sampling of many
// lights with adaptive tree splitting"). The light over its probability stands for its node (Yuksel 2019, "Stochastic
// lightcuts").

#include "etendue/render/virtual_lights.h"

namespace etendue {

class VirtualLightTree {
 public:
  void build(std::span<const VirtualLight>);

  /// Where light is wanted.
  struct Place {
    Point3 position;
    Vector3 normal;     ///< lights behind it bring nothing; 0: there is no behind
    float nearest = 0;  ///< r [m]
  };
  static Place place(const PathVertex&, float nearest);

  /// A light of a node of the cut, and its probability in that.
  struct Sample {
    std::uint32_t light = 0;
    double probability = 0;
  };
  /// One of each node of a cut of at most so many.
  void cut(const Place&, size_t nodes, NumberStream&, std::vector<Sample>&) const;

 private:
  struct Node {
    Point3 low, high;
    float power = 0;
    std::uint32_t parts = 0;  ///< the first of two nodes side by side; 0: it is one light
    std::uint32_t light = 0;
  };
  std::vector<Node> nodes_;

  void build(std::uint32_t node, std::span<std::uint32_t> lights, std::span<const VirtualLight> all);
  static double bound(const Node&, const Place&);
  static double likely(const Node&, const Place&);
};

}  // namespace etendue
