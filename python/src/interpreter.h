#pragma once
// The interpreter's lock: taken by threads of the library, given away by threads of Python, and what becomes of both when the
// interpreter ends.
//
// A daemon thread of Python that takes the lock after the interpreter has begun to end is unwound by Python (before 3.14),
// which frames of C++ do not survive: std::terminate. So no thread of Python that comes back from the library takes the lock
// from then on (WithoutLock); it sleeps until the process ends.

#include <nanobind/nanobind.h>

namespace etendue::python {

/// Holds the interpreter's lock, in a thread of whatever origin. A thread that Python does not know keeps its Python state
/// until it ends: making a new one for each call would take longer than most calls. Throws Error when the interpreter is about
/// to end.
class Interpreter {
 public:
  Interpreter();
  ~Interpreter();
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  /// Whether the interpreter is about to end: long work stops, and none begins.
  static bool ending();
  /// Throws Error if the interpreter is about to end.
  static void require_future();
  /// Whether Python may no longer be called, as it is about to end or has ended.
  static bool closed();
  /// Ends long work (`stop_work`, which is called with the lock), lets all later calls fail, and waits for those that run now.
  /// Called by Python's atexit, with the lock.
  static void close(void (*stop_work)());
  /// In a process that was forked: the threads that were counted are not there.
  static void forget_threads();

 private:
  PyGILState_STATE state_;
};

/// Gives the interpreter's lock away while it lives. A thread that comes back after Interpreter::close does not go on.
class WithoutLock {
 public:
  WithoutLock();
  ~WithoutLock();
  WithoutLock(const WithoutLock&) = delete;
  WithoutLock& operator=(const WithoutLock&) = delete;

 private:
  PyThreadState* state_;
};

/// Long work that wakes often and ends when Interpreter::ending; the interpreter waits for it.
class WatchedWork {
 public:
  WatchedWork();
  ~WatchedWork();
  WatchedWork(const WatchedWork&) = delete;
  WatchedWork& operator=(const WatchedWork&) = delete;
};

}  // namespace etendue::python
