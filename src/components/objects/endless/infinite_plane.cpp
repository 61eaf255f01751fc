// InfinitePlane: an unbounded plane, such as a floor.

#include "etendue/placed_object.h"
#include "geometry/double_ray.h"
#include "geometry/geometry.h"

namespace etendue {
namespace {

class InfinitePlane final : public PlacedObject {
 public:
  static void describe(Description<InfinitePlane>& d) {
    d.summary(
        "The plane z = 0, facing +z; its surface coordinates are x and y in metres. It cannot emit: it would give off endless "
        "power.");
  }

  void prepare() override {
    // Computes limit_, the largest object-space coordinate whose transformed point stays within endless_box().
    double reach = 1, shift = 0;
    // Object-space coordinates are relative to the projection of the scene's origin onto the plane, so that floats are most
    // precise near the camera.
    use_scene_origin(transform);
    transform.set_inner_origin({transform.inner_origin().x, transform.inner_origin().y, 0});
    for (const AnimatedTransform::Key& key : transform.keys()) {
      const Transform t = transform.at(key.time);
      const Transform::Matrix& m = t.matrix();
      for (size_t row = 0; row < 12; row += 4) {
        reach = std::max(reach, double(std::abs(m[row])) + double(std::abs(m[row + 1])));
        shift = std::max(shift, double(std::abs(m[row + 3])));
      }
    }
    limit_ = (double(endless) - shift) / (transform.animated() ? 2 * reach : reach);
    if (!(limit_ > 0)) fail("transform", "moves the plane out of all bounds");
    place();
  }

  Extent extent() const override { return Extent::unbounded; }

 protected:
  Bounds3 local_bounds() const override { return {}; }  // not called: the plane is unbounded

  bool local_intersect(const Ray& ray, Hit& hit) const override {
    const DoubleRay r(ray);
    const double t = -r.origin[2] / r.direction[2];
    const float distance = float(t);
    if (!(distance > 0 && distance < ray.maximum)) return false;
    const double x = r.at(t, 0), y = r.at(t, 1);
    if (!(std::abs(x) < limit_ && std::abs(y) < limit_)) return false;
    hit.distance = distance;
    hit.primitive = 0;
    hit.u = float(x);
    hit.v = float(y);
    return true;
  }

  void local_point(const Ray&, const Hit& hit, LocalPoint& p) const override {
    p.position = {hit.u, hit.v, 0};
    p.normal = {0, 0, 1};
    p.uv = {float(double(hit.u) + transform.inner_origin().x), float(double(hit.v) + transform.inner_origin().y)};
    p.dpdu = {1, 0, 0};
    p.dpdv = {0, 1, 0};
    // z = 0 is exact, but a ray that starts on the plane must not hit it again because of the rounding of its own coordinates.
    p.error = 1e-12f;
  }

  double local_area() const override { return double(infinity); }
  float local_sample(Point2, LocalPoint&) const override { return 0; }
  float local_pdf(const SurfacePoint&) const override { return 0; }

 private:
  double limit_ = 0;  // [m]
};

const Register<InfinitePlane> registered;

}  // namespace
}  // namespace etendue
