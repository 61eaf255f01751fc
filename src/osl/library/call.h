#pragma once
// Call: the arguments with which a function of the library is called.

#include <cstddef>
#include <vector>

#include "etendue/core/error.h"
#include "osl/values/dual.h"
#include "osl/values/interned_string.h"
#include "osl/values/type.h"

namespace etendue::osl {

class Services;

/// What is the same for each run of a call: the types, known when the shader is compiled. The object lives as long as the code.
struct CallTypes {
  struct Argument {
    Type type;
    /// The value has the two blocks of derivatives behind it (type.h). Input arguments without them are constant over the
    /// picture; output arguments without them take no derivatives.
    bool derivatives = false;
  };

  Argument result;  ///< type void: Call::result is not used. `derivatives`: the function writes the result's derivatives, too.
  std::vector<Argument> arguments;
  Location place;  ///< of the call in the shader's file, for messages
};

struct Call {
  void* const* arguments;  ///< the address of each argument's value
  void* result;            ///< the address of the result, which is no argument's
  const CallTypes& types;
  Services& services;

  int count() const { return int(types.arguments.size()); }
  const Type& type(int i) const { return types.arguments[std::size_t(i)].type; }
  bool derivatives(int i) const { return types.arguments[std::size_t(i)].derivatives; }

  template <class T>
  T& at(int i) const {
    return *static_cast<T*>(arguments[i]);
  }
  const String* string(int i) const { return at<const String*>(i); }

  /// The i-th input argument as T: int, float, Triple, Matrix, const String*, or Dual of one of them, with zero derivatives if
  /// the argument has none.
  template <class T>
  T get(int i) const {
    if constexpr (is_dual<T>) {
      using Part = decltype(T::value);
      const Part* p = static_cast<const Part*>(arguments[i]);
      return derivatives(i) ? T(p[0], p[1], p[2]) : T(p[0]);
    } else {
      return at<T>(i);
    }
  }

  /// Sets the result, with derivatives if it takes them: a value that is not dual has zero derivatives.
  template <class T>
  void give(const T& v) const {
    store(result, types.result.derivatives, v);
  }
  /// Sets the i-th argument, which is an output.
  template <class T>
  void give(int i, const T& v) const {
    store(arguments[i], derivatives(i), v);
  }

 private:
  template <class T>
  static void store(void* to, bool derivatives, const Dual<T>& v) {
    T* p = static_cast<T*>(to);
    p[0] = v.value;
    if (derivatives) p[1] = v.dx, p[2] = v.dy;
  }
  template <class T>
  static void store(void* to, bool derivatives, const T& v) {
    T* p = static_cast<T*>(to);
    p[0] = v;
    if (derivatives) p[1] = p[2] = T{};
  }
};

using Evaluate = void (*)(const Call&);

}  // namespace etendue::osl
