#include "shaped_arrays.h"

#include <fmt/format.h>

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace etendue::python {
namespace {

using Doubles = nb::ndarray<const double, nb::numpy, nb::c_contig>;

std::string text_of(const nb::object& object) { return nb::cast<std::string>(nb::str(object)); }

/// The number of axes that the `resolution` of a class has; 0: the member is not the list of numbers that it belongs to.
size_t axes_of(const Component& c, const Member& member) {
  if (member.kind != Kind::number || !member.list) return 0;
  const Member* const resolution = c.class_info().find("resolution");
  if (!resolution || resolution->kind != Kind::integer || !resolution->list) return 0;
  const auto* const by_default = resolution->default_value.as<Numbers>();
  return by_default ? by_default->rows() : 0;
}

/// The `number_type` of an image's array. Integers of other sizes would leave open which of them is white.
std::string number_type_of(const nb::object& dtype) {
  const std::string kind = nb::cast<std::string>(dtype.attr("kind"));
  const auto size = nb::cast<int>(dtype.attr("itemsize"));
  if (kind == "f" || kind == "b") return "float";
  if (kind == "u" && size == 1) return "uint8";
  if (kind == "u" && size == 2) return "uint16";
  throw Error("is an image, so an array of floats, uint8 or uint16, not of " + text_of(dtype) +
              "; say what its numbers are by .astype");
}

/// Checks the shape: (height, width) or (height, width, channels) of an image, (nz, ny, nx) or (nz, ny, nx, 3) of a grid.
void check_shape(const std::vector<size_t>& shape, size_t axes, const nb::object& array) {
  const size_t channels = shape.size() > axes ? shape[axes] : 1;
  const bool fits = (shape.size() == axes || shape.size() == axes + 1) &&
                    (axes == 2 ? channels >= 1 && channels <= 4 : channels == 1 || channels == 3);
  const char* const wanted = axes == 2 ? "an image: an array of shape (height, width) or (height, width, 1 to 4)"
                                       : "a grid: an array of shape (nz, ny, nx) or (nz, ny, nx, 3)";
  if (!fits) throw Error(fmt::format("expects {}, not {}", wanted, text_of(array.attr("shape"))));
  for (const size_t n : shape)
    if (n == 0) throw Error(fmt::format("cannot be an array of shape {}, which is empty", text_of(array.attr("shape"))));
}

/// given_values, with errors that do not name class and member.
std::vector<Given> values_of(const Component& c, const Member& member, nb::handle object, Location at) {
  const size_t axes = axes_of(c, member);
  const nb::object array = axes > 0 && !nb::isinstance<nb::list>(object) ? as_array(object) : nb::object();
  if (!array.is_valid() || nb::cast<size_t>(array.attr("ndim")) < 2) return {{&member, to_value(object, &member, at)}};
  const nb::object dtype = array.attr("dtype"), numpy = nb::module_::import_("numpy");
  const std::string kind = nb::cast<std::string>(dtype.attr("kind"));
  if (kind != "b" && kind != "i" && kind != "u" && kind != "f") throw Error("cannot be an array of " + text_of(dtype));
  const auto shape = nb::cast<std::vector<size_t>>(array.attr("shape"));
  check_shape(shape, axes, array);
  const Member* const type = c.class_info().find("number_type");
  const std::string number_type = type ? number_type_of(dtype) : "";

  const auto doubles = nb::cast<Doubles>(numpy.attr("ascontiguousarray")(array, numpy.attr("float64")));
  Numbers values, resolution;
  values.values.assign(doubles.data(), doubles.data() + doubles.size());
  for (size_t i = axes; i-- > 0;) resolution.values.push_back(double(shape[i]));  // along x first
  // The list first: it may be refused, for numbers out of its range; then nothing has changed.
  std::vector<Given> given{{&member, Value(std::move(values), at)},
                           {c.class_info().find("resolution"), Value(std::move(resolution), at)}};
  if (type) given.push_back({type, Value(number_type, at)});
  return given;
}

}  // namespace

std::vector<Given> given_values(const Component& c, const Member& member, nb::handle object, Location at) {
  try {
    return values_of(c, member, object, at);
  } catch (const Error& e) {
    throw Error(c.class_info().name + "." + member.name + " " + e.what(), e.location.known() ? e.location : at);
  }
}

Ref<Component> image_map_of(nb::handle array, Location at) {
  Ref<Component> map = Registry::instance().create("ImageMap");
  for (const Given& g : values_of(*map, *map->class_info().find("values"), array, at)) set(*map, g.member->name, g.value);
  if (at.known()) {
    map->origin = std::make_unique<Component::Origin>();
    map->origin->location = at;
  }
  return map;
}

}  // namespace etendue::python
