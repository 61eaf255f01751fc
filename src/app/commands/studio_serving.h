#pragma once
// A studio on the network, until somebody ends it: what `etendue studio` and `etendue view` have in common.

#include <functional>

#include "app/commands.h"
#include "studio/server/server.h"

namespace etendue {

/// Prints the address, and opens a browser if wanted. `begin` gives the studio what it begins with. Its exit status.
int serve(studio::StudioSettings, studio::ServerSettings, bool open_browser, const std::function<void(studio::Studio&)>& begin);

/// Of src/app/commands/view_command.cpp; added along with the studio's.
void add_view_command(CLI::App& program, Run& run);

}  // namespace etendue
