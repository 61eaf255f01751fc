// Develops the collected sums to a picture, and estimates its error.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "film_values.h"

namespace etendue {
namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

/// A channel besides the light.
struct Layer {
  enum class Source { variance, count } source;
};

std::vector<Layer> add_layers(const PictureFormat& format, std::vector<std::string>& channels) {
  using enum Layer::Source;
  std::vector<Layer> layers;
  const auto add = [&](const char* name, Layer::Source source) {
    channels.emplace_back(name);
    layers.push_back({source});
  };
  for (const std::string& layer : format.layers) {
    if (layer == "variance")
      add("variance.Y", variance);
    else if (layer == "samples")
      add("samples.N", count);
  }
  for (int length = 1; length <= format.path_lengths; ++length)
    for (const char* part : {".X", ".Y", ".Z"}) channels.push_back("length_" + std::to_string(length) + part);
  for (const std::string& group : format.light_groups)
    for (const char* part : {".X", ".Y", ".Z"}) channels.push_back(PictureFormat::light_prefix + group + part);
  for (const PictureFormat::PathLayer& layer : format.path_layers)
    for (const char* part : {".X", ".Y", ".Z"}) channels.push_back(PictureFormat::path_prefix + layer.name + part);
  if (format.stokes)
    for (const char* name : {"S1", "S2", "S3"})
      for (const char* part : {".X", ".Y", ".Z"}) channels.push_back(std::string(name) + part);
  if (format.bands) channels.insert(channels.end(), format.bands->channels().begin(), format.bands->channels().end());
  if (format.stokes) channels.insert(channels.end(), {"polarization.linear", "polarization.circular", "polarization.angle"});
  return layers;
}

/// The state of polarization, of a Stokes vector of luminances: the degree of linear polarization, that of circular
/// polarization (right positive), and the angle of linear polarization from horizontal, counter-clockwise in the picture
/// [degrees, 0 to 180).
std::array<double, 3> polarization_state(double s0, double s1, double s2, double s3) {
  if (!(s0 > 0)) return {};
  double angle = std::atan2(s2, s1) * 90 / double(pi);
  if (angle < 0) angle += 180;
  return {std::hypot(s1, s2) / s0, s3 / s0, angle < 180 ? angle : 0};
}

Image blank(const PictureFormat& format, std::vector<std::string> channels) {
  Image image(format.area.width(), format.area.height(), std::move(channels));
  image.metadata["color_space"] = "xyz";
  if (format.bands && !format.bands->edges().empty())
    image.metadata[band_edges_key] = fmt::format("{}", fmt::join(format.bands->edges(), " "));
  if (format.cropped) {
    image.metadata["crop_x"] = std::to_string(format.area.x0);
    image.metadata["crop_y"] = std::to_string(format.area.y0);
    image.metadata["full_width"] = std::to_string(format.width);
    image.metadata["full_height"] = std::to_string(format.height);
  }
  return image;
}

}  // namespace

bool FilmSnapshot::Values::even() const {
  for (size_t i = 0; i < counts.samples.size(); ++i)
    if (weight(i) != weight(0)) return false;
  return true;
}

// A pixel estimates the mean of the radiance on the film, weighted by the filter f around it, over the film F: I = int_F f L /
// int_F f. F is that of the whole picture, for a crop as well, since samples are taken around the crop as far as f reaches. Let
// F_i be the integral of f over pixel i of F.
//   Camera samples, n_i of them, are spread evenly over each pixel i:        I ~ sum_k f(x_k) L_k / sum_i n_i F_i.
//   Splats s_k have a pdf of their own, by which each is already divided:    I ~ scale * sum_k f(x_k) s_k / sum_i F_i,
// where the scale is the number of pixels of the whole picture (the film's area) over the number of paths. If a renderer has
// samples of both kinds, its MIS weights make the two estimates parts of one sum. Camera samples are divided by the expected
// sum of weights, not by the actual one, sum_k f(x_k): the expected value of a quotient of two correlated sums is not the
// quotient of their expected values (decision 013).
FilmSnapshot::Values::Scales FilmSnapshot::Values::scales(int x, int y, bool even) const {
  Scales s;
  s.filter = format->over_film(x, y);
  const size_t pixel = format->index(x, y);
  // With a box filter of one pixel each sample counts for its own pixel only, with weight 1.
  const double expected = format->box ? weight(pixel)
                          : even      ? weight(pixel) * s.filter.filter
                                      : format->expected(x, y, [&](size_t i) { return weight(i); });
  if (expected > 0) s.light = 1 / expected;
  const double splat_scale = counts.paths > 0 ? double(format->width) * double(format->height) / double(counts.paths) : 0;
  if (!lists[splat_list].empty() && s.filter.filter > 0) s.splat = splat_scale / s.filter.filter;
  return s;
}

Image FilmSnapshot::develop() const {
  const Values& v = *values_;
  const PictureFormat& format = *v.format;
  std::vector<std::string> channels = {"X", "Y", "Z"};
  const std::vector<Layer> layers = add_layers(format, channels);
  Image image = blank(format, std::move(channels));
  if (v.counts.samples.empty()) return image;

  const bool even = v.even();
  const auto &light = v.lists[light_list], &splats = v.lists[splat_list], &parts = v.lists[part_list],
             &part_splats = v.lists[part_splat_list];
  const size_t stride = list_stride(part_list, format),
               all_parts = 3 * format.parts() + (format.bands ? format.bands->count() : 0);
  double* out = image.values.data();
  for (int y = format.area.y0; y < format.area.y1; ++y)
    for (int x = format.area.x0; x < format.area.x1; ++x) {
      const size_t pixel = format.index(x, y);
      const Values::Scales scales = v.scales(x, y, even);
      const auto sum = [&](const std::vector<double>& camera, const std::vector<double>& splatted, size_t at) {
        return (camera.empty() ? 0 : scales.light * camera[at]) + (splatted.empty() ? 0 : scales.splat * splatted[at]);
      };
      for (size_t c = 0; c < 3; ++c) *out++ = sum(light, splats, 4 * pixel + c);
      for (const Layer& layer : layers)
        *out++ = layer.source == Layer::Source::variance ? v.variance(pixel, scales) : v.counts.samples[pixel];
      for (size_t i = 0; i < all_parts; ++i) *out++ = sum(parts, part_splats, stride * pixel + i);
      if (format.stokes) {
        const auto luminance = [&](size_t i) {
          return sum(parts, part_splats, stride * pixel + 3 * (format.first_stokes() + i) + 1);
        };
        for (const double part :
             polarization_state(sum(light, splats, 4 * pixel + 1), luminance(0), luminance(1), luminance(2)))
          *out++ = part;
      }
    }
  return image;
}

// ---- error estimation ------------------------------------------------------------------------------------------------------

double FilmSnapshot::Values::luminance(size_t pixel, const Scales& scales) const {
  const auto& light = lists[light_list];
  const auto& splats = lists[splat_list];
  return (light.empty() ? 0 : scales.light * light[4 * pixel + 1]) +
         (splats.empty() ? 0 : scales.splat * splats[4 * pixel + 1]);
}

double FilmSnapshot::Values::variance(size_t pixel, const Scales& scales) const {
  if (estimator == Estimator::correlated) return variance_of_steps(pixel, scales);
  return variance_of_samples(pixel, scales) + variance_of_splats(pixel, scales);
}

// For n samples L_k per pixel, independent and with the filter weights f_k, the variance of sum f_k L_k is the spread of the
// values around the mean m in the pixel's neighbourhood, sum f_k^2 (L_k - m)^2, in expectation
//   sum (f_k L_k)^2 - n m^2 int f^2   with   m = sum f_k L_k / (n int f).
// The estimated m varies itself, which makes the result too small by the factor 1 - noise / n with noise = int f^2 / (int f)^2;
// for a box of one pixel that is the usual (n - 1) / n. Film points are assumed to be evenly spread: the variation of the f_k
// that independent film points would have does not count as noise, but edges within the filter's radius do.
double FilmSnapshot::Values::variance_of_samples(size_t pixel, const Scales& scales) const {
  const double n = weight(pixel), noise = scales.filter.noise();
  if (counts.samples[pixel] < 2 || !(n > noise)) return unknown;
  if (lists[light_list].empty()) return 0;
  const double* sum = &lists[light_list][4 * pixel];
  return scales.light * scales.light * std::max(0.0, sum[3] - sum[1] * sum[1] * noise / n) / (1 - noise / n);
}

// Each of N samples, wherever its own pixel is, contributes s_k to this one, mostly zero; the s_k are independent.
double FilmSnapshot::Values::variance_of_splats(size_t pixel, const Scales& scales) const {
  if (lists[splat_list].empty()) return 0;
  const auto n = double(counts.paths);
  if (n < 2) return unknown;
  const double* sum = &lists[splat_list][4 * pixel];
  return scales.splat * scales.splat * std::max(0.0, sum[3] - sum[1] * sum[1] / n) * n / (n - 1);
}

// For steps of n_b samples with means v_b, the variance of one sample is estimated as sum n_b (v_b - mean)^2 / (steps - 1).
double FilmSnapshot::Values::variance_of_steps(size_t pixel, const Scales& scales) const {
  constexpr std::uint64_t enough = 8;
  const auto n = double(counts.paths);
  if (steps < enough || lists[batch_list].empty()) return unknown;
  const double mean = luminance(pixel, scales);
  return std::max(0.0, lists[batch_list][pixel] - n * mean * mean) / double(steps - 1) / n;
}

double FilmSnapshot::relative_error() const {
  const Values& v = *values_;
  const PictureFormat& format = *v.format;
  if (v.counts.samples.empty()) return unknown;
  const bool even = v.even();
  std::vector<double> means, errors;
  double total = 0;
  for (int y = format.area.y0; y < format.area.y1; ++y)
    for (int x = format.area.x0; x < format.area.x1; ++x) {
      const size_t pixel = format.index(x, y);
      const Values::Scales scales = v.scales(x, y, even);
      means.push_back(std::abs(v.luminance(pixel, scales)));
      errors.push_back(std::sqrt(v.variance(pixel, scales)));
      total += means.back();
    }
  // In a picture that is still black, no light may have been found yet.
  if (!(total > 0)) return unknown;
  const double pixels = double(means.size()), floor = 1e-3 * total / pixels;
  double sum = 0;
  for (size_t i = 0; i < means.size(); ++i) sum += errors[i] / (means[i] + floor);
  return sum / pixels;
}

std::uint64_t FilmSnapshot::samples() const { return values_->counts.paths; }
std::uint64_t FilmSnapshot::bad_samples() const { return values_->counts.bad_count; }

}  // namespace etendue
