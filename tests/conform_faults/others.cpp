// Emissions, objects, filters, media and cameras with one fault each, which `etendue conform` must find.

#include "etendue/camera.h"
#include "etendue/core/warp.h"
#include "etendue/filter.h"
#include "etendue/phase_function.h"
#include "etendue/scene_object.h"
#include "etendue/shader.h"
#include "etendue/volume_shader.h"

namespace etendue {
namespace {

// ---- emission ----------------------------------------------------------------------------------------------------------

/// A correct emission except for what subclasses override: radiance 1 in all directions of a surface.
class Glow : public EmissionShader {
 public:
  Spectrum radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths&) const override {
    return emits(p, direction) ? Spectrum(1.0f) : Spectrum();
  }
  DirectionSample sample(const SurfacePoint& p, Point2 u) const override {
    if (p.normal == Normal3{}) return {warp::sphere(u), warp::sphere_pdf};
    bool behind = sides == Sides::back;
    if (sides == Sides::both) {
      behind = u.x >= 0.5f;
      u.x = std::min(2 * u.x - (behind ? 1 : 0), one_minus_epsilon);
    }
    Vector3 d = drawn(u);
    if (behind) d.z = -d.z;
    const Vector3 direction = Frame(p.normal).to_world(d);
    return {direction, pdf(p, direction)};
  }
  float pdf(const SurfacePoint& p, const Vector3& direction) const override {
    if (p.normal == Normal3{}) return warp::sphere_pdf;
    if (!emits(p, direction)) return 0;
    return std::abs(dot(p.normal, direction)) * inverse_pi * (sides == Sides::both ? 0.5f : 1.0f);
  }
  Spectrum power(const SceneObject& object, const Wavelengths&) const override {
    if (object.delta()) return 4 * pi;
    return pi * object.area() * (sides == Sides::both ? 2.0f : 1.0f);
  }

 protected:
  virtual Vector3 drawn(Point2 u) const { return warp::cosine_hemisphere(u); }
};

class WrongPowerEmission final : public Glow {
 public:
  static void describe(Description<WrongPowerEmission>& d) { d.summary("Radiance 1; forgets pi in its power."); }
  Spectrum power(const SceneObject& object, const Wavelengths& w) const override { return Glow::power(object, w) / pi; }
};
const Register<WrongPowerEmission> power;

class WrongDirectionsEmission final : public Glow {
 public:
  static void describe(Description<WrongDirectionsEmission>& d) {
    d.summary("Radiance 1; directions uniform, densities by cosine.");
  }

 protected:
  Vector3 drawn(Point2 u) const override { return warp::hemisphere(u); }
};
const Register<WrongDirectionsEmission> directions;

// ---- objects -----------------------------------------------------------------------------------------------------------

/// A correct object except for what subclasses override: the unit square of the xy plane, moved by its transform.
class Square : public SceneObject {
 public:
  Bounds3 bounds() const override {
    Bounds3 b;
    for (const float x : {0.0f, 1.0f})
      for (const float y : {0.0f, 1.0f}) b.add(transform.still()(Point3{x, y, 0}));
    const Vector3 margin{1e-4f, 1e-4f, 1e-4f};
    b.low = b.low - margin;
    b.high = b.high + margin;
    return b;
  }
  bool intersect(const Ray& ray, Hit& hit) const override {
    const Point3 o = transform.still().back(ray.origin);
    const Vector3 d = transform.still().back(ray.direction);
    const float t = -o.z / d.z;
    if (!(t > 0 && t < ray.maximum)) return false;
    const float x = o.x + t * d.x, y = o.y + t * d.y;
    if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1)) return false;
    hit.distance = t;
    hit.object = this;
    hit.primitive = 0;
    hit.u = x;
    hit.v = y;
    hit.depth = 0;
    return true;
  }
  void surface_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const override { place({hit.u, hit.v}, ray.time, p); }
  void tangents(SurfacePoint& p) const override {
    p.dpdu = transform.still()(Vector3{1, 0, 0});
    p.dpdv = transform.still()(Vector3{0, 1, 0});
  }
  float area(float) const override {
    return length(cross(transform.still()(Vector3{1, 0, 0}), transform.still()(Vector3{0, 1, 0})));
  }
  float area_pdf(const SurfacePoint&) const override { return 1 / Square::area(0); }
  SurfaceSample sample_area(Point2 u, float time) const override {
    SurfaceSample s;
    place(u, time, s.point);
    s.pdf = 1 / Square::area(0);
    return s;
  }

 private:
  void place(Point2 at, float time, SurfacePoint& p) const {
    p.object_position = {at.x, at.y, 0};
    p.object_normal = {0, 0, 1};
    p.position = transform.still()(p.object_position);
    p.error = 1e-6f * (1 + length(p.position - Point3{}));
    p.normal = p.shading_normal = normalize(transform.still()(p.object_normal));
    p.uv = at;
    p.dpdu = p.dpdv = {};
    p.time = time;
    p.object = this;
    p.primitive = 0;
    p.u = at.x;
    p.v = at.y;
  }
};

class WrongAreaSquare final : public Square {
 public:
  static void describe(Description<WrongAreaSquare>& d) { d.summary("A unit square that says it is twice as large."); }
  float area(float time) const override { return 2 * Square::area(time); }
};
const Register<WrongAreaSquare> area;

class WrongVisibleSquare final : public Square {
 public:
  static void describe(Description<WrongVisibleSquare>& d) {
    d.summary("A unit square whose solid-angle densities lack the cosine.");
  }
  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override {
    SurfaceSample s = SceneObject::sample_visible(from, u, time);
    s.pdf *= std::abs(dot(s.point.normal, s.direction));
    return s;
  }
};
const Register<WrongVisibleSquare> visible;

class MissWritingSquare final : public Square {
 public:
  static void describe(Description<MissWritingSquare>& d) { d.summary("A unit square that changes the hit on a miss."); }
  bool intersect(const Ray& ray, Hit& hit) const override {
    if (Square::intersect(ray, hit)) return true;
    hit.distance = ray.maximum;
    return false;
  }
};
const Register<MissWritingSquare> miss;

/// Says that it is closed, while its normals point away from whoever hits it, as on the inside of a closed surface.
class InwardSquare final : public Square {
 public:
  static void describe(Description<InwardSquare>& d) {
    d.summary("A unit square that says it is closed and shows its inside alone.");
  }
  bool closed() const override { return true; }
  void surface_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const override {
    Square::surface_point(ray, hit, p);
    if (dot(p.normal, ray.direction) < 0) p.normal = p.shading_normal = -p.normal;
  }
};
const Register<InwardSquare> inward;

/// The tangents are wrong on a fortieth of the square (0.16^2): `conform` may accept no more wrong steps than poles and
/// rounding explain.
class WrongTangentsSquare final : public Square {
 public:
  static void describe(Description<WrongTangentsSquare>& d) { d.summary("A unit square with a corner of wrong tangents."); }
  void tangents(SurfacePoint& p) const override {
    Square::tangents(p);
    if (p.uv.x < 0.16f && p.uv.y < 0.16f) p.dpdu = 1.1f * p.dpdu;
  }
};
const Register<WrongTangentsSquare> tangents;

class LostTangentsSquare final : public Square {
 public:
  static void describe(Description<LostTangentsSquare>& d) {
    d.summary("A unit square whose tangents are set with its points only.");
  }
  void surface_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const override {
    Square::surface_point(ray, hit, p);
    Square::tangents(p);
  }
  void tangents(SurfacePoint&) const override {}
};
const Register<LostTangentsSquare> lost_tangents;

// ---- filters -----------------------------------------------------------------------------------------------------------

class EndlessFilter final : public Filter {
 public:
  static void describe(Description<EndlessFilter>& d) { d.summary("A normal distribution that does not end at its radius."); }
  float weight(float x, float y) const override { return std::exp(-2 * (x * x + y * y)); }
  float radius() const override { return 1; }
};
const Register<EndlessFilter> filter;

// ---- media -------------------------------------------------------------------------------------------------------------

class WrongPhaseVolume final : public VolumeShader {
 public:
  static void describe(Description<WrongPhaseVolume>& d) {
    d.summary("Scatters alike in all directions, with a phase function that integrates to 1/2.")
        .member<&WrongPhaseVolume::scattering>("scattering", "1/m", "scattering coefficient", range(0.1, 10));
  }
  VolumeCoefficients coefficients(const Point3&, float, const Wavelengths&) const override { return {0, scattering, 0}; }
  bool homogeneous() const override { return true; }
  Spectrum majorant(const Wavelengths&) const override { return scattering; }
  float phase(const Point3&, const Vector3&, const Vector3&) const override { return warp::hemisphere_pdf / 4; }
  Vector3 sample_phase(const Point3&, const Vector3&, Point2 u, float& pdf) const override {
    pdf = warp::hemisphere_pdf / 4;
    return warp::sphere(u);
  }

  float scattering = 1;
};
const Register<WrongPhaseVolume> phase;

class BackwardPhase final : public PhaseFunction {
 public:
  static void describe(Description<BackwardPhase>& d) {
    d.summary("Says that light goes on, and sends it back.")
        .member<&BackwardPhase::slope>("slope", "1", "how much", range(0.5, 1));
  }
  float value(float h) const override { return (1 + slope * (1 - h)) / (4 * pi); }
  float sample(float u) const override {  // pdf (1 + slope (h - 1)) / 2, cdf ((1 - slope) h + slope h^2 / 2) / 2
    const float b = 1 - slope;
    return (std::sqrt(b * b + 4 * slope * u) - b) / slope;
  }

  float slope = 1;
};
const Register<BackwardPhase> backward;

// ---- cameras -----------------------------------------------------------------------------------------------------------

class SecretLensCamera final : public Camera {
 public:
  static void describe(Description<SecretLensCamera>& d) {
    d.summary("Parallel rays from points beside where they should begin, by the lens point that it says it does not look at.");
  }
  void set_film(int, int) override {}
  Ray ray(Point2 film, Point2 lens, float time) const override {
    Ray r;
    r.origin = {film.x + lens.x, film.y + lens.y, 0};
    r.direction = {0, 0, 1};
    r.time = time;
    return r;
  }
  bool has_lens() const override { return false; }
  std::optional<Point2> film_point(const Ray& r) const override { return Point2{r.origin.x, r.origin.y}; }
  std::optional<LensSample> sample_lens(const Point3&, float, Point2) const override { return std::nullopt; }
  float importance(const Ray&) const override { return 1; }
  CameraPdf pdf(const Ray&) const override { return {1, 1}; }
};
const Register<SecretLensCamera> secret_lens;

// ---- any component -----------------------------------------------------------------------------------------------------

class ForgetfulFilter final : public Filter {
 public:
  static void describe(Description<ForgetfulFilter>& d) {
    d.summary("A box whose radius is saved as a diameter: prepare() changes what was written.")
        .member<&ForgetfulFilter::half>("width", "1", "half the width [pixels]", range(0.5, 1e6));
  }
  void prepare() override { half *= 2; }
  float weight(float x, float y) const override { return std::abs(x) <= half && std::abs(y) <= half ? 1.0f : 0.0f; }
  float radius() const override { return half; }

  float half = 1;
};
const Register<ForgetfulFilter> forgetful;

}  // namespace
}  // namespace etendue
