#include "interpreter.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "etendue/core/error.h"

namespace etendue::python {

namespace {

std::atomic<bool> is_ending = false, is_closed = false;
std::atomic<std::thread::id> closing_thread;
/// Calls from the library that hold the interpreter's lock or wait for it; threads of Python that gave it away; long works.
std::atomic<int> inside = 0, away = 0, works = 0;

[[noreturn]] void refuse() {
  throw Error("the Python interpreter is about to end, and parts that are written in Python with it");
}

/// Counts a call; throws if Python may not be called any more.
void enter() {
  ++inside;
  if (!is_closed) return;
  --inside;
  refuse();
}
void leave() { --inside; }

/// Waits, without the lock, until a count is 0: long enough for all that is not stuck. Without a limit one that waits forever
/// would keep the process alive.
void wait_for_none(const std::atomic<int>& count) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (count > 0 && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

/// The Python state of a thread that Python did not start.
class KeptState {
 public:
  /// Makes the state, without the lock.
  void keep() {
    if (kept_ || PyGILState_GetThisThreadState()) return;
    PyGILState_Ensure();
    PyEval_SaveThread();
    kept_ = true;
  }
  ~KeptState() {
    if (!kept_) return;
    try {
      enter();
    } catch (const Error&) {
      return;  // the interpreter deletes the state
    }
    PyGILState_Ensure();
    PyGILState_Release(PyGILState_LOCKED);    // the count of this function's Ensure
    PyGILState_Release(PyGILState_UNLOCKED);  // that of keep(): deletes the state
    leave();
  }

 private:
  bool kept_ = false;
};

}  // namespace

Interpreter::Interpreter() {
  enter();
  thread_local KeptState state;
  state.keep();
  state_ = PyGILState_Ensure();
}

Interpreter::~Interpreter() {
  PyGILState_Release(state_);
  leave();
}

bool Interpreter::ending() { return is_ending; }

void Interpreter::require_future() {
  if (is_ending && closing_thread.load() != std::this_thread::get_id()) refuse();
}

bool Interpreter::closed() { return is_closed; }

void Interpreter::close(void (*stop_work)()) {
  closing_thread = std::this_thread::get_id();
  is_ending = true;
  stop_work();
  const nanobind::gil_scoped_release without;
  wait_for_none(works);
  is_closed = true;
  wait_for_none(inside);
  wait_for_none(away);
}

void Interpreter::forget_threads() { inside = away = works = 0; }

WithoutLock::WithoutLock() {
  ++away;
  state_ = PyEval_SaveThread();
}

WithoutLock::~WithoutLock() {
  if (is_closed && closing_thread.load() != std::this_thread::get_id()) {
    --away;
    while (true) ::pause();
  }
  PyEval_RestoreThread(state_);
  --away;
}

WatchedWork::WatchedWork() {
  Interpreter::require_future();
  ++works;
}

WatchedWork::~WatchedWork() { --works; }

}  // namespace etendue::python
