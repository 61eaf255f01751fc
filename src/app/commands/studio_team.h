#pragma once
// The document's render of `etendue studio` by several processes (program_team.h): the first of them serves the page, the
// others compute what it renders, and follow all edits.

#include "render/team/process_team.h"

namespace etendue {

/// Leader: lets the others follow. A job goes to them as text that contains everything but the files that it names, which all
/// processes see at the same paths.
void lead_studio(ProcessTeam&);

/// What a follower does until the leader ends. Signals are left to the leader. Returns the exit status.
int follow_studio(ProcessTeam&, int threads);

}  // namespace etendue
