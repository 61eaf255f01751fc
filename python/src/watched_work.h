#pragma once
// Long work on a thread of its own, while Python's thread wakes often: Ctrl-C ends the work, and a Python function is called
// with its progress.

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "binding.h"

namespace etendue::python {

/// How far the work is, written by the thread that works and read by Python's.
class WorkProgress {
 public:
  /// `fraction` is from 0 to 1; `what` names what is being done.
  void set(double fraction, std::string what);
  /// What was set since the last call; empty: nothing.
  std::optional<std::pair<double, std::string>> take();

 private:
  std::mutex mutex_;
  std::optional<std::pair<double, std::string>> news_;
};

/// Does the work on another thread, and waits for it without the interpreter's lock. Every 50 ms Python's signal handlers run,
/// and `told(fraction, what)` is called if there is progress; it may be None. If one of these raises, `stop` is called, which
/// is to make the work end soon, and the exception is raised when it has ended. Exceptions of the work are rethrown. Warnings
/// are given to Python at the end.
void do_watched(const std::function<void()>& work, const std::function<void()>& stop, WorkProgress& progress, nb::object told);

}  // namespace etendue::python
