#include "post.h"

#include <time.h>

#include <exception>

namespace etendue {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::milliseconds sign_interval = 1s, watch_interval = 50ms;
// The thread looks for messages again after these times, as messages cannot wake it: a look takes some 10 microseconds. While
// nobody waits, what is needed next is there already.
constexpr std::chrono::microseconds shortest_rest = 100us, rest_of_waiting = 1ms, rest_of_busy = 4ms;

/// An empty message is a sign of life.
const Parcel& sign_of_life() {
  static const Parcel empty = std::make_shared<std::vector<std::byte>>();
  return empty;
}

}  // namespace

Post::Post(std::unique_ptr<Messages> messages, double patience) : messages_(std::move(messages)), patience_(patience) {
  std::exception_ptr problem;
  bool opened = false;
  thread_ = std::thread([&] {
    try {
      messages_->open();
      rank_ = messages_->rank();
      size_ = messages_->size();
    } catch (...) {
      problem = std::current_exception();
    }
    std::unique_lock lock(mutex_);
    opened = true;
    changed_.notify_all();
    if (problem) return;
    changed_.wait(lock, [&] { return started_ || ending_ || abandoned_; });
    lock.unlock();
    run();
  });
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return opened; });
  if (!problem) return;
  lock.unlock();
  thread_.join();
  std::rethrow_exception(problem);
}

Post::~Post() { end(); }

void Post::start(Handlers handlers) {
  const std::lock_guard lock(mutex_);
  handlers_ = std::move(handlers);
  started_ = true;
  changed_.notify_all();
}

Post::Traffic Post::traffic() const {
  const std::lock_guard lock(mutex_);
  Traffic now = traffic_;
  clockid_t clock{};
  timespec used{};
  if (pthread_getcpuclockid(const_cast<std::thread&>(thread_).native_handle(), &clock) == 0 && clock_gettime(clock, &used) == 0)
    now.seconds = double(used.tv_sec) + double(used.tv_nsec) * 1e-9;
  return now;
}

void Post::send(int to, Parcel parcel) {
  const std::lock_guard lock(mutex_);
  outgoing_.emplace_back(to, std::move(parcel));
  urgent_ = true;
  changed_.notify_all();
}

void Post::send_soon(int to, Parcel parcel) {
  const std::lock_guard lock(mutex_);
  outgoing_.emplace_back(to, std::move(parcel));
}

Post::Waiting::Waiting(Post& post) : post_(post) {
  const std::lock_guard lock(post_.mutex_);
  if (++post_.waiting_ == 1) post_.changed_.notify_all();
}

Post::Waiting::~Waiting() {
  const std::lock_guard lock(post_.mutex_);
  --post_.waiting_;
}

void Post::end() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

void Post::abandon(int status) {
  {
    const std::lock_guard lock(mutex_);
    abandoned_ = status;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

/// Sends and receives what there is. Returns whether there was anything.
bool Post::exchange() {
  std::vector<std::pair<int, Parcel>> outgoing;
  {
    const std::lock_guard lock(mutex_);
    outgoing.swap(outgoing_);
    for (const auto& [to, parcel] : outgoing) traffic_.bytes += parcel->size();
    traffic_.messages += outgoing.size();
  }
  bool any = !outgoing.empty();
  for (auto& [to, parcel] : outgoing) messages_->send(to, std::move(parcel));
  while (std::optional<Messages::Received> message = messages_->receive()) {
    heard_[size_t(message->from)] = Clock::now();
    any = true;
    if (!message->bytes.empty() && handlers_.received) handlers_.received(message->from, std::move(message->bytes));
  }
  return any;
}

/// Gives signs of life, and notices who gives none.
void Post::watch() {
  const Clock::time_point now = Clock::now();
  if (now - watched_ < watch_interval) return;
  // After a pause of this process itself (SIGSTOP, a laptop's lid) nobody else is to blame.
  if (now - watched_ > 5 * sign_interval)
    for (Clock::time_point& heard : heard_) heard = now;
  watched_ = now;
  if (starter_ != 0 && ::getppid() != starter_) {
    starter_ = 0;
    if (handlers_.orphaned) handlers_.orphaned();
  }
  const int first = rank_ == 0 ? 1 : 0, end = rank_ == 0 ? size_ : 1;
  if (now - signed_ >= sign_interval) {
    signed_ = now;
    for (int other = first; other < end; ++other) messages_->send(other, sign_of_life());
  }
  for (int other = first; other < end && !silent_; ++other)
    if (now - heard_[size_t(other)] > patience_) {
      silent_ = true;
      if (handlers_.lost) handlers_.lost(other);
    }
}

void Post::run() {
  heard_.assign(size_t(size_), Clock::now());
  watched_ = Clock::now();
  std::chrono::microseconds rest = shortest_rest;
  while (true) {
    const bool any = exchange();
    watch();
    std::unique_lock lock(mutex_);
    if (abandoned_) {
      messages_->abandon(*abandoned_);
      return;
    }
    if (urgent_) {
      urgent_ = false;
      continue;
    }
    if (ending_ && outgoing_.empty() && messages_->all_sent()) break;
    const bool busy = waiting_ == 0;
    rest = busy ? rest_of_busy : any ? shortest_rest : std::min(2 * rest, rest_of_waiting);
    changed_.wait_for(lock, rest, [&] { return urgent_ || abandoned_ || (busy && waiting_ > 0); });
  }
  messages_->close();
}

}  // namespace etendue
