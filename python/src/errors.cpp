// Errors and warnings of the library as Python's.

#include <nanobind/stl/string.h>

#include <mutex>
#include <vector>

#include "binding.h"
#include "etendue/language/language.h"
#include "parts_calls.h"

namespace etendue::python {

namespace {

PyObject* error_type = nullptr;

nb::dict location_dict(const Error& e) {
  nb::dict d;
  d["message"] = std::string(e.what());
  d["file"] = e.location.known() ? nb::cast(std::string(e.location.file)) : nb::none();
  d["line"] = e.location.line > 0 ? nb::cast(e.location.line) : nb::none();
  d["column"] = e.location.column > 0 ? nb::cast(e.location.column) : nb::none();
  return d;
}

/// Raises etendue.Error: its text is what the program prints, and its attributes are made by etendue/_errors.py. An exception
/// of a method that is written in Python is its cause; what is no failure, such as KeyboardInterrupt, is raised itself again.
void raise(const std::vector<Error>& errors) {
  std::string text;
  nb::list all;
  nb::object cause;
  for (const Error& e : errors) {
    text += (text.empty() ? "" : "\n") + show(e);
    all.append(location_dict(e));
    if (!cause.is_valid()) cause = cause_of(e.what());
  }
  if (cause.is_valid() && !PyErr_GivenExceptionMatches(cause.ptr(), PyExc_Exception)) {
    PyErr_SetObject(cause.type().ptr(), cause.ptr());
    return;
  }
  nb::object made = nb::handle(error_type)(text, all);
  if (cause.is_valid()) PyException_SetCause(made.ptr(), cause.release().ptr());
  PyErr_SetObject(error_type, made.ptr());
}

struct Waiting {
  std::string message;
  Location at;
};
std::mutex waiting_mutex;
std::vector<Waiting> waiting;

}  // namespace

void tell_warnings() {
  std::vector<Waiting> told;
  {
    const std::lock_guard lock(waiting_mutex);
    std::swap(told, waiting);
  }
  if (told.empty()) return;
  const nb::object warn = nb::module_::import_("etendue._errors").attr("_warn");
  for (const Waiting& w : told) warn(show(Error(w.message, w.at)));
}

void bind_errors(nb::module_& m) {
  // The class is Python's own (etendue/_errors.py); it is set before anything can fail.
  m.def("_set_error_type", [](nb::handle type) {
    Py_XDECREF(error_type);
    error_type = type.inc_ref().ptr();
  });
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const Errors& e) {
      raise(e.errors);
    } catch (const Error& e) {
      raise({e});
    }
  });
  m.def(
      "print_warnings", [] { handle_warnings(nullptr); },
      "From now on warnings are printed on standard error, as the program does.");
  handle_warnings([](const std::string& message, Location at) {
    const std::lock_guard lock(waiting_mutex);
    waiting.push_back({message, at});
  });
}

}  // namespace etendue::python
