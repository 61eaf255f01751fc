#include "program_team.h"

#include "etendue/describe/registry.h"
#include "render/team/message_library.h"

namespace etendue {
namespace {

std::unique_ptr<ProcessTeam>& program_team() {
  static std::unique_ptr<ProcessTeam> team;
  return team;
}

}  // namespace

ProcessTeam* join_team() {
  std::unique_ptr<ProcessTeam>& team = program_team();
  if (!team && processes_started() > 1)
    team = std::make_unique<ProcessTeam>(load_messages(),
                                         TeamSettings{.version = std::string("etendue " ETENDUE_VERSION ", ") + abi_string()});
  return team.get();
}

void leave_team() { program_team().reset(); }

}  // namespace etendue
