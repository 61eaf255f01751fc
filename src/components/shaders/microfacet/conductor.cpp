// Conductor: a metal, polished or rough.

#include <fmt/format.h>

#include <memory>

#include "components/shaders/reflectance.h"
#include "components/shaders/tangent_frame.h"
#include "etendue/core/warp.h"
#include "etendue/scatter_model.h"
#include "etendue/transport/medium_stack.h"
#include "rgb_reflectance.h"
#include "roughness.h"

namespace etendue {
namespace {

/// The Fresnel reflectance of a conductor at the path's wavelengths.
struct BoundaryReflectance {
  Spectrum n, k;                        ///< the conductor's index over that of the medium in front
  const RgbReflectance* rgb = nullptr;  ///< not null: n and k are given for red, green and blue only
  bool in_vacuum = true;                ///< of `rgb`: no medium in front; otherwise n and k hold red's, green's and blue's
  Wavelengths wavelengths{};

  Spectrum at(float cosine) const {
    return rgb && in_vacuum ? rgb->reflectance(cosine, wavelengths) : seen(fresnel_conductor(cosine, n, k));
  }
  Spectrum mean() const { return rgb && in_vacuum ? rgb->mean_reflectance(wavelengths) : seen(mean_fresnel_conductor(n, k)); }

 private:
  Spectrum seen(const Spectrum& reflected) const { return rgb ? rgb->seen(reflected, wavelengths) : reflected; }
};

class PolishedConductor final : public ScatterModel<PolishedConductor> {
 public:
  static constexpr bool uses_choice = false;

  PolishedConductor(const SurfacePoint& p, const BoundaryReflectance& boundary, Spectrum tint)
      : ScatterModel(p, specular_reflection), boundary_(boundary), tint_(tint) {}

  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }
  bool local_sample(const Vector3& out, float, Point2, Lobes, LocalSample& s) const {
    s.in = {-out.x, -out.y, out.z};
    s.value = tint_ * boundary_.at(std::abs(out.z));
    s.pdf = 1;
    s.lobe = specular_reflection;
    return true;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    return (lobes & specular_reflection) ? tint_ * boundary_.at(std::abs(out.z)) : Spectrum();
  }

 private:
  BoundaryReflectance boundary_;
  Spectrum tint_;
};

// f is the sum of single scattering, f1 = F D(m) G2 / (4 |out.z in.z|)  [1/sr]  (Torrance & Sparrow 1967; Walter et al. 2007,
// eq. 20), and multiple scattering, f2 (see MultipleReflection).
//
// f1 is sampled by visible normals, f2 with the pdf cos / pi. f2 is chosen with a probability q that is its share of the
// reflected light, computed with the mean of F. Samples of f1 that lead below the surface are absorbed, so the pdf integrates
// to less than 1.
class RoughConductor final : public ScatterModel<RoughConductor> {
 public:
  RoughConductor(const SurfacePoint& p, const Frame& frame, const MicrofacetDistribution& distribution,
                 const BoundaryReflectance& boundary, Spectrum tint, bool multiple)
      : ScatterModel(p, frame, glossy_reflection),
        distribution_(distribution),
        multiple_reflection_(distribution),
        boundary_(boundary),
        tint_(tint) {
    has_choice_ = multiple;
    if (!multiple) return;
    const Spectrum mean = boundary.mean();
    multiple_ = multiple_reflection_.factor(mean);
    multiple_over_single_ = multiple_.average() / std::max(mean.average(), 1e-6f);
  }

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes lobes) const {
    return local_value_and_pdf(out, in, lobes).value;
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    if (!(out.z * in.z > 0)) return 0;
    const float multiple = has_choice_ ? probability_of_multiple(multiple_reflection_.missing(out)) : 0;
    return pdf(out, in, reflection_half_vector(out, in), multiple);
  }
  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    if (!(out.z * in.z > 0)) return {};
    const Vector3 m = reflection_half_vector(out, in);
    Spectrum value = boundary_.at(std::abs(dot(out, m))) * (distribution_.D(m) * distribution_.visibility(out, in));
    if (!has_choice_) return {tint_ * value, pdf(out, in, m, 0)};
    const float missing = multiple_reflection_.missing(out);
    value += multiple_ * multiple_reflection_.value(missing, multiple_reflection_.missing(in));
    return {tint_ * value, pdf(out, in, m, probability_of_multiple(missing))};
  }

  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    if (has_choice_ && choice < probability_of_multiple(multiple_reflection_.missing(out))) {
      s.in = warp::cosine_hemisphere(u);
      if (out.z < 0) s.in.z = -s.in.z;
    } else {
      s.in = reflect(out, distribution_.sample_visible(out, u));
    }
    const ScatterValue both = local_value_and_pdf(out, s.in, lobes);
    s.value = both.value * std::abs(s.in.z);
    s.pdf = both.pdf;
    s.lobe = glossy_reflection;
    return s.pdf > 0;
  }

  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    if (!(lobes & glossy_reflection)) return {};
    const float missing = multiple_reflection_.missing(out);
    return tint_ * (boundary_.at(distribution_.typical_cosine(out)) * (1 - missing) + multiple_ * missing);
  }

 private:
  float probability_of_multiple(float missing) const {
    const float multiple = missing * multiple_over_single_;
    return multiple / (multiple + 1 - missing);
  }
  float pdf(const Vector3& out, const Vector3& in, const Vector3& m, float multiple) const {
    return (1 - multiple) * distribution_.visible_pdf(out, m) * reflection_jacobian(dot(out, m)) +
           multiple * std::abs(in.z) * inverse_pi;
  }

  MicrofacetDistribution distribution_;
  MultipleReflection multiple_reflection_;
  BoundaryReflectance boundary_;
  Spectrum tint_, multiple_;  ///< multiple_: factor of multiple scattering relative to F = 1
  float multiple_over_single_ = 0;
};

class Conductor final : public Shader {
 public:
  static void describe(Description<Conductor>& d) {
    d.summary("A metal, polished or rough, on both sides. It reflects as its complex refractive index says.",
              "Walter et al. 2007, Microfacet models for refraction through rough surfaces; Heitz 2014, Understanding the "
              "masking-shadowing function; Kulla & Conty 2017, Revisiting physically based shading at Imageworks")
        .group("Metal")
        .member<&Conductor::index>(
            "index", "",
            "what tells the index; spectral: `ior`; rgb: n and k of red, green and blue, as renderers of "
            "three channels have them: the colour these give at each angle becomes a reflectance",
            choices("spectral", "rgb"))
        .member<&Conductor::ior>("ior", "1", "complex index of refraction: metal(\"Au\"), or complex(n, k)", Meaning::index,
                                 when("index", "spectral"))
        .member<&Conductor::rgb_n>("rgb_n", "1", "n of red, green and blue", when("index", "rgb"))
        .member<&Conductor::rgb_k>("rgb_k", "1", "k of red, green and blue", when("index", "rgb"))
        .member<&Conductor::color_space>("color_space", "", "whose red, green and blue", rgb_space_names(),
                                         when("index", "rgb"))
        .member<&Conductor::color>("color", "1", "what the reflectance is multiplied by, per wavelength", Meaning::reflectance)
        .group("Roughness")
        .member<&Conductor::roughness>("roughness", "1",
                                       "the alpha of the distribution of facets, along the surface's u direction unless "
                                       "rotated (not its square root); below 0.001 polished",
                                       Meaning::number, soft(0, 1))
        .member<&Conductor::roughness_v>("roughness_v", "1", "alpha across that direction; by default the same",
                                         Meaning::number, soft(0, 1))
        .member<&Conductor::rotation>("rotation", "turn", "turns those directions, counter-clockwise", Meaning::number,
                                      soft(0, 1), when("roughness_v"))
        .member<&Conductor::distribution>("distribution", "", "of the directions of facets", choices("ggx", "beckmann"))
        .member<&Conductor::multiple_scattering>("multiple_scattering", "",
                                                 "whether light that meets more than one facet is counted, or lost")
        .member<&Conductor::heights>("heights", "",
                                     "of facets that hide light on its way in and on its way out: by_side and correlated, as "
                                     "in pbrt, the same ones hide "
                                     "both ways; independent, as in Mitsuba, others do, and less is reflected at a slant",
                                     choices("by_side", "independent", "correlated"), unless("multiple_scattering"));
  }

  void prepare() override {
    for (int i = 0; i < 3 && index == Index::rgb; ++i) {
      if (!(rgb_n[i] > 0 && rgb_n[i] < 100)) fail("rgb_n", "each must be more than 0 and less than 100");
      if (!(rgb_k[i] >= 0 && rgb_k[i] < 100)) fail("rgb_k", "each must be at least 0 and less than 100");
    }
    rgb_ = {};
    if (index == Index::rgb) rgb_ = std::make_unique<RgbReflectance>(rgb_space(color_space), rgb_n, rgb_k);
    if (!ior) fail("ior", "an index of refraction is needed");
    const Color k = ior->imaginary();
    for (float lambda = wavelength_low; lambda <= wavelength_high; lambda += 5) {
      const float real = ior->at(lambda, ColorUse::coefficient), imaginary = k ? k->at(lambda, ColorUse::coefficient) : 0;
      const bool n_good = real > 0 && real < 100, k_good = imaginary >= 0 && imaginary < 100;
      if (n_good && k_good) continue;
      const std::string n_wrong = fmt::format("n must be more than 0 and less than 100, and is {:.6g}", real),
                        k_wrong = fmt::format("k must be at least 0 and less than 100, and is {:.6g}", imaginary);
      fail("ior", fmt::format("{} at {:.0f} nm", n_good ? k_wrong : k_good ? n_wrong : n_wrong + "; " + k_wrong, lambda));
    }
    require_reflectance(*this, "color", color);
    require_roughness(*this, roughness, roughness_v);
    if (!rotation) fail("rotation", "a map or a number is needed");
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const Spectrum tint = reflectance_at(*color, p, w);
    if (tint.black()) return nullptr;
    const BoundaryReflectance boundary = boundary_of(p, w);
    MicrofacetDistribution d = distribution_at(distribution, *roughness, roughness_v.get(), p);
    if (!multiple_scattering) d.heights = heights;
    if (d.smooth()) return arena.make<PolishedConductor>(p, boundary, tint);
    const Frame frame = d.isotropic() ? Frame(p.shading_normal) : tangent_frame(p, rotation->scalar(p));
    return arena.make<RoughConductor>(p, frame, d, boundary, tint, multiple_scattering);
  }
  /// A rough metal's reflectance is taken at one angle for all facets, and its energy loss from a table.
  float albedo_error() const override { return possible_lobes() == specular_reflection ? 0 : 0.1f; }
  Lobes possible_lobes() const override {
    const Color x = roughness->constant(), y = roughness_v ? roughness_v->constant() : x;
    if (!x || !y) return glossy_reflection | specular_reflection;
    const SurfacePoint nowhere;
    return distribution_at(distribution, *roughness, roughness_v.get(), nowhere).smooth() ? specular_reflection
                                                                                          : glossy_reflection;
  }

  Color ior = metal_index("Al");
  Ref<ObjectMap> color = constant(1.0f), roughness = constant(0.2f), roughness_v, rotation = constant(0.0f);
  MicrofacetDistribution::Kind distribution = MicrofacetDistribution::ggx;
  MicrofacetDistribution::Heights heights = MicrofacetDistribution::Heights::by_side;
  bool multiple_scattering = true;
  enum class Index : std::uint8_t { spectral, rgb };
  Index index = Index::spectral;
  Vector3 rgb_n{1.44f, 0.86f, 0.60f}, rgb_k{7.74f, 6.40f, 5.39f};  // aluminium, at 645, 526 and 444 nm
  std::string color_space = "srgb";

 private:
  BoundaryReflectance boundary_of(const SurfacePoint& p, const Wavelengths& w) const {
    const SceneObject* outside = p.media && p.object ? p.media->outside_of(*p.object) : nullptr;
    BoundaryReflectance boundary;
    if (rgb_) {
      boundary.rgb = rgb_.get();
      boundary.wavelengths = w;
      boundary.in_vacuum = !outside;
      if (!outside) return boundary;
      boundary.n = rgb_->n();
      boundary.k = rgb_->k();
    } else {
      boundary.n = ior->evaluate(w, ColorUse::coefficient);
      if (const Color imaginary = ior->imaginary()) boundary.k = imaginary->evaluate(w, ColorUse::coefficient);
    }
    if (!outside) return boundary;
    const Spectrum around = MediumStack::index(outside, w), n = rgb_ ? Spectrum(around.average()) : around;
    boundary.n = boundary.n / n;
    boundary.k = boundary.k / n;
    return boundary;
  }

  std::unique_ptr<const RgbReflectance> rgb_;
};

const Register<Conductor> registered;

}  // namespace
}  // namespace etendue
