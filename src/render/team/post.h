#pragma once
// Post: the one thread of a process that sends and receives its messages, and notices when another process falls silent.

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "messages.h"

namespace etendue {

class Post {
 public:
  /// Both are called on the post's thread.
  struct Handlers {
    std::function<void(int from, std::vector<std::byte>)> received;
    /// Nothing, not even a sign of life, has come from this process for `patience`; called once.
    std::function<void(int silent)> lost;
    /// The process that started this one has ended.
    std::function<void()> orphaned;
  };
  /// Opens the messages, on its thread. Each process gives a sign of life every second; the first rank watches over all others,
  /// which watch over the first. Throws Error.
  Post(std::unique_ptr<Messages>, double patience_seconds);
  /// Closes, unless end was called.
  ~Post();
  Post(const Post&) = delete;
  Post& operator=(const Post&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  /// Begins to receive.
  void start(Handlers);
  /// What was sent to others, and the processor time of the thread.
  struct Traffic {
    std::uint64_t bytes = 0, messages = 0;
    double seconds = 0;
  };
  Traffic traffic() const;    ///< any thread
  void send(int to, Parcel);  ///< any thread
  /// The same when the thread looks next, which spares waking it.
  void send_soon(int to, Parcel);
  /// While one exists, somebody waits for a message: the thread looks more often.
  class Waiting {
   public:
    explicit Waiting(Post&);
    ~Waiting();
    Waiting(const Waiting&) = delete;
    Waiting& operator=(const Waiting&) = delete;

   private:
    Post& post_;
  };
  /// Sends what is left, waits for the others, which must end as well, and ends the thread.
  void end();
  /// Ends all processes at once (Messages::abandon).
  void abandon(int status);

 private:
  using Clock = std::chrono::steady_clock;
  void run();
  bool exchange();
  void watch();

  const std::unique_ptr<Messages> messages_;
  const std::chrono::duration<double> patience_;
  int rank_ = 0, size_ = 1;
  Handlers handlers_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Traffic traffic_;
  std::vector<std::pair<int, Parcel>> outgoing_;
  bool urgent_ = false;  ///< something was sent that must not wait
  int waiting_ = 0;
  bool started_ = false, ending_ = false;
  std::optional<int> abandoned_;  ///< with this status

  // Of the thread alone.
  std::vector<Clock::time_point> heard_;  ///< when the last message of each rank came
  Clock::time_point watched_, signed_;
  bool silent_ = false;
  pid_t starter_ = ::getppid();
  std::thread thread_;
};

}  // namespace etendue
