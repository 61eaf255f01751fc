#include <fmt/format.h>

#include "etendue/film/image_tools.h"

namespace etendue {
namespace {

void check_sizes(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height)
    throw Error(fmt::format("the pictures differ in size: {} x {} and {} x {} pixels", a.width, a.height, b.width, b.height));
}

size_t position(const Image& image, const std::string& channel) {
  return size_t(std::find(image.channels.begin(), image.channels.end(), channel) - image.channels.begin());
}

double ratio(double a, double b) {
  if (a == b) return 1;
  return b != 0 ? a / b : std::copysign(std::numeric_limits<double>::infinity(), a);
}

}  // namespace

Comparison compare(const Image& given_a, const Image& given_b, const std::string& color_space) {
  check_sizes(given_a, given_b);
  const Image a = convert_color_space(given_a, color_space), b = convert_color_space(given_b, color_space);
  std::vector<std::string> names = {"R", "G", "B"};
  if (position(a, "X") < a.channels.size()) names = {"X", "Y", "Z"};

  // Calls f(x, y, channel, a, b) for each value that is finite in both.
  Comparison result;
  const auto each = [&](auto&& f) {
    size_t left_out = 0;
    for (size_t c = 0; c < 3; ++c) {
      const size_t in_a = position(a, names[c]), in_b = position(b, names[c]);
      for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
          const double va = a.at(x, y, in_a), vb = b.at(x, y, in_b);
          if (std::isfinite(va) && std::isfinite(vb))
            f(x, y, c, va, vb);
          else
            ++left_out;
        }
    }
    result.not_finite = left_out;
  };

  std::array<double, 3> sum_a{}, sum_b{}, squares{}, count{};
  result.channels.resize(3);
  each([&](int x, int y, size_t c, double va, double vb) {
    const double difference = std::abs(va - vb);
    sum_a[c] += va;
    sum_b[c] += vb;
    squares[c] += difference * difference;
    count[c] += 1;
    double& largest = result.channels[c].maximum_difference;
    largest = std::max(largest, difference);
    if (difference > result.maximum_difference) {
      result.maximum_difference = difference;
      result.maximum_x = x;
      result.maximum_y = y;
      result.maximum_channel = names[c];
    }
    const double size = std::abs(va) + std::abs(vb);
    if (size > 0) result.symmetric_error += 2 * difference / size;
  });
  const double n = count[0] + count[1] + count[2];
  for (size_t c = 0; c < 3; ++c) {
    ChannelComparison& channel = result.channels[c];
    channel.name = names[c];
    if (count[c] == 0) continue;
    channel.mean_a = sum_a[c] / count[c];
    channel.mean_b = sum_b[c] / count[c];
    channel.ratio = ratio(channel.mean_a, channel.mean_b);
    channel.root_mean_square_error = std::sqrt(squares[c] / count[c]);
  }
  if (n == 0) {  // nothing could be compared, which must not look like equality
    result.root_mean_square_error = result.relative_mean_square_error = result.symmetric_error = result.maximum_difference =
        std::numeric_limits<double>::quiet_NaN();
    return result;
  }
  result.root_mean_square_error = std::sqrt((squares[0] + squares[1] + squares[2]) / n);
  result.symmetric_error /= n;

  const double mean = (sum_b[0] + sum_b[1] + sum_b[2]) / n, floor = 1e-2 * mean * mean;
  double sum = 0;
  each([&](int, int, size_t, double va, double vb) {
    const double square = (va - vb) * (va - vb);
    if (square > 0) sum += square / (vb * vb + floor);
  });
  result.relative_mean_square_error = sum / n;
  return result;
}

std::vector<TileRatio> tile_ratios(const Image& given_a, const Image& given_b, int size) {
  check_sizes(given_a, given_b);
  if (size < 1) throw Error("tiles must be at least one pixel wide");
  const Image a = convert_color_space(given_a, "xyz"), b = convert_color_space(given_b, "xyz");
  const size_t in_a = position(a, "Y"), in_b = position(b, "Y");
  std::vector<TileRatio> tiles;
  for (int y0 = 0; y0 < a.height; y0 += size)
    for (int x0 = 0; x0 < a.width; x0 += size) {
      TileRatio tile;
      tile.area = {x0, y0, std::min(x0 + size, a.width), std::min(y0 + size, a.height)};
      double count = 0;
      for (int y = tile.area.y0; y < tile.area.y1; ++y)
        for (int x = tile.area.x0; x < tile.area.x1; ++x) {
          const double va = a.at(x, y, in_a), vb = b.at(x, y, in_b);
          if (!std::isfinite(va) || !std::isfinite(vb)) continue;
          tile.mean_a += va;
          tile.mean_b += vb;
          count += 1;
        }
      if (count > 0) {
        tile.mean_a /= count;
        tile.mean_b /= count;
      }
      tile.ratio = ratio(tile.mean_a, tile.mean_b);
      tiles.push_back(tile);
    }
  return tiles;
}

}  // namespace etendue
