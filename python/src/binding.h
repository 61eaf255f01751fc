#pragma once
// What the files of the extension module share: components as Python objects, values in both directions, errors, and calls
// without the interpreter's lock.

#include <nanobind/nanobind.h>

#include <string>
#include <type_traits>

#include "etendue/describe/registry.h"
#include "interpreter.h"

namespace etendue::python {

namespace nb = nanobind;

/// What every Python object of a component holds. Python's class of the object is made from the component's ClassInfo
/// (etendue/_classes.py).
struct Handle {
  Ref<Component> component;
  ~Handle();
};

/// From now on the Python object is that of this component, which was made for it.
void attach(nb::handle object, const Ref<Component>&);

/// The Python object of a component: always the same one for as long as it lives. None for null.
nb::object wrap(const Ref<Component>&);
/// The Python object of a component if it has one that lives; else an invalid one.
nb::object living_object(const Component&);
/// The component of a Python object; throws a Python TypeError for other objects, and Error for an object whose __init__ was
/// not called.
Ref<Component> component_of(nb::handle);
/// The same for a component of an interface: component_as<Camera>(object, "a camera").
template <class C>
Ref<C> component_as(nb::handle object, const char* wanted) {
  const Ref<Component> any = component_of(object);
  Ref<C> fitting = ref_cast<C>(any);
  if (!fitting) throw Error(std::string("expects ") + wanted + ", not " + any->class_info().name);
  return fitting;
}
bool is_component(nb::handle);

/// A value of the language that has no counterpart among Python's own types: a colour or a transform.
struct Opaque {
  Value value;
};

/// From a Python object to a value for a member; null: for no certain member. Numbers without a unit are in the member's unit.
/// Throws Error, or Python's TypeError for objects of which no value can be made.
Value to_value(nb::handle, const Member* member, Location = {});
/// The array of an object that has a shape and is no list; an invalid object for all others.
nb::object as_array(nb::handle);
/// From a value to a Python object. Numbers are in the member's unit, without a member in base units.
nb::object to_python(const Value&, const Member* member);

/// The line of Python that called, as a location for errors; unknown outside of files.
Location calling_line();

/// Runs a function without the interpreter's lock, so that other Python threads go on, and then gives the warnings that the
/// library had to Python's `warnings`.
template <class F>
auto released(F&& work);
/// Gives the warnings that have accumulated to Python's `warnings`; may throw, if these are to be errors.
void tell_warnings();

// One function for each file that adds to the module.
void bind_errors(nb::module_&);
void bind_values(nb::module_&);
void bind_components(nb::module_&);
void bind_language(nb::module_&);
void bind_images(nb::module_&);
void bind_laboratory(nb::module_&);
void bind_render(nb::module_&);
void bind_scene_questions(nb::module_&);
void bind_points(nb::module_&);
void bind_scatter_questions(nb::module_&);
void bind_light_questions(nb::module_&);
void bind_camera_questions(nb::module_&);
void bind_volume_questions(nb::module_&);
void bind_map_questions(nb::module_&);
void bind_spectrum_questions(nb::module_&);
void bind_sampler_questions(nb::module_&);
void bind_parts(nb::module_&);

// ---- implementation ----------------------------------------------------------------------------------------------------

template <class F>
auto released(F&& work) {
  if constexpr (std::is_void_v<decltype(work())>) {
    {
      const WithoutLock without;
      work();
    }
    tell_warnings();
  } else {
    auto result = [&] {
      const WithoutLock without;
      return work();
    }();
    tell_warnings();
    return result;
  }
}

}  // namespace etendue::python
