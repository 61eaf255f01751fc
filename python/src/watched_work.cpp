#include "watched_work.h"

#include <nanobind/stl/string.h>

#include "interpreter.h"
#include "worker.h"

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

void tell(WorkProgress& progress, const nb::object& told) {
  if (told.is_none()) return;
  if (const auto news = progress.take()) told(news->first, news->second);
}

}  // namespace

void do_watched(const std::function<void()>& work, const std::function<void()>& stop, WorkProgress& progress, nb::object told) {
  const WatchedWork counted;
  std::exception_ptr raised;
  Worker worker(work);
  while (!worker.wait()) {
    if (raised) continue;
    try {
      Interpreter::require_future();
      check_signals();
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
