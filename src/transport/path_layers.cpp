#include "etendue/transport/path_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "etendue/transport/path_vertex.h"
#include "film/picture_format.h"

namespace etendue {
namespace {

const std::string& name_of(const Component* part) {
  static const std::string none;
  return part && part->origin ? part->origin->name : none;
}

/// Visits each object of a scene once with each shader that instances give it.
template <class Visit>
void visit_objects(const Scene& scene, const Shader* instead, std::set<std::pair<const Scene*, const Shader*>>& seen,
                   const Visit& visit) {
  if (!seen.insert({&scene, instead}).second) return;
  for (const Ref<SceneObject>& object : scene.objects) {
    if (const Scene* inner = scene_within(*object)) {
      const bool replaces = inner != object.get() && object->shader;
      visit_objects(*inner, instead ? instead : replaces ? object->shader.get() : nullptr, seen, visit);
    } else {
      visit(*object, instead ? instead : object->shader.get());
    }
  }
}

[[noreturn]] void refuse(const ImageBuffer& image, const std::string& layer, const PathExpression& expression,
                         const PathExpression::Mention& mention, const std::set<std::string>& known) {
  const std::vector<std::string> all(known.begin(), known.end());
  image.fail("layers", fmt::format("{}{}: {}", PictureFormat::path_prefix, layer,
                                   PathExpression::place(expression.text(), mention.at,
                                                         fmt::format("nothing in the scene is called '{}'{}", mention.name,
                                                                     suggestion(mention.name, all)))));
}

}  // namespace

thread_local constinit PathStates* PathStates::current_ = nullptr;

PathLayers::PathLayers(const Scene& scene, const ImageBuffer& image) {
  const std::vector<PictureFormat::PathLayer>& wanted = image.format()->path_layers;
  if (wanted.empty()) return;
  count_ = wanted.size();
  PathLabelNames names;
  std::vector<PathExpression> expressions;
  for (const PictureFormat::PathLayer& layer : wanted) expressions.emplace_back(layer.expression, names);

  std::set<std::string> known;
  const auto note = [&](const Component* part) {
    const std::string& name = name_of(part);
    if (name.empty()) return PathLabels(0);
    known.insert(name);
    const auto found = std::ranges::find(names.names, name);
    if (found == names.names.end()) return PathLabels(0);
    return labels_[part] = PathLabels(1) << (found - names.names.begin());
  };
  std::set<PathLabels> others;
  const auto visit = [&](const SceneObject& object, const Shader* shader) {
    const PathLabels own = note(&object.original());
    for (const Component* part : {static_cast<const Component*>(shader), static_cast<const Component*>(object.emission.get()),
                                  static_cast<const Component*>(object.interior.get())})
      others.insert(own | note(part));
    others.insert(own);
  };
  if (!names.names.empty()) {
    std::set<std::pair<const Scene*, const Shader*>> seen;
    visit_objects(scene, nullptr, seen, visit);
    for (const SceneObject* luminaire : scene.luminaires()) visit(*luminaire, luminaire->shader.get());
  }
  for (size_t i = 0; i < expressions.size(); ++i)
    for (const PathExpression::Mention& mention : expressions[i].mentions())
      if (!known.contains(mention.name)) refuse(image, wanted[i].name, expressions[i], mention, known);
  others.erase(0);
  classes_ = {0};
  classes_.insert(classes_.end(), others.begin(), others.end());
  try {
    automaton_ = PathAutomaton(expressions, classes_);
  } catch (const Error& e) {
    image.fail("layers", e.what());
  }
}

PathLabels PathLayers::labels_of(const Component* part) const {
  const auto found = labels_.find(part);
  return found == labels_.end() ? 0 : found->second;
}

int PathLayers::class_of(const SceneObject* object, const Component* part) const {
  if (labels_.empty()) return 0;
  const PathLabels own = object ? labels_of(&object->original()) : 0, labels = own | labels_of(part);
  auto found = std::ranges::lower_bound(classes_, labels);
  if (found == classes_.end() || *found != labels) found = std::ranges::lower_bound(classes_, own);
  return int(found - classes_.begin());
}

PathEvent PathLayers::end_at(const SceneObject* luminaire) {
  if (!luminaire) return PathEvent::emission;
  return luminaire->infinite() && !luminaire->delta() ? PathEvent::background : PathEvent::light;
}

PathStates::PathStates(const PathLayers* layers) : layers_(layers), before_(current_) {
  if (layers_ && layers_->count() > 0) current_ = this;
}
PathStates::~PathStates() { current_ = before_; }

void PathStates::clear() {
  parts_.clear();
  ranges_.clear();
}

PathStates::Events PathStates::events_at(const PathVertex& v, const Vector3& in, Lobe lobe, Transport transport) const {
  Events found;
  found.count = 1;
  found.all[0].weight = Spectrum(1.0f);
  if (v.in_medium()) {
    found.all[0].event = PathEvent::volume;
    found.label_class = layers_->class_of(v.medium.object, v.medium.volume);
    return found;
  }
  found.label_class = layers_->class_of(v.point.object, v.point.object ? v.point.object->shader.get() : nullptr);
  // Light that leaves a body in which it was scattered crosses its surface.
  bool through = v.subsurface_exit || (dot(v.point.normal, v.out) > 0) != (dot(v.point.normal, in) > 0);
  if (lobe & (specular_reflection | specular_transmission)) {
    through = lobe == specular_transmission;
    found.all[0].event = through ? PathEvent::specular_transmission : PathEvent::specular_reflection;
    return found;
  }
  const PathEvent diffuse = through ? PathEvent::diffuse_transmission : PathEvent::diffuse_reflection;
  const PathEvent glossy = through ? PathEvent::glossy_transmission : PathEvent::glossy_reflection;
  const Lobes present = v.scatter ? Lobes(v.scatter->lobes() & v.lobes) : no_lobes;
  if (!(present & glossy_lobes) || !(present & diffuse_lobes)) {
    found.all[0].event = present & glossy_lobes ? glossy : diffuse;
    return found;
  }
  const Spectrum f_diffuse = v.scatter->evaluate(v.out, in, {transport, Lobes(v.lobes & diffuse_lobes)});
  const Spectrum f_glossy = v.scatter->evaluate(v.out, in, {transport, Lobes(v.lobes & glossy_lobes)});
  const Spectrum f = f_diffuse + f_glossy;
  Spectrum is_diffuse, is_glossy;
  for (int i = 0; i < spectrum_size; ++i) {
    const float part = f[i] > 0 ? f_diffuse[i] / f[i] : 1;
    is_diffuse.set(i, part);
    is_glossy.set(i, 1 - part);
  }
  found.count = 0;
  if (!f_diffuse.black() || f_glossy.black()) found.all[found.count++] = {diffuse, is_diffuse};
  if (!f_glossy.black()) found.all[found.count++] = {glossy, is_glossy};
  return found;
}

std::span<const PathStates::Part> PathStates::parts_of(PathState state, Part& single) const {
  if (state.value < PathState::mixed) {
    single.value = state.value;
    return {&single, 1};
  }
  const Range range = ranges_[state.value - PathState::mixed];
  return std::span(parts_).subspan(range.begin, range.end - range.begin);
}

PathState PathStates::stored(std::vector<Part>& parts) {
  if (parts.size() == 1) return {parts[0].value};
  ranges_.push_back({std::uint32_t(parts_.size()), std::uint32_t(parts_.size() + parts.size())});
  parts_.insert(parts_.end(), parts.begin(), parts.end());
  return {PathState::mixed + std::uint32_t(ranges_.size()) - 1};
}

template <class Next, class Weight>
PathState PathStates::made(PathState state, size_t count, const Next& next, const Weight& weight) {
  if (!state.known()) return state;
  if (state.value < PathState::mixed && count == 1) return {next(state.value, 0)};
  scratch_.clear();
  Part single;
  for (const Part& part : parts_of(state, single))
    for (size_t i = 0; i < count; ++i) {
      const std::uint32_t value = next(part.value, i);
      const Spectrum share = count == 1 ? part.weight : part.weight * weight(i);
      const auto same = std::ranges::find(scratch_, value, &Part::value);
      if (same == scratch_.end())
        scratch_.push_back({value, share});
      else
        same->weight += share;
    }
  return stored(scratch_);
}

PathState PathStates::scattered(PathState before, const PathVertex& v, const Vector3& in, Lobe lobe) {
  if (lobe == null_scattering) return before;
  const Events events = events_at(v, in, lobe, Transport::radiance);
  const PathAutomaton& automaton = layers_->automaton();
  return made(
      before, size_t(events.count),
      [&](std::uint32_t s, size_t i) -> std::uint32_t {
        return automaton.scattered(PathAutomaton::State(s), events.all[i].event, events.label_class);
      },
      [&](size_t i) { return events.all[i].weight; });
}

PathState PathStates::scattered_in(PathState before, const SceneObject* medium) {
  const int label_class = layers_->class_of(medium, medium ? medium->interior.get() : nullptr);
  return made(
      before, 1,
      [&](std::uint32_t s, size_t) -> std::uint32_t {
        return layers_->automaton().scattered(PathAutomaton::State(s), PathEvent::volume, label_class);
      },
      [](size_t) { return Spectrum(1.0f); });
}

PathState PathStates::scattered_before(PathState after, const PathVertex& v, const Vector3& on, Lobe lobe) {
  if (lobe == null_scattering) return after;
  const Events events = events_at(v, on, lobe, Transport::importance);
  const PathAutomaton& automaton = layers_->automaton();
  return made(
      after, size_t(events.count),
      [&](std::uint32_t s, size_t i) -> std::uint32_t {
        return automaton.scattered_before(PathAutomaton::State(s), events.all[i].event, events.label_class);
      },
      [&](size_t i) { return events.all[i].weight; });
}

PathState PathStates::begun(const SceneObject* luminaire) const {
  return {layers_->automaton().end(PathLayers::end_at(luminaire),
                                   layers_->class_of(luminaire, luminaire ? luminaire->emission.get() : nullptr))};
}

PathState PathStates::ended(PathState state, const SceneObject* luminaire, const SceneObject* medium) {
  const PathEvent event = PathLayers::end_at(luminaire);
  const Component* part = luminaire ? static_cast<const Component*>(luminaire->emission.get())
                          : medium  ? static_cast<const Component*>(medium->interior.get())
                                    : nullptr;
  const int label_class = layers_->class_of(luminaire ? luminaire : medium, part);
  return made(
      state, 1,
      [&](std::uint32_t s, size_t) -> std::uint32_t {
        return layers_->automaton().ended(PathAutomaton::State(s), event, label_class);
      },
      [](size_t) { return Spectrum(1.0f); });
}

PathState PathStates::alone(PathState state, int lane) {
  if (!state.known() || state.value < PathState::mixed) return state;
  Part single;
  const std::span<const Part> parts = parts_of(state, single);
  scratch_.assign(parts.begin(), parts.end());
  for (Part& part : scratch_) part.weight = Spectrum(part.weight[lane]);
  return stored(scratch_);
}

PathState PathStates::joined(PathState first, PathState rest) {
  if (!first.known() || !rest.known()) return {};
  Part single;
  const std::span<const Part> others = parts_of(rest, single);
  return made(
      first, others.size(),
      [&](std::uint32_t s, size_t i) -> std::uint32_t {
        return layers_->automaton().joined(PathAutomaton::State(s), PathAutomaton::State(others[i].value));
      },
      [&](size_t i) { return others[i].weight; });
}

}  // namespace etendue
