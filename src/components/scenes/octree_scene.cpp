// OctreeScene: an octree.

#include "cell_scene.h"

namespace etendue {
namespace {

class OctreeScene final : public CellScene<OctreeScene> {
 public:
  static void describe(Description<OctreeScene>& d) {
    d.summary(
         "A scene whose space is divided into eight equal cells, and these again where they hold much. Takes parts of all "
         "sizes; "
         "bounding volume hierarchies are faster.",
         "Revelles, Urena & Lastra 2000, \"An efficient parametric algorithm for octree traversal\"")
        .group("Structure")
        .member<&OctreeScene::max_depth>("max_depth", "1", "how often a cell is divided at most", range(0, deepest),
                                         Effect::rebuild)
        .member<&OctreeScene::leaf_size>("leaf_size", "1", "triangles and other objects that may stay together in a cell",
                                         at_least(1), Effect::rebuild, soft(1, 64), logarithmic);
  }

  /// See CellScene.
  template <class Visit>
  void walk(const Ray& ray, const float& limit, const Visit& visit) const {
    if (nodes_.empty()) return;
    const CellRay r(ray);
    if (!r.sound) return;
    double entry[3], exit[3];
    unsigned mirrored =
        0;  // axes of negative direction, in which the octree is mirrored so that the ray ascends along all axes
    for (int k = 0; k < 3; ++k) {
      entry[k] = (box_.low[k] - r.origin[k]) * r.inverse[k];
      exit[k] = (box_.high[k] - r.origin[k]) * r.inverse[k];
      if (r.direction[k] > 0) continue;
      std::swap(entry[k], exit[k]);
      mirrored |= 1u << k;
    }
    descend(nodes_[0], entry, exit, mirrored, limit, visit);
  }

 protected:
  void build(std::span<const SceneObject* const> finite) override {
    primitives_.gather(finite);
    nodes_.clear();
    items_.clear();
    if (primitives_.size() == 0) return;
    enclose_all();

    // Breadth-first: all cells of one depth are divided before those of the next, so that the limit of references, for memory,
    // affects all parts of the scene equally.
    struct Waiting {
      std::vector<std::uint32_t> items;
      DoubleBox box;
      int depth;
    };
    std::vector<Waiting> waiting(1);
    waiting[0].items.resize(primitives_.size());
    for (size_t i = 0; i < primitives_.size(); ++i) waiting[0].items[i] = std::uint32_t(i);
    waiting[0].box = box_;
    waiting[0].depth = 0;
    nodes_.emplace_back();
    size_t references = primitives_.size();
    const size_t most = most_per_primitive * primitives_.size() + 65536;
    for (size_t n = 0; n < nodes_.size(); ++n) {
      const Waiting cell = std::move(waiting[n]);
      std::vector<std::uint32_t> parts[8];
      size_t sum = 0;
      if (cell.items.size() > size_t(leaf_size) && cell.depth < max_depth && references < most) {
        for (unsigned c = 0; c < 8; ++c) {
          const DoubleBox box = widened(child_box(cell.box, c));
          for (const std::uint32_t i : cell.items)
            if (primitives_.meets(i, box)) parts[c].push_back(i);
          sum += parts[c].size();
        }
      }
      // A ray through a cell hits each of its eight parts with probability 1/4, the ratio of their surface areas, so the
      // expected number of tests after division is a quarter of the sum over the parts. The cell is divided only if this is
      // fewer tests.
      if (sum > 0 && sum < 4 * cell.items.size()) {
        nodes_[n].first = std::uint32_t(nodes_.size());
        for (unsigned c = 0; c < 8; ++c) {
          waiting.push_back({std::move(parts[c]), child_box(cell.box, c), cell.depth + 1});
          nodes_.emplace_back();
        }
        references += sum - cell.items.size();
      } else {
        nodes_[n].first = std::uint32_t(items_.size());
        nodes_[n].count = std::uint32_t(cell.items.size());
        nodes_[n].leaf = true;
        items_.insert(items_.end(), cell.items.begin(), cell.items.end());
      }
    }
  }

 private:
  static constexpr int deepest = 20;
  /// Cells are no longer divided when they hold this many references per primitive altogether.
  static constexpr size_t most_per_primitive = 16;

  int max_depth = 12;
  int leaf_size = 8;

  struct Node {
    std::uint32_t first = 0, count = 0;  ///< of a leaf: items; else the first of eight nodes, bit k: upper half along axis k
    bool leaf = false;
  };

  // In the mirrored octree the ray crosses the lower faces of a cell at t = `entry` and the upper faces at t = `exit`, for each
  // axis. It crosses the middle planes half way between, and the order of these crossings gives the sequence of the parts.
  template <class Visit>
  bool descend(const Node& node, const double (&entry)[3], const double (&exit)[3], unsigned mirrored, const float& limit,
               const Visit& visit) const {
    const double in = std::max({entry[0], entry[1], entry[2]}), out = std::min({exit[0], exit[1], exit[2]});
    if (out < 0 || in > out) return false;
    if (in > double(limit)) return true;
    if (node.leaf) return node.count > 0 && visit(std::span(items_).subspan(node.first, node.count));
    double middle[3];
    unsigned part = 0;  // the part that the ray enters first
    for (int k = 0; k < 3; ++k) {
      middle[k] = (entry[k] + exit[k]) / 2;
      if (middle[k] < in) part |= 1u << k;
    }
    for (;;) {
      double from[3], to[3];
      int across = 0;  // the axis along which the ray leaves the part
      for (int k = 0; k < 3; ++k) {
        const bool upper = part >> k & 1;
        from[k] = upper ? middle[k] : entry[k];
        to[k] = upper ? exit[k] : middle[k];
        if (to[k] < to[across]) across = k;
      }
      if (descend(nodes_[node.first + (part ^ mirrored)], from, to, mirrored, limit, visit)) return true;
      if (part >> across & 1) return false;
      part |= 1u << across;
    }
  }

  static DoubleBox child_box(const DoubleBox& box, unsigned child) {
    DoubleBox part = box;
    for (int k = 0; k < 3; ++k) (child >> k & 1 ? part.low[k] : part.high[k]) = (box.low[k] + box.high[k]) / 2;
    return part;
  }
  /// A slightly enlarged cell, so that a ray that by rounding visits the neighbour of the right cell finds a primitive there.
  DoubleBox widened(DoubleBox box) const {
    for (int k = 0; k < 3; ++k) {
      box.low[k] -= slack_;
      box.high[k] += slack_;
    }
    return box;
  }

  /// Sets the cube around all primitives, slightly enlarged so that nothing lies in its faces.
  void enclose_all() {
    Bounds3 all;
    for (size_t i = 0; i < primitives_.size(); ++i) all.add(primitives_.bounds(i));
    const double longest = double(max_component(all.diagonal()));
    double furthest = 0;
    for (int k = 0; k < 3; ++k) furthest = std::max({furthest, std::abs(double(all.low[k])), std::abs(double(all.high[k]))});
    slack_ = 1e-8 * longest + 1e-12 * furthest + 1e-37;
    for (int k = 0; k < 3; ++k) {
      const double middle = (double(all.low[k]) + double(all.high[k])) / 2;
      box_.low[k] = middle - longest / 2 - 4 * slack_;
      box_.high[k] = middle + longest / 2 + 4 * slack_;
    }
  }

  DoubleBox box_;
  double slack_ = 0;                  // by how much cells are enlarged [m]
  std::vector<Node> nodes_;           // the first is the root
  std::vector<std::uint32_t> items_;  // primitives, leaf after leaf
};

const Register<OctreeScene> registered;

}  // namespace
}  // namespace etendue
