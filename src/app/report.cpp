// Reports errors to the user.

#include "report.h"

#include <fmt/format.h>

#include <cstdio>
#include <vector>

#include "describe/guard.h"
#include "etendue/core/error.h"
#include "etendue/describe/registry.h"
#include "etendue/language/language.h"

namespace etendue {

namespace {

void show_all(const std::vector<Error>& errors) {
  for (const Error& error : errors) {
    std::string text = show(error);
    if (text.empty() || text.back() != '\n') text += '\n';
    fmt::print(stderr, "{}", text);
  }
  fmt::print(stderr, "{} error{}\n", errors.size(), errors.size() == 1 ? "" : "s");
}

/// Names the plugins in use: their code runs in this process and may have failed.
std::string plugins_note() {
  std::string text;
  for (const std::string& file : Registry::instance().plugins()) {
    text += text.empty() ? "classes of plugins are in use:" : ";";
    for (const ClassInfo* info : Registry::instance().all())
      if (info->provider == file) text += " " + info->name;
    text += fmt::format(" of '{}'", file);
  }
  return text.empty() ? text : text + "\n";
}

}  // namespace

int reporting_errors(const Run& run) {
  std::fflush(stdout);
  try {
    return run();
  } catch (const Errors& errors) {
    show_all(errors.errors);
    return exit_status::bad_input;
  } catch (const Error& error) {
    show_all({error});
    return exit_status::bad_input;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "etendue: out of memory\n");
  } catch (...) {
    fmt::print(stderr, "etendue: unexpected failure: {}\n{}", thrown_text(), plugins_note());
  }
  return exit_status::failed;
}

}  // namespace etendue
