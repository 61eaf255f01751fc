#include "live_render.h"

#include <fmt/format.h>
#include <tbb/task.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <map>
#include <unordered_map>
#include <vector>

#include "describe/expansion.h"
#include "etendue/describe/reflection.h"
#include "kept_lists.h"
#include "snapshots.h"
#include "worker.h"

namespace etendue::python {

namespace {

/// The living render of each part. Never destroyed: renders may outlive the module.
std::unordered_map<const Component*, LiveRender*>& owners() {
  static auto* all = new std::unordered_map<const Component*, LiveRender*>;
  return *all;
}

std::unordered_set<LiveRender*>& living() {
  static auto* all = new std::unordered_set<LiveRender*>;
  return *all;
}

/// Values that members had before the edits that are being made.
using Place = std::pair<const Component*, std::string>;
std::multimap<Place, nb::object>& values_before() {
  static auto* all = new std::multimap<Place, nb::object>;
  return *all;
}

std::unordered_set<const Component*> parts_of(const Component& root) {
  std::unordered_set<const Component*> found{&root};
  std::vector<const Component*> left{&root};
  while (!left.empty()) {
    const Component* const part = left.back();
    left.pop_back();
    for (const Component* const inner : components_of(*part))
      if (found.insert(inner).second) left.push_back(inner);
  }
  return found;
}

/// The components that a value refers to, with their parts.
void add_parts_of(const Value& v, std::unordered_set<const Component*>& found) {
  if (const auto* c = v.as<Ref<Component>>(); c && *c) found.merge(parts_of(**c));
  if (const auto* list = v.as<Value::List>())
    for (const Value& item : *list) add_parts_of(item, found);
}

/// A step waits for its tasks, and a change waits for the step: a task that waited for a change would wait for ever.
void require_outside_step() {
  if (tbb::task::current_context())
    throw Error("a part that is being rendered can neither be changed nor rendered from within its own step");
}

}  // namespace

void use_threads() {
  static pid_t first = 0;
  if (first == 0) first = getpid();
  if (first != getpid())
    throw Error(
        "this process was forked from one that has rendered already, and the threads of a render do not survive a fork: start "
        "processes by multiprocessing's method 'spawn' or 'forkserver', or before the first render");
}

LiveRender* render_of(const Component& part) {
  if (owners().empty()) return nullptr;
  const auto found = owners().find(&part);
  return found == owners().end() ? nullptr : found->second;
}

void require_no_render(const Component& part, const std::string& doing) {
  if (render_of(part))
    throw Error(fmt::format("{} is part of a job that is being rendered, and cannot be {} until that render is closed",
                            part.class_info().name, doing));
}

nb::object value_before_edit(const Component& part, const std::string& member) {
  if (values_before().empty()) return {};
  const auto found = values_before().find({&part, member});
  return found == values_before().end() ? nb::object() : found->second;
}

// ---- one render ------------------------------------------------------------------------------------------------------------

LiveRender::LiveRender(Ref<Job> job, RenderSettings settings) : job_(std::move(job)), process_(getpid()) {
  Interpreter::require_future();
  use_threads();
  require_outside_step();
  require_shallow(*job_);
  claim(parts_of(*job_));
  living().insert(this);
  settings.on_progress = [this](const Progress& p) {
    const std::lock_guard lock(reporting_);
    reported_ = p;
  };
  try {
    render_ = released([&] { return std::make_unique<Render>(job_, settings); });
  } catch (...) {
    disclaim();
    throw;
  }
}

LiveRender::~LiveRender() { close(); }

LiveRender::Use::Use(LiveRender& live) : live_(live) {
  if (live.process_ != getpid())
    throw Error("this render was made before the process was forked; make another one from its job");
  if (live.closed()) throw Error("this render is closed");
  ++live.uses_;
}

void LiveRender::claim(const Parts& parts) {
  for (const Component* const part : parts)
    if (const LiveRender* owner = render_of(*part); owner && owner != this) {
      // The part whose name says most: the job, or one of its members.
      const auto known = [&](const Component* c) { return owner->parts_.contains(c); };
      std::vector<Component*> inner = components_of(*job_);
      const auto shared = std::find_if(inner.begin(), inner.end(), known);
      const Component& named = known(job_.get()) ? *job_ : shared != inner.end() ? **shared : *part;
      throw Error(fmt::format("{} belongs to a render that is not closed. Close that render, or render a "
                              "copy of the job (etendue.copy)",
                              &named == job_.get() ? "the job" : "the job's " + named.class_info().name),
                  named.location_of());
    }
  for (const Component* const part : parts) owners()[part] = this;
  parts_.insert(parts.begin(), parts.end());
}

void LiveRender::claim_parts_of_job() {
  Parts now = parts_of(*job_);
  for (const Component* const part : parts_)
    if (!now.contains(part)) owners().erase(part);
  for (const Component* const part : now) owners()[part] = this;
  parts_ = std::move(now);
}

void LiveRender::disclaim() {
  for (const Component* const part : parts_)
    if (render_of(*part) == this) owners().erase(part);
  parts_.clear();
  living().erase(this);
}

void LiveRender::close() {
  if (closed()) return;
  if (process_ != getpid()) {
    render_.release();  // NOLINT: its locks may be held by threads that this process does not have
    disclaim();
    return;
  }
  if (runner_ == std::this_thread::get_id())
    throw Error("a render cannot be closed from its own progress function; stop() or abort() end it");
  while (uses_ > 0) {
    render_->abort();
    const WithoutLock without;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (closed()) return;  // by another thread, which waited as well
  disclaim();
  const std::unique_ptr<Render> dropped = std::move(render_);
}

void leave_all_renders() {
  Interpreter::forget_threads();
  owners().clear();
  living().clear();
}

void close_all_renders() {
  const std::unordered_set<LiveRender*> all = living();
  for (LiveRender* const live : all)
    if (living().contains(live) && !live->closed()) live->close();
}

std::optional<Progress> LiveRender::take_progress() {
  const std::lock_guard lock(reporting_);
  return std::exchange(reported_, std::nullopt);
}

// ---- running ---------------------------------------------------------------------------------------------------------------

namespace {

/// The thread that runs a render, while it does.
class Running {
 public:
  explicit Running(std::optional<std::thread::id>& runner) : runner_(runner) {
    if (runner_)
      throw Error(*runner_ == std::this_thread::get_id() ? "a render cannot be run from its own progress function"
                                                         : "the render is being run by another thread");
    runner_ = std::this_thread::get_id();
  }
  ~Running() { runner_.reset(); }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

 private:
  std::optional<std::thread::id>& runner_;
};

}  // namespace

void LiveRender::run(const std::function<void(Render&)>& work, const nb::callable& wake) {
  require_outside_step();
  const Use use(*this);
  const Running running(runner_);
  use_threads();
  take_progress();
  Worker worker([&] { work(*use); });
  try {
    while (!worker.wait()) {
      check_signals();
      tell_warnings();
      wake();
    }
  } catch (...) {
    use->abort();
    worker.join();
    // If the work had ended by itself, the request would abort the next run. A step that is to stop clears all requests.
    use->stop();
    use->step();
    throw;
  }
  worker.join();
  if (worker.thrown()) std::rethrow_exception(worker.thrown());
  tell_warnings();
  wake();
}

// ---- editing ---------------------------------------------------------------------------------------------------------------

namespace {

/// Keeps the values of members for other Python threads while an edit changes them.
class ValuesBefore {
 public:
  void add(const Component& part, const Member& member) {
    nb::object before = value_before_edit(part, member.name);
    if (!before.is_valid()) before = to_python(member.get(part, member), &member);
    kept_.push_back(values_before().emplace(Place{&part, member.name}, std::move(before)));
  }
  ValuesBefore() = default;
  ~ValuesBefore() {
    for (const auto& at : kept_) values_before().erase(at);
  }
  ValuesBefore(const ValuesBefore&) = delete;
  ValuesBefore& operator=(const ValuesBefore&) = delete;

 private:
  std::vector<std::multimap<Place, nb::object>::iterator> kept_;
};

}  // namespace

void LiveRender::edit(std::span<const Change> changes) {
  require_outside_step();
  const Use use(*this);
  std::unique_lock lock(editing_, std::defer_lock);
  {
    const WithoutLock without;
    lock.lock();
  }
  std::vector<Edit> edits;
  Parts added;
  bool other_parts = false;
  ValuesBefore before;
  for (const Change& change : changes) {
    const std::string name = change.component->class_info().name + "." + change.member->name;
    if (render_of(*change.component) != this)
      throw Error(name + ": is no part of the job that is rendered", change.value.location);
    if (is_viewed(*change.component, *change.member))
      throw Error(name +
                      ": an array views this list, which the render reads, too; drop the array, or copy it by numpy.array(…), "
                      "before the list is changed",
                  change.value.location);
    other_parts |= change.member->kind == Kind::component;
    add_parts_of(change.value, added);
    edits.push_back({Ref<const Component>(change.component.get()), change.member->name, change.value});
    before.add(*change.component, *change.member);
  }
  claim(added);
  try {
    released([&] { use->edit(edits); });
  } catch (...) {
    if (other_parts) claim_parts_of_job();
    throw;
  }
  if (other_parts) claim_parts_of_job();
  for (const Change& change : changes) forget_snapshots(*change.component);
}

}  // namespace etendue::python
