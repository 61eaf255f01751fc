// etendue image diff, info, tonemap, spectrum, sensor, balance, false-colour, glare, cryptomatte, merge, polarizer: tools for
// image files.

#include <fmt/format.h>

#include <cmath>

#include "app/commands.h"
#include "etendue/film/image_tools.h"
#include "etendue/language/language.h"
#include "etendue/render/job.h"
#include "etendue/tone_map.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "image_balance.h"
#include "image_cryptomatte.h"
#include "image_false_color.h"
#include "image_glare.h"
#include "image_merge.h"
#include "image_polarizer.h"
#include "image_sensor.h"
#include "image_spectrum.h"

namespace etendue {

namespace {

// ---- diff -------------------------------------------------------------------------------------------------------------

struct DiffOptions {
  std::string a, b;
  int tiles = 0;
  double tolerance = -1;  ///< negative: none
};

void print_comparison(const Comparison& c) {
  fmt::print("RMSE          {:.6g}\n", c.root_mean_square_error);
  fmt::print("relative MSE  {:.6g}   (its root: {:.6g})\n", c.relative_mean_square_error,
             std::sqrt(c.relative_mean_square_error));
  fmt::print("SMAPE         {:.6g} %\n", 100 * c.symmetric_error);
  fmt::print("maximum       {:.6g}", c.maximum_difference);
  if (!c.maximum_channel.empty()) fmt::print("   (channel {} of pixel {},{})", c.maximum_channel, c.maximum_x, c.maximum_y);
  fmt::print("\n\nchannel       mean of A     mean of B         A / B          RMSE       maximum\n");
  for (const ChannelComparison& channel : c.channels)
    fmt::print("{:<9} {:>13.6g} {:>13.6g} {:>13.6f} {:>13.6g} {:>13.6g}\n", channel.name, channel.mean_a, channel.mean_b,
               channel.ratio, channel.root_mean_square_error, channel.maximum_difference);
  if (c.not_finite > 0) fmt::print("\n{} values are not finite in one of the pictures and were left out\n", c.not_finite);
}

/// Ratios of the tiles' means of X, Y or Z. tile_ratios compares the channel named Y, so the channels are renamed.
std::vector<TileRatio> ratios_of(const std::string& channel, Image a, Image b, int size) {
  for (Image* image : {&a, &b})
    for (std::string& name : image->channels) {
      if (name == channel)
        name = "Y";
      else if (name == "Y")
        name = channel;
    }
  return tile_ratios(a, b, size);
}

/// Prints the ratios of Y of all tiles and the worst tile of each channel; returns the largest deviation from 1.
double print_tiles(const Image& given_a, const Image& given_b, int size) {
  const Image a = convert_color_space(given_a, "xyz"), b = convert_color_space(given_b, "xyz");
  fmt::print("\nmeans of {} x {} pixel tiles, A / B, of Y:\n", size, size);
  int row = 0;
  for (const TileRatio& tile : ratios_of("Y", a, b, size)) {
    if (tile.area.y0 != row) fmt::print("\n");
    row = tile.area.y0;
    fmt::print(" {:7.4f}", tile.ratio);
  }
  fmt::print("\n\n");
  double largest = 0;
  for (const char* channel : {"X", "Y", "Z"}) {
    TileRatio worst;
    double deviation = -1;
    for (const TileRatio& tile : ratios_of(channel, a, b, size)) {
      const double d = std::isnan(tile.ratio) ? INFINITY : std::abs(tile.ratio - 1);
      if (d <= deviation) continue;
      deviation = d;
      worst = tile;
    }
    fmt::print("worst tile of {}: {:.6f} at x {} to {}, y {} to {} (A {:.6g}, B {:.6g})\n", channel, worst.ratio, worst.area.x0,
               worst.area.x1, worst.area.y0, worst.area.y1, worst.mean_a, worst.mean_b);
    largest = std::max(largest, deviation);
  }
  return largest;
}

int diff(const DiffOptions& options) {
  const Image a = read_image(options.a), b = read_image(options.b);
  const Comparison comparison = compare(a, b);
  print_comparison(comparison);
  double deviation = std::sqrt(comparison.relative_mean_square_error);
  if (options.tiles > 0) deviation = print_tiles(a, b, options.tiles);
  if (options.tolerance < 0) return exit_status::done;

  const bool agree =
      deviation <= options.tolerance && comparison.not_finite == 0;  // a deviation that is NaN fails this comparison
  fmt::print("\n{} {:.6g} {} the tolerance {:.6g}\n",
             options.tiles > 0 ? "largest deviation of a tile" : "root of the relative MSE", deviation,
             deviation <= options.tolerance ? "is within" : "exceeds", options.tolerance);
  return agree ? exit_status::done : exit_status::failed;
}

void add_diff(Command& image) {
  Command command = image.add_command("diff", "Compare two pictures, in CIE XYZ");
  auto options = std::make_shared<DiffOptions>();
  command.argument("A", options->a, "A picture").required();
  command.argument("B", options->b, "The reference").required();
  command.option("--tiles N", options->tiles, "Compare also the means of tiles of N x N pixels").range(1, 1 << 20);
  command
      .option("--tolerance T", options->tolerance,
              "Exit with 1 if the root of the relative MSE exceeds this; with --tiles, if a tile's mean, in X, Y or Z, "
              "deviates by a larger fraction")
      .range(0.0, 1e30);
  command.footer(
      "\nExamples\n"
      "  etendue image diff a.exr b.exr\n"
      "  etendue image diff a.npy reference.npy --tiles 32 --tolerance 0.02");
  command.runs([options] { return diff(*options); });
}

// ---- info -------------------------------------------------------------------------------------------------------------

void add_info(Command& image) {
  Command command = image.add_command("info", "Show size, metadata and ranges of a picture");
  auto files = std::make_shared<std::vector<std::string>>();
  command.argument("FILE", *files, "Pictures").required();
  command.runs([files] {
    for (const std::string& file : *files) fmt::print("{}", describe_image(file));
    return exit_status::done;
  });
}

// ---- tonemap ------------------------------------------------------------------------------------------------------------

struct ToneMapOptions {
  std::string in, out, tone_map = write_description(*make<Job>()->tone_map);
};

int tone_map_picture(const ToneMapOptions& options) {
  const Ref<ToneMap> tone_map = ref_cast<ToneMap>(parse_component(options.tone_map, "--tone-map"));
  if (!tone_map)
    throw Error("'" + options.tone_map + "' is not a tone map; see etendue classes ToneMap", {intern("--tone-map"), 0, 0});
  prepare_tree(*tone_map);
  note_input(options.in);
  OutputFiles files;
  files.add(options.out, {intern("OUT"), 0, 0});
  files.raise();
  write_any(tone_map->apply(convert_color_space(read_image(options.in), "xyz")), options.out);
  return exit_status::done;
}

void add_tonemap(Command& image) {
  Command command = image.add_command("tonemap", "Apply a tone map to a picture of radiance");
  auto options = std::make_shared<ToneMapOptions>();
  command.argument("IN", options->in, "A picture of radiance, such as an EXR or NPY file").required();
  command.argument("OUT", options->out, "The file to write; its ending chooses the format").required();
  command.option("--tone-map TONEMAP", options->tone_map, "A tone map as it is written in a file").show_default();
  command.footer("\nExample\n  etendue image tonemap box.exr box.png --tone-map 'ReinhardToneMap { stops: 1 }'");
  command.runs([options] { return tone_map_picture(*options); });
}

}  // namespace

void add_image_command(Command& program) {
  Command command = program.add_command("image", "Compare, inspect, tone map and merge pictures");
  command.require_command();
  add_diff(command);
  add_info(command);
  add_tonemap(command);
  add_image_spectrum(command);
  add_image_sensor(command);
  add_image_balance(command);
  add_image_false_color(command);
  add_image_glare(command);
  add_image_cryptomatte(command);
  add_image_merge(command);
  add_image_polarizer(command);
}

}  // namespace etendue
