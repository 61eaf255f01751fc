#include "expansion.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_set>

#include "etendue/describe/registry.h"

namespace etendue {

namespace {

void components_in(const Value& value, std::vector<Component*>& out) {
  if (const auto* c = value.as<Ref<Component>>()) {
    if (*c) out.push_back(c->get());
  } else if (const auto* list = value.as<Value::List>()) {
    for (const Value& item : *list) components_in(item, out);
  }
}

bool is_a(const Component& c, std::string_view interface) {
  for (const ClassInfo* info = &c.class_info(); info; info = info->parent)
    if (info->name == interface) return true;
  return false;
}

/// All components reachable from one, itself included, each once, and before the components that refer to it.
template <class Below>
std::vector<const Component*> in_order(const Component& top, Below below) {
  struct Step {
    const Component* component;
    std::vector<Component*> rest;
  };
  std::unordered_set<const Component*> seen = {&top};
  std::vector<Step> way = {{&top, below(top)}};
  std::vector<const Component*> order;
  while (!way.empty()) {
    Step& step = way.back();
    if (step.rest.empty()) {
      order.push_back(step.component);
      way.pop_back();
      continue;
    }
    const Component* next = step.rest.back();
    step.rest.pop_back();
    if (seen.insert(next).second) way.push_back({next, below(*next)});
  }
  return order;
}

std::string called(const Component& c) {
  if (c.origin && !c.origin->name.empty()) return "'" + c.origin->name + "'";
  const Location at = c.location_of();
  return "the " + c.class_info().name + (at.line > 0 ? fmt::format(" of line {}", at.line) : "");
}

}  // namespace

std::vector<Component*> components_of(const Component& c) {
  std::vector<Component*> found;
  for (const Member& m : c.class_info().members)
    if (m.kind == Kind::component) components_in(m.get(c, m), found);
  std::reverse(found.begin(), found.end());
  return found;
}

std::vector<Component*> Expansion::asked(const Component& c) {
  if (is_a(c, "Scene") || is_a(c, "Job")) return {};
  std::vector<Component*> parts = components_of(c);
  if (is_a(c, "SceneObject")) std::erase_if(parts, [](const Component* part) { return !is_a(*part, "SceneObject"); });
  return parts;
}

void Expansion::check(const Component& c) {
  const std::vector<Component*> parts = asked(c);
  double count = 1;
  for (const Component* part : parts) count += parts_.at(part);
  parts_[&c] = count;
  if (count <= most || parts.size() < 2) return;
  // A component with little more parts than an accepted part of it is accepted, too, so that a long chain is not traversed
  // again for each of its links.
  double right = 0;
  for (const Component* part : parts)
    if (const auto found = right_.find(part); found != right_.end()) right = std::max(right, found->second);
  if (count > 1.1 * right) {
    // A factor of two is allowed: a written component may well be used in two places.
    const size_t written = in_order(c, asked).size();
    if (count > 2 * double(written)) fail(c, count, written);
    right = count;
  }
  right_[&c] = right;
}

void Expansion::fail(const Component& c, double parts, size_t written) const {
  std::vector<const Component*> order = in_order(c, asked);
  std::unordered_map<const Component*, double> places = {{&c, 1}};
  // Prefers components with a name: unnamed defaults of members were not written by the user.
  const Component* most_used = nullptr;
  const auto named = [](const Component* part) { return part->origin && !part->origin->name.empty(); };
  for (auto user = order.rbegin(); user != order.rend(); ++user)
    for (const Component* part : asked(**user)) places[part] += places[*user];
  for (const Component* part : order)
    if (part != &c && (!most_used || std::pair(named(part), places[part]) > std::pair(named(most_used), places[most_used])))
      most_used = part;
  throw Error(fmt::format("{} evaluates {:.0f} components at every hit, as {} is used in {:.0f} places in it; there are only "
                          "{} different ones, and {:.0f} evaluations are the most that shared components may cause",
                          called(c), parts, called(*most_used), places[most_used], written, most),
              c.location_of());
}

}  // namespace etendue
