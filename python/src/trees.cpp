#include "trees.h"

#include <fmt/format.h>

#include <unordered_map>
#include <unordered_set>

#include "describe/expansion.h"
#include "language/evaluator.h"

namespace etendue::python {

namespace {

void add_parts(const Value& v, std::vector<const Component*>& to) {
  if (const auto* c = v.as<Ref<Component>>()) {
    if (*c) to.push_back(c->get());
  } else if (const auto* list = v.as<Value::List>()) {
    for (const Value& item : *list) add_parts(item, to);
  }
}

}  // namespace

void refuse_cycle(const Component& self, const Value& old, const Value& given) {
  std::vector<const Component*> left, known;
  add_parts(given, left);
  if (left.empty()) return;
  add_parts(old, known);
  std::unordered_set<const Component*> seen(known.begin(), known.end());
  while (!left.empty()) {
    const Component* const c = left.back();
    left.pop_back();
    if (c == &self) throw Error(self.class_info().name + " would be a part of itself", given.location);
    if (!seen.insert(c).second) continue;
    for (const Component* part : components_of(*c)) left.push_back(part);
  }
}

void require_shallow(const Component& root) {
  constexpr int deepest = language::Evaluator::height_limit;
  struct Step {
    const Component* component;
    std::vector<Component*> rest;
    int height = 0;
  };
  std::unordered_map<const Component*, int> heights;
  std::vector<Step> way{{&root, components_of(root)}};
  while (!way.empty()) {
    Step& step = way.back();
    if (int(way.size()) + step.height > deepest)
      throw Error(fmt::format("parts are nested more than {} deep", deepest), root.location_of());
    if (step.rest.empty()) {
      const int height = step.height + 1;
      heights[step.component] = height;
      way.pop_back();
      if (!way.empty()) way.back().height = std::max(way.back().height, height);
      continue;
    }
    const Component* const next = step.rest.back();
    step.rest.pop_back();
    if (const auto known = heights.find(next); known != heights.end())
      step.height = std::max(step.height, known->second);
    else
      way.push_back({next, components_of(*next)});
  }
}

void release_tree(Ref<Component> root) {
  if (!root || root->references() > 1) return;
  // With a reference to each part in this list, none is destroyed from within the destructor of another one.
  std::vector<Ref<Component>> all;
  std::unordered_set<const Component*> seen{root.get()};
  all.push_back(std::move(root));
  for (size_t i = 0; i < all.size(); ++i)
    for (Component* const part : components_of(*all[i]))
      if (part->references() == 1 && seen.insert(part).second) all.emplace_back(part);
  for (Ref<Component>& c : all) c = nullptr;
}

}  // namespace etendue::python
