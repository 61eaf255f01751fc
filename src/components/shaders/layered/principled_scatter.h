#pragma once
// Scattering by the layers of Principled.

#include "components/shaders/classic/eon.h"
#include "components/shaders/joint_scatter.h"
#include "components/shaders/microfacet/microfacet.h"
#include "sheen.h"

namespace etendue {

/// The parameters of Principled's layers at a point.
struct PrincipledLayers {
  float opacity = 1;
  bool thin_walled = false;
  bool single = false;  ///< only the path's hero wavelength is left

  // Fuzz, on top.
  float fuzz = 0;  ///< fraction of the surface
  Spectrum fuzz_color;
  SheenLobe fuzz_lobe{0.5f};

  // Coat, below it.
  float coat = 0;           ///< fraction of the surface
  Spectrum coat_log_color;  ///< logarithm of the transmittance down and up, along the normal
  MicrofacetDistribution coat_facets{MicrofacetDistribution::ggx, 0};
  float coat_eta = 1;  ///< its index over that around, >= 1

  // The base: facets of metal and of dielectric, some of the latter transparent (clear), the rest over a diffuse body (opaque).
  // Fractions of the surface, which sum to 1.
  float metal = 0, clear = 0, opaque = 1;
  MicrofacetDistribution facets;
  Spectrum metal_normal, metal_dip;  ///< F82-tint: reflectance along the normal, and the dip that is subtracted at 82 degrees
  float metal_weight = 1;
  Spectrum specular_color;  ///< tint of what dielectric facets reflect
  Spectrum eta;             ///< refraction: index inside over that around
  Spectrum reflect_eta;     ///< reflection: the higher index over the lower, modified by `specular_weight` and coat
  Spectrum transmission_color;
  Spectrum metal_darkening{1.0f}, gloss_darkening{1.0f}, matt_darkening{1.0f};  ///< by reflections inside the coat

  // A film on the facets. Indices over that of the medium in front, thickness in wavelengths.
  float film = 0;  ///< fraction of the surface
  Spectrum film_thickness, film_eta, film_metal_n, film_metal_k;

  // The diffuse body: colours of reflection and, for thin walls, of transmission.
  Spectrum diffuse_color, diffuse_through_color;
  float diffuse_roughness = 0;
};

/// The BSDF of these layers.
class PrincipledScatter final : public JointScatter<PrincipledScatter> {
 public:
  static Lobes lobes_of(const PrincipledLayers&);
  PrincipledScatter(const SurfacePoint& p, const Frame& frame, const PrincipledLayers&);

  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
    return combine(out, in, lobes, plan(out, lobes));
  }
  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample&) const;
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const;
  Spectrum relative_index(const Vector3& out, const Vector3& in) const {
    if (out.z * in.z > 0 || layers_.thin_walled) return Spectrum(1.0f);
    return out.z > 0 ? layers_.eta : Spectrum(1.0f) / layers_.eta;
  }

 private:
  /// A dielectric boundary over lower layers: its transmittance.
  class Top {
   public:
    Top(const MicrofacetDistribution& facets, float eta);
    /// 1 minus the albedo of single reflection.
    float passed(const Vector3& v) const;
    float mean_passed() const { return smooth_ ? mean_ : rough_->mean(); }

   private:
    bool smooth_;
    float eta_, mean_;
    std::optional<CoatTransmittance> rough_;
  };

  /// Fractions of the light incident at one angle that facets of the base reflect and transmit.
  struct Facets {
    Spectrum metal, opaque, clear;  ///< reflected
    Spectrum through;               ///< transmitted by the clear ones
    Spectrum reflected() const { return metal + opaque + clear; }
  };

  /// The probabilities of the sampling strategies, for one `out`.
  struct Plan {
    float fuzz = 0, coat = 0, base = 0, matt = 0, matt_glossy = 0, through = 0, through_glossy = 0, straight = 0;
  };

  Plan plan(const Vector3& out, Lobes lobes) const;
  ScatterValue combine(const Vector3& out, const Vector3& in, Lobes lobes, const Plan&) const;
  void reflection(const Vector3& out, const Vector3& in, Lobes lobes, const Plan&, ScatterValue&) const;
  void transmission(const Vector3& out, const Vector3& in, Lobes lobes, const Plan&, ScatterValue&) const;
  void thin_transmission(const Vector3& out, const Vector3& in, Lobes lobes, const Plan&, ScatterValue&) const;
  bool sample_base(const Vector3& out, float choice, Point2 u, Lobes lobes, const Plan&, LocalSample&) const;

  /// Index behind the boundary over index in front, seen from `out`.
  static float towards(const Vector3& out, float eta) { return out.z > 0 ? eta : 1 / eta; }
  float hero_index(const Vector3& out, const Vector3& in) const { return relative_index(out, in)[0]; }
  /// Whether `out` lies inside a refracting body: seen from there, the surface has no diffuse body, fuzz or coat.
  bool inside(const Vector3& out) const { return out.z < 0 && layers_.clear > 0 && !layers_.thin_walled; }
  /// The fraction of the surface that is the same from `out` as from the front.
  float fronting(const Vector3& out) const { return inside(out) ? 1 - layers_.clear : 1; }

  /// Fractions at a facet; `clear` includes the light from inside that coat and fuzz reflect back.
  Facets facets_at(float cosine, bool from_inside) const;
  Facets mean_facets(const Vector3& out) const;
  void clear_facets_at(float cosine, bool from_inside, Facets&) const;
  void thin_facets_at(float cosine, Facets&) const;
  /// At wavelength i; the cosine is that on the side of the lower index.
  float dielectric_reflectance(float cosine, int i) const;
  Spectrum metal_reflectance(float cosine) const;
  /// The probability of choosing reflection at a facet, rather than transmission.
  float reflect_probability(const Facets&, Lobes lobes) const;
  Lobe base_reflection() const { return smooth_ ? specular_reflection : glossy_reflection; }
  Lobe base_transmission() const { return smooth_ ? specular_transmission : glossy_transmission; }
  Lobe coat_reflection() const { return coat_smooth_ ? specular_reflection : glossy_reflection; }

  float fuzz_passed(const Vector3& v) const { return layers_.fuzz > 0 ? 1 - layers_.fuzz * layers_.fuzz_lobe.albedo(v) : 1; }
  float coat_passed(const Vector3& v) const { return layers_.coat > 0 ? 1 - layers_.coat * (1 - coat_.passed(v)) : 1; }
  /// The transmittance of the layers over the base, without absorption.
  float upper_passed(const Vector3& v) const;
  float upper_passed(float cosine) const { return upper_passed({safe_sqrt(1 - cosine * cosine), 0, cosine}); }
  /// The same including the dielectric's surface: the fraction of light that reaches the diffuse body.
  float matt_passed(const Vector3& v) const { return upper_passed(v) * gloss_.passed(v); }
  float matt_normalizer() const;
  void prepare_multiple();
  /// The transmittance of the upper layers, down and up, for light reflected by facets of the base.
  Spectrum through_upper(const Vector3& out, const Vector3& in) const;
  /// The same for light that facets refract, which crosses the upper layers once: `front` is the direction on the front side,
  /// `cosine` that at the facet there.
  Spectrum once_through_upper(const Vector3& front, float cosine) const;
  /// The coat's transmittance by absorption; `inverse_cosines` is the sum of 1 / cosine of the crossings, down and up.
  Spectrum coat_absorption(float inverse_cosines) const;
  float inverse_cosine_in_coat(const Vector3& v) const;

  PrincipledLayers layers_;
  Top coat_, gloss_;
  EonLobe matt_, matt_through_;
  std::optional<MultipleReflection> multiple_;        ///< of rough metal, and of rough thin sheets
  std::optional<MultipleRefraction> clear_multiple_;  ///< of a rough clear boundary
  Spectrum metal_more_, sheet_back_, sheet_through_;  ///< their factors for absorption
  float clear_more_ = 0;                              ///< the fraction of clear_multiple_ that is added
  float matt_mean_;                                   ///< mean of matt_passed
  bool smooth_, coat_smooth_, covered_;
  bool disperses_;  ///< the index of refraction depends on the wavelength
  bool colored_;    ///< the reflectance of facets depends on the wavelength, tints aside
  int choosing_;    ///< how many of the path's wavelengths may choose the refracted direction
};

}  // namespace etendue
