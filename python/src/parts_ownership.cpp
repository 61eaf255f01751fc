// When parts that are written in Python are freed.
//
// Let P be the Python object of such a part and T its C++ object. P owns T (Handle), and T owns P. An ordinary component C may
// have a Python object H, which owns C; C does not own H.
//
// Python's garbage collector finds the objects that are referred to only from within a set of objects, by subtracting from each
// object's reference count the references that `traverse` of the others, and of itself, reports. So each reference T -> P must
// be reported by one Python object at most, and by one that is alive exactly as long as that reference keeps P alive:
//
//   - If nothing but P owns T (T has one reference), T -> P keeps P alive as long as P is: P reports itself.
//   - If T is also owned by the member of a component C, and C by another one, and so on up to a component R that nothing but
//     its Python object H owns, then T -> P keeps P alive as long as H is: H reports P. So a shader may keep the job that it is
//     used in: P.__dict__ -> H(job) -> P is a cycle which the collector sees.
//   - T itself owns components by its members. As T lives exactly as long as P, P reports the parts below T.
//   - Below a component that has a Python object of its own, and another owner, nothing is reported: it lives as long as
//   either,
//     and no single object could report it. Then the parts there are freed only after one of the two owners is gone. In the
//     same way a part that is referred to from elsewhere (a render that is running, another thread) is not reported.
//
// The components below R that only R keeps alive are found by counting: a component is one of them if as many members of such
// components refer to it as it has references (and one reference more, that of P, if it is a part T). While that is so, nobody
// else can make a new reference to it, and the count cannot change while the collector runs.

#include <unordered_map>

#include "describe/expansion.h"
#include "parts.h"

namespace etendue::python {

std::atomic<int> PythonPart::alive_ = 0;

namespace {

PythonPart* part_of(const Component& c) {
  return const_cast<PythonPart*>(dynamic_cast<const PythonPart*>(&c));  // the object itself is never const
}

/// Calls `report(P)` for each part T whose reference T -> P the Python object of `root` reports.
template <class Report>
int report_parts(const Component& root, const Report& report) {
  PythonPart* const own = part_of(root);
  const bool alone = root.references() == 1;
  if (own && alone && own->self)
    if (const int stop = report(own->self)) return stop;
  if (!own && !alone) return 0;
  std::unordered_map<const Component*, int> counted;
  std::vector<const Component*> left = {&root};
  while (!left.empty()) {
    const Component* const at = left.back();
    left.pop_back();
    // All references that reading the members made are gone when they are counted.
    for (const Component* c : components_of(*at)) {
      const int owners = ++counted[c];
      if (PythonPart* const part = part_of(*c)) {
        if (part->self && owners == c->references() - 1)
          if (const int stop = report(part->self)) return stop;
      } else if (owners == c->references()) {
        left.push_back(c);
      }
    }
  }
  return 0;
}

int traverse(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (PythonPart::alive() == 0 || !nb::inst_ready(self)) return 0;
  const Ref<Component>& component = nb::inst_ptr<Handle>(self)->component;
  return component ? report_parts(*component, [&](PyObject* part) { return visit(part, arg); }) : 0;
}

/// Called for objects that are garbage: drops T -> P. If something still owns T, it is owned by garbage that is about to go,
/// and the collector comes back to P.
int clear(PyObject* self) {
  if (!nb::inst_ready(self)) return 0;
  const Ref<Component>& component = nb::inst_ptr<Handle>(self)->component;
  if (!component || component->references() != 1) return 0;
  if (PythonPart* const part = part_of(*component)) Py_CLEAR(part->self);
  return 0;
}

PyType_Slot slots[] = {
    {Py_tp_traverse, reinterpret_cast<void*>(traverse)}, {Py_tp_clear, reinterpret_cast<void*>(clear)}, {0, nullptr}};

}  // namespace

PyType_Slot* ownership_slots() { return slots; }

PythonPart::PythonPart(const ClassInfo& info, PyObject* of)
    : self(Py_NewRef(of)), info_(info), class_(*static_cast<const PythonClass*>(info.declared.get())) {
  ++alive_;
}

PythonPart::~PythonPart() { --alive_; }

bool PythonClass::defines(const char* method) const {
  for (const std::string& m : methods)
    if (m == method) return true;
  return false;
}

}  // namespace etendue::python
