// From what the film collected to a picture, and how exact it is.

#include <cmath>

#include "etendue/film/image_buffer.h"

namespace etendue {

// Exactly those of the table, which is constant in each of its cells.
void ImageBuffer::find_filter_shares() {
  filter_reach_ = int(std::ceil(filter_radius_ - 0.5f));
  const int side = filter_reach_ + 1;
  filter_shares_.assign(size_t(side) * size_t(side), 0);
  const double cell = double(filter_radius_) / table_size;
  // The length of a cell of the table within the pixel `away` pixels from the filter's own, on one side of its centre.
  const auto covered = [&](int i, int away) {
    const auto up_to = [&](double distance) { return std::clamp(distance / cell - i, 0.0, 1.0) * cell; };
    return away == 0 ? 2 * up_to(0.5) : up_to(away + 0.5) - up_to(away - 0.5);
  };
  for (int dy = 0; dy < side; ++dy)
    for (int dx = 0; dx < side; ++dx) {
      double& share = filter_shares_[size_t(dy * side + dx)];
      for (int y = 0; y < table_size; ++y) {
        const double down = covered(y, dy);
        if (down == 0) continue;
        double row = 0;
        for (int x = 0; x < table_size; ++x) row += covered(x, dx) * double(filter_table_[size_t(y * table_size + x)]);
        share += down * row;
      }
    }
}

/// Whether a pixel's filter reaches nothing beside the film.
bool ImageBuffer::within_reach(int x, int y) const {
  const PixelArea film{0, 0, width, height};
  const int r = filter_reach_;
  return x - r >= film.x0 && x + r < film.x1 && y - r >= film.y0 && y + r < film.y1;
}

/// The integral of a pixel's filter over the film [pixel^2]; on request each pixel's share times the samples that belong to it.
/// Around a crop each pixel has as many as this one.
double ImageBuffer::filter_over_film(int x, int y, bool times_samples) const {
  const PixelArea film{0, 0, width, height};
  const int r = filter_reach_;
  double sum = 0;
  for (int j = std::max(y - r, film.y0); j <= std::min(y + r, film.y1 - 1); ++j)
    for (int i = std::max(x - r, film.x0); i <= std::min(x + r, film.x1 - 1); ++i) {
      const double share = filter_shares_[size_t(std::abs(j - y) * (r + 1) + std::abs(i - x))];
      const bool known = area_.contains(i, j);
      sum += times_samples ? share * sums_[4 * (known ? index(i, j) : index(x, y)) + 3] : share;
    }
  return sum;
}

/// The integral of the whole filter [pixel^2].
double ImageBuffer::filter_integral() const {
  const int side = filter_reach_ + 1;
  double sum = 0;
  for (int dy = 0; dy < side; ++dy)
    for (int dx = 0; dx < side; ++dx) sum += (dx ? 2 : 1) * (dy ? 2 : 1) * filter_shares_[size_t(dy * side + dx)];
  return sum;
}

// A pixel estimates the mean of the radiance on the film, weighted by the filter f around it, over the film F: I = int_F f L /
// int_F f. F is that of the whole picture, in a crop as well, since samples are taken around it as far as f reaches. Let F_i
// be the integral of f over pixel i of F.
//   Samples of the camera, n_i of them, are spread evenly over each pixel i:   I ~ sum_k f(x_k) L_k / sum_i n_i F_i.
//   Splats arrive with a density of their own, each already divided by it:     I ~ scale * sum_k f(x_k) s_k / sum_i F_i,
// where the scale is the number of pixels of the whole picture (the film's area) over the number of paths. With samples of both
// kinds the two are parts of one sum, weighted against each other by whoever made them.
// Camera samples are divided by the sum of weights that is to be expected, not by the one that came, sum_k f(x_k): the quotient
// of two sums that vary together is not in expectation the quotient of what is expected of each (decision 013).
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

  const double samples = sums_[3], whole = filter_integral();
  bool even = true;  // as all our renderers leave it
  for (size_t i = 3; i < sums_.size(); i += 4) even &= sums_[i] == samples;
  double* out = image.values.data();
  for (int y = area_.y0; y < area_.y1; ++y)
    for (int x = area_.x0; x < area_.x1; ++x) {
      const size_t pixel = index(x, y);
      const double* sum = &sums_[4 * pixel];
      const bool inside = within_reach(x, y);
      const double norm = inside ? whole : filter_over_film(x, y, false);
      // A box of one pixel gives each sample to its own pixel, with weight 1.
      const double expected = box_ ? sum[3] : even ? samples * norm : filter_over_film(x, y, true);
      const double scale = expected > 0 ? 1 / expected : 0;
      for (size_t c = 0; c < 3; ++c) out[c] = scale * sum[c];
      const double splat = !splats_.empty() && norm > 0 ? splat_scale() / norm : 0;
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
  if (!splats_.empty()) variance += std::pow(splat_scale() / filter_integral(), 2) * splats_[4 * pixel + 3];
  return variance;
}

double ImageBuffer::splat_scale() const { return samples_ > 0 ? double(width) * double(height) / double(samples_) : 0; }

double ImageBuffer::relative_error() const {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  double total = 0, samples = 0;
  const double splat = splats_.empty() ? 0 : splat_scale() / filter_integral();
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
