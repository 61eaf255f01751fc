// etendue image polarizer: a picture with its Stokes vectors, as seen through a polarizing filter.

#include "image_polarizer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/commands.h"
#include "etendue/film/image_tools.h"
#include "files/input_files.h"
#include "files/output_files.h"

namespace etendue {
namespace {

struct PolarizerOptions {
  std::string in, out, circular;
  double angle = 0;
};

size_t place_of(const Image& image, const std::string& channel, const std::string& file) {
  const auto found = std::ranges::find(image.channels, channel);
  if (found == image.channels.end())
    throw Error(fmt::format(
        "'{}' has no channel '{}': render it by PolarizedPathTracer, with the layer \"stokes\" of the image", file, channel));
  return size_t(found - image.channels.begin());
}

/// The filter lets (S0 + S1 cos 2a + S2 sin 2a) / 2 pass if it is linear, and (S0 + S3) / 2 or (S0 - S3) / 2 if it is circular.
Image filtered(const Image& image, const PolarizerOptions& options) {
  constexpr double pi_over_90 = 0.03490658503988659;
  double weights[3] = {std::cos(options.angle * pi_over_90), std::sin(options.angle * pi_over_90), 0};
  if (!options.circular.empty()) {
    weights[0] = weights[1] = 0;
    weights[2] = options.circular == "right" ? 1 : -1;
  }
  const size_t colors = std::min<size_t>(3, image.channels.size()), stride = image.channels.size();
  Image seen(image.width, image.height, {image.channels.begin(), image.channels.begin() + std::ptrdiff_t(colors)});
  seen.metadata = image.metadata;
  for (size_t c = 0; c < colors; ++c) {
    size_t places[3];
    for (size_t k = 0; k < 3; ++k) places[k] = place_of(image, fmt::format("S{}.{}", k + 1, image.channels[c]), options.in);
    for (size_t i = 0; i < size_t(image.width) * size_t(image.height); ++i) {
      double sum = image.values[i * stride + c];
      for (size_t k = 0; k < 3; ++k) sum += weights[k] * image.values[i * stride + places[k]];
      seen.values[i * colors + c] = std::max(sum / 2, 0.0);  // noise may make it slightly negative
    }
  }
  return seen;
}

int polarize(const PolarizerOptions& options) {
  note_input(options.in);
  OutputFiles files;
  files.add(options.out, {intern("OUT"), 0, 0});
  files.raise();
  write_any(filtered(read_image(options.in), options), options.out);
  return exit_status::done;
}

}  // namespace

void add_image_polarizer(Command& image) {
  Command command = image.add_command("polarizer", "Show a picture as through a polarizing filter, of its layer \"stokes\"");
  auto options = std::make_shared<PolarizerOptions>();
  command.argument("IN", options->in, "A picture with Stokes vectors, such as an EXR file").required();
  command.argument("OUT", options->out, "The file to write; its ending chooses the format").required();
  command.option("--angle DEGREES", options->angle, "Of what passes, counter-clockwise from horizontal")
      .show_default()
      .range(-360.0, 360.0);
  command.option("--circular HAND", options->circular, "A filter for circular light instead: right or left")
      .one_of({"right", "left"});
  command.footer(
      "\nExamples\n"
      "  etendue image polarizer window.exr through.exr --angle 90\n"
      "  etendue image tonemap through.exr through.png\n"
      "  etendue image false-colour window.exr -o degree.png --channel polarization.linear --unit degree --linear --range 0:1");
  command.runs([options] { return polarize(*options); });
}

}  // namespace etendue
