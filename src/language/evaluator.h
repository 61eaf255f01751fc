#pragma once
// Evaluator: from syntax to values. Evaluates names, arithmetic, calls and components.

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "etendue/describe/registry.h"
#include "source.h"
#include "syntax.h"

namespace etendue::language {

/// Arithmetic on values; throws Error at the operator if the operands do not match.
Value add(const Value&, const Value&, Location);
Value subtract(const Value&, const Value&, Location);
Value multiply(const Value&, const Value&, Location);
Value divide(const Value&, const Value&, Location);
Value power(const Value& base, const Value& exponent, Location);
Value negate(const Value&, Location);
/// Applies a unit to a plain number or to packed plain numbers.
Value with_unit(Value, const Unit&, Location);
/// Packs the items if they are numbers, or rows of numbers, of one dimension and width; otherwise they stay a list.
Value packed(Value::List, Location);

/// Calls a function of the language; throws Error at the argument that does not fit.
Value call(const std::string& function, const std::vector<Value>& arguments, Location, bool allow_files);
bool is_function(const std::string& name);

/// Comparisons: == != < <= > >=. Numbers can be compared only with numbers of the same dimension.
Value compare(const std::string& operation, const Value&, const Value&, Location);
/// The integers from the first (included) to the second (excluded).
Value whole_numbers(const Value& first, const Value& end, Location);
/// The number of entries of a list; throws Error if the value is not a list.
size_t list_size(const Value& list, Location);
/// An entry of a list, with an index below list_size.
Value list_entry(const Value& list, size_t place);

/// The cost of a copy of the value: the numbers of a packed list, or a multiple of the entries of another list.
size_t copied_size(const Value&);

/// The number of single values in a list, with nested lists.
size_t value_count(const Value&);
/// Whether a value refers to components; otherwise it consists of numbers, texts, colours and transforms.
bool keeps_parts(const Value&);

/// The frame of an animation for which a description is evaluated.
struct Moment {
  double frame = 0;
  double seconds = 0;
};

/// Evaluates expressions in the namespaces of definitions. Each definition is evaluated once, when first used, so that the
/// order does not matter and components are shared. Errors are reported to the Diagnostics; an empty result means that an error
/// was reported.
class Evaluator {
 public:
  /// The greatest height of a component tree: limits the recursion here, and later wherever trees are traversed or destroyed.
  static constexpr int height_limit = 1000;

  /// A namespace: one for all files together, and one for each file that was included under a name.
  struct Space;

  /// Without a moment the names `frame` and `time` are undefined.
  Evaluator(Diagnostics& diagnostics, bool allow_files, std::optional<Moment> moment = {});
  ~Evaluator();

  /// Sets the folder of relative paths in the text with this name.
  void set_folder(const char* source, std::string folder) { folders_[source] = std::move(folder); }
  /// Some definitions or classes could not be read: undefined names are then not reported.
  void set_incomplete() { incomplete_ = true; }
  /// Whether `frame` or `time` was used.
  bool moment_used() const { return moment_used_; }

  /// The outermost namespace, with the names of all files that were not included under a name.
  Space& root() { return *root_; }
  /// The enclosing namespace; null for the outermost one.
  static Space* around(const Space&);
  /// Makes the namespace of a file included under a name, whose names are used as "name.x"; null (and reported) if the name is
  /// taken.
  Space* make_space(Space& outer, const Label& name);
  void define(Definition, Space&);
  /// Defines a name for an existing value; the label has the location. Returns null (and reports) if the name is taken;
  /// otherwise a pointer to a flag that is true after evaluation if the name was used.
  const bool* define_part(const Label&, Value, Space&);
  /// Whether a name is defined in the outermost namespace.
  bool knows(const std::string& name) { return find(name, *root_) != nullptr; }
  /// The prefix of the names in a space as seen from the outermost one: "small." for a file included as small; "" for the
  /// outermost.
  static std::string prefix(const Space&);
  /// Replaces a param of `space` by the value of a definition written in the namespace `written_in`; messages name the file
  /// `file`.
  void replace(Definition, Space& space, Space& written_in, const std::string& file);
  /// Replaces the value of a param by an expression from the command line.
  void redefine(const std::string& name, const std::string& text);

  /// The context of an expression, which determines how bare words are read.
  struct Context {
    const Member* member = nullptr;  ///< the member that gets the value: its choices may be bare words
    bool words = false;              ///< undefined bare words are strings
    bool lenient = false;            ///< undefined bare words are ignored, since their member is unknown
  };
  std::optional<Value> evaluate(Node&, const Context&);
  std::optional<Value> evaluate_in(Space&, Node&);
  /// Evaluates unused definitions, to find their errors, and warns of those defined in the text with this name.
  void check_unused(const char* source);

 private:
  enum class State : std::uint8_t { waiting, active, done, failed };
  struct Entry {
    Definition definition;
    Space* home = nullptr;   // the namespace that the name belongs to
    Space* space = nullptr;  // the namespace that the value is written in
    State state = State::waiting;
    bool used = false;
    bool replaced = false;   // by -D on the command line
    bool generated = false;  // computed, not written out: the value may be much longer than its text
    Label given = {};        // the location where an include replaced it …
    std::string given_to;    // … and the included file
    bool pending = false;    // an entry whose dependencies are being evaluated
    int height = 0;          // of the component tree in its value; 0 if the value has no components
    Value value;
  };
  // Limits the size of nested lists, since each use of a name copies its list.
  static constexpr size_t nested_limit = 1'000'000;
  // Limits the iterations of one comprehension, and the components made by all comprehensions and functions.
  static constexpr size_t repetition_limit = 1'000'000;
  static constexpr size_t part_limit = 500'000;
  // Limits the work in comprehensions and functions: evaluated nodes, and copied numbers of lists.
  static constexpr size_t step_limit = 20'000'000;
  // Limits the depth of function calls, including recursion.
  static constexpr int call_limit = 100;

  /// A variable of a comprehension or a parameter of a function.
  struct Local {
    std::string_view name;
    Value value;
    int height = 0;    // as in Entry
    size_t place = 0;  // index in the list of a loop
    const Local* outer = nullptr;
  };
  /// The name of such a variable, for checks without evaluation.
  struct Bound {
    std::string_view name;
    const Bound* outer = nullptr;
    mutable bool used = false;
  };
  /// Switches evaluation to the namespace where a name is defined or a function is written, for its lifetime.
  class Elsewhere;
  class LoopTrail;
  class CallTrail;
  struct Loop;

  std::optional<Value> value_of(Node&, const Context&);
  std::optional<Value> name(Node&, const Context&);
  std::optional<Value> named(Entry&, Location);
  void settle(Entry&);
  void settle_with_all_it_needs(Entry&);
  static std::vector<Entry*> waiting_names(const Node&, Space&);
  static std::string given_name(const Entry&);
  std::optional<Value> list(Node&, const Context&);
  /// The stored value of a name, without a copy; null for other expressions, and for a name without a value (not reported).
  const Value* stored(const Node&);
  const Local* local(std::string_view name) const;
  std::optional<Value> bound(const Local&, Location);

  // repeating/logic.cpp
  std::optional<Value> comparison(Node&, const Context&);
  std::optional<Value> connection(Node&, const Context&);
  std::optional<Value> conditional(Node&, const Context&);
  std::optional<Value> range(Node&, const Context&);
  std::optional<Value> index(Node&, const Context&);
  std::optional<bool> truth(Node&, const Context&, const char* what);

  // repeating/comprehension.cpp
  std::optional<Value> comprehension(Node&, const Context&);
  bool run(Loop&, size_t clause);
  bool take_entry(Loop&);
  bool foresee(Loop&);
  void charge(size_t steps, Location);
  void charge_part(Location);

  // repeating/functions.cpp
  std::optional<Value> count(Node& call, const Context&);
  std::optional<Value> call_own(Entry&, Node& call, const Context&);
  std::optional<std::vector<Node*>> arguments_of(const Entry&, Node& call);
  std::optional<Value> measured(Node&, const Context&, int& height);
  void unknown_function(const Node& call);
  void not_a_function(const Entry&, const Node& call);

  // repeating/checker.cpp: reports undefined names, classes, members and functions in expressions that may never be evaluated
  bool check_function(Entry&);
  bool check(Node&, const Bound*, const Context&);
  bool check_all(std::vector<Node>&, const Bound*, const Context&);
  bool check_name(const Node&, const Bound*, const Context&);
  bool check_call(Node&, const Bound*, const Context&);
  bool check_component(Node&, const Bound*, const Context&);
  bool check_comprehension(Node&, const Bound*, const Context&);
  std::optional<Value> json_text(Node&, const Context&);
  std::optional<Value> json_numbers(Node&, const Member&);
  void check_size(const Node&, const Value::List&) const;
  std::optional<Value> chain(Node&, const Context&);
  std::optional<Value> call_function(Node&, const Context&);
  std::optional<Value> component(Node&, const std::string& given_name);
  bool set_members(Component&, Node&);
  bool is_json_text(const Node&, const Context&);
  void unknown_unit(const Label&);

  Entry* find(const std::string& text) { return find(text, *space_); }
  static Entry* find(const std::string&, Space&);
  std::string name_seen_from(const Entry&, const Space&) const;
  void undefined(const std::string&, Location);
  bool lacks_quotes(const Node& call, const Node& argument, const Bound*);
  /// Calls a function that may throw Error; errors without a location are reported at `at`.
  template <class F>
  std::optional<Value> reporting(Location at, F&& make) {
    try {
      return make();
    } catch (const Errors& list) {
      for (const Error& e : list.errors) diagnostics_.add(located(e, at));
    } catch (const Error& e) {
      diagnostics_.add(located(e, at));
    }
    return std::nullopt;
  }

  Diagnostics& diagnostics_;
  bool allow_files_, incomplete_ = false;
  std::optional<Moment> moment_;
  bool moment_used_ = false;
  std::deque<Entry> entries_;
  std::unique_ptr<Space> root_;
  std::vector<const Space*> spaces_;  // all except the root
  Space* space_;                      // the namespace of the expression being evaluated
  const Local* locals_ = nullptr;     // the innermost variable
  const Bound* bound_ = nullptr;      // the same for checks without evaluation
  int repeating_ = 0;                 // 0: nodes are evaluated once, and their values may be moved from
  int calls_ = 0;                     // number of active calls
  size_t steps_ = 0, parts_ = 0;      // used by comprehensions and functions
  std::vector<Label> unused_parameters_;
  std::vector<Entry*> active_;  // being evaluated, outermost first
  bool circle_ = false;         // the current definition is cyclic
  std::unordered_map<const char*, std::string> folders_;
  std::deque<Source> replacements_;
  int depth_ = 0, reach_ = 0;  // the current nesting, and the deepest within the current definition
};

struct Evaluator::Space {
  Space* outer = nullptr;
  Label label;  ///< the name under which the file was included; "" for the outermost
  std::unordered_map<std::string, Entry*> names = {};
  std::map<std::string, std::unique_ptr<Space>> inner = {};
  bool used = false;

  /// The prefix of its names as seen from the outermost namespace: "small." for a file included as small; "" for the outermost.
  std::string prefix() const { return outer ? outer->prefix() + label.text + "." : std::string(); }
};

/// The part of a trail that names the include, for errors in a file that was included under a name.
class SpaceTrail : public Trail {
 public:
  explicit SpaceTrail(const Label& label) : Trail(nullptr), label_(label) {}
  std::string words(const Location& seen_from) const override {
    return label_.text.empty() ? std::string() : "in '" + label_.text + "', included at " + place(label_.at, seen_from);
  }

 private:
  const Label& label_;
};

class Evaluator::Elsewhere {
 public:
  Elsewhere(Evaluator& evaluator, Space& space)
      : evaluator_(evaluator),
        space_(std::exchange(evaluator.space_, &space)),
        locals_(std::exchange(evaluator.locals_, nullptr)),
        repeating_(evaluator.repeating_),
        trail_(evaluator.diagnostics_.trail) {}
  ~Elsewhere() {
    evaluator_.space_ = space_;
    evaluator_.locals_ = locals_;
    evaluator_.repeating_ = repeating_;
    evaluator_.diagnostics_.trail = trail_;
  }
  Elsewhere(const Elsewhere&) = delete;
  Elsewhere& operator=(const Elsewhere&) = delete;

 private:
  Evaluator& evaluator_;
  Space* space_;
  const Local* locals_;
  int repeating_;
  const Trail* trail_;
};

}  // namespace etendue::language
