#include "watched_work.h"

#include <nanobind/stl/string.h>

#include <chrono>
#include <condition_variable>
#include <thread>

namespace etendue::python {

void WorkProgress::set(double fraction, std::string what) {
  const std::lock_guard lock(mutex_);
  news_.emplace(fraction, std::move(what));
}

std::optional<std::pair<double, std::string>> WorkProgress::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, std::nullopt);
}

namespace {

/// A thread with its end, which the owner waits for.
class Worker {
 public:
  explicit Worker(const std::function<void()>& work)
      : thread_([this, &work] {
          try {
            work();
          } catch (...) {
            thrown_ = std::current_exception();
          }
          const std::lock_guard lock(mutex_);
          done_ = true;
          ended_.notify_one();
        }) {}
  /// Without the interpreter's lock: a thread that has called Python takes it once more when it ends.
  ~Worker() {
    const nb::gil_scoped_release without;
    thread_.join();
  }

  /// Waits without the interpreter's lock; whether the work has ended.
  bool ended_within(std::chrono::milliseconds time) {
    const nb::gil_scoped_release without;
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, time, [&] { return done_; });
  }
  /// What the work threw; null: nothing. To be called when it has ended.
  const std::exception_ptr& thrown() const { return thrown_; }

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool done_ = false;
  std::exception_ptr thrown_;
  std::thread thread_;  // the last member: it uses the others
};

void tell(WorkProgress& progress, const nb::object& told) {
  if (told.is_none()) return;
  if (const auto news = progress.take()) told(news->first, news->second);
}

}  // namespace

void do_watched(const std::function<void()>& work, const std::function<void()>& stop, WorkProgress& progress, nb::object told) {
  using namespace std::chrono_literals;
  std::exception_ptr raised;
  Worker worker(work);
  while (!worker.ended_within(50ms)) {
    if (raised) continue;
    try {
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
      tell(progress, told);
    } catch (...) {
      raised = std::current_exception();
      stop();
    }
  }
  if (raised) std::rethrow_exception(raised);
  if (worker.thrown()) std::rethrow_exception(worker.thrown());
  tell(progress, told);
  tell_warnings();
}

}  // namespace etendue::python
