#include "report_pictures.h"

#include <algorithm>
#include <cmath>

#include "images/base64.h"
#include "images/image_library.h"

namespace etendue::verify {
namespace {

unsigned char byte(double v) { return static_cast<unsigned char>(std::clamp(v, 0.0, 255.0) + 0.5); }

}  // namespace

std::string png_uri(int width, int height, const std::vector<unsigned char>& rgb) {
  ImageHeader header(width, height, 3, NumberType::uint8);
  header.transfer = "srgb";
  header.compression_level = 9;
  try {
    return "data:image/png;base64," + base64(image_library().encode(".png", header, rgb));
  } catch (const Error& e) {
    throw Error(std::string("cannot make a PNG for the report: ") + e.what());
  }
}

std::array<unsigned char, 3> difference_color(double z) {
  // From light grey to red or blue, which people with colour deficiencies can distinguish.
  constexpr double middle[3] = {247, 247, 247}, red[3] = {178, 24, 43}, blue[3] = {33, 102, 172};
  const double t = std::min(std::abs(z) / z_of_full_color, 1.0);
  const double* end = z > 0 ? red : blue;
  std::array<unsigned char, 3> color{};
  for (size_t c = 0; c < 3; ++c) color[c] = byte(middle[c] + t * (end[c] - middle[c]));
  return color;
}

std::string difference_map(const Layout& layout, const PairAgreement& pair, size_t layer) {
  // The map is between 256 and 512 pixels wide or high, so that frames are thin and files small.
  constexpr int wanted = 256;
  const PixelArea all = layout.area(layout.whole());
  const int side = std::max(all.width(), all.height());
  const int up = std::max(1, wanted / side), down = std::max(1, side / wanted);
  const int width = std::max(1, all.width() * up / down), height = std::max(1, all.height() * up / down);
  std::vector<unsigned char> rgb(size_t(width) * size_t(height) * 3, 247);
  for (const MeanTest& test : pair.tests) {
    if (test.layer != layer || test.place == layout.whole()) continue;
    const PixelArea tile = layout.area(test.place);
    const auto scaled = [&](int pixel, int first, int limit) { return std::min((pixel - first) * up / down, limit); };
    const PixelArea on_map{scaled(tile.x0, all.x0, width), scaled(tile.y0, all.y0, height), scaled(tile.x1, all.x0, width),
                           scaled(tile.y1, all.y0, height)};
    const std::array<unsigned char, 3> color = difference_color(test.z);
    for (int y = on_map.y0; y < on_map.y1; ++y)
      for (int x = on_map.x0; x < on_map.x1; ++x) {
        const bool edge = x == on_map.x0 || y == on_map.y0 || x == on_map.x1 - 1 || y == on_map.y1 - 1;
        const bool frame = edge && test.verdict != Verdict::agrees;
        for (size_t c = 0; c < 3; ++c)
          rgb[3 * (size_t(y) * size_t(width) + size_t(x)) + c] = !frame                               ? color[c]
                                                                 : test.verdict == Verdict::disagrees ? 0
                                                                                                      : 128;
      }
  }
  return png_uri(width, height, rgb);
}

Ref<ToneMap> display_tone_map(const Job& job) {
  if (job.tone_map && job.tone_map->clips()) return job.tone_map;
  Ref<ToneMap> map = make<Job>()->tone_map;
  prepare_tree(*map);
  return map;
}

std::string displayed_picture(const Image& xyz, const ToneMap& tone_map) {
  const Image shown = tone_map.apply(xyz);
  std::vector<unsigned char> rgb;
  rgb.reserve(shown.values.size());
  for (const double value : shown.values) rgb.push_back(byte(255 * (value > 0 ? value : 0)));
  return png_uri(shown.width, shown.height, rgb);
}

}  // namespace etendue::verify
