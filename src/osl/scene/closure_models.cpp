// What each closure is here. One row of the table `models` for each name.

#include "closure_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_map>

#include "closure_walk.h"
#include "components/shaders/tangent_frame.h"
#include "gathering.h"
#include "lobes.h"

namespace etendue::osl {

namespace {

using Component = ClosureComponent;

/// The number of a closure's arguments by position.
size_t positional(const Component& c) {
  size_t n = 0;
  while (n < c.shape->arguments.size() && !c.shape->arguments[n].keyword) ++n;
  return n;
}
const String* string_at(const Component& c, size_t i) { return c.argument<const String*>(i); }

/// The value of an optional argument, or `otherwise`.
float keyword(const Component& c, std::string_view name, float otherwise) {
  for (size_t i = 0; i < c.shape->arguments.size(); ++i) {
    const ClosureShape::Argument& a = c.shape->arguments[i];
    if (!a.keyword || a.keyword->view() != name) continue;
    if (a.type.is_float()) return c.argument<float>(i);
    if (a.type.is_int()) return float(c.argument<int>(i));
  }
  return otherwise;
}

MicrofacetDistribution::Kind distribution_named(Gathering& g, const String* name) {
  const std::string_view text = name->view();
  if (text == "beckmann") return MicrofacetDistribution::beckmann;
  if (text != "ggx" && text != "default" && !text.empty())
    g.warn(fmt::format("the distribution '{}' of facets is not known; 'ggx' is used", text));
  return MicrofacetDistribution::ggx;
}

void warn_of_film(Gathering& g, const Component& c) {
  if (keyword(c, "thinfilm_thickness", 0) > 0)
    g.warn("thinfilm_thickness has no effect: thin films on closures are not rendered; write one by `spectrum`");
}

// ---- diffuse
// ------------------------------------------------------------------------------------------------------------------

void diffuse(Gathering& g, const Component& c) {
  static const Ref<etendue::Shader> model =
      make_model("Lambertian", {{"color", Value(Ref<etendue::Component>(color_slot(0)))}});
  SlotValues v;
  v.colors[0] = g.reflectance(Triple(1));
  g.add(*model, v, g.at(c.argument<Triple>(0)), diffuse_reflection);
}

void rough_diffuse(Gathering& g, Triple normal, Triple albedo, float roughness) {
  static const Ref<etendue::Shader> model =
      make_model("OrenNayar", {{"color", Value(Ref<etendue::Component>(color_slot(0)))},
                               {"roughness", Value(Ref<etendue::Component>(number_slot(0)))}});
  SlotValues v;
  v.colors[0] = g.reflectance(albedo);
  v.numbers[0] = roughness;
  g.add(*model, v, g.at(normal), diffuse_reflection);
}

/// The roughness of the energy-preserving model (eon.h) for the slopes' standard deviation sigma [rad] of Oren & Nayar 1994:
/// f is proportional to A + B s / t there, and to 1 + r s / t here, so r = B / A.
float roughness_of_sigma(float sigma) {
  const float s2 = sigma * sigma, a = 1 - 0.5f * s2 / (s2 + 0.33f), b = 0.45f * s2 / (s2 + 0.09f);
  return clamp(b / a, 0, 1);
}

void oren_nayar(Gathering& g, const Component& c) {
  rough_diffuse(g, c.argument<Triple>(0), Triple(1), roughness_of_sigma(c.argument<float>(1)));
}

void oren_nayar_diffuse_bsdf(Gathering& g, const Component& c) {
  const float roughness = c.argument<float>(2);
  rough_diffuse(g, c.argument<Triple>(0), c.argument<Triple>(1),
                keyword(c, "energy_compensation", 0) != 0 ? clamp(roughness, 0, 1) : roughness_of_sigma(roughness));
}

void burley_diffuse_bsdf(Gathering& g, const Component& c) {
  const SurfacePoint p = g.at(c.argument<Triple>(0));
  g.add(g.arena().make<BurleyModel>(p, g.reflectance(c.argument<Triple>(1)), clamp(c.argument<float>(2), 0, 1)),
        diffuse_reflection);
}

void transmit_diffusely(Gathering& g, Triple normal, Triple albedo) {
  static const Ref<etendue::Shader> model =
      make_model("DiffuseTransmitter", {{"reflectance", Value(Ref<etendue::Component>(color_slot(0)))},
                                        {"transmittance", Value(Ref<etendue::Component>(color_slot(1)))}});
  SlotValues v;
  v.colors[0] = {};
  v.colors[1] = g.reflectance(albedo);
  g.add(*model, v, g.at(normal), diffuse_transmission);
}
void translucent(Gathering& g, const Component& c) { transmit_diffusely(g, c.argument<Triple>(0), Triple(1)); }
void translucent_bsdf(Gathering& g, const Component& c) { transmit_diffusely(g, c.argument<Triple>(0), c.argument<Triple>(1)); }

void sheen_bsdf(Gathering& g, const Component& c) {
  const SurfacePoint p = g.at(c.argument<Triple>(0));
  g.add(g.arena().make<SheenModel>(p, g.reflectance(c.argument<Triple>(1)), c.argument<float>(2)), diffuse_reflection);
}

void under_the_surface(Gathering& g, Triple normal, Triple albedo) {
  g.warn("subsurface scattering is rendered as diffuse reflection of the same albedo: light leaves where it entered");
  rough_diffuse(g, normal, albedo, 0);
}
void subsurface(Gathering& g, const Component& c) { under_the_surface(g, Triple(0), c.argument<Triple>(3)); }
void subsurface_bssrdf(Gathering& g, const Component& c) { under_the_surface(g, c.argument<Triple>(0), c.argument<Triple>(1)); }

// ---- highlights
// ---------------------------------------------------------------------------------------------------------------

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
  warn_of_film(g, c);
  Boundary b;
  b.normal = c.argument<Triple>(0);
  b.tangent = c.argument<Triple>(1);
  b.reflection_tint = c.argument<Triple>(2);
  b.transmission_tint = c.argument<Triple>(3);
  b.roughness_x = c.argument<float>(4);
  b.roughness_y = c.argument<float>(5);
  b.index = c.argument<float>(6);
  b.kind = distribution_named(g, string_at(c, 7));
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
  warn_of_film(g, c);
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
  const bool beckmann = distribution_named(g, string_at(c, 6)) == MicrofacetDistribution::beckmann;
  g.add(*models[beckmann ? 1 : 0], v, g.at(c.argument<Triple>(0), c.argument<Triple>(1)), reflection_lobes);
}

void generalized_schlick_bsdf(Gathering& g, const Component& c) {
  warn_of_film(g, c);
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

// ---- the rest
// ------------------------------------------------------------------------------------------------------------------

void transparent(Gathering& g, const Component&) {
  static const Ref<etendue::Shader> model = make_model("PassThrough", {});
  g.add(*model, SlotValues{}, g.point(), null_scattering, g.reflectance(Triple(1)));
}

void layer(Gathering& g, const Component& c) {
  g.add_layers(c.argument<const ClosureNode*>(0), c.argument<const ClosureNode*>(1));
}

void nothing(Gathering&, const Component&) {}
void volume(Gathering& g, const Component& c) {
  g.warn(c.shape->name->text() + "() has no effect on a surface: give the object an `interior`");
}
void hair(Gathering& g, const Component&) {
  g.warn("chiang_hair_bsdf() is black: hair is rendered by HairShader of the description only");
}

constexpr Lobes facets = glossy_reflection | specular_reflection, through_facets = glossy_transmission | specular_transmission;

struct Model {
  const char* name;
  void (*gather)(Gathering&, const Component&);  ///< null: the closure emits light
  Lobes lobes;
};
constexpr Model models[] = {
    {"diffuse", diffuse, diffuse_reflection},
    {"oren_nayar", oren_nayar, diffuse_reflection},
    {"oren_nayar_diffuse_bsdf", oren_nayar_diffuse_bsdf, diffuse_reflection},
    {"burley_diffuse_bsdf", burley_diffuse_bsdf, diffuse_reflection},
    {"translucent", translucent, diffuse_transmission},
    {"translucent_bsdf", translucent_bsdf, diffuse_transmission},
    {"sheen_bsdf", sheen_bsdf, diffuse_reflection},
    {"subsurface", subsurface, diffuse_reflection},
    {"subsurface_bssrdf", subsurface_bssrdf, diffuse_reflection},
    {"phong", phong, glossy_reflection},
    {"ward", ward, glossy_reflection},
    {"microfacet", microfacet, facets | through_facets},
    {"reflection", reflection, specular_reflection},
    {"refraction", refraction, specular_transmission},
    {"dielectric_bsdf", dielectric_bsdf, facets | through_facets},
    {"conductor_bsdf", conductor_bsdf, facets},
    {"generalized_schlick_bsdf", generalized_schlick_bsdf, facets | through_facets},
    {"transparent", transparent, null_scattering},
    {"transparent_bsdf", transparent, null_scattering},
    {"layer", layer, no_lobes},
    {"holdout", nothing, no_lobes},
    {"debug", nothing, no_lobes},
    {"chiang_hair_bsdf", hair, no_lobes},
    {"anisotropic_vdf", volume, no_lobes},
    {"medium_vdf", volume, no_lobes},
    {"isotropic", volume, no_lobes},
    {"henyey_greenstein", volume, no_lobes},
    {"absorption", volume, no_lobes},
    {"emission", nullptr, no_lobes},
    {"background", nullptr, no_lobes},
    {"uniform_edf", nullptr, no_lobes},
};

const Model* model_of(const String* name) {
  static const auto table = [] {
    std::unordered_map<const String*, const Model*> t;
    for (const Model& m : models) t[intern_string(m.name)] = &m;
    return t;
  }();
  const auto found = table.find(name);
  return found == table.end() ? nullptr : found->second;
}

}  // namespace

void Gathering::add_component(const ClosureComponent& c) {
  const Model* m = model_of(c.shape->name);
  if (m && m->gather) m->gather(*this, c);
}

namespace {

/// Calls a function for each expression of a shader.
template <class F>
class Visit {
 public:
  Visit(const Shader& shader, const F& f) : f_(f) {
    for (const auto& symbol : shader.symbols) expression(symbol->initial.get());
    for (const auto& function : shader.functions) statement(function->body.get());
    statement(shader.body.get());
  }

 private:
  void expression(const Expression* e) {
    if (!e) return;
    f_(*e);
    for (const auto& operand : e->operands) expression(operand.get());
  }
  void statement(const Statement* s) {
    if (!s) return;
    expression(s->expression.get());
    expression(s->step.get());
    for (const auto& inner : s->statements) statement(inner.get());
    statement(s->body.get());
    statement(s->otherwise.get());
  }
  const F& f_;
};

/// Whether an operand is known to be zero.
bool zero(const Expression& call, size_t i) {
  const Expression* e = i < call.operands.size() ? call.operands[i].get() : nullptr;
  if (!e || e->kind != Expression::Kind::constant) return false;
  return std::all_of(e->constant.bytes.begin(), e->constant.bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

/// The lobes of a call of a closure: without those that its constant arguments exclude.
Lobes lobes_of_call(const Model& m, const Expression& call) {
  const std::string_view name = m.name;
  constexpr auto reflects = Lobes(~transmission_lobes), transmits = Lobes(~reflection_lobes);
  Lobes lobes = m.lobes;
  if (name == "dielectric_bsdf" || name == "generalized_schlick_bsdf") {
    if (zero(call, 2)) lobes &= transmits;
    if (zero(call, 3)) lobes &= reflects;
  }
  if (name == "microfacet" && (zero(call, 6) || (call.operands.size() < 7 && zero(call, 4)))) lobes &= reflects;
  return lobes;
}

}  // namespace

ClosureUses uses_of(const Shader& shader) {
  ClosureUses uses;
  const auto note = [&](const Expression& e) {
    if (e.kind != Expression::Kind::closure) return;
    const Model* m = model_of(e.shape->name);
    if (!m) throw Error(fmt::format("the closure '{}' is not known here", e.shape->name->text()), e.place);
    uses.lobes |= lobes_of_call(*m, e);
    uses.scatters |= m->gather && m->gather != nothing;
    uses.emits |= !m->gather;
    uses.layers |= m->gather == layer;
  };
  Visit<decltype(note)>(shader, note);
  // Thin sheets (translucent) have no body inside; null scattering lets paths enter the object's interior.
  uses.interior = (uses.lobes & (specular_transmission | glossy_transmission | null_scattering)) != 0;
  return uses;
}

bool calls(const Shader& shader, std::string_view signature) {
  bool found = false;
  const auto note = [&](const Expression& e) {
    found |= e.kind == Expression::Kind::library && std::string_view(e.row->signature).starts_with(signature);
  };
  Visit<decltype(note)>(shader, note);
  return found;
}

ClosureUses& ClosureUses::operator|=(const ClosureUses& b) {
  lobes |= b.lobes;
  scatters |= b.scatters;
  emits |= b.emits;
  layers |= b.layers;
  interior |= b.interior;
  return *this;
}

Spectrum light_of(const ClosureNode* node, const RgbSpace& space, const Wavelengths& w) {
  static const String *emission = intern_string("emission"), *background = intern_string("background"),
                      *edf = intern_string("uniform_edf");
  Spectrum sum;
  each_component(node, [&](const ClosureComponent& c, Triple weight, const Spectrum& spectral) {
    if (c.shape->name == edf) weight = weight * c.argument<Triple>(0);
    if (c.shape->name != edf && c.shape->name != emission && c.shape->name != background) return;
    for (int i = 0; i < 3; ++i) weight[i] = weight[i] > 0 ? std::min(weight[i], 1e30f) : 0;
    sum += spectral * rgb_spectrum(space, weight.x, weight.y, weight.z, ColorUse::radiance, w);
  });
  return sum;
}

float refracting_index(const ClosureNode* node) {
  if (!node) return 1;
  if (node->kind == ClosureNode::Kind::sum) {
    const float first = refracting_index(static_cast<const ClosureSum*>(node)->a);
    return first != 1 ? first : refracting_index(static_cast<const ClosureSum*>(node)->b);
  }
  if (node->kind == ClosureNode::Kind::product) return refracting_index(static_cast<const ClosureProduct*>(node)->closure);
  const auto& c = *static_cast<const ClosureComponent*>(node);
  const std::string_view name = c.shape->name->view();
  const auto any = [](const Triple& t) { return t.x > 0 || t.y > 0 || t.z > 0; };
  float index = 1;
  if (name == "layer") {
    const float first = refracting_index(c.argument<const ClosureNode*>(0));
    return first != 1 ? first : refracting_index(c.argument<const ClosureNode*>(1));
  }
  if (name == "dielectric_bsdf" && any(c.argument<Triple>(3))) index = c.argument<float>(6);
  if (name == "refraction") index = c.argument<float>(1);
  if (name == "microfacet") {
    const size_t n = positional(c);
    if (c.argument<int>(n - 1) != 0) index = c.argument<float>(n - 2);
  }
  if (name == "generalized_schlick_bsdf" && any(c.argument<Triple>(3))) {
    const Triple f0 = c.argument<Triple>(6);
    const float root = std::sqrt(clamp((f0.x + f0.y + f0.z) / 3, 1e-4f, 0.9f));
    index = (1 + root) / (1 - root);
  }
  return index > 0.01f && index < 100 ? index : 1;
}

}  // namespace etendue::osl
