// A texture, out of tree: hexagonal tiles with joints between them.
#include "etendue/object_map.h"
#include "etendue/scene_object.h"

using namespace etendue;

// The centres of the tiles are a lattice in which neighbours are 1 apart: a grid with the periods 1 and sqrt(3), and the same
// grid moved by half of both. With d the offset from the nearest centre, h = max(|d.x|, |d.x| / 2 + sqrt(3) / 2 |d.y|) is 0 at
// the centre and 1/2 on the border between two tiles. A tile ends at h = (1 - joint) / 2, so tiles cover (1 - joint)^2 of the
// area.
class HexagonMap final : public ObjectMap {
  Ref<ObjectMap> tile = etendue::constant(0.6f), mortar = etendue::constant(0.2f);
  Vector2 repeat{8, 8};
  float joint = 0.1f;

 public:
  static void describe(Description<HexagonMap>& d) {
    d.summary("Hexagonal tiles over surface coordinates; they are regular where `repeat` has equal lengths along u and v.")
        .member<&HexagonMap::tile>("tile", "1", "the map of the tiles")
        .member<&HexagonMap::mortar>("mortar", "1", "the map between them")
        .member<&HexagonMap::repeat>("repeat", "1", "widths of a tile per unit of u, and per unit of v", soft(1, 100))
        .member<&HexagonMap::joint>("joint", "1", "thickness of the mortar over the width of a tile", range(0, 1));
  }
  void prepare() override {
    if (!tile) fail("tile", "a map is needed");
    if (!mortar) fail("mortar", "a map is needed");
    if (!(repeat.x > 0 && repeat.y > 0 && repeat.x < infinity && repeat.y < infinity))
      fail("repeat", "must be positive, finite numbers");
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    const float t = covered(p);
    return (1 - t) * mortar->color(p, w, use) + t * tile->color(p, w, use);
  }
  float scalar(const SurfacePoint& p) const override { return lerp(covered(p), mortar->scalar(p), tile->scalar(p)); }
  float largest() const override { return std::max(tile->largest(), mortar->largest()); }

 private:
  /// The fraction of a point's footprint that tiles cover.
  float covered(const SurfacePoint& p) const {
    constexpr float root3 = 1.7320508f;
    const float x = p.uv.x * repeat.x, y = p.uv.y * repeat.y, width = width_of(p), mean = square(1 - joint);
    if (!(std::abs(x) < 1e6f && std::abs(y) < 1e6f && width < 1)) return mean;
    const auto offset = [&](float moved) {
      const float a = x - moved, b = y - moved * root3;
      return Vector2{a - std::round(a), b - root3 * std::round(b / root3)};
    };
    const Vector2 d0 = offset(0), d1 = offset(0.5f);
    const Vector2 d = std::hypot(d0.x, d0.y) < std::hypot(d1.x, d1.y) ? d0 : d1;
    const float h = std::max(std::abs(d.x), 0.5f * std::abs(d.x) + 0.5f * root3 * std::abs(d.y));
    const float border = 0.5f - h, half = 0.5f * joint;
    if (!(width > 1e-4f)) return border < half ? 0.0f : 1.0f;
    // The joint is averaged as if it were straight; wide footprints tend to the mean over all tiles.
    const float covering = std::min(border + 0.5f * width, half) - std::max(border - 0.5f * width, -half);
    return lerp(square(width), 1 - clamp(covering / width, 0, 1), mean);
  }
  /// The side of a square with the area of the ray's footprint, in widths of a tile.
  float width_of(const SurfacePoint& point) const {
    if (!(point.footprint > 0)) return 0;
    SurfacePoint p = point;
    if (p.dpdu == Vector3{} && p.dpdv == Vector3{} && p.object) p.object->tangents(p);
    const float area = length(cross(p.dpdu, p.dpdv)) / (repeat.x * repeat.y);
    return p.footprint / std::sqrt(area * std::max(p.footprint_cosine, 1e-3f));
  }
};

static const Register<HexagonMap> registered;
