#pragma once
// The commands of the program. Each lives in its own file, adds itself to the command line with its options and its
// help, and says through `run` what is to be done when it was the one given.

#include <CLI/CLI.hpp>
#include <functional>

namespace etendue {

/// Returns the program's exit status.
using Run = std::function<int()>;

namespace exit_status {
inline constexpr int done = 0;
inline constexpr int failed = 1;
inline constexpr int bad_input = 2;      ///< of the file or the command line
inline constexpr int interrupted = 130;  ///< as a shell reports Ctrl-C
}  // namespace exit_status

void add_render_command(CLI::App& program, Run& run);
void add_check_command(CLI::App& program, Run& run);
void add_save_command(CLI::App& program, Run& run);
void add_convert_command(CLI::App& program, Run& run);
void add_export_command(CLI::App& program, Run& run);
void add_classes_command(CLI::App& program, Run& run);
void add_schema_command(CLI::App& program, Run& run);
void add_manual_command(CLI::App& program, Run& run);
void add_image_command(CLI::App& program, Run& run);
void add_verify_command(CLI::App& program, Run& run);
void add_compare_command(CLI::App& program, Run& run);
void add_conform_command(CLI::App& program, Run& run);

}  // namespace etendue
