#pragma once
// The command line of `etendue shade`: shaders of a network, and a grid of points at which it is run. The options are those of
// the reference implementation's testshade, with one or two dashes.

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "osl/language/group_description.h"
#include "osl/running/machine.h"

namespace etendue::osl {

struct ShadeArguments {
  struct Output {
    std::string variable, file;
  };

  GroupDescription group;
  std::vector<std::string> folders;                              ///< -I, of shaders and of what they include
  std::vector<std::pair<std::string, std::string>> definitions;  ///< -D
  std::vector<Output> outputs;
  std::vector<std::string> entry_outputs;
  std::vector<std::pair<std::string, std::string>> options;  ///< --options
  std::string data_type = "float";
  std::string ray_type = "camera";
  std::string color_space = "Rec709";
  std::string check;       ///< a file that is only compiled
  std::string describe;    ///< a file whose parameters are printed
  std::string expression;  ///< --expr: assigns `result`
  int width = 1, height = 1, repetitions = 1;
  float u_scale = 1, v_scale = 1, u_offset = 0, v_offset = 0;
  bool centers = false, vary_point = false, vary_u = false, vary_v = false;
  std::optional<Execute> execute;  ///< --interpreter, --compiler
  bool print = false, verbose = false, query = false, userdata_is_connected = false;
  std::vector<std::string> messages;  ///< what the reference prints for its arguments, before the run
  std::vector<std::string> warnings;  ///< options that have no effect
};

/// Throws Error for what is not understood.
ShadeArguments parse_shade_arguments(std::span<const std::string> words);

/// The text of --help.
const char* shade_help();

}  // namespace etendue::osl
