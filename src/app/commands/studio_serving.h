#pragma once
// Runs a studio as a server until it is shut down: the common part of `etendue studio` and `etendue view`.

#include <functional>

#include "app/commands.h"
#include "studio/server/server.h"

namespace etendue {

/// Prints the address, and opens a browser if wanted. `begin` sets up the studio's first content. Returns the exit status.
int serve(studio::StudioSettings, studio::ServerSettings, bool open_browser, const std::function<void(studio::Studio&)>& begin);

/// Defined in view_command.cpp; add_studio_command calls it.
void add_view_command(Command& program);

}  // namespace etendue
