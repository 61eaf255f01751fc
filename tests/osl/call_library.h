#pragma once
// Calls functions of the shading language's library as a compiled shader would.

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

#include "osl/library/services.h"
#include "osl/library/table.h"

namespace etendue::osl::test {

/// A world in which a test sets what it needs, and reads what was said.
class World : public Services {
 public:
  std::string said, warned, failed;
  Matrix shader = Matrix::identity();

  bool to_common(const String* space, Matrix& out) override {
    if (space->view() == "world")
      out = Matrix::identity();
    else if (space->view() == "shader")
      out = shader;
    else
      return false;
    return true;
  }
  void print(std::string_view text) override { said += text; }
  void warn(std::string_view text, Location) override { warned += text; }
  void error(std::string_view text, Location) override { failed += text; }
  void* allocate(std::size_t size, std::size_t) override {
    memory_.push_back(std::make_unique<std::max_align_t[]>(size / sizeof(std::max_align_t) + 1));
    return memory_.back().get();
  }

 private:
  std::vector<std::unique_ptr<std::max_align_t[]>> memory_;
};

/// One value with its type, and derivatives if it has them.
struct Value {
  Type type;
  bool derivatives = false;
  std::vector<std::byte> bytes;

  Value(float x) { set(Base::float_, x); }                       // NOLINT
  Value(int x) { set(Base::int_, x); }                           // NOLINT
  Value(const char* x) { set(Base::string, intern_string(x)); }  // NOLINT
  Value(const Matrix& x) { set(Base::matrix, x); }               // NOLINT
  Value(Base base, const Triple& x) { set(base, x); }
  Value(const Dual<float>& x) : derivatives(true) { set(Base::float_, x); }  // NOLINT
  Value(Base base, const Dual<Triple>& x) : derivatives(true) { set(base, x); }
  /// Memory for an output or an array, zero.
  explicit Value(const Type& t, bool with_derivatives = false) : type(t), derivatives(with_derivatives) {
    bytes.resize(t.size() * (with_derivatives ? 3 : 1));
  }
  template <class T>
  static Value array(Base base, const std::vector<T>& x) {
    Value v(Type(base, int(x.size())));
    std::memcpy(v.bytes.data(), x.data(), v.bytes.size());
    return v;
  }

  template <class T>
  const T& as() const {
    return *reinterpret_cast<const T*>(bytes.data());
  }
  template <class T>
  const T& at(std::size_t i) const {
    return reinterpret_cast<const T*>(bytes.data())[i];
  }

 private:
  template <class T>
  void set(Base base, const T& x) {
    type = base;
    bytes.resize(sizeof x);
    std::memcpy(bytes.data(), &x, sizeof x);
  }
};

inline const Row* find_row(std::string_view signature) {
  for (const Row& row : library_rows())
    if (row.signature == signature) return &row;
  return nullptr;
}

/// Runs the row of this signature. Outputs among the arguments are written.
inline Value call(World& world, std::string_view signature, const Type& result, bool derivatives,
                  std::vector<Value>& arguments) {
  const Row* row = find_row(signature);
  EXPECT_NE(row, nullptr) << signature;
  Value out(result, derivatives);
  if (!row) return out;
  CallTypes types;
  types.result = {result, derivatives};
  std::vector<void*> addresses;
  for (Value& v : arguments) {
    types.arguments.push_back({v.type, v.derivatives});
    addresses.push_back(v.bytes.data());
  }
  row->choose(types)({addresses.data(), out.bytes.data(), types, world});
  return out;
}

inline Value call(World& world, std::string_view signature, const Type& result, std::vector<Value> arguments) {
  return call(world, signature, result, false, arguments);
}
inline float number(std::string_view signature, std::vector<Value> arguments) {
  World world;
  return call(world, signature, Base::float_, false, arguments).as<float>();
}
inline int integer(std::string_view signature, std::vector<Value> arguments) {
  World world;
  return call(world, signature, Base::int_, false, arguments).as<int>();
}
inline Triple triple(std::string_view signature, std::vector<Value> arguments) {
  World world;
  return call(world, signature, Base::vector, false, arguments).as<Triple>();
}
inline std::string text(std::string_view signature, std::vector<Value> arguments) {
  World world;
  return call(world, signature, Base::string, false, arguments).as<const String*>()->text();
}

}  // namespace etendue::osl::test
