// Closures of highlights: facets of metals and of Schlick's approximation, and lobes without facets.

#include "facet_arguments.h"

#include <fmt/format.h>

#include <algorithm>

#include "etendue/describe/bands.h"

namespace etendue::osl {

MicrofacetDistribution::Kind distribution_named(const Gathering& g, const ClosureComponent& c, size_t i) {
  const std::string_view text = c.argument<const String*>(i)->view();
  if (text == "beckmann") return MicrofacetDistribution::beckmann;
  if (text != "ggx" && text != "default" && !text.empty())
    g.warn(fmt::format("the distribution '{}' of facets is not known; 'ggx' is used", text));
  return MicrofacetDistribution::ggx;
}

// ---- thin films

Film film_of(const Gathering& g, const ClosureComponent& c) {
  const Film f{keyword(c, "thinfilm_thickness", 0), keyword(c, "thinfilm_ior", 1.5f)};
  if (f.thickness > 0 && in_bands(g.wavelengths())) {
    g.warn("a thin film interferes wavelength by wavelength, and is left out where paths carry three bands");
    return {0, f.index};
  }
  return {std::isfinite(f.thickness) ? clamp(f.thickness, 0, 1e5f) : 0, clamp(f.index, 0.01f, 99)};
}

namespace {

Ref<etendue::Shader> film_model(bool opaque) {
  return make_model("ThinFilm", {{"thickness", Value(Ref<etendue::Component>(number_slot(2)))},
                                 {"film_ior", Value(film_slot())},
                                 {"base_ior", Value(index_slot(opaque))},
                                 {"opaque", Value(opaque)}});
}

}  // namespace

void add_film(Gathering& g, const SurfacePoint& p, const MicrofacetDistribution& d, const Film& film, SlotValues v, bool opaque,
              const Spectrum& color, Lobes lobes) {
  static const Ref<etendue::Shader> models[2] = {film_model(false), film_model(true)};
  v.numbers[2] = film.thickness;
  v.film = Spectrum(film.index);
  if (d.smooth()) return g.add(*models[opaque ? 1 : 0], v, p, lobes, color);
  FilmFresnel fresnel;
  fresnel.outside = g.index_outside();
  fresnel.film = v.film;
  fresnel.base = v.index;
  if (opaque) fresnel.absorbing = v.extinction;
  fresnel.set_thickness(film.thickness, g.wavelengths());
  g.add_facets(p, d, fresnel, color);
}

namespace {

using Component = ClosureComponent;

void phong(Gathering& g, const Component& c) {
  g.add(g.arena().make<PhongModel>(g.at(c.argument<Triple>(0)), g.reflectance(Triple(1)), clamp(c.argument<float>(1), 0, 1e6f)),
        glossy_reflection);
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

/// A metal's Fresnel reflectance; n and k over the index of the medium in front.
struct MetalFresnel {
  Spectrum n, k, diffuse_mean;

  /// As fresnel_conductor, for all wavelengths at once.
  Spectrum at(float cosine) const {
    const float c = clamp(cosine, 0, 1), c2 = c * c, s2 = 1 - c2;
    const Spectrum d = n * n - k * k - Spectrum(s2), product = 2 * n * k;
    const Spectrum sum = sqrt(d * d + product * product);
    Spectrum a;  // the root of (sum + d) / 2, where that cancels from a b = n k
    for (int i = 0; i < spectrum_size; ++i) {
      const float q = std::sqrt(0.5f * (sum[i] + std::abs(d[i])));
      a.set(i, d[i] > 0 ? q : product[i] / (2 * q + 1e-30f));
    }
    const Spectrum ac2 = a * (2 * c), across = sum + Spectrum(c2), along = sum * c2 + Spectrum(s2 * s2);
    const Spectrum s = (across - ac2) / (across + ac2 + Spectrum(1e-20f));
    const Spectrum p = (along - ac2 * s2) / (along + ac2 * s2 + Spectrum(1e-20f));
    return clamp(0.5f * s * (Spectrum(1.0f) + p), 0, 1);
  }
  const Spectrum& mean() const { return diffuse_mean; }
};

/// A metal whose n and k are given for red, green and blue, as colours: its reflectance r along the normal, the place g of n
/// between its extremes for that r, and its mean reflectance under diffuse light.
struct MetalColors {
  Triple n{-1}, k{-1}, r, edge, mean;

  MetalColors() = default;
  MetalColors(const Triple& index, const Triple& extinction) : n(index), k(extinction) {
    for (int i = 0; i < 3; ++i) {
      const float k2 = k[i] * k[i];
      r[i] = clamp((square(n[i] - 1) + k2) / std::max(square(n[i] + 1) + k2, 1e-6f), 0, 0.9999f);
      const float root = std::sqrt(r[i]), high = (1 + root) / (1 - root), low = (1 - r[i]) / (1 + r[i]);
      edge[i] = high > low ? clamp((high - n[i]) / (high - low), 0, 1) : 0;
      mean[i] = clamp(mean_fresnel_conductor(Spectrum(n[i]), Spectrum(k[i]))[0], 0, 1);
    }
  }
};

/// The colours become spectra of reflectances, from which n and k follow per wavelength (Gulbrandsen 2014, "Artist friendly
/// metallic Fresnel"):
///   n = g (1 - r) / (1 + r) + (1 - g) (1 + sqrt r) / (1 - sqrt r),   k^2 = (r (n + 1)^2 - (n - 1)^2) / (1 - r).
MetalFresnel metal_of(const Gathering& g, const MetalColors& colors, const Spectrum& outside) {
  const Spectrum one(1.0f);
  const Spectrum r = clamp(g.color(colors.r, ColorUse::reflectance), 0, 0.9999f), root = sqrt(r);
  const Spectrum e = clamp(g.color(colors.edge, ColorUse::reflectance), 0, 1);
  const Spectrum n = e * (one - r) / (one + r) + (one - e) * (one + root) / (one - root);
  const Spectrum above = n + one, below = n - one;
  MetalFresnel metal{n / outside, sqrt((r * above * above - below * below) / (one - r)) / outside, {}};
  metal.diffuse_mean = (outside - one).black() ? clamp(g.color(colors.mean, ColorUse::reflectance), 0, 1)
                                               : mean_fresnel_conductor(metal.n, metal.k);
  return metal;
}

/// The metal for the path's wavelengths. The colours of the last few metals of this thread are kept, and for a path's
/// wavelengths the spectra: a path that meets a metal mostly meets it again.
const MetalFresnel& recent_metal(const Gathering& g, const Triple& n, const Triple& k, const Spectrum& outside) {
  struct Entry {
    MetalColors colors;
    Spectrum wavelengths, outside;
    MetalFresnel metal;
  };
  constexpr int size = 8;
  thread_local Entry entries[size];
  thread_local int next = 0;
  Spectrum w;
  for (int i = 0; i < spectrum_size; ++i) w.set(i, g.wavelengths()[i]);
  Entry* found = nullptr;
  for (Entry& e : entries)
    if (e.colors.n == n && e.colors.k == k) found = &e;
  if (found && (found->wavelengths - w).black() && (found->outside - outside).black()) return found->metal;
  if (!found) {
    found = &entries[next++ % size];
    found->colors = MetalColors(n, k);
  }
  found->wavelengths = w;
  found->outside = outside;
  found->metal = metal_of(g, found->colors, outside);
  return found->metal;
}

void conductor_bsdf(Gathering& g, const Component& c) {
  const Spectrum tint = g.reflectance(Triple(1)), outside = g.index_outside();
  const MicrofacetDistribution d(distribution_named(g, c, 6), c.argument<float>(2), c.argument<float>(3));
  const SurfacePoint& p = g.at(c.argument<Triple>(0), c.argument<Triple>(1));
  const auto spectral = [&](size_t i) { return c.shape->arguments[i].type.base == Base::spectrum; };
  MetalFresnel metal;
  if (spectral(4) && spectral(5)) {
    metal.n = max(c.argument<Spectrum>(4), 1e-3f) / outside;
    metal.k = max(c.argument<Spectrum>(5), 0) / outside;
    metal.diffuse_mean = mean_fresnel_conductor(metal.n, metal.k);
  } else {
    metal = recent_metal(g, c.argument<Triple>(4), c.argument<Triple>(5), outside);
  }
  if (const Film film = film_of(g, c); film.thickness > 0) {
    SlotValues v;
    v.index = metal.n * outside;
    v.extinction = metal.k * outside;
    return add_film(g, p, d, film, v, true, tint, reflection_lobes);
  }
  g.add_facets(p, d, metal, tint);
}

void generalized_schlick_bsdf(Gathering& g, const Component& c) {
  if (film_of(g, c).thickness > 0)
    g.warn("a film on generalized_schlick_bsdf() has no effect, as it has no index of refraction");
  const Triple tint = c.argument<Triple>(2), through = c.argument<Triple>(3), f0 = c.argument<Triple>(6);
  const MicrofacetDistribution d(distribution_named(g, c, 9), c.argument<float>(4), c.argument<float>(5));
  const SurfacePoint& p = g.at(c.argument<Triple>(0), c.argument<Triple>(1));
  if (tint.x > 0 || tint.y > 0 || tint.z > 0)
    g.add_facets(p, d,
                 SchlickFresnel{g.reflectance(tint * f0), g.reflectance(tint * c.argument<Triple>(7)),
                                clamp(c.argument<float>(8), 0, 100)});
  if (through.x > 0 || through.y > 0 || through.z > 0) {
    g.adds_up();  // what is refracted does not follow from what is reflected
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
    {"phong", phong, glossy_reflection, 0.3f},
    {"ward", ward, glossy_reflection, 0.05f},
    {"conductor_bsdf", conductor_bsdf, facets, 0.1f},
    {"generalized_schlick_bsdf", generalized_schlick_bsdf, facets | through_facets, 0.3f},
};

}  // namespace

std::span<const ClosureModel> facet_closures() { return rows; }

}  // namespace etendue::osl
