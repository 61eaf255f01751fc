// Formulas: expressions of the render description language, compiled for a stack machine.

#include "formula.h"

#include <span>

#include "components/maps/combining/combination.h"
#include "language/source.h"
#include "language/syntax.h"

namespace etendue {
namespace {

using Lanes = detail::Lanes;

float quotient(float a, float b) { return a - b * std::floor(a / b); }
float smooth_step(float low, float high, float x) {
  const float t = clamp((x - low) / (high - low), 0, 1);
  return t * t * (3 - 2 * t);
}

struct Operation {
  const char* name;  // null: cannot be called by name
  int arguments;
  void (*run)(Spectrum* first);  // the first argument becomes the result
};

template <float (*f)(float)>
void each(Spectrum* s) {
  s[0] = map(s[0], f);
}
template <float (*f)(float, float)>
void each(Spectrum* s) {
  for (int i = 0; i < spectrum_size; ++i) s[0].set(i, f(s[0][i], s[1][i]));
}
template <float (*f)(float, float, float)>
void each(Spectrum* s) {
  for (int i = 0; i < spectrum_size; ++i) s[0].set(i, f(s[0][i], s[1][i], s[2][i]));
}

// In the order of Formula::Code; those without a name come first.
constexpr Operation operations[] = {
    {nullptr, 0, nullptr},
    {nullptr, 0, nullptr},
    {nullptr, 2, [](Spectrum* s) { s[0] = s[0] + s[1]; }},
    {nullptr, 2, [](Spectrum* s) { s[0] = s[0] - s[1]; }},
    {nullptr, 2, [](Spectrum* s) { s[0] = s[0] * s[1]; }},
    {nullptr, 2, [](Spectrum* s) { s[0] = s[0] / s[1]; }},
    {nullptr, 1, [](Spectrum* s) { s[0] = -s[0]; }},
    {"abs", 1, each<std::fabs>},
    {"sqrt", 1, each<std::sqrt>},
    {"exp", 1, each<std::exp>},
    {"log", 1, each<std::log>},
    {"sin", 1, each<std::sin>},
    {"cos", 1, each<std::cos>},
    {"tan", 1, each<std::tan>},
    {"atan2", 2, each<std::atan2>},
    {"floor", 1, each<std::floor>},
    {"fract", 1, each<[](float x) { return x - std::floor(x); }>},
    {"mod", 2, each<quotient>},
    {"pow", 2, each<safe_power>},
    {"min", 2, each<[](float a, float b) { return std::min(a, b); }>},
    {"max", 2, each<[](float a, float b) { return std::max(a, b); }>},
    {"step", 2, each<[](float edge, float x) { return x < edge ? 0.0f : 1.0f; }>},
    {"clamp", 3, each<[](float x, float low, float high) { return clamp(x, low, high); }>},
    {"mix", 3, each<[](float a, float b, float t) { return lerp(t, a, b); }>},
    {"smoothstep", 3, each<smooth_step>},
    {"mean", 1, [](Spectrum* s) { s[0] = s[0].average(); }},
};
static_assert(std::size(operations) == Formula::operation_count);

}  // namespace

class FormulaCompiler {
 public:
  FormulaCompiler(Formula& formula, const std::vector<std::string>& names) : formula_(formula), names_(names) {
    formula_.steps_.clear();
    formula_.used_.assign(names.size(), false);
  }

  void expression(const language::Node& node) {
    using language::NodeType;
    switch (node.type) {
      case NodeType::number:
        if (!(std::abs(node.number) <= double(std::numeric_limits<float>::max())))
          throw Error("the number is too large", node.at);
        push({Formula::push_number, 0, float(node.number)}, node.at);
        return;
      case NodeType::name: name(node); return;
      case NodeType::call: call(node); return;
      case NodeType::negation:
        expression(node.children.at(0));
        operation(Formula::negate);
        return;
      case NodeType::sum:
      case NodeType::product:
        expression(node.children.at(0));
        for (size_t i = 1; i < node.children.size(); ++i) {
          expression(node.children[i]);
          const char symbol = node.labels.at(i - 1).text.at(0);
          operation(symbol == '+'
                        ? Formula::add
                        : (symbol == '-' ? Formula::subtract : (symbol == '*' ? Formula::multiply : Formula::divide)));
        }
        return;
      case NodeType::unit:
        throw Error("a formula has no units; write '*' between factors", node.labels.empty() ? node.at : node.labels[0].at);
      default: throw Error("a formula is made of numbers, names, + - * / and functions", node.at);
    }
  }

 private:
  void push(Formula::Step step, const Location& at) {
    if (++depth_ > Formula::deepest) throw Error("the formula is too deeply nested", at);
    formula_.steps_.push_back(step);
  }
  void operation(std::uint8_t which) {
    depth_ -= operations[which].arguments - 1;
    formula_.steps_.push_back({which});
  }

  void name(const language::Node& node) {
    if (node.text == "pi") return push({Formula::push_number, 0, pi}, node.at);
    for (size_t i = 0; i < names_.size(); ++i) {
      if (names_[i] != node.text) continue;
      formula_.used_[i] = true;
      return push({Formula::push_value, std::uint16_t(i)}, node.at);
    }
    std::vector<std::string> known = names_;
    known.emplace_back("pi");
    std::string list;
    for (const std::string& n : known) list += (list.empty() ? "" : ", ") + n;
    throw Error("'" + node.text + "' is no name in this formula" + suggestion(node.text, known) + "; there are " + list,
                node.at);
  }

  void call(const language::Node& node) {
    for (size_t i = Formula::first_function; i < std::size(operations); ++i) {
      if (node.text != operations[i].name) continue;
      const size_t wanted = size_t(operations[i].arguments);
      if (node.children.size() != wanted)
        throw Error(node.text + " takes " + std::to_string(wanted) + (wanted == 1 ? " argument" : " arguments") + ", not " +
                        std::to_string(node.children.size()),
                    node.at);
      for (const language::Node& argument : node.children) expression(argument);
      return operation(std::uint8_t(i));
    }
    throw Error("there is no function '" + node.text + "'" + suggestion(node.text, Formula::function_names()), node.at);
  }

  Formula& formula_;
  const std::vector<std::string>& names_;
  int depth_ = 0;
};

std::vector<std::string> Formula::function_names() {
  std::vector<std::string> names;
  for (const Operation& o : std::span(operations).subspan(Formula::first_function)) names.emplace_back(o.name);
  return names;
}

int Formula::arguments(std::uint8_t operation) { return operations[operation].arguments; }

Formula::Formula(const std::string& text, const std::vector<std::string>& names, const char* text_name, int first_column) {
  // Line breaks are replaced by blanks, so that the formula is one line. Blanks before the formula make the columns of errors
  // equal to those in the file.
  language::Source source{text_name, {}, std::string(size_t(std::max(first_column, 1) - 1), ' ') + text};
  std::replace(source.text.begin(), source.text.end(), '\n', ' ');
  language::Diagnostics diagnostics;
  std::unique_ptr<language::Node> node;
  try {
    node = language::parse_expression(source, diagnostics);
    diagnostics.raise();
  } catch (const Errors& errors) {
    throw Error(errors.errors.front());
  }
  if (!node) throw Error("the formula cannot be read", {text_name, 1, first_column});
  FormulaCompiler(*this, names).expression(*node);
}

Spectrum Formula::run(const Spectrum* values) const {
  Spectrum stack[deepest + 1];
  Spectrum* top = stack;  // one past the last value
  for (const Step& step : steps_) {
    if (step.operation == Formula::push_number) {
      *top++ = Spectrum(step.number);
    } else if (step.operation == Formula::push_value) {
      *top++ = finite_or_zero(values[step.place]);
    } else {
      const Operation& o = operations[step.operation];
      top -= o.arguments;
      o.run(top);
      *top = finite_or_zero(*top);
      ++top;
    }
  }
  return stack[0];
}

}  // namespace etendue
