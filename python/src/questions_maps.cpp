// Maps at points of surfaces.

#include <nanobind/stl/string.h>

#include "color_uses.h"
#include "etendue/object_map.h"
#include "points.h"

namespace etendue::python {

namespace {

nb::object color(nb::handle part, const Points& points, size_t count, const nb::tuple& wavelengths, const std::string& use) {
  const auto asked = snapshot_of<ObjectMap>(part, "a map");
  const WavelengthRows rows = wavelength_rows(wavelengths);
  const ColorUse as = color_use(use);
  Answers<float> values({count, rows.count()});
  for_all(count, [&](size_t i, Arena&) {
    const FoundPoint& found = points.row(i);
    rows.fill(i, values[i], [&](const Wavelengths& w) {
      return found.exists() ? asked->as<ObjectMap>().color(found.point, w, as) : Spectrum();
    });
  });
  return values.take();
}

nb::object scalar(nb::handle part, const Points& points) {
  const auto asked = snapshot_of<ObjectMap>(part, "a map");
  Answers<float> values({points.count});
  for_all(points.count, [&](size_t i, Arena&) {
    values.set(i, points.at[i].exists() ? asked->as<ObjectMap>().scalar(points.at[i].point) : 0);
  });
  return values.take();
}

}  // namespace

void bind_map_questions(nb::module_& m) {
  m.def("map_color", &color);
  m.def("map_scalar", &scalar);
}

}  // namespace etendue::python
