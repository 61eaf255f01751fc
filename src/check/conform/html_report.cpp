// Writes outcomes as one self-contained HTML page.

#include <fmt/format.h>

#include <map>
#include <set>

#include "conformance.h"
#include "describe/html_text.h"

namespace etendue::conform {
namespace {

constexpr std::string_view style = R"(
pre { font-size: .85rem; overflow-wrap: anywhere; background: var(--panel); padding: .6rem; white-space: pre-wrap;
      border-radius: .3rem; }
.passed { color: var(--good); } .failed { color: var(--bad); } .not { color: var(--open); }
.failed, .not { font-weight: 600; }
table { border-collapse: collapse; font-size: .9rem; } td, th { padding: .25rem .8rem .25rem 0; text-align: left;
        border-bottom: 1px solid var(--line); vertical-align: top; } td.n { text-align: right; }
)";

struct Tally {
  int passed = 0, failed = 0, not_tried = 0;
  void add(Result r) { ++(r == Result::passed ? passed : r == Result::failed ? failed : not_tried); }
};

const char* css(Result r) { return r == Result::passed ? "passed" : r == Result::failed ? "failed" : "not"; }

std::string remark(const Outcome& o) {
  return fmt::format("<p><span class=\"{}\">{}</span> {}<br>{}</p>\n<pre>{}</pre>\n", css(o.result),
                     o.result == Result::failed ? "FAILED" : "not tried", escaped(o.check), escaped(o.detail), escaped(o.part));
}

}  // namespace

std::string html_report(const std::vector<Outcome>& outcomes, const std::string& command_line) {
  std::map<std::string, std::map<std::string, Tally>> classes;  // by class and check
  std::map<std::string, Tally> totals;
  std::map<std::string, std::set<std::string>> parts;
  Tally all;
  for (const Outcome& o : outcomes) {
    classes[o.class_name][o.check].add(o.result);
    totals[o.class_name].add(o.result);
    parts[o.class_name].insert(o.part);
    all.add(o.result);
  }
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta "
      "charset=\"utf-8\"><title>Conformance</title><style>{}{}</style></head><body>\n"
      "<h1>Conformance of {} classes</h1>\n<p><code>{}</code></p>\n<p>{} checks of single parts passed, "
      "<span class=\"{}\">{} failed</span>, {} could not be made.</p>\n",
      page_style, style, classes.size(), escaped(command_line), all.passed, all.failed > 0 ? "failed" : "passed", all.failed,
      all.not_tried);

  html += "<div class=\"scroll\"><table><tr><th>class<th>parts<th>passed<th>failed<th>not tried</tr>\n";
  for (const auto& [name, t] : totals)
    html += fmt::format(
        "<tr><td><a href=\"#{0}\">{0}</a><td class=\"n\">{1}<td class=\"n\">{2}<td class=\"n {3}\">{4}<td "
        "class=\"n\">{5}</tr>\n",
        escaped(name), parts[name].size(), t.passed, t.failed > 0 ? "failed" : "quiet", t.failed, t.not_tried);
  html += "</table></div>\n";

  for (const auto& [name, checks] : classes) {
    html += fmt::format("<h2 id=\"{0}\">{0}</h2>\n", escaped(name));
    for (const Outcome& o : outcomes)
      if (o.class_name == name && o.result != Result::passed) html += remark(o);
    html += "<details><summary>checks</summary><div class=\"scroll\"><table>\n";
    for (const auto& [check, t] : checks)
      html += fmt::format("<tr><td class=\"{}\">{}<td class=\"n\">{} of {}</tr>\n",
                          t.failed > 0   ? "failed"
                          : t.passed > 0 ? "passed"
                                         : "not",
                          escaped(check), t.passed, t.passed + t.failed + t.not_tried);
    html += "</table></div></details>\n<details><summary>parts</summary>\n";
    for (const std::string& part : parts[name]) html += fmt::format("<pre>{}</pre>\n", escaped(part));
    html += "</details>\n";
  }
  return html + "</body></html>\n";
}

}  // namespace etendue::conform
