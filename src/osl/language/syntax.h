#pragma once
// The untyped tree of a text: what the parser makes, and the checker takes. Names are not resolved, types are names.

#include <memory>
#include <string>
#include <vector>

#include "etendue/core/error.h"
#include "tree.h"

namespace etendue::osl::syntax {

struct Expression;
struct Statement;
struct FunctionDeclaration;
using ExpressionPointer = std::unique_ptr<Expression>;
using StatementPointer = std::unique_ptr<Statement>;

/// A type as it is written: "float", "closure color", a structure's name.
struct TypeName {
  std::string name;
  bool closure = false;
  Location place;
};

struct Expression {
  enum class Kind : unsigned char {
    integer,  ///< `number` (an int)
    real,     ///< `number`
    text,     ///< `name`: a string's text, without quotes and escapes
    name,
    subscript,    ///< operands[0][operands[1]]
    member,       ///< operands[0].name
    unary,        ///< negate, complement; `name` is "!" for not, "+" for plus
    binary,       ///< `operation`; `name` is "&&" or "||" for the logical ones
    conditional,  ///< three operands
    assignment,   ///< `operation`, none for =
    increment,    ///< `direction`, `postfix`
    call,         ///< name(operands), also a constructor
    cast,         ///< (type) operands[0]
    list,         ///< { operands }
    comma
  };
  Kind kind;
  Location place;
  std::string name;
  double number = 0;
  Operator operation = Operator::none;
  int direction = 0;
  bool postfix = false;
  TypeName type;
  std::vector<ExpressionPointer> operands;
  int depth = 1;  ///< nodes on the longest way down
};

/// `name`, `name[4]`, `name[]` with an initial value, as variable, parameter or field.
struct Declarator {
  TypeName type;
  std::string name;
  Location place;
  bool output = false, array = false;
  ExpressionPointer length;  ///< of an array; null: unsized
  ExpressionPointer initial;
  std::vector<Declarator> metadata;
};

struct StructDeclaration {
  std::string name;
  Location place;
  std::vector<Declarator> fields;
};

struct Statement {
  enum class Kind : unsigned char {
    nothing,
    expression,
    variables,
    function,
    structure,
    block,
    branch,
    loop,
    do_loop,
    break_loop,
    continue_loop,
    leave
  };
  Kind kind = Kind::nothing;
  Location place;
  ExpressionPointer expression, step;
  std::vector<StatementPointer> statements;  ///< block; initial statement of a loop
  StatementPointer body, otherwise;
  std::vector<Declarator> variables;
  std::shared_ptr<FunctionDeclaration> function;
  std::shared_ptr<StructDeclaration> structure;
};

struct FunctionDeclaration {
  TypeName result;
  bool result_array = false;
  std::string name;
  Location place;
  std::vector<Declarator> parameters;
  std::vector<Declarator> metadata;
  StatementPointer body;                           ///< null: only declared
  bool variadic = false, output_variadic = false;  ///< `...` at the end, in signatures of the library
};

struct ShaderDeclaration {
  Shader::Kind kind = Shader::Kind::shader;
  std::string name;
  Location place;
  std::vector<Declarator> metadata;
  std::vector<Declarator> parameters;
  StatementPointer body;
};

/// A whole text: statements of kinds function and structure, and the shader among them.
struct File {
  std::vector<StatementPointer> before;  ///< the shader: declarations
  std::vector<StatementPointer> after;   ///< of no use, but checked
  std::unique_ptr<ShaderDeclaration> shader;
};

}  // namespace etendue::osl::syntax
