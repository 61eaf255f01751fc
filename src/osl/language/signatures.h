#pragma once
// The library's functions and closures as the checker needs them: by name, with their types instead of texts.

#include <string>
#include <vector>

#include "osl/library/closures.h"
#include "tree.h"

namespace etendue::osl {

/// A function that a call may mean: one row of the library for one set of types, or a closure's constructor.
struct Signature {
  struct Parameter {
    Type type;
    bool any = false;  ///< of any type
    bool output = false;
  };
  std::string name;
  Type result;
  std::vector<Parameter> parameters;
  bool variadic = false, output_variadic = false;
  const Row* row = nullptr;                            ///< null: a closure
  int closure = -1;                                    ///< index in closures(), of a closure
  std::vector<std::pair<std::string, Type>> keywords;  ///< of a closure, besides "label"
};

/// Those of a name, in the order of the table; empty if there are none. Families of types are spelled out.
const std::vector<Signature>& library_signatures(const std::string& name);

/// The simple type of a name, void for "void" and other names.
Type simple_type(const std::string& name);

}  // namespace etendue::osl
