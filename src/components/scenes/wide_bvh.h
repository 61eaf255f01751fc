#pragma once
// A bounding volume hierarchy with eight children a node: its form, how it is built, and how rays go through it.

#include <span>
#include <vector>

#include "etendue/core/ray.h"
#include "geometry/finite_ray.h"
#include "geometry/lanes.h"

namespace etendue {

/// What one child of a node is, and its box beside those of the others.
struct alignas(64) WideNode {
  static constexpr std::uint32_t objects = 1u << 31;  ///< in `count`: a leaf of whole objects, not of triangles

  Floats sides[6];  ///< low x, high x, low y, …; a child that is none has its low sides at infinity, its high ones at -infinity
  std::uint32_t child[lanes];  ///< a node, or where a leaf begins
  std::uint32_t count[lanes];  ///< how much a leaf holds; 0: the child is a node
};

/// Of a hierarchy over primitives: the nodes, root first (none: there are no primitives), and the primitives in the order in
/// which leaves hold them. A leaf's child and count tell which of them.
struct WideBvh {
  std::vector<WideNode> nodes;
  std::vector<std::uint32_t> order;
};

/// What a hierarchy is built over.
struct BvhPrimitive {
  Bounds3 bounds;
  std::uint32_t index;
  bool triangle;  ///< triangles are tested `lanes` at a time, objects one by one and at greater cost
};

/// Chooses splits by the surface area heuristic (Goldsmith & Salmon 1987), among a few planes across each axis (Wald 2007, "On
/// fast construction of SAH-based bounding volume hierarchies"), with all threads. The same primitives give the same
/// hierarchy. A leaf holds triangles or objects, not both.
WideBvh build_wide_bvh(std::vector<BvhPrimitive> primitives);

/// How deep a hierarchy may be: what lies deeper is split in halves, which ends soon.
inline constexpr int deepest_bvh = 64;

// A ray meets a box when the last slab it enters comes before the first it leaves (Kay & Kajiya 1986). Rounding of plane -
// origin, of 1 / direction and of their product is relative, so it is enough to widen every t by a relative amount (Ize 2013,
// "Robust BVH ray traversal"); with it, boxes also hold what the shear of watertight.h, relative to the same distances, moves
// out of them. A ray within a plane divides 0 by 0: not-a-number limits nothing.
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

  /// Which children are met before `limit`, and at which t their boxes are entered.
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

/// Calls leaf(first, count) for leaves along the ray, near ones first as far as their boxes tell, until it returns true; leaves
/// out what begins beyond `limit`, which the calls may lower.
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
      // Most nodes let the ray on into one child. Its numbers need not wait until they are stored and loaded again.
      const int i = std::countr_zero(met);
      next = {entries[i], node->child[i], node->count[i]};
    } else {
      Waiting* const before = top;
      for (; met; met &= met - 1) {
        const int i = std::countr_zero(met);
        const Waiting child{entries[i], node->child[i], node->count[i]};
        // Sorted as they come: few are met.
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
