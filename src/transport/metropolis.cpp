#include "etendue/transport/metropolis.h"

#include <algorithm>
#include <cmath>

namespace etendue {

FilmWeights::FilmWeights(std::span<const double> light) : weights_(cells) {
  double all = 0;
  for (const double l : light) all += l;
  if (!(all > 0)) {
    weights_.assign(cells, 1.0f);
    return;
  }
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      double sum = 0, count = 0;
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, side - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, side - 1); ++i) {
          sum += light[size_t(j * side + i)];
          count += 1;
        }
      // A cell in which no light was found may contain some nevertheless.
      const double mean = all / double(cells);
      weights_[size_t(y * side + x)] = float(mean / (sum / count + 0.03 * mean));
    }
}

std::uint32_t FilmWeights::order(std::uint16_t cell) {
  const auto spread = [](std::uint32_t x) {  // 0b1011 to 0b1000101
    x = (x | (x << 2)) & 0x33333333u;
    return (x | (x << 1)) & 0x55555555u;
  };
  static_assert(side <= 16);
  return spread(cell % side) | (spread(std::uint32_t(cell) / side) << 1);
}

void Contribution::add(const Splat& part, const PixelArea& area) {
  if (part.value.black()) return;
  const double y = to_xyz(part.value, part.wavelengths).y;
  if (!std::isfinite(y)) {
    bad.push_back(part);
    return;
  }
  parts.push_back(part);
  luminances.push_back({float(std::max(y, 0.0)), FilmWeights::cell(part.film, area)});
}

namespace {

void splat(ImageTile& tile, const Splat& part, double factor) {
  tile.splat(part.film, int(part.film.x), int(part.film.y), 0, part.value * float(factor), part.wavelengths, part.length);
}

}  // namespace

void Contribution::add_to(ImageTile& tile, double factor) const {
  if (!(factor > 0)) return;
  for (const Splat& part : parts) splat(tile, part, factor);
}

void Contribution::report_bad(ImageTile& tile) const {
  for (const Splat& part : bad) splat(tile, part, 1);
}

ChainStarts::ChainStarts(std::vector<Path> paths) : paths_(std::move(paths)) {
  std::ranges::sort(paths_,
                    [](const Path& a, const Path& b) { return a.order != b.order ? a.order < b.order : a.number < b.number; });
  double sum = 0;
  for (const Path& path : paths_) sums_.push_back(sum += path.brightness);
  if (!paths_.empty()) mean_ = sum / double(paths_.size());
}

std::uint64_t ChainStarts::begin(std::uint64_t chain, std::uint64_t chains, double u) const {
  if (paths_.empty()) return 0;
  const double at = (double(chain) + u) / double(chains) * sums_.back();
  const auto found = std::ranges::upper_bound(sums_, at);
  return paths_[std::min(size_t(found - sums_.begin()), paths_.size() - 1)].number;
}

void require_mutable(const WavelengthSampler& wavelengths, const Component& component) {
  const SampleKey one(1, 2, 3, 4), other(5, 6, 7, 8);
  for (const float u : {0.1f, 0.3f, 0.9f})
    if (wavelengths.sample(one, u)[0] != wavelengths.sample(other, u)[0])
      component.fail({}, wavelengths.class_info().name +
                             " cannot be mutated: needs wavelengths that follow from a number, such as HeroWavelengths");
}

}  // namespace etendue
