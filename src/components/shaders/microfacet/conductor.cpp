// Conductor: a metal, polished or rough.

#include <fmt/format.h>

#include <memory>

#include "components/shaders/polarized_fresnel.h"
#include "components/shaders/reflectance.h"
#include "components/shaders/tangent_frame.h"
#include "etendue/describe/bands.h"
#include "etendue/transport/medium_stack.h"
#include "facet_reflection.h"
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
  /// What reflection does to polarization. Where n and k are given for red, green and blue, each wavelength takes those of the
  /// colour it belongs to.
  Polarization polarization(const Vector3& out, const Vector3& in) const {
    const Spectrum& real = rgb && in_vacuum ? rgb->n() : n;
    const Spectrum& imaginary = rgb && in_vacuum ? rgb->k() : k;
    return polarized::reflection(out, in, [&](int lane, float cosine) {
      const int color = in_bands(wavelengths) ? lane % 3 : wavelengths[lane] > 580 ? 0 : wavelengths[lane] > 490 ? 1 : 2;
      const int at = rgb ? color : lane;
      return polarized::reflected(cosine, {real[at], imaginary[at]});
    });
  }
  Spectrum mean() const { return rgb && in_vacuum ? rgb->mean_reflectance(wavelengths) : seen(mean_fresnel_conductor(n, k)); }

 private:
  Spectrum seen(const Spectrum& reflected) const { return rgb ? rgb->seen(reflected, wavelengths) : reflected; }
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
    if (d.smooth()) return arena.make<MirrorReflection<BoundaryReflectance>>(p, boundary, tint);
    const Frame frame = d.isotropic() ? Frame(p.shading_normal) : tangent_frame(p, rotation->scalar(p));
    return arena.make<FacetReflection<BoundaryReflectance>>(p, frame, d, boundary, tint, multiple_scattering);
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
