#pragma once
// Renders that go on side by side take turns, each with all threads: so the time that each has spent can be compared, and
// several need no more threads than one.

#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>

namespace etendue::studio {

class Turns {
 public:
  /// One who takes turns. `stop` asks it to end its turn soon, `abort` at once; they are called from other threads.
  struct Seat {
    std::function<void()> stop, abort;
    double used = 0;       ///< [s] of turns, counted from when it sat down among those who were there
    bool waiting = false;  ///< for its turn
    bool first = false;    ///< it has been hurried: its turn is next
  };

  /// Waits for a turn. False: `wanted`, asked now and then, said no before it came. Who was `away` does not make up for it.
  bool take(Seat&, bool away, const std::function<bool()>& wanted);
  void give_back(Seat&);
  /// Somebody looks at what this seat is about to do: whoever else has the turn gives it up at once.
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
