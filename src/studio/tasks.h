#pragma once
// What takes a while: checks of classes, in processes of their own, and pictures computed beside the render.

#include <atomic>
#include <functional>
#include <list>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

namespace etendue::studio {

/// Each has a thread; `tell` is called from those, with events for all browsers.
class Tasks {
 public:
  using Json = nlohmann::ordered_json;
  explicit Tasks(std::function<void(const Json&)> tell) : tell_(std::move(tell)) {}
  /// Ends them all.
  ~Tasks();
  Tasks(const Tasks&) = delete;
  Tasks& operator=(const Tasks&) = delete;

  /// How a piece of work tells of itself.
  struct Work {
    const std::atomic<bool>& ended;               ///< it is to give up
    std::function<void(double)> done;             ///< a fraction of it is done
    std::function<void(const std::string&)> say;  ///< further text
  };
  /// Does something; what it returns goes along with the last event. The number that its events bear. Throws Error when too
  /// much is going on already.
  int work(const std::string& title, std::function<Json(const Work&)>);
  /// Runs this program with other arguments, in a process of its own: what happens to it happens to nobody else.
  int run(const std::string& title, std::vector<std::string> arguments);
  /// Gives one up. Throws Error when there is none.
  void end(int number);

 private:
  struct Running {
    int number = 0;
    std::atomic<bool> ended{false};  ///< it is to give up
    std::atomic<bool> over{false};   ///< it has no more to do: whoever hears its last event finds it so
    std::atomic<bool> told{false};   ///< and has said so: its thread may be waited for by who holds what `tell` needs
    std::thread thread;
  };
  void sweep();
  std::function<void(const Json&)> tell_;
  std::mutex guard_;
  std::list<Running> running_;
  int next_ = 1;
};

}  // namespace etendue::studio
