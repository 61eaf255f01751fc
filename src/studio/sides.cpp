#include "sides.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

#include "describe/guard.h"
#include "request.h"
#include "studio/document/text_editor.h"

namespace etendue::studio {

// ---- error curve -----------------------------------------------------------------------------------------------------------

void Course::add(const Point& p) {
  constexpr size_t most = 1000;
  if (!points_.empty() && (p.seconds < points_.back().seconds || p.samples < points_.back().samples)) {
    points_.clear();
    spacing_ = 0;
  }
  if (!points_.empty() && p.samples == points_.back().samples) return;
  if (!points_.empty() && p.seconds - points_.back().seconds < spacing_) return;
  points_.push_back(p);
  if (points_.size() < most) return;
  // Keeps every other point; the next points get the same spacing.
  for (size_t i = 0; 2 * i < points_.size(); ++i) points_[i] = points_[2 * i];
  points_.resize((points_.size() + 1) / 2);
  spacing_ = 2 * (points_.back().seconds - points_.front().seconds) / double(most);
}

nlohmann::ordered_json Course::json() const {
  auto list = nlohmann::ordered_json::array();
  for (const Point& p : points_) list.push_back({p.seconds, p.error, p.samples});
  return list;
}

// ---- one side render -------------------------------------------------------------------------------------------------------

Side::Side(int n, Difference d, const RenderSettings& settings, const Folders& folders, Turns& turns)
    : number(n), difference(std::move(d)), document_(settings, folders), runner_(turns) {}

void Side::became(std::vector<Error> errors) {
  std::string title = difference.renderer;
  if (title.empty() && document_.valid()) title = document_.job().renderer->class_info().name;
  for (const auto& [path, expression] : difference.set) title += fmt::format(", {}: {}", path, expression);
  const std::lock_guard lock(guard_);
  title_ = std::move(title);
  errors_ = std::move(errors);
}

void Side::follow(const Document& leader, const std::map<std::string, std::string>& overrides) {
  std::map<std::string, std::string> all = overrides;
  for (const auto& [path, expression] : difference.set) all[path] = expression;
  bool changed = false;
  try {
    TextEditor editor(leader);
    if (!difference.renderer.empty()) {
      const ClassInfo& renderer = class_named(difference.renderer);
      const Ref<Component> now(const_cast<Renderer*>(leader.job().renderer.get()));
      if (&now->class_info() != &renderer) editor.replace_class(now, renderer);
    }
    changed = document_.follow(leader, editor.text(), all);
  } catch (...) {
    became(thrown_errors());
    runner_.stop();
    throw;
  }
  const bool stood_still = !errors().empty();
  became({});
  if (!changed && begun_ && !stood_still) return;
  ++generation_;
  runner_.follow(document_.render());
  if (!std::exchange(begun_, true) || stood_still) runner_.start();
}

void Side::reload() {
  document_.reload();
  ++generation_;
  runner_.follow(document_.render());
}

void Side::restart() {
  render()->restart();
  ++generation_;
  runner_.start();
}

std::string Side::title() const {
  const std::lock_guard lock(guard_);
  return title_;
}

std::vector<Error> Side::errors() const {
  const std::lock_guard lock(guard_);
  return errors_;
}

// ---- all side renders ------------------------------------------------------------------------------------------------------

namespace {

/// The memory used by this program, and the memory available in the system [bytes]; 0 if unknown.
double held_memory() {
  double pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * double(sysconf(_SC_PAGE_SIZE));
}
double free_memory() {
  std::ifstream file("/proc/meminfo");
  std::string key, unit;
  for (double kilobytes = 0; file >> key >> kilobytes && std::getline(file, unit);)
    if (key == "MemAvailable:") return 1024 * kilobytes;
  return 0;
}

}  // namespace

std::shared_ptr<Side> Sides::add(Difference difference, const Document& leader,
                                 const std::map<std::string, std::string>& overrides) {
  const size_t count = all().size();
  if (count >= most) throw Error(fmt::format("{} renders go on beside this one already: remove one first", most));
  // Each render has its own copy of the scene: estimates the memory of one.
  const double needed = held_memory() / double(1 + count), free = free_memory();
  if (free > 0 && needed > 0.8 * free)
    throw Error(
        fmt::format("another render of this scene may need {:.1f} GB, and {:.1f} GB are free", 1e-9 * needed, 1e-9 * free));
  const auto side = std::make_shared<Side>(next_++, std::move(difference), settings_, folders_, turns_);
  side->follow(leader, overrides);
  const std::lock_guard lock(guard_);
  sides_.push_back(side);
  return side;
}

void Sides::remove(int number) {
  static_cast<void>(find(number));
  std::shared_ptr<Side> removed;  // destroyed after the lock is released
  const std::lock_guard lock(guard_);
  for (auto& side : sides_)
    if (side->number == number) removed = side;
  std::erase(sides_, removed);
}

void Sides::clear() {
  std::vector<std::shared_ptr<Side>> removed;
  const std::lock_guard lock(guard_);
  removed.swap(sides_);
}

void Sides::follow(const Document& leader, const std::map<std::string, std::string>& overrides) {
  for (const auto& side : all()) try {
      side->follow(leader, overrides);
    } catch (const std::exception&) {  // the side reports the error, and follows again later
    }
}

std::vector<std::shared_ptr<Side>> Sides::all() const {
  const std::lock_guard lock(guard_);
  return sides_;
}

std::shared_ptr<Side> Sides::find(int number) const {
  for (const auto& side : all())
    if (side->number == number) return side;
  throw Error(fmt::format("there is no render {} beside this one", number));
}

}  // namespace etendue::studio
