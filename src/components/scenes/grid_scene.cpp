// GridScene: a uniform grid.

#include "cell_scene.h"

namespace etendue {
namespace {

class GridScene final : public CellScene<GridScene> {
 public:
  static void describe(Description<GridScene>& d) {
    d.summary(
         "A scene whose space is divided into equal cells, which rays walk through one by one. Quick to build, and fast when "
         "all parts are of about the same size and evenly spread; slow when a small part of the scene holds most of it.",
         "Amanatides & Woo 1987, \"A fast voxel traversal algorithm for ray tracing\"")
        .group("Structure")
        .member<&GridScene::resolution>("resolution", "1",
                                        "cells along the longest edge of the scene; 0: from the number of parts", range(0, 512),
                                        Effect::rebuild);
  }

  /// See CellScene.
  template <class Visit>
  void walk(const Ray& ray, const float& limit, const Visit& visit) const {
    if (offsets_.empty()) return;
    const CellRay r(ray);
    if (!r.sound) return;
    double entry = 0, exit = double(limit);
    for (int k = 0; k < 3; ++k) {
      const double t0 = (box_.low[k] - r.origin[k]) * r.inverse[k], t1 = (box_.high[k] - r.origin[k]) * r.inverse[k];
      entry = std::max(entry, std::min(t0, t1));
      exit = std::min(exit, std::max(t0, t1));
    }
    if (!(entry <= exit)) return;
    int cell[3], step[3];
    double next[3];  // t at which the ray leaves the cell along each axis
    const auto boundary = [&](int k) {
      return (box_.low[k] + (cell[k] + (step[k] > 0)) * edge_[k] - r.origin[k]) * r.inverse[k];
    };
    for (int k = 0; k < 3; ++k) {
      cell[k] = cell_at(r.origin[k] + entry * r.direction[k], k);
      step[k] = r.direction[k] > 0 ? 1 : -1;
      next[k] = boundary(k);
    }
    for (;;) {
      const size_t i = index(cell[0], cell[1], cell[2]);
      if (offsets_[i] != offsets_[i + 1] && visit(std::span(items_).subspan(offsets_[i], offsets_[i + 1] - offsets_[i])))
        return;
      const int k = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
      if (next[k] > double(limit)) return;
      cell[k] += step[k];
      if (cell[k] < 0 || cell[k] >= count_[k]) return;
      next[k] = boundary(k);  // computed anew, as increments would accumulate rounding errors
    }
  }

 protected:
  void build(std::span<const SceneObject* const> finite) override {
    primitives_.gather(finite);
    offsets_.clear();
    items_.clear();
    if (primitives_.size() == 0) return;
    enclose_all();
    choose_counts();
    // Two passes over all cells of all primitives: the first counts the primitives of each cell, the second stores them.
    offsets_.assign(size_t(count_[0]) * size_t(count_[1]) * size_t(count_[2]) + 2, 0);
    for_cells([&](size_t cell, std::uint32_t) { ++offsets_[cell + 2]; });
    std::uint64_t sum = 0;
    for (std::uint32_t& offset : offsets_) {
      sum += offset;
      if (sum >= std::numeric_limits<std::uint32_t>::max()) fail("resolution", "the cells hold more than can be counted");
      offset = std::uint32_t(sum);
    }
    items_.resize(offsets_.back());
    for_cells([&](size_t cell, std::uint32_t i) { items_[offsets_[cell + 1]++] = i; });
    offsets_.pop_back();
  }

 private:
  int resolution = 0;

  // The number of cells is this times the number of primitives: the factor that Wald et al. 2006 ("Ray tracing animated scenes
  // using coherent grid traversal") and Ize et al. 2007 ("Grid creation strategies for efficient ray tracing") found to be
  // good.
  static constexpr double cells_per_primitive = 5;
  static constexpr int most_cells = 512;  // along an axis
  // If the bounds of a primitive would overlap more cells than this on average, the cells are made larger.
  static constexpr double most_per_primitive = 24;

  int cell_at(double x, int k) const { return int(std::clamp((x - box_.low[k]) / edge_[k], 0.0, double(count_[k] - 1))); }
  size_t index(int x, int y, int z) const {
    return size_t(x) + size_t(count_[0]) * (size_t(y) + size_t(count_[1]) * size_t(z));
  }

  /// Sets the box around all primitives, slightly enlarged so that nothing lies in its faces and no edge has length 0.
  void enclose_all() {
    Bounds3 all;
    for (size_t i = 0; i < primitives_.size(); ++i) all.add(primitives_.bounds(i));
    const double longest = double(max_component(all.diagonal()));
    for (int k = 0; k < 3; ++k) {
      const double furthest = std::max(std::abs(double(all.low[k])), std::abs(double(all.high[k])));
      slack_[k] = 1e-6 * longest + 1e-12 * furthest + 1e-37;
      box_.low[k] = double(all.low[k]) - 2 * slack_[k];
      box_.high[k] = double(all.high[k]) + 2 * slack_[k];
    }
  }

  void choose_counts() {
    double edges[3], volume = 1, longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, edges[k] = box_.high[k] - box_.low[k]);
    // Flat scenes count as at least a hundredth of their longest edge thick.
    for (int k = 0; k < 3; ++k) volume *= std::max(edges[k], longest / 100);
    double cells_per_length =
        resolution > 0 ? resolution / longest : std::cbrt(cells_per_primitive * double(primitives_.size()) / volume);
    for (;; cells_per_length *= 0.7) {
      bool one = true;
      for (int k = 0; k < 3; ++k) {
        count_[k] = int(std::clamp(std::round(edges[k] * cells_per_length), 1.0, double(most_cells)));
        edge_[k] = edges[k] / count_[k];
        one &= count_[k] == 1;
      }
      if (one || resolution > 0) return;
      double sum = 0;
      for (size_t i = 0; i < primitives_.size(); ++i) {
        const CellRange range = cells_of(i);
        sum +=
            double(range.high[0] - range.low[0] + 1) * (range.high[1] - range.low[1] + 1) * (range.high[2] - range.low[2] + 1);
      }
      if (sum <= most_per_primitive * double(primitives_.size()) + 4096) return;
    }
  }

  struct CellRange {
    int low[3], high[3];  // inclusive
  };
  CellRange cells_of(size_t i) const {
    const Bounds3 own = primitives_.bounds(i);
    CellRange range;
    for (int k = 0; k < 3; ++k) {
      range.low[k] = cell_at(double(own.low[k]) - slack_[k], k);
      range.high[k] = cell_at(double(own.high[k]) + slack_[k], k);
    }
    return range;
  }

  /// Calls call(cell, primitive) for every cell that a primitive may overlap. The cells are slightly enlarged, so that a ray
  /// that by rounding visits the neighbour of the right cell finds the primitive there.
  template <class Call>
  void for_cells(const Call& call) const {
    for (size_t i = 0; i < primitives_.size(); ++i) {
      const CellRange range = cells_of(i);
      const bool single = range.low[0] == range.high[0] && range.low[1] == range.high[1] && range.low[2] == range.high[2];
      int c[3];
      for (c[2] = range.low[2]; c[2] <= range.high[2]; ++c[2])
        for (c[1] = range.low[1]; c[1] <= range.high[1]; ++c[1])
          for (c[0] = range.low[0]; c[0] <= range.high[0]; ++c[0]) {
            DoubleBox cell;
            for (int k = 0; k < 3; ++k) {
              cell.low[k] = box_.low[k] + c[k] * edge_[k] - slack_[k];
              cell.high[k] = box_.low[k] + (c[k] + 1) * edge_[k] + slack_[k];
            }
            if (single || primitives_.meets(i, cell)) call(index(c[0], c[1], c[2]), std::uint32_t(i));
          }
    }
  }

  DoubleBox box_;
  double edge_[3], slack_[3];           // size of a cell; by how much cells are enlarged [m]
  int count_[3] = {0, 0, 0};            // cells along each axis
  std::vector<std::uint32_t> offsets_;  // where the items of each cell begin, and where the last end
  std::vector<std::uint32_t> items_;    // primitives, cell after cell
};

const Register<GridScene> registered;

}  // namespace
}  // namespace etendue
