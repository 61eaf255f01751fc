// A texture, out of tree: hexagonal tiles with joints between them.
#include "etendue/object_map.h"
#include "etendue/scene_object.h"

using namespace etendue;

// Neighbouring tiles have centres at a distance of 1. These are the points of two grids: one has the periods 1 and sqrt(3), the
// other is the same moved by half of both. At the offset d from the nearest centre the maximum of |d.x| and
// |d.x| / 2 + sqrt(3) / 2 |d.y| is 0 at the centre and 1/2 on the border between two tiles. The mortar begins at
// (1 - joint) / 2, so tiles cover (1 - joint)^2 of the surface.
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
  float largest() const override { return std::max(mortar->largest(), tile->largest()); }

 private:
  /// The fraction of the ray's footprint that tiles cover: 0 or 1 without a footprint, the mean for wide ones.
  float covered(const SurfacePoint& p) const {
    const float x = p.uv.x * repeat.x, y = p.uv.y * repeat.y;
    const Vector2 width = footprint(p);
    if (!(std::abs(x) < 1e6f && std::abs(y) < 1e6f && width.x < 1 && width.y < 1)) return square(1 - joint);
    if (width == Vector2{}) return is_tile(x, y);
    float sum = 0;
    for (int i = 0; i < 16; ++i)
      sum += is_tile(x + width.x * (float(i % 4) - 1.5f) / 4, y + width.y * (float(i / 4) - 1.5f) / 4);
    return sum / 16;
  }
  bool is_tile(float x, float y) const {
    constexpr float root3 = 1.7320508f;
    const auto offset = [&](float a, float b) { return Vector2{a - std::round(a), b - root3 * std::round(b / root3)}; };
    const Vector2 d0 = offset(x, y), d1 = offset(x - 0.5f, y - 0.5f * root3);
    const Vector2 d = std::hypot(d0.x, d0.y) < std::hypot(d1.x, d1.y) ? d0 : d1;
    return std::max(std::abs(d.x), 0.5f * (std::abs(d.x) + root3 * std::abs(d.y))) <= 0.5f * (1 - joint);
  }
  /// The widths of the footprint along u and v, in widths of a tile. Its direction on the surface is neglected.
  Vector2 footprint(const SurfacePoint& point) const {
    if (!(point.footprint > 0)) return {};
    SurfacePoint p = point;
    if (p.dpdu == Vector3{} && p.dpdv == Vector3{} && p.object) p.object->tangents(p);
    const float side = p.footprint / std::sqrt(std::max(p.footprint_cosine, 0.01f));  // of a square with its area [m]
    return {side / length(p.dpdu) * repeat.x, side / length(p.dpdv) * repeat.y};
  }
};

static const Register<HexagonMap> registered;
