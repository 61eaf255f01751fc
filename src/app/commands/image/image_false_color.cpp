// etendue image false-colour: luminances as colours, with a legend.

#include "image_false_color.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "app/commands.h"
#include "etendue/describe/color.h"
#include "etendue/film/image_tools.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "images/false_color.h"

namespace etendue {
namespace {

struct FalseColorOptions {
  std::string in, out, unit = "cd/m2", range, channel, color_map = ColorScale().color_map;
  double scale = 0;
  bool linear = false;
};

double number_of(std::string_view text, const std::string& all) {
  double v = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(v))
    throw Error(fmt::format("takes two numbers, as in 1:10000, not '{}'", all), {intern("--range"), 0, 0});
  return v;
}

/// The numbers that are shown: luminance, or one channel as it is.
std::vector<double> values_of(const Image& given, const FalseColorOptions& options) {
  const Image image = options.channel.empty() ? convert_color_space(given, "xyz") : given;
  const std::string name = options.channel.empty() ? "Y" : options.channel;
  const size_t count = image.channels.size();
  const auto c = size_t(std::ranges::find(image.channels, name) - image.channels.begin());
  if (c == count) throw Error(fmt::format("'{}' has no channel '{}'", options.in, name));
  const bool photometric = options.channel.empty() && options.unit == "cd/m2";
  const double scale = options.scale > 0 ? options.scale : photometric ? 683 * observer_y_integral() : 1;
  std::vector<double> values(image.values.size() / count);
  for (size_t i = 0; i < values.size(); ++i) values[i] = scale * image.values[i * count + c];
  return values;
}

ColorScale scale_of(const std::vector<double>& values, const FalseColorOptions& options) {
  ColorScale scale;
  if (options.range.empty()) {
    scale = decades_of(values, 4);
    if (options.linear) scale.low = 0;
  } else {
    const size_t colon = options.range.find(':');
    scale.low = number_of(std::string_view(options.range).substr(0, colon), options.range);
    scale.high = number_of(colon == std::string::npos ? "" : std::string_view(options.range).substr(colon + 1), options.range);
  }
  scale.logarithmic = !options.linear;
  if (!(scale.low < scale.high) || (scale.logarithmic && !(scale.low > 0)))
    throw Error(fmt::format("must grow, and a logarithmic scale begin above 0 (--linear makes another): '{}'", options.range),
                {intern("--range"), 0, 0});
  scale.color_map = options.color_map;
  scale.unit = options.unit;
  return scale;
}

int show(const FalseColorOptions& options) {
  if (!options.out.ends_with(".png") && !options.out.ends_with(".tga"))
    throw Error("is a picture to be looked at: its ending is .png or .tga", {intern("--output"), 0, 0});
  note_input(options.in);
  OutputFiles files;
  files.add(options.out, {intern("--output"), 0, 0});
  files.raise();
  const Image image = read_image(options.in);
  const std::vector<double> values = values_of(image, options);
  const ColorScale scale = scale_of(values, options);
  write_any(false_color(values, image.width, image.height, scale), options.out);

  size_t below = 0, above = 0, bad = 0;
  for (const double v : values) {
    bad += !std::isfinite(v);
    below += v < scale.low;
    above += v > scale.high;
  }
  const double all = double(values.size()) / 100;
  fmt::print("{}: {:.6g} to {:.6g} {}; {:.3g} % of the pixels are below, {:.3g} % above\n", options.out, scale.low, scale.high,
             scale.unit, double(below) / all, double(above) / all);
  if (bad > 0) warn(fmt::format("{} pixels are not finite, and magenta", bad));
  return exit_status::done;
}

}  // namespace

void add_image_false_color(Command& image) {
  Command command = image.add_command("false-colour", "Show luminances as colours, with a legend");
  auto options = std::make_shared<FalseColorOptions>();
  command.argument("IN", options->in, "A picture of radiance, such as an EXR or NPY file").required();
  command.option("-o,--output FILE", options->out, "The picture to write, .png or .tga").required();
  command.option("--unit NAME", options->unit, "What the legend says. For cd/m2 luminances are computed; others name --channel")
      .show_default();
  command.option("--range LOW:HIGH", options->range,
                 "Values at the ends of the scale; without it, up to four decades that fit");
  command.option("--channel NAME", options->channel, "Show this channel as it is, not the luminance; --unit names it");
  command.option("--scale F", options->scale, "Multiply the values instead of Y's factor to cd/m2: 179 for Radiance's pictures")
      .range(1e-30, 1e30);
  command.option("--map NAME", options->color_map, "The colours").show_default().one_of(color_map_names());
  command.flag("--linear", options->linear, "A linear scale, not a logarithmic one");
  command.footer(
      "\nExamples\n"
      "  etendue image false-colour room.exr -o room.png --range 1:10000\n"
      "  etendue image false-colour room.exr -o depth.png --channel depth.Z --unit m --linear --map turbo");
  command.runs([options] { return show(*options); });
}

}  // namespace etendue
