#pragma once
// Names and what they mean where.
//
// A name is known behind its declaration. A function's body is checked again for each set of array lengths, at a time when more
// is declared than where it stands: it must not see that. So each declaration has a number, counted up, and a body sees of the
// scopes around it what has a lower number than itself.

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "syntax.h"
#include "tree.h"

namespace etendue::osl {

struct Scope;

/// A function that the text declares, for all lengths of arrays.
struct FunctionEntry {
  std::shared_ptr<syntax::FunctionDeclaration> declaration;
  Type result;
  struct Parameter {
    Type type;
    bool output = false;
  };
  std::vector<Parameter> parameters;
  Scope* scope = nullptr;                           ///< in which it is declared
  std::size_t number = 0;                           ///< of its declaration
  bool closure = false;                             ///< a closure's constructor: declared with `builtin`, without a body
  FunctionEntry* definition = nullptr;              ///< of one that was only declared before: where its body is
  std::map<std::vector<int>, Function*> instances;  ///< by the lengths of its unsized parameters
};

struct Scope {
  struct Entry {
    std::size_t number = 0;
    Symbol* symbol = nullptr;
    const StructType* structure = nullptr;
    FunctionEntry* function = nullptr;
  };

  Scope* parent = nullptr;
  /// What is seen of the parent and beyond: entries with lower numbers.
  std::size_t limit = std::size_t(-1);
  std::unordered_map<std::string, std::vector<Entry>> names;

  /// The innermost variable or structure of a name, or function; nullptr if the name is unknown.
  const Entry* find(const std::string& name) const;
  /// All functions of a name, innermost and last declared first. Stops at a variable of the name.
  std::vector<FunctionEntry*> functions(const std::string& name) const;
};

}  // namespace etendue::osl
