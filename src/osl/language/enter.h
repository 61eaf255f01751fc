#pragma once

#include "checker.h"

namespace etendue::osl {

/// A new innermost scope, until the end of the block. The scope itself stays, for bodies of functions that are checked later.
struct Enter {
  explicit Enter(Checker& checker) : c(checker), outer(checker.scope_) {
    c.scopes_.push_back(std::make_unique<Scope>());
    c.scopes_.back()->parent = outer;
    c.scope_ = c.scopes_.back().get();
  }
  ~Enter() { c.scope_ = outer; }
  Enter(const Enter&) = delete;
  Enter& operator=(const Enter&) = delete;

  Checker& c;
  Scope* outer;
};

}  // namespace etendue::osl
