#pragma once
// Calls of the library in code that is made: as calls of the library's own functions, or, where these are short, as
// instructions.

#include <span>

#include "coded_numbers.h"
#include "osl/library/table.h"

namespace etendue::osl {

/// A call whose arguments are evaluated.
struct CodedCall {
  Code& code;
  const CallTypes& types;
  std::span<const Value> arguments;
  const std::vector<bool>& outputs;  ///< which arguments are written
  const Memory& result;
};

/// Makes the instructions of a short function that do the same as the library's code, to the bit. False: there are none.
bool emit_instructions(const Row&, const CodedCall&);

/// The same for noise: a call of a function of numbers.
bool emit_noise(const Row&, const CodedCall&);

/// Calls a function of the program with a value's address. A value that the layer has its own copy of is lent as a copy, so
/// that it can be kept in registers.
class Lent {
 public:
  Lent(Code& code, const Memory& m) : code_(code), memory_(m), own_(code.own(m.offset)) {
    at_ = own_ ? code.borrow(m.type.size()) : code.address_of({m.offset, {}});
  }
  ~Lent() {
    if (own_) code_.give_back(at_);
  }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;
  Word in() {
    if (own_) emit_copy(code_, memory_.type, {0, at_}, 0, {memory_.offset, {}}, 0, memory_.type.size());
    return at_;
  }
  Word address() const { return at_; }
  void out() {
    if (own_) emit_copy(code_, memory_.type, {memory_.offset, {}}, 0, {0, at_}, 0, memory_.type.size());
    if (!memory_.stride) return;
    for (std::size_t i = 1; i < 3; ++i)
      code_.clear({memory_.offset + std::uint32_t(i) * memory_.stride, {}}, memory_.type.size());
  }

 private:
  Code& code_;
  Memory memory_;
  bool own_;
  Word at_;
};

/// Where the library's functions find the arguments of a call, and leave the result.
///
/// They take addresses. An input that the layer keeps in registers is lent as a copy, so that it can stay there; one that is
/// written, or large, gives its own address, which keeps it in memory for the whole layer.
class LentArguments {
 public:
  explicit LentArguments(const CodedCall&);
  /// The address of the Call.
  Word call() const { return memory_; }
  /// Behind the call: takes the result, and gives the memory back.
  void end();

 private:
  bool direct(std::size_t i) const;

  const CodedCall& call_;
  Word memory_;
  Spot result_;  ///< where the result is left, unless in its own place
  bool result_copied_ = false;
};

}  // namespace etendue::osl
