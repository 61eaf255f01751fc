#pragma once
// Shows the progress of a comparison on standard error.

#include <map>
#include <string>
#include <utility>

#include "app/progress_display.h"

namespace etendue {

class CompareProgress {
 public:
  /// `runs`: the number of runs of all variants on all scenes together.
  CompareProgress(ProgressDisplay::Kind kind, size_t runs) : kind_(kind), runs_(runs) {}
  ~CompareProgress() { clear(); }

  /// A run begins. Runs of the same `kind_of_run` (scene and variant) take about the same time.
  void begin(size_t kind_of_run, const std::string& what);
  /// Shows that this fraction of the current run is done.
  void at(double fraction);
  /// The current run took so many seconds, now or, if it was stored, when it was rendered.
  void done(size_t kind_of_run, double seconds, bool now);
  void clear();

 private:
  void show(double fraction);
  ProgressDisplay::Kind kind_;
  size_t runs_, done_ = 0;
  std::string what_;
  std::map<size_t, std::pair<double, size_t>> known_;  // total seconds and number of the runs of each kind
  double began_ = 0, shown_ = 0, next_line_ = 0, start_ = -1;
  bool bar_on_screen_ = false;
};

}  // namespace etendue
