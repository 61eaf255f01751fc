#pragma once
// Team: several processes that compute one Render together, as the Render sees them. Each of them holds a Render of the same
// job. The leader's collects the picture; the others (followers) mirror its process: they take each of its steps with the same
// state, and so make the same calls of Schedule::run in the same order, whose items the schedule divides among all.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "checkpoint.h"
#include "etendue/render/process.h"

namespace etendue {

class Team {
 public:
  virtual ~Team() = default;
  virtual bool leads() const = 0;
  /// Whether the leader's job may be edited: then `announce` tells the followers of it. Safe in signal handlers.
  virtual bool follows_edits() const = 0;

  /// What a process is about to render, which must be the same in all of them.
  struct Prepared {
    Identity identity;
    std::uint64_t seed = 0;
    std::uint32_t samples_per_step = 1;
    std::string command;  ///< the command line that makes the picture; may be empty
    int threads = 0;      ///< of this process; 0: its share of the machine's cores
  };
  /// Leader, before `assemble`, if edits are followed: lets the others prepare this job. `fresh`: no earlier state of this
  /// Render was announced; otherwise it was edited since then.
  virtual void announce(const Job&, bool fresh) = 0;
  /// Leader: waits until every follower has prepared the render. Throws Error, with the host's name, if one of them could not,
  /// or prepared something else. Follower: says that it is ready.
  virtual void assemble(const Prepared&) = 0;

  /// A schedule whose items all processes compute. Leader: results and tiles come together in the order of items, and
  /// `tick(done, count)` is called as by ParallelSchedule. It must not outlive the team.
  virtual std::unique_ptr<Schedule> schedule(Film&, int threads, const std::atomic<bool>& abort,
                                             std::function<void(std::uint64_t, std::uint64_t)> tick) = 0;

  // ---- the leader ----------------------------------------------------------------------------------------------------------

  /// Lets all followers take a step from a state of RenderProcess::save_state; they then run its schedules' calls.
  virtual void begin_step(const Step&, const std::vector<std::byte>& state) = 0;
  /// Waits until all have finished the step. Throws Error if one of them has another state than this one.
  virtual void end_step(const std::vector<std::byte>& state) = 0;
  /// Aborts the step that has begun.
  virtual void drop_step() noexcept = 0;

  // ---- followers -----------------------------------------------------------------------------------------------------------

  struct Task {
    Step step;
    bool fresh = true;             ///< a new process must load the state; otherwise the last step's process goes on
    std::vector<std::byte> state;  ///< if fresh
  };
  /// Waits for the next step; nothing: the leader's render has ended. `abort` becomes true when the leader drops the step.
  virtual std::optional<Task> next_step(std::atomic<bool>& abort) = 0;
  /// Reports that the step is finished, with this state.
  virtual void finished(const std::vector<std::byte>& state) = 0;
  /// Reports why the step, or the preparation of the render, failed.
  virtual void failed(const std::vector<Error>&) noexcept = 0;
};

/// A process of the team is lost, or the connection to it: the render cannot go on.
class LostProcess : public Error {
 public:
  using Error::Error;
};

}  // namespace etendue
