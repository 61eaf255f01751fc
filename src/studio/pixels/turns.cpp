#include "turns.h"

#include <algorithm>
#include <chrono>

namespace etendue::studio {

namespace {

/// The length of a turn, unless one step of the render takes longer [s].
constexpr double slice = 0.25;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

/// The seat with the next turn: one that was hurried, otherwise the one with the least used time.
Turns::Seat* Turns::next() const {
  const auto before = [](const Seat* a, const Seat* b) { return a->first != b->first ? a->first : a->used < b->used; };
  const auto found = std::min_element(waiting_.begin(), waiting_.end(), before);
  return found == waiting_.end() ? nullptr : *found;
}

bool Turns::take(Seat& seat, bool away, const std::function<bool()>& wanted) {
  std::unique_lock lock(guard_);
  if (away) {  // starts with the least used time of the others
    std::list<Seat*> others = waiting_;
    if (at_work_) others.push_back(at_work_);
    const auto least = [](const Seat* a, const Seat* b) { return a->used < b->used; };
    if (!others.empty()) seat.used = std::max(seat.used, (*std::min_element(others.begin(), others.end(), least))->used);
  }
  waiting_.push_back(&seat);
  seat.waiting = true;
  const auto leave = [&] {
    waiting_.remove(&seat);
    seat.waiting = false;
  };
  while (at_work_ || next() != &seat) {
    if (!wanted()) {
      leave();
      changed_.notify_all();
      return false;
    }
    if (at_work_ && now() - began_ >= slice) at_work_->stop();
    changed_.wait_for(lock, std::chrono::milliseconds(20));
  }
  leave();
  seat.first = false;
  at_work_ = &seat;
  began_ = now();
  return true;
}

void Turns::give_back(Seat& seat) {
  {
    const std::lock_guard lock(guard_);
    seat.used += now() - began_;
    at_work_ = nullptr;
  }
  changed_.notify_all();
}

void Turns::hurry(Seat& seat) {
  {
    const std::lock_guard lock(guard_);
    if (at_work_ == &seat) return;
    seat.first = true;
    if (at_work_) at_work_->abort();
  }
  changed_.notify_all();
}

}  // namespace etendue::studio
