#pragma once
// What the parser makes of a text: statements and expressions, nothing evaluated yet.

#include <memory>
#include <string>
#include <vector>

#include "etendue/describe/value.h"
#include "source.h"

namespace etendue::language {

enum class NodeType : std::uint8_t {
  none,
  boolean,
  number,
  string,
  name,
  list,
  numbers,
  call,
  component,
  unit,
  negation,
  sum,
  product,
  power,
  range,          ///< whole numbers from the first child to the second, which is not one of them
  comparison,     ///< of two children
  conjunction,    ///< all of its children
  disjunction,    ///< any of its children
  inversion,      ///< not
  conditional,    ///< condition, value if it holds, value if not
  index,          ///< a list and a place in it, from 0
  argument,       ///< of a call, by the name in `text`
  comprehension,  ///< an entry, then what each clause is of; `labels` are the clauses: the name after `for`, or "" of an `if`
  json_text,      ///< a string of JSON: a text or an expression, as its member has it
  bad             ///< could not be read; reported already
};

/// A name and its place: of a member, of a unit, of an operator.
struct Label {
  std::string text;
  Location at;
  size_t begin = 0;  ///< its first byte in the text; of member names and definitions of an .etd only
};

struct Node {
  NodeType type = NodeType::none;
  Location at;
  std::string text;                  ///< string, name, function or class
  bool json = false;                 ///< a list or object of JSON
  bool damaged = false;              ///< a component some of whose members could not be read
  double number = 0;                 ///< number, boolean
  std::unique_ptr<Numbers> numbers;  ///< a packed list
  std::vector<Node> children;        ///< items, arguments, member values, operands
  std::vector<Label> labels;         ///< member names; the unit; the operator before each operand but the first
  /// Bytes of the text, from the first to the one behind the last, of an .etd only: of members' values, items, arguments, names
  /// and of what is defined. `inside` is the byte behind the '{' of a component.
  size_t begin = 0, end = 0, inside = 0;
};

/// A parameter of a function.
struct Parameter {
  Label name;
  std::unique_ptr<Node> standard;  ///< its default; null: it must be given
};

struct Definition {
  Label name;
  bool parameter = false;  ///< a param, which may be replaced
  Node value;              ///< a function's body
  bool function = false;
  std::vector<Parameter> parameters = {};  ///< of a function
};

/// include "file" with { param: value } as name
struct Inclusion {
  Label path;
  std::vector<Definition> replaced;  ///< params of the file and what they are to be
  Label name;                        ///< that stands before the names of the file; "": none does
};

/// One parsed file.
struct Document {
  std::vector<Inclusion> includes;
  std::vector<Label> plugins;  ///< paths as written
  std::vector<Definition> definitions;
  std::vector<Node> components;  ///< those that stand for themselves, such as the Job
  bool whole = true;             ///< false when reading had to be given up before the end
};

/// Reads statements, reporting what is wrong and going on after it.
Document parse_document(const Source&, Diagnostics&);
/// Reads one expression that ends with the text; null when it was wrong (and reported). `begin` is where it starts.
std::unique_ptr<Node> parse_expression(const Source&, Diagnostics&, size_t begin = 0);

}  // namespace etendue::language
