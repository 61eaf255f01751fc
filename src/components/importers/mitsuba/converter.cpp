#include "converter.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "transport/unprepared.h"

namespace etendue::mitsuba {

namespace {

constexpr size_t most_errors = 20;  // reported at once

}  // namespace

Converter::Reading::Reading(const Element& element) : element_(element) {
  if (element.being_read) throw Error(fmt::format("this {} '{}' holds itself", element.tag, element.type), element.at);
  element.being_read = element.read = true;
}

namespace {

/// The first nested element with one of these types, or with any type if the list is empty; null: there is none. Searches
/// recursively.
const Element* first_of(const Element& within, const char* tag, std::initializer_list<const char*> types) {
  for (const Property& p : within.properties) {
    const auto* nested = std::get_if<Nested>(&p.value);
    if (!nested || !nested->reference.empty()) continue;
    const Element& e = *nested->element;
    const bool is_one = types.size() == 0 || std::ranges::any_of(types, [&](const char* type) { return e.type == type; });
    if (e.tag == tag && is_one) return &e;
    if (const Element* inner = first_of(e, tag, types)) return inner;
  }
  return nullptr;
}

/// Whether an integrator of the scene handles participating media; many of Mitsuba 0.5 do.
bool knows_media(const Element& scene) {
  return first_of(scene, "integrator", {"volpath", "volpathmis", "prbvolpath", "volpath_simple"}) ||
         (scene.old && first_of(scene, "integrator", {"bdpt", "ptracer", "photonmapper", "pssmlt", "mlt", "erpt", "vpl"}));
}

}  // namespace

Ref<Job> Converter::job(const Element& scene) {
  const Reading reading(scene);
  pair_sun_and_sky(scene);
  Ref<Component> job = importing_.make("Job", scene.at);
  std::vector<const Element*> sensors = scene.all("sensor");
  const Element* sensor = sensors.empty() ? nullptr : sensors.front();
  if (sensors.size() > 1) importing_.inexact("the scene has several sensors: the first counts", sensors[1]->at);

  Ref<Component> objects = importing_.make(imported_structure, scene.at);
  Value::List list;
  std::vector<Error> errors;
  for (const Property& p : scene.properties) {
    const auto* nested = std::get_if<Nested>(&p.value);
    if (!nested || !nested->reference.empty()) continue;
    const Element& e = *nested->element;
    try {
      Ref<SceneObject> object;
      if (e.tag == "shape" && e.type != "shapegroup") object = shape(e);
      if (e.tag == "emitter") object = emitter(e);
      if (object) list.emplace_back(Ref<Component>(object), e.at);
    } catch (const Error& error) {
      errors.push_back(error);
      if (errors.size() >= most_errors) throw Errors(std::move(errors));
    }
    if (e.tag == "shape" || e.tag == "emitter" || e.tag == "bsdf" || e.tag == "texture" || e.tag == "medium" ||
        e.tag == "phase" || e.tag == "volume" || e.tag == "spectrum")
      p.asked = true;
  }
  if (!errors.empty()) throw Errors(std::move(errors));
  if (list.empty()) importing_.inexact("the scene has no shapes", scene.at);
  const std::vector<const Element*> films = sensor ? sensor->all("film") : std::vector<const Element*>{};
  const std::vector<const Element*> samplers = sensor ? sensor->all("sampler") : std::vector<const Element*>{};
  const std::vector<const Element*> integrators = scene.all("integrator");
  const Element* const film = films.empty() ? nullptr : films.front();
  const Ref<Component> picture = image(film);
  set_member(*job, "image", picture, scene.at);
  // volpath does not count null scattering (BSDFFlags::Null), such as transmission through a thin dielectric, for max_depth;
  // path does.
  const Element* volumetric = first_of(scene, "integrator", {"volpath", "volpathmis", "prbvolpath"});
  const Element* pane = first_of(scene, "bsdf", {"thindielectric"});
  if (volumetric && pane && volumetric->integer("max_depth", -1) >= 0)
    importing_.inexact("passing through a thin dielectric counts for max_depth here, unlike in volpath", pane->at);
  if (sensor) set_member(*job, "camera", camera(*sensor), sensor->at);
  set_member(
      *job, "renderer",
      renderer(scene, integrators.empty() ? nullptr : integrators.front(), samplers.empty() ? nullptr : samplers.front()),
      scene.at);
  if (!layers_.empty()) set_member(*picture, "layers", layers_, scene.at);
  if (!samplers.empty() && samplers.front()->has("seed")) {
    const Reading of_sampler(*samplers.front());
    const std::int64_t seed = samplers.front()->integer("seed", 0);
    set_member(*job, "seed", double(std::max<std::int64_t>(seed, 0)), samplers.front()->location_of("seed"));
  }
  std::vector<Ref<SceneObject>> world;
  for (const Value& v : list) world.push_back(ref_cast<SceneObject>(*v.as<Ref<Component>>()));
  if (!sensor) set_member(*job, "camera", default_camera(scene, world), scene.at);
  if (scene.old && !first_of(scene, "emitter", {})) {
    world.push_back(default_sky(scene));
    list.emplace_back(Ref<Component>(world.back()), scene.at);
  }
  if (const Ref<SceneObject> around = settle_media(sensor, knows_media(scene), world))
    list.emplace_back(Ref<Component>(around), scene.at);
  if (hides_emitters_.known()) hide_emitters(world);
  set(*objects, "objects", Value(std::move(list)));
  set_member(*job, "scene", objects, scene.at);
  add_outputs(*job, film);
  note_unread(scene);
  return ref_cast<Job>(job);
}

void Converter::hide_emitters(const std::vector<Ref<SceneObject>>& objects) {
  for (const Ref<SceneObject>& object : objects) {
    if (const Scene* inner = scene_within(*object))
      hide_emitters(inner->objects);
    else if (!object->luminaire() || object->delta())
      continue;
    else if (enterable_once_prepared(*object))
      importing_.inexact("an emitter that light goes into is seen: it cannot be hidden from the camera", hides_emitters_);
    else
      set_member(*object, "visible_to_camera", false, hides_emitters_);
  }
}

void Converter::set_transform(Component& part, const TransformValue& t, Location at) {
  if (t.transform.animated())
    set_member(part, "transform", t.transform, at);
  else if (!t.transform.still().identity())
    set_member(part, "transform", t.transform.still(), at);
}

FilePath Converter::file(const Element& e, const std::string& name) {
  const std::string named = e.string(name, "");
  if (!e.has(name)) throw Error(fmt::format("{} '{}' needs a '{}'", e.tag, e.type, name), e.at);
  return {importing_.file(named, e.location_of(name), e.folder), {}};
}

void Converter::fail_unknown(const Element& e, const std::vector<std::string>& known) const {
  throw Error(fmt::format("there is no {} '{}' in Mitsuba{}", e.tag, e.type, suggestion(e.type, known)), e.at);
}

void Converter::stand_in(const Element& e, const std::vector<std::string>& known, const std::string& what) {
  if (std::ranges::find(known, e.type) != known.end())
    inexact(e, fmt::format("{} '{}' has no counterpart here: {}", e.tag, e.type, what));
  else
    inexact(e, fmt::format("there is no {} '{}' in Mitsuba{}: {}", e.tag, e.type, suggestion(e.type, known), what));
  e.dismiss();
}

void Converter::note_unread(const Element& scene) {
  struct Unread {
    std::string what;
    Location at;
  };
  std::vector<Unread> all;
  std::vector<const char*> files;  // in the order of first use; each name is stored only once
  std::vector<const Element*> open{&scene};
  std::set<const Element*> seen;
  while (!open.empty()) {
    const Element& e = *open.back();
    open.pop_back();
    if (!seen.insert(&e).second) continue;
    for (const Property& p : e.properties) {
      if (std::ranges::find(files, p.at.file) == files.end()) files.push_back(p.at.file);
      const auto* nested = std::get_if<Nested>(&p.value);
      if (nested && nested->element->read) open.push_back(nested->element);
      // A plugin directly in the scene need not be read there: plugins inside may refer to it.
      if (!e.read || e.dismissed || p.asked || (nested && &e == &scene && nested->element->read)) continue;
      if (nested) {
        all.push_back({fmt::format("{} '{}' has no use for a {} '{}'{}", e.tag, e.type, nested->element->tag,
                                   nested->element->type, p.name.empty() ? "" : " called '" + p.name + "'"),
                       p.at});
      } else {
        std::vector<std::string> known = e.known;
        std::erase(known, p.name);
        all.push_back({fmt::format("'{}' of {} '{}' is not used{}", p.name, e.tag, e.type, suggestion(p.name, known)), p.at});
      }
    }
  }
  // Of several places with the same message the first in the file is reported.
  const auto place = [&](const Unread& u) {
    return std::tuple(std::ranges::find(files, u.at.file) - files.begin(), u.at.line, u.at.column);
  };
  std::ranges::stable_sort(all, {}, place);
  for (const Unread& u : all) importing_.inexact(u.what, u.at);
}

}  // namespace etendue::mitsuba
