#pragma once
// Nodes between layers: values that come from layers above, and from the geometry.

#include "nodes.h"

namespace etendue::osl {

/// Brings a connected parameter's value, once in a run: runs the layers above if they did not run, then copies.
class FetchParameter final : public Node {
 public:
  struct Transfer {
    int layer;
    const Node* copy;
  };
  FetchParameter(std::uint32_t flag, std::vector<Transfer> transfers) : flag_(flag), transfers_(std::move(transfers)) {}
  Flow run(RunState&) const override;
  void emit(Code&) const override;

 private:
  std::uint32_t flag_;
  std::vector<Transfer> transfers_;
};

/// Replaces a parameter's value by the geometry's, if that has data of this name and type.
class InterpolatedParameter final : public Node {
 public:
  InterpolatedParameter(const String* name, const Memory& memory) : name_(name), memory_(memory) {}
  Flow run(RunState&) const override;
  void emit(Code& code) const override { code.interpret(*this); }

 private:
  const String* name_;
  Memory memory_;
};

}  // namespace etendue::osl
