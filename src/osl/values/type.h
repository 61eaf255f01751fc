#pragma once
// Type: the types of the language, and how their values lie in memory.
//
// int and float take 4 bytes, color, point, vector and normal three floats, matrix sixteen floats in rows, string a
// `const String*` (interned_string.h), a closure a `const ClosureNode*` (closure.h; null is the closure that does nothing),
// spectrum spectrum_size floats. Arrays lie element after element, structures field after field with natural alignment.
//
// A value with derivatives is three such blocks, one directly behind the other: the value, its derivative with respect to the
// picture's x and that with respect to y (per pixel). Only types made of floats have derivatives.

#include <cstddef>
#include <string>
#include <vector>

namespace etendue::osl {

enum class Base : unsigned char { void_, int_, float_, color, point, vector, normal, matrix, string, structure, spectrum };

struct StructType;

struct Type {
  static constexpr int unsized = -1;  ///< `float a[]`: an array that takes the length of the argument

  Base base = Base::void_;
  bool closure = false;  ///< `closure color`: base is color
  int array = 0;         ///< 0: no array; unsized; else the number of elements
  const StructType* structure = nullptr;

  constexpr Type() = default;
  constexpr Type(Base b, int array_ = 0) : base(b), array(array_) {}  // NOLINT: a base is a type
  bool operator==(const Type&) const = default;

  constexpr bool is_array() const { return array != 0; }
  constexpr bool is_closure() const { return closure; }
  constexpr bool is_structure() const { return base == Base::structure; }
  /// color, point, vector or normal, not an array.
  constexpr bool is_triple() const { return !array && triple_based(); }
  constexpr bool is_float() const { return !array && base == Base::float_; }
  constexpr bool is_int() const { return !array && base == Base::int_; }
  constexpr bool is_string() const { return !array && base == Base::string; }
  constexpr bool is_matrix() const { return !array && base == Base::matrix; }
  constexpr bool is_void() const { return base == Base::void_; }
  constexpr bool triple_based() const { return !closure && base >= Base::color && base <= Base::normal; }
  /// Whether values of the type, or of its elements, consist of floats, so that they may have derivatives.
  constexpr bool float_based() const {
    return !closure && ((base >= Base::float_ && base <= Base::matrix) || base == Base::spectrum);
  }

  constexpr Type element() const {
    Type t = *this;
    t.array = 0;
    return t;
  }
  constexpr Type as_array(int length) const {
    Type t = *this;
    t.array = length;
    return t;
  }
  static constexpr Type closure_color(int array = 0) {
    Type t(Base::color, array);
    t.closure = true;
    return t;
  }
  static constexpr Type of(const StructType* s, int array = 0) {
    Type t(Base::structure, array);
    t.structure = s;
    return t;
  }

  /// Number of elements: 1 if it is no array. An unsized array has 0.
  constexpr int elements() const { return array == 0 ? 1 : (array < 0 ? 0 : array); }
  /// Floats per element: 1, 3, 16 or spectrum_size; 0 if it does not consist of floats.
  int floats() const;
  /// The size of one value [bytes], without derivatives; 0 for void and unsized arrays.
  std::size_t size() const;
  std::size_t element_size() const { return element().size(); }
  std::size_t alignment() const;
  /// As a shader writes it: "float", "color[3]", "closure color", the structure's name.
  std::string name() const;
};

struct Field {
  std::string name;
  Type type;
  std::size_t offset = 0;  ///< [bytes] from the beginning of the structure
};

struct StructType {
  std::string name;
  std::vector<Field> fields;
  std::size_t size = 0, alignment = 1;  ///< [bytes]

  /// Appends a field behind the others, with natural alignment.
  void add(std::string field, const Type&);
  /// nullptr if there is none.
  const Field* find(std::string_view field) const;
};

}  // namespace etendue::osl
