#pragma once
// TeamSchedule: a Schedule whose items are computed by the processes of a team.
//
// All processes make the same calls of `run`. The leader deals the items, in their order and a few at a time, so that fast
// processes and fast items make up for slow ones. Whoever has computed an item sends its results to all others if the call has
// results, and its tile to the leader, as soon as it is done; each process puts the results in order. Items of the next call
// are computed while those of the last one are still on their way. The leader deals no items that are far from the first one
// that is missing, because what comes after that is kept in memory.

#include <chrono>
#include <deque>
#include <map>

#include "process_team.h"
#include "render/parallel_schedule.h"

namespace etendue {

class TeamSchedule final : public Schedule {
 public:
  TeamSchedule(ProcessTeam&, Film&, int threads, const std::atomic<bool>& abort,
               std::function<void(std::uint64_t, std::uint64_t)> tick);
  ~TeamSchedule() override;
  /// A letter of the kinds want, deal and item; from the post's thread.
  void received(Reading&&);
  size_t largest_kept() const { return film_.largest_kept(); }

 private:
  /// The number of a call: of the step, and within the step.
  using Number = std::pair<std::uint64_t, std::uint64_t>;
  class Call;
  void run(const Items&, Work&) override;
  std::unique_ptr<ImageTile> tile();
  void give_back(std::unique_ptr<ImageTile>);
  bool stopped() const { return aborted() || team_.troubled(); }

  ProcessTeam& team_;
  Film& film_;
  ParallelSchedule local_;
  const std::function<void(std::uint64_t, std::uint64_t)> tick_;
  Number last_{0, 0};  ///< the last call that was begun
  std::chrono::duration<double> answer_time_{
      0};  ///< from asking for items until they are there, on average; for the call alone

  std::mutex mutex_;
  Call* call_ = nullptr;
  std::multimap<Number, Reading> early_;  ///< letters of calls that are not yet begun here

  std::mutex tiles_mutex_;
  std::vector<std::unique_ptr<ImageTile>> tiles_;
};

}  // namespace etendue
