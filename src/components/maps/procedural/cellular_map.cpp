// Cellular texture.

#include "components/maps/combining/blend.h"

namespace etendue {
namespace {

enum class Measure : std::uint8_t { nearest, second_nearest, difference, cell };

// Worley 1996: feature points are scattered through space, here one at a random position in each cube of a lattice, and
// F1 <= F2 <= … are the distances from p to the nearest, the second nearest, … of them. F2 - F1 is 0 on the borders of the
// Voronoi cells.
class CellularMap final : public SolidMap {
 public:
  static void describe(Description<CellularMap>& d) {
    d.summary("Cells around random points, between two maps.", "Worley 1996, \"A cellular texture basis function\"");
    describe_solid(d, "size of the cells")
        .member<&CellularMap::measure>(
            "measure", "",
            "nearest: distance to the nearest point; second_nearest: to the second; difference: of both, 0 on borders of "
            "cells; "
            "cell: one random number for each cell. Distances are over the size of the cells, and at most 1",
            choices("nearest", "second_nearest", "difference", "cell"));
  }

  Measure measure = Measure::nearest;

 private:
  float fraction(const SolidPoint& p) const override {
    // Means over all space, measured over 4e6 points.
    static constexpr float means[] = {0.5202f, 0.7162f, 0.1963f, 0.5f};
    const float mean = means[int(measure)];
    const float remains = noise_remains(p.width);
    if (remains == 0) return mean;
    Nearest n;
    if (!find(p.at, n)) return mean;
    float value = 0;
    switch (measure) {
      case Measure::nearest: value = std::sqrt(n.first); break;
      case Measure::second_nearest: value = std::sqrt(n.second); break;
      case Measure::difference: value = std::sqrt(n.second) - std::sqrt(n.first); break;
      case Measure::cell: value = to_unit_float(std::uint32_t(mix_bits(n.cell))); break;
    }
    return mean + remains * (std::min(value, 1.0f) - mean);
  }

  struct Nearest {
    float first = infinity, second = infinity;  // distances squared
    std::uint32_t cell = 0;
  };

  // The cubes around p are visited ring by ring; cubes that are farther away than the second nearest point so far are skipped.
  // As each cube contains a point, the second nearest point is never more than two cubes away.
  bool find(const Vector3& p, Nearest& n) const {
    constexpr float most = 1e9f;
    if (!(std::abs(p.x) < most && std::abs(p.y) < most && std::abs(p.z) < most)) return false;
    const float fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
    const Vector3 at{p.x - fx, p.y - fy, p.z - fz};
    const auto gap = [](int i, float x) { return i > 0 ? float(i) - x : (i < 0 ? x - float(i + 1) : 0.0f); };
    for (int ring = 0; ring <= 2; ++ring) {
      const float nearest_side = std::min({at.x, at.y, at.z, 1 - at.x, 1 - at.y, 1 - at.z});
      if (ring > 0 && n.second <= square(nearest_side + float(ring - 1))) break;
      for (int z = -ring; z <= ring; ++z)
        for (int y = -ring; y <= ring; ++y) {
          const bool inner = std::abs(z) < ring && std::abs(y) < ring;
          for (int x = -ring; x <= ring; x += inner ? 2 * ring : 1) {
            if (square(gap(x, at.x)) + square(gap(y, at.y)) + square(gap(z, at.z)) >= n.second) continue;
            const std::uint32_t h = lattice_hash(int(fx) + x, int(fy) + y, int(fz) + z, seed);
            const std::uint64_t bits = mix_bits(h + 0x9e3779b97f4a7c15ull);
            const Vector3 d =
                Vector3{float(x) + float(bits & 0x1fffff) * 0x1p-21f, float(y) + float(bits >> 21 & 0x1fffff) * 0x1p-21f,
                        float(z) + float(bits >> 42 & 0x1fffff) * 0x1p-21f} -
                at;
            const float d2 = dot(d, d);
            if (d2 < n.first) {
              n.second = n.first;
              n.first = d2;
              n.cell = h;
            } else if (d2 < n.second) {
              n.second = d2;
            }
          }
        }
    }
    return true;
  }
};

const Register<CellularMap> registered;

}  // namespace
}  // namespace etendue
