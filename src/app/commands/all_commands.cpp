// The entry of the library of commands.

#include <string_view>

#include "app/commands.h"

/// Adds all commands but `render`. False, and nothing is added: the program is of another version than the library.
extern "C" bool etendue_add_commands(etendue::Command& program, const char* version) {
  using namespace etendue;
  if (std::string_view(version) != ETENDUE_VERSION) return false;
  add_check_command(program);
  add_save_command(program);
  add_convert_command(program);
  add_export_command(program);
  add_format_command(program);
  add_classes_command(program);
  add_schema_command(program);
  add_manual_command(program);
  add_image_command(program);
  add_verify_command(program);
  add_compare_command(program);
  add_conform_command(program);
  add_measure_command(program);
  add_cryptomatte_command(program);
  add_cluster_command(program);
  add_studio_command(program);
  add_shade_command(program);
  return true;
}
