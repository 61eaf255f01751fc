#pragma once
// LayerBuilder: translates one shader of a group from its typed tree to nodes.

#include <string>
#include <vector>

#include "nodes.h"
#include "osl/language/tree.h"

namespace etendue::osl {

/// What the group has decided about a shader's symbol before the layer is built, by Symbol::index.
struct SymbolPlan {
  Type type;  ///< with the length of an unsized array
  bool derivatives = false;
  const Node* fetch = nullptr;  ///< of a parameter that is connected: brings the value from upstream
  bool constant = false;        ///< a parameter whose value the group states
  Memory memory;                ///< of a parameter, or a global
  bool placed = false;          ///< whether `memory` is set
  int connected = 0;            ///< as isconnected() says it
  std::vector<std::pair<std::uint32_t, int>> connected_parts;  ///< likewise, of fields: offset [bytes] and value
};

class LayerBuilder {
 public:
  LayerBuilder(const Shader&, std::vector<SymbolPlan>, MemoryLayout&, NodeStore&);

  /// The whole body. Throws Error if it becomes too large.
  const Node* body();
  /// Evaluates the default of a parameter into its place.
  const Node* default_value(const Symbol& parameter);

 private:
  /// Where a symbol is at this call of a function.
  struct Binding {
    Place place;
    bool bound = false;
  };
  /// The function whose body is translated now.
  struct Frame {
    Memory result;
  };

  // expressions.cpp
  Value value(const Expression&, bool derivatives, const Memory* into = nullptr);
  /// The same in one piece of memory with its derivatives, as library functions take it.
  Value contiguous(const Value&);
  Place place(const Expression&);
  Place variable(const Symbol&);
  Place element(const Expression&, int operand, const Place& base, int count, const Type& of, std::uint32_t step);
  Value read(const Place&, bool derivatives);
  Value assignment(const Expression&, bool derivatives);
  Value compound_assignment(const Expression&, const Place&, bool derivatives);
  Value increment(const Expression&);
  Value conditional(const Expression&, bool derivatives);
  Value aggregate(const Expression&, bool derivatives);
  Value short_circuit(const Expression&);
  Value binary(const Expression&, bool derivatives, const Memory* into);
  Value constant_int(int);
  Value constant(const Constant&);
  bool is_constant(const Expression&);
  int connection_of(const Expression&);

  // calls.cpp
  Value call(const Expression&, bool derivatives);
  Value library_call(const Expression&, bool derivatives, const Memory* into);
  Value closure(const Expression&);
  Value triple(const Expression&, bool derivatives, const Memory* into);

  // statements.cpp
  const Node* statement(const Statement&);
  const Node* sequence(const std::vector<StatementPointer>&);
  const Node* declaration(const Statement&);

  Memory result_memory(const Type&, bool derivatives, const Memory* into);
  bool wants(const Symbol& symbol) const { return plans_[std::size_t(symbol.index)].derivatives; }

  const Shader& shader_;
  std::vector<SymbolPlan> plans_;
  std::vector<Binding> bindings_;
  MemoryLayout& layout_;
  NodeStore& nodes_;
  std::vector<Frame> calls_;
};

}  // namespace etendue::osl
