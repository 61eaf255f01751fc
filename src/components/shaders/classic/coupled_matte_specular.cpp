// CoupledMatteSpecular: a specular coat over a diffuse base (varnished wood, tiles), which darkens where the coat reflects
// more.

#include "components/shaders/half_vector.h"
#include "components/shaders/reflectance.h"
#include "etendue/core/warp.h"
#include "etendue/scatter_model.h"

namespace etendue {
namespace {

// The coupled model of Shirley, Hu, Smits & Lafortune 1997. The coat is specular, with the reflectance
//   R(theta) = R0 + (1 - R0) (1 - cos(theta))^5,
// and the light it transmits is scattered by the base:
//   f = k Rm (1 - R(theta)) (1 - R(theta')),  k = 21 / (20 pi (1 - R0))  [1/sr].
// k makes the albedo of the base Rm (1 - R(theta)): the integral of (1 - (1 - c)^5) c over the hemisphere is 2 pi (1/2 - 1/42)
// = 20 pi / 21. So the total albedo is R + Rm (1 - R), and no light is lost when Rm = 1. With g(c) = 1 - (1 - c)^5,  1 - R = (1
// - R0) g  and  f = 21 / (20 pi) Rm (1 - R0) g(cos(theta)) g(cos(theta')).
//
// Sampling: coat or base is chosen in proportion to their albedos (means over the path's wavelengths), the base's directions
// with the pdf cos / pi; the base's weight varies with g(cos(theta')) only.
class CoupledScatter final : public ScatterModel<CoupledScatter> {
 public:
  CoupledScatter(const SurfacePoint& p, Lobes lobes, Spectrum matte, Spectrum normal_reflectance)
      : ScatterModel(p, lobes), base_(matte * (Spectrum(1.0f) - normal_reflectance)), normal_reflectance_(normal_reflectance) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes lobes) const {
    if (!(lobes & diffuse_reflection) || !(out.z * in.z > 0)) return {};
    return base_ * (21 / (20 * pi) * passed(out) * passed(in));
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
    if (!(lobes & diffuse_reflection) || !(out.z * in.z > 0)) return 0;
    return (1 - mirror_probability(out, lobes)) * std::abs(in.z) * inverse_pi;
  }
  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    const float mirror = mirror_probability(out, lobes);
    if (choice < mirror) {
      s.in = {-out.x, -out.y, out.z};
      s.value = reflectance(out);
      s.pdf = mirror;
      s.lobe = specular_reflection;
      return true;
    }
    s.in = warp::cosine_hemisphere(u);
    s.pdf = (1 - mirror) * s.in.z * inverse_pi;
    s.value = base_ * (21 / (20 * pi) * passed(out) * passed(s.in) * s.in.z);
    s.lobe = diffuse_reflection;
    if (out.z < 0) s.in.z = -s.in.z;
    return s.pdf > 0;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    Spectrum sum;
    if (lobes & diffuse_reflection) sum += base_ * passed(out);
    if (lobes & specular_reflection) sum += reflectance(out);
    return sum;
  }

 private:
  /// g: the transmittance of the coat over that at normal incidence.
  static float passed(const Vector3& v) { return 1 - schlick_growth(std::abs(v.z)); }
  Spectrum reflectance(const Vector3& v) const { return Spectrum(1.0f) - (Spectrum(1.0f) - normal_reflectance_) * passed(v); }
  float mirror_probability(const Vector3& out, Lobes lobes) const {
    if (!(lobes & specular_reflection)) return 0;
    if (!(lobes & diffuse_reflection)) return 1;
    const float mirror = reflectance(out).average(), matte = base_.average() * passed(out);
    return mirror / (mirror + matte);
  }

  Spectrum base_, normal_reflectance_;  ///< base_: Rm (1 - R0)
};

class CoupledMatteSpecular final : public Shader {
 public:
  static void describe(Description<CoupledMatteSpecular>& d) {
    d.summary("A polished surface over a matt base, which fades towards grazing angles as the polish reflects more.",
              "Shirley, Hu, Smits & Lafortune 1997, A practitioners' assessment of light reflection models")
        .member<&CoupledMatteSpecular::color>(
            "color", "1", "fraction the base reflects of the light that reaches it, per wavelength", Meaning::reflectance)
        .member<&CoupledMatteSpecular::specular>(
            "specular", "1", "fraction the polish reflects at normal incidence, per wavelength", Meaning::reflectance);
  }
  void prepare() override {
    require_reflectance(*this, "color", color);
    require_reflectance(*this, "specular", specular);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const Spectrum matte = reflectance_at(*color, p, w), normal_reflectance = reflectance_at(*specular, p, w);
    const bool base = !(matte * (Spectrum(1.0f) - normal_reflectance)).black();
    return arena.make<CoupledScatter>(p, Lobes(specular_reflection | (base ? diffuse_reflection : 0)), matte,
                                      normal_reflectance);
  }
  Lobes possible_lobes() const override { return diffuse_reflection | specular_reflection; }
  bool lossless() const override {
    const Color same = color->constant();
    return same && !same->varies() && same->at(550, ColorUse::reflectance) == 1;
  }

  Ref<ObjectMap> color = constant(0.5f), specular = constant(0.05f);
};

const Register<CoupledMatteSpecular> registered;

}  // namespace
}  // namespace etendue
