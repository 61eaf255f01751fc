// The outcomes as the text that `etendue conform` prints.

#include <fmt/format.h>

#include <map>

#include "conformance.h"

namespace etendue::conform {
namespace {

/// Indents each line and drops empty lines.
std::string set_in(const std::string& text, const std::string& margin) {
  std::string out;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    if (end > begin) out += margin + text.substr(begin, end - begin) + "\n";
    begin = end + 1;
  }
  return out;
}

}  // namespace

std::string results_text(const std::vector<Outcome>& outcomes, bool parts) {
  struct Tally {
    int passed = 0, failed = 0, not_tried = 0;
  };
  std::map<std::string, Tally> classes;
  Tally all;
  for (const Outcome& o : outcomes)
    for (Tally* t : {&classes[o.class_name], &all})
      ++(o.result == Result::passed ? t->passed : o.result == Result::failed ? t->failed : t->not_tried);

  std::string text;
  const std::string* last_part = nullptr;
  for (const auto& [name, tally] : classes) {
    text += fmt::format("{:32} {:4} passed{}{}\n", name, tally.passed,
                        tally.failed > 0 ? fmt::format(", {} FAILED", tally.failed) : "",
                        tally.not_tried > 0 ? fmt::format(", {} not tried", tally.not_tried) : "");
    for (const Outcome& o : outcomes) {
      if (o.class_name != name) continue;
      if (parts && (!last_part || *last_part != o.part)) text += set_in(o.part, "    ");
      last_part = &o.part;
      if (o.result == Result::passed) continue;
      text +=
          fmt::format("  {}: {}\n{}", o.result == Result::failed ? "FAILED" : "not tried", o.check, set_in(o.detail, "    "));
      if (!parts) text += set_in(o.part, "    | ");
    }
  }
  return text + fmt::format("{} classes, {} checks passed, {} failed, {} not tried\n", classes.size(), all.passed, all.failed,
                            all.not_tried);
}

}  // namespace etendue::conform
