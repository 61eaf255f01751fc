#pragma once
// Code: the maker of machine code, as the nodes see it. Each node that runs can also say itself in instructions of this
// interface (Node::emit), next to the code that interprets it; osl/machine implements the interface by LLVM.
//
// The instructions are those of IEEE arithmetic without freedom: nothing is fused, reordered or approximated, so that compiled
// code gives the same numbers as the interpreter, bit by bit, except for the sign and payload of not-a-number.
//
// Places of the frame are named by their offsets, as everywhere. Variables and temporaries of a layer, which nothing outside it
// sees, are kept in registers where possible, and have then no place in the frame.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>

namespace etendue::osl {

class Node;

/// A number, address or truth value in the code that is made.
struct Word {
  void* value = nullptr;
};

enum class WordKind : unsigned char { none, int_, float_, address };

/// `offset` bytes behind an address, or, without one, behind the beginning of the frame.
struct Spot {
  std::uint32_t offset = 0;
  Word base;

  Spot operator+(std::size_t bytes) const { return {offset + std::uint32_t(bytes), base}; }
};

class Code {
 public:
  enum class Arithmetic : unsigned char {
    add,
    subtract,
    multiply,
    divide,
    remainder,  // of ints, like those below
    bit_and,
    bit_or,
    bit_xor,
    shift_left,
    shift_right
  };
  enum class Comparison : unsigned char { equal, unequal, less, less_equal, greater, greater_equal };
  enum class Function : unsigned char { negate, absolute, square_root, floor, ceiling, round, truncate };
  enum class Label : std::uint32_t { none };

  virtual ~Code() = default;

  // Constants

  virtual Word integer(int) = 0;
  virtual Word number(float) = 0;
  /// Of an object that lives as long as the code.
  virtual Word address(const void*) = 0;

  // Arithmetic. Both operands are ints, or both floats; bit_and, bit_or and bit_xor also take truth values. Ints wrap around; a
  // division by zero, and of the least int by -1, is the caller's fault.

  virtual Word arithmetic(Arithmetic, Word, Word) = 0;
  virtual Word function(Function, Word) = 0;
  /// A truth value. Comparisons with not-a-number are false, except `unequal`. Addresses can be equal and unequal.
  virtual Word compare(Comparison, Word, Word) = 0;
  virtual Word select(Word truth, Word yes, Word no) = 0;
  virtual Word int_of_truth(Word) = 0;
  virtual Word float_of_int(Word) = 0;
  /// Towards zero; the number is in range.
  virtual Word int_of_float(Word) = 0;

  // Memory

  virtual Word load(WordKind, const Spot&) = 0;
  virtual void store(const Spot&, Word) = 0;
  /// As memmove.
  virtual void copy(const Spot& to, const Spot& from, std::size_t bytes) = 0;
  virtual void clear(const Spot&, std::size_t bytes) = 0;
  /// Whether the byte in the frame is not zero: one of the group's flags.
  virtual Word flag(std::uint32_t offset) = 0;
  virtual Word address_of(const Spot&) = 0;
  /// `index` (an int that is not negative) times `step` bytes behind an address.
  virtual Word element(Word base, Word index, std::uint32_t step) = 0;
  /// Whether the layer has its own copy of the place, so that the frame does not show its value, nor take changes of it.
  virtual bool own(std::uint32_t offset) const = 0;
  /// The bytes of a place whose value never changes; null: it is none.
  virtual const std::byte* constant(std::uint32_t offset) const = 0;
  /// Memory for a call, aligned to 32 bytes, until it is released. No other layer sees it.
  virtual Word borrow(std::size_t bytes) = 0;
  virtual void give_back(Word) = 0;

  // What the code is called with

  virtual Word run_state() = 0;
  virtual Word services() = 0;  ///< those of the run
  /// A counter of the layer's loops: one more. True every 256th time.
  virtual Word tick() = 0;

  // Calls of functions of the program with the C convention. They may throw.

  virtual Word call(const void* function, WordKind result, std::span<const Word>) = 0;
  Word call(const void* f, WordKind result, std::initializer_list<Word> words) {
    return call(f, result, std::span(words.begin(), words.size()));
  }
  /// The same for a function of numbers that depends on nothing else, and has no effect.
  virtual Word call_pure(const void* function, WordKind result, std::span<const Word>) = 0;

  // Flow

  virtual Label label() = 0;
  virtual void jump(Label) = 0;
  virtual void branch(Word truth, Label yes, Label no) = 0;
  /// What follows is behind the label, which code before it reaches by a jump only.
  virtual void begin(Label) = 0;

  /// Where the statements that jump go.
  struct Targets {
    Label break_loop{}, continue_loop{}, leave{}, exit{};
  };
  Targets targets;

  /// Runs a node by the interpreter. It must not read or write what is `own`.
  void interpret(const Node&);
};

}  // namespace etendue::osl
