// Maps at points of surfaces.

#include <nanobind/stl/string.h>

#include "color_uses.h"
#include "etendue/object_map.h"
#include "points.h"

namespace etendue::python {

namespace {

nb::object color(nb::handle part, const Points& points, size_t count, const nb::tuple& wavelengths, const std::string& use) {
  const auto asked = snapshot_of<ObjectMap>(part, "a map");
  const ColorUse as = color_use(use);
  return answer_spectra(count, wavelengths, [&](size_t i, const Wavelengths& w) {
    const FoundPoint& found = points.row(i);
    return found.exists() ? asked->as<ObjectMap>().color(found.point, w, as) : Spectrum();
  });
}

nb::object scalar(nb::handle part, const Points& points) {
  const auto asked = snapshot_of<ObjectMap>(part, "a map");
  return answer_numbers(
      points.count, [&](size_t i) { return points.at[i].exists() ? asked->as<ObjectMap>().scalar(points.at[i].point) : 0; });
}

}  // namespace

void bind_map_questions(nb::module_& m) {
  m.def("map_color", &color);
  m.def("map_scalar", &scalar);
}

}  // namespace etendue::python
