// Values of the language from Python objects and back.

#include "binding.h"

#include <fmt/format.h>

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <charconv>
#include <cmath>
#include <cstdlib>

#include "etendue/language/language.h"
#include "language/calls.h"
#include "shaped_arrays.h"

namespace etendue::python {

namespace {

/// A NumPy array, or what looks like one, as doubles in C order.
using Doubles = nb::ndarray<const double, nb::numpy, nb::c_contig>;

std::string text_of(const nb::object& object) { return nb::cast<std::string>(nb::steal<nb::str>(PyObject_Str(object.ptr()))); }

std::string class_of(nb::handle object) { return nb::cast<std::string>(nb::str(object.type().attr("__name__"))); }

bool is_text_kind(Kind k) { return k == Kind::string || k == Kind::file || k == Kind::choice; }

/// A plain text for members that are texts; for all others the text is an expression of the language: "30 cm", "rgb(1, 0, 0)".
Value from_text(const std::string& text, const Member* member, Location at) {
  if (!member || is_text_kind(member->kind)) return Value(text, at);
  Value parsed;
  try {
    parsed = parse_value(text, "text");
  } catch (const Errors& e) {
    throw Error("cannot be read: '" + text + "': " + e.what(), at);
  } catch (const Error& e) {
    throw Error("cannot be read: '" + text + "': " + e.what(), at);
  }
  parsed.location = at;
  return parsed;
}

Value transform_from(const std::vector<double>& m, Location at) {
  if (m.size() == 16 && (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1))
    throw Error("expects an affine transform: the last row of its matrix is 0 0 0 1", at);
  Transform::DoubleMatrix rows;
  std::copy_n(m.begin(), 12, rows.begin());
  return Value(Transform(rows), at);
}

Value from_array(nb::object array, const Member* member, Location at) {
  const std::string kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  if (kind == "U" || kind == "S" || kind == "O") return to_value(array.attr("tolist")(), member, at);
  if (kind != "b" && kind != "i" && kind != "u" && kind != "f")
    throw Error("cannot be an array of " + text_of(array.attr("dtype")), at);
  if (member && !member->list && member->component_class == "ObjectMap" && nb::cast<size_t>(array.attr("ndim")) >= 2)
    return Value(image_map_of(array, at), at);
  const nb::object numpy = nb::module_::import_("numpy");
  if (nb::cast<size_t>(array.attr("ndim")) == 0) {
    if (kind == "b") return Value(nb::cast<bool>(array.attr("item")()), at);
    return Value(Number{nb::cast<double>(nb::float_(array.attr("item")()))}, at);
  }
  const auto doubles = nb::cast<Doubles>(numpy.attr("ascontiguousarray")(array, numpy.attr("float64")));
  const size_t count = doubles.size();
  if (member && member->kind == Kind::transform && !member->list) {
    if (doubles.ndim() != 2 || (doubles.shape(0) != 4 && doubles.shape(0) != 3) || doubles.shape(1) != 4)
      throw Error("expects a transform: an array of shape (4, 4) or (3, 4)", at);
    return transform_from({doubles.data(), doubles.data() + count}, at);
  }
  if (doubles.ndim() > 2 || (doubles.ndim() == 2 && (doubles.shape(1) < 1 || doubles.shape(1) > 4)))
    throw Error(fmt::format("cannot be an array of shape {}", text_of(array.attr("shape"))), at);
  Numbers numbers;
  numbers.width = doubles.ndim() == 2 ? int(doubles.shape(1)) : 1;
  numbers.values.assign(doubles.data(), doubles.data() + count);
  if (count == 0) return Value(Value::List{}, at);
  return Value(std::move(numbers), at);
}

Value from_sequence(nb::handle sequence, const Member* member, Location at) {
  Member entry;  // texts within a list are read as the member's own kind
  if (member) {
    entry = *member;
    entry.list = false;
  }
  Value::List items;
  for (const nb::handle item : sequence) items.push_back(to_value(item, member ? &entry : nullptr, at));
  if (member && member->kind == Kind::transform && !member->list) {
    const Value rows = language::packed(items, at);
    if (const auto* n = rows.as<Numbers>(); n && n->width == 4 && (n->rows() == 3 || n->rows() == 4))
      return transform_from(n->values, at);
  }
  if (items.empty()) return Value(std::move(items), at);
  return language::packed(std::move(items), at);
}

}  // namespace

nb::object as_array(nb::handle object) {
  if (!nb::hasattr(object, "__array__") && !nb::hasattr(object, "__array_interface__") && !nb::hasattr(object, "__dlpack__") &&
      !nb::isinstance<nb::ndarray<>>(object))
    return {};
  return nb::module_::import_("numpy").attr("asarray")(object);
}

Value to_value(nb::handle object, const Member* member, Location at) {
  if (object.is_none()) return Value();
  if (nb::isinstance<Opaque>(object)) {
    Value v = nb::cast<const Opaque&>(object).value;
    v.location = at;
    return v;
  }
  if (is_component(object)) return Value(component_of(object), at);
  if (nb::isinstance<nb::bool_>(object)) return Value(nb::cast<bool>(object), at);
  if (nb::isinstance<nb::float_>(object) || nb::isinstance<nb::int_>(object))
    return Value(Number{nb::cast<double>(nb::float_(object))}, at);
  if (nb::isinstance<nb::str>(object)) return from_text(nb::cast<std::string>(object), member, at);
  if (nb::isinstance<nb::list>(object) || nb::isinstance<nb::tuple>(object)) return from_sequence(object, member, at);
  if (nb::hasattr(object, "__fspath__")) return Value(text_of(object.attr("__fspath__")()), at);
  if (nb::hasattr(object, "_etendue_value_")) return to_value(object.attr("_etendue_value_")(), member, at);
  if (const nb::object array = as_array(object); array.is_valid()) return from_array(array, member, at);
  if (nb::hasattr(object, "__float__") || nb::hasattr(object, "__index__"))
    return Value(Number{nb::cast<double>(nb::float_(object))}, at);
  if (nb::isinstance<nb::dict>(object) && nb::borrow<nb::dict>(object).contains("class"))
    return to_value(nb::module_::import_("etendue._files").attr("from_dict")(object), member, at);
  // What can be iterated over, but has no order, or is text: its entries would be numbers by accident.
  const bool no_list = nb::isinstance<nb::dict>(object) || PyAnySet_Check(object.ptr()) || nb::isinstance<nb::bytes>(object) ||
                       nb::isinstance<nb::bytearray>(object);
  if (!no_list && (nb::isinstance<nb::sequence>(object) || nb::hasattr(object, "__iter__")))
    return from_sequence(object, member, at);
  throw Error("cannot be an object of Python's class " + class_of(object), at);
}

namespace {

/// In the member's unit. A member that is a float gives the shortest number that is the same float: 0.3, not 0.30000001192.
double in_unit(double value, const Member* member) {
  const Unit* unit = member ? find_unit(member->unit) : nullptr;
  const double x = unit ? value / unit->factor : value;
  if (!member || member->in_double || member->kind == Kind::integer || !std::isfinite(x)) return x;
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, float(x)).ptr;
  double shortest = x;
  std::from_chars(text, end, shortest);
  return shortest;
}

nb::object array_of(const Numbers& n, const Member* member) {
  auto* const data = new std::vector<double>(n.values);
  for (double& x : *data) x = in_unit(x, member);
  const nb::capsule owner(data, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  const size_t shape[2] = {n.rows(), size_t(n.width)};
  return nb::cast(nb::ndarray<nb::numpy, double>(data->data(), n.width > 1 ? 2 : 1, shape, owner), nb::rv_policy::reference);
}

/// Vectors and points are tuples: they cannot be changed in place, which would be lost without a word.
nb::object tuple_of(const Numbers& n, const Member* member) {
  nb::list entries;
  for (const double x : n.values) entries.append(in_unit(x, member));
  return nb::tuple(entries);
}

}  // namespace

nb::object to_python(const Value& v, const Member* member) {
  if (v.none()) return nb::none();
  if (const auto* b = v.as<bool>()) return nb::bool_(*b);
  if (const auto* n = v.as<Number>()) {
    const double x = in_unit(n->value, member);
    if (member && member->kind == Kind::integer) return nb::int_(std::int64_t(x));
    return nb::float_(x);
  }
  if (const auto* s = v.as<std::string>()) return nb::str(s->c_str(), s->size());
  if (const auto* f = v.as<FilePath>()) {
    const std::string path = f->resolved();
    return nb::str(path.c_str(), path.size());
  }
  if (const auto* n = v.as<Numbers>()) return member && !member->list ? tuple_of(*n, member) : array_of(*n, member);
  if (const auto* c = v.as<Ref<Component>>()) return wrap(*c);
  if (const auto* list = v.as<Value::List>()) {
    nb::list entries;
    for (const Value& item : *list) entries.append(to_python(item, member));
    return nb::tuple(entries);
  }
  return nb::cast(Opaque{v});
}

Location calling_line() {
  // The innermost frame that is not of this package.
  PyFrameObject* frame = PyEval_GetFrame();
  nb::object at = nb::borrow(reinterpret_cast<PyObject*>(frame));
  while (at.is_valid() && !at.is_none()) {
    const nb::object module = at.attr("f_globals").attr("get")("__name__", "");
    if (!nb::isinstance<nb::str>(module) || !nb::cast<std::string>(module).starts_with("etendue.")) {
      const std::string file = nb::cast<std::string>(at.attr("f_code").attr("co_filename"));
      return {intern(file), nb::cast<int>(at.attr("f_lineno")), 0};
    }
    at = at.attr("f_back");
  }
  return {};
}

namespace {

/// A value for a function of the language. A text that is a number with a unit, "20 deg", is that quantity; others are names.
Value function_argument(nb::handle object, const Location& at) {
  Value value = to_value(object, nullptr, at);
  const auto* const text = value.as<std::string>();
  if (!text) return value;
  char* unit = nullptr;
  std::strtod(text->c_str(), &unit);
  if (unit == text->c_str() || !*unit || text->find_first_of(".\"", size_t(unit - text->c_str())) != std::string::npos)
    return value;
  try {
    Value quantity = parse_value(*text);
    quantity.location = at;
    return quantity;
  } catch (const Error&) {
    return value;  // a name that begins with a digit
  }
}

}  // namespace

void bind_values(nb::module_& m) {
  nb::class_<Opaque>(m, "Value", "A colour or a transform of the language.")
      .def("__repr__", [](const Opaque& o) { return write_value(o.value); })
      .def("__eq__", [](const Opaque& a,
                        nb::handle b) { return nb::isinstance<Opaque>(b) && equal(a.value, nb::cast<const Opaque&>(b).value); })
      .def("__hash__", [](const Opaque& o) { return nb::hash(nb::str(write_value(o.value).c_str())); })
      .def_prop_ro("kind", [](const Opaque& o) { return o.value.kind(); })
      .def_prop_ro(
          "matrix",
          [](const Opaque& o) -> nb::object {
            const auto* still = o.value.as<Transform>();
            if (!still) throw Error("only a transform that does not move has a matrix, not " + o.value.kind());
            Numbers rows{{still->exact().begin(), still->exact().end()}, 4, Dimension::none};
            rows.values.insert(rows.values.end(), {0, 0, 0, 1});
            return to_python(Value(std::move(rows)), nullptr);
          },
          "The matrix of a transform, shape (4, 4).")
      .def("__matmul__",
           [](const Opaque& a, const Opaque& b) { return Opaque{language::multiply(a.value, b.value, calling_line())}; })
      .def("__mul__",
           [](const Opaque& a, nb::handle b) {
             return to_python(language::multiply(a.value, to_value(b, nullptr, calling_line()), calling_line()), nullptr);
           })
      .def("__rmul__",
           [](const Opaque& a, nb::handle b) {
             return to_python(language::multiply(to_value(b, nullptr, calling_line()), a.value, calling_line()), nullptr);
           })
      .def("__add__", [](const Opaque& a, nb::handle b) {
        return to_python(language::add(a.value, to_value(b, nullptr, calling_line()), calling_line()), nullptr);
      });
  m.def(
      "call",
      [](const std::string& function, const nb::args& arguments) {
        const Location at = calling_line();
        std::vector<Value> values;
        for (const nb::handle a : arguments) values.push_back(function_argument(a, at));
        return to_python(released([&] { return language::call(function, values, at, true); }), nullptr);
      },
      "Calls a function of the language.");
  m.def("is_function", &language::is_function);
  m.def("functions", [] {
    nb::list all;  // (name, usage, what it makes)
    const auto add = [&](std::span<const language::Function> functions, const char* makes) {
      for (const language::Function& f : functions) all.append(nb::make_tuple(f.name, f.usage, makes));
    };
    add(language::color_functions(), "color");
    add(language::transform_functions(), "transform");
    add(language::math_functions(), "number");
    return all;
  });
  m.def("parse_value", [](const std::string& text) { return to_python(parse_value(text), nullptr); });
  m.def("write_value", [](nb::handle value) { return write_value(to_value(value, nullptr)); });
}

}  // namespace etendue::python
