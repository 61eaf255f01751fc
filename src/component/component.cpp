#include "etendue/component.h"

#include <cstdio>
#include <mutex>
#include <set>
#include <unordered_set>

#include "component/guard.h"
#include "etendue/registry.h"

namespace etendue {

Component::~Component() = default;

const ClassInfo& Component::class_info() const {
  const ClassInfo* info = Registry::instance().find(std::type_index(typeid(*this)));
  if (!info) throw Error(std::string("a component of an unregistered class (") + typeid(*this).name() + ")");
  return *info;
}

Location Component::location_of(std::string_view member) const {
  if (!origin) return {};
  for (const auto& [name, place] : origin->members)
    if (name == member) return place;
  return origin->location;
}

void Component::fail(std::string_view member, const std::string& message) const {
  std::string who = class_info().name;
  if (!member.empty()) who += "." + std::string(member);
  throw Error(who + ": " + message, location_of(member));
}

namespace {

void components_in(const Value& value, std::vector<Component*>& out) {
  if (const auto* c = value.as<Ref<Component>>()) {
    if (*c) out.push_back(c->get());
  } else if (const auto* list = value.as<Value::List>()) {
    for (const Value& item : *list) components_in(item, out);
  }
}

void prepare_once(Component& c, std::unordered_set<const Component*>& done) {
  if (!done.insert(&c).second) return;
  for (const Member& m : c.class_info().members) {
    if (m.kind != Kind::component) continue;
    std::vector<Component*> children;
    components_in(m.get(c, m), children);
    for (Component* child : children) prepare_once(*child, done);
  }
  try {
    c.prepare();
  } catch (...) {
    // Helpers that know nothing of components throw without a place; the component's own is the nearest.
    blame(c, "preparing");
  }
}

}  // namespace

void prepare_tree(Component& root) {
  std::unordered_set<const Component*> done;
  prepare_once(root, done);
}

void warn(const std::string& message, Location at) {
  static std::mutex mutex;
  static std::set<std::string> said;
  const std::lock_guard lock(mutex);
  std::string text =
      at.known() ? std::string(at.file) + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " : "";
  text += "warning: " + message + "\n";
  if (said.insert(text).second) std::fputs(text.c_str(), stderr);
}

const char* intern(const std::string& text) {
  static std::mutex mutex;
  static auto* all = new std::set<std::string>;  // never destroyed: locations outlive everything
  const std::lock_guard lock(mutex);
  return all->insert(text).first->c_str();
}

namespace {

/// Insertions, deletions, replacements and exchanges of neighbours that turn a into b.
size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (size_t i = 1; i <= a.size(); ++i)
    for (size_t j = 1; j <= b.size(); ++j) {
      const bool same = std::tolower(a[i - 1]) == std::tolower(b[j - 1]);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + !same});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string suggestion(const std::string& given, const std::vector<std::string>& known) {
  if (given.size() > 100) return {};
  const std::string* best = nullptr;
  size_t best_distance = std::max<size_t>(1, given.size() / 3) + 1;
  for (const std::string& name : known) {
    if (name.size() > 100) continue;
    size_t distance = edit_distance(given, name);
    // "Path" for "PathTracer": a beginning is as good as two slips.
    if (given.size() >= 3 && name.size() > given.size() && name.compare(0, given.size(), given) == 0)
      distance = std::min<size_t>(distance, 2);
    if (distance < best_distance) best_distance = distance, best = &name;
  }
  return best ? " (did you mean '" + *best + "'?)" : std::string();
}

}  // namespace etendue
