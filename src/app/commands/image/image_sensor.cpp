// etendue image sensor: what a digital camera would record of a spectral picture.

#include "image_sensor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "app/commands.h"
#include "app/text.h"
#include "etendue/describe/color.h"
#include "etendue/describe/sensor_curves.h"
#include "etendue/film/image_tools.h"
#include "etendue/output.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "film/image_bands.h"
#include "film/sensor.h"
#include "images/raw_file.h"

namespace etendue {
namespace {

/// Of options with 0 the default holds; it is 0 so that it can be known whether they were given.
struct SensorOptions {
  std::string in, out, camera, sensitivities, columns = "2,3,4", white, mosaic, speed = "saturation", quantity = "numbers";
  double iso = Sensor().iso, shutter = Sensor().shutter, f_number = Sensor().f_number;
  double full_well = 0, base_iso = 0, conversion_gain = 0;
  double read_noise = SensorNoise().read, dark_current = SensorNoise().dark_current;
  int bits = Sensor().bits, black_level = Sensor().black_level;
  bool noise = false;
  std::uint64_t seed = 0;
};

[[noreturn]] void reject(const char* option, const std::string& reason) { throw Error(reason, {intern(option), 0, 0}); }

bool ends_in(const SensorOptions& options, std::initializer_list<const char*> endings) {
  std::string ending = std::filesystem::path(options.out).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return std::ranges::find(endings, ending) != endings.end();
}
bool is_dng(const SensorOptions& options) { return ends_in(options, {".dng"}); }
bool is_tiff(const SensorOptions& options) { return ends_in(options, {".tif", ".tiff"}); }

/// What would be ignored is an error.
void check(const SensorOptions& options) {
  const bool numbers = options.quantity == "numbers";
  if (options.camera.empty() == options.sensitivities.empty())
    reject("image sensor",
           fmt::format("needs either --sensitivities or --camera; known are {}", fmt::join(sensor_names(), ", ")));
  if (!options.mosaic.empty() && !is_dng(options)) reject("--mosaic", "is for files that end in .dng");
  if (!numbers && (is_dng(options) || is_tiff(options) || ends_in(options, {".png"})))
    reject("--quantity", "files of this kind hold digital numbers; .npy and .exr hold electrons and volts");
  if (ends_in(options, {".tga", ".jpg", ".jpeg", ".bmp", ".hdr"}))
    reject("--output", "files of this kind do not hold digital numbers: .png, .tif, .dng, .npy and .exr do");
  if (!numbers && !options.white.empty()) reject("--white", "a colour picture is made of digital numbers");
  if (numbers && !options.noise)
    for (const auto& [name, value] : {std::pair("--full-well", options.full_well), std::pair("--base-iso", options.base_iso)})
      if (value > 0) reject(name, "has no effect on digital numbers without --noise");
  if (options.quantity != "volts" && options.conversion_gain > 0) reject("--conversion-gain", "has an effect on volts alone");
}

std::vector<std::string> columns_of(const std::string& text) {
  std::vector<std::string> columns;
  for (size_t at = 0; at <= text.size();) {
    const size_t end = std::min(text.find(',', at), text.size());
    columns.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  if (columns.size() != 3) reject("--columns", fmt::format("takes three columns, as in red,green,blue, not '{}'", text));
  return columns;
}

Sensor sensor_of(const SensorOptions& options) {
  Sensor sensor;
  if (options.camera.empty()) {
    const std::vector<std::string> columns = columns_of(options.columns);
    for (size_t c = 0; c < 3; ++c) sensor.sensitivities[c] = file_spectrum(FilePath(options.sensitivities), columns[c]);
  } else {
    try {
      for (size_t c = 0; c < 3; ++c) sensor.sensitivities[c] = sensor_curve(options.camera, sensor_channels[c]);
    } catch (const Error& e) {
      reject("--camera", e.what());
    }
  }
  sensor.iso = options.iso;
  sensor.speed_rule = options.speed == "saturation" ? SpeedRule::saturation : SpeedRule::standard_output;
  sensor.shutter = options.shutter;
  sensor.f_number = options.f_number;
  sensor.bits = options.bits;
  sensor.black_level = options.black_level;
  if (options.full_well > 0) sensor.photosites.full_well = options.full_well;
  if (options.base_iso > 0) sensor.photosites.base_iso = options.base_iso;
  if (options.conversion_gain > 0) sensor.photosites.conversion_gain = options.conversion_gain;
  if (options.noise) sensor.noise = SensorNoise{options.read_noise, options.dark_current, options.seed};
  return sensor;
}

/// The numbers of a display format are fractions of its largest one: a 16 bit file then holds the digital numbers themselves.
void write_numbers(Image numbers, const SensorOptions& options) {
  if (is_tiff(options)) return write_linear_tiff(numbers, 65535, options.out);
  if (ends_in(options, {".npy"})) {
    // An NpyOutput writes X, Y and Z. Called so, the numbers are not turned from R, G, B into these.
    numbers.channels = {"X", "Y", "Z"};
    numbers.metadata["color_space"] = "xyz";
    return write_any(numbers, options.out);
  }
  if (!ends_in(options, {".png"})) return write_any(numbers, options.out);
  const Ref<Output> png = ref_cast<Output>(Registry::instance().create("PngOutput"));
  for (double& v : numbers.values) v /= 65535;
  numbers.metadata["transfer"] = "linear";
  set(*png, "bits", Value(Number{16}));
  png->prepare();
  png->write_image(numbers, options.out);
}

void write(const Image& raw, const Sensor& sensor, const SensorOptions& options) {
  if (is_dng(options)) {
    const std::string camera = options.camera.empty() ? "Etendue sensor" : options.camera;
    return write_dng(raw, sensor, camera, *illuminant_spectrum(options.white.empty() ? "D65" : options.white), options.mosaic,
                     options.out);
  }
  if (options.white.empty()) return write_numbers(raw, options);
  const Image picture = developed(raw, sensor, *illuminant_spectrum(options.white));
  if (is_tiff(options)) return write_linear_tiff(picture, 1, options.out);
  write_any(picture, options.out);
}

double mean_luminance(const Image& picture) {
  const Image xyz = convert_color_space(picture, "xyz");
  const auto y = size_t(std::ranges::find(xyz.channels, "Y") - xyz.channels.begin());
  double luminance = 0;
  for (size_t i = y; i < xyz.values.size(); i += xyz.channels.size())
    luminance += 683 * observer_y_integral() * xyz.values[i] / (double(xyz.width) * double(xyz.height));
  return luminance;
}

int expose(const SensorOptions& options) {
  check(options);
  note_input(options.in);
  if (!options.sensitivities.empty()) note_input(options.sensitivities);
  OutputFiles files;
  files.add(options.out, {intern("OUT"), 0, 0});
  files.raise();
  const Image spectral = read_image(options.in);
  const Sensor sensor = sensor_of(options);
  const Image raw = recorded(spectral, sensor,
                             options.quantity == "volts"       ? SensorQuantity::volts
                             : options.quantity == "electrons" ? SensorQuantity::electrons
                                                               : SensorQuantity::numbers);
  write(raw, sensor, options);

  fmt::print("{}: {}; {}; noise: {}; {} of the pixels are clipped\n", options.out, raw.metadata.at("sensor"),
             raw.metadata.at("sensor_quantity"), raw.metadata.at("noise"), raw.metadata.at("clipped"));
  const double luminance = mean_luminance(spectral), settings = exposure_value(sensor);
  if (!(luminance > 0)) return exit_status::done;
  const double scene = exposure_value(luminance);
  fmt::print(
      "mean luminance {:.4g} cd/m2, exposure value {:.2f} at ISO 100; that of the settings is {:.2f}: {:.2f} stops {} than a "
      "light meter exposes\n",
      luminance, scene, settings, std::abs(scene - settings), scene < settings ? "darker" : "brighter");
  return exit_status::done;
}

void add_electronics(Command& command, SensorOptions& options) {
  const Photosites usual;
  command.option("--quantity Q", options.quantity, "What .npy and .exr files hold: numbers, electrons or volts")
      .show_default()
      .one_of({"numbers", "electrons", "volts"});
  command.flag("--noise", options.noise, "Add the noise of photons and of the read-out");
  command
      .option("--full-well N", options.full_well,
              fmt::format("Electrons that a photosite holds, which fill the numbers at the base speed [{:g}]", usual.full_well))
      .range(1.0, 1e12);
  command
      .option("--base-iso S", options.base_iso,
              fmt::format("The lowest speed; higher ones fill the numbers with fewer electrons [{:g}]", usual.base_iso))
      .range(1e-3, 1e9);
  command
      .option("--conversion-gain G", options.conversion_gain,
              fmt::format("Microvolts of an electron at the base speed [{:g}]", usual.conversion_gain))
      .range(1e-6, 1e6);
  command.option("--read-noise E", options.read_noise, "Standard deviation of the read-out in electrons")
      .needs("--noise")
      .show_default()
      .range(0.0, 1e9);
  command.option("--dark-current D", options.dark_current, "Electrons per second without light")
      .needs("--noise")
      .show_default()
      .range(0.0, 1e12);
  command.option("--seed N", options.seed, "Seed of the noise").needs("--noise");
}

}  // namespace

void add_image_sensor(Command& image) {
  Command command = image.add_command("sensor", "Expose a digital sensor to a spectral picture");
  auto options = std::make_shared<SensorOptions>();
  command.argument("IN", options->in, "A picture with channels such as S0.550nm").required();
  command
      .argument(
          "OUT", options->out,
          "The file to write: .dng for raw developers; .png and .tif have the digital numbers in 16 bits, .npy and .exr as "
          "numbers")
      .required();
  command.option("--camera NAME", options->camera, fmt::format("A measured camera: {}", fmt::join(sensor_names(), ", ")));
  command.option("--sensitivities FILE", options->sensitivities, "Or a CSV: wavelength [nm] and a column for each channel")
      .excludes({"--camera"});
  command.option("--columns R,G,B", options->columns, "Names or numbers of the columns of red, green and blue")
      .needs("--sensitivities")
      .show_default();
  command.option("--iso S", options->iso, "Speed").show_default().range(1e-3, 1e9);
  command.option("--speed RULE", options->speed, "What the speed says (ISO 12232): saturation or standard-output")
      .show_default()
      .one_of({"saturation", "standard-output"});
  command.option("--shutter T", options->shutter, "Time of exposure [s]").show_default().range(1e-9, 1e9);
  command.option("--f-number N", options->f_number, "Of the lens").show_default().range(0.1, 1000.0);
  command.option("--bits N", options->bits, "Of a digital number").show_default().range(1, 16);
  command.option("--black-level N", options->black_level, "Digital number of no light").show_default().range(0, 65534);
  command.option("--white NAME", options->white,
                 "Write a colour picture instead, in which this illuminant (D65, A, …) is neutral: the channels scaled, and a "
                 "matrix to the colours under D65; the white that a .dng states");
  command.option("--mosaic ORDER", options->mosaic, "Keep one colour of each pixel in a .dng: RGGB, BGGR, GRBG or GBRG")
      .one_of(mosaic_names());
  add_electronics(command, *options);
  command.footer(
      "\nExamples\n"
      "  etendue image sensor box.exr raw.dng --camera \"Nikon D5100\" --shutter 0.005 --f-number 4 --mosaic RGGB\n"
      "  etendue image sensor box.exr photo.png --camera \"Nikon D5100\" --white A --noise --full-well 40000\n"
      "  etendue image sensor box.exr raw.png --sensitivities camera.csv --iso 400");
  command.runs([options] { return expose(*options); });
}

}  // namespace etendue
