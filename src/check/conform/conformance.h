#pragma once
// Conformance: tests the contract of every interface, for all classes in the registry including those of plugins, with default
// and with random valid members.

#include <functional>
#include <string>
#include <vector>

#include "etendue/check/conform/trial.h"

namespace etendue::conform {

struct Options {
  std::vector<std::string> classes;  ///< names of classes or interfaces; empty: all
  Effort effort = Effort::standard;
  int drawn = 3;  ///< the number of components with random members, in addition to the one with defaults
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all cores
  /// Called after each component, from any thread, one call at a time.
  std::function<void(const std::string& class_name, int done, int of)> progress = {};
  /// Called before each component, from any thread; false ends all, and the outcomes are those of the components until then.
  std::function<bool()> go_on = {};
};

/// Runs all checks of the chosen classes. The outcomes depend on the options only, except for the number of threads. A
/// component that cannot be created or throws is an outcome too. Throws Error for an unknown class.
std::vector<Outcome> conform(const Options&);

/// The names of the interfaces that have checks of their own, including those of plugins.
std::vector<std::string> checked_interfaces();

/// The text that `etendue conform` prints: failures and checks that could not be run in full, the rest in one line for each
/// class. `parts`: also the components that were tested.
std::string results_text(const std::vector<Outcome>&, bool parts = false);

/// An HTML page with the outcomes: classes, checks, and the components that failed.
std::string html_report(const std::vector<Outcome>&, const std::string& command_line);

}  // namespace etendue::conform
