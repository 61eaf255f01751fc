#include "maps.h"

#include <algorithm>
#include <cmath>

#include "check/verify/report_pictures.h"

namespace etendue::comparing {
namespace {

size_t pixel_count(const SceneResult& scene) { return size_t(scene.width) * size_t(scene.height); }

/// The quantile of the numbers at the fraction `part`.
double quantile(std::vector<double> numbers, double part) {
  if (numbers.empty()) return 0;
  const auto at = numbers.begin() + std::ptrdiff_t(part * double(numbers.size() - 1));
  std::nth_element(numbers.begin(), at, numbers.end());
  return *at;
}

/// Means over 3 x 3 pixels, as the variance of a few runs is noisy itself.
std::vector<double> smoothed(const std::vector<double>& from, int width, int height) {
  std::vector<double> to(from.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0, count = 0;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
          sum += from[size_t(v) * size_t(width) + size_t(u)];
          count += 1;
        }
      to[size_t(y) * size_t(width) + size_t(x)] = sum / count;
    }
  return to;
}

/// The constant e of relative errors, as in relative_weights, for Y.
double floor_of(const SceneImages& images) {
  double sum = 0;
  for (size_t i = 1; i < images.reference.size(); i += 3) sum += images.reference[i];
  const double mean = sum / double(images.reference.size() / 3);
  return 1e-2 * mean * mean;
}

}  // namespace

Shown Shown::part(const PixelArea& area) const {
  Shown out{area.width(), area.height(), {}};
  for (int y = area.y0; y < area.y1; ++y)
    for (int x = area.x0; x < area.x1; ++x)
      for (size_t c = 0; c < 3; ++c) out.rgb.push_back(rgb[3 * (size_t(y) * size_t(width) + size_t(x)) + c]);
  return out;
}

std::string Shown::uri() const { return verify::png_uri(width, height, rgb); }

std::vector<Shown> show_alike(const ToneMap& tone_map, const std::vector<std::vector<double>>& pictures, int width,
                              int height) {
  std::vector<Shown> all;
  const auto show = [&](const std::vector<std::vector<double>>& together) {
    Image image(width, height * int(together.size()), {"X", "Y", "Z"});
    image.metadata["color_space"] = "xyz";
    image.values.clear();
    for (const auto& picture : together) image.values.insert(image.values.end(), picture.begin(), picture.end());
    const Image shown = tone_map.apply(image);
    const size_t each = 3 * size_t(width) * size_t(height);
    for (size_t p = 0; p < together.size(); ++p) {
      Shown one{width, height, {}};
      for (size_t i = 0; i < each; ++i) {
        const double v = shown.values[p * each + i];
        one.rgb.push_back(static_cast<unsigned char>(255 * std::clamp(v > 0 ? v : 0, 0.0, 1.0) + 0.5));
      }
      all.push_back(std::move(one));
    }
  };
  if (!tone_map.local())
    show(pictures);
  else
    for (const auto& picture : pictures) show({picture});
  return all;
}

std::vector<PixelArea> most_different(const SceneImages& images, const SceneResult& scene, size_t count) {
  const size_t pixels = pixel_count(scene);
  const double floor = floor_of(images);
  // The score is the range of the variants' relative errors, limited so that a single firefly does not dominate.
  std::vector<double> score(pixels);
  for (size_t i = 0; i < pixels; ++i) {
    const double r = images.reference[3 * i + 1], weight = r != 0 || floor > 0 ? 1 / (r * r + floor) : 0;
    double least = HUGE_VAL, most = 0;
    for (size_t v = 0; v < images.variants.size(); ++v) {
      const double d = images.variants[v].mean[3 * i + 1] - r;
      const double error = weight * (images.variants[v].variance[i] + d * d);
      least = std::min(least, error);
      most = std::max(most, error);
    }
    score[i] = images.variants.size() > 1 ? most - least : most;
  }
  const double high = quantile(score, 0.99);
  for (double& s : score) s = std::min(s, high);

  const int side = std::clamp(std::min(scene.width, scene.height) / 5, 1, 64), width = scene.width;
  std::vector<double> sums((size_t(width) + 1) * (size_t(scene.height) + 1));  // summed-area table
  const auto at = [&](int x, int y) -> double& { return sums[size_t(y) * (size_t(width) + 1) + size_t(x)]; };
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < width; ++x)
      at(x + 1, y + 1) = score[size_t(y) * size_t(width) + size_t(x)] + at(x, y + 1) + at(x + 1, y) - at(x, y);
  std::vector<PixelArea> list;
  while (list.size() < count) {
    double best = -1;
    PixelArea found;
    for (int y = 0; y + side <= scene.height; ++y)
      for (int x = 0; x + side <= width; ++x) {
        const bool overlaps = std::ranges::any_of(
            list, [&](const PixelArea& a) { return x < a.x1 && x + side > a.x0 && y < a.y1 && y + side > a.y0; });
        const double sum = at(x + side, y + side) - at(x, y + side) - at(x + side, y) + at(x, y);
        if (!overlaps && sum > best) best = sum, found = {x, y, x + side, y + side};
      }
    if (best < 0) break;
    list.push_back(found);
  }
  return list;
}

DifferenceMaps difference_maps(const SceneImages& images, const SceneResult& scene) {
  const size_t pixels = pixel_count(scene);
  const double floor = floor_of(images);
  std::vector<std::vector<double>> differences;
  std::vector<double> sizes;
  for (const SceneImages::One& one : images.variants) {
    std::vector<double> d(pixels);
    for (size_t i = 0; i < pixels; ++i) {
      const double r = images.reference[3 * i + 1], scale = std::sqrt(r * r + floor);
      d[i] = scale > 0 ? (double(one.picture[3 * i + 1]) - r) / scale : 0;
      sizes.push_back(std::abs(d[i]));
    }
    differences.push_back(std::move(d));
  }
  DifferenceMaps maps;
  maps.full = quantile(std::move(sizes), 0.98);
  for (const auto& d : differences) {
    Shown map{scene.width, scene.height, {}};
    for (const double x : d) {
      const auto color = verify::difference_color(maps.full > 0 ? verify::z_of_full_color * x / maps.full : 0);
      map.rgb.insert(map.rgb.end(), color.begin(), color.end());
    }
    maps.maps.push_back(std::move(map));
  }
  return maps;
}

std::array<unsigned char, 3> scale_color(double t) {
  // Even steps of lightness from dark violet by green to yellow, as of viridis (Smith & van der Walt 2015).
  constexpr double stops[5][3] = {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
  const double at = std::clamp(t, 0.0, 1.0) * 4;
  const auto i = std::min<size_t>(size_t(at), 3);
  std::array<unsigned char, 3> color{};
  for (size_t c = 0; c < 3; ++c)
    color[c] = static_cast<unsigned char>(stops[i][c] + (at - double(i)) * (stops[i + 1][c] - stops[i][c]) + 0.5);
  return color;
}

VarianceMaps variance_maps(const SceneImages& images, const SceneResult& scene) {
  std::vector<std::vector<double>> all;
  std::vector<double> positive;
  for (size_t v = 0; v < images.variants.size(); ++v) {
    all.push_back(smoothed(images.variants[v].variance, scene.width, scene.height));
    for (double& x : all.back()) {
      x *= scene.variants[v].seconds;
      if (x > 0) positive.push_back(x);
    }
  }
  VarianceMaps maps;
  maps.high = quantile(positive, 0.995);
  maps.low = std::max(quantile(std::move(positive), 0.005), 1e-6 * maps.high);
  for (const auto& variance : all) {
    Shown map{scene.width, scene.height, {}};
    for (const double x : variance) {
      const bool known = x > 0 && maps.high > maps.low;
      const auto color = scale_color(known ? std::log(x / maps.low) / std::log(maps.high / maps.low) : 0);
      map.rgb.insert(map.rgb.end(), color.begin(), color.end());
    }
    maps.maps.push_back(std::move(map));
  }
  return maps;
}

}  // namespace etendue::comparing
