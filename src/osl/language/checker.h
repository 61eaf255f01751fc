#pragma once
// The checker: an untyped tree to a typed one. Resolves names, finds the functions that calls mean, makes conversions explicit,
// folds constants, and refuses what the language does not allow.
//
// check_declarations.cpp, check_statements.cpp, check_expressions.cpp, check_operators.cpp, check_calls.cpp.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics.h"
#include "scopes.h"
#include "signatures.h"

namespace etendue::osl {

/// Limits of one shader.
inline constexpr int most_array_elements = 1'000'000;
inline constexpr std::size_t most_memory = std::size_t(64) << 20;  ///< of all variables [bytes]
inline constexpr std::size_t most_nodes = 2'000'000;               ///< expressions and statements of the typed tree
inline constexpr std::size_t most_functions = 20'000;
inline constexpr int most_depth_of_checks = 3000;  ///< expressions and statements in each other, functions' bodies included
inline constexpr int most_nested_functions = 100;  ///< bodies that are checked because another body calls them

class Checker {
 public:
  explicit Checker(Diagnostics&);

  /// The shader; null if there are errors.
  std::unique_ptr<Shader> check(const syntax::File&, const std::string& file_name);

 private:
  /// Ends the statement that is checked, after its error was reported.
  struct Abandon {};

  /// An argument of a call: its expression, or a list `{...}` that takes the parameter's type.
  struct Argument {
    ExpressionPointer value;
    const syntax::Expression* list = nullptr;
    Location place;
  };
  /// A function that a call may mean.
  struct Candidate {
    FunctionEntry* function = nullptr;
    const Signature* signature = nullptr;
    int score = 0;
    Type result;
  };
  struct Pending {
    Expression* call;
    FunctionEntry* function;
    std::vector<int> lengths;
  };
  /// What the statements that are checked belong to.
  struct Body {
    Function* function = nullptr;  ///< null: the shader itself
    int loops = 0;
  };

  /// Counts how deeply the checker calls itself.
  struct Deeper {
    Deeper(Checker& checker, Location at) : c(checker) {
      if (++c.depth_ <= most_depth_of_checks) return;
      --c.depth_;
      c.refuse(at, "this nests too deeply");
    }
    ~Deeper() { --c.depth_; }
    Checker& c;
  };

  // Errors
  [[noreturn]] void refuse(Location at, const std::string& text);
  void count_node(Location at);

  // Declarations
  void declarations(const std::vector<syntax::StatementPointer>&);
  void declare_structure(const syntax::StructDeclaration&);
  void declare_function(const std::shared_ptr<syntax::FunctionDeclaration>&);
  Type type_of(const syntax::TypeName&);
  Type type_of(const syntax::Declarator&);
  int array_length(const syntax::Declarator&);
  Symbol* make_symbol(const std::string& name, const Type&, Symbol::Role, Location);
  void declare(const std::string& name, Scope::Entry);
  Symbol* declare_variable(const syntax::Declarator&, Symbol::Role);
  void initial_value(Symbol&, const syntax::Expression&);
  std::vector<Metadatum> metadata(const std::vector<syntax::Declarator>&);
  void shader(const syntax::ShaderDeclaration&);
  Function* instance(FunctionEntry&, const std::vector<int>& lengths, Location at);
  void check_body(FunctionEntry&, Function&, const std::vector<int>& lengths);
  void resolve_pending();
  void finish_functions();

  // Statements
  StatementPointer statement(const syntax::Statement&);
  StatementPointer block(const syntax::Statement&);
  StatementPointer variables(const syntax::Statement&);
  StatementPointer branch(const syntax::Statement&);
  StatementPointer loop(const syntax::Statement&);
  StatementPointer leave(const syntax::Statement&);
  StatementPointer make(Statement::Kind, Location);

  // Expressions. `expected`: the type that the value will be converted to, if that is known, to choose between functions that
  // differ in their result only.
  ExpressionPointer value(const syntax::Expression&, Type expected = {});
  ExpressionPointer value_as(const syntax::Expression&, const Type&, const char* what);
  ExpressionPointer condition(const syntax::Expression&);
  ExpressionPointer truth(ExpressionPointer, bool negated = false);
  ExpressionPointer name(const syntax::Expression&);
  ExpressionPointer subscript(const syntax::Expression&);
  ExpressionPointer member(const syntax::Expression&);
  ExpressionPointer unary(const syntax::Expression&, Type expected);
  ExpressionPointer binary(const syntax::Expression&, Type expected);
  ExpressionPointer conditional(const syntax::Expression&, Type expected);
  ExpressionPointer assignment(const syntax::Expression&);
  ExpressionPointer increment(const syntax::Expression&);
  ExpressionPointer cast(const syntax::Expression&);
  ExpressionPointer list(const syntax::Expression&, const Type&);
  ExpressionPointer convert(ExpressionPointer, const Type&);
  ExpressionPointer converted(ExpressionPointer, const Type&, const char* what);
  ExpressionPointer operation(Operator, ExpressionPointer a, ExpressionPointer b, Location);
  ExpressionPointer closure_operation(Operator, ExpressionPointer a, ExpressionPointer b, Location);
  ExpressionPointer overloaded(const char* name, std::vector<ExpressionPointer>&, Location);
  bool fits_list(const syntax::Expression&, const Type&);
  void must_be_writable(const Expression&);
  ExpressionPointer make(Expression::Kind, const Type&, Location);
  template <class... Parts>
  ExpressionPointer make(Expression::Kind kind, const Type& t, Location at, ExpressionPointer first, Parts... rest) {
    ExpressionPointer e = make(kind, t, at);
    e->operands.push_back(std::move(first));
    (e->operands.push_back(std::move(rest)), ...);
    return e;
  }

  // Calls
  ExpressionPointer call(const syntax::Expression&, Type expected);
  ExpressionPointer call(const std::string& name, std::vector<Argument>, Type expected, Location);
  std::optional<ExpressionPointer> special_call(const syntax::Expression&);
  ExpressionPointer structure(const StructType&, const syntax::Expression&);
  std::vector<Candidate> candidates(const std::string& name, const std::vector<Argument>&);
  int score(const Candidate&, const std::vector<Argument>&);
  Candidate choose(std::vector<Candidate>&, Type expected, const std::string& name, const std::vector<Argument>&, Location);
  [[noreturn]] void refuse_call(const std::string& name, const std::vector<Argument>&, Location);
  ExpressionPointer argument(Argument&, const Type&, bool output, bool any, const std::string& function);
  ExpressionPointer call_function(FunctionEntry&, std::vector<Argument>&, Location);
  ExpressionPointer call_library(const Signature&, std::vector<Argument>&, Location);
  void mark_output(Expression& call, std::size_t argument);
  ExpressionPointer call_closure(const std::string& name, int known, const std::vector<Type>& parameters, const Signature*,
                                 std::vector<Argument>&, Location);
  std::string shown(const std::string& name, const std::vector<Argument>&) const;

  friend struct Enter;

  Diagnostics& diagnostics_;
  std::unique_ptr<Shader> shader_;
  std::vector<std::unique_ptr<Scope>> scopes_;
  std::vector<std::unique_ptr<FunctionEntry>> entries_;
  std::vector<std::pair<Function*, FunctionEntry*>> unfinished_;
  std::vector<Pending> pending_;
  Scope* scope_ = nullptr;
  Body body_;
  std::vector<std::string> open_functions_;  ///< whose bodies are checked now, each because the one before calls it
  std::size_t number_ = 0, nodes_ = 0, memory_ = 0;
  int depth_ = 0, functions_deep_ = 0;
  /// Expressions that folding made superfluous, kept because pending_ may point into them.
  std::vector<ExpressionPointer> dropped_;
};

}  // namespace etendue::osl
