#pragma once
// Conformance: what must hold of every part of an interface, tested for all classes that the registry knows, plugins
// included, with default and with randomly drawn valid members.

#include <functional>
#include <string>
#include <vector>

#include "etendue/check/conform/trial.h"

namespace etendue::conform {

struct Options {
  std::vector<std::string> classes;  ///< names of classes or interfaces; empty: all
  Effort effort = Effort::standard;
  int drawn = 3;  ///< how many parts with random members, beside the one with defaults
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all cores
  /// Told after each part, from any thread, one at a time.
  std::function<void(const std::string& class_name, int done, int of)> progress = {};
};

/// Runs all checks of the classes asked for; the outcomes depend on the options but for the threads, and on nothing else. A
/// part that cannot be made or throws is an outcome too. Throws Error for a class that is unknown.
std::vector<Outcome> conform(const Options&);

/// The interfaces that have checks of their own, plugins' too, by name.
std::vector<std::string> checked_interfaces();

/// A page that shows outcomes: classes, checks, failures with the parts that failed.
std::string html_report(const std::vector<Outcome>&, const std::string& command_line);

}  // namespace etendue::conform
