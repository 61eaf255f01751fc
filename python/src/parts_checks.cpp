// Conformance checks and small renders, for the tests of parts that are written in Python.

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "check/conform/conformance.h"
#include "etendue/object_map.h"
#include "etendue/render/render.h"
#include "parts.h"

namespace etendue::python {

namespace {

nb::list conform_quickly(const std::vector<std::string>& classes, int drawn, std::uint64_t seed) {
  conform::Options options;
  options.classes = classes;
  options.effort = conform::Effort::quick;
  options.drawn = drawn;
  options.seed = seed;
  nb::list all;
  for (const conform::Outcome& o : released([&] { return conform::conform(options); })) {
    constexpr const char* results[] = {"passed", "failed", "not tried"};
    all.append(nb::make_tuple(o.class_name, o.check, results[size_t(o.result)], o.detail));
  }
  return all;
}

/// The picture of a job in X Y Z, shape (height, width, 3).
nb::object picture_of(nb::handle object, int threads) {
  const Ref<Job> job = component_as<Job>(object, "a Job");
  auto* const values = new std::vector<double>;
  const nb::capsule owner(values, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  Image image;
  released([&] {
    Render render(job, {.threads = threads});
    render.run();
    image = render.film().develop();
  });
  *values = std::move(image.values);
  const size_t shape[3] = {size_t(image.height), size_t(image.width), image.channels.size()};
  return nb::cast(nb::ndarray<nb::numpy, double>(values->data(), 3, shape, owner), nb::rv_policy::reference);
}

/// Calls a map many times from the library, without the interpreter's lock in between: to measure the time of a call.
double evaluate_map(nb::handle object, int count) {
  const auto map = component_as<ObjectMap>(object, "a map");
  return released([&] {
    double sum = 0;
    SurfacePoint p;
    for (int i = 0; i < count; ++i) {
      p.uv.x = float(i) / float(count);
      sum += double(map->scalar(p));
    }
    return sum;
  });
}

}  // namespace

void bind_part_checks(nb::module_& m) {
  m.def("conform_quickly", &conform_quickly);
  m.def("picture_of", &picture_of);
  m.def("evaluate_map", &evaluate_map);
}

}  // namespace etendue::python
