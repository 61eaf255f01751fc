#pragma once
// Runner: the thread that runs a render, taking turns with other renders.

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "etendue/render/render.h"
#include "turns.h"

namespace etendue::studio {

class Runner {
 public:
  explicit Runner(Turns&);
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  /// Replaces the render, possibly by none; the old one is aborted. Returns when the old one is no longer used.
  void set(std::shared_ptr<Render>);
  void start();
  /// After the current step (`pause`), or immediately (`stop`).
  void pause();
  void stop();
  /// Called when the render was edited or replaced: a finished render may have to continue.
  void follow(const std::shared_ptr<Render>&);
  /// Called when a user waits for the picture: other renders give up their turns.
  void hurry();

  enum class State : std::uint8_t { empty, rendering, paused, finished, failed };
  struct Status {
    State state = State::empty;
    std::optional<Ended> ended;
    std::vector<Error> errors;
    std::uint64_t changes = 0;  ///< incremented at each start and end
  };
  Status status() const;

 private:
  void work();
  void rest(void (Render::*word)());

  Ended run(const std::shared_ptr<Render>&);

  Turns& turns_;
  Turns::Seat seat_;
  mutable std::mutex guard_;
  std::condition_variable changed_;
  std::shared_ptr<Render> render_;
  bool wanted_ = false, running_ = false, ending_ = false;
  std::uint64_t turn_ = 0, done_turn_ = 0;  // counters of requested and handled changes
  Status status_;
  std::thread thread_;
};

}  // namespace etendue::studio
