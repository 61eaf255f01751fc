#pragma once
// One sample alone, told vertex by vertex.

#include <string>

#include "etendue/job.h"

namespace etendue {

/// A replayed path for people to read.
std::string path_text(const PathRecord&, Point2 film);

}  // namespace etendue
