// Principled: OpenPBR Surface, one shader for most materials.

#include "components/shaders/fresnel.h"
#include "components/shaders/reflectance.h"
#include "components/shaders/scalar_map.h"
#include "components/shaders/tangent_frame.h"
#include "etendue/describe/bands.h"
#include "etendue/transport/medium_stack.h"
#include "principled_scatter.h"

namespace etendue {
namespace {

/// The highest index ratio in the tables of boundaries.
constexpr float highest_ratio = 4;

/// An index ratio changed so that its reflectance along the normal is `weight` times what it was (OpenPBR, eq. "modulated
/// IOR"): eta = (1 + e) / (1 - e) with e^2 the reflectance.
float with_weight(float eta, float weight) {
  constexpr float most = (highest_ratio - 1) / (highest_ratio + 1);
  const float e = std::min(std::abs((eta - 1) / (eta + 1)) * std::sqrt(weight), most);
  return eta < 1 ? (1 - e) / (1 + e) : (1 + e) / (1 - e);
}

/// GGX from roughness and anisotropy (OpenPBR, section "Microfacet model"): the sum of alpha^2 does not depend on the
/// anisotropy.
MicrofacetDistribution facets_of(float roughness, float anisotropy) {
  const float across = 1 - anisotropy, along = roughness * roughness * std::sqrt(2 / (1 + across * across));
  return {MicrofacetDistribution::ggx, along, across * along};
}

/// A rough coat blurs the base seen through it, twice: variances of facet slopes add up as for Gaussians (OpenPBR,
/// "Roughening").
float roughened(float base, float coat, float coat_weight) {
  const auto fourth = [](float x) { return square(square(x)); };
  return lerp(coat_weight, base, std::sqrt(std::sqrt(std::min(fourth(base) + 2 * fourth(coat), 1.0f))));
}

/// The inside of the coat reflects the fraction K of the light from a base of the given albedo back down; the light that leaves
/// is multiplied by (1 - K) / (1 - albedo K) (OpenPBR, "Darkening").
Spectrum darkening(Spectrum albedo, float k, float amount) {
  return Spectrum(1 - amount) + Spectrum(amount * (1 - k)) / (Spectrum(1.0f) - albedo * k);
}

Spectrum mix(float t, Spectrum a, Spectrum b) { return a * (1 - t) + b * t; }

class Principled final : public Shader, public NeedsWavelengths {
 public:
  static void describe(Description<Principled>&);
  static void describe_upper_layers(Description<Principled>&);
  void prepare() override;

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const PrincipledLayers layers = layers_at(p, w);
    const Lobes lobes = PrincipledScatter::lobes_of(layers);
    if (lobes == no_lobes) return nullptr;
    const bool turned = !layers.facets.isotropic() || !layers.coat_facets.isotropic();
    return arena.make<PrincipledScatter>(
        p, turned ? tangent_frame(p, geometry_tangent_rotation->scalar(p)) : Frame(p.shading_normal), layers);
  }

  void refuse_bands() const override {
    if (!always(thin_film_weight, 0)) fail("thin_film_weight", "a thin film interferes wavelength by wavelength");
    if (refracts_ && transmission_dispersion_scale > 0)
      fail("transmission_dispersion_scale", "dispersion refracts each wavelength into a direction of its own");
  }
  /// The transmittance of the layers above is taken for `out` alone, and as a mean for facets.
  float albedo_error() const override { return 0.3f; }
  Lobes possible_lobes() const override { return possible_lobes_; }
  Spectrum interior_index(const Wavelengths& w) const override {
    return refracts_ ? index_at(inside_index_, w) : Spectrum(1.0f);
  }
  bool transmits() const override { return refracts_ || (possible_lobes_ & null_scattering); }

  Ref<ObjectMap> base_weight = constant(1.0f), base_color = constant(0.8f), base_diffuse_roughness = constant(0.0f),
                 base_metalness = constant(0.0f);
  Ref<ObjectMap> specular_weight = constant(1.0f), specular_color = constant(1.0f), specular_roughness = constant(0.3f),
                 specular_roughness_anisotropy = constant(0.0f);
  float specular_ior = 1.5f;
  Ref<ObjectMap> transmission_weight = constant(0.0f), transmission_color = constant(1.0f);
  float transmission_dispersion_scale = 0, transmission_dispersion_abbe_number = 20;
  Ref<ObjectMap> subsurface_weight = constant(0.0f), subsurface_color = constant(0.8f);
  float subsurface_scatter_anisotropy = 0;
  Ref<ObjectMap> coat_weight = constant(0.0f), coat_color = constant(1.0f), coat_roughness = constant(0.0f),
                 coat_roughness_anisotropy = constant(0.0f);
  float coat_ior = 1.6f, coat_darkening = 1;
  Ref<ObjectMap> fuzz_weight = constant(0.0f), fuzz_color = constant(1.0f), fuzz_roughness = constant(0.5f);
  Ref<ObjectMap> thin_film_weight = constant(0.0f), thin_film_thickness = constant(500.0f);
  float thin_film_ior = 1.4f;
  Ref<ObjectMap> geometry_opacity = constant(1.0f), geometry_tangent_rotation = constant(0.0f);
  bool thin_walled = false;

 private:
  static constexpr float thickest_film = 1e5f, highest_specular_weight = 1000;

  static bool always(const Ref<ObjectMap>& map, float value) { return map->constant() && map->scalar(SurfacePoint()) == value; }
  /// Whether facets of such a roughness, isotropic or not, may be treated as a smooth surface anywhere.
  static bool may_be_smooth(const Ref<ObjectMap>& roughness) {
    if (!roughness->constant()) return true;
    constexpr float rounding = 1.001f;
    return square(roughness->scalar(SurfacePoint())) <= rounding * MicrofacetDistribution::smooth_below;
  }
  /// Cauchy's formula, from the index at 587.6 nm and Abbe's number, (n - 1) / (n(486.1 nm) - n(656.3 nm)).
  Spectrum index_at(float index, const Wavelengths& w) const {
    if (!(transmission_dispersion_scale > 0)) return Spectrum(index);
    constexpr float f = 0.4861f, d = 0.5876f, c = 0.6563f;  // Fraunhofer's lines [um]
    const float b =
        (index - 1) * transmission_dispersion_scale / (transmission_dispersion_abbe_number * (1 / (f * f) - 1 / (c * c)));
    Spectrum r;
    for (int i = 0; i < spectrum_size; ++i) r.set(i, std::max(index + b * (1e6f / square(w[i]) - 1 / (d * d)), 1.0f));
    return r;
  }

  PrincipledLayers layers_at(const SurfacePoint&, const Wavelengths&) const;
  void set_base(PrincipledLayers&, const SurfacePoint&, const Wavelengths&) const;
  void set_boundary(PrincipledLayers&, const SurfacePoint&, const Wavelengths&) const;

  Lobes possible_lobes_ = no_lobes;
  bool refracts_ = false;         ///< light may enter the object
  bool weight_in_index_ = false;  ///< specular_weight is constant, and included in the index inside
  float inside_index_ = 1;        ///< at 587.6 nm
};

void Principled::describe(Description<Principled>& d) {
  d.summary(
       "OpenPBR Surface: metal, plastic, glass and matt bodies under coats and fuzz, one shader for most materials. Below its "
       "surface a body is matt where OpenPBR has subsurface scattering, and what glass absorbs over a distance is its "
       "object's interior's part.",
       "Portsmouth et al. 2024, OpenPBR Surface specification 1.1, Academy Software Foundation")
      .group("Base")
      .member<&Principled::base_weight>("base_weight", "1", "factor of base_color", Meaning::number, soft(0, 1))
      .member<&Principled::base_color>("base_color", "1", "colour of the matt body; of metal, seen straight on",
                                       Meaning::reflectance, when("base_weight"))
      .member<&Principled::base_diffuse_roughness>("base_diffuse_roughness", "1", "of the matt body: 0 Lambertian, 1 like clay",
                                                   Meaning::number, soft(0, 1))
      .member<&Principled::base_metalness>("base_metalness", "1", "fraction of the surface that is metal", Meaning::number,
                                           soft(0, 1))
      .group("Specular")
      .member<&Principled::specular_weight>("specular_weight", "1",
                                            "factor of the surface's reflectance: of metal as it is, of others by its index",
                                            Meaning::number, soft(0, 1))
      .member<&Principled::specular_color>("specular_color", "1", "tint of reflections; of metal, towards its edges",
                                           Meaning::reflectance)
      .member<&Principled::specular_roughness>("specular_roughness", "1", "of the base's surface; its square is GGX's alpha",
                                               Meaning::number, soft(0, 1))
      .member<&Principled::specular_roughness_anisotropy>("specular_roughness_anisotropy", "1",
                                                          "how much more rough the surface is along dpdu than across it",
                                                          Meaning::number, soft(0, 1))
      .member<&Principled::specular_ior>("specular_ior", "1", "index of refraction of the base, at 587.6 nm",
                                         range(1, highest_ratio), soft(1, 2.5))
      .group("Transmission")
      .member<&Principled::transmission_weight>("transmission_weight", "1", "fraction of what is not metal that is clear",
                                                Meaning::number, soft(0, 1))
      .member<&Principled::transmission_color>("transmission_color", "1",
                                               "tint of light that goes through the clear surface; through a whole thin wall",
                                               Meaning::reflectance, when("transmission_weight"))
      .member<&Principled::transmission_dispersion_scale>("transmission_dispersion_scale", "1",
                                                          "amount of dispersion: 1 for that of the Abbe number", range(0, 1))
      .member<&Principled::transmission_dispersion_abbe_number>(
          "transmission_dispersion_abbe_number", "1", "Abbe number of the clear base: low ones disperse more", range(5, 1000),
          soft(10, 100), logarithmic, when("transmission_dispersion_scale"))
      .group("Subsurface")
      .member<&Principled::subsurface_weight>(
          "subsurface_weight", "1",
          "fraction of the matt body that has subsurface_color; of thin walls, what scatters "
          "light to both sides",
          Meaning::number, soft(0, 1))
      .member<&Principled::subsurface_color>("subsurface_color", "1", "colour of that fraction", Meaning::reflectance,
                                             when("subsurface_weight"))
      .member<&Principled::subsurface_scatter_anisotropy>("subsurface_scatter_anisotropy", "1",
                                                          "of thin walls: -1 all back, 0 as much to both sides, 1 all through",
                                                          range(-1, 1), when("subsurface_weight"), when("thin_walled"));
  describe_upper_layers(d);
}

void Principled::describe_upper_layers(Description<Principled>& d) {
  d.group("Coat")
      .member<&Principled::coat_weight>("coat_weight", "1", "fraction of the surface that has a clear coat", Meaning::number,
                                        soft(0, 1))
      .member<&Principled::coat_color>("coat_color", "1", "tint of what is seen through the coat, straight on",
                                       Meaning::reflectance, when("coat_weight"))
      .member<&Principled::coat_roughness>("coat_roughness", "1", "of the coat's surface", Meaning::number, soft(0, 1),
                                           when("coat_weight"))
      .member<&Principled::coat_roughness_anisotropy>("coat_roughness_anisotropy", "1", "as of the base", Meaning::number,
                                                      soft(0, 1), when("coat_weight"))
      .member<&Principled::coat_ior>("coat_ior", "1", "index of refraction of the coat", range(1, highest_ratio), soft(1, 2.5),
                                     when("coat_weight"))
      .member<&Principled::coat_darkening>("coat_darkening", "1",
                                           "amount by which the base looks darker for reflections on the coat's inside",
                                           range(0, 1), when("coat_weight"))
      .group("Fuzz")
      .member<&Principled::fuzz_weight>("fuzz_weight", "1", "fraction of the surface that has fuzz, or dust, on top",
                                        Meaning::number, soft(0, 1))
      .member<&Principled::fuzz_color>("fuzz_color", "1", "colour of the fuzz", Meaning::reflectance, when("fuzz_weight"))
      .member<&Principled::fuzz_roughness>("fuzz_roughness", "1", "0 for upright fibres, 1 for dust", Meaning::number,
                                           soft(0, 1), when("fuzz_weight"))
      .group("Thin film")
      .member<&Principled::thin_film_weight>("thin_film_weight", "1",
                                             "fraction of the base's surface that has a film, whose colours are interference",
                                             Meaning::number, soft(0, 1))
      .member<&Principled::thin_film_thickness>("thin_film_thickness", "nm", "of that film", Meaning::number, soft(50, 2000),
                                                logarithmic, when("thin_film_weight"))
      .member<&Principled::thin_film_ior>("thin_film_ior", "1", "index of refraction of that film", range(1, highest_ratio),
                                          soft(1, 2.5), when("thin_film_weight"))
      .group("Geometry")
      .member<&Principled::geometry_opacity>("geometry_opacity", "1", "fraction of the surface that is there", Meaning::number,
                                             soft(0, 1))
      .member<&Principled::geometry_tangent_rotation>(
          "geometry_tangent_rotation", "turn",
          "by how many turns dpdu is rotated for the roughness of base and coat, counter-clockwise seen from the front",
          Meaning::number, soft(0, 1))
      .member<&Principled::thin_walled>("thin_walled", "", "a sheet without an inside, such as a leaf, paper or a window pane");
}

void Principled::prepare() {
  require_reflectance(*this, "base_color", base_color);
  require_reflectance(*this, "specular_color", specular_color);
  require_reflectance(*this, "transmission_color", transmission_color);
  require_reflectance(*this, "subsurface_color", subsurface_color);
  require_reflectance(*this, "coat_color", coat_color);
  require_reflectance(*this, "fuzz_color", fuzz_color);
  const std::pair<const char*, const Ref<ObjectMap>*> fractions[] = {
      {"base_weight", &base_weight},
      {"base_diffuse_roughness", &base_diffuse_roughness},
      {"base_metalness", &base_metalness},
      {"specular_roughness", &specular_roughness},
      {"specular_roughness_anisotropy", &specular_roughness_anisotropy},
      {"transmission_weight", &transmission_weight},
      {"subsurface_weight", &subsurface_weight},
      {"coat_weight", &coat_weight},
      {"coat_roughness", &coat_roughness},
      {"coat_roughness_anisotropy", &coat_roughness_anisotropy},
      {"fuzz_weight", &fuzz_weight},
      {"fuzz_roughness", &fuzz_roughness},
      {"thin_film_weight", &thin_film_weight},
      {"geometry_opacity", &geometry_opacity}};
  for (const auto& [name, map] : fractions) require_scalar(*this, name, *map);
  require_scalar(*this, "specular_weight", specular_weight, 0, highest_specular_weight);
  require_scalar(*this, "thin_film_thickness", thin_film_thickness, 0, thickest_film);
  if (!geometry_tangent_rotation) fail("geometry_tangent_rotation", "a map or a number is needed");

  const bool clear = !always(transmission_weight, 0) && !always(base_metalness, 1);
  const bool matt = !always(transmission_weight, 1) && !always(base_metalness, 1);
  refracts_ = clear && !thin_walled;
  weight_in_index_ = specular_weight->constant() != nullptr;
  inside_index_ = weight_in_index_ ? with_weight(specular_ior, specular_weight->scalar(SurfacePoint())) : specular_ior;

  // Coat and anisotropy can only make the base rougher: its own roughness decides whether it may be smooth.
  const bool smooth = may_be_smooth(specular_roughness), smooth_coat = !always(coat_weight, 0) && may_be_smooth(coat_roughness);
  possible_lobes_ = glossy_reflection;
  if (smooth || smooth_coat) possible_lobes_ |= specular_reflection;
  if (matt) possible_lobes_ |= diffuse_reflection;
  if (clear) possible_lobes_ |= glossy_transmission;
  if (clear && smooth) possible_lobes_ |= specular_transmission;
  if (matt && thin_walled && !always(subsurface_weight, 0)) possible_lobes_ |= diffuse_transmission;
  if (!always(geometry_opacity, 1)) possible_lobes_ |= null_scattering;

  // Tables are computed at first use: here, before rendering.
  const MicrofacetDistribution some(MicrofacetDistribution::ggx, 0.5f);
  (void)CoatTransmittance(some, 1.5f);
  (void)MultipleReflection(some);
  if (clear) (void)MultipleRefraction(some, 1.5f);
  if (!always(specular_roughness_anisotropy, 0)) (void)MultipleReflection({MicrofacetDistribution::ggx, 0.5f, 0.25f});
  if (!always(fuzz_weight, 0)) (void)SheenLobe(0.5f).mean_albedo();
}

PrincipledLayers Principled::layers_at(const SurfacePoint& p, const Wavelengths& w) const {
  PrincipledLayers l;
  l.opacity = scalar_at(*geometry_opacity, p);
  l.thin_walled = thin_walled;
  l.single = w.single();
  l.fuzz = scalar_at(*fuzz_weight, p);
  if (l.fuzz > 0) {
    l.fuzz_color = reflectance_at(*fuzz_color, p, w);
    l.fuzz_lobe = SheenLobe(scalar_at(*fuzz_roughness, p));
  }
  set_base(l, p, w);
  set_boundary(l, p, w);
  return l;
}

/// Sets the materials of the base.
void Principled::set_base(PrincipledLayers& l, const SurfacePoint& p, const Wavelengths& w) const {
  l.metal = scalar_at(*base_metalness, p);
  l.clear = (1 - l.metal) * scalar_at(*transmission_weight, p);
  l.opaque = std::max(1 - l.metal - l.clear, 0.0f);
  l.specular_color = reflectance_at(*specular_color, p, w);
  if (l.clear > 0) l.transmission_color = reflectance_at(*transmission_color, p, w);
  const Spectrum base = reflectance_at(*base_color, p, w) * scalar_at(*base_weight, p);
  if (l.metal > 0) {
    // F82-tint: at the cosine 1/7 the reflectance is that of Schlick's formula times specular_color.
    constexpr float c = 6.0f / 7, c5 = c * c * c * c * c;
    l.metal_normal = base;
    l.metal_dip = (base + (Spectrum(1.0f) - base) * c5) * (Spectrum(1.0f) - l.specular_color) * (7 / (c5 * c));
    l.metal_weight = scalar_at(*specular_weight, p);
  }
  if (l.opaque > 0) {
    const float below = scalar_at(*subsurface_weight, p), g = thin_walled ? subsurface_scatter_anisotropy : -1;
    const Spectrum color = below > 0 ? reflectance_at(*subsurface_color, p, w) : Spectrum();
    l.diffuse_color = mix(below, base, color * (0.5f * (1 - g)));
    l.diffuse_through_color = color * (below * 0.5f * (1 + g));
    l.diffuse_roughness = scalar_at(*base_diffuse_roughness, p);
  }
}

/// Sets the base's surface, and the film and coat on it. A coat's index is relative to the medium around, the base's to the
/// coat where there is one. Where the lower medium has the lower index, the inverse ratio is used for reflection: between
/// parallel boundaries, light from outside is never totally reflected.
void Principled::set_boundary(PrincipledLayers& l, const SurfacePoint& p, const Wavelengths& w) const {
  const Spectrum around = MediumStack::index(p.media && p.object ? p.media->outside_of(*p.object) : nullptr, w);
  const float weight = scalar_at(*specular_weight, p, 0, highest_specular_weight);
  const float roughness = scalar_at(*specular_roughness, p);
  l.coat = scalar_at(*coat_weight, p);
  const float coat_rough = l.coat > 0 ? scalar_at(*coat_roughness, p) : 0;
  l.facets = facets_of(roughened(roughness, coat_rough, l.coat), scalar_at(*specular_roughness_anisotropy, p));

  const Spectrum plain = index_at(specular_ior, w), inside = index_at(inside_index_, w);
  // Rough facets must refract light, however little, for the transmitted direction to have a pdf.
  l.eta = map(inside / around, [&](float eta) {
    constexpr float least = 2e-3f;
    return l.facets.smooth() || thin_walled || std::abs(eta - 1) >= least ? eta : eta < 1 ? 1 - least : 1 + least;
  });
  l.film = scalar_at(*thin_film_weight, p);
  const float nanometres = l.film > 0 ? scalar_at(*thin_film_thickness, p, 0, thickest_film) : 0;
  for (int i = 0; i < spectrum_size; ++i) {
    const float above = lerp(l.coat, around[i], coat_ior);
    const float bare = l.coat > 0 ? lerp(l.coat, plain[i] / around[i], plain[i] / coat_ior) : l.eta[i];
    const float ratio =
        clamp(l.coat > 0 || !weight_in_index_ ? with_weight(bare, weight) : bare, 1 / highest_ratio, highest_ratio);
    l.reflect_eta.set(i, std::max(ratio, 1 / ratio));
    if (!(l.film > 0)) continue;
    l.film_eta.set(i, thin_film_ior / (ratio < 1 ? above * ratio : above));
    l.film_thickness.set(i, nanometres * (ratio < 1 ? above * ratio : above) / w[i]);
    if (l.metal > 0) {
      // Indices of a metal of this reflectance along the normal and edge colour (Gulbrandsen 2014, "Artist friendly metallic
      // Fresnel").
      const float r = std::min(l.metal_normal[i], 0.999f), root = std::sqrt(r), edge = l.specular_color[i];
      const float n = lerp(edge, (1 + root) / (1 - root), (1 - r) / (1 + r));
      l.film_metal_n.set(i, n);
      l.film_metal_k.set(i, safe_sqrt((r * square(n + 1) - square(n - 1)) / (1 - r)));
    }
  }
  if (!(l.coat > 0)) return;

  l.coat_facets = facets_of(coat_rough, scalar_at(*coat_roughness_anisotropy, p));
  const float eta = clamp(coat_ior / around[0], 1 / highest_ratio, highest_ratio);
  l.coat_eta = std::max(eta, 1 / eta);
  l.coat_log_color = map(reflectance_at(*coat_color, p, w), [](float x) { return std::log(std::max(x, 1e-6f)); });
  // Light from a diffuse body is reflected inside the coat with the mean for diffuse light; light from a smooth base, with the
  // reflectance along the normal.
  const float amount = l.coat * coat_darkening, normal = square((l.coat_eta - 1) / (l.coat_eta + 1));
  const float diffuse = 1 - (1 - mean_fresnel_dielectric(l.coat_eta)) / square(l.coat_eta),
              some = lerp(roughness, normal, diffuse);
  const float gloss = square((l.reflect_eta[0] - 1) / (l.reflect_eta[0] + 1));
  const Spectrum opaque = Spectrum(gloss) + l.diffuse_color * (1 - gloss);
  l.metal_darkening = darkening(l.metal_normal * l.metal_weight, some, amount);
  l.gloss_darkening = darkening(opaque, some, amount);
  l.matt_darkening = darkening(opaque, diffuse, amount);
}

const Register<Principled> registered;

}  // namespace
}  // namespace etendue
