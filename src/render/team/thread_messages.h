#pragma once
// Messages between threads of one process, for tests of what else needs MPI.

#include <memory>
#include <vector>

#include "messages.h"

namespace etendue {

/// Connected Messages, one for each of `size` ranks. The queues live as long as one of them.
std::vector<std::unique_ptr<Messages>> thread_messages(int size);

}  // namespace etendue
