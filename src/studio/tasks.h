#pragma once
// Checks that take a while: whether a class keeps its promises.

#include <functional>
#include <list>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

namespace etendue::studio {

/// Runs them one thread each; `tell` is called from those, with events for all browsers.
class Tasks {
 public:
  explicit Tasks(std::function<void(const nlohmann::ordered_json&)> tell) : tell_(std::move(tell)) {}
  ~Tasks();
  Tasks(const Tasks&) = delete;
  Tasks& operator=(const Tasks&) = delete;

  /// Tries a class's conformance; the number that events of it bear. Throws Error when too much is going on already.
  int conform(const std::string& class_name);

 private:
  struct Running {
    std::thread thread;
    bool done = false;
  };
  void sweep();
  std::function<void(const nlohmann::ordered_json&)> tell_;
  std::mutex guard_;
  std::list<Running> running_;
  int next_ = 1;
};

}  // namespace etendue::studio
