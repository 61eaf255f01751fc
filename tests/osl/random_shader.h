#pragma once
// RandomShader: the text of a well-typed shader, made at random: for comparisons of two ways to run it.

#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::osl {

class RandomShader {
 public:
  explicit RandomShader(unsigned seed) : random_(seed) {}

  /// A surface with outputs of all types. Divisions by zero, indices out of range and the like occur; no loop is long.
  std::string text();

 private:
  struct Variable {
    std::string name;
    char type;  // i int, f float, c color, v vector, m matrix, s string, F float[4], C color[3], S the structure
    bool writable = true;
  };

  int below(int n) { return int(random_() % unsigned(n)); }
  bool chance(int percent) { return below(100) < percent; }
  template <std::size_t n>
  std::string_view any(const std::string_view (&words)[n]) {
    return words[below(int(n))];
  }
  /// A variable of the type, or one of its parts; empty: there is none.
  std::string variable(char type, bool to_write);
  std::string index(int count);
  std::string expression(char type, int depth);
  std::string literal(char type);
  std::string int_expression(int depth);
  std::string float_expression(int depth);
  std::string triple_expression(char type, int depth);
  std::string matrix_expression(int depth);
  std::string string_expression(int depth);
  std::string condition(int depth);
  std::string closure();
  void statement(int depth);
  void block(int depth);
  void declaration();
  void assignment();
  void loop(int depth);
  void function(int number);
  void line(const std::string& text) { text_ += std::string(std::size_t(2 * indent_), ' ') + text + "\n"; }

  std::mt19937 random_;
  std::string text_;
  std::vector<Variable> variables_;
  int names_ = 0, indent_ = 1, loops_ = 0, functions_ = 0, left_ = 0;
};

}  // namespace etendue::osl
