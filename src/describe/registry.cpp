#include "etendue/describe/registry.h"

#include <cxxabi.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <unordered_map>

#include "etendue/describe/description.h"
#include "faults.h"
#include "files/format_library.h"
#include "files/input_files.h"
#include "files/shading_library.h"
#include "guard.h"
#include "plugin.h"
#include "words.h"

namespace etendue {

namespace {
// Constant-initialized to null before any constructor runs, so that nodes can enlist in any order.
constinit RegistrationNode* pending = nullptr;
}  // namespace

void enlist(RegistrationNode& node) noexcept {
  node.next = pending;
  pending = &node;
}

RegistrationNode* take_pending() { return std::exchange(pending, nullptr); }

std::string detail::bare_class_name(const std::type_info& type) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> text(abi::__cxa_demangle(type.name(), nullptr, nullptr, &status), std::free);
  std::string full = status == 0 ? text.get() : type.name();
  const size_t last = full.rfind("::");
  return last == std::string::npos ? full : full.substr(last + 2);
}

std::string_view name(Effect e) {
  constexpr std::array<std::string_view, 4> names = {"none", "retone", "rerender", "rebuild"};
  return names[size_t(e)];
}

std::string_view name(Kind k) {
  constexpr std::array<std::string_view, 13> names = {"boolean", "integer",   "number",   "string", "file",
                                                      "choice",  "vector2",   "vector3",  "point3", "normal3",
                                                      "color",   "transform", "component"};
  return names[size_t(k)];
}

std::string_view name(Meaning m) {
  constexpr std::array<std::string_view, 6> names = {"plain", "number", "reflectance", "radiance", "coefficient", "index"};
  return names[size_t(m)];
}

std::string Range::text() const {
  const bool has_low = std::isfinite(low), has_high = std::isfinite(high);
  if (has_low && has_high)
    return open_low ? fmt::format("more than {:.12g} and at most {:.12g}", low, high)
                    : fmt::format("from {:.12g} to {:.12g}", low, high);
  if (has_low) return (open_low ? "more than " : "at least ") + fmt::format("{:.12g}", low);
  if (has_high) return fmt::format("at most {:.12g}", high);
  return "any number";
}

bool ClassInfo::is_a(const ClassInfo& ancestor) const {
  for (const ClassInfo* c = this; c; c = c->parent)
    if (c == &ancestor) return true;
  return false;
}

const Member* ClassInfo::find(std::string_view member) const {
  for (const Member& m : members)
    if (m.name == member) return &m;
  return nullptr;
}

struct Registry::State {
  std::recursive_mutex mutex;
  std::map<std::string, std::unique_ptr<ClassInfo>, std::less<>> by_name;
  std::unordered_map<std::type_index, const ClassInfo*> by_type;
  std::map<std::string, void*> plugins;
  std::map<std::string, std::string> refused;  // rejected plugins and why: reopened, they would not enlist again
  std::string provider;                        // of the classes being adopted
  std::map<std::string, std::function<void(const std::string&)>> readers;  // of plugins, by the ending of their files
  std::vector<std::unique_ptr<ClassInfo>> replaced;  // declarations that were replaced or refused: objects may have them

  /// The function that reads such a plugin; empty: it is a library.
  std::function<void(const std::string&)> reader_of(const std::string& file) {
    const std::lock_guard lock(mutex);
    for (const auto& [ending, read] : readers)
      if (file.ends_with(ending)) return read;
    return nullptr;
  }

  /// The loaded classes that can be created by name, and their bases: not those that are bases in tests only.
  std::vector<const ClassInfo*> creatable() const {
    std::set<const ClassInfo*> wanted;
    for (const auto& [name, info] : by_name)
      for (const ClassInfo* at = info->abstract() ? nullptr : info.get(); at; at = at->parent) wanted.insert(at);
    std::vector<const ClassInfo*> list;
    for (const auto& [name, info] : by_name)
      if (wanted.contains(info.get())) list.push_back(info.get());
    return list;
  }
};

Registry::Registry() : state_(new State) {}

Registry& Registry::instance() {
  static Registry* registry = new Registry;  // never destroyed: components of plugins may outlive main
  return *registry;
}

namespace {

/// Takes defaults from default-constructed objects, which may contain objects of other new classes. Returns the faults found.
std::string note_defaults(const std::vector<ClassInfo*>& added) {
  std::string faults;
  for (ClassInfo* info : added) {
    if (info->abstract()) continue;
    try {
      const Ref<Component> object = etendue::create(*info);
      for (Member& m : info->members) {
        m.default_value = m.get(*object, m);
        if (m.required) continue;
        try {
          const Ref<Component> scratch = etendue::create(*info);
          if (m.kind != Kind::component) m.store(*scratch, m, m.default_value);
        } catch (const Error& e) {
          faults += fmt::format("\n  {}.{}: its default is not allowed: {}", info->name, m.name, e.what());
        }
      }
    } catch (...) {
      faults += fmt::format("\n  {}", thrown_text());
    }
  }
  return faults;
}

}  // namespace

void Registry::adopt() {
  const std::lock_guard lock(state_->mutex);
  const std::lock_guard libraries(libraries_guard());  // all classes of a library, or none
  if (!pending) return;
  std::unordered_map<std::type_index, RegistrationNode*> waiting;
  std::vector<ClassInfo*> added;
  std::string faults;
  const auto defined_twice = [&](const std::string& name, const std::string& first_provider) {
    const auto where = [](const std::string& provider) {
      return provider.empty() ? std::string("this program") : "'" + provider + "'";
    };
    faults += first_provider == state_->provider
                  ? fmt::format("\n  {}: {} defines this class twice", name, where(state_->provider))
                  : fmt::format("\n  {}: there already is a class of this name: both {} and {} define it", name,
                                where(first_provider), where(state_->provider));
  };
  for (RegistrationNode* n = take_pending(); n; n = n->next) {
    if (const auto known = state_->by_type.find(n->type); known != state_->by_type.end())
      defined_twice(known->second->name, known->second->provider);
    else if (!waiting.try_emplace(n->type, n).second)
      defined_twice(detail::bare_class_name(n->type), state_->provider);
  }

  // Parents come before children: a class starts with its parent's members.
  const std::function<const ClassInfo*(const std::type_info&)> take = [&](const std::type_info& type) -> const ClassInfo* {
    if (const auto known = state_->by_type.find(type); known != state_->by_type.end()) return known->second;
    const auto node = waiting.find(type);
    if (node == waiting.end()) return nullptr;
    auto info = std::make_unique<ClassInfo>();
    info->name = detail::bare_class_name(type);
    info->type = type;
    info->provider = state_->provider;
    info->make = node->second->make;
    if (node->second->parent != typeid(void)) {
      info->parent = take(node->second->parent);
      if (info->parent) {
        info->members = info->parent->members;
        info->absent = info->parent->absent;
      } else if (node->second->parent != typeid(Component)) {
        faults += fmt::format("\n  {}: its parent class {} is not registered", info->name,
                              detail::bare_class_name(node->second->parent));
      }
    }
    try {
      node->second->describe(*info);
    } catch (...) {
      faults += fmt::format("\n  {}: describe() failed: {}", info->name, thrown_text());
      return nullptr;
    }
    if (const std::string wrong = fault(*info); !wrong.empty()) faults += "\n  " + info->name + ": " + wrong;
    ClassInfo* raw = info.get();
    if (!state_->by_name.try_emplace(info->name, std::move(info)).second) {
      defined_twice(detail::bare_class_name(type), state_->by_name.find(detail::bare_class_name(type))->second->provider);
      return nullptr;
    }
    state_->by_type[type] = raw;
    added.push_back(raw);
    return raw;
  };
  for (const auto& [type, node] : waiting) take(node->type);

  if (faults.empty()) faults = note_defaults(added);
  if (faults.empty()) return;
  for (const ClassInfo* info : added) {
    state_->by_type.erase(info->type);
    state_->by_name.erase(info->name);
  }
  throw Error("classes that cannot be used:" + faults);
}

const ClassInfo* Registry::find(std::string_view name) const {
  const_cast<Registry*>(this)->adopt();
  const std::lock_guard lock(state_->mutex);
  auto found = state_->by_name.find(name);
  // Names of classes begin with a capital; the parser looks up every other name of a scene, too.
  const bool capital = !name.empty() && name[0] >= 'A' && name[0] <= 'Z';
  bool more = false;
  try {
    more = found == state_->by_name.end() && capital && load_format_library();
  } catch (const Error&) {
    // The library is missing. Where the name resembles a known class the caller suggests that one; otherwise the Error goes on.
    (void)meant_class(std::string(name));
  }
  // Networks of shaders are written without a plugin.
  if (found == state_->by_name.end() && name.starts_with("OslGroup")) {
    load_shading_library();
    more = true;
  }
  if (more) {
    const_cast<Registry*>(this)->adopt();
    found = state_->by_name.find(name);
  }
  return found == state_->by_name.end() ? nullptr : found->second.get();
}

const ClassInfo* Registry::find(std::type_index type) const {
  const_cast<Registry*>(this)->adopt();
  const std::lock_guard lock(state_->mutex);
  const auto found = state_->by_type.find(type);
  return found == state_->by_type.end() ? nullptr : found->second;
}

std::vector<const ClassInfo*> Registry::all() const {
  const std::lock_guard lock(state_->mutex);
  load_format_library();
  try {
    load_shading_library();
  } catch (const Error&) {
    // An installation without the library has no such classes; whoever names one hears the reason.
  }
  const_cast<Registry*>(this)->adopt();
  return state_->creatable();
}

std::vector<const ClassInfo*> Registry::loaded() const {
  const std::lock_guard lock(state_->mutex);
  const_cast<Registry*>(this)->adopt();
  return state_->creatable();
}

std::vector<const ClassInfo*> Registry::subclasses(const ClassInfo& of) const {
  const_cast<Registry*>(this)->adopt();
  const std::lock_guard lock(state_->mutex);
  std::vector<const ClassInfo*> list = state_->creatable();
  const auto unrelated = [&](const ClassInfo* c) { return c->abstract() || !c->is_a(of); };
  std::erase_if(list, unrelated);
  if (!list.empty() || !load_format_library()) return list;
  const_cast<Registry*>(this)->adopt();  // none of the interface's classes was loaded
  list = state_->creatable();
  std::erase_if(list, unrelated);
  return list;
}

Ref<Component> Registry::create(std::string_view name) const {
  const ClassInfo* info = find(name);
  std::vector<std::string> known;
  if (info && info->abstract())
    for (const ClassInfo* c : subclasses(*info)) known.push_back(c->name);
  if (!info) throw Error(fmt::format("there is no class '{}'{}", name, meant_class(std::string(name))));
  if (info->abstract())
    throw Error(fmt::format("'{}' is an interface; write one of its classes: {}", name, fmt::join(known, ", ")));
  return etendue::create(*info);
}

const ClassInfo& Registry::declare(std::unique_ptr<ClassInfo> info) {
  all();  // loads all classes, so that a declaration of a compiled name is refused here
  if (!info->parent) throw Error(info->name + ": a class that is declared needs a parent class");
  if (info->name.empty() || info->name[0] < 'A' || info->name[0] > 'Z')
    throw Error(fmt::format("'{}': the name of a class begins with a capital letter", info->name));
  if (const std::string wrong = fault(*info); !wrong.empty()) throw Error(info->name + ": " + wrong);
  // Without the lock: a script that makes the object may wait for another thread that waits for the registry.
  const std::string faults = note_defaults({info.get()});
  const std::lock_guard lock(state_->mutex);
  std::unique_ptr<ClassInfo>& place = state_->by_name[info->name];
  const bool taken = place && !place->declared;
  const std::string name = info->name;
  // A class that is refused is kept as well: the objects that were made for its defaults may still exist.
  if (!faults.empty() || taken) {
    state_->replaced.push_back(std::move(info));
    if (!place) state_->by_name.erase(name);
    throw Error(taken ? name + ": there already is a class of this name" : name + " cannot be used:" + faults);
  }
  if (place) state_->replaced.push_back(std::move(place));
  place = std::move(info);
  return *place;
}

void Registry::read_plugins(const std::string& ending, std::function<void(const std::string&)> read) {
  const std::lock_guard lock(state_->mutex);
  state_->readers[ending] = std::move(read);
}

std::vector<std::string> Registry::plugins() const {
  const std::lock_guard lock(state_->mutex);
  std::vector<std::string> list;
  for (const auto& [path, handle] : state_->plugins) list.push_back(path);
  return list;
}

void Registry::load_plugin(const std::string& path) {
  {
    // First, so that a plugin that defines a class of that library again is refused here, and for that reason.
    const std::lock_guard lock(state_->mutex);
    load_format_library();
    adopt();
  }
  const std::string file = find_plugin(path);
  note_input(file);
  // A shader's file, or a document of such, may have changed since: its reader compares.
  static constexpr std::array endings = {".osl", ".mtlx", ".usd", ".usda", ".usdc", ".usdz"};
  const bool shading = std::ranges::any_of(endings, [&](const char* ending) { return file.ends_with(ending); });
  {
    const std::lock_guard lock(state_->mutex);
    if (state_->plugins.contains(file) && !shading) return;
    if (const auto known = state_->refused.find(file); known != state_->refused.end()) throw Error(known->second);
  }
  const auto named = [&] { return Error("plugin '" + file + "': " + thrown_text()); };
  if (shading) {
    try {
      const std::lock_guard lock(state_->mutex);  // before the library's own, as elsewhere
      load_shading_library();
    } catch (const Error& e) {
      throw Error("plugin '" + file + "': " + e.what());
    }
  }
  if (const auto read = state_->reader_of(file)) {
    try {
      read(file);
    } catch (const Error& e) {
      throw Error("plugin '" + file + "': " + e.what(), e.location);
    } catch (...) {
      throw named();
    }
    const std::lock_guard lock(state_->mutex);
    state_->plugins[file] = nullptr;
    return;
  }
  if (file.ends_with(".py"))
    throw Error("plugin '" + file +
                "' is written in Python, and only Python can read it: etendue.load_plugin, or `plugin` in a description that "
                "etendue.load reads");
  try {
    // Without the lock, since the child process could not lock it again.
    check_plugin(file, [&] {
      state_->provider = file;
      adopt();
    });
  } catch (...) {
    throw named();
  }
  const std::lock_guard lock(state_->mutex);
  state_->provider = file;
  try {
    state_->plugins[file] = open_plugin(file);  // its static nodes enlist themselves; their functions are not called yet
    adopt();
    state_->provider.clear();
  } catch (...) {
    state_->provider.clear();
    state_->plugins.erase(file);
    take_pending();
    const Error reason = named();
    state_->refused[file] = reason.what();
    throw reason;
  }
}

Value get(const Component& c, std::string_view member) {
  const ClassInfo& info = c.class_info();
  const Member* m = info.find(member);
  if (!m) throw Error(no_member(info, std::string(member)));
  return m->get(c, *m);
}

void set(Component& c, std::string_view member, const Value& value) {
  const ClassInfo& info = c.class_info();
  const Member* m = info.find(member);
  if (!m) throw Error(no_member(info, std::string(member)), value.location);
  try {
    m->store(c, *m, value);
  } catch (const Error& e) {
    throw Error(fmt::format("{}.{} {}", info.name, member, e.what()), e.location.known() ? e.location : value.location);
  }
}

namespace {

using Copies = std::unordered_map<const Component*, Ref<Component>>;

Ref<Component> copy_once(const Component& c, Copies& made);

Value copy_value(const Value& v, Copies& made) {
  Value out = v;
  if (const auto* c = v.as<Ref<Component>>()) {
    if (*c) out.data = copy_once(**c, made);
  } else if (const auto* list = v.as<Value::List>()) {
    Value::List copies;
    for (const Value& item : *list) copies.push_back(copy_value(item, made));
    out.data = std::move(copies);
  }
  return out;
}

Ref<Component> copy_once(const Component& c, Copies& made) {
  if (const auto known = made.find(&c); known != made.end()) return known->second;
  const ClassInfo& info = c.class_info();
  Ref<Component> out = create(info);
  made[&c] = out;
  for (const Member& m : info.members) m.store(*out, m, copy_value(m.get(c, m), made));
  if (c.origin) out->origin = std::make_unique<Component::Origin>(*c.origin);
  return out;
}

}  // namespace

Ref<Component> copy(const Component& c) {
  Copies made;
  return copy_once(c, made);
}

}  // namespace etendue
