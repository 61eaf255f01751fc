#pragma once
// Renders of `etendue render` that several processes compute (program_team.h).

#include "app/render_options.h"
#include "files/input_files.h"
#include "render/team/process_team.h"
#include "render/team/witness.h"

namespace etendue {

/// While it exists, the other processes compute the render that these options describe; nothing happens without a team.
class TeamRender {
 public:
  explicit TeamRender(const RenderOptions&);
  ~TeamRender();
  /// With --send-scene: lets the other processes have the files that were read or are named.
  void send_scene(const InputsRead&, const RenderOptions&) const;
  /// From now on, if all processes are killed together with mpirun, a file beside the checkpoint, or beside the first of these
  /// pictures, says so.
  void leave_word(const RenderOptions&, const std::vector<Ref<Output>>&);
  TeamRender(const TeamRender&) = delete;
  TeamRender& operator=(const TeamRender&) = delete;

 private:
  ProcessTeam* team_ = nullptr;
  std::optional<Witness> witness_;
};

/// What a follower does: computes the leader's renders until there are no more. It writes nothing, and leaves all signals to
/// the leader. Returns the exit status.
int follow_renders(const RenderOptions&, ProcessTeam&);

}  // namespace etendue
