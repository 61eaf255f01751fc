#include "conversions.h"

namespace etendue::osl {

bool equivalent(const Type& a, const Type& b) { return a == b || (a.triple_based() && b.triple_based() && a.array == b.array); }

bool assignable(const Type& to, const Type& from) {
  if (to.is_void() || from.is_void()) return false;
  if (to.is_array() || from.is_array()) {
    if (!to.is_array() || !from.is_array() || !equivalent(to.element(), from.element())) return false;
    return to.array == Type::unsized || from.array == Type::unsized || to.array >= from.array;
  }
  if (equivalent(to, from)) return true;
  if (to.is_closure() || from.is_closure() || to.is_structure() || from.is_structure()) return false;
  if (from.is_int()) return to.is_float() || to.is_triple() || to.is_matrix() || to.base == Base::spectrum;
  if (from.is_float()) return to.is_triple() || to.is_matrix() || to.base == Base::spectrum;
  return false;
}

bool castable(const Type& to, const Type& from) {
  return assignable(to, from) || (to.is_int() && from.is_float() && !from.is_closure());
}

int fit(const Type& parameter, const Type& argument) {
  if (parameter == argument) return exact_fit;
  if (parameter.is_float() && argument.is_int()) return number_fit;
  if (parameter.array == Type::unsized && argument.is_array() && parameter.element() == argument.element()) return array_fit;
  if (parameter.is_array() || argument.is_array()) {
    const bool lengths = parameter.array == argument.array || (parameter.array == Type::unsized && argument.is_array()) ||
                         (argument.array == Type::unsized && parameter.is_array());
    return lengths && equivalent(parameter.element(), argument.element()) ? conversion_fit : 0;
  }
  if (!assignable(parameter, argument)) return 0;
  const bool spatial =
      parameter.is_triple() && parameter.base != Base::color && argument.is_triple() && argument.base != Base::color;
  return spatial ? kind_fit : conversion_fit;
}

int rank_of_result(const Type& t) {
  if (t.is_array()) return 13;
  if (t.is_closure()) return 9;
  switch (t.base) {
    case Base::float_: return 1;
    case Base::int_: return 2;
    case Base::color: return 3;
    case Base::vector: return 4;
    case Base::point: return 5;
    case Base::normal: return 6;
    case Base::matrix: return 7;
    case Base::string: return 8;
    case Base::structure: return 10;
    case Base::void_: return 11;
    case Base::spectrum: return 12;
  }
  return 14;
}

}  // namespace etendue::osl
