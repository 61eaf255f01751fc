// Objects of the world, their materials and emission, instances.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "reader.h"

namespace etendue::pbrt {

AnimatedTransform Reader::to_world(const Transform& inner) const {
  const Transform first = state.ctm[0] * inner;
  if (state.ctm[0] == state.ctm[1] || !(times[0] < times[1])) return first;
  return AnimatedTransform({{float(times[0]), first}, {float(times[1]), state.ctm[1] * inner}});
}

void Reader::add(const Ref<Component>& object) { into_->push_back(ref_cast<SceneObject>(object)); }

void Reader::add_light(const Ref<Component>& object) { objects_.push_back(ref_cast<SceneObject>(object)); }

bool front_matters(const Reader& reader) {
  const State& state = reader.state;
  if (state.light || state.reversed || state.inside != state.outside) return true;
  const auto named = reader.named_materials.find(state.named_material);
  return has_front(reader, reader.materials[named == reader.named_materials.end() ? state.material : named->second]);
}

namespace {

/// If the transform mirrors, pbrt reverses the normal of a quadric at ray hits but not when its light is sampled.
void tell_mirrored(Reader& reader, const std::string& type, Location at) {
  for (const char* turned : {"sphere", "cylinder", "disk", "cone", "curve"})
    if (type == turned && reader.state.ctm[0].flips() && reader.state.ctm[0] == reader.state.ctm[1] && front_matters(reader))
      reader.importing.inexact(
          fmt::format("a mirroring transform leaves the front of a {} where it is; pbrt exchanges its inside and outside",
                      type),
          at);
}

/// The opacity of a shape: in v3 it is 0 where alpha is 0, else 1.
Value opacity_of(Reader& reader, const Parameters& p) {
  if (!p.has("alpha")) return {};
  Value alpha = number_map(reader, p, {"alpha"}, 1);
  if (reader.version != 3) return alpha;
  if (const Number* n = alpha.as<Number>()) return Value(Number{n->value == 0 ? 0.0 : 1.0}, p.at);
  return Value(formula(reader, p.at, "step(0.00001, alpha)", {{"alpha", alpha}}), p.at);
}

/// The emission of a shape with holes: multiplied by alpha.
Ref<Component> with_holes(Reader& reader, const Ref<Component>& emission, const Value& alpha, Location at) {
  if (alpha.none()) return emission;
  if (const Number* n = alpha.as<Number>(); n && n->value >= 1) return emission;
  const Ref<Component> own = copy(*emission), product = reader.make("MultiplyMap", at);
  set_map(*product, "first", get(*emission, "radiance"), at);
  set_map(*product, "second", alpha, at);
  set_member(*own, "radiance", product, at);
  return own;
}

/// Whether pbrt creates no light for a shape that should emit.
bool leaves_light_out(Reader& reader, Location at) {
  const State& state = reader.state;
  if (reader.version == 3) {
    if (!reader.to_world().animated()) return false;
    reader.importing.inexact("the light of a shape that moves is left out, as in pbrt", at);
    return true;
  }
  const auto named = reader.named_materials.find(state.named_material);
  const std::string& type = reader.materials[named == reader.named_materials.end() ? state.material : named->second].type;
  if (!type.empty() && type != "interface" && type != "none") return false;
  reader.importing.inexact("the light of a shape without a surface, whose material is an interface, is left out, as in pbrt",
                           at);
  return true;
}

/// In pbrt no ray hits a light whose alpha is the constant 0, but surfaces still sample it by next event estimation: a lamp
/// that is invisible in the image.
void light_unseen(Reader& reader, Component& object, const Ref<Component>& emission, Location at) {
  set_emission(object, emission, at);
  set_member(object, "shader", reader.make("PassThrough", at), at);
  set_member(object, "visible_to_camera", false, at);
  reader.importing.inexact(
      "a light whose alpha is 0 is left out of what the camera sees; in mirrors and behind smooth glass it shows here, and not "
      "in pbrt",
      at);
}

}  // namespace

// In v3 a shape's parameters override those of its material, for any parameter that the material reads.
size_t Reader::material_for(const Parameters& shape) {
  if (version != 3) return state.material;
  constexpr std::string_view of_shapes[] = {"alpha", "shadowalpha", "filename", "type", "scheme"};  // stay with the shape
  const Parameters& of = materials[state.material].parameters;
  std::vector<const Parameter*> said;
  for (const Parameter& p : shape.own)
    if (std::ranges::count(of_shapes, p.name) == 0 && of.asked_for(p.name)) said.push_back(&p);
  if (said.empty()) return state.material;
  std::string key = std::to_string(state.material);
  Material changed{materials[state.material].type, {}, of, {}};
  changed.parameters.forget();  // unused parameters of the original were reported already
  changed.parameters.overridden.clear();
  for (const Parameter* p : said) {
    p->used = true;
    key += fmt::format("|{}|{}|{}|{}", p->type, p->name, fmt::join(p->numbers, ","), fmt::join(p->strings, ","));
    std::erase_if(changed.parameters.own, [&](const Parameter& other) { return other.name == p->name; });
    changed.parameters.own.push_back(*p);
  }
  const auto [known, added] = changed_materials_.try_emplace(key, materials.size());
  if (added) {
    materials.push_back(std::move(changed));
    make_with_present_textures(*this, known->second);
  }
  return known->second;
}

void Reader::shape(const std::string& type, Parameters&& p) {
  const size_t material = std::exchange(state.material, material_for(p));
  try {
    add_shape(type, std::move(p));
  } catch (...) {
    state.material = material;
    throw;
  }
  state.material = material;
}

void Reader::add_shape(const std::string& type, Parameters&& p) {
  const Location at = p.at;
  const Value alpha = opacity_of(*this, p);
  const Number* whole = alpha.as<Number>();
  const bool emits = state.light && !leaves_light_out(*this, at), unseen = emits && whole && whole->value == 0 && !in_object();
  const Shape made = make_shape(*this, type, p);
  if (p.has("shadowalpha"))
    importing.inexact("'shadowalpha' is left out: shadows are those of 'alpha'", p.place("shadowalpha"));
  if (p.has("S")) importing.inexact("tangents of vertices are left out", p.place("S"));
  if (p.has("faceIndices")) importing.inexact("numbers of faces are left out", p.place("faceIndices"));
  p.tell_unused(importing);
  if (!made.object) return;
  tell_mirrored(*this, type, at);
  Component& object = *made.object;
  const AnimatedTransform transform = to_world(made.inner);
  if (!transform.valid()) {
    importing.inexact(fmt::format("{} is left out: its transform, which cannot be inverted, leaves no body of it", p.of), at);
    return;
  }
  set_member(object, "transform", transform, at);
  if (emits && in_object())
    importing.inexact("objects that are instanced do not emit in pbrt, nor here", at);
  else if (emits) {
    const Ref<Component> emission = area_emission(*this, *state.light, made.turned, made.pieces);
    unseen ? light_unseen(*this, object, emission, at) : set_emission(object, with_holes(*this, emission, alpha, at), at);
  }
  if (unseen) return add(made.object);
  // The interior is the side that the normal does not point to.
  const std::string &inside = made.turned ? state.outside : state.inside, &outside = made.turned ? state.inside : state.outside;
  if (!inside.empty())
    if (const Ref<Component> medium = medium_for(*this, inside, transform, at)) set_member(object, "interior", medium, at);
  sides_.push_back({made.object, inside, outside, in_object(), at});
  bool no_uvs = type == "trianglemesh";
  for (const Parameter& parameter : p.own)
    if (parameter.name == "uv" || parameter.name == "st" || parameter.name == "UV") no_uvs = false;
  waiting_.push_back({made.object, state.material, state.named_material, alpha, made.turned, no_uvs, at});
  add(made.object);
}

void Reader::begin_object(const std::string& name, Location at) {
  if (in_object()) throw Error("an object cannot be defined within another", at);
  into_ = &object_parts_;
  object_name_ = name;
  object_at_ = at;
}

Ref<Scene> Reader::scene_of(const std::vector<Ref<SceneObject>>& objects, Location at, const std::string& name) {
  const Ref<Component> scene = make(imported_structure, at, name);
  Ref<Scene> result = ref_cast<Scene>(scene);
  result->objects = objects;
  return result;
}

void Reader::end_object(Location at) {
  if (!in_object()) throw Error("ObjectEnd without ObjectBegin", at);
  instanced_[object_name_] = scene_of(object_parts_, object_at_, object_name_);
  object_parts_.clear();
  into_ = &objects_;
}

void Reader::instance(const std::string& name, Location at) {
  if (in_object()) throw LeftOut("an object cannot be instanced within the definition of another", at);
  const auto found = instanced_.find(name);
  if (found == instanced_.end()) {
    std::vector<std::string> known;
    for (const auto& [n, scene] : instanced_) known.push_back(n);
    throw LeftOut(fmt::format("there is no object named '{}'{}", name, suggestion(name, known)), at);
  }
  if (found->second->objects.empty()) return;
  const Ref<Component> object = make("Instance", at);
  set_member(*object, "scene", Ref<Component>(found->second), at);
  const AnimatedTransform transform = to_world(Transform());
  if (!transform.valid()) throw Error("the instance cannot be placed: its transform cannot be inverted", at);
  set_member(*object, "transform", transform, at);
  add(object);
}

Ref<Component> Reader::shader_for(const Waiting& w) {
  const auto named = named_materials.find(w.named_material);
  turned = w.turned && has_front(*this, materials[named == named_materials.end() ? w.material : named->second]);
  Ref<Component> shader =
      w.named_material.empty() ? shader_of(*this, w.material, w.at) : shader_named(*this, w.named_material, w.at);
  if (w.alpha.none()) return shader;
  // One mask for each pair of material and opacity, shared by all shapes with them.
  const auto* map = w.alpha.as<Ref<Component>>();
  const std::string key = map ? fmt::format("{}", static_cast<const void*>(map->get())) : write_value(w.alpha);
  Ref<Component>& mask = masked_[{shader.get(), key}];
  if (!mask) {
    mask = make("MaskShader", w.at);
    set_member(*mask, "shader", shader, w.at);
    set_map(*mask, "opacity", w.alpha, w.at);
  }
  return mask;
}

void Reader::finish_materials() {
  std::vector<Error> errors;
  for (const Waiting& w : waiting_) try {
      const Ref<Component> shader = shader_for(w);
      set_member(*w.object, "shader", shader, w.at);
      if (!w.no_uvs) continue;
      const auto named = named_materials.find(w.named_material);
      const Parameters& p = materials[named == named_materials.end() ? w.material : named->second].parameters;
      for (const Parameter& parameter : p.own)
        if (parameter.is("texture")) {
          importing.inexact("a textured mesh without surface coordinates has those of each triangle, which are not pbrt's",
                            w.at);
          break;
        }
    } catch (const Error& e) {
      bool told = false;
      for (const Error& other : errors) told = told || (other.location == e.location && std::string(other.what()) == e.what());
      if (!told) errors.push_back(e);
      if (errors.size() == 20) break;
    }
  if (!errors.empty()) throw Errors(std::move(errors));
  turned = false;
  // Mistakes in materials that no object uses are only warnings.
  for (size_t i = 0; i < materials.size(); ++i) try {
      if (!materials[i].shaders[1]) shader_of(*this, i, materials[i].parameters.at);
    } catch (const Error& e) {
      importing.inexact(e.what(), e.location);
    }
}

Ref<Job> Reader::finish() {
  if (in_object()) throw Error("this ObjectBegin has no ObjectEnd", object_at_);
  finish_materials();
  if (const Ref<SceneObject> around = settle_media()) objects_.push_back(around);
  const Location at = importing.at();
  const Ref<Component> job = make("Job", at);
  set_camera(*this, *job);
  set_film(*this, *job);
  set_renderer(*this, *job);
  if (seed) set_member(*job, "seed", double(std::max(*seed, 0)), at);
  set_member(*job, "scene", Ref<Component>(scene_of(objects_, at, "")), at);
  return ref_cast<Job>(job);
}

}  // namespace etendue::pbrt
