#pragma once
// Queue: files that are rendered one after the other, as by `etendue render`.

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "etendue/render/render.h"

namespace etendue::studio {

using Json = nlohmann::ordered_json;

class Queue {
 public:
  /// `changed` is called from any thread when the state has changed.
  Queue(RenderSettings settings, std::function<void()> changed);
  ~Queue();
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;

  void add(const std::string& file);
  /// If the entry is being rendered, its render is aborted.
  void remove(int entry);
  void start();
  void stop();
  Json json() const;

 private:
  enum class State : std::uint8_t { waiting, rendering, done, failed };
  struct Entry {
    int number = 0;
    std::string file;
    State state = State::waiting;
    double fraction = 0;
    std::vector<std::string> outputs;
    std::vector<Error> errors;
  };
  void work();
  void render(const std::string& file, int number);
  Entry* find(int number);

  RenderSettings settings_;
  std::function<void()> changed_;
  mutable std::mutex guard_;
  std::condition_variable waiting_;
  std::deque<Entry> entries_;
  std::shared_ptr<Render> at_work_;
  int at_work_number_ = 0, next_ = 1;
  bool running_ = false, ending_ = false;
  std::thread thread_;
};

}  // namespace etendue::studio
