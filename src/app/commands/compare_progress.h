#pragma once
// Shows the progress of a comparison on standard error.

#include <string>

#include "app/progress_display.h"

namespace etendue {

class CompareProgress {
 public:
  /// `runs`: the number of runs of all variants on all scenes together.
  CompareProgress(ProgressDisplay::Kind kind, size_t runs) : kind_(kind), runs_(runs) {}
  ~CompareProgress() { clear(); }

  /// A run begins; `what` names it.
  void begin(const std::string& what);
  /// Shows that this fraction of the current run is done.
  void at(double fraction);
  /// The current run took so many seconds, now or, if it was stored, when it was rendered.
  void done(double seconds);
  void clear();

 private:
  void show(double fraction);
  ProgressDisplay::Kind kind_;
  size_t runs_, done_ = 0;
  std::string what_;
  double seconds_ = 0;  // of all finished runs
  double began_ = 0, shown_ = 0, next_line_ = 0, start_ = -1;
  bool bar_on_screen_ = false;
};

}  // namespace etendue
