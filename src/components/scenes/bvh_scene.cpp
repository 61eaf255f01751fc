// BvhScene: Étendue's own bounding volume hierarchy, with eight children per node (wide_bvh.h).

#include "etendue/scene.h"
#include "primitives.h"
#include "wide_bvh.h"

namespace etendue {
namespace {

/// Triangles in SIMD layout. In lanes without a triangle all corners are the same point, which no ray hits.
struct Block {
  Floats corner[3][3] = {};                             ///< by corner and axis
  std::uint32_t owner[lanes] = {}, number[lanes] = {};  ///< the triangle's object, and its number within this object

  Floats operator()(int k, int axis) const { return corner[k][axis]; }
};

/// The hits of a ray on the triangles of a block. `met` has the bits of the triangles that are hit at a t in (0, limit).
struct BlockHit {
  CornerWeights<Floats> weights;
  Floats t;
  LaneBits met;

  [[gnu::always_inline]] BlockHit(const Block& block, const ShearedRay<Floats>& ray, float limit)
      : weights(corner_weights(ray, block)) {
    met = inside(weights);
    if (!met) return;
    t = plane_distance(ray, block);
    met &= less(Floats{}, t) & less(t, spread(limit));
  }
  void fill(int lane, Hit& hit) const {
    const float scale = 1 / (weights.a[lane] + weights.b[lane] + weights.c[lane]);
    hit.distance = t[lane];
    hit.u = weights.b[lane] * scale;
    hit.v = weights.c[lane] * scale;
  }
};

class BvhScene final : public Scene {
 public:
  static void describe(Description<BvhScene>& d) {
    d.summary(
        "A scene searched by a hierarchy of bounding boxes with eight children a node, the fastest structure for most scenes; "
        "no ray "
        "slips between triangles with common edges.",
        "Wald, Benthin & Boulos 2008, \"Getting rid of packets\"; Woop, Benthin & Wald 2013; Ize 2013");
  }

  bool find_nearest(const Ray& ray, Hit& hit) const override {
    Ray rest = ray;
    bool found = primitives_.nearest_endless(rest, hit);
    const ShearedRay<Floats> sheared(ray);
    const Block* block = nullptr;
    int met_lane = 0;
    traverse(bvh_, ray, rest.maximum, [&](std::uint32_t first, std::uint32_t count) {
      if (count & WideNode::objects) [[unlikely]] {
        for (std::uint32_t i = first; i < first + (count & ~WideNode::objects); ++i)
          if (objects_[i]->intersect(rest, hit)) {
            rest.maximum = hit.distance;
            block = nullptr;
            found = true;
          }
        return false;
      }
      for (std::uint32_t i = first; i < first + count; ++i) {
        const BlockHit here(blocks_[i], sheared, rest.maximum);
        for (LaneBits met = here.met; met; met &= met - 1) {
          const int lane = std::countr_zero(met);
          if (!(here.t[lane] < rest.maximum)) continue;
          here.fill(lane, hit);
          rest.maximum = hit.distance;
          block = &blocks_[i];
          met_lane = lane;
        }
      }
      return false;
    });
    if (!block) return found;
    name(*block, met_lane, hit);
    return true;
  }

  bool find_any(const Ray& ray) const override {
    if (primitives_.any_endless(ray)) return true;
    const ShearedRay<Floats> sheared(ray);
    bool found = false;
    traverse(bvh_, ray, ray.maximum, [&](std::uint32_t first, std::uint32_t count) {
      if (count & WideNode::objects) [[unlikely]] {
        for (std::uint32_t i = first; i < first + (count & ~WideNode::objects); ++i)
          if (objects_[i]->occludes(ray)) return found = true;
        return false;
      }
      for (std::uint32_t i = first; i < first + count; ++i)
        if (BlockHit(blocks_[i], sheared, ray.maximum).met) return found = true;
      return false;
    });
    return found;
  }

  void find_all(const Ray& ray, HitList& list) const override {
    primitives_.all_endless(ray, list);
    const ShearedRay<Floats> sheared(ray);
    traverse(bvh_, ray, ray.maximum, [&](std::uint32_t first, std::uint32_t count) {
      if (count & WideNode::objects) {
        for (std::uint32_t i = first; i < first + (count & ~WideNode::objects); ++i)
          if (!holds(list, objects_[i])) objects_[i]->all_hits(ray, list);
        return false;
      }
      for (std::uint32_t i = first; i < first + count; ++i) {
        const BlockHit here(blocks_[i], sheared, ray.maximum);
        for (LaneBits met = here.met; met; met &= met - 1) {
          const int lane = std::countr_zero(met);
          Hit hit;
          here.fill(lane, hit);
          name(blocks_[i], lane, hit);
          list.add(hit);
        }
      }
      return false;
    });
  }

 protected:
  void build(std::span<const SceneObject* const> finite) override {
    primitives_.gather(finite);
    std::vector<BvhPrimitive> boxes;
    boxes.reserve(primitives_.size());
    for (size_t i = 0; i < primitives_.size(); ++i)
      boxes.push_back({primitives_.bounds(i), std::uint32_t(i), primitives_.triangle(i)});
    bvh_ = build_wide_bvh(std::move(boxes));
    blocks_.clear();
    objects_.clear();
    for (WideNode& node : bvh_.nodes)
      for (int i = 0; i < lanes; ++i)
        if (node.count[i]) fill_leaf(node.child[i], node.count[i]);
    bvh_.order = {};
    primitives_.forget_items();
  }

 private:
  /// Whether a hit on one of this scene's own objects is in a list already. A caller that passes a list with a known hit needs
  /// only the hits on other objects.
  static bool holds(const HitList& list, const SceneObject* object) {
    for (int i = 0; i < list.size; ++i)
      if (list.hits[i].object == object && list.hits[i].depth == 0) return true;
    return false;
  }

  void name(const Block& block, int lane, Hit& hit) const {
    hit.object = primitives_.owner(block.owner[lane]);
    hit.primitive = block.number[lane];
    hit.depth = 0;
  }

  /// Copies the primitives of a leaf to blocks or to the list of objects, and sets the leaf's range to these.
  void fill_leaf(std::uint32_t& child, std::uint32_t& count) {
    const std::span<const std::uint32_t> own(bvh_.order.data() + child, count & ~WideNode::objects);
    if (count & WideNode::objects) {
      child = std::uint32_t(objects_.size());
      for (const std::uint32_t p : own) objects_.push_back(primitives_.object(p));
      return;
    }
    child = std::uint32_t(blocks_.size());
    for (size_t i = 0; i < own.size(); ++i) {
      const size_t lane = i % lanes;
      if (lane == 0) blocks_.emplace_back();
      Block& block = blocks_.back();
      block.owner[lane] = primitives_.owner_of(own[i]);
      block.number[lane] = primitives_.number(own[i]);
      for (int k = 0; k < 3; ++k) {
        const Point3& p = primitives_.corner(own[i], k);
        block.corner[k][0][lane] = p.x;
        block.corner[k][1][lane] = p.y;
        block.corner[k][2][lane] = p.z;
      }
    }
    count = std::uint32_t(blocks_.size()) - child;
  }

  Primitives primitives_;
  WideBvh bvh_;
  HugeVector<Block> blocks_;
  std::vector<const SceneObject*> objects_;
};

const Register<BvhScene> registered;

}  // namespace
}  // namespace etendue
