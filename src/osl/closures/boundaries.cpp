// Closures of dielectric boundaries, and of mirrors.

#include <algorithm>

#include "boundary.h"
#include "components/shaders/microfacet/rough_dielectric.h"
#include "facet_arguments.h"

namespace etendue::osl {

namespace {

using Component = ClosureComponent;

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

}  // namespace

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
  if (!(lobes & transmission_lobes) && !g.refracts()) {
    const Spectrum eta = b.relative ? v.index : v.index / g.index_outside();
    if (RoughDielectric::smooth(b.facets(), eta))
      return g.add(g.arena().make<CoatModel>(g.at(b.normal), v.colors[0], eta), specular_reflection);
    const SurfacePoint& p = g.at(b.normal, b.tangent);
    const Frame frame = b.facets().isotropic() ? Frame(p.shading_normal) : tangent_frame(p);
    return g.add(g.arena().make<RoughCoatModel>(p, frame, b.facets(), v.colors[0], eta), glossy_reflection);
  }
  const etendue::Shader& model = *models[b.kind == MicrofacetDistribution::beckmann ? 1 : 0][b.relative ? 1 : 0];
  const SurfacePoint& p = g.at(b.normal, b.tangent);
  const bool half = lobes != (reflection_lobes | transmission_lobes);
  if (!half || g.exits()) return g.add(model, v, p, lobes);
  if (const Gathering::Half* other = g.other_half(b)) {
    v.colors[lobes & reflection_lobes ? 1 : 0] = other->values.colors[lobes & reflection_lobes ? 1 : 0];
    return g.join(*other, model, v, p);
  }
  g.add(model, v, p, lobes);
  g.note_half(b, v);
}

namespace {

void mirror(Gathering& g, Triple normal) {
  const Spectrum color = g.reflectance(Triple(1));
  g.add(g.arena().make<MirrorReflection<SchlickFresnel>>(g.at(normal), SchlickFresnel{color, color, 5}, Spectrum(1.0f)),
        specular_reflection);
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
  b.kind = distribution_named(g, c, 0);
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
    return g.add_facets(g.at(b.normal, b.tangent), b.facets(), SchlickFresnel{color, color, 5});
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
  b.kind = distribution_named(g, c, 7);
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

constexpr Lobes facets = glossy_reflection | specular_reflection, through_facets = glossy_transmission | specular_transmission;

constexpr ClosureModel rows[] = {
    {"microfacet", microfacet, facets | through_facets, 0.15f},
    {"reflection", reflection, specular_reflection},
    {"refraction", refraction, specular_transmission},
    {"dielectric_bsdf", dielectric_bsdf, facets | through_facets, 0.15f},
};

}  // namespace

std::span<const ClosureModel> boundary_closures() { return rows; }

}  // namespace etendue::osl
