#include "merge.h"

#include <unordered_set>

#include "etendue/describe/registry.h"

namespace etendue::studio {

namespace {

using Parts = std::vector<Component*>;

/// The components in a member's value, in order; null for empty entries of a list.
Parts parts_in(const Value& value) {
  Parts parts;
  if (const auto* one = value.as<Ref<Component>>()) {
    parts.push_back(one->get());
  } else if (const auto* list = value.as<Value::List>()) {
    for (const Value& item : *list) {
      const auto* part = item.as<Ref<Component>>();
      parts.push_back(part ? part->get() : nullptr);
    }
  }
  return parts;
}

class Matcher {
 public:
  Matcher(Pairs& pairs, const std::function<Component*(const Component&)>& counterpart)
      : pairs_(pairs), counterpart_(counterpart) {}

  void match(Component& old, Component& now) {
    pair(old, now);
    // Components with a known location are paired first, in the whole job; otherwise components that only look similar might
    // take their partners.
    for (const Ref<Component>& part : components_of(static_cast<const Job&>(now)))
      if (Component* was = counterpart_(*part)) pair(*was, *part);
    std::vector<std::pair<Component*, Component*>> rest{{&old, &now}};
    std::unordered_set<const Component*> seen;
    while (!rest.empty()) {
      const auto [was, is] = rest.back();
      rest.pop_back();
      if (!seen.insert(is).second) continue;
      for (const Member& member : is->class_info().members) {
        if (member.kind != Kind::component) continue;
        const Parts before = parts_in(member.get(*was, member)), after = parts_in(member.get(*is, member));
        for (size_t i = 0; i < after.size(); ++i) {
          if (after[i] && i < before.size() && before[i]) pair(*before[i], *after[i]);
        }
        for (Component* part : after)
          if (const auto found = pairs_.find(part); part && found != pairs_.end()) rest.emplace_back(found->second, part);
      }
    }
  }

 private:
  void pair(Component& old, Component& now) {
    if (&old.class_info() != &now.class_info() || taken_.contains(&old) || pairs_.contains(&now)) return;
    taken_.insert(&old);
    pairs_.emplace(&now, &old);
  }

  Pairs& pairs_;
  const std::function<Component*(const Component&)>& counterpart_;
  std::unordered_set<const Component*> taken_;
};

/// The value with new components replaced by the old ones they are paired with.
Value with_old_parts(const Value& value, const Merge& merge, bool& any) {
  Value result = value;
  const auto replace = [&](Ref<Component>& part) {
    const auto found = merge.old_of.find(part.get());
    if (!part || found == merge.old_of.end()) return;
    part = Ref<Component>(found->second);
    any = true;
  };
  if (auto* one = std::get_if<Ref<Component>>(&result.data)) {
    replace(*one);
  } else if (auto* list = std::get_if<Value::List>(&result.data)) {
    for (Value& item : *list)
      if (auto* part = std::get_if<Ref<Component>>(&item.data)) replace(*part);
  }
  return result;
}

}  // namespace

std::vector<Ref<Component>> components_of(const Job& job) {
  std::vector<Ref<Component>> all;
  std::unordered_set<const Component*> seen;
  std::vector<Component*> rest{const_cast<Job*>(&job)};  // components are const only through the job
  while (!rest.empty()) {
    Component& c = *rest.back();
    rest.pop_back();
    if (!seen.insert(&c).second) continue;
    all.emplace_back(&c);
    Parts below;
    for (const Member& member : c.class_info().members)
      if (member.kind == Kind::component)
        for (Component* part : parts_in(member.get(c, member)))
          if (part) below.push_back(part);
    rest.insert(rest.end(), below.rbegin(), below.rend());
  }
  return all;
}

Pairs pairs_of(const Job& old, Job& now, const std::function<Component*(const Component&)>& counterpart) {
  Pairs pairs;
  Matcher(pairs, counterpart).match(const_cast<Job&>(old), now);
  return pairs;
}

Merge merge(const Job& old, Job& now, const std::function<Component*(const Component&)>& counterpart) {
  Merge merge;
  merge.old_of = pairs_of(old, now, counterpart);
  merge.parts = components_of(now);
  for (const Ref<Component>& part : merge.parts) {
    const auto found = merge.old_of.find(part.get());
    Component* was = found == merge.old_of.end() ? nullptr : found->second;
    if (!was) merge.fresh.push_back(part), merge.structure = true;
    for (const Member& member : part->class_info().members) {
      const Value value = member.get(*part, member);
      if (member.kind != Kind::component) {
        if (was && !equal(member.get(*was, member), value))
          merge.edits.push_back({Ref<const Component>(was), member.name, value});
        continue;
      }
      bool any = false;
      const Value linked = with_old_parts(value, merge, any);
      if (was && parts_in(member.get(*was, member)) != parts_in(linked)) {
        merge.edits.push_back({Ref<const Component>(was), member.name, linked});
        merge.structure = true;
      } else if (!was && any) {
        set(*part, member.name, linked);
      }
    }
  }
  return merge;
}

}  // namespace etendue::studio
