// LossyPlastic: a diffuse body under a dielectric microfacet coat, with the energy loss of Mitsuba 3's plastics.

#include <memory>

#include "components/shaders/microfacet/coated_body.h"
#include "components/shaders/microfacet/microfacet_quadrature.h"
#include "components/shaders/reflectance.h"

namespace etendue {
namespace {

// The model of the `roughplastic` and `plastic` of Mitsuba 3 (Jakob et al. 2022), for scenes that were made with it:
//   f = ks F D(m) G1(out) G1(in) / (4 |out.z in.z|) + T(out) T(in) rho / (pi eta^2 (1 - rho' R))  [1/sr]
// with rho' = rho if `nonlinear`, else 1. It differs from Plastic in three ways. Masking of the two directions is independent,
// and Beckmann's is the rational fit of Walter et al. 2007, eq. 27. T(v), the coat's transmittance, counts only light that a
// single facet refracts and that is not masked on the way in:
//   T(v) = mean over the normals m seen from v of (1 - F(v.m)) G1(t),  t the refracted direction.
// And R, the coat's reflectance from inside, likewise counts single reflections only. Light that hits more facets is lost: with
// a white body under GGX 9 % at alpha 0.1, 41 % at 0.4. T is linear between 64 values at mu = i / 63 and R is 2 / 64 times the
// sum over these of mu times the reflectance from inside, lobes is 1.6 % low. A smooth coat uses exact formulas for both, and
// loses nothing.
struct LossyCoat {
  static constexpr int count = 64;

  MicrofacetDistribution distribution;
  float eta;  ///< index of the coat over that in front
  float inside = 0, through_mean = 0;
  std::array<float, count> through{}, reflected{};  ///< tables of a rough coat, by the cosine

  LossyCoat(const MicrofacetDistribution& d, float index) : distribution(d), eta(index) {
    if (d.smooth()) {
      inside = mean_fresnel_dielectric(1 / eta);
      through_mean = 1 - mean_fresnel_dielectric(eta);
      return;
    }
    const albedo::Slopes slopes(d.kind, 96, 64, pi);
    double sum = 0, mean = 0;
    for (int i = 0; i < count; ++i) {
      const float mu = std::max(float(i) / (count - 1), 1e-6f);
      const Vector3 v{safe_sqrt(1 - mu * mu), 0, mu};
      through[size_t(i)] = float(once(slopes, v, eta, true));
      reflected[size_t(i)] = float(once(slopes, v, eta, false));
      sum += once(slopes, v, 1 / eta, false) * double(mu);
      mean += double(through[size_t(i)]) * double(mu) * (i == 0 || i == count - 1 ? 0.5 : 1);
    }
    inside = float(2 * sum / count);
    through_mean = float(2 * mean / (count - 1));
  }

  bool smooth() const { return distribution.smooth(); }
  float at(const std::array<float, count>& table, const Vector3& v) const {
    const float x = std::min(std::abs(v.z), 1.0f) * (count - 1);
    const size_t i = size_t(std::min(int(x), count - 2));
    return lerp(x - float(i), table[i], table[i + 1]);
  }
  float lets_through(const Vector3& v) const { return smooth() ? 1 - fresnel_dielectric(std::abs(v.z), eta) : at(through, v); }
  float throws_back(const Vector3& v) const { return smooth() ? fresnel_dielectric(std::abs(v.z), eta) : at(reflected, v); }

  float G1(const Vector3& v) const {
    const float slope2 = square(distribution.alpha_x) * (v.x * v.x + v.y * v.y), z2 = v.z * v.z;
    if (distribution.kind == MicrofacetDistribution::ggx) return 2 / (1 + std::sqrt(1 + slope2 / z2));
    if (!(slope2 > 0) || z2 >= 1.6f * 1.6f * slope2) return 1;
    const float a = std::sqrt(z2 / slope2);
    return (3.535f * a + 2.181f * a * a) / (1 + 2.276f * a + 2.577f * a * a);
  }

 private:
  /// The fraction of light from v (v.z > 0) that a single facet reflects, or refracts; integrated over slopes as in
  /// microfacet_quadrature.cpp.
  double once(const albedo::Slopes& slopes, const Vector3& v, float index, bool refracted) const {
    const float alpha = distribution.alpha_x;
    double sum = 0, seen = 0;
    for (size_t i = 0; i < slopes.x.size(); ++i) {
      const float x = alpha * slopes.x[i], y = alpha * slopes.y[i], projected = v.z - v.x * x;
      if (!(projected > 0)) continue;
      const Vector3 m = Vector3{-x, -y, 1} / std::sqrt(1 + x * x + y * y);
      float behind = 0;
      const float cosine = dot(v, m), f = fresnel_dielectric(cosine, index, behind);
      const double weight = double(slopes.weight[i] * projected);
      seen += weight;
      const Vector3 leaving = refracted ? refract(v, m, index, behind) : reflect(v, m);
      if (refracted ? f < 1 && leaving.z < 0 : leaving.z > 0) sum += weight * double((refracted ? 1 - f : f) * G1(leaving));
    }
    return sum / seen;  // normalizes the visible normals exactly, without the fit of G1(v)
  }
};

class LossyPlasticScatter final : public CoatedBodyScatter<LossyPlasticScatter> {
 public:
  LossyPlasticScatter(const SurfacePoint& p, const LossyCoat& coat, Spectrum body, Spectrum shine, bool nonlinear)
      : CoatedBodyScatter(p, Lobes((body.black() ? 0 : diffuse_reflection) |
                                   (shine.black() ? 0 : (coat.smooth() ? specular_reflection : glossy_reflection)))),
        coat_(coat),
        shine_(shine) {
    const Spectrum kept = nonlinear ? Spectrum(1.0f) - body * coat.inside : Spectrum(1 - coat.inside);
    body_ = body / (kept * square(coat.eta));
    body_weight_ = (body_ * coat.through_mean).average();
    shine_weight_ = shine.average();
  }

  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    Spectrum sum;
    if (lobes & diffuse_reflection) sum += body_ * (coat_.lets_through(out) * coat_.through_mean);
    if (lobes & (glossy_reflection | specular_reflection)) sum += shine_ * coat_.throws_back(out);
    return sum;
  }

  const MicrofacetDistribution& facets() const { return coat_.distribution; }
  float eta() const { return coat_.eta; }
  float through(const Vector3& v) const { return coat_.lets_through(v); }
  const Spectrum& body() const { return body_; }
  Spectrum coat(const Vector3& out, const Vector3& in, float fresnel, float density) const {
    return shine_ * (fresnel * density * coat_.G1(out) * coat_.G1(in) / (4 * std::abs(out.z * in.z)));
  }
  Spectrum mirrored(const Vector3& out, float) const { return shine_ * coat_.throws_back(out); }
  float coat_share(const Vector3& out, float through) const {
    const float coat = std::max(coat_.throws_back(out), 0.01f) * shine_weight_;
    return coat / (coat + through * body_weight_);
  }

 private:
  const LossyCoat& coat_;
  Spectrum body_;  ///< f of the body times pi / (T(out) T(in))
  Spectrum shine_;
  float body_weight_, shine_weight_;
};

class LossyPlastic final : public Shader {
 public:
  static void describe(Description<LossyPlastic>& d) {
    d.summary(
         "A diffuse body under a dielectric coat, with the losses of Mitsuba's plastic and roughplastic, to reproduce pictures "
         "made with those. Plastic loses nothing.",
         "Jakob et al. 2022, Mitsuba 3 renderer; Walter et al. 2007, Microfacet models for refraction through rough surfaces")
        .member<&LossyPlastic::color>("color", "1", "fraction of light the body under the coat reflects, per wavelength",
                                      Meaning::reflectance)
        .member<&LossyPlastic::reflection_tint>("reflection_tint", "1",
                                                "what light that the coat reflects is multiplied by; real coats have 1",
                                                Meaning::reflectance)
        .member<&LossyPlastic::ior>("ior", "1", "index of refraction of the coat over that in front", Range{0.25, 4},
                                    soft(1, 2.5))
        .member<&LossyPlastic::roughness>(
            "roughness", "1", "the alpha of the distribution of the coat's facets (not its square root); below 0.001 polished",
            range(0, 1))
        .member<&LossyPlastic::distribution>("distribution", "", "of the directions of facets", choices("ggx", "beckmann"))
        .member<&LossyPlastic::nonlinear>(
            "nonlinear", "",
            "whether light that the coat throws back to the body takes on its colour again, lobes makes colours deeper");
  }

  void prepare() override {
    require_reflectance(*this, "color", color);
    require_reflectance(*this, "reflection_tint", reflection_tint);
    coat_ = std::make_unique<const LossyCoat>(MicrofacetDistribution(distribution, roughness), ior);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    return arena.make<LossyPlasticScatter>(p, *coat_, reflectance_at(*color, p, w), reflectance_at(*reflection_tint, p, w),
                                           nonlinear);
  }
  /// Interpolation error of the albedo table.
  float albedo_error() const override { return 0.02f; }
  Lobes possible_lobes() const override {
    return Lobes(diffuse_reflection |
                 (MicrofacetDistribution(distribution, roughness).smooth() ? specular_reflection : glossy_reflection));
  }

  Ref<ObjectMap> color = constant(0.5f), reflection_tint = constant(1.0f);
  float ior = 1.49f, roughness = 0.1f;
  MicrofacetDistribution::Kind distribution = MicrofacetDistribution::beckmann;
  bool nonlinear = false;

 private:
  std::unique_ptr<const LossyCoat> coat_;
};

const Register<LossyPlastic> registered;

}  // namespace
}  // namespace etendue
