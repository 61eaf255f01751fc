#pragma once
// Worker: a function that runs on a thread of its own, while Python's thread wakes often.

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace etendue::python {

/// Made and used by a thread that holds the interpreter's lock, which it gives away while it waits: the work may call Python,
/// and a thread that has called Python takes the lock once more when it ends.
class Worker {
 public:
  explicit Worker(std::function<void()> work);
  ~Worker() { join(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Waits for 50 ms at most. Returns whether the work has ended.
  bool wait();
  /// Waits until the work has ended.
  void join();
  /// The exception that the work threw, null if none; after `join`, or when `wait` has returned true.
  const std::exception_ptr& thrown() const { return thrown_; }

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool done_ = false;
  std::exception_ptr thrown_;
  std::thread thread_;  // the last member: it uses the others
};

/// Runs Python's signal handlers; throws what they raise, such as KeyboardInterrupt.
void check_signals();

}  // namespace etendue::python
