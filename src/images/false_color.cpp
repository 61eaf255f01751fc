#include "false_color.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "bitmap_text.h"
#include "etendue/core/error.h"

namespace etendue {
namespace {

/// 33 colours at equal distances, 0xRRGGBB in sRGB, with straight lines between. viridis and inferno: S. van der Walt & N.
/// Smith 2015, as in matplotlib (CC0); turbo: A. Mikhailov 2019. The lines deviate from the published 256 colours by less than
/// 2 / 255.
struct ColorMap {
  const char* name;
  std::array<std::uint32_t, 33> colors;
};

constexpr std::array<ColorMap, 3> maps = {{
    {"viridis", {0x440154, 0x470d60, 0x48186a, 0x482374, 0x472d7b, 0x453681, 0x424086, 0x3f4989, 0x3b528b, 0x375a8d, 0x33638d,
                 0x2f6a8e, 0x2c728e, 0x297a8e, 0x26818e, 0x23898e, 0x21908c, 0x1f988b, 0x1f9f88, 0x21a685, 0x28ae80, 0x31b57b,
                 0x3ebc74, 0x4cc26c, 0x5dc963, 0x6ece58, 0x82d34c, 0x96d83f, 0xabdc32, 0xc0df24, 0xd5e21a, 0xeae51a, 0xfde725}},
    {"inferno", {0x000004, 0x040312, 0x0b0724, 0x150b37, 0x210c4a, 0x2e0a5a, 0x3c0965, 0x4a0c6b, 0x57106d, 0x63146e, 0x70196e,
                 0x7d1e6d, 0x89226a, 0x962766, 0xa32b61, 0xaf315c, 0xbb3755, 0xc63e4d, 0xd14644, 0xdb4f3b, 0xe35932, 0xeb6528,
                 0xf1711e, 0xf67f14, 0xf98d0a, 0xfb9c06, 0xfcab0f, 0xfbba1f, 0xf9ca32, 0xf5d949, 0xf2e865, 0xf3f586, 0xfcffa4}},
    {"turbo", {0x30123b, 0x392a73, 0x4040a1, 0x4456c7, 0x466be3, 0x467ff6, 0x4293ff, 0x37a7fa, 0x29bbec, 0x1dcdd8, 0x18dcc3,
               0x1ee8b0, 0x31f299, 0x4cf97e, 0x6bfd64, 0x8aff4d, 0xa3fd3c, 0xb8f735, 0xcced34, 0xdee037, 0xedd03a, 0xf8c03a,
               0xfdae35, 0xfe982c, 0xfb8022, 0xf56817, 0xec520f, 0xe04009, 0xd23105, 0xc02302, 0xac1701, 0x950d01, 0x7a0403}},
}};

double component(std::uint32_t color, int shift) { return double(color >> shift & 255) / 255; }

/// A number as short as it can be: 0.05, 200, 10k, 1e+06.
std::string number_text(double v) {
  const std::string plain = fmt::format("{:.6g}", v);
  return std::abs(v) >= 1e4 && std::abs(v) < 1e6 ? fmt::format("{:.6g}k", v / 1000) : plain;
}

/// A canvas of display colours.
struct Canvas {
  Image image;
  void put(int x, int y, const DisplayColor& c) {
    if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
    image.at(x, y, 0) = c.r, image.at(x, y, 1) = c.g, image.at(x, y, 2) = c.b;
  }
  void text(const std::string& t, int left, int top, int scale) {
    for (int y = 0; y < character_height * scale; ++y)
      for (int x = 0; x < character_width * scale * int(t.size()); ++x)
        if (has_ink(t, x / scale, y / scale)) put(left + x, top + y, {1, 1, 1});
  }
};

}  // namespace

std::vector<std::string> color_map_names() {
  std::vector<std::string> names;
  for (const ColorMap& map : maps) names.emplace_back(map.name);
  names.emplace_back("grey");
  return names;
}

DisplayColor color_of(const std::string& color_map, double position) {
  const double p = std::clamp(position, 0.0, 1.0);
  if (color_map == "grey") return {p, p, p};
  const auto* map = std::ranges::find(maps, color_map, &ColorMap::name);
  if (map == maps.end()) throw Error("there is no colour map '" + color_map + "'");
  const size_t last = map->colors.size() - 1, i = std::min(size_t(p * double(last)), last - 1);
  const double t = p * double(last) - double(i);
  const auto mixed = [&](int shift) {
    return (1 - t) * component(map->colors[i], shift) + t * component(map->colors[i + 1], shift);
  };
  return {mixed(16), mixed(8), mixed(0)};
}

double ColorScale::position(double value) const {
  if (!logarithmic) return (value - low) / (high - low);
  return value > 0 ? std::log(value / low) / std::log(high / low) : -1;
}

std::vector<double> scale_marks(const ColorScale& scale, int most) {
  const double slack = 1e-9 * (scale.high - scale.low);
  if (!scale.logarithmic) {
    // The smallest step of 1, 2 or 5 times a power of ten that gives few enough marks.
    for (int exponent = int(std::floor(std::log10((scale.high - scale.low) / most))) - 1;; ++exponent)
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double step = digit * std::pow(10, exponent);
        const double first = std::ceil((scale.low - slack) / step), last = std::floor((scale.high + slack) / step);
        if (last - first + 1 > most) continue;
        std::vector<double> marks;
        for (double k = first; k <= last; ++k) marks.push_back(k * step + 0.0);  // not -0
        return marks;
      }
  }
  const int first = int(std::floor(std::log10(scale.low))), last = int(std::ceil(std::log10(scale.high)));
  const auto marks_of = [&](const std::vector<double>& digits, int stride) {
    std::vector<double> marks;
    for (int e = first; e <= last; ++e)
      for (const double digit : digits) {
        const double value = digit * std::pow(10, e);
        if (e % stride == 0 && value >= scale.low * (1 - 1e-9) && value <= scale.high * (1 + 1e-9)) marks.push_back(value);
      }
    return marks;
  };
  for (const std::vector<double>& digits : {std::vector<double>{1, 2, 5}, {1, 3}, {1}})
    if (const std::vector<double> marks = marks_of(digits, 1); int(marks.size()) <= most) return marks;
  for (int stride = 2;; ++stride)
    if (const std::vector<double> marks = marks_of({1}, stride); int(marks.size()) <= most) return marks;
}

ColorScale decades_of(const std::vector<double>& values, int decades) {
  std::vector<double> positive;
  for (const double v : values)
    if (v > 0 && std::isfinite(v)) positive.push_back(v);
  if (positive.empty()) throw Error("the picture is black: it has no range that could be shown");
  std::ranges::sort(positive);
  const size_t rare = positive.size() / 1000;
  const double top = std::ceil(std::log10(positive[positive.size() - 1 - rare]) - 1e-9);
  const double bottom = std::max(std::floor(std::log10(positive[rare]) + 1e-9), top - decades);
  ColorScale scale;
  scale.high = std::pow(10, top);
  scale.low = std::pow(10, std::min(bottom, top - 1));
  return scale;
}

Image false_color(const std::vector<double>& values, int width, int height, const ColorScale& scale) {
  const int size = std::max(1, height / 350);  // of a text's pixel
  const int line = (character_height + 5) * size, margin = 8 * size, bar = 16 * size;
  // The legend: the unit above a bar with marks. A picture that is lower than a legend's least height is continued in black.
  const int legend_height = std::max(height, 8 * line), top = 2 * line, bottom = legend_height - line;
  const std::vector<double> marks = scale_marks(scale, std::max((bottom - top) / (2 * line), 2));
  size_t longest = scale.unit.size();
  for (const double mark : marks) longest = std::max(longest, number_text(mark).size() + 4);
  const int legend_width = 2 * margin + std::max(bar, 0) + character_width * size * int(longest);
  Canvas canvas{Image(width + legend_width, legend_height, {"R", "G", "B"})};
  canvas.image.metadata = {{"color_space", "srgb"}, {"transfer", "srgb"}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double v = values[size_t(y) * size_t(width) + size_t(x)];
      canvas.put(x, y, std::isfinite(v) ? color_of(scale.color_map, scale.position(v)) : DisplayColor{1, 0, 1});
    }
  const int left = width + margin;
  canvas.text(scale.unit, left, line / 2, size);
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x < left + bar; ++x)
      canvas.put(x, y, color_of(scale.color_map, double(bottom - y) / double(bottom - top)));
  for (const double mark : marks) {
    const int y = bottom - int(std::lround(std::clamp(scale.position(mark), 0.0, 1.0) * (bottom - top)));
    for (int x = 0; x < 4 * size; ++x)
      for (int thick = 0; thick < size; ++thick) canvas.put(left + bar + x, y + thick, {1, 1, 1});
    canvas.text(number_text(mark), left + bar + 6 * size, y - character_height * size / 2, size);
  }
  return canvas.image;
}

}  // namespace etendue
