#pragma once
// From syntax to values: names, arithmetic, calls, components.

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

/// Arithmetic on values; each throws Error at the place of the operator when it has no meaning.
Value add(const Value&, const Value&, Location);
Value subtract(const Value&, const Value&, Location);
Value multiply(const Value&, const Value&, Location);
Value divide(const Value&, const Value&, Location);
Value power(const Value& base, const Value& exponent, Location);
Value negate(const Value&, Location);
/// A plain number or packed plain numbers in this unit.
Value with_unit(Value, const Unit&, Location);
/// Items as packed numbers when they are numbers, or rows of numbers, of one dimension and width; else as a list.
Value packed(Value::List, Location);

/// Calls a function of the language; throws Error at the argument that does not fit.
Value call(const std::string& function, const std::vector<Value>& arguments, Location, bool allow_files);
bool is_function(const std::string& name);

/// Comparisons: == != < <= > >=. Numbers are compared with those of their dimension.
Value compare(const std::string& operation, const Value&, const Value&, Location);
/// The whole numbers from the first, to the second, which is not one of them.
Value whole_numbers(const Value& first, const Value& end, Location);
/// How many entries a list has; throws Error for what is none.
size_t list_size(const Value& list, Location);
/// An entry of a list, of as many as list_size says.
Value list_entry(const Value& list, size_t place);

/// How much is copied with a value: the numbers of a packed list, the entries of another.
size_t copied_size(const Value&);

/// How many single values a list holds with all lists within it.
size_t value_count(const Value&);
/// Whether a value refers to components; numbers, texts, colours and transforms are all there is of others.
bool keeps_parts(const Value&);

/// The frame of a film that a description is read for.
struct Moment {
  double frame = 0;
  double seconds = 0;
};

/// Evaluates expressions in one namespace of definitions. Each definition is evaluated once, when first used, so that
/// order does not matter and components are shared. What is wrong is reported; an absent result means that it was.
class Evaluator {
 public:
  /// Where names are: those of all files together, but for files that were included as a name of their own.
  struct Space;

  /// Without a moment the names `frame` and `time` have no meaning.
  Evaluator(Diagnostics& diagnostics, bool allow_files, std::optional<Moment> moment = {});
  ~Evaluator();

  /// Paths in the text of this name start from a folder.
  void set_folder(const char* source, std::string folder) { folders_[source] = std::move(folder); }
  /// Some definitions or classes could not be read: names that are missing are no news.
  void set_incomplete() { incomplete_ = true; }
  /// Whether `frame` or `time` was asked for.
  bool moment_used() const { return moment_used_; }

  /// Where the names of all files are that were not given one of their own.
  Space& root() { return *root_; }
  /// The space around one; null of the outermost.
  static Space* around(const Space&);
  /// For the names of a file that stand behind a name and a point; null (and reported) when that name is taken.
  Space* make_space(Space& outer, const Label& name);
  void define(Definition, Space&);
  /// Gives a name to a value that there is already; where it is, at which place of what file, is the label's. Null (and
  /// reported) when the name is taken; else whether anything asked for it, once all is evaluated.
  const bool* define_part(const Label&, Value, Space&);
  /// Whether a name is known where all names are.
  bool knows(const std::string& name) { return find(name, *root_) != nullptr; }
  /// "small." before the names of a file that was included as small; "" of the outermost.
  static std::string prefix(const Space&);
  /// Gives a param of `space` the value of a definition that stands in `written_in`; `file` is what messages call the file.
  void replace(Definition, Space& space, Space& written_in, const std::string& file);
  /// Replaces the value of a param.
  void redefine(const std::string& name, const std::string& text);

  /// Where an expression stands.
  struct Context {
    const Member* member = nullptr;  ///< that it is for: makes bare words choices
    bool words = false;              ///< bare words that name nothing are strings
    bool lenient = false;            ///< bare words that name nothing are ignored: their member is unknown
  };
  std::optional<Value> evaluate(Node&, const Context&);
  std::optional<Value> evaluate_in(Space&, Node&);
  /// Evaluates what was not used, for the errors in it, and warns of it if it was defined in the text of this name.
  void check_unused(const char* source);

 private:
  enum class State : std::uint8_t { waiting, active, done, failed };
  struct Entry {
    Definition definition;
    Space* home = nullptr;   // that it is a name of
    Space* space = nullptr;  // that its value is written in
    State state = State::waiting;
    bool used = false;
    bool replaced = false;   // by -D
    bool generated = false;  // not written out: it may be much longer than the text
    Label given = {};        // where an include gave it, to …
    std::string given_to;    // … this file
    bool pending = false;    // on the way from the name that is settled to what it needs first
    int height = 0;          // of the tree of all that it is made of, where that remains: of components
    Value value;
  };
  // Bounds recursion here, and later wherever components are walked or destroyed.
  static constexpr int height_limit = 1000;
  // Bounds what lists within lists hold, as each use of a name copies its list.
  static constexpr size_t nested_limit = 1'000'000;
  // Bounds the turns of one comprehension, and how many components all of them and all functions make.
  static constexpr size_t repetition_limit = 1'000'000;
  static constexpr size_t part_limit = 500'000;
  // Bounds what is evaluated in comprehensions and functions: nodes, and the numbers of lists that are copied.
  static constexpr size_t step_limit = 20'000'000;
  // Bounds how deep functions call each other, or themselves.
  static constexpr int call_limit = 100;

  /// A name that a comprehension or a function binds.
  struct Local {
    std::string_view name;
    Value value;
    int height = 0;    // as an Entry's
    size_t place = 0;  // in the list that a loop goes through
    const Local* outer = nullptr;
  };
  /// The same, where it is only asked which names there are.
  struct Bound {
    std::string_view name;
    const Bound* outer = nullptr;
    mutable bool used = false;
  };
  /// While it lives, evaluation goes on where a name is defined or a function is written, not where it is used.
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
  /// A list that is a name, without a copy; null for anything else, and for a name that has no value (not reported).
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

  // repeating/checker.cpp: names, classes, members and functions that there are not, in what may never be evaluated
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
  /// Runs what may throw Error; an error is reported at `at` unless it has a place.
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
  std::vector<const Space*> spaces_;  // all but the root
  Space* space_;                      // whose names are those of what is evaluated
  const Local* locals_ = nullptr;     // innermost first
  const Bound* bound_ = nullptr;      // the same where names are only checked
  int repeating_ = 0;                 // 0: what is evaluated is so once, and may be moved from
  int calls_ = 0;                     // that are active
  size_t steps_ = 0, parts_ = 0;      // made in comprehensions and functions
  std::vector<Label> unused_parameters_;
  std::vector<Entry*> active_;  // being evaluated, outermost first
  bool circle_ = false;         // what is settled now is defined by itself
  std::unordered_map<const char*, std::string> folders_;
  std::deque<Source> replacements_;
  int depth_ = 0, reach_ = 0;  // nesting now, and the deepest within the definition being evaluated
};

struct Evaluator::Space {
  Space* outer = nullptr;
  Label label;  ///< the name that stands before its names outside; "" of the outermost
  std::unordered_map<std::string, Entry*> names = {};
  std::map<std::string, std::unique_ptr<Space>> inner = {};
  bool used = false;

  /// "small." before the names of a file that was included as small; "" of the outermost.
  std::string prefix() const { return outer ? outer->prefix() + label.text + "." : std::string(); }
};

/// In a file that was included under a name: which one, of several of the same file.
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
