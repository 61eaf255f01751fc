// BruteForceScene: tests every object for every ray. It is the fastest structure for a few dozen triangles, and the reference
// with which other structures are compared.

#include "etendue/mesh_facts.h"
#include "etendue/scene.h"
#include "etendue/shader.h"

#include "geometry/finite_ray.h"
#include "triangle_pairs.h"

namespace etendue {

class BruteForceScene final : public Scene {
 public:
  static void describe(Description<BruteForceScene>& d) {
    d.summary(
        "A scene that tests every object for every ray: triangles many at a time, the others one by one. The fastest "
        "for a few dozen triangles, and what other structures are checked against.",
        "triangle test: Moeller & Trumbore 1997");
  }

  bool find_nearest(const Ray& ray, Hit& hit) const override {
    return others_.empty() ? triangles_.nearest(ray, hit) : nearest_of_all(ray, hit);
  }

  void find_all(const Ray& ray, HitList& list) const override {
    triangles_.all(ray, list);
    const Inverse inverse(ray);
    for (const Other& other : others_)
      if (inverse.meets(other.bounds, ray.maximum)) other.object->all_hits(ray, list);
  }

  bool find_any(const Ray& ray) const override { return others_.empty() ? triangles_.any(ray) : any_of_all(ray); }

 protected:
  void build(std::span<const SceneObject* const> finite) override {
    triangles_.clear();
    others_.clear();
    for (const SceneObject* object : finite) {
      const std::optional<TriangleView> view = still_triangles(*object);
      if (view)
        triangles_.add(*object, *view, 2 * radius());
      else
        others_.push_back({object, object->bounds()});
    }
  }

 private:
  // Not inlined, so that find_nearest and find_any are a mere jump to the triangles' test if there are no other objects.
  [[gnu::noinline]] bool nearest_of_all(const Ray& ray, Hit& hit) const {
    if (!has_finite_squares(ray)) return false;
    bool found = triangles_.nearest(ray, hit);
    Ray rest = ray;
    if (found) rest.maximum = hit.distance;
    const Inverse inverse(ray);
    for (const Other& other : others_)
      if (inverse.meets(other.bounds, rest.maximum) && other.object->intersect(rest, hit)) {
        rest.maximum = hit.distance;
        found = true;
      }
    return found;
  }

  [[gnu::noinline]] bool any_of_all(const Ray& ray) const {
    if (!has_finite_squares(ray)) return false;
    if (triangles_.any(ray)) return true;
    const Inverse inverse(ray);
    for (const Other& other : others_)
      if (inverse.meets(other.bounds, ray.maximum) && other.object->occludes(ray)) return true;
    return false;
  }

  struct Other {
    const SceneObject* object;
    Bounds3 bounds;
  };

  /// Slab tests of boxes (Kay & Kajiya 1986). Rounding may make a box appear smaller by a few units in the last place, so the
  /// interval of t is widened.
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

  TrianglePairs triangles_;
  std::vector<Other> others_;
};

static const Register<BruteForceScene> registered;

}  // namespace etendue
