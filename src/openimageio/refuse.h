#pragma once

#include <string>

#include "etendue/core/error.h"

namespace etendue {

/// Throws what OpenImageIO says, without its line ends.
[[noreturn]] inline void refuse(std::string reason) {
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == ' ')) reason.pop_back();
  throw Error(reason.empty() ? "the image library gives no reason" : reason);
}

}  // namespace etendue
