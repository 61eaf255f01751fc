#include "program_team.h"

#include <malloc.h>

#include "etendue/describe/registry.h"
#include "render/team/message_library.h"

namespace etendue {
namespace {

std::unique_ptr<ProcessTeam>& program_team() {
  static std::unique_ptr<ProcessTeam> team;
  return team;
}

/// Messages and the results in them are some 100 kB each. By default the C library gives memory of that size back to the system
/// and takes it again for each, page by page, which for photon maps takes 3 % of a process's time.
void keep_freed_memory() {
  constexpr int largest_kept = 32 << 20, unused_kept = 256 << 20;
  mallopt(M_MMAP_THRESHOLD, largest_kept);
  mallopt(M_TRIM_THRESHOLD, unused_kept);
}

}  // namespace

ProcessTeam* join_team() {
  std::unique_ptr<ProcessTeam>& team = program_team();
  if (!team && processes_started() > 1) {
    keep_freed_memory();
    team = std::make_unique<ProcessTeam>(load_messages(),
                                         TeamSettings{.version = std::string("etendue " ETENDUE_VERSION ", ") + abi_string()});
  }
  return team.get();
}

void leave_team() { program_team().reset(); }

}  // namespace etendue
