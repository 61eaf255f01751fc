// Shows the progress of a render as a bar or lines of text, or as JSON for other programs.

#include "progress_display.h"
#include "core/number_text.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace etendue {

ProgressDisplay::Kind ProgressDisplay::kind_for(const std::string& asked, bool quiet) {
  if (asked == "json") return Kind::json;
  if (quiet || asked == "none") return Kind::none;
  if (asked == "bar") return Kind::bar;
  return isatty(STDERR_FILENO) ? Kind::bar : Kind::lines;
}

std::string ProgressDisplay::line(const Progress& p) const {
  std::string text = fmt::format("{:3.0f} %  {}", 100 * p.fraction, p.samples);
  if (!open_ended_) text += fmt::format("/{}", p.samples_wanted);
  text += fmt::format(" samples  {:.2f} Msamples/s  {}", p.samples_per_second * 1e-6, duration_text(p.seconds));
  if (p.error > 0) text += fmt::format("  error {:.4f}", p.error);
  if (!p.finished && p.seconds_left >= 0) text += fmt::format("  {} left", duration_text(p.seconds_left));
  return text;
}

void ProgressDisplay::show(const Progress& p) {
  last_ = p;
  switch (kind_) {
    case Kind::none: break;
    case Kind::bar: {
      constexpr int cells = 24;
      const int full = std::clamp(int(p.fraction * cells), 0, cells);
      fmt::print(stderr, "\r\x1b[K[{}{}] {}", std::string(size_t(full), '#'), std::string(size_t(cells - full), '.'), line(p));
      std::fflush(stderr);
      bar_on_screen_ = true;
      break;
    }
    case Kind::lines:
      if (p.finished || p.seconds < next_line_) break;
      next_line_ = p.seconds + std::max(10.0, 0.25 * p.seconds);  // the interval grows with the time
      fmt::print(stderr, "{}\n", line(p));
      break;
    case Kind::json: {
      nlohmann::ordered_json json = {{"event", "progress"},  {"fraction", p.fraction},
                                     {"samples", p.samples}, {"samples_wanted", p.samples_wanted},
                                     {"seconds", p.seconds}, {"samples_per_second", p.samples_per_second}};
      json["seconds_left"] = p.seconds_left >= 0 ? nlohmann::ordered_json(p.seconds_left) : nlohmann::ordered_json(nullptr);
      if (p.error > 0) json["error"] = p.error;
      fmt::print("{}\n", json.dump());
      std::fflush(stdout);
      break;
    }
  }
}

void ProgressDisplay::clear() {
  if (!bar_on_screen_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  bar_on_screen_ = false;
}

std::string_view name(Ended ended) {
  switch (ended) {
    case Ended::samples: return "samples";
    case Ended::time: return "time";
    case Ended::error: return "error";
    case Ended::interrupted: return "interrupted";
    case Ended::aborted: return "aborted";
  }
  return "";
}

}  // namespace etendue
