#pragma once
// Tasks that take long: checks of classes, in separate processes, and pictures computed beside the render.

#include <atomic>
#include <functional>
#include <list>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

namespace etendue::studio {

/// Each task has a thread, which calls `tell` with events for all browsers.
class Tasks {
 public:
  using Json = nlohmann::ordered_json;
  explicit Tasks(std::function<void(const Json&)> tell) : tell_(std::move(tell)) {}
  /// Ends all tasks.
  ~Tasks();
  Tasks(const Tasks&) = delete;
  Tasks& operator=(const Tasks&) = delete;

  /// The interface by which a task reports.
  struct Work {
    const std::atomic<bool>& ended;               ///< the task should end
    std::function<void(double)> done;             ///< reports the finished fraction
    std::function<void(const std::string&)> say;  ///< reports further text
  };
  /// Starts a task; its return value is added to the last event. Returns the number in its events. Throws Error if there are
  /// too many tasks.
  int work(const std::string& title, std::function<Json(const Work&)>);
  /// Runs this program with other arguments in a separate process, so that a crash affects nothing else.
  int run(const std::string& title, std::vector<std::string> arguments);
  /// Ends a task. Throws Error if there is none with this number.
  void end(int number);

 private:
  struct Running {
    int number = 0;
    std::atomic<bool> ended{false};  ///< the task should end
    std::atomic<bool> over{false};   ///< the work is done; set before the last event is sent
    std::atomic<bool> told{false};   ///< the last event is sent: joining the thread cannot deadlock with locks of `tell`
    std::thread thread;
  };
  void sweep();
  std::function<void(const Json&)> tell_;
  std::mutex guard_;
  std::list<Running> running_;
  int next_ = 1;
};

}  // namespace etendue::studio
