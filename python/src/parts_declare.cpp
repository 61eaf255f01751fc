// Declares classes that are written in Python, with their members. etendue/_declare.py reads the Python class.

#include <fmt/format.h>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

#include "describe/faults.h"
#include "describe/guard.h"
#include "etendue/describe/reflection.h"
#include "language/evaluator.h"
#include "live_render.h"
#include "parts.h"

namespace etendue::python {

const std::vector<PartInterface>& part_interfaces() {
  static const auto* all = new std::vector<PartInterface>{
      map_interface(),    tone_map_interface(), renderer_interface(),       shader_interface(), emission_interface(),
      camera_interface(), filter_interface(),   phase_function_interface(), output_interface(), importer_interface()};
  return *all;
}

namespace {

constexpr const char* info_attribute = "_declared";

/// Holds the values of a default while it is converted.
class Scratch final : public Component, public DeclaredMembers {};

// ---- members ----------------------------------------------------------------------------------------------------------------

template <class T>
T entry(const nb::dict& from, const char* name, T otherwise) {
  return from.contains(name) && !from[name].is_none() ? nb::cast<T>(from[name]) : otherwise;
}

Kind kind_named(const std::string& wanted) {
  for (int k = 0; k <= int(Kind::component); ++k)
    if (name(Kind(k)) == wanted) return Kind(k);
  throw Error("there is no kind of member '" + wanted + "'");
}

template <class E>
E one_of(const std::string& wanted, std::initializer_list<E> all, const char* what) {
  std::vector<std::string> known;
  for (const E e : all) {
    if (name(e) == wanted) return e;
    known.emplace_back(name(e));
  }
  throw Error(fmt::format("{} is one of {}, not '{}'", what, fmt::join(known, ", "), wanted));
}

Condition condition_from(const nb::dict& from) {
  Condition c;
  c.member = nb::cast<std::string>(from["member"]);
  c.unless = nb::cast<bool>(from["unless"]);
  for (const nb::handle value : from["values"]) {
    if (nb::isinstance<nb::bool_>(value))
      c.values.emplace_back(nb::cast<bool>(value));
    else if (nb::isinstance<nb::str>(value))
      c.values.emplace_back(nb::cast<std::string>(value));
    else
      c.values.emplace_back(nb::cast<double>(nb::float_(value)));
  }
  return c;
}

/// The value of a member whose class gives it no default.
Value nothing(const Member& m) {
  if (m.list) return Value(Value::List{});
  switch (m.kind) {
    case Kind::boolean: return Value(false);
    case Kind::integer:
    case Kind::number: return Value(Number{});
    case Kind::string: return Value(m.choices.empty() ? std::string() : m.choices.front());
    case Kind::choice: return Value(m.choices.front());
    case Kind::file: return Value(std::string());
    case Kind::vector2: return Value(Numbers{{0, 0}, 1, Dimension::none});
    case Kind::vector3:
    case Kind::point3:
    case Kind::normal3: return Value(Numbers{{0, 0, 0}, 1, Dimension::none});
    case Kind::transform: return Value(Transform());
    case Kind::color:
    case Kind::component: return Value();
  }
  return Value();
}

void set_default(Member& m, const nb::dict& from, Location at) {
  const Member unlimited = [&] {  // a required member may begin outside of its range
    Member copy = m;
    copy.range.reset();
    copy.choices.clear();
    return copy;
  }();
  const auto scratch = make<Scratch>();
  const bool given = from.contains("default");
  const Value value = given ? to_value(from["default"], &m, at) : nothing(m);
  const Member& described = given ? m : unlimited;
  described.store(*scratch, described, value);
  m.default_value = scratch->declared_values.at(m.name);
}

Member member_from(const nb::dict& from, Location at) {
  Member m;
  m.name = nb::cast<std::string>(from["name"]);
  m.kind = kind_named(nb::cast<std::string>(from["kind"]));
  m.list = entry(from, "list", false);
  m.text = entry<std::string>(from, "text", "");
  m.unit = entry<std::string>(from, "unit", "");
  m.required = entry(from, "required", false);
  m.group = entry<std::string>(from, "group", "");
  m.component_class = entry<std::string>(from, "part", "");
  m.choices = entry<std::vector<std::string>>(from, "choices", {});
  m.logarithmic = entry(from, "logarithmic", false);
  if (from.contains("range")) {
    const auto [low, high] = nb::cast<std::pair<std::optional<double>, std::optional<double>>>(from["range"]);
    m.range = Range{low.value_or(-std::numeric_limits<double>::infinity()),
                    high.value_or(std::numeric_limits<double>::infinity()), entry(from, "open_low", false)};
  }
  if (from.contains("soft")) {
    const auto [low, high] = nb::cast<std::pair<double, double>>(from["soft"]);
    m.soft = SoftRange{low, high};
  }
  m.effect = one_of(entry<std::string>(from, "effect", std::string(name(m.effect))),
                    {Effect::none, Effect::retone, Effect::rerender, Effect::rebuild}, "an effect");
  m.meaning =
      one_of(entry<std::string>(from, "meaning", std::string(name(m.meaning))),
             {Meaning::plain, Meaning::number, Meaning::reflectance, Meaning::radiance, Meaning::coefficient, Meaning::index},
             "a meaning");
  for (const nb::handle c : entry(from, "conditions", nb::list()))
    m.conditions.push_back(condition_from(nb::cast<nb::dict>(c)));
  try {
    keep_as_value(m);
    set_default(m, from, at);
  } catch (const Error& e) {
    throw Error(m.name + ": its default " + e.what(), at);
  }
  return m;
}

// ---- classes ----------------------------------------------------------------------------------------------------------------

const PartInterface* interface_of(const ClassInfo& info) {
  for (const PartInterface& known : part_interfaces())
    if (info.name == known.name) return &known;
  return nullptr;
}

/// The interface of a class of Python: that of its first ancestor that is compiled.
const PartInterface& interface_above(const ClassInfo& info) {
  const ClassInfo* at = &info;
  while (at->declared) at = at->parent;
  if (const PartInterface* known = interface_of(*at)) return *known;
  std::vector<std::string> names;
  for (const PartInterface& known : part_interfaces()) names.emplace_back(known.name);
  throw Error(
      fmt::format("{}: a class that is written in Python derives from an interface ({}) or from another class that is "
                  "written in Python, not from {}",
                  info.name, fmt::join(names, ", "), at->name));
}

/// Makes an object from C++: for the language, copies, conform.
Ref<Component> make_by_python(const ClassInfo& info) {
  const Interpreter lock;
  const PythonClass& of = *static_cast<const PythonClass*>(info.declared.get());
  PyObject* const object = PyObject_CallNoArgs(of.type.ptr());
  if (!object) throw_python_error({info.name, "__init__"});
  const nb::object made = nb::steal(object);
  const Ref<Component> component = component_of(made);
  if (&component->class_info() != &info) throw Error(info.name + ": calling the class gives an object of another class");
  return component;
}

std::shared_ptr<void> python_class(nb::handle type, std::vector<std::string> methods) {
  return {new PythonClass{nb::borrow(type), std::move(methods)}, [](void* p) {
            auto* const of = static_cast<PythonClass*>(p);
            if (Interpreter::closed()) {
              of->type.release();  // Python has ended
              delete of;
              return;
            }
            const Interpreter lock;
            delete of;
          }};
}

/// The class as it will be declared. Throws Error that names the class.
std::unique_ptr<ClassInfo> class_from(nb::handle type, const nb::dict& from, Location at) {
  auto info = std::make_unique<ClassInfo>();
  info->name = nb::cast<std::string>(from["name"]);
  const std::string parent = nb::cast<std::string>(from["parent"]);
  const ClassInfo* const declared_parent = declared_class_of(type.attr("__base__"));
  info->parent = declared_parent ? declared_parent : Registry::instance().find(parent);
  if (!info->parent) throw Error(info->name + ": there is no class " + parent);
  const ClassInfo* const taken = Registry::instance().find(info->name);
  if (taken && !taken->declared) throw Error(info->name + ": the library has a class of this name", at);
  info->summary = nb::cast<std::string>(from["summary"]);
  info->source = entry<std::string>(from, "source", "");
  info->provider = entry<std::string>(from, "provider", "");
  info->members = info->parent->members;
  info->absent = info->parent->absent;
  info->declared = python_class(type, nb::cast<std::vector<std::string>>(from["methods"]));
  info->make = entry(from, "abstract", false) ? nullptr : make_by_python;
  interface_above(*info);
  for (const nb::handle m : from["members"]) {
    const auto described = nb::cast<nb::dict>(m);
    try {
      info->members.push_back(member_from(described, at));
    } catch (const Error& e) {
      throw Error(info->name + "." + e.what(), at);
    }
    info->members.back().owner = info.get();
  }
  return info;
}

/// Declares the class. An object is made before the registry does: when that fails, the description is kept for the objects of
/// the class that may exist.
void declare(nb::handle type, const nb::dict& from) {
  const Location at = calling_line();
  std::unique_ptr<ClassInfo> info = class_from(type, from, at);
  if (const std::string wrong = fault(*info); !wrong.empty()) throw Error(info->name + ": " + wrong, at);
  type.attr(info_attribute) = nb::capsule(info.get());
  try {
    if (!info->abstract()) info->make(*info);
  } catch (const Error& e) {
    const std::string name = info.release()->name;
    throw Error(name + " cannot be used: " + e.what(), e.location.known() ? e.location : at);
  }
  try {
    released([&] { Registry::instance().declare(std::move(info)); });
  } catch (const Error& e) {
    throw Error(e.what(), e.location.known() ? e.location : at);
  }
}

nb::list interfaces() {
  nb::list all;
  for (const PartInterface& known : part_interfaces()) {
    nb::dict methods, texts;
    for (const PartMethod& m : known.methods) {
      methods[m.name] = m.arguments;
      texts[m.name] = m.text;
    }
    nb::dict entry;
    entry["name"] = known.name;
    entry["methods"] = methods;
    entry["texts"] = texts;
    entry["required"] = known.required;
    entry["together"] = known.together;
    all.append(entry);
  }
  return all;
}

const MethodName prepare_name("prepare");

}  // namespace

const ClassInfo* declared_class_of(nb::handle type) {
  const nb::object found = nb::getattr(type, info_attribute, nb::none());
  return found.is_none() ? nullptr : static_cast<const ClassInfo*>(nb::cast<nb::capsule>(found).data());
}

Ref<Component> make_declared(const ClassInfo& info, PyObject* self) {
  Ref<Component> made = interface_above(info).make(info, self);
  // Each object has parts of its own, as the objects of compiled classes have.
  for (const Member& m : info.members)
    if (m.owner && m.owner->declared && m.kind == Kind::component && !m.default_value.none()) {
      auto& values = dynamic_cast<DeclaredMembers&>(*made).declared_values;
      if (const auto* part = m.default_value.as<Ref<Component>>()) {
        values.insert_or_assign(m.name, Value(copy(**part)));
      } else if (const auto* list = m.default_value.as<Value::List>()) {
        Value::List copies;
        for (const Value& item : *list)
          copies.push_back(item.as<Ref<Component>>() ? Value(copy(**item.as<Ref<Component>>())) : item);
        values.insert_or_assign(m.name, Value(std::move(copies)));
      }
    }
  return made;
}

void prepare_part(const PythonPart& part) {
  if (part.defines(prepare_name)) PartCall(part, prepare_name)();
}

void bind_declarations(nb::module_& m) {
  m.def("declare", &declare);
  m.def("part_interfaces", &interfaces);
  m.def("is_declared", [](nb::handle type) { return declared_class_of(type) != nullptr; });
  m.def("read_python_plugins", [](const nb::object& read) {
    // Never destroyed: the registry outlives the interpreter.
    auto* const reader = new nb::object(read);
    Registry::instance().read_plugins(".py", [reader](const std::string& file) {
      const Interpreter lock;
      try {
        (*reader)(file);
      } catch (nb::python_error& e) {
        e.restore();
        static const std::string name = "it";
        throw_python_error({name, ""});
      }
    });
  });
  nb::module_::import_("atexit").attr("register")(nb::cpp_function([] { Interpreter::close(close_all_renders); }));
}

void bind_parts(nb::module_& m) {
  bind_part_values(m);
  bind_rays(m);
  bind_importing(m);
  bind_declarations(m);
}

}  // namespace etendue::python
