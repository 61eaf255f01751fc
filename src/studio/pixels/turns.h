#pragma once
// Turns: renders that run side by side take turns, each with all threads. So their times can be compared, and several renders
// need no more threads than one.

#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>

namespace etendue::studio {

class Turns {
 public:
  /// A participant. `stop` requests the end of its turn soon, `abort` at once; both are called from other threads.
  struct Seat {
    std::function<void()> stop, abort;
    double used = 0;       ///< [s] used in turns, relative to the other participants since it joined
    bool waiting = false;  ///< for its turn
    bool first = false;    ///< hurried: it gets the next turn
  };

  /// Waits for a turn. False: `wanted`, which is called repeatedly, returned false first. A seat that was `away` does not get
  /// extra time for it.
  bool take(Seat&, bool away, const std::function<bool()>& wanted);
  void give_back(Seat&);
  /// Gives this seat the next turn: the current turn of another seat is aborted.
  void hurry(Seat&);

 private:
  Seat* next() const;

  std::mutex guard_;
  std::condition_variable changed_;
  std::list<Seat*> waiting_;
  Seat* at_work_ = nullptr;
  double began_ = 0;  // [s]
};

}  // namespace etendue::studio
