// From what the film collected to a picture, and how exact it is.

#include <map>
#include <tuple>

#include "etendue/image_buffer.h"

namespace etendue {

/// The integral of the filter [pixel^2] over what lies closer to a pixel's centre than these distances on each side:
/// exactly that of the table, which is constant in each cell.
double ImageBuffer::filter_integral(float left, float right, float up, float down) const {
  const double cell = double(filter_radius_) / table_size;
  std::array<double, table_size> across{}, along{};
  for (int i = 0; i < table_size; ++i) {
    const auto covered = [&](float distance) { return std::clamp(double(distance) / cell - i, 0.0, 1.0); };
    across[size_t(i)] = covered(left) + covered(right);
    along[size_t(i)] = covered(up) + covered(down);
  }
  double sum = 0;
  for (size_t y = 0; y < table_size; ++y) {
    double row = 0;
    for (size_t x = 0; x < table_size; ++x) row += across[x] * double(filter_table_[y * table_size + x]);
    sum += along[y] * row;
  }
  return sum * cell * cell;
}

// A pixel estimates the mean of the radiance on the film, weighted by the filter f around it, over the film F that is
// rendered: I = int_F f L / int_F f.
//   Samples of the camera are spread evenly over F, with L_k known at x_k:   I ~ sum_k f(x_k) L_k / sum_k f(x_k).
//   Splats arrive with a density of their own, each already divided by it:   I ~ scale * sum_k f(x_k) s_k / int_F f,
// where the scale is the number of pixels of the whole picture (the film's area) over the number of paths. With samples of both
// kinds the two are parts of one sum, weighted against each other by whoever made them.
Image ImageBuffer::develop() const {
  std::vector<std::string> channels = {"X", "Y", "Z"};
  enum class Source { mean, hit_mean, first, variance, count };
  struct Layer {
    Source source;
    size_t offset;
  };
  std::vector<Layer> sources;
  const auto add = [&](const char* name, Source source, size_t offset = 0) {
    channels.emplace_back(name);
    sources.push_back({source, offset});
  };
  for (const std::string& layer : layers) {
    if (layer == "albedo")
      add("albedo.R", Source::mean, 0), add("albedo.G", Source::mean, 1), add("albedo.B", Source::mean, 2);
    else if (layer == "normal")
      add("normal.X", Source::mean, 3), add("normal.Y", Source::mean, 4), add("normal.Z", Source::mean, 5);
    else if (layer == "depth")
      add("depth.Z", Source::hit_mean, 6);
    else if (layer == "object")
      add("object.ID", Source::first, 8);
    else if (layer == "variance")
      add("variance.Y", Source::variance);
    else if (layer == "samples")
      add("samples.N", Source::count);
  }
  for (int length = 1; length <= path_lengths; ++length)
    for (const char* part : {".X", ".Y", ".Z"}) channels.push_back("length_" + std::to_string(length) + part);

  Image image(area_.width(), area_.height(), std::move(channels));
  image.metadata["color_space"] = "xyz";
  if (!crop.empty()) {
    image.metadata["crop_x"] = std::to_string(area_.x0);
    image.metadata["crop_y"] = std::to_string(area_.y0);
    image.metadata["full_width"] = std::to_string(width);
    image.metadata["full_height"] = std::to_string(height);
  }
  if (sums_.empty()) return image;

  std::map<std::tuple<float, float, float, float>, double> integrals;  // the border has few different ones
  const auto integral = [&](int x, int y) {
    const auto side = [&](int pixels) { return std::min(float(pixels) + 0.5f, filter_radius_); };
    const std::tuple key(side(x - area_.x0), side(area_.x1 - 1 - x), side(y - area_.y0), side(area_.y1 - 1 - y));
    const auto [found, fresh] = integrals.try_emplace(key, 0.0);
    if (fresh) found->second = std::apply([&](auto... sides) { return filter_integral(sides...); }, key);
    return found->second;
  };

  double* out = image.values.data();
  for (int y = area_.y0; y < area_.y1; ++y)
    for (int x = area_.x0; x < area_.x1; ++x) {
      const size_t pixel = index(x, y);
      const double* sum = &sums_[4 * pixel];
      // Filters with negative lobes can leave a pixel of few samples without weight.
      const double scale = sum[3] > 0 ? 1 / sum[3] : 0;
      for (size_t c = 0; c < 3; ++c) out[c] = scale * sum[c];
      const double norm = splats_.empty() ? 0 : integral(x, y);
      const double splat = norm > 0 ? splat_scale() / norm : 0;
      if (splat > 0)
        for (size_t c = 0; c < 3; ++c) out[c] += splat * splats_[4 * pixel + c];
      out += 3;
      const double* moment = &moments_[3 * pixel];
      for (const Layer& layer : sources) {
        const double* feature = features_.empty() ? nullptr : &features_[feature_values * pixel];
        double value = 0;
        switch (layer.source) {
          case Source::mean: value = feature && feature[9] > 0 ? feature[layer.offset] / feature[9] : 0; break;
          case Source::hit_mean: value = feature && feature[7] > 0 ? feature[layer.offset] / feature[7] : 0; break;
          case Source::first: value = feature ? feature[layer.offset] : 0; break;
          case Source::variance: value = variance_of_pixel(pixel); break;
          case Source::count: value = moment[0]; break;
        }
        *out++ = value;
      }
      for (size_t i = 0; i < 3 * size_t(path_lengths); ++i) {
        const size_t at = 3 * size_t(path_lengths) * pixel + i;
        *out++ = scale * lengths_[at] + (splat > 0 ? splat * length_splats_[at] : 0);
      }
    }
  return image;
}

/// From count, sum and sum of squares of n independent samples: (mean of squares - squared mean) / (n - 1). For
/// low-discrepancy samples, which spread better than independent ones, it is too high. Unknown, so infinite, for n < 2.
double ImageBuffer::variance_of_mean(const double* moment) {
  const double n = moment[0];
  if (n < 2) return std::numeric_limits<double>::infinity();
  const double mean = moment[1] / n;
  return std::max(0.0, moment[2] / n - mean * mean) / (n - 1);
}

/// Splats add to a pixel's variance as arrivals that are independent of one another: scale^2 * sum of squares.
double ImageBuffer::variance_of_pixel(size_t pixel) const {
  double variance = variance_of_mean(&moments_[3 * pixel]);
  if (!splats_.empty()) variance += std::pow(splat_scale() / splat_norm(), 2) * splats_[4 * pixel + 3];
  return variance;
}

double ImageBuffer::splat_scale() const { return samples_ > 0 ? double(width) * double(height) / double(samples_) : 0; }

double ImageBuffer::splat_norm() const {
  return filter_integral(filter_radius_, filter_radius_, filter_radius_, filter_radius_);
}

double ImageBuffer::relative_error() const {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  double total = 0, samples = 0;
  const double splat = splats_.empty() ? 0 : splat_scale() / splat_norm();
  const auto mean = [&](size_t pixel) {
    return moments_[3 * pixel + 1] / moments_[3 * pixel] + (splat > 0 ? splat * splats_[4 * pixel + 1] : 0);
  };
  const size_t pixels = moments_.size() / 3;
  for (size_t i = 0; i < pixels; ++i) {
    if (moments_[3 * i] < 2) return unknown;
    samples += 1;
    total += mean(i);
  }
  // A picture still black may only have found no light yet.
  if (samples == 0 || total <= 0) return unknown;
  const double floor = 1e-3 * total / samples;
  double sum = 0;
  for (size_t i = 0; i < pixels; ++i) sum += std::sqrt(variance_of_pixel(i)) / (mean(i) + floor);
  return sum / samples;
}

}  // namespace etendue
