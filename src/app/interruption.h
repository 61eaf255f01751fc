#pragma once
// Ctrl-C while it renders.

#include "etendue/render/render.h"

namespace etendue {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP lets the render finish its pass and a second SIGINT aborts it, within
/// the paths it is at; a third ends the program. Under nohup SIGHUP stays ignored. One at a time.
class Interruption {
 public:
  explicit Interruption(Render&);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// Whether a signal came.
  bool asked() const;
};

}  // namespace etendue
