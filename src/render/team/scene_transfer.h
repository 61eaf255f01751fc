#pragma once
// The leader sends the files of a scene to the processes that do not see them.
//
// Each follower is told the paths, sizes and hashes. One that has all these files at the same paths uses them. The others make
// a SceneFolder. On each machine the first of them takes from the leader what is missing, in pieces that it asks for; after it
// the others take from its folder what they can reach, and from the leader the rest. So each content crosses the network once
// for each machine, and nobody gets more than it can write.

#include <memory>

#include "process_team.h"
#include "scene_folder.h"

namespace etendue {

/// What was sent.
struct SceneSent {
  size_t files = 0;         ///< of the scene
  std::uint64_t bytes = 0;  ///< of all copies that were sent
  size_t receivers = 0;     ///< processes that were sent at least one
};

/// Leader: lets the followers of a render that was begun receive these files (absolute paths), of which those that are no
/// regular files are left out. Returns when all have them. Throws Error.
SceneSent send_scene(ProcessTeam&, const std::vector<std::string>& paths);

/// Follower: waits for the files. `folder` is made when it is needed, and kept for the next render; the working folder is then
/// in it. False: the leader's render has ended. Throws Error.
bool receive_scene(ProcessTeam&, std::unique_ptr<SceneFolder>& folder);

}  // namespace etendue
