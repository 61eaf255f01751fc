#pragma once

#include <string>

#include "etendue/core/error.h"

namespace etendue {

/// Throws OpenImageIO's error message as Error, without trailing line ends.
[[noreturn]] inline void refuse(std::string reason) {
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == ' ')) reason.pop_back();
  throw Error(reason.empty() ? "the image library gives no reason" : reason);
}

}  // namespace etendue
