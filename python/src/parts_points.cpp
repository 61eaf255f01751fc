#include "parts_points.h"

#include <nanobind/stl/string.h>

#include "etendue/object_map.h"
#include "etendue/scene_object.h"
#include "etendue/shader.h"

namespace etendue::python {

PointArgument::PointArgument(const SurfacePoint& p) : object(nb::cast(PointView{p})) {
  nb::inst_ptr<PointView>(object)->point.media = nullptr;
}

PointArgument::~PointArgument() { nb::inst_ptr<PointView>(object)->point.object = nullptr; }

nb::object attribute_or_call(const PythonPart& part, const MethodName& name) {
  if (!part.defines(name)) return nb::none();
  const Called called{part.declared_class().name, name.text};
  if (!part.self) throw Error(called.text() + ": the Python object has been destroyed");
  nb::object value = nb::steal(PyObject_GetAttr(part.self, name.object()));
  if (value.is_valid() && PyCallable_Check(value.ptr())) value = nb::steal(PyObject_CallNoArgs(value.ptr()));
  if (!value.is_valid()) throw_python_error(called);
  return value;
}

bool truth_of(const PythonPart& part, const MethodName& name, bool otherwise) {
  if (!part.defines(name)) return otherwise;
  const Interpreter lock;
  return to_truth(attribute_or_call(part, name), {part.declared_class().name, name.text});
}

float number_of(const PythonPart& part, const MethodName& name, float otherwise) {
  if (!part.defines(name)) return otherwise;
  const Interpreter lock;
  return float(to_number(attribute_or_call(part, name), {part.declared_class().name, name.text}));
}

namespace {

/// The wavelengths of a call, as the tuple that Python was given, and a use by its name.
Wavelengths wavelengths_from(nb::handle tuple) {
  static const std::string what = "point";
  std::array<double, spectrum_size> given{};
  to_numbers(tuple, given, {what, "color"}, "the wavelengths that the method was given");
  std::array<float, spectrum_size> lambda{}, pdf{};
  for (size_t i = 0; i < lambda.size(); ++i) lambda[i] = float(given[i]), pdf[i] = 1 / (wavelength_high - wavelength_low);
  return {lambda, pdf};
}

constexpr const char* use_names[] = {"reflectance", "radiance", "coefficient"};

ColorUse use_named(const std::string& name) {
  for (int i = 0; i < 3; ++i)
    if (name == use_names[i]) return ColorUse(i);
  throw Error("a colour is used as 'reflectance', 'radiance' or 'coefficient', not as '" + name + "'");
}

nb::object color_of(const PointView& view, nb::handle of, nb::handle tuple, const std::string& use) {
  const Wavelengths wavelengths = wavelengths_from(tuple);
  if (nb::isinstance<Opaque>(of)) {
    const auto* color = nb::cast<const Opaque&>(of).value.as<Color>();
    if (!color) throw Error("expects a map or a colour, not " + nb::cast<const Opaque&>(of).value.kind());
    return tuple_of_spectrum((*color)->evaluate(wavelengths, use_named(use)));
  }
  if (nb::isinstance<nb::float_>(of) || nb::isinstance<nb::int_>(of))
    return tuple_of_spectrum(Spectrum(nb::cast<float>(nb::float_(of))));
  return tuple_of_spectrum(component_as<ObjectMap>(of, "a map or a colour")->color(view.point, wavelengths, use_named(use)));
}

SurfacePoint with_tangents(const SurfacePoint& given) {
  SurfacePoint p = given;
  if (p.dpdu == Vector3{} && p.dpdv == Vector3{} && p.object) p.object->tangents(p);
  return p;
}

nb::object world_position_of(const SurfacePoint& p) {
  const DoublePoint3 at =
      p.object ? world_position(p) : DoublePoint3{double(p.position.x), double(p.position.y), double(p.position.z)};
  return nb::make_tuple(at.x, at.y, at.z);
}

}  // namespace

void bind_part_values(nb::module_& m) {
  using namespace nb::literals;
  const auto get = [](auto read) { return [read](const PointView& v) { return read(v.point); }; };
  nb::class_<PointView>(m, "SurfacePoint", "A point of a surface, as the methods of maps, shaders and emissions get it.")
      .def_prop_ro("uv", get([](const SurfacePoint& p) { return tuple_of(p.uv); }), "Surface coordinates (u, v).")
      .def_prop_ro("position", get([](const SurfacePoint& p) { return tuple_of(p.position); }),
                   "(x, y, z) [m] in rendering space, whose origin is near the camera.")
      .def_prop_ro("world_position", get(world_position_of), "(x, y, z) [m] in the coordinates of the description.")
      .def_prop_ro("object_position", get([](const SurfacePoint& p) { return tuple_of(p.object_position); }),
                   "(x, y, z) [m] in the object's own coordinates: a pattern of these moves with the object.")
      .def_prop_ro("normal", get([](const SurfacePoint& p) { return tuple_of(p.normal); }), "The geometric normal, unit.")
      .def_prop_ro("shading_normal", get([](const SurfacePoint& p) { return tuple_of(p.shading_normal); }),
                   "The interpolated or perturbed normal, unit.")
      .def_prop_ro("object_normal", get([](const SurfacePoint& p) { return tuple_of(p.object_normal); }),
                   "The normal in the object's own coordinates, unit.")
      .def_prop_ro("dpdu", get([](const SurfacePoint& p) { return tuple_of(with_tangents(p).dpdu); }),
                   "The derivative of the position by u [m].")
      .def_prop_ro("dpdv", get([](const SurfacePoint& p) { return tuple_of(with_tangents(p).dpdv); }),
                   "The derivative of the position by v [m].")
      .def_prop_ro("footprint", get([](const SurfacePoint& p) { return p.footprint; }),
                   "The width of the ray's cone [m]; 0: no filtering.")
      .def_prop_ro("footprint_cosine", get([](const SurfacePoint& p) { return p.footprint_cosine; }),
                   "|cos| of the angle between ray and normal.")
      .def_prop_ro("ray_direction", get([](const SurfacePoint& p) { return tuple_of(p.ray_direction); }),
                   "The direction of the ray that hit the point; zero: unknown.")
      .def_prop_ro("time", get([](const SurfacePoint& p) { return p.time; }), "[s]")
      .def_prop_ro("primitive", get([](const SurfacePoint& p) { return p.primitive; }),
                   "The number of the triangle or other part of the object.")
      .def(
          "color", &color_of, "of"_a, "wavelengths"_a, "use"_a = "reflectance",
          "The value of a map, or of a colour, at the wavelengths that the method was given: a tuple with one number for each.")
      .def(
          "scalar",
          [](const PointView& v, nb::handle map) -> float {
            if (nb::isinstance<nb::float_>(map) || nb::isinstance<nb::int_>(map)) return nb::cast<float>(nb::float_(map));
            return component_as<ObjectMap>(map, "a map")->scalar(v.point);
          },
          "of"_a, "The number that a map has here.");
  nb::dict lobes;
  constexpr std::pair<const char*, Lobe> names[] = {
      {"diffuse_reflection", diffuse_reflection},   {"diffuse_transmission", diffuse_transmission},
      {"glossy_reflection", glossy_reflection},     {"glossy_transmission", glossy_transmission},
      {"specular_reflection", specular_reflection}, {"specular_transmission", specular_transmission},
      {"null_scattering", null_scattering}};
  for (const auto& [name, bit] : names) lobes[name] = int(bit);
  m.attr("lobes") = lobes;
}

}  // namespace etendue::python
