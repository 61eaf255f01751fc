#pragma once
// Ctrl-C while a job renders.

#include "etendue/job.h"

namespace etendue {

/// While it lives, the first SIGINT or SIGTERM lets the job finish its pass and a second SIGINT aborts it; a third ends
/// the program. One at a time.
class Interruption {
 public:
  explicit Interruption(Job&);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// Tells the job again: a signal that came before it began would be forgotten.
  void remind() const;
  /// Whether a signal came.
  bool asked() const;

 private:
  Job& job_;
};

}  // namespace etendue
