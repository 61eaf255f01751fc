// etendue image balance: a picture as if its light were white.

#include "image_balance.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/commands.h"
#include "etendue/core/spectral_function.h"
#include "etendue/describe/color.h"
#include "etendue/film/image_tools.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "images/white_balance.h"

namespace etendue {
namespace {

struct BalanceOptions {
  std::string in, out, white, to = "D65", method = "cat16";
};

Xyz white_of(const std::string& illuminant) { return to_xyz(*illuminant_spectrum(illuminant), ColorUse::radiance); }

int balance(const BalanceOptions& options) {
  note_input(options.in);
  OutputFiles files;
  files.add(options.out, {intern("OUT"), 0, 0});
  files.raise();
  const Image picture = convert_color_space(read_image(options.in), "xyz");
  write_any(white_balanced(picture, options.method, white_of(options.white), white_of(options.to)), options.out);
  return exit_status::done;
}

}  // namespace

void add_image_balance(Command& image) {
  Command command = image.add_command("balance", "Balance the white of a picture, by chromatic adaptation");
  auto options = std::make_shared<BalanceOptions>();
  command.argument("IN", options->in, "A picture of radiance, such as an EXR or NPY file").required();
  command.argument("OUT", options->out, "The file to write; its ending chooses the format").required();
  command.option("--white NAME", options->white, "The illuminant that the picture was lit with: A, D50, F11, …").required();
  command.option("--to NAME", options->to, "The white that it becomes").show_default();
  command.option("--method NAME", options->method, "cat16, bradford or von_kries").show_default().one_of(adaptation_names());
  command.footer(
      "\nExample\n  etendue image balance lamp.exr balanced.exr --white A\n  etendue image tonemap balanced.exr lamp.png");
  command.runs([options] { return balance(*options); });
}

}  // namespace etendue
