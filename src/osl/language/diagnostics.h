#pragma once
// Collects errors and warnings while a text is compiled.

#include <string>
#include <vector>

#include "compile.h"

namespace etendue::osl {

class Diagnostics {
 public:
  explicit Diagnostics(int most_errors) : most_errors_(most_errors) {}

  /// Thrown by `error` when there are too many, and by those that cannot go on: nothing more is to be said.
  struct Stop {};

  void error(Location at, std::string text) {
    list.push_back({false, at, std::move(text)});
    if (++errors_ >= most_errors_) throw Stop{};
  }
  void warning(Location at, std::string text) {
    constexpr int most_warnings = 1000;
    if (++warnings_ <= most_warnings) list.push_back({true, at, std::move(text)});
  }
  bool failed() const { return errors_ > 0; }

  std::vector<Diagnostic> list;

 private:
  int most_errors_, errors_ = 0, warnings_ = 0;
};

}  // namespace etendue::osl
