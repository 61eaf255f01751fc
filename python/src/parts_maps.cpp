// Maps that are written in Python.

#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "parts_points.h"

namespace etendue::python {

namespace {

const MethodName scalar_name("scalar"), rgb_name("rgb"), color_name("color"), largest_name("largest");

/// A class defines `scalar`, `rgb` or `color`; what it lacks follows from what it has.
class PythonMap final : public PartOf<ObjectMap> {
 public:
  using PartOf::PartOf;

  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    if (defines(color_name)) return python_color(p, w, use);
    if (defines(rgb_name)) {
      const std::array<double, 3> c = rgb(p);
      static const RgbSpace& srgb = rgb_space("srgb");
      return rgb_spectrum(srgb, float(c[0]), float(c[1]), float(c[2]), use, w);
    }
    const float value = scalar(p);
    return Spectrum(use == ColorUse::reflectance ? clamp(value, 0, 1) : value);
  }

  float scalar(const SurfacePoint& p) const override {
    if (defines(scalar_name)) {
      const PartCall call(*this, scalar_name);
      return float(to_number(call(PointArgument(p)), call.called));
    }
    if (defines(rgb_name)) {
      const std::array<double, 3> c = rgb(p);
      return float((c[0] + c[1] + c[2]) / 3);
    }
    return python_color(p, whole_range(), ColorUse::coefficient).average();
  }

  float largest() const override { return number_of(*this, largest_name, 0); }

 private:
  std::array<double, 3> rgb(const SurfacePoint& p) const {
    const PartCall call(*this, rgb_name);
    std::array<double, 3> c{};
    to_numbers(call(PointArgument(p)), c, call.called, "three finite numbers: linear sRGB");
    return c;
  }

  Spectrum python_color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const {
    static const MethodName names[] = {MethodName("reflectance"), MethodName("radiance"), MethodName("coefficient")};
    std::array<float, spectrum_size> lambda;
    for (int i = 0; i < spectrum_size; ++i) lambda[size_t(i)] = w[i];
    const PartCall call(*this, color_name);
    return to_spectrum(call(PointArgument(p), tuple_of_numbers(lambda), nb::borrow(names[size_t(use)].object())), call.called);
  }

  /// Wavelengths over all of the visible range, for the mean of a colour.
  static const Wavelengths& whole_range() {
    static const Wavelengths all = [] {
      std::array<float, spectrum_size> lambda{}, pdf{};
      for (int i = 0; i < spectrum_size; ++i) {
        lambda[size_t(i)] = lerp((float(i) + 0.5f) / spectrum_size, wavelength_low, wavelength_high);
        pdf[size_t(i)] = 1 / (wavelength_high - wavelength_low);
      }
      return Wavelengths(lambda, pdf);
    }();
    return all;
  }
};

}  // namespace

PartInterface map_interface() {
  return {"ObjectMap",
          make_part<PythonMap>,
          {{"scalar", "self, point", "one number; a colour's mean over wavelengths or channels"},
           {"rgb", "self, point", "three numbers: linear sRGB"},
           {"color", "self, point, wavelengths, use",
            "a number for all wavelengths, or one for each of them [nm]; use is 'reflectance' (a fraction in [0, 1]), "
            "'radiance' or "
            "'coefficient'"},
           {"largest", "self", "the largest number in the map, if any is above 1"},
           prepare_method},
          {{"scalar", "rgb", "color"}}};
}

}  // namespace etendue::python
