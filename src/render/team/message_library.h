#pragma once
// Loads the library that speaks MPI, which stands beside the main one and is needed by nobody who is not started by mpirun.

#include <memory>

#include "messages.h"

namespace etendue {

/// What the library provides; it announces itself when it is loaded.
using MakeMessages = std::unique_ptr<Messages> (*)();
void announce_messages(MakeMessages, const char* version);

/// How many processes mpirun or srun has started together with this one, as the environment says; 1: none, or ETENDUE_MPI is
/// "off". Processes that were started by srun without MPI (--mpi=none) are not counted.
int processes_started();

/// The messages of these processes; not yet open. Throws Error if the library is missing or does not fit.
std::unique_ptr<Messages> load_messages();

}  // namespace etendue
