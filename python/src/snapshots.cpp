#include "snapshots.h"

#include <tbb/task.h>

#include <unordered_set>

#include "describe/expansion.h"
#include "etendue/camera.h"
#include "etendue/render/renderer.h"
#include "geometry/rendering_space.h"
#include "live_render.h"

namespace etendue::python {

namespace {

using Tree = std::unordered_set<const Component*>;

/// Calls call(original, copied) for a part and all parts within it, each once.
template <class F>
void for_pairs(Component& original, Component& copied, const F& call) {
  Tree seen{&original};
  std::vector<std::pair<Component*, Component*>> left{{&original, &copied}};
  while (!left.empty()) {
    const auto [from, to] = left.back();
    left.pop_back();
    call(*from, *to);
    const std::vector<Component*> inner = components_of(*from), copies = components_of(*to);
    for (size_t i = 0; i < inner.size(); ++i)
      if (seen.insert(inner[i]).second) left.emplace_back(inner[i], copies.at(i));
  }
}

/// Parts that are written in Python may keep what they like among the attributes of their objects.
void copy_attributes(const Component& original, Component& copied) {
  const nb::object from = living_object(original);
  if (!from.is_valid() || !nb::hasattr(from, "__dict__")) return;
  const nb::object attributes = from.attr("__dict__");
  if (nb::len(attributes) == 0) return;
  const nb::object to = wrap(Ref<Component>(&copied));
  to.attr("__dict__").attr("update")(attributes);
}

struct Entry {
  Ref<Component> original;
  FilmSize film;
  std::shared_ptr<Snapshot> snapshot;
};

std::vector<Entry>& entries() {
  static auto* all = new std::vector<Entry>;  // never destroyed: Python objects outlive the module
  return *all;
}

/// The number of edits so far: a snapshot is not kept if there was one while it was made.
std::uint64_t edits = 0;

/// More snapshots than this are not kept, as each is looked at when a part is edited.
constexpr size_t most_entries = 256;

}  // namespace

Snapshot::Snapshot(Component& original, FilmSize film) : copied_at_(edits), part_(copy(original)), film_(film) {
  for_pairs(original, *part_, [&](Component& from, Component& to) {
    parts_.insert(&from);
    copy_attributes(from, to);
    if (const auto* object = dynamic_cast<const SceneObject*>(&to); object && &to != part_.get()) {
      index_.emplace(object, int(objects_.size()));
      objects_.emplace_back(&from);
    }
  });
}

void Snapshot::prepare() {
  use_threads();
  released([&] {
    if (auto* const scene = dynamic_cast<Scene*>(part_.get())) {
      prepare_scene(*scene);
    } else if (auto* const camera = dynamic_cast<Camera*>(part_.get())) {
      const std::optional<Camera::Place> place = camera->place();
      if (place && is_finite(place->position)) origin_ = place->position;
      camera->rendering_origin = origin_;
      prepare_tree(*camera);
      camera->set_film(film_.width, film_.height);
    } else {
      prepare_tree(*part_);
    }
  });
}

/// As Job::prepare does for a scene that is far from its camera: floats are precise near the origin, which is therefore moved
/// into a scene that is far from the world's.
void Snapshot::prepare_scene(Scene& scene) {
  set_rendering_origin(scene, origin_, 0);
  prepare_tree(scene);
  constexpr float far = 4;
  const Vector3 away = scene.centre() - Point3{};
  if (!(length(away) > far * scene.radius()) || !is_finite(away)) return;
  origin_ = origin_ + DoubleVector3(away);
  set_rendering_origin(scene, origin_, 0);
  prepare_tree(scene);
}

int Snapshot::index_of(const SceneObject& object) const {
  const auto found = index_.find(&object.original());
  return found == index_.end() ? -1 : found->second;
}

const LightSampler& Snapshot::light_sampler(nb::handle given) const {
  std::shared_ptr<const Snapshot> described;
  if (!given.is_none()) described = snapshot_of<LightSampler>(given, "a light sampler");
  for (const Built& known : built_)
    if (known.described == described) return *known.sampler;
  Ref<LightSampler> sampler;
  if (described)
    sampler = ref_cast<LightSampler>(copy(described->part()));
  else
    sampler = ref_cast<Renderer>(Registry::instance().create("PathTracer"))->light_sampler;
  released([&] {
    prepare_tree(*sampler);
    sampler->build(as<Scene>());
  });
  built_.push_back({described, sampler});
  return *built_.back().sampler;
}

namespace {

/// A snapshot that is not prepared yet, copied while no living render edits the part.
std::shared_ptr<Snapshot> copied(Component& original, FilmSize film) {
  LiveRender* const live = render_of(original);
  // Within a step of the render no edit can be made, and one that waits for the step must not be waited for.
  if (!live || tbb::task::current_context()) return std::make_shared<Snapshot>(original, film);
  return live->unedited([&](Render&) {
    const nb::gil_scoped_acquire with;
    return std::make_shared<Snapshot>(original, film);
  });
}

}  // namespace

std::shared_ptr<const Snapshot> snapshot_of(nb::handle part, FilmSize film) {
  const Ref<Component> original = component_of(part);
  for (const Entry& known : entries())
    if (known.original == original && known.film == film) return known.snapshot;
  const std::shared_ptr<Snapshot> made = copied(*original, film);
  made->prepare();
  if (made->copied_at() != edits) return made;
  if (entries().size() == most_entries) entries().erase(entries().begin());
  entries().push_back({original, film, made});
  return made;
}

void forget_snapshots(const Component& part) {
  ++edits;
  std::vector<Entry> dropped;  // destroyed last, as that may call Python
  std::erase_if(entries(), [&](Entry& entry) {
    if (!entry.snapshot->is_of(part)) return false;
    dropped.push_back(std::move(entry));
    return true;
  });
}

void release_snapshots(const Component& part) {
  std::vector<Entry> dropped;
  std::erase_if(entries(), [&](Entry& entry) {
    // The object that is being destroyed has a reference, too.
    if (entry.original->references() > (entry.original.get() == &part ? 2 : 1)) return false;
    dropped.push_back(std::move(entry));
    return true;
  });
}

}  // namespace etendue::python
