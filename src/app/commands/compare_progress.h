#pragma once
// How far a comparison is, shown on standard error.

#include <map>
#include <string>
#include <utility>

#include "app/progress_display.h"

namespace etendue {

class CompareProgress {
 public:
  /// `runs`: of all variants on all scenes.
  CompareProgress(ProgressDisplay::Kind kind, size_t runs) : kind_(kind), runs_(runs) {}
  ~CompareProgress() { clear(); }

  /// A run begins, of which others may be known that take as long; `kind_of_run` says which.
  void begin(size_t kind_of_run, const std::string& what);
  /// The run at hand has done this part of itself.
  void at(double fraction);
  /// It took so many seconds, now or when it was made.
  void done(size_t kind_of_run, double seconds, bool now);
  void clear();

 private:
  void show(double fraction);
  ProgressDisplay::Kind kind_;
  size_t runs_, done_ = 0;
  std::string what_;
  std::map<size_t, std::pair<double, size_t>> known_;  // seconds and number of the runs of a kind
  double began_ = 0, shown_ = 0, next_line_ = 0, start_ = -1;
  bool bar_on_screen_ = false;
};

}  // namespace etendue
