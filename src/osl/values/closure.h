#pragma once
// ClosureNode: a closure's value, a tree of sums and products over components, in the memory of the point that is shaded.
//
// `0.5 * diffuse(N) + emission()` is a sum of a product and a component. The null pointer is the closure that does nothing.

#include <cstddef>
#include <vector>

#include "etendue/core/spectrum.h"
#include "interned_string.h"
#include "triple.h"
#include "type.h"

namespace etendue::osl {

/// What a call of a closure's constructor makes, the same for each run of the call: its name, and its arguments in order.
struct ClosureShape {
  struct Argument {
    const String* keyword = nullptr;  ///< of an optional argument, `"label", "coat"`; null for one by position
    Type type;
    std::size_t offset = 0;  ///< [bytes] in ClosureComponent::arguments
  };

  const String* name = nullptr;
  int known = -1;  ///< its index in closures() (library/closures.h), or -1 if the shader declares it by itself
  std::vector<Argument> arguments;
  std::size_t size = 0;  ///< of all arguments [bytes]

  /// Appends an argument behind the others, with natural alignment.
  void add(const Type&, const String* keyword = nullptr);
  /// The optional argument of this name, or null; of several, the last counts.
  const Argument* find(const String* keyword) const;
};

struct ClosureNode {
  enum class Kind : unsigned char { component, sum, product };
  Kind kind;
};

struct ClosureComponent : ClosureNode {
  const ClosureShape* shape = nullptr;
  const std::byte* arguments = nullptr;  ///< aligned to 8 bytes

  template <class T>
  const T& argument(std::size_t i) const {
    return *reinterpret_cast<const T*>(arguments + shape->arguments[i].offset);
  }
};

/// Neither a nor b is null.
struct ClosureSum : ClosureNode {
  const ClosureNode *a = nullptr, *b = nullptr;
};

/// The closure is not null. The weight of a float is that of the color with three equal components. With the spectral extension
/// the closure is multiplied by `spectrum`, too, unless that is null.
struct ClosureProduct : ClosureNode {
  Triple weight{1};
  const Spectrum* spectrum = nullptr;
  const ClosureNode* closure = nullptr;
};

/// As printf's %s shows a closure: "(0.5, 0.5, 0.5) * diffuse ((0, 0, 1))", one component per line.
std::string to_text(const ClosureNode*);

}  // namespace etendue::osl
