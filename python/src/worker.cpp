#include "worker.h"

#include <chrono>

#include "interpreter.h"

namespace etendue::python {

Worker::Worker(std::function<void()> work)
    : thread_([this, work = std::move(work)] {
        try {
          work();
        } catch (...) {
          thrown_ = std::current_exception();
        }
        const std::lock_guard lock(mutex_);
        done_ = true;
        ended_.notify_all();
      }) {}

bool Worker::wait() {
  constexpr std::chrono::milliseconds interval{50};
  const WithoutLock without;
  std::unique_lock lock(mutex_);
  return ended_.wait_for(lock, interval, [&] { return done_; });
}

void Worker::join() {
  if (!thread_.joinable()) return;
  const WithoutLock without;
  thread_.join();
}

void check_signals() {
  if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
}

}  // namespace etendue::python
