// Closures of highlights, mirrors and boundaries: facets of metals and dielectrics.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "closure_rows.h"
#include "components/shaders/tangent_frame.h"
#include "etendue/describe/bands.h"
#include "lobes.h"

namespace etendue::osl {

namespace {

using Component = ClosureComponent;

const String* string_at(const Component& c, size_t i) { return c.argument<const String*>(i); }

MicrofacetDistribution::Kind distribution_named(Gathering& g, const String* name) {
  const std::string_view text = name->view();
  if (text == "beckmann") return MicrofacetDistribution::beckmann;
  if (text != "ggx" && text != "default" && !text.empty())
    g.warn(fmt::format("the distribution '{}' of facets is not known; 'ggx' is used", text));
  return MicrofacetDistribution::ggx;
}

// ---- thin films

/// The film of the optional arguments thinfilm_thickness [nm] and thinfilm_ior.
struct Film {
  float thickness = 0, index = 1.5f;
};
Film film_of(const Gathering& g, const Component& c) {
  const Film f{keyword(c, "thinfilm_thickness", 0), keyword(c, "thinfilm_ior", 1.5f)};
  if (f.thickness > 0 && in_bands(g.wavelengths())) {
    g.warn("a thin film interferes wavelength by wavelength, and is left out where paths carry three bands");
    return {0, f.index};
  }
  return {std::isfinite(f.thickness) ? clamp(f.thickness, 0, 1e5f) : 0, clamp(f.index, 0.01f, 99)};
}

/// A film on a smooth boundary: the house's ThinFilm. A film on facets: their Fresnel reflectance is that of the film.
Ref<etendue::Shader> film_model(bool opaque) {
  return make_model("ThinFilm", {{"thickness", Value(Ref<etendue::Component>(number_slot(2)))},
                                 {"film_ior", Value(film_slot())},
                                 {"base_ior", Value(index_slot(opaque))},
                                 {"opaque", Value(opaque)}});
}
/// `v.index` and `v.extinction` are those of the base, which light enters unless it is `opaque`.
void add_film(Gathering& g, const SurfacePoint& p, const MicrofacetDistribution& d, const Film& film, SlotValues v, bool opaque,
              const Spectrum& color, Lobes lobes) {
  static const Ref<etendue::Shader> models[2] = {film_model(false), film_model(true)};
  v.numbers[2] = film.thickness;
  v.film = Spectrum(film.index);
  if (d.smooth()) return g.add(*models[opaque ? 1 : 0], v, p, lobes, color);
  FilmFresnel fresnel;
  fresnel.color = color;
  fresnel.outside = g.index_outside();
  fresnel.film = v.film;
  fresnel.base = v.index;
  if (opaque) fresnel.absorbing = v.extinction;
  fresnel.set_thickness(film.thickness, g.wavelengths());
  g.add_film_facets(p, d, fresnel);
}

void phong(Gathering& g, const Component& c) {
  const SurfacePoint p = g.at(c.argument<Triple>(0));
  g.add(g.arena().make<PhongModel>(p, g.reflectance(Triple(1)), clamp(c.argument<float>(1), 0, 1e6f)), glossy_reflection);
}

void ward(Gathering& g, const Component& c) {
  static const Ref<etendue::Shader> model =
      make_model("WardShader", {{"color", Value(Ref<etendue::Component>(color_slot(0)))},
                                {"specular", Value(Ref<etendue::Component>(color_slot(1)))},
                                {"roughness_u", Value(Ref<etendue::Component>(number_slot(0)))},
                                {"roughness_v", Value(Ref<etendue::Component>(number_slot(1)))}});
  SlotValues v;
  v.colors[0] = {};
  v.colors[1] = g.reflectance(Triple(1));
  v.numbers[0] = clamp(c.argument<float>(2), 1e-3f, 1);
  v.numbers[1] = clamp(c.argument<float>(3), 1e-3f, 1);
  g.add(*model, v, g.at(c.argument<Triple>(0), c.argument<Triple>(1)), glossy_reflection);
}

/// A dielectric boundary. `relative`: the index is that of the back side over that of the front side; else that of the inside,
/// and the medium outside is what the path is in.
struct Boundary {
  Triple normal, tangent, reflection_tint{1}, transmission_tint{1};
  float roughness_x = 0, roughness_y = 0, index = 1.5f;
  MicrofacetDistribution::Kind kind = MicrofacetDistribution::ggx;
  bool relative = false;
};
Ref<etendue::Shader> dielectric_model(bool beckmann, bool relative) {
  std::initializer_list<std::pair<const char*, Value>> members = {
      {"ior", Value(index_slot(false))},
      {"exterior", relative ? Value(flat_spectrum(1)) : Value()},
      {"reflection_tint", Value(Ref<etendue::Component>(color_slot(0)))},
      {"transmission_tint", Value(Ref<etendue::Component>(color_slot(1)))},
      {"roughness", Value(Ref<etendue::Component>(number_slot(0)))},
      {"roughness_v", Value(Ref<etendue::Component>(number_slot(1)))},
      {"distribution", Value(std::string(beckmann ? "beckmann" : "ggx"))}};
  return make_model("Dielectric", members);
}
void add_boundary(Gathering& g, const Boundary& b) {
  static const Ref<etendue::Shader> models[2][2] = {{dielectric_model(false, false), dielectric_model(false, true)},
                                                    {dielectric_model(true, false), dielectric_model(true, true)}};
  SlotValues v;
  v.colors[0] = g.reflectance(b.reflection_tint);
  v.colors[1] = g.reflectance(b.transmission_tint);
  v.numbers[0] = b.roughness_x;
  v.numbers[1] = b.roughness_y;
  v.index = Spectrum(clamp(b.index, 0.01f, 99));
  Lobes lobes = reflection_lobes | transmission_lobes;
  if (v.colors[0].black()) lobes &= Lobes(~reflection_lobes);
  if (v.colors[1].black()) lobes &= Lobes(~transmission_lobes);
  if (!lobes) return;
  if (!(lobes & transmission_lobes) && !g.refracts() && MicrofacetDistribution(b.kind, b.roughness_x, b.roughness_y).smooth())
    g.add(g.arena().make<CoatModel>(g.at(b.normal), v.colors[0], b.relative ? v.index : v.index / g.index_outside()),
          specular_reflection);
  else
    g.add(*models[b.kind == MicrofacetDistribution::beckmann ? 1 : 0][b.relative ? 1 : 0], v, g.at(b.normal, b.tangent), lobes);
}

void mirror(Gathering& g, Triple normal) {
  const Spectrum color = g.reflectance(Triple(1));
  g.add(g.arena().make<MirrorModel>(g.at(normal), SchlickFresnel{color, color, 5}), specular_reflection);
}
/// The index of the back of the surface over that of its front, from that of the side that N points away from.
float by_sides(const Gathering& g, const Triple& normal, float eta) { return g.points_back(normal) ? 1 / eta : eta; }

void reflection(Gathering& g, const Component& c) {
  const float eta = positional(c) > 1 ? c.argument<float>(1) : 0;
  const Triple n = c.argument<Triple>(0);
  if (!(eta > 0)) return mirror(g, n);
  Boundary b;
  b.normal = n;
  b.transmission_tint = Triple(0);
  b.index = by_sides(g, n, eta);
  b.relative = true;
  add_boundary(g, b);
}
void refraction(Gathering& g, const Component& c) {
  Boundary b;
  b.normal = c.argument<Triple>(0);
  b.reflection_tint = Triple(0);
  const float eta = c.argument<float>(1);
  if (!(eta > 0)) return g.warn("refraction() with an index that is not positive is black");
  b.index = by_sides(g, b.normal, eta);
  b.relative = true;
  add_boundary(g, b);
}
void microfacet(Gathering& g, const Component& c) {
  const bool anisotropic = positional(c) == 7;
  Boundary b;
  b.kind = distribution_named(g, string_at(c, 0));
  b.normal = c.argument<Triple>(1);
  if (anisotropic) b.tangent = c.argument<Triple>(2);
  const size_t at = anisotropic ? 3 : 2;
  b.roughness_x = c.argument<float>(at);
  b.roughness_y = anisotropic ? c.argument<float>(at + 1) : b.roughness_x;
  const float eta = c.argument<float>(at + (anisotropic ? 2 : 1));
  const int refract = c.argument<int>(at + (anisotropic ? 3 : 2));
  if (!(eta > 0)) {  // reflects everything
    if (refract == 1) return g.warn("microfacet() that refracts with an index that is not positive is black");
    const Spectrum color = g.reflectance(Triple(1));
    return g.add_facets(g.at(b.normal, b.tangent), {b.kind, b.roughness_x, b.roughness_y}, {color, color, 5});
  }
  if (refract == 0) b.transmission_tint = Triple(0);
  if (refract == 1) b.reflection_tint = Triple(0);
  b.index = by_sides(g, b.normal, eta);
  b.relative = true;
  add_boundary(g, b);
}

void dielectric_bsdf(Gathering& g, const Component& c) {
  Boundary b;
  b.normal = c.argument<Triple>(0);
  b.tangent = c.argument<Triple>(1);
  b.reflection_tint = c.argument<Triple>(2);
  b.transmission_tint = c.argument<Triple>(3);
  b.roughness_x = c.argument<float>(4);
  b.roughness_y = c.argument<float>(5);
  b.index = c.argument<float>(6);
  b.kind = distribution_named(g, string_at(c, 7));
  if (const Film film = film_of(g, c); film.thickness > 0) {
    const MicrofacetDistribution d(b.kind, b.roughness_x, b.roughness_y);
    const Spectrum reflected = g.reflectance(b.reflection_tint), through = g.reflectance(b.transmission_tint);
    SlotValues v;
    v.index = Spectrum(clamp(b.index, 0.01f, 99));
    const bool one_weight = reflected.minimum() == reflected.maximum() && through.minimum() == reflected.minimum() &&
                            through.maximum() == reflected.minimum();
    if (through.black()) {
      v.extinction = Spectrum();
      return add_film(g, g.at(b.normal, b.tangent), d, film, v, true, reflected, reflection_lobes);
    }
    if (d.smooth() && one_weight) return add_film(g, g.at(b.normal), d, film, v, false, reflected, all_lobes);
    g.warn("a film on a dielectric that refracts has no effect if it is rough or if its tints differ");
  }
  add_boundary(g, b);
}

/// Sets the complex index of a metal whose n and k are given for red, green and blue. Their reflectance r at normal incidence
/// and the place g of n between its extremes for that r become spectra of reflectances, from which n and k follow per
/// wavelength (Gulbrandsen 2014, "Artist friendly metallic Fresnel"):
///   n = g (1 - r) / (1 + r) + (1 - g) (1 + sqrt r) / (1 - sqrt r),   k^2 = (r (n + 1)^2 - (n - 1)^2) / (1 - r).
void set_metal(Gathering& g, const Triple& n, const Triple& k, SlotValues& v) {
  Triple r, edge;
  for (int i = 0; i < 3; ++i) {
    const float k2 = k[i] * k[i];
    r[i] = clamp((square(n[i] - 1) + k2) / std::max(square(n[i] + 1) + k2, 1e-6f), 0, 0.9999f);
    const float root = std::sqrt(r[i]), high = (1 + root) / (1 - root), low = (1 - r[i]) / (1 + r[i]);
    edge[i] = high > low ? clamp((high - n[i]) / (high - low), 0, 1) : 0;
  }
  const Spectrum rs = g.color(r, ColorUse::reflectance), es = g.color(edge, ColorUse::reflectance);
  for (int i = 0; i < spectrum_size; ++i) {
    const float x = clamp(rs[i], 0, 0.9999f), root = std::sqrt(x), e = clamp(es[i], 0, 1);
    const float index = e * (1 - x) / (1 + x) + (1 - e) * (1 + root) / (1 - root);
    v.index.set(i, index);
    v.extinction.set(i, safe_sqrt((x * square(index + 1) - square(index - 1)) / (1 - x)));
  }
}

Ref<etendue::Shader> conductor_model(const char* distribution) {
  return make_model("Conductor", {{"ior", Value(index_slot(true))},
                                  {"color", Value(Ref<etendue::Component>(color_slot(0)))},
                                  {"roughness", Value(Ref<etendue::Component>(number_slot(0)))},
                                  {"roughness_v", Value(Ref<etendue::Component>(number_slot(1)))},
                                  {"distribution", Value(std::string(distribution))}});
}
void conductor_bsdf(Gathering& g, const Component& c) {
  static const Ref<etendue::Shader> models[2] = {conductor_model("ggx"), conductor_model("beckmann")};
  SlotValues v;
  v.colors[0] = g.reflectance(Triple(1));
  v.numbers[0] = c.argument<float>(2);
  v.numbers[1] = c.argument<float>(3);
  const auto spectral = [&](size_t i) { return c.shape->arguments[i].type.base == Base::spectrum; };
  if (spectral(4) && spectral(5)) {
    v.index = c.argument<Spectrum>(4);
    v.extinction = c.argument<Spectrum>(5);
  } else {
    set_metal(g, c.argument<Triple>(4), c.argument<Triple>(5), v);
  }
  const MicrofacetDistribution d(distribution_named(g, string_at(c, 6)), v.numbers[0], v.numbers[1]);
  const SurfacePoint p = g.at(c.argument<Triple>(0), c.argument<Triple>(1));
  if (const Film film = film_of(g, c); film.thickness > 0)
    return add_film(g, p, d, film, v, true, v.colors[0], reflection_lobes);
  const bool beckmann = d.kind == MicrofacetDistribution::beckmann;
  g.add(*models[beckmann ? 1 : 0], v, p, reflection_lobes);
}

void generalized_schlick_bsdf(Gathering& g, const Component& c) {
  if (film_of(g, c).thickness > 0)
    g.warn("a film on generalized_schlick_bsdf() has no effect, as it has no index of refraction");
  const Triple tint = c.argument<Triple>(2), through = c.argument<Triple>(3), f0 = c.argument<Triple>(6);
  const MicrofacetDistribution d(distribution_named(g, string_at(c, 9)), c.argument<float>(4), c.argument<float>(5));
  const SurfacePoint p = g.at(c.argument<Triple>(0), c.argument<Triple>(1));
  if (tint.x > 0 || tint.y > 0 || tint.z > 0)
    g.add_facets(p, d,
                 {g.reflectance(tint * f0), g.reflectance(tint * c.argument<Triple>(7)), clamp(c.argument<float>(8), 0, 100)});
  if (through.x > 0 || through.y > 0 || through.z > 0) {
    // Refraction by the dielectric whose reflectance at normal incidence is the mean of F0.
    const float root = std::sqrt(clamp((f0.x + f0.y + f0.z) / 3, 1e-4f, 0.9f));
    Boundary b;
    b.normal = c.argument<Triple>(0);
    b.tangent = c.argument<Triple>(1);
    b.reflection_tint = Triple(0);
    b.transmission_tint = through;
    b.roughness_x = d.alpha_x;
    b.roughness_y = d.alpha_y;
    b.kind = d.kind;
    b.index = (1 + root) / (1 - root);
    add_boundary(g, b);
  }
}

constexpr Lobes facets = glossy_reflection | specular_reflection, through_facets = glossy_transmission | specular_transmission;

constexpr ClosureModel rows[] = {
    {"phong", phong, glossy_reflection},
    {"ward", ward, glossy_reflection},
    {"microfacet", microfacet, facets | through_facets},
    {"reflection", reflection, specular_reflection},
    {"refraction", refraction, specular_transmission},
    {"dielectric_bsdf", dielectric_bsdf, facets | through_facets},
    {"conductor_bsdf", conductor_bsdf, facets},
    {"generalized_schlick_bsdf", generalized_schlick_bsdf, facets | through_facets},
};

}  // namespace

std::span<const ClosureModel> facet_closures() { return rows; }

}  // namespace etendue::osl
