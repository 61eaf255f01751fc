#include "etendue/describe/component.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstdio>
#include <mutex>
#include <set>
#include <unordered_set>

#include "etendue/describe/read_ahead.h"
#include "etendue/describe/registry.h"
#include "expansion.h"
#include "guard.h"

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

/// Lets all components that read files do so in parallel; the rest of the preparation is sequential.
void read_ahead(Component& root) {
  std::unordered_set<const Component*> seen{&root};
  std::vector<Component*> left{&root};
  std::vector<ReadsAhead*> readers;
  while (!left.empty()) {
    Component* const c = left.back();
    left.pop_back();
    if (auto* const reader = dynamic_cast<ReadsAhead*>(c)) readers.push_back(reader);
    for (Component* const part : components_of(*c))
      if (seen.insert(part).second) left.push_back(part);
  }
  if (readers.size() < 2) return;
  tbb::parallel_for(size_t(0), readers.size(), [&](size_t i) {
    // While a component waits for its own tasks, the thread must not begin to read another file, which might be the same one.
    tbb::this_task_arena::isolate([&] {
      try {
        readers[i]->read_ahead();
      } catch (...) {  // `prepare` reports the error
      }
    });
  });
}

}  // namespace

void prepare_tree(Component& root) {
  // Depth-first search with an explicit stack, so that long chains need no deep recursion.
  struct Visit {
    Component* component;
    std::vector<Component*> rest;
  };
  std::unordered_set<const Component*> seen;
  std::vector<Visit> way;
  Expansion expansion;
  const auto visit = [&](Component& c) {
    if (seen.insert(&c).second) way.push_back({&c, components_of(c)});
  };
  root.before_prepare();
  read_ahead(root);
  visit(root);
  while (!way.empty()) {
    Visit& last = way.back();
    if (!last.rest.empty()) {
      Component* next = last.rest.back();
      last.rest.pop_back();
      visit(*next);
      continue;
    }
    Component& c = *last.component;
    way.pop_back();
    expansion.check(c);
    try {
      c.prepare();
    } catch (...) {
      // Helpers without access to the component throw without a location; the component's own location is used then.
      blame(c, "preparing");
    }
  }
}

namespace {
std::mutex warnings_mutex;
std::function<void(const std::string&, Location)> warning_handler;
}  // namespace

void handle_warnings(std::function<void(const std::string&, Location)> handle) {
  const std::lock_guard lock(warnings_mutex);
  warning_handler = std::move(handle);
}

void warn(const std::string& message, Location at) {
  static std::set<std::string> said;
  std::unique_lock lock(warnings_mutex);
  if (const auto handle = warning_handler) {
    lock.unlock();
    handle(message, at);
    return;
  }
  std::string text = at.known() ? std::string(at.file) + ":" : "";
  if (at.line > 0) text += std::to_string(at.line) + ":" + std::to_string(at.column) + ":";
  if (!text.empty()) text += " ";
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

/// The number of insertions, deletions, replacements and transpositions of neighbours that turn a into b.
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

std::string small_letters(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

std::string suggestion(const std::string& given, const std::vector<std::string>& known) {
  if (given.size() > 100) return {};
  const std::string* best = nullptr;
  const size_t most = std::max<size_t>(1, given.size() / 3);
  size_t best_rank = 1000;
  for (const std::string& name : known) {
    if (name.size() > 100) continue;
    const size_t distance = edit_distance(given, name);
    size_t rank = distance <= most ? distance : 1000;
    // Otherwise accepts a prefix, as "Path" of "PathTracer", a part, as "depth" of "max_depth", or the reverse.
    const std::string a = small_letters(name), b = small_letters(given);
    const std::string &longer = a.size() > b.size() ? a : b, &shorter = a.size() > b.size() ? b : a;
    if (shorter.size() >= 3 && longer.starts_with(shorter)) rank = std::min<size_t>(rank, 2);
    if (shorter.size() >= 4 && longer.find(shorter) != std::string::npos) rank = std::min<size_t>(rank, 100);
    if (rank < best_rank) best_rank = rank, best = &name;
  }
  return best ? " (did you mean '" + *best + "'?)" : std::string();
}

}  // namespace etendue
