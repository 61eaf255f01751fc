#pragma once
// Handles Ctrl-C during a render.

#include "etendue/render/render.h"

namespace etendue {

/// While an object of this class exists, the first SIGINT, SIGTERM, SIGUSR1 or SIGHUP lets the render finish its pass, or drop
/// it if a team computes it. A second SIGINT drops the pass, in the middle of its paths; a third ends the program. Under nohup
/// SIGHUP stays ignored. At most one object may exist at a time.
class Interruption {
 public:
  explicit Interruption(Render&);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// Whether a signal has been received since the last object of this class was made.
  static bool asked();
};

}  // namespace etendue
