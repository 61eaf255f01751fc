#pragma once
// Parts that are written in Python: `class Mine(etendue.Shader)`.
//
// A class of Python becomes a declared class of the registry (describe/declared_class.h). Its C++ objects are of one type for
// each interface, PartOf<Interface>, whose virtual functions call the methods of the Python object. The files parts_*.cpp
// derive from it.
//
// Ownership. The Python object holds a Ref to the C++ object (Handle), and the C++ object a reference to the Python object, so
// that each is alive as long as anything refers to either. Python's garbage collector frees the pair when both are referred to
// by nothing else: parts_ownership.cpp tells it which references are of this kind.

#include <atomic>
#include <string>
#include <vector>

#include "binding.h"
#include "etendue/describe/declared_class.h"
#include "parts_calls.h"

namespace etendue::python {

/// What ClassInfo::declared refers to for a class that is written in Python.
struct PythonClass {
  nb::object type;
  /// The names of the methods that the class defines.
  std::vector<std::string> methods;
  bool defines(const char* method) const;
};

/// The part of a C++ object that does not depend on its interface.
class PythonPart : public DeclaredMembers {
 public:
  PythonPart(const ClassInfo&, PyObject* self);
  ~PythonPart() override;
  PythonPart(const PythonPart&) = delete;
  PythonPart& operator=(const PythonPart&) = delete;

  const ClassInfo& declared_class() const { return info_; }
  bool defines(const MethodName& m) const { return class_.defines(m.text); }

  /// The Python object, which is owned; null when the garbage collector has dropped it. Needs the interpreter's lock.
  PyObject* self;
  /// The number of objects of this class.
  static int alive() { return alive_; }

 private:
  const ClassInfo& info_;
  const PythonClass& class_;
  static std::atomic<int> alive_;
};

/// A call of a method of a part: holds the interpreter's lock as long as it lives, as its results are read with it.
class PartCall : Interpreter {
 public:
  PartCall(const PythonPart& part, const MethodName& name)
      : called{part.declared_class().name, name.text}, part_(part), name_(name) {}
  /// With any number of arguments, which are objects of Python.
  template <class... A>
  nb::object operator()(const A&... arguments) const {
    return call(part_.self, name_, called, {arguments.ptr()...});
  }

  const Called called;

 private:
  const PythonPart& part_;
  const MethodName& name_;
};

/// Calls the method `prepare` of the Python object, if its class has one.
void prepare_part(const PythonPart&);

/// The base of the C++ objects of an interface.
template <class Interface>
class PartOf : public Interface, public PythonPart {
 public:
  PartOf(const ClassInfo& info, PyObject* of) : PythonPart(info, of) {}
  const ClassInfo& class_info() const override { return declared_class(); }
  void prepare() override { prepare_part(*this); }
};

/// A method that a Python class of an interface may define. `arguments` as in the definition: "self, point"; `text` says what
/// it returns. With "self" alone a plain attribute of the class will do.
struct PartMethod {
  const char *name, *arguments, *text;
};
inline constexpr PartMethod prepare_method{"prepare", "self",
                                           "called once all members are set, to check them with self.fail and to precompute"};

/// What the classes of an interface are made of.
struct PartInterface {
  const char* name;
  Ref<Component> (*make)(const ClassInfo&, PyObject* self);
  std::vector<PartMethod> methods;
  /// Which of them a class must define: one of each list.
  std::vector<std::vector<const char*>> required;
  /// Of which it must define all or none.
  std::vector<const char*> together = {};
};

/// All interfaces whose classes can be written in Python.
const std::vector<PartInterface>& part_interfaces();

template <class Part>
Ref<Component> make_part(const ClassInfo& info, PyObject* self) {
  return Ref<Component>(make<Part>(info, self));
}

// Defined in one file each.
PartInterface map_interface();
PartInterface tone_map_interface();
PartInterface renderer_interface();
PartInterface shader_interface();
PartInterface emission_interface();
PartInterface camera_interface();
PartInterface filter_interface();
PartInterface phase_function_interface();
PartInterface output_interface();
PartInterface importer_interface();

/// The declared class of a Python class, or of its objects; null for classes of the library.
const ClassInfo* declared_class_of(nb::handle type);
/// Makes the C++ object of a Python object that is being initialized.
Ref<Component> make_declared(const ClassInfo&, PyObject* self);

/// Slots of the Python class of all components, for the garbage collector.
PyType_Slot* ownership_slots();

// One function for each file that adds to the module.
void bind_declarations(nb::module_&);
void bind_part_values(nb::module_&);
void bind_rays(nb::module_&);
void bind_importing(nb::module_&);

}  // namespace etendue::python
