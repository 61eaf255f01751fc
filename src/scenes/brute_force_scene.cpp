// BruteForceScene: tests everything. For a few dozen triangles the fastest, and for all others the one to compare with.

#include "etendue/scene.h"
#include "etendue/shader.h"

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace etendue {
namespace {

#if defined(__AVX512F__)
constexpr int lanes = 16;
#elif defined(__AVX__)
constexpr int lanes = 8;
#else
constexpr int lanes = 4;
#endif
using Floats = float __attribute__((vector_size(lanes * sizeof(float))));
using Ints = std::int32_t __attribute__((vector_size(lanes * sizeof(std::int32_t))));

inline bool any_of(const Ints& mask) {
#if defined(__AVX512F__)
  const __m512i m = std::bit_cast<__m512i>(mask);
  return _mm512_test_epi32_mask(m, m) != 0;
#else
  std::int32_t all = 0;
  for (int i = 0; i < lanes; ++i) all |= mask[i];
  return all != 0;
#endif
}

/// 1/x to about 2e-7: a division of all lanes would take as long as the rest of the test.
inline Floats reciprocal(const Floats& x) {
#if defined(__AVX512F__)
  const Floats y = std::bit_cast<Floats>(_mm512_rcp14_ps(std::bit_cast<__m512>(x)));
  return y * (2 - x * y);  // one step of Newton's method
#else
  return 1 / x;
#endif
}

/// The lane of the smallest value, the first of several.
inline int lowest_lane(const Floats& x) {
#if defined(__AVX512F__)
  const __m512 values = std::bit_cast<__m512>(x);
  const __m512 lowest = _mm512_set1_ps(_mm512_reduce_min_ps(values));
  return std::countr_zero(unsigned(_mm512_cmp_ps_mask(values, lowest, _CMP_EQ_OQ)));
#else
  int lane = 0;
  for (int i = 1; i < lanes; ++i)
    if (x[i] < x[lane]) lane = i;
  return lane;
#endif
}

/// Some triangles side by side: a corner, two edges and their cross product. A triangle of zeros is never hit: its t is
/// 0/0, which fails all comparisons.
struct alignas(64) Block {
  Floats vx, vy, vz, ax, ay, az, bx, by, bz, nx, ny, nz;
  Floats slack;  ///< see test
};

/// The ray in all lanes.
struct WideRay {
  Floats ox, oy, oz, dx, dy, dz;
  explicit WideRay(const Ray& r)
      : ox(Floats{} + r.origin.x),
        oy(Floats{} + r.origin.y),
        oz(Floats{} + r.origin.z),
        dx(Floats{} + r.direction.x),
        dy(Floats{} + r.direction.y),
        dz(Floats{} + r.direction.z) {}
};

// As in objects/triangle_test.h, for all lanes, with triangles a little wider than they are: by what u and v may be off, so
// that no ray slips between two that share an edge. The coordinates of C, C x D and the edges round by half a unit in the last
// place each, which makes an error of about 2 eps |C| |D| |e| / (N.D) of u or v: bounded where |C| is no more than the scene's
// diameter and the cosine no less than an eighth.
/// Returns which are hit with t in (0, limit).
inline Ints test(const Block& b, const WideRay& r, const Floats& limit, Floats& t, Floats& u, Floats& v) {
  const Floats cx = b.vx - r.ox, cy = b.vy - r.oy, cz = b.vz - r.oz;
  const Floats rx = cy * r.dz - cz * r.dy, ry = cz * r.dx - cx * r.dz, rz = cx * r.dy - cy * r.dx;
  const Floats inverse = reciprocal(b.nx * r.dx + b.ny * r.dy + b.nz * r.dz);
  t = (b.nx * cx + b.ny * cy + b.nz * cz) * inverse;
  u = (rx * b.bx + ry * b.by + rz * b.bz) * inverse;
  v = -(rx * b.ax + ry * b.ay + rz * b.az) * inverse;
  return (u >= -b.slack) & (v >= -b.slack) & (u + v <= 1 + b.slack) & (t > 0) & (t < limit);
}

}  // namespace

class BruteForceScene final : public Scene {
 public:
  static void describe(Description<BruteForceScene>& d) {
    d.summary(
        "A scene that tests every object for every ray: triangles many at a time, the others one by one. The fastest "
        "for a few dozen triangles, and what other structures are checked against.",
        "triangle test: Moeller & Trumbore 1997");
  }

  bool nearest(const Ray& ray, Hit& hit) const override {
    bool found = false;
    Ray rest = ray;
    if (!blocks_.empty()) {
      const WideRay wide(ray);
      Floats best = Floats{} + ray.maximum, best_u{}, best_v{};
      Ints where = Ints{} - 1;
      for (size_t i = 0; i < blocks_.size(); ++i) {
        Floats t, u, v;
        const Ints mask = test(blocks_[i], wide, best, t, u, v);
        best = mask ? t : best;
        best_u = mask ? u : best_u;
        best_v = mask ? v : best_v;
        where = mask ? Ints{} + std::int32_t(i) : where;
      }
      const int lane = lowest_lane(best);
      if (where[lane] >= 0) {
        const Slot& slot = slots_[size_t(where[lane]) * lanes + size_t(lane)];
        hit.distance = best[lane];
        hit.object = slot.object;
        hit.primitive = slot.primitive;
        hit.u = best_u[lane];
        hit.v = best_v[lane];
        hit.depth = 0;
        rest.maximum = hit.distance;
        found = true;
      }
    }
    if (!others_.empty()) {
      const Inverse inverse(ray);
      for (const Other& other : others_)
        if (inverse.meets(other.bounds, rest.maximum) && other.object->intersect(rest, hit)) {
          rest.maximum = hit.distance;
          found = true;
        }
    }
    return found;
  }

  void all(const Ray& ray, HitList& list) const override {
    const WideRay wide(ray);
    for (size_t i = 0; i < blocks_.size(); ++i) {
      Floats t, u, v;
      const Ints mask = test(blocks_[i], wide, Floats{} + ray.maximum, t, u, v);
      for (size_t lane = 0; lane < size_t(lanes) && any_of(mask); ++lane) {
        if (!mask[lane]) continue;
        const Slot& slot = slots_[i * lanes + lane];
        Hit hit;
        hit.distance = t[lane];
        hit.object = slot.object;
        hit.primitive = slot.primitive;
        hit.u = u[lane];
        hit.v = v[lane];
        list.add(hit);
      }
    }
    const Inverse inverse(ray);
    for (const Other& other : others_)
      if (inverse.meets(other.bounds, ray.maximum)) other.object->all_hits(ray, list);
  }

  bool any(const Ray& ray) const override {
    if (!blocks_.empty()) {
      const WideRay wide(ray);
      const Floats limit = Floats{} + ray.maximum;
      // A few blocks at a time without a branch, which would be guessed wrongly too often.
      constexpr size_t group = 4;
      for (size_t i = 0; i < blocks_.size(); i += group) {
        Ints hit{};
        for (size_t k = i; k < std::min(i + group, blocks_.size()); ++k) {
          Floats t, u, v;
          hit |= test(blocks_[k], wide, limit, t, u, v);
        }
        const bool met = any_of(hit);
        if (i + group >= blocks_.size() && others_.empty()) return met;
        if (met) return true;
      }
    }
    if (!others_.empty()) {
      const Inverse inverse(ray);
      for (const Other& other : others_)
        if (inverse.meets(other.bounds, ray.maximum) && other.object->occludes(ray)) return true;
    }
    return false;
  }

 protected:
  void build(std::span<const SceneObject* const> finite) override {
    blocks_.clear();
    slots_.clear();
    others_.clear();
    for (const SceneObject* object : finite) {
      const std::optional<TriangleView> view = object->triangles();
      if (!view) {
        others_.push_back({object, object->bounds()});
        continue;
      }
      for (size_t i = 0; i < view->triangles.size(); ++i) {
        const auto& t = view->triangles[i];
        add(object, std::uint32_t(i), view->positions[t[0]], view->positions[t[1]], view->positions[t[2]], 2 * radius());
      }
    }
  }

 private:
  struct Slot {
    const SceneObject* object;
    std::uint32_t primitive;
  };
  struct Other {
    const SceneObject* object;
    Bounds3 bounds;
  };

  /// For tests against boxes (Kay & Kajiya 1986). Rounding may make a box look smaller by a few units: it is widened.
  struct Inverse {
    Point3 origin;
    Vector3 d;
    explicit Inverse(const Ray& r) : origin(r.origin), d{1 / r.direction.x, 1 / r.direction.y, 1 / r.direction.z} {}
    bool meets(const Bounds3& b, float maximum) const {
      float near = 0, far = maximum;
      for (int k = 0; k < 3; ++k) {
        const float t0 = (b.low[k] - origin[k]) * d[k], t1 = (b.high[k] - origin[k]) * d[k];
        // Written so that a NaN (a ray within a side's plane) limits nothing.
        const float low = t0 < t1 ? t0 : t1, high = t0 < t1 ? t1 : t0;
        if (low == low && high == high) {
          near = std::max(near, low - 1e-6f * std::abs(low));
          far = std::min(far, high + 1e-6f * std::abs(high));
        }
      }
      return near <= far;
    }
  };

  void add(const SceneObject* object, std::uint32_t primitive, const Point3& p, const Point3& q, const Point3& r,
           float diameter) {
    const size_t lane = slots_.size() % lanes;
    if (lane == 0) blocks_.emplace_back();
    slots_.push_back({object, primitive});
    Block& b = blocks_.back();
    const Vector3 e1 = q - p, e2 = r - p, n = cross(e1, e2);
    b.vx[lane] = p.x;
    b.vy[lane] = p.y;
    b.vz[lane] = p.z;
    b.ax[lane] = e1.x;
    b.ay[lane] = e1.y;
    b.az[lane] = e1.z;
    b.bx[lane] = e2.x;
    b.by[lane] = e2.y;
    b.bz[lane] = e2.z;
    b.nx[lane] = n.x;
    b.ny[lane] = n.y;
    b.nz[lane] = n.z;
    constexpr float most = 1e-4f;  // of slivers
    b.slack[lane] = std::min(rounding_bound(16) * diameter * std::max(length(e1), length(e2)) / length(n), most);
  }

  std::vector<Block> blocks_;
  std::vector<Slot> slots_;  // what stands in each lane, block after block
  std::vector<Other> others_;
};

static const Register<BruteForceScene> registered;

}  // namespace etendue
