#include "guard.h"

#include <cxxabi.h>
#include <fmt/format.h>

#include <cstdlib>
#include <memory>
#include <new>
#include <set>

namespace etendue {

std::string thrown_text() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return "there is not enough memory";
  } catch (const std::exception& e) {
    return e.what();
  } catch (...) {
    const std::type_info* type = abi::__cxa_current_exception_type();
    if (!type) return "an exception of no known type";
    int status = 0;
    const std::unique_ptr<char, void (*)(void*)> name(abi::__cxa_demangle(type->name(), nullptr, nullptr, &status), std::free);
    return fmt::format("an exception of type {}", status == 0 ? name.get() : type->name());
  }
}

std::vector<Error> thrown_errors() {
  try {
    throw;
  } catch (const Errors& several) {
    return several.errors;
  } catch (const Error& error) {
    return {error};
  } catch (...) {
    return {Error(thrown_text())};
  }
}

std::string name_with_plugin(const ClassInfo& info) {
  return info.provider.empty() ? info.name : fmt::format("{} (of plugin '{}')", info.name, info.provider);
}

Ref<Component> create(const ClassInfo& info) {
  try {
    return info.create();
  } catch (const Error& e) {
    if (info.provider.empty()) throw;
    throw Error(fmt::format("{}: its constructor failed: {}", name_with_plugin(info), e.what()), e.location);
  } catch (...) {
    throw Error(fmt::format("{}: its constructor failed: {}", name_with_plugin(info), thrown_text()));
  }
}

namespace {

/// Collects the plugin classes of a component and of all components it refers to.
class Suspects {
 public:
  void visit(const Component& c) {
    if (!visited_.insert(&c).second) return;
    const ClassInfo& info = c.class_info();
    if (!info.provider.empty()) names.insert(name_with_plugin(info));
    for (const Member& m : info.members)
      if (m.kind == Kind::component) visit(m.get(c, m));
  }
  std::set<std::string> names;

 private:
  void visit(const Value& value) {
    if (const auto* c = value.as<Ref<Component>>()) {
      if (*c) visit(**c);
    } else if (const auto* list = value.as<Value::List>()) {
      for (const Value& item : *list) visit(item);
    }
  }
  std::set<const Component*> visited_;
};

std::set<std::string> suspects(const Component& c) {
  Suspects found;
  if (!c.class_info().provider.empty()) return {name_with_plugin(c.class_info())};
  found.visit(c);
  return found.names;
}

/// The files named by a component's own members, as text for messages.
std::string files_of(const Component& c) {
  std::string names;
  const auto add = [&](const Value& value) {
    if (const auto* file = value.as<FilePath>(); file && !file->empty())
      names += fmt::format("{}'{}'", names.empty() ? "" : ", ", file->resolved());
  };
  for (const Member& m : c.class_info().members) {
    if (m.kind != Kind::file) continue;
    const Value value = m.get(c, m);
    add(value);
    if (const auto* list = value.as<Value::List>())
      for (const Value& item : *list) add(item);
  }
  return names.empty() ? names : " (" + names + ")";
}

/// Null for a helper class that is not registered.
const ClassInfo* class_of(const Component& c) {
  try {
    return &c.class_info();
  } catch (const Error&) {
    return nullptr;
  }
}

}  // namespace

void blame(const Component& c, std::string_view doing) {
  const ClassInfo* known = class_of(c);
  if (!known) throw;  // an unregistered helper class
  const ClassInfo& info = *known;
  Location place = c.origin ? c.origin->location : Location{};
  std::string text;
  try {
    throw;
  } catch (const Errors&) {
    throw;
  } catch (const Error& e) {
    text = e.what();
    const bool told = info.provider.empty() || text.find("(of plugin '") != std::string::npos;
    if (told && (e.location.known() || !place.known())) throw;
    if (e.location.known()) place = e.location;
    if (!told) text += fmt::format(" [said by {}]", name_with_plugin(info));
  } catch (const std::bad_alloc&) {
    text = fmt::format("{}: there is not enough memory for {} it{}", info.name, doing, files_of(c));
  } catch (...) {
    const std::set<std::string> names = suspects(c);
    if (names.empty()) throw;  // not an exception of a plugin: passed on unchanged
    text = fmt::format("{}{}: {} failed: {}", names.size() > 1 ? "one of " : "", fmt::join(names, ", "), doing, thrown_text());
  }
  throw Error(text, place);
}

}  // namespace etendue
