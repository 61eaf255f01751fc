// The table of closures, and what a shader's text says about its closures.

#include "closure_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "closure_rows.h"
#include "closure_walk.h"
#include "osl/library/closures.h"

namespace etendue::osl {

size_t positional(const ClosureComponent& c) {
  size_t n = 0;
  while (n < c.shape->arguments.size() && !c.shape->arguments[n].keyword) ++n;
  return n;
}

float keyword(const ClosureComponent& c, std::string_view name, float otherwise) {
  for (size_t i = 0; i < c.shape->arguments.size(); ++i) {
    const ClosureShape::Argument& a = c.shape->arguments[i];
    if (!a.keyword || a.keyword->view() != name) continue;
    if (a.type.is_float()) return c.argument<float>(i);
    if (a.type.is_int()) return float(c.argument<int>(i));
  }
  return otherwise;
}

namespace {

using Component = ClosureComponent;

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
constexpr ClosureModel rows[] = {
    {"transparent", transparent, null_scattering},
    {"transparent_bsdf", transparent, null_scattering},
    {"layer", layer, no_lobes, 0, false},
    {"holdout", nothing, no_lobes},
    {"debug", nothing, no_lobes},
    {"anisotropic_vdf", volume, no_lobes},
    {"medium_vdf", volume, no_lobes},
    {"isotropic", volume, no_lobes},
    {"henyey_greenstein", volume, no_lobes},
    {"absorption", volume, no_lobes},
    {"emission", nullptr, no_lobes},
    {"background", nullptr, no_lobes},
    {"uniform_edf", nullptr, no_lobes},
};

const ClosureModel* model_of(const String* name) {
  static const auto table = [] {
    std::unordered_map<const String*, const ClosureModel*> t;
    for (const std::span<const ClosureModel> part :
         {std::span<const ClosureModel>(rows), diffuse_closures(), facet_closures(), boundary_closures(), body_closures()})
      for (const ClosureModel& m : part) t[intern_string(m.name)] = &m;
    return t;
  }();
  const auto found = table.find(name);
  return found == table.end() ? nullptr : found->second;
}

}  // namespace

Spectrum Gathering::add_component(const ClosureComponent& c) {
  // By its place in the language's table, which is faster than by its name.
  static const auto by_number = [] {
    std::vector<const ClosureModel*> models;
    for (const ClosureSignature& s : closures()) {
      const std::string_view text = s.signature, begin = "closure color ";
      models.push_back(model_of(intern_string(text.substr(begin.size(), text.find('(') - begin.size()))));
    }
    return models;
  }();
  const ClosureModel* m = c.shape->known >= 0 ? by_number[std::size_t(c.shape->known)] : model_of(c.shape->name);
  if (!m || !m->gather) return {};
  component_bound_ = weight_bound();
  m->gather(*this, c);
  return component_bound_;
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

bool is_body(const ClosureModel& m) { return std::string_view(m.name).starts_with("subsurface"); }
/// Whether light that the closure transmits goes on inside the object: a body of subsurface scattering has exits of its own,
/// and light that passed a fibre is outside again.
bool enters(const ClosureModel& m) { return !is_body(m) && std::string_view(m.name) != "chiang_hair_bsdf"; }

/// Whether an operand is known to be zero.
bool zero(const Expression& call, size_t i) {
  const Expression* e = i < call.operands.size() ? call.operands[i].get() : nullptr;
  if (!e || e->kind != Expression::Kind::constant) return false;
  return std::all_of(e->constant.bytes.begin(), e->constant.bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

/// The lobes of a call of a closure: without those that its constant arguments exclude.
Lobes lobes_of_call(const ClosureModel& m, const Expression& call) {
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

/// The error of the albedo of a call of a closure: none of facets that are smooth by constant arguments.
float error_of_call(const ClosureModel& m, const Expression& call) {
  const std::string_view name = m.name;
  const bool smooth = (name == "conductor_bsdf" && zero(call, 2) && zero(call, 3)) ||
                      (name == "dielectric_bsdf" && zero(call, 4) && zero(call, 5));
  return smooth ? 0 : m.albedo_error;
}

}  // namespace

ClosureUses uses_of(const Shader& shader) {
  ClosureUses uses;
  Lobes inside = no_lobes;
  bool layers = false, sums = false;
  const auto note = [&](const Expression& e) {
    sums |= e.operation == Operator::add && e.type.is_closure();
    if (e.kind != Expression::Kind::closure) return;
    const ClosureModel* m = model_of(e.shape->name);
    if (!m) throw Error(fmt::format("the closure '{}' is not known here", e.shape->name->text()), e.place);
    uses.lobes |= lobes_of_call(*m, e);
    uses.scatters |= m->gather && m->gather != nothing;
    uses.emits |= !m->gather;
    uses.reciprocal &= m->reciprocal;
    uses.albedo_error = std::max(uses.albedo_error, error_of_call(*m, e));
    layers |= std::string_view(m->name) == "layer";
    uses.bodies |= is_body(*m);
    if (enters(*m)) inside |= lobes_of_call(*m, e);
  };
  Visit<decltype(note)>(shader, note);
  // What a layer of uncertain albedo lets through is small where it reflects most. A sum may be limited, and its albedo then
  // is a bound (Mixture). No closer bound is known of these.
  if ((layers && uses.albedo_error > 0) || sums) uses.albedo_error = std::max(uses.albedo_error, 0.3f);
  // Thin sheets (translucent) have no body inside; null scattering lets paths enter the object's interior.
  uses.interior = (inside & (specular_transmission | glossy_transmission | null_scattering)) != 0;
  return uses;
}

bool lets_through(const ClosureNode* node) {
  bool found = false;
  each_component(node, [&](const ClosureComponent& c, const Triple&, const Spectrum&) {
    const ClosureModel* m = model_of(c.shape->name);
    if (!m || !enters(*m) || !(m->lobes & transmission_lobes & ~null_scattering)) return;
    const std::string_view name = m->name;
    const size_t tint = name == "dielectric_bsdf" || name == "generalized_schlick_bsdf" ? 3 : 0;
    if (tint > 0 && c.argument<Triple>(tint) == Triple(0)) return;
    if (name == "microfacet" && c.argument<int>(positional(c) - 1) == 0) return;
    found = true;
  });
  return found;
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
  reciprocal &= b.reciprocal;
  bodies |= b.bodies;
  interior |= b.interior;
  albedo_error = std::max(albedo_error, b.albedo_error);
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

namespace {

/// The index that a component refracts with; 1: it does not.
float index_of_component(const ClosureComponent& c) {
  const std::string_view name = c.shape->name->view();
  const auto any = [](const Triple& t) { return t.x > 0 || t.y > 0 || t.z > 0; };
  float index = 1;
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

}  // namespace

float refracting_index(const ClosureNode* node) {
  float first = 1;
  each_component(node, [&](const ClosureComponent& c, const Triple&, const Spectrum&) {
    if (first == 1) first = index_of_component(c);
  });
  return first;
}

}  // namespace etendue::osl
