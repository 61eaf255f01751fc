#include "consequences.h"

#include <functional>

#include "describe/guard.h"

namespace etendue {
namespace {

/// Calls for every component in a value.
void for_components(const Value& value, const std::function<void(Component&)>& call) {
  if (const auto* component = value.as<Ref<Component>>()) {
    if (*component) call(**component);
  } else if (const auto* list = value.as<Value::List>()) {
    for (const Value& item : *list) for_components(item, call);
  }
}

/// Whether a component is `part`, or contains it at any depth.
bool holds(const Component& holder, const Component& part) {
  std::unordered_set<const Component*> seen;
  std::vector<const Component*> rest{&holder};
  while (!rest.empty()) {
    const Component& c = *rest.back();
    rest.pop_back();
    if (&c == &part) return true;
    if (!seen.insert(&c).second) continue;
    for (const Member& member : c.class_info().members)
      if (member.kind == Kind::component)
        for_components(member.get(c, member), [&](Component& next) { rest.push_back(&next); });
  }
  return false;
}

}  // namespace

Holders::Holders(const Job& job) {
  held_by_[&job];
  std::vector<const Component*> rest{&job};
  while (!rest.empty()) {
    const Component& holder = *rest.back();
    rest.pop_back();
    for (const Member& member : holder.class_info().members) {
      if (member.kind != Kind::component) continue;
      for_components(member.get(holder, member), [&](Component& part) {
        const auto [at, fresh] = held_by_.try_emplace(&part);
        at->second.push_back({&holder, &member});
        if (fresh) rest.push_back(&part);
      });
    }
  }
}

// An effect propagates from a component to its holders, and the holding member limits or raises it. A member with
// Effect::retone reduces it to retone. A member with Effect::rebuild raises rerender to rebuild, unless the component is an
// object, whose shape does not change: structures over objects are built from their shapes.
void Consequences::spread(const Holders& holders, const Component& part, Effect effect) {
  const auto [at, fresh] = parts_.try_emplace(&part, effect);
  if (!fresh && at->second >= effect) return;
  at->second = effect;
  if (dynamic_cast<const Job*>(&part)) effect_ = std::max(effect_, effect);
  const bool is_object = dynamic_cast<const SceneObject*>(&part) != nullptr;
  for (const Holders::Holder& holder : holders.of(part)) {
    Effect above = effect;
    if (holder.member->effect == Effect::retone) above = std::min(effect, Effect::retone);
    if (holder.member->effect == Effect::rebuild && effect == Effect::rerender && !is_object) above = Effect::rebuild;
    spread(holders, *holder.component, above);
  }
}

void Consequences::note(const Holders& holders, Component& part, const Member& member, const Value& now) {
  spread(holders, part, member.effect);
  if (auto* object = dynamic_cast<SceneObject*>(&part); object && member.kind == Kind::transform) {
    moved_.emplace(object, object->transform.outer_origin());
    // The origin of the objects within depends on this transform.
    everything_ |= !objects_within(*object).empty() || dynamic_cast<Instance*>(object) != nullptr;
  }
  if (member.kind != Kind::component) return;
  structure_ = true;
  const ClassInfo* kind = Registry::instance().find(member.component_class);
  const bool of_objects = kind && kind->is_a(*Registry::instance().find("SceneObject"));
  bool objects_in_it = of_objects;
  for_components(now, [&](Component& c) {
    objects_in_it |= dynamic_cast<SceneObject*>(&c) != nullptr;
    if (holds(c, part)) throw Error(part.class_info().name + "." + member.name + ": a component cannot contain itself");
  });
  everything_ |= objects_in_it;
}

void Consequences::prepare(Job& job, const Holders& before) const {
  if (effect_ >= Effect::rerender) {
    bool everything = everything_ || job.rendering_origin_is_stale();
    if (effect_ == Effect::rebuild) {
      // The positions of its objects determine the origin of a scene that is far from the camera, or that is instanced.
      everything |= !job.origin_is_near_camera();
      for (const auto& [part, effect] : parts_) {
        const auto* scene = dynamic_cast<const Scene*>(part);
        everything |= scene && effect == Effect::rebuild && scene->chooses_origin();
      }
    }
    if (everything) return prepare_tree(job);
    for (const auto& [object, outer] : moved_) object->transform.set_origins(outer, {});
    if (job.camera) job.camera->rendering_origin = job.rendering_origin();
  }
  prepare_parts(job, before);
  if (effect_ == Effect::rebuild && job.rendering_origin_is_stale()) prepare_tree(job);
}

/// Prepares parts before their holders. Uses an explicit stack, as prepare_tree does: chains of components may be long.
void Consequences::prepare_parts(Job& job, const Holders& before) const {
  struct Visit {
    Component* part;
    std::vector<Component*> rest;
  };
  std::unordered_set<const Component*> seen;
  std::vector<Visit> way;
  const auto visit = [&](Component& part) {
    const bool fresh = !before.knows(part);
    if ((!fresh && !parts_.contains(&part)) || !seen.insert(&part).second) return;
    Visit& next = way.emplace_back(Visit{&part, {}});
    for (const Member& member : part.class_info().members)
      if (member.kind == Kind::component)
        for_components(member.get(part, member), [&](Component& c) { next.rest.push_back(&c); });
  };
  visit(job);
  while (!way.empty()) {
    if (std::vector<Component*>& rest = way.back().rest; !rest.empty()) {
      Component* next = rest.back();
      rest.pop_back();
      visit(*next);
      continue;
    }
    Component& part = *way.back().part;
    way.pop_back();
    const auto concerned = parts_.find(&part);
    const Effect effect = concerned == parts_.end() ? Effect::rebuild : concerned->second;
    try {
      if (&part == &job) {
        if (effect >= Effect::rerender) job.prepare_again();
      } else if (effect == Effect::rerender) {
        part.prepare_again();
      } else {
        part.prepare();
      }
    } catch (...) {
      blame(part, "preparing");
    }
  }
}

}  // namespace etendue
