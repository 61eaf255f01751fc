#include "reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "etendue/film/image_tools.h"
#include "files/input_files.h"

namespace etendue::comparing {

AgreedMean::AgreedMean(std::vector<const RunSums*> sums) : sums_(std::move(sums)), weights_(sums_.size()) {
  double total = 0;
  for (size_t s = 0; s < sums_.size(); ++s) {
    if (!sums_[s]) continue;
    std::vector<double> mean(sums_[s]->size());
    for (size_t i = 0; i < mean.size(); ++i) mean[i] = sums_[s]->mean(i);
    const double variance = sums_[s]->relative_variance(relative_weights(mean)) / sums_[s]->runs();
    weights_[s] = 1 / std::max(variance, 1e-12);  // a source without variance is as accurate as float arithmetic
    total += weights_[s];
  }
  for (double& weight : weights_) weight /= total;
}

size_t AgreedMean::members() const {
  return size_t(std::ranges::count_if(sums_, [](const RunSums* s) { return s != nullptr; }));
}

Reference AgreedMean::mean(std::optional<size_t> left_out, std::optional<size_t> of_run, std::span<const float> run) const {
  Reference r;
  const double left = left_out ? weights_[*left_out] : 0;
  for (size_t s = 0; s < sums_.size(); ++s) {
    if (!sums_[s] || left_out == s) continue;
    const RunSums& sums = *sums_[s];
    r.mean.resize(sums.size());
    r.variance.resize(sums.size());
    const double w = weights_[s] / (1 - left), runs = of_run == s ? sums.runs() - 1 : sums.runs();
    for (size_t i = 0; i < sums.size(); ++i) {
      r.mean[i] += w * (of_run == s ? sums.mean_without(i, run[i]) : sums.mean(i));
      r.variance[i] += w * w * sums.variance(i) / runs;
    }
  }
  return r;
}

Reference reference_from(const Image& picture, const std::string& what, int width, int height) {
  const Image image = convert_color_space(picture, "xyz");
  if (image.width != width || image.height != height)
    throw Error(
        fmt::format("{} has {} x {} pixels, the scene's picture {} x {}", what, image.width, image.height, width, height));
  Reference r;
  size_t not_finite = 0, channel[3] = {};
  for (size_t c = 0; c < 3; ++c)
    channel[c] = size_t(std::ranges::find(image.channels, std::string(1, char('X' + c))) - image.channels.begin());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (size_t c = 0; c < 3; ++c) {
        r.mean.push_back(image.at(x, y, channel[c]));
        not_finite += !std::isfinite(r.mean.back());
      }
  if (not_finite > 0) throw Error(fmt::format("{} values of {} are not finite", not_finite, what));
  return r;
}

Reference read_reference(const std::string& path, int width, int height) {
  const Location at{intern("--reference"), 0, 0};
  note_input(path);
  std::string ending = std::filesystem::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  for (const char* display : {".png", ".jpg", ".jpeg", ".bmp", ".gif", ".webp", ".tga", ".ppm"})
    if (ending == display)
      throw Error(fmt::format("'{}' is a picture for display: its values are clipped and rounded; give one of linear values "
                              "(.exr, .npy) or a checkpoint",
                              path),
                  at);
  try {
    Image image;
    try {
      image = read_image(path);
    } catch (const Error& no_image) {
      try {
        image = picture_of(read_checkpoint(path)).picture;
      } catch (const Error& no_checkpoint) {
        throw Error(fmt::format("{}; and it is not a checkpoint: {}", no_image.what(), no_checkpoint.what()));
      }
    }
    return reference_from(image, fmt::format("the reference '{}'", path), width, height);
  } catch (const Error& e) {
    throw Error(e.what(), at);
  }
}

}  // namespace etendue::comparing
