#pragma once
// The typed tree of a shader: what the checker makes of the text, and what an interpreter or a compiler takes.
//
// All names are resolved and all types are said. Conversions are nodes of their own, so that operands always have the types
// that the node's comment states. There is no recursion in the language, so each variable, also of a function, has one place in
// memory: all symbols of a shader, those of its functions included, are one list, numbered by Symbol::index.
//
// Arguments are passed by reference. A function is checked once for each set of lengths of the arrays that are passed for its
// parameters `T x[]`, so that a length is unknown (Type::unsized) only where it comes from a shader's parameter `T x[]`.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "etendue/core/error.h"
#include "osl/library/table.h"
#include "osl/values/closure.h"
#include "osl/values/type.h"

namespace etendue::osl {

struct Expression;
struct Function;
struct Statement;
using ExpressionPointer = std::unique_ptr<Expression>;
using StatementPointer = std::unique_ptr<Statement>;

/// A value that is known when the shader is compiled, as it lies in memory (type.h), without derivatives. Strings are interned;
/// a closure is the null pointer. The type is no unsized array.
struct Constant {
  Type type;
  std::vector<std::byte> bytes;

  template <class T>
  const T& at(std::size_t i = 0) const {
    return reinterpret_cast<const T*>(bytes.data())[i];
  }
};

/// `[[ string label = "Roughness", float min = 0 ]]`.
struct Metadatum {
  std::string name;
  Constant value;
};

/// The variables that the renderer sets. A shader may write all of them: of Ci, and of P and N of displacement shaders, the
/// renderer takes the new value.
enum class Global : unsigned char { P, I, N, Ng, dPdu, dPdv, Ps, u, v, time, dtime, dPdtime, Ci };
inline constexpr int global_count = 13;

/// A variable.
struct Symbol {
  enum class Role : unsigned char {
    parameter,        ///< of the shader, read only
    output,           ///< output parameter of the shader
    local,            ///< of the shader or of a function
    argument,         ///< parameter of a function, read only: a reference to the caller's value
    output_argument,  ///< `output` parameter of a function: a reference to the caller's variable
    global            ///< see `global`
  };

  std::string name;
  Type type;
  Role role = Role::local;
  Global global = Global::P;  ///< of Role::global
  int index = 0;              ///< in Shader::symbols
  Location place;
  /// The default of a shader's parameter, the initial value of a local, else null. Its type is the symbol's type, except that
  /// of an unsized array, which has the length of the default. Of a parameter it is an expression of the globals and of the
  /// parameters before it; a constant in most cases (Kind::constant).
  ExpressionPointer initial;
  std::vector<Metadatum> metadata;
  /// Whether the value must have derivatives, if no other layer asks for those of an output (see find_derivatives).
  bool needs_derivatives = false;
  bool read = false;  ///< the text reads it
  /// The text writes it. An `argument` that is written is a copy of the caller's value instead of a reference.
  bool written = false;

  /// nullptr if there is none.
  const Metadatum* find(std::string_view metadatum) const;
};

enum class Operator : unsigned char {
  none,
  add,
  subtract,
  multiply,
  divide,
  modulus,
  shift_left,
  shift_right,
  bit_and,
  bit_or,
  bit_xor,
  equal,
  unequal,
  less,
  less_equal,
  greater,
  greater_equal,
  negate,
  complement
};

struct Expression {
  enum class Kind : unsigned char {
    constant,  ///< `constant`

    // References: what can be written, too.
    variable,          ///< `symbol`
    element,           ///< operands[0][operands[1]]: element of an array, index an int, in range or an error at run time
    component,         ///< operands[0][operands[1]]: component of a triple, a float
    matrix_component,  ///< operands[0][operands[1]][operands[2]]: a float
    field,             ///< field number `index` of the structure operands[0]

    /// operands[0] as `type`: int to float; int and float to triple (all components), to matrix (diagonal) and to spectrum;
    /// float to int (towards zero); triple to triple of another kind (the same numbers); a triple or a closure's null.
    conversion,
    /// Whether operands[0] is true: an int, 0 or 1. A number is true if it is not zero, a triple or matrix if a component is, a
    /// string if it is not empty, a closure if it is not null.
    truth,
    not_true,  ///< 1 - truth; the operand as of `truth`

    /// `operation` negate (int, float, triple, matrix, spectrum, closure) or complement (int) of operands[0].
    unary,
    /// operands[0] `operation` operands[1]. Both have one type, int, float, a triple (kinds may differ), matrix, spectrum or,
    /// for
    /// == and !=, string, with these exceptions:
    /// matrix * float, float * matrix, matrix / float, float / matrix (float times the inverse); matrix with + - is not
    /// allowed. closure + closure; closure * x and x * closure for x a float, color or spectrum. closure == closure does not
    /// exist. Comparisons have type int; those of triples and matrices (== and != only) compare all components.
    binary,
    logical_and,  ///< both are int (0 or 1, see truth); operands[1] is evaluated only if operands[0] is 1
    logical_or,   ///< likewise, if operands[0] is 0
    /// operands[0] ? operands[1] : operands[2], an int 0 or 1 and two values of `type`; only one of them is evaluated.
    conditional,
    comma,  ///< all operands in order; the value is that of the last

    /// operands[0] = operands[1]; the value is the variable's new value. Both have the same type (triples of different kinds
    /// count as the same, arrays may differ in length: the shorter length is copied, see the checker). With an `operation`:
    /// operands[0] = operands[0] operation operands[1], with types as of `binary`.
    assignment,
    /// ++ (`index` = 1) or -- (`index` = -1) of the int or float variable operands[0]; the value is the new one, or with
    /// `postfix` the old one.
    increment,

    call,  ///< of `function`. The operand of an output parameter is a reference, of the same type or another kind of triple.
    /// Of the row `row` of the library, which are also the constructors: color(r, g, b), point("world", x, y, z), matrix(1).
    /// The operand of an output parameter is a reference.
    library,
    /// The component of `shape`. The operands are the arguments, then pairs of a keyword, a constant string, and its value
    /// (make_component, library/closures.h).
    closure,
    /// All elements of an array, or all fields of a structure, in order. There may be fewer operands than elements: the
    /// remaining ones are undefined. An operand may be null: that element is undefined, too.
    aggregate,
    array_length,  ///< of operands[0], which is an array whose length the group decides (all others are constants)
    /// isconnected(operands[0]), a reference to a shader's parameter or a part of one, or to a function's parameter (then it is
    /// asked of what the caller passes): 1 connected from upstream, 2 to downstream, 3 both, else 0, as an int.
    is_connected,
    is_constant,  ///< isconstant(operands[0]): whether it is known when the group is built
  };

  Kind kind = Kind::constant;
  Type type;
  Location place;
  std::vector<ExpressionPointer> operands;

  Operator operation = Operator::none;  // unary, binary, assignment
  bool postfix = false;                 // increment
  int index = 0;                        // field, increment
  Symbol* symbol = nullptr;             // variable
  Constant constant;                    // constant
  const Function* function = nullptr;   // call
  const Row* row = nullptr;             // library
  std::uint64_t outputs = 0;            // library: the operands that it writes, as bits
  const ClosureShape* shape = nullptr;  // closure, owned by the shader

  /// The symbol of which a reference is a part; null for other kinds.
  const Symbol* root() const;
  bool is_reference() const { return root() != nullptr; }
};

struct Statement {
  enum class Kind : unsigned char {
    nothing,
    expression,   ///< `expression`
    declaration,  ///< `symbol` begins here, and gets its value if it has an initial one
    block,        ///< `statements`
    /// if (`expression`) `body` else `otherwise` (may be null). All conditions are int, 0 or 1.
    branch,
    /// for (`statements`; `expression`; `step`) `body`. `expression` (absent: true) and `step` may be null. Also `while`.
    loop,
    do_loop,        ///< do `body` while (`expression`)
    break_loop,     ///< of the innermost loop
    continue_loop,  ///< of the innermost loop: goes on with its step and condition
    /// Ends the function, with the value `expression` of its result type unless that is void; in the shader's own body ends the
    /// shader.
    leave,
    exit  ///< exit(): ends the shader, from within a function, too
  };

  Kind kind = Kind::nothing;
  Location place;
  ExpressionPointer expression, step;
  std::vector<StatementPointer> statements;
  StatementPointer body, otherwise;
  Symbol* symbol = nullptr;
};

/// A function of the shader's text (or of the library, if that is written in the language itself), for one set of array
/// lengths.
struct Function {
  std::string name;
  Type result;
  std::vector<Symbol*> parameters;  ///< roles argument and output_argument
  /// May name the symbols of blocks around it: parameters and locals of the shader.
  StatementPointer body;
  Location place;
};

/// A shader, complete and checked. Immutable, and shared by all that run it.
struct Shader {
  enum class Kind : unsigned char { shader, surface, displacement, volume, light };

  std::string name;
  Kind kind = Kind::shader;
  Location place;
  std::vector<Metadatum> metadata;
  std::vector<Symbol*> parameters;  ///< roles parameter and output, in order; structures are one parameter
  std::vector<std::unique_ptr<Symbol>> symbols;
  Symbol* globals[global_count] = {};  ///< null: the shader does not name this one
  /// In an order in which each function calls only functions before it.
  std::vector<std::unique_ptr<Function>> functions;
  StatementPointer body;

  std::vector<std::unique_ptr<StructType>> structures;
  std::vector<std::unique_ptr<ClosureShape>> shapes;

  /// nullptr if there is none.
  const Symbol* find_parameter(std::string_view) const;
};

/// "shader", "surface", ...
const char* name_of(Shader::Kind);
/// "P", "I", ...
const char* name_of(Global);

/// Which symbols must have derivatives, by Symbol::index, so that those that are taken (Row::taken) are right: backward through
/// all assignments, arguments and initial values, to a fixed point. `wanted` are symbols whose derivatives others ask for:
/// outputs that are connected to parameters with derivatives, or displacement's P. Ints, strings and closures never have any. A
/// function's parameters by reference have derivatives when the caller's variable has them and vice versa, for outputs; an
/// argument's may have more than the parameter.
/// An expression has to be evaluated with derivatives where they go: into a symbol that has them, or an argument that is taken.
std::vector<bool> find_derivatives(const Shader&, std::span<const Symbol* const> wanted = {});

}  // namespace etendue::osl
