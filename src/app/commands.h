#pragma once
// The commands of the program. Each has its own file: its add_..._command adds the command with its options, help and what
// it does to the command line. All but `render` are in a library of their own (src/app/commands), which is opened for them: so
// a picture can be had before the studio and the laboratory are built, and starts without them.

#include "command_line.h"

namespace etendue {

namespace exit_status {
inline constexpr int done = 0;
inline constexpr int failed = 1;
inline constexpr int bad_input = 2;      ///< an error in the file or the command line
inline constexpr int interrupted = 130;  ///< the status that a shell reports after Ctrl-C
}  // namespace exit_status

void add_render_command(Command& program);
/// Adds all others. Throws Error if their library is missing.
void add_other_commands(Command& program);

void add_check_command(Command& program);
void add_save_command(Command& program);
void add_convert_command(Command& program);
void add_export_command(Command& program);
void add_format_command(Command& program);
void add_classes_command(Command& program);
void add_schema_command(Command& program);
void add_manual_command(Command& program);
void add_image_command(Command& program);
void add_verify_command(Command& program);
void add_compare_command(Command& program);
void add_conform_command(Command& program);
void add_measure_command(Command& program);
void add_cryptomatte_command(Command& program);
void add_cluster_command(Command& program);
void add_studio_command(Command& program);
void add_shade_command(Command& program);

}  // namespace etendue
