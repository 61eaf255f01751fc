#pragma once
// LiveRender: a Render that Python holds, and the parts of its job. As long as it lives, members of these parts are set by
// Render::edit, between two steps, whoever sets them.
//
// The interpreter's lock guards everything here; what takes long runs without it.

#include <sys/types.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <unordered_set>

#include "binding.h"
#include "etendue/render/render.h"
#include "trees.h"

namespace etendue::python {

/// Throws Error in a process that was forked from one that has rendered, as the threads of TBB do not survive a fork. Otherwise
/// notes that this process uses threads.
void use_threads();

class LiveRender {
 public:
  /// Prepares the job. Throws Error if one of its parts belongs to another living render.
  LiveRender(Ref<Job>, RenderSettings);
  ~LiveRender();
  LiveRender(const LiveRender&) = delete;
  LiveRender& operator=(const LiveRender&) = delete;

  /// One use of the render by a function. Throws Error if the render was closed, or was made before a fork.
  class Use {
   public:
    explicit Use(LiveRender&);
    ~Use() { --live_.uses_; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    Render& operator*() const { return *live_.render_; }
    Render* operator->() const { return live_.render_.get(); }

   private:
    LiveRender& live_;
  };

  const Ref<Job>& job() const { return job_; }
  bool closed() const { return !render_; }
  /// Whether no function uses the render now.
  bool idle() const { return uses_ == 0; }

  /// Runs or steps: `work` is called on a thread of its own while this thread wakes every 50 ms and calls `wake`, which may
  /// raise. The exception of `wake`, or of a signal's handler, aborts the render and is passed on.
  void run(const std::function<void(Render&)>& work, const nb::callable& wake);

  struct Change {
    Ref<Component> component;
    const Member* member;
    Value value;
  };
  /// Makes all edits or none. Throws Error for parts of other jobs, and for lists that an array views.
  void edit(std::span<const Change>);

  /// Calls a function that reads the job while no edit is made.
  template <class F>
  auto unedited(F&& work) {
    const Use use(*this);
    return released([&] {
      const std::lock_guard lock(editing_);
      return work(*use);
    });
  }

  /// The newest progress that the run has reported and nobody has taken.
  std::optional<Progress> take_progress();

  /// Aborts a run and waits for all that use the render; then its job belongs to nobody.
  void close();

 private:
  friend void close_all_renders();
  using Parts = std::unordered_set<const Component*>;
  void claim(const Parts&);
  void claim_parts_of_job();
  void disclaim();

  const Ref<Job> job_;
  const pid_t process_;
  std::unique_ptr<Render> render_;
  Parts parts_;
  int uses_ = 0;
  std::optional<std::thread::id> runner_;  ///< the thread that runs or steps, and calls `wake`
  std::mutex editing_;                     ///< never waited for with the interpreter's lock
  std::mutex reporting_;
  std::optional<Progress> reported_;
};

/// The living render of a part's job; null: none.
LiveRender* render_of(const Component&);
/// Throws Error if a part belongs to a living render: `doing` is what is refused, "prepared".
void require_no_render(const Component&, const std::string& doing);

/// Runs a function that reads a component, without the interpreter's lock, and while no living render edits it.
template <class F>
auto reading(const Component& part, F&& work) {
  require_shallow(part);
  if (LiveRender* const live = render_of(part)) return live->unedited([&](Render&) { return work(); });
  return released(work);
}

/// The value of a member before an edit that is being made by another thread; invalid if none is.
nb::object value_before_edit(const Component&, const std::string& member);

/// Ends all renders, before the interpreter does.
void close_all_renders();
/// In a forked process: the parts of jobs that its parent renders are free here.
void leave_all_renders();

}  // namespace etendue::python
