#include "compare_progress.h"
#include "core/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace etendue {

namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

void CompareProgress::begin(const std::string& what) {
  what_ = what;
  began_ = now();
  if (start_ < 0) start_ = began_;
  at(0);
}

void CompareProgress::at(double fraction) {
  if (now() - shown_ < 0.25 && fraction > 0) return;
  shown_ = now();
  show(std::clamp(fraction, 0.0, 1.0));
}

void CompareProgress::done(double seconds) {
  ++done_;
  seconds_ += seconds;
}

void CompareProgress::show(double fraction) {
  // Every remaining run is estimated to take the mean time of the finished ones, as the variants take turns.
  const double spent = now() - began_, left_runs = double(runs_ - done_);
  std::string left;
  if (done_ > 0)
    left = duration_text(std::max(0.0, seconds_ / double(done_) * left_runs - spent));
  else if (fraction > 0.02)
    left = duration_text(spent / fraction * left_runs - spent);
  const double whole = (double(done_) + fraction) / double(std::max<size_t>(runs_, 1));
  const std::string line = fmt::format("{:3.0f} %  {}  {}{}", 100 * whole, what_, duration_text(now() - start_),
                                       left.empty() ? "" : "  " + left + " left");
  if (kind_ == ProgressDisplay::Kind::bar) {
    constexpr int cells = 24;
    const int full = std::clamp(int(whole * cells), 0, cells);
    fmt::print(stderr, "\r\x1b[K[{}{}] {}", std::string(size_t(full), '#'), std::string(size_t(cells - full), '.'), line);
    std::fflush(stderr);
    bar_on_screen_ = true;
  } else if (kind_ == ProgressDisplay::Kind::lines && now() - start_ >= next_line_ + 10) {
    next_line_ = (now() - start_) * 1.25;
    fmt::print(stderr, "{}\n", line);
  }
}

void CompareProgress::clear() {
  if (!bar_on_screen_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  bar_on_screen_ = false;
}

}  // namespace etendue
