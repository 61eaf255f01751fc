// Spectra and colours.

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "color_uses.h"
#include "etendue/describe/color.h"
#include "etendue/describe/description.h"
#include "question_arrays.h"

namespace etendue::python {

namespace {

/// The spectral function of a Python object: a colour, a number, or a text such as "rgb(1, 0, 0)".
Color color_from(nb::handle object) {
  Member member;
  member.name = "spectrum";
  member.kind = Kind::color;
  const Color color = detail::to_color(to_value(object, &member, calling_line()), member);
  if (!color) throw Error("expects a colour or spectrum, not None");
  return color;
}

nb::object evaluate(nb::handle spectrum, const Array<float>& nm, const std::string& use, bool imaginary) {
  Color color = color_from(spectrum);
  const ColorUse as = color_use(use);
  if (imaginary) {
    color = color->imaginary();
    if (!color) color = flat_spectrum(0);
  }
  const size_t count = nm.size();
  Answers<float> values({count});
  for_all(count, [&](size_t i, Arena&) {
    const float at = nm.data()[i];
    values.set(i, at >= wavelength_low && at <= wavelength_high ? color->at(at, as) : std::numeric_limits<float>::quiet_NaN());
  });
  return values.take();
}

nb::object three(const Xyz& c) {
  Answers<double> values({3});
  values.set(0, c.x);
  values.set(1, c.y);
  values.set(2, c.z);
  return values.take();
}

nb::object xyz_of_spectrum(nb::handle spectrum, const std::string& use, nb::handle illuminant) {
  const Color color = color_from(spectrum), light = illuminant.is_none() ? nullptr : color_from(illuminant);
  return three(to_xyz(*color, color_use(use), light.get()));
}

/// The estimate of a path's colour, for each row of values.
nb::object xyz_of_values(size_t count, const Array<float>& values, const nb::tuple& wavelengths) {
  const WavelengthRows rows = wavelength_rows(wavelengths);
  const Rows<float> given(values);
  Answers<double> xyz({count, 3});
  for_all(count, [&](size_t i, Arena&) {
    const Xyz c = to_xyz(rows.load(given[i], 0), rows.at(i));
    double* const to = xyz[i];
    to[0] = c.x, to[1] = c.y, to[2] = c.z;
  });
  return xyz.take();
}

nb::object observers(const Array<float>& nm) {
  const size_t count = nm.size();
  Answers<double> xyz({count, 3});
  for_all(count, [&](size_t i, Arena&) {
    const Xyz c = observer(nm.data()[i]);
    double* const to = xyz[i];
    to[0] = c.x, to[1] = c.y, to[2] = c.z;
  });
  return xyz.take();
}

nb::object spectra_of_rgb(size_t count, const Array<float>& rgb, const nb::tuple& wavelengths, const std::string& use,
                          const std::string& space) {
  const WavelengthRows rows = wavelength_rows(wavelengths);
  const RgbSpace& in = rgb_space(space);
  const ColorUse as = color_use(use);
  const Rows<float> given(rgb);
  Answers<float> values({count, rows.count()});
  for_all(count, [&](size_t i, Arena&) {
    const float* const c = given[i];
    rows.fill(i, values[i], [&](const Wavelengths& w) { return rgb_spectrum(in, c[0], c[1], c[2], as, w); });
  });
  return values.take();
}

/// The matrix from XYZ to linear RGB, or its inverse, row by row.
nb::object rgb_matrix(const std::string& space, bool from_xyz) {
  const RgbSpace& in = rgb_space(space);
  Answers<double> matrix({3, 3});
  const std::array<double, 9>& values = from_xyz ? in.from_xyz : in.to_xyz;
  std::copy(values.begin(), values.end(), matrix[0]);
  return matrix.take();
}

nb::object transfer(const std::string& name, const Array<double>& values, bool encode) {
  const size_t count = values.size();
  (encode ? encode_transfer : decode_transfer)(name, 0);  // throws Error for an unknown name
  Answers<double> answers({count});
  for_all(count,
          [&](size_t i, Arena&) { answers.set(i, (encode ? encode_transfer : decode_transfer)(name, values.data()[i])); });
  return answers.take();
}

}  // namespace

void bind_spectrum_questions(nb::module_& m) {
  using namespace nb::literals;
  m.def("spectrum_evaluate", &evaluate, "spectrum"_a.none(), "wavelengths"_a, "use"_a, "imaginary"_a);
  m.def("spectrum_xyz", &xyz_of_spectrum, "spectrum"_a.none(), "use"_a, "illuminant"_a.none());
  m.def("wavelengths_xyz", &xyz_of_values);
  m.def("observer", &observers);
  m.def("observer_y_integral", &observer_y_integral);
  m.def("rgb_spectra", &spectra_of_rgb);
  m.def("rgb_matrix", &rgb_matrix);
  m.def("transfer", &transfer);
  m.def("illuminant_names", &illuminant_names);
  m.def("rgb_space_names", &rgb_space_names);
  m.def("transfer_names", &transfer_names);
  m.attr("spectrum_size") = spectrum_size;
  m.attr("wavelength_low") = wavelength_low;
  m.attr("wavelength_high") = wavelength_high;
}

}  // namespace etendue::python
