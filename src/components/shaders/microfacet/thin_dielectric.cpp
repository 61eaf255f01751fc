// ThinDielectric: a pane of glass, so thin that light leaves it where it came in.

#include "components/shaders/fresnel.h"
#include "components/shaders/polarized_fresnel.h"
#include "components/shaders/reflectance.h"
#include "etendue/scatter_model.h"
#include "etendue/transport/medium_stack.h"
#include "rough_dielectric.h"
#include "roughness.h"

namespace etendue {
namespace {

// Light is reflected back and forth inside a slab: with R the reflectance of one boundary, the same from both sides, and a the
// transmittance of one passage, the contributions sum to geometric series (Stokes 1862):
//   R' = R + (1 - R)^2 a^2 R / (1 - a^2 R^2),  T' = (1 - R)^2 a / (1 - a^2 R^2);  T' = (1 - R) / (1 + R) where a = 1.
// They hold for each polarization separately, as no passage or reflection changes it; unpolarized light is half of each. The
// slab is thicker than the light's coherence length, so intensities add. A passage at the angle of cosine c' inside is 1 / c'
// times as long as one along the normal: a = color^(1 / c'). pbrt and Mitsuba use the mean of both polarizations' R in the
// series instead, as `polarizations: averaged` does: at oblique angles, where the two differ most, less is reflected (R_s = 0.3
// and R_p = 0.05 give 0.298 apart and 0.278 averaged).
enum class Polarizations : std::uint8_t { apart, averaged };

class ThinDielectricScatter final : public ScatterModel<ThinDielectricScatter>, public PolarizingScatter {
 public:
  /// eta: index of the slab over that around it; `passage`: transmittance of one passage along the normal.
  ThinDielectricScatter(const SurfacePoint& p, Spectrum eta, Spectrum passage, const BoundaryTint& tint, Polarizations kept)
      : ScatterModel(p, specular_reflection | null_scattering),
        eta_(eta),
        passage_(passage),
        tint_(tint),
        polarizations_(kept),
        clear_(passage.minimum() >= 1),
        flat_(eta.minimum() == eta.maximum() && passage.minimum() == passage.maximum()) {}

  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }

  bool local_sample(const Vector3& out, float choice, Point2, Lobes lobes, LocalSample& s) const {
    const Slab slab = tinted(slab_at(std::abs(out.z)));
    const float reflected = (lobes & specular_reflection) ? slab.reflected.average() : 0;
    const float transmitted = (lobes & null_scattering) ? slab.transmitted.average() : 0;
    if (!(reflected + transmitted > 0)) return false;
    const float probability = transmitted > 0 ? reflected / (reflected + transmitted) : 1;
    if (choice < probability) {
      s.in = {-out.x, -out.y, out.z};
      s.value = slab.reflected;
      s.pdf = probability;
      s.lobe = specular_reflection;
    } else {
      s.in = -out;
      s.value = slab.transmitted;
      s.pdf = 1 - probability;
      s.lobe = null_scattering;
    }
    return true;
  }

  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    const Slab slab = tinted(slab_at(std::abs(out.z)));
    Spectrum sum;
    if (lobes & specular_reflection) sum += slab.reflected;
    if (lobes & null_scattering) sum += slab.transmitted;
    return sum;
  }

  // With r = r_s r_p of one boundary, each pair of reflections inside multiplies a_p a_s* by a^2 r^2 and each passage of the
  // slab by a, so that the products add up to geometric series as the powers do:
  //   r + (1 - R_s)(1 - R_p) a^2 r / (1 - a^2 r^2)  in reflection,   (1 - R_s)(1 - R_p) a / (1 - a^2 r^2)  in transmission,
  // since the amplitudes through both boundaries have the product 1 - R. They hold for polarizations apart, whatever is chosen
  // for unpolarized light.
  bool polarization(const Vector3& out, const Vector3&, Lobes lobes, Polarization& event) const override {
    const bool reflects = (lobes & specular_reflection) != 0;
    const float cosine = cosine_of(out);
    const Vector3 s = common_perpendicular(out, Vector3(frame_.n));
    event = {{}, s, s};
    for (int i = 0; i < spectrum_size; ++i) {
      const polarized::Amplitudes r = polarized::reflected(cosine, eta_[i]);
      float behind = 0;
      fresnel_dielectric(cosine, eta_[i], behind);
      const float a = clear_ ? 1 : behind > 0 ? std::pow(passage_[i], 1 / behind) : 0;
      const float rs = std::norm(r.s), rp = std::norm(r.p);
      const polarized::Complex both = std::conj(r.p) * r.s;
      if (rs >= 1 || rp >= 1) {  // total reflection: nothing gets in
        polarized::set_mueller(event.mueller, i, 1, 1, both);
        continue;
      }
      const auto power = [&](float R) {
        const float through = (1 - R) * (1 - R) * a / (1 - a * a * R * R);
        return reflects ? R + through * a * R : through;
      };
      const float r0 = both.real(), through = (1 - rs) * (1 - rp) * a / (1 - a * a * r0 * r0);
      polarized::set_mueller(event.mueller, i, power(rs), power(rp), reflects ? r0 + through * a * r0 : through);
    }
    return true;
  }

 private:
  float cosine_of(const Vector3& v) const { return std::abs(dot(frame_.n, v)); }
  struct Slab {
    Spectrum reflected, transmitted;
  };
  Slab tinted(const Slab& slab) const { return {slab.reflected * tint_.reflected, slab.transmitted * tint_.transmitted}; }
  Slab slab_at(float cosine) const {
    Slab slab;
    for (int i = 0; i < (flat_ ? 1 : spectrum_size); ++i) {
      float cosine_behind = 0;
      PolarizedReflectance r = fresnel_dielectric_polarized(cosine, eta_[i], cosine_behind);
      const float a = clear_ ? 1 : cosine_behind > 0 ? std::pow(passage_[i], 1 / cosine_behind) : 0;
      if (polarizations_ == Polarizations::averaged) r.s = r.p = (r.s + r.p) / 2;
      float reflected = 0, transmitted = 0;
      for (const float R : {r.s, r.p}) {
        if (R >= 1) {
          reflected += 0.5f;
          continue;
        }
        const float through = (1 - R) * (1 - R) * a / (1 - a * a * R * R);
        transmitted += 0.5f * through;
        reflected += 0.5f * (R + through * a * R);
      }
      slab.reflected.set(i, reflected);
      slab.transmitted.set(i, transmitted);
    }
    if (flat_) slab = {Spectrum(slab.reflected[0]), Spectrum(slab.transmitted[0])};
    return slab;
  }

  Spectrum eta_, passage_;
  BoundaryTint tint_;
  Polarizations polarizations_;
  bool clear_, flat_;
};

class ThinDielectric final : public Shader {
 public:
  static void describe(Description<ThinDielectric>& d) {
    d.summary(
         "A thin pane of glass, film of water, ...: it mirrors, and lets light pass straight on, with all reflections inside. "
         "A single surface stands for the whole pane; colours of interference are left out. Around a closed object it "
         "bounds the medium that this names as its interior, which has the index of what is around; without one, what is "
         "around goes on inside.",
         "Stokes 1862, On the intensity of the light reflected from or transmitted through a pile of plates")
        .member<&ThinDielectric::ior>("ior", "1", "index of refraction: a number, glass(\"N-BK7\"), or a spectrum",
                                      Meaning::index)
        .member<&ThinDielectric::color>("color", "1", "fraction of light left after one passage along the normal",
                                        Meaning::reflectance)
        .member<&ThinDielectric::reflection_tint>(
            "reflection_tint", "1", "what all that the pane reflects is multiplied by; real panes have 1", Meaning::reflectance)
        .member<&ThinDielectric::transmission_tint>(
            "transmission_tint", "1",
            "what all that the pane lets through is multiplied by, whatever the angle; glass that absorbs has a `color`",
            Meaning::reflectance)
        .member<&ThinDielectric::polarizations>("polarizations", "",
                                                "how unpolarized light goes to and fro inside; apart: each polarization by "
                                                "itself, as in glass; averaged: the mean of "
                                                "both at each reflection, as in pbrt and Mitsuba",
                                                choices("apart", "averaged"));
  }

  void prepare() override {
    if (!ior) fail("ior", "an index of refraction is needed");
    if (ior->imaginary()) fail("ior", "a dielectric's index is real; this one is complex (a metal's)");
    for (float lambda = wavelength_low; lambda <= wavelength_high; lambda += 5) {
      const float n = ior->at(lambda, ColorUse::coefficient);
      if (!(n > 0 && n < 100))
        fail("ior", "an index of refraction lies between 0 and 100, and this is " + std::to_string(n) + " at " +
                        std::to_string(int(lambda)) + " nm");
    }
    require_reflectance(*this, "color", color);
    require_reflectance(*this, "reflection_tint", reflection_tint);
    require_reflectance(*this, "transmission_tint", transmission_tint);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    Spectrum eta = ior->evaluate(w, ColorUse::coefficient);
    if (const SceneObject* around = p.media && p.object ? p.media->outside_of(*p.object) : nullptr)
      eta = eta / MediumStack::index(around, w);
    return arena.make<ThinDielectricScatter>(
        p, eta, reflectance_at(*color, p, w),
        BoundaryTint{reflectance_at(*reflection_tint, p, w), reflectance_at(*transmission_tint, p, w)}, polarizations);
  }
  Lobes possible_lobes() const override { return specular_reflection | null_scattering; }
  bool transmits() const override { return false; }
  bool lossless() const override {
    return everywhere(color, 1) && everywhere(reflection_tint, 1) && everywhere(transmission_tint, 1);
  }

  Color ior = flat_spectrum(1.5f);
  Ref<ObjectMap> color = constant(1.0f), reflection_tint = constant(1.0f), transmission_tint = constant(1.0f);
  Polarizations polarizations = Polarizations::apart;
};

const Register<ThinDielectric> registered;

}  // namespace
}  // namespace etendue
