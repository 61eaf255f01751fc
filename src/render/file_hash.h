#pragma once
// The hash by which a picture's metadata names the files that it was made of ("file_hash").

#include <set>
#include <span>
#include <string>

#include "etendue/render/job.h"

namespace etendue {

/// 16 hexadecimal digits of a hash of the contents of all files that were read for a job or are named by it, and of texts: what
/// else determines the picture. `read` are absolute paths.
std::string file_hash(const Job&, std::set<std::string> read, std::span<const std::string> texts);

}  // namespace etendue
