#pragma once
// The commands of the program. Each has its own file: its add_..._command adds the command with its options and help to the
// command line, and sets `run` when the command was given.

#include <CLI/CLI.hpp>
#include <functional>

namespace etendue {

/// Returns the program's exit status.
using Run = std::function<int()>;

namespace exit_status {
inline constexpr int done = 0;
inline constexpr int failed = 1;
inline constexpr int bad_input = 2;      ///< an error in the file or the command line
inline constexpr int interrupted = 130;  ///< the status that a shell reports after Ctrl-C
}  // namespace exit_status

void add_render_command(CLI::App& program, Run& run);
void add_check_command(CLI::App& program, Run& run);
void add_save_command(CLI::App& program, Run& run);
void add_convert_command(CLI::App& program, Run& run);
void add_export_command(CLI::App& program, Run& run);
void add_format_command(CLI::App& program, Run& run);
void add_classes_command(CLI::App& program, Run& run);
void add_schema_command(CLI::App& program, Run& run);
void add_manual_command(CLI::App& program, Run& run);
void add_image_command(CLI::App& program, Run& run);
void add_verify_command(CLI::App& program, Run& run);
void add_compare_command(CLI::App& program, Run& run);
void add_conform_command(CLI::App& program, Run& run);
void add_studio_command(CLI::App& program, Run& run);

}  // namespace etendue
