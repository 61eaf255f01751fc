#pragma once
// Nodes: a shader in the form in which it is interpreted. The typed tree is translated once, when a group is built, to a tree
// of small objects that know the addresses of their operands.
//
// The order of evaluation is that of the reference implementation:
//  - operands from left to right, each completely before the next; a variable is read when the operation is done, not when its
//    operand is reached, so `i + i++` adds the new value;
//  - of `a = b` and `a += b` first the indices in a, then b, then the assignment;
//  - arguments of a function from left to right, then its body; arguments are references, so a function that writes its output
//    parameter changes an input parameter for which the same variable was passed;
//  - &&, || and ?: evaluate only what they need;
//  - a parameter that is connected is fetched when it is first read: then the layer above runs, if it did not run before;
//  - defaults of parameters are evaluated in their order before the layer's body.

#include <cstring>
#include <memory>
#include <type_traits>
#include <vector>

#include "code.h"
#include "memory_layout.h"
#include "run_state.h"

namespace etendue::osl {

/// What a statement did: whether the next one follows.
enum class Flow : unsigned char { next, break_loop, continue_loop, leave, exit };

/// Thrown by exit() in a function that is called within an expression; caught where the layer began.
struct ExitLayer {};
/// Thrown when the renderer's abort flag was set.
struct RunAborted {};

class Node {
 public:
  virtual ~Node() = default;
  /// Computes an expression's value and leaves it in the place that was chosen when the node was made; or runs a statement.
  virtual Flow run(RunState&) const = 0;
  /// Makes code that does the same.
  virtual void emit(Code&) const = 0;
};

/// Finds a place that depends on computed indices.
class Locator {
 public:
  virtual ~Locator() = default;
  virtual std::byte* locate(RunState&) const = 0;
  virtual Word emit(Code&) const = 0;
};

/// An expression, translated: `compute` (unless null) leaves the value in `memory`.
struct Value {
  Memory memory;
  const Node* compute = nullptr;

  const Type& type() const { return memory.type; }
  void evaluate(RunState& run) const {
    if (compute) compute->run(run);
  }
  void emit(Code& code) const {
    if (compute) compute->emit(code);
  }
};

/// A reference, translated: at `memory`, or, with a locator, wherever that finds it (memory.offset is then not used). `fetch`
/// must run before.
struct Place {
  Memory memory;
  const Locator* locator = nullptr;
  const Node* fetch = nullptr;

  std::byte* find(RunState& run) const { return locator ? locator->locate(run) : run.memory + memory.offset; }
  Spot emit(Code& code) const { return locator ? Spot{0, locator->emit(code)} : Spot{memory.offset, {}}; }
};

// Reading and writing of values.

template <class T>
T& value_at(RunState& run, std::uint32_t offset) {
  return *reinterpret_cast<T*>(run.memory + offset);
}
template <class T>
const T& load(RunState& run, const Memory& m) {
  return *reinterpret_cast<const T*>(run.memory + m.offset);
}
template <class T>
Dual<T> load_dual(RunState& run, const Memory& m) {
  const std::byte* at = run.memory + m.offset;
  const T& value = *reinterpret_cast<const T*>(at);
  if (!m.stride) return Dual<T>(value);
  return {value, *reinterpret_cast<const T*>(at + m.stride), *reinterpret_cast<const T*>(at + 2 * std::size_t(m.stride))};
}
template <class T>
void store(RunState& run, const Memory& m, const T& value) {
  std::byte* at = run.memory + m.offset;
  *reinterpret_cast<T*>(at) = value;
  if (!m.stride) return;
  *reinterpret_cast<T*>(at + m.stride) = T{};
  *reinterpret_cast<T*>(at + 2 * std::size_t(m.stride)) = T{};
}
template <class T>
void store(RunState& run, const Memory& m, const Dual<T>& v) {
  std::byte* at = run.memory + m.offset;
  *reinterpret_cast<T*>(at) = v.value;
  if (!m.stride) return;
  *reinterpret_cast<T*>(at + m.stride) = v.dx;
  *reinterpret_cast<T*>(at + 2 * std::size_t(m.stride)) = v.dy;
}

/// Copies a value and its derivatives; those that the source does not have are zero.
inline void copy_value(std::byte* to, std::uint32_t to_stride, const std::byte* from, std::uint32_t from_stride,
                       std::size_t size) {
  std::memmove(to, from, size);
  if (!to_stride) return;
  for (int i = 1; i < 3; ++i) {
    if (from_stride)
      std::memmove(to + i * std::size_t(to_stride), from + i * std::size_t(from_stride), size);
    else
      std::memset(to + i * std::size_t(to_stride), 0, size);
  }
}

/// Owns the nodes of a group.
class NodeStore {
 public:
  static constexpr std::size_t limit = 2'000'000;  ///< nodes; each call of a function has nodes of its own

  template <class T, class... Arguments>
  const T* make(Arguments&&... arguments) {
    if (nodes_.size() + locators_.size() >= limit) throw Error("the shader's functions, each call counted, are too large");
    auto made = std::make_unique<T>(std::forward<Arguments>(arguments)...);
    const T* result = made.get();
    if constexpr (std::is_base_of_v<Node, T>)
      nodes_.push_back(std::move(made));
    else
      locators_.push_back(std::move(made));
    return result;
  }

  std::size_t size() const { return nodes_.size() + locators_.size(); }

 private:
  std::vector<std::unique_ptr<const Node>> nodes_;
  std::vector<std::unique_ptr<const Locator>> locators_;
};

}  // namespace etendue::osl
