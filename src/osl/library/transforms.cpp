// Rows of the table: matrices, and transforms between coordinate systems.

#include <fmt/format.h>

#include "choose.h"
#include "parts.h"
#include "spaces.h"

namespace etendue::osl {

bool matrix_between(const Call& c, const String* from, const String* to, Matrix& out) {
  static const String* const common = intern_string("common");
  out = Matrix::identity();
  if (from == to) return true;
  const auto unknown = [&](const String* name) {
    if (c.services.unknown_space_is_error())
      c.services.error(fmt::format("Unknown transformation \"{}\"", name->text()), c.types.place);
    out = Matrix::identity();
    return false;
  };
  Matrix first = Matrix::identity(), second = Matrix::identity();
  if (from != common && !c.services.to_common(from, first)) return unknown(from);
  if (to != common && !c.services.from_common(to, second)) return unknown(to);
  out = from == common ? second : (to == common ? first : first * second);
  return true;
}

Triple transform_as(Base kind, const Matrix& m, const Triple& p) {
  if (kind == Base::point) return transform_point(m, p);
  return kind == Base::normal ? transform_normal(m, p) : transform_vector(m, p);
}

Dual<Triple> transform_as(Base kind, const Matrix& m, const Dual<Triple>& p) {
  if (kind != Base::point) return {transform_as(kind, m, p.value), transform_as(kind, m, p.dx), transform_as(kind, m, p.dy)};
  // The quotient rule for the division by the fourth component w.
  Dual<float> w(m.m[3][3]);
  for (int i = 0; i < 3; ++i) w = w + Dual<float>(m.m[i][3]) * p[i];
  Dual<Triple> r(transform_vector(m, p.value) + Triple(m.m[3][0], m.m[3][1], m.m[3][2]), transform_vector(m, p.dx),
                 transform_vector(m, p.dy));
  return w.value == 1 && w.dx == 0 && w.dy == 0 ? r : r / make_triple(w, w, w);
}

namespace {

struct TransformByMatrix {
  template <bool D>
  static void evaluate(const Call& c) {
    c.give(transform_as(c.type(1).base, c.at<Matrix>(0), c.get<Number<Triple, D>>(1)));
  }
};

/// transform(from, to, p), transform(to, p)
struct TransformBySpaces {
  template <bool D>
  static void evaluate(const Call& c) {
    static const String* const common = intern_string("common");
    const bool both = c.count() > 2;
    const int p = both ? 2 : 1;
    Matrix m;
    const bool known = matrix_between(c, both ? c.string(0) : common, c.string(both ? 1 : 0), m);
    const auto value = c.get<Number<Triple, D>>(p);
    c.give(known ? transform_as(c.type(p).base, m, value) : value);
  }
};

/// point("space", x, y, z), point("space", f): the result is in common space.
struct PointIn {
  template <bool D>
  static void evaluate(const Call& c) {
    using Value = Number<float, D>;
    static const String* const common = intern_string("common");
    Matrix m;
    matrix_between(c, c.string(0), common, m);
    const Value x = c.get<Value>(1), y = c.count() > 2 ? c.get<Value>(2) : x, z = c.count() > 2 ? c.get<Value>(3) : x;
    c.give(transform_as(c.types.result.type.base, m, make_triple(x, y, z)));
  }
};

Matrix from_numbers(const Call& c, int first) {
  if (c.count() == first + 1) return Matrix::diagonal(c.at<float>(first));
  Matrix m;
  for (int i = 0; i < 16; ++i) m.m[i / 4][i % 4] = c.at<float>(first + i);
  return m;
}

void plain_matrix(const Call& c) { c.give(from_numbers(c, 0)); }

void matrix_in(const Call& c) {
  static const String* const common = intern_string("common");
  Matrix m;
  matrix_between(c, c.string(0), common, m);
  c.give(m * from_numbers(c, 1));  // in this order, as the reference implementation has it
}

void matrix_from_to(const Call& c) {
  Matrix m;
  matrix_between(c, c.string(0), c.string(1), m);
  c.give(m);
}

/// int getmatrix(from, to, output m), int getmatrix(from, output m): an unknown name leaves m as it is.
void get_matrix(const Call& c) {
  static const String* const common = intern_string("common");
  const bool both = c.count() > 2;
  Matrix m;
  const bool known = matrix_between(c, c.string(0), both ? c.string(1) : common, m);
  if (known) c.give(both ? 2 : 1, m);
  c.give(int(known));
}

void determinant_of(const Call& c) { c.give(determinant(c.at<Matrix>(0))); }
void transposed(const Call& c) { c.give(transpose(c.at<Matrix>(0))); }

struct Unit {
  const char* name;
  float size;
};

/// A unit of length [m] or a coordinate system's scale: the cube root of its volume. False if it is no length.
bool length_unit(const Call& c, const String* name, float& size) {
  static constexpr Unit units[] = {{"mm", 0.001f},  {"cm", 0.01f},   {"m", 1},         {"km", 1000},
                                   {"in", 0.0254f}, {"ft", 0.3048f}, {"mi", 1609.344f}};
  for (const Unit& u : units)
    if (name->view() == u.name) {
      size = u.size;
      return true;
    }
  Matrix m = Matrix::identity();
  if (name->view() != "common" && !c.services.to_common(name, m)) return false;
  m.m[3][0] = m.m[3][1] = m.m[3][2] = 0;
  size = std::cbrt(std::abs(determinant(m))) * c.services.metres_per_unit();
  return true;
}

/// A unit of time [s]; "common" is also one of length.
bool time_unit(const Call& c, const String* name, float& size) {
  if (name->view() == "s")
    size = 1;
  else if (name->view() == "frames")
    size = c.services.seconds_per_frame();
  else if (name->view() == "common")
    size = c.services.seconds_per_time();
  else
    return false;
  return true;
}

/// float transformu(to, x), float transformu(from, to, x)
struct TransformUnits {
  template <bool D>
  static void evaluate(const Call& c) {
    static const String* const common = intern_string("common");
    const bool both = c.count() > 2;
    const String* from = both ? c.string(0) : common;
    const String* to = c.string(both ? 1 : 0);
    const auto x = c.get<Number<float, D>>(both ? 2 : 1);
    float a = 1, b = 1;
    const bool time = time_unit(c, from, a) && time_unit(c, to, b) && (from != common || to != common);
    if (!time && !(length_unit(c, from, a) && length_unit(c, to, b))) {
      c.services.error(fmt::format("transformu: cannot convert from \"{}\" to \"{}\": not two units of length or two of time",
                                   from->text(), to->text()),
                       c.types.place);
      return c.give(x);
    }
    c.give(Number<float, D>(safe_divide(a, b)) * x);
  }
};

constexpr Derivatives passed = Derivatives::passed, none = Derivatives::none;

constexpr Row rows[] = {
    {"PTYPE transform(matrix to, PTYPE p)", with_derivatives<TransformByMatrix>},
    {"PTYPE transform(string from, string to, PTYPE p)", with_derivatives<TransformBySpaces>, passed, 0, nullptr, false},
    {"PTYPE transform(string to, PTYPE p)", with_derivatives<TransformBySpaces>, passed, 0, nullptr, false},
    {"float transformu(string to, float x)", with_derivatives<TransformUnits>, passed, 0, nullptr, false},
    {"float transformu(string from, string to, float x)", with_derivatives<TransformUnits>, passed, 0, nullptr, false},
    {"point point(string space, float f)", with_derivatives<PointIn>, passed, 0, nullptr, false},
    {"point point(string space, float x, float y, float z)", with_derivatives<PointIn>, passed, 0, nullptr, false},
    {"vector vector(string space, float f)", with_derivatives<PointIn>, passed, 0, nullptr, false},
    {"vector vector(string space, float x, float y, float z)", with_derivatives<PointIn>, passed, 0, nullptr, false},
    {"normal normal(string space, float f)", with_derivatives<PointIn>, passed, 0, nullptr, false},
    {"normal normal(string space, float x, float y, float z)", with_derivatives<PointIn>, passed, 0, nullptr, false},
    {"matrix matrix(float f)", always<plain_matrix>, none},
    {"matrix matrix(float m00, float m01, float m02, float m03, float m10, float m11, float m12, float m13, float m20, float "
     "m21, "
     "float m22, float m23, float m30, float m31, float m32, float m33)",
     always<plain_matrix>, none},
    {"matrix matrix(string space, float f)", always<matrix_in>, none, 0, nullptr, false},
    {"matrix matrix(string space, float m00, float m01, float m02, float m03, float m10, float m11, float m12, float m13, "
     "float m20, "
     "float m21, float m22, float m23, float m30, float m31, float m32, float m33)",
     always<matrix_in>, none, 0, nullptr, false},
    {"matrix matrix(string from, string to)", always<matrix_from_to>, none, 0, nullptr, false},
    {"int getmatrix(string from, string to, output matrix m)", always<get_matrix>, none, 0, nullptr, false},
    {"int getmatrix(string from, output matrix m)", always<get_matrix>, none, 0, nullptr, false},
    {"float determinant(matrix m)", always<determinant_of>, none},
    {"matrix transpose(matrix m)", always<transposed>, none},
};

}  // namespace

std::span<const Row> transform_rows() { return rows; }

}  // namespace etendue::osl
