#include "wide_bvh.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_group.h>

#include <atomic>
#include <memory>

namespace etendue {
namespace {

using Corner = float __attribute__((vector_size(16)));

inline Corner smaller(Corner a, Corner b) { return a < b ? a : b; }
inline Corner larger(Corner a, Corner b) { return a > b ? a : b; }

/// A box whose three coordinates are computed at once by SIMD.
struct Box {
  Corner low = Corner{} + infinity, high = Corner{} - infinity;
  void add(const Box& b) {
    low = smaller(low, b.low);
    high = larger(high, b.high);
  }
  void add(Corner p) {
    low = smaller(low, p);
    high = larger(high, p);
  }
  /// Half of the surface area.
  float area() const {
    const Corner d = high - low;
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
  }
};

struct Item {
  Box box;
  std::uint32_t index;
  bool triangle;
  Corner centre() const { return box.low + box.high; }  // twice the centre: only used in comparisons
};

struct Counts {
  std::uint32_t triangles = 0, objects = 0;
  std::uint32_t sum() const { return triangles + objects; }
  /// The cost of intersecting them, in units of the test of a block of triangles.
  float cost() const { return float((triangles + lanes - 1) / lanes) + 3 * float(objects); }
  void add(const Counts& b) {
    triangles += b.triangles;
    objects += b.objects;
  }
};

/// The common bounding box and the counts of some items.
struct Group {
  Box box;
  Counts counts;

  void add(const Item& item) {
    box.add(item.box);
    counts.triangles += item.triangle;
    counts.objects += !item.triangle;
  }
  void add(const Group& b) {
    box.add(b.box);
    counts.add(b.counts);
  }
};

/// A contiguous range of items.
struct Part : Group {
  size_t begin = 0, end = 0;
  Box centres;
  bool leaf = false;

  void add(const Item& item) {
    Group::add(item);
    centres.add(item.centre());
  }
  size_t size() const { return end - begin; }
  bool mixed() const { return counts.triangles && counts.objects; }
  /// Triangles and objects do not share a leaf, nor do objects.
  bool must_split() const { return mixed() || counts.objects > 1; }
  bool one_block() const { return counts.objects == 0 && counts.triangles <= lanes; }
};

constexpr int bins = 16;
// The cost of a split: splitting pays if the cost of the rest decreases by more. It is a fraction of a node's test, as one test
// separates eight children, which are made by three successive splits.
constexpr float split_cost = 0.3f;
// Smaller numbers of items are processed by one thread.
constexpr size_t few_to_sort = 1 << 16, few_to_build = 1 << 12;

/// Items binned by their centres, along each axis, in slices of the box of all centres.
struct Bins {
  Box centres;
  Corner scale;
  Group slice[3][bins];

  explicit Bins(const Box& all_centres) : centres(all_centres) {
    const Corner extent = centres.high - centres.low;
    for (int k = 0; k < 3; ++k) {
      const float s = float(bins) * (1 - 1e-5f) / extent[k];
      scale[k] = extent[k] > 0 && s < infinity ? s : 0;  // 0: all items are in the first slice
    }
  }
  int slice_of(Corner centre, int axis) const {
    return std::clamp(int((centre[axis] - centres.low[axis]) * scale[axis]), 0, bins - 1);
  }
  void add(const Item& item) {
    const Corner centre = item.centre();
    for (int k = 0; k < 3; ++k) slice[k][slice_of(centre, k)].add(item);
  }
  void add(const Bins& b) {
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < bins; ++i) slice[k][i].add(b.slice[k][i]);
  }
};

class Builder {
 public:
  explicit Builder(std::vector<Item> items)
      : items_(std::move(items)), nodes_(std::make_unique_for_overwrite<WideNode[]>(items_.size())) {}

  WideBvh build() {
    Part all;
    all.end = items_.size();
    for (const Item& item : items_) all.add(item);
    node_for(all, 0);
    WideBvh bvh;
    bvh.nodes.reserve(used_);
    copy(0, bvh.nodes);
    bvh.order.reserve(items_.size());
    for (const Item& item : items_) bvh.order.push_back(item.index);
    return bvh;
  }

 private:
  /// Builds the node over a range of items and all nodes below it; returns the node's number.
  std::uint32_t node_for(const Part& part, int depth) {
    const std::uint32_t number = used_++;
    Part children[lanes];
    int count = 1;
    children[0] = part;
    while (count < lanes) {
      // The child with the largest surface area is split first, as most rays hit it.
      int largest = -1;
      for (int i = 0; i < count; ++i)
        if (!children[i].leaf && (largest < 0 || children[i].box.area() > children[largest].box.area())) largest = i;
      if (largest < 0) break;
      Part& chosen = children[largest];
      Part rest;
      if (split(chosen, rest, depth))
        children[count++] = rest;
      else
        chosen.leaf = true;
    }
    WideNode& node = nodes_[number];
    for (int i = 0; i < lanes; ++i) {
      Part& child = children[i];
      child.leaf |= child.one_block();
      for (int k = 0; k < 3; ++k) {
        node.sides[2 * k][i] = i < count ? child.box.low[k] : infinity;
        node.sides[2 * k + 1][i] = i < count ? child.box.high[k] : -infinity;
      }
      node.child[i] = i < count ? std::uint32_t(child.begin) : 0;
      // An unused child is a leaf of 0 objects, so that it is not a node that rays could visit.
      node.count[i] = i >= count                 ? WideNode::objects
                      : !child.leaf              ? 0
                      : child.counts.objects > 0 ? child.counts.sum() | WideNode::objects
                                                 : child.counts.sum();
    }
    tbb::task_group others;
    for (int i = 0; i < count; ++i) {
      if (children[i].leaf) continue;
      const auto below = [this, &node, i, child = children[i], depth] { node.child[i] = node_for(child, depth + 1); };
      if (children[i].size() > few_to_build)
        others.run(below);
      else
        below();
    }
    others.wait();
    return number;
  }

  /// Splits a part in two; false: it should remain a leaf.
  bool split(Part& part, Part& rest, int depth) {
    if (part.one_block()) return false;
    const bool must = part.must_split();
    // Where sizes differ by orders of magnitude repeatedly, the surface area heuristic makes deep hierarchies: below this depth
    // parts are split by count.
    if (depth < deepest_bvh / 2) {
      const Bins sorted = sort(part);
      const Plane plane = best_plane(sorted);
      if (plane.axis >= 0) {
        if (!must && plane.cost + split_cost * part.box.area() >= part.box.area() * part.counts.cost()) return false;
        return divide(part, rest, [&](const Item& item) { return sorted.slice_of(item.centre(), plane.axis) < plane.slice; });
      }
      if (!must) return false;  // all centres coincide
    }
    if (part.mixed()) return divide(part, rest, [](const Item& item) { return item.triangle; });
    const Item* const middle = &items_[(part.begin + part.end) / 2];
    return divide(part, rest, [&](const Item& item) { return &item < middle; });
  }

  Bins sort(const Part& part) const {
    const auto sorted = [this](const tbb::blocked_range<size_t>& range, Bins some) {
      for (size_t i = range.begin(); i < range.end(); ++i) some.add(items_[i]);
      return some;
    };
    const tbb::blocked_range<size_t> all(part.begin, part.end, few_to_sort / 4);
    const Bins none(part.centres);
    if (part.size() < few_to_sort) return sorted(all, none);
    return tbb::parallel_reduce(all, none, sorted, [](Bins a, const Bins& b) {
      a.add(b);
      return a;
    });
  }

  struct Plane {
    int axis = -1, slice = 0;
    float cost = infinity;
  };
  static Plane best_plane(const Bins& sorted) {
    Plane best;
    for (int k = 0; k < 3; ++k) {
      if (!(sorted.scale[k] > 0)) continue;
      float above[bins];  // cost of the items in slice i and beyond
      Group sum;
      for (int i = bins; i-- > 1;) {
        sum.add(sorted.slice[k][i]);
        above[i] = sum.counts.sum() ? sum.box.area() * sum.counts.cost() : infinity;
      }
      sum = {};
      for (int i = 1; i < bins; ++i) {
        sum.add(sorted.slice[k][i - 1]);
        if (!sum.counts.sum()) continue;
        const float cost = sum.box.area() * sum.counts.cost() + above[i];
        if (cost < best.cost) best = {k, i, cost};
      }
    }
    return best;
  }

  /// Items for which first(item) is true stay in the part, the others go to `rest`. False: one of the two would be empty.
  template <class First>
  bool divide(Part& part, Part& rest, const First& first) {
    Part left, right;
    // Like std::partition, but the predicate is called once for each item, at the item's original position.
    size_t i = part.begin, j = part.end;
    while (i < j) {
      if (first(items_[i])) {
        left.add(items_[i++]);
        continue;
      }
      for (--j; i < j && !first(items_[j]); --j) right.add(items_[j]);
      right.add(items_[i]);
      if (i < j) {
        std::swap(items_[i], items_[j]);
        left.add(items_[i++]);
      }
    }
    left.begin = part.begin;
    left.end = right.begin = i;
    right.end = part.end;
    if (left.begin == left.end || right.begin == right.end) return false;
    part = left;
    rest = right;
    return true;
  }

  /// Copies the nodes in depth-first order, each followed by its first child, independent of the order in which threads made
  /// them.
  std::uint32_t copy(std::uint32_t number, HugeVector<WideNode>& to) const {
    const std::uint32_t place = std::uint32_t(to.size());
    to.push_back(nodes_[number]);
    for (int i = 0; i < lanes; ++i) {
      if (to[place].count[i] || !(to[place].sides[0][i] < infinity)) continue;
      const std::uint32_t child = copy(nodes_[number].child[i], to);
      to[place].child[i] = child;
    }
    return place;
  }

  std::vector<Item> items_;
  std::unique_ptr<WideNode[]> nodes_;  // the largest possible number; pages that are not touched take no memory
  std::atomic<std::uint32_t> used_ = 0;
};

}  // namespace

WideBvh build_wide_bvh(std::vector<BvhPrimitive> primitives) {
  if (primitives.empty()) return {};
  std::vector<Item> items;
  items.reserve(primitives.size());
  for (const BvhPrimitive& p : primitives) {
    const Point3 &low = p.bounds.low, &high = p.bounds.high;
    const Box box{Corner{low.x, low.y, low.z, 0}, Corner{high.x, high.y, high.z, 0}};
    items.push_back({box, p.index, p.triangle});
  }
  primitives = {};
  return Builder(std::move(items)).build();
}

}  // namespace etendue
