#pragma once
// The syntax tree that the parser makes of a text: statements and expressions, not yet evaluated.

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
  range,          ///< integers from the first child (included) to the second (excluded)
  comparison,     ///< of its two children
  conjunction,    ///< all of its children
  disjunction,    ///< any of its children
  inversion,      ///< not
  conditional,    ///< condition, value if it holds, value if not
  index,          ///< a list and an index into it, from 0
  argument,       ///< a named argument of a call; its name is `text`
  comprehension,  ///< the entry, then the list or condition of each clause; `labels`: for each clause the variable of `for`, or
                  ///< "" for `if`
  json_text,      ///< a JSON string: a text or an expression, depending on its member
  bad             ///< has syntax errors, which are reported already
};

/// A name of a member, a unit or an operator, with its location.
struct Label {
  std::string text;
  Location at;
  size_t begin = 0;  ///< byte offset in the text; only for member names and definitions of an .etd
};

struct Node {
  NodeType type = NodeType::none;
  Location at;
  std::string text;                  ///< string, name, function or class
  bool json = false;                 ///< a list or object of JSON
  bool damaged = false;              ///< a component with members that could not be parsed
  double number = 0;                 ///< number, boolean
  std::unique_ptr<Numbers> numbers;  ///< a packed list
  std::vector<Node> children;        ///< items, arguments, member values, operands
  std::vector<Label> labels;         ///< member names; the unit; the operator before each operand except the first
  /// Byte range of the node in the text, only in an .etd, and only for members' values, items, arguments, names and
  /// definitions. `inside` is the byte after the '{' of a component.
  size_t begin = 0, end = 0, inside = 0;
};

/// A parameter of a function.
struct Parameter {
  Label name;
  std::unique_ptr<Node> standard;  ///< default value; null: the argument is required
};

struct Definition {
  Label name;
  bool parameter = false;  ///< a param, which may be replaced
  Node value;              ///< the body, for a function
  bool function = false;
  std::vector<Parameter> parameters = {};  ///< of a function
};

/// An include statement: include "file" with { param: value } as name
struct Inclusion {
  Label path;
  std::vector<Definition> replaced;  ///< params of the file and their new values
  Label name;                        ///< prefix of the names of the file; "": none
};

/// One parsed file.
struct Document {
  std::vector<Inclusion> includes;
  std::vector<Label> plugins;  ///< paths as written
  std::vector<Definition> definitions;
  std::vector<Node> components;  ///< unnamed components, such as the Job
  bool whole = true;             ///< false if parsing was given up before the end
};

/// Parses statements; reports errors and continues after them.
Document parse_document(const Source&, Diagnostics&);
/// Parses one expression that ends with the text; null if it has errors (which are reported). `begin` is its start.
std::unique_ptr<Node> parse_expression(const Source&, Diagnostics&, size_t begin = 0);

}  // namespace etendue::language
