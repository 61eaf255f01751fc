// Digital Negatives (Adobe, Digital Negative Specification 1.4.0.0, chapter 6: mapping camera colour space to CIE XYZ).
//
// With the channels n of a perfect white and the matrix M from balanced channels to X, Y, Z (sensor.h),
//   ColorMatrix   = diag(n) M^-1: from X, Y, Z in an illuminant to channels, for M with the colours seen in the same
//   illuminant, ForwardMatrix = M: from balanced channels to X, Y, Z under D50, for M with the colours seen in D50.
// There is one of each for the illuminants A and D65, between which programs interpolate.

#include "raw_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "files/tiff_file.h"

namespace etendue {
namespace {

/// Numbers of tags and of what they hold.
enum Tag : std::uint16_t {
  new_subfile_type = 254,
  photometric_interpretation = 262,
  image_description = 270,
  maker = 271,
  model = 272,
  orientation = 274,
  software = 305,
  mosaic_size = 33421,
  mosaic_pattern = 33422,
  exposure_time = 33434,
  f_number = 33437,
  speed = 34855,
  dng_version = 50706,
  dng_backward_version = 50707,
  unique_camera_model = 50708,
  mosaic_plane_color = 50710,
  mosaic_layout = 50711,
  black_level = 50714,
  white_level = 50717,
  color_matrix_1 = 50721,
  color_matrix_2 = 50722,
  as_shot_neutral = 50728,
  calibration_illuminant_1 = 50778,
  calibration_illuminant_2 = 50779,
  forward_matrix_1 = 50964,
  forward_matrix_2 = 50965,
};
constexpr std::uint16_t rgb = 2, color_filter_array = 32803, linear_raw = 34892;  // photometric interpretations
constexpr std::uint16_t standard_light_a = 17, d65 = 21;                          // Exif's light sources

std::vector<double> row_major(const SensorMatrix& m) {
  std::vector<double> all;
  for (const auto& row : m) all.insert(all.end(), row.begin(), row.end());
  return all;
}

std::vector<double> color_matrix(const Sensor& sensor, const SpectralFunction& light) {
  SensorMatrix m = inverse(sensor_matrix(sensor, light, light));
  const std::array<double, 3> neutral = sensor_neutral(sensor, light);
  for (size_t c = 0; c < 3; ++c)
    for (double& x : m[c]) x *= neutral[c];
  return row_major(m);
}

std::string description_of(const Image& image) {
  std::string text;
  for (const char* key : {"sensor", "sensor_quantity", "noise", "clipped"})
    if (const auto found = image.metadata.find(key); found != image.metadata.end())
      text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", key, found->second);
  return text;
}

/// The colours of a mosaic as numbers of channels.
std::vector<std::uint8_t> colors_of(const std::string& mosaic) {
  const std::vector<std::string> known = mosaic_names();
  if (std::ranges::find(known, mosaic) == known.end())
    throw Error(fmt::format("'{}' is no order of colours in a mosaic", mosaic));
  std::vector<std::uint8_t> colors;
  for (const char c : mosaic) colors.push_back(c == 'R' ? 0 : c == 'G' ? 1 : 2);
  return colors;
}

void add_colors(TiffFields& fields, const Sensor& sensor, const SpectralFunction& white) {
  const Color a = illuminant_spectrum("A"), daylight = illuminant_spectrum("D65"), paper = illuminant_spectrum("D50");
  fields.add_shorts(calibration_illuminant_1, {standard_light_a});
  fields.add_shorts(calibration_illuminant_2, {d65});
  fields.add_signed_rationals(color_matrix_1, color_matrix(sensor, *a));
  fields.add_signed_rationals(color_matrix_2, color_matrix(sensor, *daylight));
  fields.add_signed_rationals(forward_matrix_1, row_major(sensor_matrix(sensor, *a, *paper)));
  fields.add_signed_rationals(forward_matrix_2, row_major(sensor_matrix(sensor, *daylight, *paper)));
  const std::array<double, 3> neutral = sensor_neutral(sensor, white);
  fields.add_rationals(as_shot_neutral, {neutral[0], neutral[1], neutral[2]});
}

}  // namespace

std::vector<std::string> mosaic_names() { return {"RGGB", "BGGR", "GRBG", "GBRG"}; }

void write_dng(const Image& numbers, const Sensor& sensor, const std::string& camera, const SpectralFunction& white,
               const std::string& mosaic, const std::string& path) {
  TiffFields fields, exif;
  fields.add_longs(new_subfile_type, {0});
  fields.add_text(image_description, description_of(numbers));
  fields.add_text(maker, camera.substr(0, camera.find(' ')));
  fields.add_text(model, camera);
  fields.add_shorts(orientation, {1});
  fields.add_text(software, fmt::format("Etendue {}", ETENDUE_VERSION));
  fields.add_bytes(dng_version, {1, 4, 0, 0});
  fields.add_bytes(dng_backward_version, {1, 1, 0, 0});
  fields.add_text(unique_camera_model, camera + ", simulated");
  add_colors(fields, sensor, white);
  exif.add_rationals(exposure_time, {sensor.shutter});
  exif.add_rationals(f_number, {sensor.f_number});
  exif.add_shorts(speed, {std::uint16_t(std::clamp(std::round(sensor.iso), 1.0, 65535.0))});

  const std::uint32_t most = std::uint32_t(std::exp2(sensor.bits)) - 1;
  const auto black = std::uint16_t(sensor.black_level);
  std::vector<std::uint16_t> samples;
  if (mosaic.empty()) {
    fields.add_shorts(photometric_interpretation, {linear_raw});
    fields.add_shorts(black_level, {black, black, black});
    fields.add_longs(white_level, {most, most, most});
    for (const double v : numbers.values) samples.push_back(std::uint16_t(v));
    return write_tiff(path, numbers.width, numbers.height, 3, samples, fields, exif);
  }
  const std::vector<std::uint8_t> colors = colors_of(mosaic);
  fields.add_shorts(photometric_interpretation, {color_filter_array});
  fields.add_shorts(mosaic_size, {2, 2});
  fields.add_bytes(mosaic_pattern, colors);
  fields.add_bytes(mosaic_plane_color, {0, 1, 2});
  fields.add_shorts(mosaic_layout, {1});  // rectangular
  fields.add_shorts(black_level, {black});
  fields.add_longs(white_level, {most});
  for (int y = 0; y < numbers.height; ++y)
    for (int x = 0; x < numbers.width; ++x)
      samples.push_back(std::uint16_t(numbers.at(x, y, colors[size_t(2 * (y % 2) + x % 2)])));
  write_tiff(path, numbers.width, numbers.height, 1, samples, fields, exif);
}

void write_linear_tiff(const Image& image, double largest, const std::string& path) {
  TiffFields fields;
  fields.add_shorts(photometric_interpretation, {rgb});
  if (const std::string text = description_of(image); !text.empty()) fields.add_text(image_description, text);
  fields.add_text(software, fmt::format("Etendue {}", ETENDUE_VERSION));
  std::vector<std::uint16_t> samples;
  for (const double v : image.values) samples.push_back(std::uint16_t(std::lround(std::clamp(v / largest, 0.0, 1.0) * 65535)));
  write_tiff(path, image.width, image.height, 3, samples, fields);
}

}  // namespace etendue
