// Tone maps that are written in Python: they get the whole picture as an array.

#include <fmt/format.h>

#include <nanobind/ndarray.h>

#include <cmath>

#include "etendue/tone_map.h"
#include "parts_points.h"

namespace etendue::python {

namespace {

const MethodName map_name("map"), clips_name("clips"), local_name("local");

class PythonToneMap final : public PartOf<ToneMap> {
 public:
  using PartOf::PartOf;

  bool clips() const override { return truth_of(*this, clips_name, true); }
  bool local() const override { return truth_of(*this, local_name, false); }

 protected:
  void map(Image& xyz) const override {
    const PartCall call(*this, map_name);
    auto* const given = new std::vector<double>(xyz.values);  // Python may change it, and keep it
    const nb::capsule owner(given, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
    const size_t shape[3] = {size_t(xyz.height), size_t(xyz.width), 3};
    const nb::object picture =
        nb::cast(nb::ndarray<nb::numpy, double>(given->data(), 3, shape, owner), nb::rv_policy::reference);
    const nb::object returned = call(picture);
    const std::string wanted = fmt::format("an array of shape ({}, {}, 3): X Y Z of each pixel", xyz.height, xyz.width);
    nb::ndarray<const double, nb::numpy, nb::c_contig, nb::ndim<3>> mapped;
    if (!nb::ndarray_check(returned) || !nb::try_cast(returned, mapped) || mapped.shape(0) != shape[0] ||
        mapped.shape(1) != shape[1] || mapped.shape(2) != shape[2])
      call.called.refuse(returned, wanted);
    take(xyz, mapped.data(), call.called);
  }

 private:
  /// Numbers that are not finite are refused, except in pixels that were not finite before.
  static void take(Image& xyz, const double* mapped, const Called& called) {
    for (size_t i = 0; i < xyz.values.size(); i += 3) {
      bool was_finite = true, is_finite = true;
      for (size_t c = 0; c < 3; ++c) {
        was_finite = was_finite && std::isfinite(xyz.values[i + c]);
        is_finite = is_finite && std::isfinite(mapped[i + c]);
      }
      if (was_finite && !is_finite)
        throw Error(
            fmt::format("{} returned ({}, {}, {}) for X Y Z = ({}, {}, {}), in column {} of row {}; it must return "
                        "finite numbers",
                        called.text(), mapped[i], mapped[i + 1], mapped[i + 2], xyz.values[i], xyz.values[i + 1],
                        xyz.values[i + 2], i / 3 % size_t(xyz.width), i / 3 / size_t(xyz.width)));
      for (size_t c = 0; c < 3; ++c) xyz.values[i + c] = mapped[i + c];
    }
  }
};

}  // namespace

PartInterface tone_map_interface() {
  return {"ToneMap",
          make_part<PythonToneMap>,
          {{"map", "self, xyz", "X Y Z of all pixels as they are shown, from X Y Z: arrays of shape (height, width, 3)"},
           {"clips", "self", "whether the result is clipped to [0, 1]; True by default"},
           {"local", "self", "whether the result of a pixel depends on its neighbours; False by default"},
           prepare_method},
          {{"map"}}};
}

}  // namespace etendue::python
