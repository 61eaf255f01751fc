#pragma once
// TellsChoice: implemented, in addition to RenderProcess, by processes that decide by themselves how to render.

#include <string>

namespace etendue {

class TellsChoice {
 public:
  /// What was decided and why, in one sentence for the user; empty: nothing was to be decided yet. Called between steps.
  virtual std::string told() const = 0;

 protected:
  ~TellsChoice() = default;
};

}  // namespace etendue
