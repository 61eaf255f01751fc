#include "runner.h"

#include "describe/guard.h"

namespace etendue::studio {

Runner::Runner(Turns& turns) : turns_(turns), thread_([this] { work(); }) {}

Runner::~Runner() {
  {
    const std::lock_guard lock(guard_);
    ending_ = true;
    wanted_ = false;
    if (running_) render_->abort();
  }
  changed_.notify_all();
  thread_.join();
}

void Runner::set(std::shared_ptr<Render> render) {
  std::unique_lock lock(guard_);
  const bool wanted = std::exchange(wanted_, false);
  // Abort is repeated until the run ends, since a run that is just beginning may clear an earlier request.
  while (running_) {
    render_->abort();
    changed_.wait_for(lock, std::chrono::milliseconds(20));
  }
  render_ = std::move(render);
  wanted_ = wanted;
  ++turn_;
  status_ = {render_ ? State::paused : State::empty, {}, {}, status_.changes + 1};
  changed_.notify_all();
}

void Runner::start() {
  const std::lock_guard lock(guard_);
  wanted_ = true;
  ++turn_;
  changed_.notify_all();
}

void Runner::pause() { rest(&Render::stop); }

void Runner::stop() { rest(&Render::abort); }

void Runner::rest(void (Render::*word)()) {
  const std::lock_guard lock(guard_);
  const bool was_to_begin = wanted_ && render_ && turn_ != done_turn_;
  wanted_ = false;
  if (running_) {
    (render_.get()->*word)();
  } else if (was_to_begin) {
    // The runner was about to start again after a change, so no run is there to report the new state.
    status_ = {State::paused, {}, {}, status_.changes + 1};
  }
}

void Runner::follow(const std::shared_ptr<Render>& render) {
  bool other = false;
  {
    const std::lock_guard lock(guard_);
    other = render_ != render;
  }
  if (other) return set(render);
  const std::lock_guard lock(guard_);
  ++turn_;
  changed_.notify_all();
}

Runner::Status Runner::status() const {
  const std::lock_guard lock(guard_);
  return status_;
}

void Runner::hurry() {
  {
    const std::lock_guard lock(guard_);
    if (!wanted_) return;
  }
  turns_.hurry(seat_);
}

/// Runs the render, in turns with others, until it ends or is no longer wanted.
Ended Runner::run(const std::shared_ptr<Render>& render) {
  const auto wanted = [&] {
    const std::lock_guard lock(guard_);
    return wanted_ && !ending_ && render_ == render;
  };
  seat_.stop = [render] { render->stop(); };
  seat_.abort = [render] { render->abort(); };
  bool away = true;
  while (true) {
    if (!turns_.take(seat_, std::exchange(away, false), wanted)) return Ended::interrupted;
    struct Turn {
      Turns& turns;
      Turns::Seat& seat;
      ~Turn() { turns.give_back(seat); }
    };
    std::optional<Turn> turn(std::in_place, turns_, seat_);
    const Ended ended = render->run();
    turn.reset();
    const bool given_up = ended == Ended::interrupted || ended == Ended::aborted;
    if (!given_up || !wanted()) return ended;
  }
}

void Runner::work() {
  std::unique_lock lock(guard_);
  while (true) {
    changed_.wait(lock, [&] { return ending_ || (wanted_ && render_ && turn_ != done_turn_); });
    if (ending_) return;
    done_turn_ = turn_;
    running_ = true;
    status_ = {State::rendering, {}, {}, status_.changes + 1};
    const std::shared_ptr<Render> render = render_;
    lock.unlock();
    Status next;
    try {
      next.ended = run(render);
    } catch (...) {
      next.errors = thrown_errors();
    }
    lock.lock();
    running_ = false;
    const bool given_up = next.ended == Ended::interrupted || next.ended == Ended::aborted;
    if (given_up && wanted_) ++turn_;  // the request to stop was for an earlier run
    next.state = !next.errors.empty() ? State::failed : (given_up ? State::paused : State::finished);
    if (next.state == State::failed) wanted_ = false;
    next.changes = status_.changes + 1;
    status_ = std::move(next);
    changed_.notify_all();
  }
}

}  // namespace etendue::studio
