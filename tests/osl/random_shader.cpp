#include "random_shader.h"

#include <fmt/format.h>

namespace etendue::osl {
namespace {

std::string_view type_name(char type) {
  switch (type) {
    case 'i': return "int";
    case 'f': return "float";
    case 'c': return "color";
    case 'v': return "vector";
    case 'm': return "matrix";
    case 's': return "string";
    default: return "Pair";
  }
}

}  // namespace

std::string RandomShader::text() {
  text_ = "struct Pair { float a; color b; int c; };\n\n";
  for (int i = 0; i < 3; ++i) function(i);
  text_ +=
      "surface random(float knob = 0.7, color tint = color(0.2, 0.4, 0.9), int count = 3, string word = \"six\",\n"
      "    output int o_i = 1, output float o_f = 0.5, output color o_c = 0.25, output vector o_v = P,\n"
      "    output matrix o_m = 1, output string o_s = \"\", output float o_F[4] = {1, 2, 3, 4},\n"
      "    output color o_C[3] = {color(1, 2, 3), color(0), color(u, v, 1)}, output Pair o_S = {1, color(2), 3})\n{\n";
  variables_ = {{"knob", 'f', false}, {"tint", 'c', false}, {"count", 'i', false}, {"word", 's', false}, {"o_i", 'i'},
                {"o_f", 'f'},         {"o_c", 'c'},         {"o_v", 'v'},          {"o_m", 'm'},         {"o_s", 's'},
                {"o_F", 'F'},         {"o_C", 'C'},         {"o_S", 'S'},          {"u", 'f', false},    {"v", 'f', false},
                {"P", 'v', false},    {"N", 'v', false},    {"I", 'v', false}};
  indent_ = 1;
  left_ = 6 + below(10);
  while (left_ > 0) statement(3);
  line(fmt::format("Ci = {};", closure()));
  if (chance(30)) line("o_F[0] += Dx(o_f) + filterwidth(o_f) + area(P + o_v);");
  text_ += "}\n";
  return text_;
}

void RandomShader::function(int number) {
  static constexpr std::string_view kinds = "fci";
  const char type = kinds[std::size_t(number)];
  variables_ = {{"x", 'f', false}, {"y", 'c', false}, {"k", 'i', false}, {"back", 'f'}};
  text_ += fmt::format("{} f{}(float x, color y, int k, output float back) {{\n", type_name(type), number);
  indent_ = 1;
  left_ = 2 + below(4);
  while (left_ > 0) statement(2);
  if (chance(40)) line(fmt::format("if ({}) return {};", condition(1), expression(type, 1)));
  line(fmt::format("return {};", expression(type, 2)));
  text_ += "}\n\n";
  ++functions_;
}

// ---- statements ------------------------------------------------------------------------------------------------------------

void RandomShader::statement(int depth) {
  --left_;
  const int kind = below(depth > 0 ? 16 : 9);
  if (kind < 3) return declaration();
  if (kind < 8) return assignment();
  if (kind == 8) {
    if (loops_ > 0 && chance(30)) return line(fmt::format("if ({}) {};", condition(1), chance(50) ? "break" : "continue"));
    if (chance(25)) return line(fmt::format("printf(\"%g %s\\n\", {}, {});", expression('f', 1), expression('s', 1)));
    return assignment();
  }
  if (kind < 12) return loop(depth - 1);
  if (kind == 15 && chance(10)) return line(fmt::format("if ({}) exit();", condition(2)));
  line(fmt::format("if ({}) {{", condition(2)));
  block(depth - 1);
  if (chance(50)) {
    line("} else {");
    block(depth - 1);
  }
  line("}");
}

void RandomShader::block(int depth) {
  const std::size_t before = variables_.size();
  ++indent_;
  for (int i = 1 + below(3); i > 0; --i) statement(depth);
  --indent_;
  variables_.resize(before);
}

void RandomShader::declaration() {
  static constexpr std::string_view types = "iffccvmsFCS";
  const char type = types[std::size_t(below(int(types.size())))];
  const std::string name = fmt::format("x{}", names_++);
  if (type == 'F')
    line(fmt::format("float {}[4] = {{{}, {}, {}, {}}};", name, expression('f', 1), expression('f', 1), expression('f', 0),
                     expression('f', 0)));
  else if (type == 'C')
    line(fmt::format("color {}[3];", name));
  else if (type == 'S')
    line(fmt::format("Pair {} = {{{}, {}, {}}};", name, expression('f', 1), expression('c', 1), expression('i', 1)));
  else if (chance(10))
    line(fmt::format("{} {};", type_name(type), name));
  else
    line(fmt::format("{} {} = {};", type_name(type), name, expression(type, 3)));
  variables_.push_back({name, type});
}

void RandomShader::assignment() {
  static constexpr std::string_view types = "iffccvms";
  const char type = types[std::size_t(below(int(types.size())))];
  const std::string to = variable(type, true);
  if (to.empty()) return declaration();
  static constexpr std::string_view real[] = {"=", "=", "+=", "-=", "*=", "/="};
  static constexpr std::string_view whole[] = {"=", "+=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="};
  const std::string_view how = type == 's' || type == 'm' ? "=" : (type == 'i' ? any(whole) : any(real));
  if ((type == 'i' || type == 'f') && chance(15)) return line(fmt::format("{}{};", to, chance(50) ? "++" : "--"));
  line(fmt::format("{} {} {};", to, how, expression(type, 3)));
}

void RandomShader::loop(int depth) {
  const std::string name = fmt::format("n{}", names_++);
  ++loops_;
  const int kind = below(3), steps = 1 + below(5);
  const std::size_t before = variables_.size();
  if (kind == 0) {
    line(fmt::format("for (int {0} = 0; {0} < {1}; ++{0}) {{", name, steps));
    variables_.push_back({name, 'i', false});
    block(depth);
    line("}");
  } else {
    line(fmt::format("int {} = {};", name, steps));
    variables_.push_back({name, 'i', false});
    line(kind == 1 ? fmt::format("while ({}-- > 0) {{", name) : "do {");
    block(depth);
    line(kind == 1 ? "}" : fmt::format("}} while (--{} > 0);", name));
  }
  if (kind == 0) variables_.resize(before);
  --loops_;
}

std::string RandomShader::closure() {
  return fmt::format("{} * diffuse({}) + ({} ? {} * emission() : {} * phong(N, {}))", expression('c', 2), expression('v', 1),
                     condition(1), expression('f', 1), expression('c', 1), expression('f', 1));
}

// ---- expressions -----------------------------------------------------------------------------------------------------------

std::string RandomShader::index(int count) {
  std::string found;
  int seen = 0;
  for (const Variable& v : variables_)
    if (v.type == 'i' && below(++seen) == 0) found = v.name;
  if (found.empty() || chance(50)) return std::to_string(below(count));
  return chance(90) ? fmt::format("abs({}) % {}", found, count) : found;  // the least int is its own absolute value
}

std::string RandomShader::variable(char type, bool to_write) {
  std::vector<std::string> found;
  for (std::size_t k = 0; k < variables_.size(); ++k) {
    const Variable v = variables_[k];
    if (to_write && !v.writable) continue;
    if (v.type == type) found.push_back(v.name);
    if (v.type == 'F' && type == 'f') found.push_back(fmt::format("{}[{}]", v.name, index(4)));
    if (v.type == 'C' && type == 'c') found.push_back(fmt::format("{}[{}]", v.name, index(3)));
    if (v.type == 'C' && type == 'f' && chance(30)) found.push_back(fmt::format("{}[{}][{}]", v.name, index(3), index(3)));
    if ((v.type == 'c' || v.type == 'v') && type == 'f') found.push_back(fmt::format("{}[{}]", v.name, index(3)));
    if (v.type == 'm' && type == 'f' && chance(30)) found.push_back(fmt::format("{}[{}][{}]", v.name, index(4), index(4)));
    if (v.type == 'S' && type == 'f') found.push_back(v.name + ".a");
    if (v.type == 'S' && type == 'c') found.push_back(v.name + ".b");
    if (v.type == 'S' && type == 'i') found.push_back(v.name + ".c");
    if (found.size() > 12) break;  // each may have cost expressions
  }
  return found.empty() ? "" : found[std::size_t(below(int(found.size())))];
}

std::string RandomShader::literal(char type) {
  static constexpr std::string_view numbers[] = {"0.0", "1.0", "-1.0", "0.5", "2.25", "-0.3", "1e-20", "3e8", "17.5"};
  static constexpr std::string_view wholes[] = {"0", "1", "-1", "2", "7", "31", "1000003"};
  static constexpr std::string_view texts[] = {"\"\"", "\"six\"", "\"a b\"", "\"%\""};
  switch (type) {
    case 'i': return std::string(any(wholes));
    case 'f': return std::string(any(numbers));
    case 's': return std::string(any(texts));
    case 'm': return fmt::format("matrix({})", any(numbers));
    default: return fmt::format("{}({}, {}, {})", type_name(type), any(numbers), any(numbers), any(numbers));
  }
}

std::string RandomShader::condition(int depth) {
  static constexpr std::string_view compare[] = {"==", "!=", "<", "<=", ">", ">="};
  const int kind = below(depth > 0 ? 7 : 3);
  if (kind == 0) return fmt::format("({} {} {})", expression('i', depth - 1), any(compare), expression('i', depth - 1));
  if (kind < 3) return fmt::format("({} {} {})", expression('f', depth - 1), any(compare), expression('f', depth - 1));
  if (kind == 3) return fmt::format("({} == {})", expression('c', depth - 1), expression('c', depth - 1));
  if (kind == 4) return fmt::format("({} != {})", expression('s', depth - 1), expression('s', depth - 1));
  if (kind == 5) return fmt::format("!{}", condition(depth - 1));
  return fmt::format("({} {} {})", condition(depth - 1), chance(50) ? "&&" : "||", condition(depth - 1));
}

std::string RandomShader::expression(char type, int depth) {
  if (depth <= 0 || chance(20)) {
    const std::string v = chance(75) ? variable(type, false) : "";
    return v.empty() ? literal(type) : v;
  }
  if (chance(8)) return fmt::format("({} ? {} : {})", condition(1), expression(type, depth - 1), expression(type, depth - 1));
  switch (type) {
    case 'i': return int_expression(depth - 1);
    case 'f': return float_expression(depth - 1);
    case 'm': return matrix_expression(depth - 1);
    case 's': return string_expression(depth - 1);
    default: return triple_expression(type, depth - 1);
  }
}

std::string RandomShader::int_expression(int depth) {
  static constexpr std::string_view operators[] = {"+", "-", "*", "/", "%", "&", "|", "^", "<<", ">>"};
  static constexpr std::string_view functions[] = {"min", "max", "mod"};
  const auto i = [&] { return expression('i', depth); };
  switch (below(8)) {
    case 0: return fmt::format("int({})", expression('f', depth));
    case 1: return condition(depth);
    case 2: return fmt::format("{}({}, {})", any(functions), i(), i());
    case 3: return fmt::format("clamp(abs({}), {}, {})", i(), i(), i());
    case 4: return chance(50) ? fmt::format("(- {})", i()) : fmt::format("(~ {})", i());
    case 5: {
      const std::string back = variable('f', true);
      if (functions_ < 3 || back.empty()) return fmt::format("strlen({})", expression('s', depth));
      return fmt::format("f2({}, {}, {}, {})", expression('f', depth), expression('c', depth), i(), back);
    }
    default: return fmt::format("({} {} {})", i(), any(operators), i());
  }
}

std::string RandomShader::float_expression(int depth) {
  static constexpr std::string_view operators[] = {"+", "-", "*", "/"};
  static constexpr std::string_view one[] = {"sin",  "cos",  "tan",  "sqrt",    "inversesqrt", "abs",   "floor", "ceil",
                                             "exp",  "exp2", "log",  "sign",    "round",       "trunc", "acos",  "asin",
                                             "atan", "cbrt", "tanh", "radians", "degrees",     "erf",   "log2",  "fabs"};
  static constexpr std::string_view two[] = {"min", "max", "pow", "mod", "fmod", "step", "atan2", "hypot"};
  static constexpr std::string_view three[] = {"clamp", "mix", "smoothstep", "linearstep", "select"};
  static constexpr std::string_view noises[] = {"perlin", "uperlin", "cell", "simplex", "hash"};
  const auto f = [&] { return expression('f', depth); };
  const auto t = [&] { return expression('v', depth); };
  switch (below(15)) {
    case 0:
    case 1: return fmt::format("{}({})", any(one), f());
    case 2: return fmt::format("{}({}, {})", any(two), f(), f());
    case 3: return fmt::format("{}({}, {}, {})", any(three), f(), f(), f());
    case 4: return fmt::format("float({})", expression('i', depth));
    case 5: return fmt::format("dot({}, {})", t(), t());
    case 6: return chance(50) ? fmt::format("length({})", t()) : fmt::format("distance({}, {})", t(), t());
    case 7: return fmt::format("noise(\"{}\", {})", any(noises), chance(50) ? t() : f());
    case 8: return chance(50) ? fmt::format("Dx({})", f()) : fmt::format("filterwidth({})", f());
    case 9: return fmt::format("(- {})", f());
    case 10: {
      const std::string back = variable('f', true);
      if (functions_ < 1 || back.empty()) return fmt::format("luminance({})", expression('c', depth));
      return fmt::format("f0({}, {}, {}, {})", f(), expression('c', depth), expression('i', depth), back);
    }
    case 11:
      return fmt::format("{}[{}]", expression('m', 0).starts_with("matrix") ? "normalize(P + N)" : "cross(P, I)", below(3));
    default: return fmt::format("({} {} {})", f(), any(operators), f());
  }
}

std::string RandomShader::triple_expression(char type, int depth) {
  static constexpr std::string_view operators[] = {"+", "-", "*", "/"};
  static constexpr std::string_view one[] = {"sin", "sqrt", "abs", "floor", "exp", "inversesqrt", "log"};
  static constexpr std::string_view two[] = {"min", "max", "pow", "mod"};
  static constexpr std::string_view three[] = {"clamp", "mix", "smoothstep", "linearstep"};
  const std::string_view name = type_name(type);
  const auto t = [&] { return expression(type, depth); };
  const auto f = [&] { return expression('f', depth); };
  switch (below(13)) {
    case 0: return fmt::format("{}({}, {}, {})", name, f(), f(), f());
    case 1: return fmt::format("{}({})", any(one), t());
    case 2: return fmt::format("{}({}, {})", any(two), t(), t());
    case 3: return fmt::format("{}({}, {}, {})", any(three), t(), t(), t());
    case 4: return fmt::format("mix({}, {}, {})", t(), t(), f());
    case 5: return fmt::format("({} * {})", t(), f());
    case 6:
      if (type == 'v') return fmt::format("normalize({})", t());
      return fmt::format("{}(noise(\"perlin\", {}))", name, expression('v', depth));
    case 7:
      if (type == 'v')
        return chance(50) ? fmt::format("cross({}, {})", t(), t())
                          : fmt::format("transform({}, {})", expression('m', depth), t());
      return fmt::format("{}({})", name, f());
    case 8:
      if (type == 'v')
        return chance(50) ? fmt::format("reflect({}, {})", t(), t()) : fmt::format("faceforward({}, I, {})", t(), t());
      return fmt::format("(- {})", t());
    case 9: {
      const std::string back = variable('f', true);
      if (type != 'c' || functions_ < 2 || back.empty()) return fmt::format("Dx({})", t());
      return fmt::format("f1({}, {}, {}, {})", f(), t(), expression('i', depth), back);
    }
    default: return fmt::format("({} {} {})", t(), any(operators), t());
  }
}

std::string RandomShader::matrix_expression(int depth) {
  const auto m = [&] { return expression('m', depth); };
  switch (below(5)) {
    case 0: return fmt::format("({} * {})", m(), m());
    case 1: return fmt::format("({} * {})", m(), expression('f', depth));
    case 2: return fmt::format("transpose({})", m());
    case 3: return fmt::format("({} / {})", m(), chance(50) ? m() : expression('f', depth));
    default: return fmt::format("(- {})", m());
  }
}

std::string RandomShader::string_expression(int depth) {
  switch (below(3)) {
    case 0: return fmt::format("substr({}, {}, {})", expression('s', depth), expression('i', depth), below(5));
    case 1: return fmt::format("format(\"%d\", {})", expression('i', depth));
    default: return fmt::format("substr(concat({}, {}), 0, 6)", expression('s', depth), expression('s', depth));
  }
}

}  // namespace etendue::osl
