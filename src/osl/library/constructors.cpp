// Rows of the table: triples from numbers. (Those in a named space are in transforms.cpp and color.cpp.)

#include "choose.h"
#include "parts.h"

namespace etendue::osl {

namespace {

struct FromNumbers {
  template <bool D>
  static void evaluate(const Call& c) {
    using Value = Number<float, D>;
    const Value x = c.get<Value>(0);
    c.give(c.count() == 1 ? make_triple(x, x, x) : make_triple(x, c.get<Value>(1), c.get<Value>(2)));
  }
};

constexpr Row rows[] = {
    {"color color(float f)", with_derivatives<FromNumbers>},
    {"color color(float r, float g, float b)", with_derivatives<FromNumbers>},
    {"point point(float f)", with_derivatives<FromNumbers>},
    {"point point(float x, float y, float z)", with_derivatives<FromNumbers>},
    {"vector vector(float f)", with_derivatives<FromNumbers>},
    {"vector vector(float x, float y, float z)", with_derivatives<FromNumbers>},
    {"normal normal(float f)", with_derivatives<FromNumbers>},
    {"normal normal(float x, float y, float z)", with_derivatives<FromNumbers>},
};

}  // namespace

std::span<const Row> constructor_rows() { return rows; }

}  // namespace etendue::osl
