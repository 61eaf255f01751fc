#pragma once
// How far a render is, shown to people or programs.

#include <string>

#include "etendue/render/render.h"

namespace etendue {

class ProgressDisplay {
 public:
  enum class Kind { none, bar, lines, json };

  /// What `--progress` asks for: "auto", "bar", "json" or "none".
  static Kind kind_for(const std::string& asked, bool quiet);

  /// `open_ended`: not stopped by a number of samples, which is then not shown.
  ProgressDisplay(Kind kind, bool open_ended) : kind_(kind), open_ended_(open_ended) {}
  ~ProgressDisplay() { clear(); }

  /// Called by one thread at a time.
  void show(const Progress&);
  /// Takes the bar off the terminal.
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
