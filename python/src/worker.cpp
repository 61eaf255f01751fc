#include "worker.h"

#include <nanobind/nanobind.h>

#include <chrono>

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
  const nanobind::gil_scoped_release without;
  std::unique_lock lock(mutex_);
  return ended_.wait_for(lock, interval, [&] { return done_; });
}

void Worker::join() {
  if (!thread_.joinable()) return;
  const nanobind::gil_scoped_release without;
  thread_.join();
}

void check_signals() {
  if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
}

}  // namespace etendue::python
