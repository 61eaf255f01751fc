// Components as Python objects, and the registry.

#include "binding.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <unordered_map>

#include "describe/guard.h"
#include "describe/words.h"
#include "etendue/describe/reflection.h"
#include "kept_lists.h"
#include "live_render.h"
#include "parts.h"
#include "shaped_arrays.h"
#include "snapshots.h"
#include "trees.h"

namespace etendue::python {

namespace {

/// The living Python objects by their components. The interpreter's lock guards it.
std::unordered_map<const Component*, PyObject*>& objects() {
  static auto* all = new std::unordered_map<const Component*, PyObject*>;  // never destroyed: objects outlive the module
  return *all;
}

nb::object class_for(const std::string& name) { return nb::module_::import_("etendue._classes").attr("class_named")(name); }

const ClassInfo& class_info(const std::string& name) {
  const ClassInfo* info = Registry::instance().find(name);
  if (!info) throw Error("there is no class '" + name + "'" + meant_class(name));
  return *info;
}

const Member& member_of(const Component& c, const std::string& name) {
  const Member* member = c.class_info().find(name);
  if (!member) throw Error(no_member(c.class_info(), name));
  return *member;
}

/// Where a member was written, for errors that only turn up when the scene is prepared.
void note_origin(Component& c, const std::string& member, Location at) {
  if (!at.known()) return;
  if (!c.origin) c.origin = std::make_unique<Component::Origin>();
  if (!c.origin->location.known()) c.origin->location = at;
  for (auto& [name, place] : c.origin->members)
    if (name == member) {
      place = at;
      return;
    }
  c.origin->members.emplace_back(member, at);
}

void set_member(nb::handle self, const std::string& name, nb::handle value) {
  const Ref<Component> c = component_of(self);
  const Location at = calling_line();
  const Member* member = c->class_info().find(name);
  if (!member) throw Error(no_member(c->class_info(), name), at);
  const std::vector<Given> given = given_values(*c, *member, value, at);
  forget_snapshots(*c);
  LiveRender* const live = render_of(*c);
  if (member->kind == Kind::component) refuse_cycle(*c, live ? Value() : member->get(*c, *member), given.front().value);
  if (live) {
    std::vector<LiveRender::Change> changes;
    for (const Given& g : given) changes.push_back({c, g.member, g.value});
    live->edit(changes);
    if (const LiveRender* still = render_of(*c); !still || still->idle()) note_origin(*c, name, at);
    return;
  }
  for (const Given& g : given) {
    const KeptList kept(*c, g.member);
    set(*c, g.member->name, g.value);
    kept.replaced();
    note_origin(*c, g.member->name, at);
  }
}

nb::object get_member(nb::handle self, const std::string& name) {
  const Ref<Component> c = component_of(self);
  const Member& member = member_of(*c, name);
  if (nb::object before = value_before_edit(*c, name); before.is_valid()) return before;
  if (member.view) return view_of(c, member);
  return to_python(member.get(*c, member), &member);
}

/// Writes values over those of a new object, keyword by keyword.
void init(nb::handle self, const std::string& name, const nb::dict& members) {
  if (nb::inst_ready(self)) throw Error(name + ": the object has been initialized already");
  const ClassInfo* const declared = declared_class_of(self.type());
  const ClassInfo& info = declared ? *declared : class_info(name);
  if (info.abstract()) throw Error(info.name + " is an interface; make an object of one of its classes");
  attach(self, declared ? make_declared(info, self.ptr()) : create(info));
  for (const auto [key, value] : members) set_member(self, nb::cast<std::string>(key), value);
}

}  // namespace

Handle::~Handle() {
  if (component) release_snapshots(*component);
  const auto known = objects().find(component.get());
  // The object may have been made anew while this one was being destroyed.
  if (known != objects().end() && nb::inst_ptr<Handle>(known->second) == this) objects().erase(known);
  release_tree(std::move(component));
}

nb::object wrap(const Ref<Component>& c) {
  if (!c) return nb::none();
  if (nb::object known = living_object(*c); known.is_valid()) return known;
  nb::object made = nb::inst_alloc(class_for(c->class_info().name));
  attach(made, c);
  return made;
}

nb::object living_object(const Component& c) {
  const auto known = objects().find(&c);
  return known != objects().end() && Py_REFCNT(known->second) > 0 ? nb::borrow(known->second) : nb::object();
}

void attach(nb::handle object, const Ref<Component>& c) {
  new (nb::inst_ptr<Handle>(object)) Handle{c};
  nb::inst_mark_ready(object);
  objects()[c.get()] = object.ptr();
}

bool is_component(nb::handle object) { return nb::isinstance<Handle>(object); }

Ref<Component> component_of(nb::handle object) {
  if (!is_component(object))
    throw nb::type_error(
        ("expects a component of etendue, not " + nb::cast<std::string>(nb::str(object.type().attr("__name__")))).c_str());
  if (!nb::inst_ready(object)) throw Error("the object was not initialized: its class must call super().__init__()");
  return nb::inst_ptr<Handle>(object)->component;
}

void bind_components(nb::module_& m) {
  // Attributes and weak references are those of the Python class that derives from it.
  nb::class_<Handle>(m, "Component", nb::type_slots(ownership_slots()), "The base of all classes of the registry.");
  m.def("init", &init, "Makes the component of a Python object, and sets members.");
  m.def("get", &get_member);
  m.def("set", &set_member, nb::arg("self"), nb::arg("name"), nb::arg("value").none());
  m.def("class_name", [](nb::handle self) { return component_of(self)->class_info().name; });
  m.def("matters", [](nb::handle self, const std::string& name) {
    const Ref<Component> c = component_of(self);
    return matters(*c, member_of(*c, name));
  });
  m.def("has_default", [](nb::handle self, const std::string& name) {
    const Ref<Component> c = component_of(self);
    const Member& member = member_of(*c, name);
    return equal(member.get(*c, member), member.default_value);
  });
  m.def("name_of", [](nb::handle self) {
    const Ref<Component> c = component_of(self);
    return c->origin ? c->origin->name : std::string();
  });
  m.def("set_name", [](nb::handle self, const std::string& name) {
    const Ref<Component> c = component_of(self);
    require_no_render(*c, "named");
    if (!c->origin) c->origin = std::make_unique<Component::Origin>();
    c->origin->name = name;
  });
  m.def("copy", [](nb::handle self) {
    const Ref<Component> c = component_of(self);
    return wrap(reading(*c, [&] { return copy(*c); }));
  });
  m.def("equal", [](nb::handle a, nb::handle b) {
    const Ref<Component> first = component_of(a), second = component_of(b);
    require_shallow(*first);
    require_shallow(*second);
    return equal(Value(first), Value(second));
  });
  m.def("prepare", [](nb::handle self) {
    const Ref<Component> c = component_of(self);
    require_no_render(*c, "prepared");
    require_shallow(*c);
    use_threads();
    released([&] { prepare_tree(*c); });
  });
  m.def("fail", [](nb::handle self, const std::string& member, const std::string& message) {
    component_of(self)->fail(member, message);
  });
  m.def("class_json", [](const std::string& name) { return class_json(class_info(name)); });
  m.def("class_names", [] {
    std::vector<std::string> names;
    for (const ClassInfo* info : released([] { return Registry::instance().all(); })) names.push_back(info->name);
    return names;
  });
  m.def("knows_class",
        [](const std::string& name) { return released([&] { return Registry::instance().find(name) != nullptr; }); });
  m.def("meant_class", [](const std::string& name) { return meant_class(name); });
  m.def("load_plugin", [](const std::string& file) { released([&] { Registry::instance().load_plugin(file); }); });
  m.def("plugins", [] { return Registry::instance().plugins(); });
  m.def("json_schema", [] { return released([] { return json_schema(); }); });
}

}  // namespace etendue::python
