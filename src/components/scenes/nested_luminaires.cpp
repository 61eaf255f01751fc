#include "nested_luminaires.h"

namespace etendue {

/// The objects of a scene that are luminaires, or nested scenes that contain luminaires.
struct NestedLuminaires::Contents {
  std::vector<const SceneObject*> lights, placings;
  double count = 0;  ///< of luminaires, in all placements
};

/// Inspects each scene once, however often it is placed, and then visits only placements that contain luminaires.
class NestedLuminaires::Finder {
 public:
  explicit Finder(NestedLuminaires& to) : to_(to) {}

  const Contents& contents(const Scene& scene) {
    const auto [place, fresh] = known_.try_emplace(&scene);
    Contents& c = place->second;  // remains valid when entries are added
    if (!fresh) return c;
    for (const Ref<SceneObject>& object : scene.objects) {
      if (const Scene* inner = scene_within(*object)) {
        const double count = contents(*inner).count;
        if (count > 0) c.placings.push_back(object.get());
        c.count += count;
      } else if (shines(*object)) {
        c.lights.push_back(object.get());
        ++c.count;
      }
    }
    return c;
  }

  void place(const Scene& scene, const Placement* around) {
    const Contents& c = contents(scene);
    if (around)
      for (const SceneObject* light : c.lights) to_.add(*light, *around);
    for (const SceneObject* placing : c.placings)
      place(*scene_within(*placing), &to_.placements_.emplace_back(Placement{placing, around}));
  }

 private:
  NestedLuminaires& to_;
  std::unordered_map<const Scene*, Contents> known_;
};

std::shared_ptr<NestedLuminaires> NestedLuminaires::of(const Scene& scene) {
  auto found = std::make_shared<NestedLuminaires>();
  Finder finder(*found);
  const Contents& c = finder.contents(scene);
  const double count = c.count - double(c.lights.size());
  if (count > double(most))
    scene.fail("objects",
               fmt::format("{:.0f} luminaires stand in nested scenes, counted in every place where those stand; more "
                           "than {} would take too much memory. Take the emission from the smallest of them",
                           count, most));
  if (count == 0) return nullptr;
  found->all_.reserve(size_t(count));
  finder.place(scene, nullptr);
  found->make_table();
  return found;
}

void NestedLuminaires::add(const SceneObject& light, const Placement& place) {
  // If an instance replaces shaders, hits refer to another object than `light`.
  Hit hit;
  hit.object = &light;
  bool similar = true;
  for (const Placement* p = &place; p != nullptr; p = p->outer) {
    if (const auto* instance = dynamic_cast<const Instance*>(p->scene))
      instance->note_way_out(hit);
    else
      hit.scenes[hit.depth++] = p->scene;
    for (const AnimatedTransform::Key& key : p->scene->transform.keys()) similar &= similarity_scale(key.transform) > 0;
  }
  const Ref<PlacedLuminaire>& placed = all_.emplace_back(make<PlacedLuminaire>(*hit.object, place, *this));
  const bool formula = light.delta() || light.infinite() || similar || light.transform.animated();
  placed->find_stretch(formula ? nullptr : &spreads_.try_emplace(hit.object, *hit.object, 0.0f).first->second);
}

const NormalSpread* NestedLuminaires::spread(const SceneObject& inner) const {
  const auto found = spreads_.find(&inner);
  return found == spreads_.end() ? nullptr : &found->second;
}

std::uint64_t NestedLuminaires::hash(const PlacedLuminaire& luminaire) {
  std::uint64_t bits = reinterpret_cast<std::uintptr_t>(&luminaire.inner());
  for (const Placement* p = &luminaire.place(); p != nullptr; p = p->outer)
    bits = mix_bits(bits) + reinterpret_cast<std::uintptr_t>(p->scene);
  return mix_bits(bits);
}

void NestedLuminaires::make_table() {
  slots_.assign(std::bit_ceil(2 * all_.size()), 0);
  for (size_t i = 0; i < all_.size(); ++i) {
    size_t slot = hash(*all_[i]) & (slots_.size() - 1);
    while (slots_[slot] != 0) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = std::uint32_t(i + 1);
  }
}

const PlacedLuminaire* NestedLuminaires::find(const Hit& hit) const {
  std::uint64_t bits = reinterpret_cast<std::uintptr_t>(hit.object);
  for (int i = 0; i < hit.depth; ++i) bits = mix_bits(bits) + reinterpret_cast<std::uintptr_t>(hit.scenes[i]);
  const auto same = [&](const PlacedLuminaire& l) {
    if (&l.inner() != hit.object) return false;
    const Placement* p = &l.place();
    for (int i = 0; i < hit.depth; ++i, p = p->outer)
      if (p == nullptr || p->scene != hit.scenes[i]) return false;
    return p == nullptr;
  };
  for (size_t slot = mix_bits(bits) & (slots_.size() - 1); slots_[slot] != 0; slot = (slot + 1) & (slots_.size() - 1))
    if (const PlacedLuminaire& l = *all_[slots_[slot] - 1]; same(l)) return &l;
  return nullptr;
}

}  // namespace etendue
