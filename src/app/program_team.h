#pragma once
// The processes that mpirun or srun started together with this one.

#include "render/team/process_team.h"

namespace etendue {

/// Connects with them; null: this process was started alone. Throws Error.
ProcessTeam* join_team();
/// To be called before the program ends, after its errors have been shown: a leader sends the others home, and ends all at once
/// if one is lost.
void leave_team();

}  // namespace etendue
