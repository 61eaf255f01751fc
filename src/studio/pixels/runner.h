#pragma once
// The thread in which a render goes on, taking turns with others.

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

  /// Another render, or none, is what goes on from now; the one before is given up. Returns when nothing is done with it any
  /// more.
  void set(std::shared_ptr<Render>);
  void start();
  /// After the step at hand (`pause`), or now.
  void pause();
  void stop();
  /// The render was edited, or replaced: what had come to its end may have to go on.
  void follow(const std::shared_ptr<Render>&);
  /// Somebody waits for what it shows: other renders leave it their turns.
  void hurry();

  enum class State : std::uint8_t { empty, rendering, paused, finished, failed };
  struct Status {
    State state = State::empty;
    std::optional<Ended> ended;
    std::vector<Error> errors;
    std::uint64_t changes = 0;  ///< grows with every beginning and end
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
  std::uint64_t turn_ = 0, done_turn_ = 0;  // what was looked at last
  Status status_;
  std::thread thread_;
};

}  // namespace etendue::studio
