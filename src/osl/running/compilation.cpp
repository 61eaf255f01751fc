#include "compilation.h"

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <thread>

#include "etendue/core/error.h"

namespace etendue::osl {

/// Lives until the program ends; then it finishes what it is compiling, and nothing more.
class CompilingThread {
 public:
  static CompilingThread& instance() {
    // Not destroyed: groups may be destroyed later than static objects.
    static auto* const made = [] {
      auto* thread = new CompilingThread;
      std::atexit([] { instance().stop(); });
      return thread;
    }();
    return *made;
  }

  void ask(Compilation& c) {
    const std::lock_guard lock(mutex_);
    if (c.state_ != Compilation::State::none || stopping_) return;
    c.state_ = Compilation::State::waiting;
    queue_.push_back(&c);
    if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
    changed_.notify_all();
  }

  /// The code is there, or being made by no one else.
  void finish(Compilation& c) {
    std::unique_lock lock(mutex_);
    if (c.state_ == Compilation::State::none || c.state_ == Compilation::State::waiting) {
      std::erase(queue_, &c);
      run(c, lock);
    }
    changed_.wait(lock, [&] { return c.state_ == Compilation::State::done; });
  }

  void forget(Compilation& c) {
    std::unique_lock lock(mutex_);
    std::erase(queue_, &c);
    changed_.wait(lock, [&] { return c.state_ != Compilation::State::running; });
  }

 private:
  void run(Compilation& c, std::unique_lock<std::mutex>& lock) {
    c.state_ = Compilation::State::running;
    lock.unlock();
    c.make();
    lock.lock();
    c.state_ = Compilation::State::done;
    changed_.notify_all();
  }

  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return stopping_ || !queue_.empty(); });
      if (stopping_) return;
      Compilation& c = *queue_.front();
      queue_.pop_front();
      run(c, lock);
    }
  }

  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
      changed_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Compilation*> queue_;
  std::thread thread_;
  bool stopping_ = false;
};

Compilation::~Compilation() {
  if (asked_) CompilingThread::instance().forget(*this);
}

void Compilation::begin() {
  if (asked_.exchange(true)) return;
  CompilingThread::instance().ask(*this);
}

void Compilation::finish() {
  asked_ = true;
  CompilingThread::instance().finish(*this);
  if (!made_) throw Error(fault_);
}

void Compilation::make() noexcept {
  try {
    made_ = make_();
  } catch (const std::exception& e) {
    fault_ = e.what();
  }
  if (made_) code_.store(made_->layers.data(), std::memory_order_release);
}

}  // namespace etendue::osl
