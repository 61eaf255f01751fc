// etendue image sensor: what a digital camera would record of a spectral picture.

#include "image_sensor.h"

#include <fmt/format.h>

#include "app/commands.h"
#include "app/text.h"
#include "etendue/describe/color.h"
#include "etendue/film/image_tools.h"
#include "etendue/output.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "film/image_bands.h"
#include "film/sensor.h"

namespace etendue {
namespace {

struct SensorOptions {
  std::string in, out, sensitivities, columns = "2,3,4", white;
  double iso = Sensor().iso, shutter = Sensor().shutter, f_number = Sensor().f_number;
  double full_well = 0, read_noise = SensorNoise().read;
  int bits = Sensor().bits;
  std::uint64_t seed = 0;
};

Sensor sensor_of(const SensorOptions& options) {
  Sensor sensor;
  std::vector<std::string> columns;
  for (size_t at = 0; at <= options.columns.size();) {
    const size_t end = std::min(options.columns.find(',', at), options.columns.size());
    columns.push_back(options.columns.substr(at, end - at));
    at = end + 1;
  }
  if (columns.size() != 3)
    throw Error(fmt::format("takes three columns, as in red,green,blue, not '{}'", options.columns),
                {intern("--columns"), 0, 0});
  for (size_t c = 0; c < 3; ++c) sensor.sensitivities[c] = file_spectrum(FilePath(options.sensitivities), columns[c]);
  sensor.iso = options.iso;
  sensor.shutter = options.shutter;
  sensor.f_number = options.f_number;
  sensor.bits = options.bits;
  if (options.full_well > 0) sensor.noise = SensorNoise{options.full_well, options.read_noise, options.seed};
  return sensor;
}

/// The numbers of a display format are fractions of its largest one: a 16 bit file then holds the digital numbers themselves.
void write_numbers(Image numbers, const std::string& path) {
  if (path.ends_with(".npy")) {
    // An NpyOutput writes X, Y and Z. Called so, the numbers are not turned from R, G, B into these.
    numbers.channels = {"X", "Y", "Z"};
    numbers.metadata["color_space"] = "xyz";
    return write_any(numbers, path);
  }
  const Ref<Output> png = ref_cast<Output>(Registry::instance().create("PngOutput"));
  if (!path.ends_with(".png")) return write_any(numbers, path);
  for (double& v : numbers.values) v /= 65535;
  numbers.metadata["transfer"] = "linear";
  set(*png, "bits", Value(Number{16}));
  png->prepare();
  png->write_image(numbers, path);
}

int expose(const SensorOptions& options) {
  note_input(options.in);
  note_input(options.sensitivities);
  OutputFiles files;
  files.add(options.out, {intern("OUT"), 0, 0});
  files.raise();
  const Image spectral = read_image(options.in);
  const Sensor sensor = sensor_of(options);
  const Image raw = digital_numbers(spectral, sensor);
  if (options.white.empty())
    write_numbers(raw, options.out);
  else
    write_any(developed(raw, sensor, *illuminant_spectrum(options.white)), options.out);

  const Image xyz = convert_color_space(spectral, "xyz");
  const auto y = size_t(std::ranges::find(xyz.channels, "Y") - xyz.channels.begin());
  double luminance = 0;
  for (size_t i = y; i < xyz.values.size(); i += xyz.channels.size())
    luminance += 683 * observer_y_integral() * xyz.values[i] / (double(xyz.width) * double(xyz.height));
  fmt::print("{}: {}; {} of the pixels are clipped\n", options.out, raw.metadata.at("sensor"), raw.metadata.at("clipped"));
  if (luminance > 0)
    fmt::print("mean luminance {:.4g} cd/m2, exposure value {:.2f} at ISO 100\n", luminance, exposure_value(luminance));
  return exit_status::done;
}

}  // namespace

void add_image_sensor(Command& image) {
  Command command = image.add_command("sensor", "Expose a digital sensor to a spectral picture");
  auto options = std::make_shared<SensorOptions>();
  command.argument("IN", options->in, "A picture with channels such as S0.550nm").required();
  command.argument("OUT", options->out, "The file to write: .png has the digital numbers in 16 bits, .npy and .exr as numbers")
      .required();
  command.option("--sensitivities FILE", options->sensitivities, "A CSV: wavelength [nm] and a column for each channel")
      .required();
  command.option("--columns R,G,B", options->columns, "Names or numbers of the columns of red, green and blue").show_default();
  command.option("--iso S", options->iso, "Speed").show_default().range(1e-3, 1e9);
  command.option("--shutter T", options->shutter, "Time of exposure [s]").show_default().range(1e-9, 1e9);
  command.option("--f-number N", options->f_number, "Of the lens").show_default().range(0.1, 1000.0);
  command.option("--bits N", options->bits, "Of a digital number").show_default().range(1, 16);
  command.option("--white NAME", options->white,
                 "Write a colour picture instead, in which this illuminant (D65, A, …) is neutral: the channels scaled, and a "
                 "matrix to the colours under D65");
  command.option("--full-well N", options->full_well, "Add noise: of photons, of which a saturated channel has N electrons")
      .range(1.0, 1e12);
  command.option("--read-noise E", options->read_noise, "and of the read-out, its standard deviation in electrons")
      .needs("--full-well")
      .show_default()
      .range(0.0, 1e9);
  command.option("--seed N", options->seed, "Seed of the noise").needs("--full-well");
  command.footer(
      "\nExamples\n"
      "  etendue image sensor box.exr raw.png --sensitivities camera.csv --iso 400 --shutter 0.005 --f-number 4\n"
      "  etendue image sensor box.exr photo.png --sensitivities camera.csv --white A --full-well 40000");
  command.runs([options] { return expose(*options); });
}

}  // namespace etendue
