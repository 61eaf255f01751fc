#pragma once
// Shows the progress of a render as a bar or lines of text, or as JSON for other programs.

#include <string>

#include "etendue/render/render.h"

namespace etendue {

class ProgressDisplay {
 public:
  enum class Kind { none, bar, lines, json };

  /// The kind for the value of `--progress`: "auto", "bar", "json" or "none".
  static Kind kind_for(const std::string& asked, bool quiet);

  /// `open_ended`: the render is not stopped by a number of samples, so that number is not shown.
  ProgressDisplay(Kind kind, bool open_ended) : kind_(kind), open_ended_(open_ended) {}
  ~ProgressDisplay() { clear(); }

  /// Called by one thread at a time.
  void show(const Progress&);
  /// Erases the bar from the terminal.
  void clear();
  const Progress& last() const { return last_; }

 private:
  std::string line(const Progress&) const;

  Kind kind_;
  bool open_ended_;
  bool bar_on_screen_ = false;
  double next_line_ = 10;  // [s]
  Progress last_;
};

std::string_view name(Ended);

}  // namespace etendue
