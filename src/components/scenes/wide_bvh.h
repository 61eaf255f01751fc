#pragma once
// A bounding volume hierarchy with eight children per node: its layout, construction and traversal.

#include <span>
#include <vector>

#include "core/huge_pages.h"
#include "etendue/core/ray.h"
#include "geometry/finite_ray.h"
#include "geometry/lanes.h"

namespace etendue {

/// A node: its children and their boxes, in SIMD layout.
struct alignas(64) WideNode {
  static constexpr std::uint32_t objects = 1u << 31;  ///< in `count`: a leaf of whole objects, not of triangles

  Floats sides[6];  ///< low x, high x, low y, …; unused children have their low sides at infinity, their high ones at -infinity
  std::uint32_t child[lanes];  ///< index of a node, or of the first primitive of a leaf
  std::uint32_t count[lanes];  ///< number of primitives of a leaf; 0: the child is a node
};

/// A hierarchy over primitives: the nodes, root first (none: there are no primitives), and the primitives' indices in the order
/// of the leaves. A leaf's child and count give its range in `order`.
struct WideBvh {
  HugeVector<WideNode> nodes;
  std::vector<std::uint32_t> order;
};

/// A primitive over which a hierarchy is built.
struct BvhPrimitive {
  Bounds3 bounds;
  std::uint32_t index;
  bool triangle;  ///< triangles are tested `lanes` at a time, objects one by one and at greater cost
};

/// Chooses splits by the surface area heuristic (Goldsmith & Salmon 1987), among a few planes across each axis (Wald 2007, "On
/// fast construction of SAH-based bounding volume hierarchies"), with all threads. The same primitives give the same
/// hierarchy. A leaf holds triangles or objects, not both.
WideBvh build_wide_bvh(std::vector<BvhPrimitive> primitives);

/// The largest depth of a hierarchy. Below half of this depth parts are split in equal halves, which ends soon.
inline constexpr int deepest_bvh = 64;

// A ray hits a box if it enters the last slab before it leaves the first (Kay & Kajiya 1986). The rounding errors of
// plane - origin, of 1 / direction and of their product are relative, so it is enough to widen every t by a relative amount
// (Ize 2013, "Robust BVH ray traversal"). This margin also covers the rounding of the shear of watertight.h, which is relative
// to the same distances. For a ray within a plane t is 0 times infinity = NaN, which limits nothing.
class BoxTest {
 public:
  explicit BoxTest(const Ray& ray) {
    for (int k = 0; k < 3; ++k) {
      const float inverse = 1 / ray.direction[k];
      near_side_[k] = 2 * k + std::signbit(inverse);
      origin_[k] = spread(ray.origin[k]);
      near_[k] = spread(inverse * (1 - margin));
      far_[k] = spread(inverse * (1 + margin));
    }
  }

  /// The children that are hit before `limit`, and in `entry` the t at which the ray enters their boxes.
  LaneBits operator()(const WideNode& node, float limit, Floats& entry) const {
    Floats in{}, out = spread(limit);
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k) {
      in = larger((node.sides[near_side_[k]] - origin_[k]) * near_[k], in);
      out = smaller((node.sides[near_side_[k] ^ 1] - origin_[k]) * far_[k], out);
    }
    entry = in;
    return at_most(in, out);
  }

 private:
  static constexpr float margin = rounding_bound(16);

  int near_side_[3];
  Floats origin_[3], near_[3], far_[3];
};

/// Calls leaf(first, count) for the leaves along the ray, in the order in which the ray enters the children's boxes, until it
/// returns true. Skips boxes that begin beyond `limit`, which the calls may lower.
template <class Leaf>
inline void traverse(const WideBvh& bvh, const Ray& ray, const float& limit, const Leaf& leaf) {
  if (bvh.nodes.empty() || !has_finite_squares(ray)) return;
  struct Waiting {
    float entry;
    std::uint32_t child, count;
  };
  Waiting stack[deepest_bvh * (lanes - 1) + lanes];
  Waiting* top = stack;
  const BoxTest test(ray);
  const WideNode* node = bvh.nodes.data();
  for (;;) {
    Floats entries;
    LaneBits met = test(*node, limit, entries);
    Waiting next;
    bool found = std::has_single_bit(met);
    if (found) {
      // In most nodes the ray hits one child. It is visited directly, without the latency of a store to the stack and a load.
      const int i = std::countr_zero(met);
      next = {entries[i], node->child[i], node->count[i]};
    } else {
      Waiting* const before = top;
      for (; met; met &= met - 1) {
        const int i = std::countr_zero(met);
        const Waiting child{entries[i], node->child[i], node->count[i]};
        // Insertion sort, as few children are hit.
        Waiting* place = top++;
        for (; place != before && place[-1].entry < child.entry; --place) *place = place[-1];
        *place = child;
      }
    }
    for (;; found = false) {
      if (!found) {
        if (top == stack) return;
        next = *--top;
        if (next.entry > limit) continue;
      }
      if (next.count == 0) {
        node = &bvh.nodes[next.child];
        break;
      }
      if (leaf(next.child, next.count)) return;
    }
  }
}

}  // namespace etendue
