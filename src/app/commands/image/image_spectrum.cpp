// etendue image spectrum: the spectrum of a pixel or rectangle of a spectral image, as a table or as JSON; and the picture of
// one band.

#include "image_spectrum.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "etendue/film/image_tools.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "film/image_bands.h"

namespace etendue {
namespace {

using Json = nlohmann::ordered_json;

struct SpectrumOptions {
  std::string file, pixel, area, output;
  double band = 0;  ///< [nm]; 0: none
  bool json = false;
};

/// Whole numbers separated by commas.
std::vector<int> whole_numbers(const std::string& text, size_t count, const char* option) {
  std::vector<int> numbers;
  size_t at = 0;
  while (at <= text.size()) {
    const size_t end = std::min(text.find(',', at), text.size());
    const std::string one = text.substr(at, end - at);
    if (one.empty() || one.find_first_not_of("0123456789") != one.npos || one.size() > 6) {
      numbers.clear();
      break;
    }
    numbers.push_back(std::stoi(one));
    at = end + 1;
  }
  if (numbers.size() != count)
    throw Error(fmt::format("takes {} whole numbers separated by commas, not '{}'", count, text), {intern(option), 0, 0});
  return numbers;
}

PixelArea area_of(const SpectrumOptions& options, const Image& image) {
  PixelArea area{0, 0, image.width, image.height};
  if (!options.pixel.empty()) {
    const std::vector<int> at = whole_numbers(options.pixel, 2, "--pixel");
    area = {at[0], at[1], at[0] + 1, at[1] + 1};
  } else if (!options.area.empty()) {
    const std::vector<int> at = whole_numbers(options.area, 4, "--area");
    area = {at[0], at[1], at[2], at[3]};
  }
  if (area.width() < 1 || area.height() < 1 || area.x1 > image.width || area.y1 > image.height)
    throw Error(fmt::format("'{}' has {} x {} pixels; {},{} to {},{} is no part of it", options.file, image.width, image.height,
                            area.x0, area.y0, area.x1, area.y1));
  return area;
}

double mean_of(const Image& image, const PixelArea& area, size_t channel) {
  double sum = 0;
  for (int y = area.y0; y < area.y1; ++y)
    for (int x = area.x0; x < area.x1; ++x) sum += image.at(x, y, channel);
  return sum / (double(area.width()) * double(area.height()));
}

/// A picture of one band: its value in all three components.
void write_band(const Image& image, const ImageBand& band, const std::string& path) {
  Image grey(image.width, image.height, {"R", "G", "B"});
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (size_t c = 0; c < 3; ++c) grey.at(x, y, c) = image.at(x, y, band.channel);
  grey.metadata = {{"color_space", "srgb"}, {"transfer", "linear"}, {"band", image.channels[band.channel]}};
  write_any(grey, path);
}

int show(const SpectrumOptions& options) {
  note_input(options.file);
  const Image image = read_image(options.file);
  BandKind kind = BandKind::emissive;
  std::vector<ImageBand> bands = bands_of(image);
  if (bands.empty()) bands = bands_of(image, kind = BandKind::reflective);
  if (bands.empty())
    throw Error(fmt::format("'{}' has no spectrum: none of its channels is named as 'S0.550nm' or 'T.550nm'", options.file));
  const std::vector<double> edges = kind == BandKind::emissive ? band_edges_of(image) : std::vector<double>();
  const char* unit = kind == BandKind::emissive ? "W/(m2 sr nm)" : "1";

  if (options.band > 0) {
    const auto nearest =
        std::ranges::min_element(bands, {}, [&](const ImageBand& b) { return std::abs(b.wavelength - options.band); });
    if (options.output.empty()) throw Error("needs a file to write", {intern("--output"), 0, 0});
    OutputFiles files;
    files.add(options.output, {intern("--output"), 0, 0});
    files.raise();
    write_band(image, *nearest, options.output);
    fmt::print("{}: {}\n", options.output, image.channels[nearest->channel]);
    return exit_status::done;
  }

  const PixelArea area = area_of(options, image);
  std::vector<double> means, wavelengths;
  for (const ImageBand& band : bands) {
    means.push_back(mean_of(image, area, band.channel));
    wavelengths.push_back(band.wavelength);
  }
  if (options.json) {
    const Json json = {{"file", options.file}, {"area", {area.x0, area.y0, area.x1, area.y1}},
                       {"unit", unit},         {"wavelengths", wavelengths},
                       {"edges", edges},       {"values", means}};
    fmt::print("{}\n", json.dump(2));
    return exit_status::done;
  }
  fmt::print("mean of the pixels {},{} to {},{} [{}]\n", area.x0, area.y0, area.x1 - 1, area.y1 - 1, unit);
  const double most = std::max(*std::ranges::max_element(means), 0.0);
  constexpr double columns = 40;
  for (size_t b = 0; b < bands.size(); ++b) {
    const auto stars = size_t(most > 0 ? std::max(columns * means[b] / most + 0.5, 0.0) : 0.0);
    fmt::print("{:>9.6g} nm {:>13.6g}  {}\n", wavelengths[b], means[b], std::string(stars, '*'));
  }
  return exit_status::done;
}

}  // namespace

void add_image_spectrum(Command& image) {
  Command command = image.add_command("spectrum", "Show the spectrum of a spectral picture's pixels");
  auto options = std::make_shared<SpectrumOptions>();
  command.argument("FILE", options->file, "A picture with channels such as S0.550nm").required();
  command.option("--pixel X,Y", options->pixel, "Of this pixel; without it, the mean of all");
  command.option("--area X0,Y0,X1,Y1", options->area, "The mean of these pixels; X1 and Y1 are excluded").excludes({"--pixel"});
  command.option("--band NM", options->band, "Write a picture of the band nearest to this wavelength instead").range(1e-3, 1e9);
  command.option("-o,--output FILE", options->output, "The picture of the band; its ending chooses the format").needs("--band");
  command.flag("--json", options->json, "Print JSON");
  command.footer(
      "\nExamples\n"
      "  etendue image spectrum box.exr --pixel 120,80\n"
      "  etendue image spectrum box.exr --band 550 -o green.png");
  command.runs([options] { return show(*options); });
}

}  // namespace etendue
