// OrenNayar: a rough diffuse surface (plaster, clay, the moon), which looks flatter than a Lambertian one and loses no energy.

#include "components/shaders/reflectance.h"
#include "components/shaders/scalar_map.h"
#include "eon.h"
#include "etendue/core/warp.h"
#include "etendue/scatter_model.h"

namespace etendue {
namespace {

// The model's value and albedo are those of eon.h; this file adds the sampling.
//
// Directions are sampled by clipped linearly transformed cosines (Portsmouth, Kutz & Hill 2025), mixed with the uniform pdf
// 1/(2 pi). A direction h of a cosine lobe is transformed by
//        | a 0 b |
//   M =  | 0 c 0 |   (x towards the azimuth of `out`)
//        | d 0 1 |
// to the direction of M h. Directions with d h.x + h.z < 0 would go below the surface: h is sampled from the rest of the lobe
// alone. Projected to the unit disc that rest lies, for d <= 0, between x = -sqrt(1 - y^2) and x = k sqrt(1 - y^2) with k = 1 /
// sqrt(1 + d^2), and has the area pi (1 + k) / 2: points uniform in the disc are compressed along x into it. The pdf is
//   p(in) = h.z / (pi (1 + k) / 2) |M h|^3 / det M   [1/sr].
// a, b, c, d and the share of the uniform pdf are the paper's fits. At mu = 1 the fit of d exceeds its limit 0 by its error,
// 0.003, so d is clamped to 0.
struct ClippedCosine {
  ClippedCosine(float mu, float r) {
    a = 1 + r * (0.303392f + (-0.518982f + 0.111709f * mu) * mu + (-0.276266f + 0.335918f * mu) * r);
    b = r * (-1.16407f + 1.15859f * mu + (0.150815f - 0.150105f * mu) * r) / (mu * mu * mu - 1.43545f);
    c = 1 + (0.20013f + (-0.506373f + 0.261777f * mu) * mu) * r;
    d = std::min((0.540852f + (-1.01625f + 0.475392f * mu) * mu) * r / (-1.0743f + mu * (0.0725628f + mu)), 0.0f);
    determinant = c * (a - b * d);
    part = 0.5f + 0.5f / std::sqrt(1 + d * d);
  }
  Vector3 sample(Point2 u) const {
    const Point2 disc = warp::disc(u);
    const float y = disc.y, x = part * disc.x - (1 - part) * safe_sqrt(1 - y * y), z = safe_sqrt(1 - x * x - y * y);
    return normalize(Vector3{a * x + b * z, c * y, d * x + z});
  }
  /// With the adjugate of M: M^-1 = adj / det, and |M h| = 1 / |M^-1 in|.
  float pdf(const Vector3& in) const {
    const Vector3 h{c * (in.x - b * in.z), (a - b * d) * in.y, c * (a * in.z - d * in.x)};
    return square(determinant / length_squared(h)) * std::max(h.z, 0.0f) * inverse_pi / part;
  }
  float a, b, c, d, determinant, part;
};

class OrenNayarScatter final : public ScatterModel<OrenNayarScatter> {
 public:
  OrenNayarScatter(const SurfacePoint& p, Spectrum color, float roughness)
      : ScatterModel(p, diffuse_reflection),
        lobe_(color, roughness),
        roughness_(roughness),
        uniform_(std::pow(roughness, 0.1f)) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? lobe_.value(out, in) : Spectrum();
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const { return out.z * in.z > 0 ? pdf_of(out, in) : 0; }
  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes, LocalSample& s) const {
    const float mu = std::abs(out.z);
    if (choice < uniform_share(mu)) {
      s.in = warp::hemisphere(u);
    } else {
      const Vector3 x = azimuth(out), v = ClippedCosine(mu, roughness_).sample(u);
      s.in = {v.x * x.x - v.y * x.y, v.x * x.y + v.y * x.x, v.z};
    }
    if (!(s.in.z > 0)) return false;
    if (out.z < 0) s.in.z = -s.in.z;
    s.pdf = pdf_of(out, s.in);
    s.value = lobe_.value(out, s.in) * std::abs(s.in.z);
    s.lobe = diffuse_reflection;
    return true;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    return lobes & diffuse_reflection ? lobe_.albedo(out) : Spectrum();
  }

 private:
  /// The cosine and sine of the azimuth of `out`.
  static Vector3 azimuth(const Vector3& out) {
    const float s2 = out.x * out.x + out.y * out.y;
    return s2 > 0 ? Vector3{out.x, out.y, 0} / std::sqrt(s2) : Vector3{1, 0, 0};
  }
  float uniform_share(float mu) const { return uniform_ * (0.162925f + mu * (-0.372058f + (0.538233f - 0.290822f * mu) * mu)); }

  float pdf_of(const Vector3& out, const Vector3& in) const {
    const float mu = std::abs(out.z), share = uniform_share(mu);
    const Vector3 x = azimuth(out);
    const Vector3 turned{in.x * x.x + in.y * x.y, in.y * x.x - in.x * x.y, std::abs(in.z)};
    return lerp(share, ClippedCosine(mu, roughness_).pdf(turned), warp::hemisphere_pdf);
  }

  EonLobe lobe_;
  float roughness_, uniform_;
};

class OrenNayar final : public Shader {
 public:
  static void describe(Description<OrenNayar>& d) {
    d.summary("A rough matt surface: flatter than a Lambertian one and brighter towards the light, without loss of energy.",
              "Portsmouth, Kutz & Hill 2025, EON: a practical energy-preserving rough diffuse BRDF (after Oren & Nayar 1994)")
        .member<&OrenNayar::color>("color", "1", "fraction of light each facet reflects, per wavelength", Meaning::reflectance)
        .member<&OrenNayar::roughness>("roughness", "1", "from 0 (Lambertian) to 1", Meaning::number, soft(0, 1));
  }
  void prepare() override {
    require_reflectance(*this, "color", color);
    require_scalar(*this, "roughness", roughness);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const Spectrum reflectance = reflectance_at(*color, p, w);
    if (reflectance.black()) return nullptr;
    return arena.make<OrenNayarScatter>(p, reflectance, scalar_at(*roughness, p));
  }
  /// Error of the fit of the albedo by the model's authors.
  float albedo_error() const override { return 0.01f; }
  Lobes possible_lobes() const override { return diffuse_reflection; }
  bool lossless() const override {
    const Color same = color->constant();
    return same && !same->varies() && same->at(550, ColorUse::reflectance) == 1;
  }

  Ref<ObjectMap> color = constant(0.5f), roughness = constant(0.5f);
};

const Register<OrenNayar> registered;

}  // namespace
}  // namespace etendue
