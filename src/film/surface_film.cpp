#include "surface_film.h"

#include <fmt/format.h>

#include <algorithm>

#include "pixel_area.h"
#include "tile_values.h"

namespace etendue {

void SurfaceSnapshot::Sums::make_room(const PictureFormat& format) {
  if (!weights.empty()) return;
  const SurfaceLayers& layers = format.surfaces;
  const size_t count = format.pixels();
  values = ExactSums(count * size_t(layers.triples()), 3);
  weights.resize(weight_count * count);
  if (layers.identifiers()) nearest.resize(count);
  if (layers.mattes()) shares.resize(count);
}

void SurfaceSnapshot::Sums::add(const Sums& other) {
  if (other.steps > ExactSums::most_addends - steps)
    throw Error(fmt::format("a film cannot take more than {} steps", ExactSums::most_addends));
  if (other.weights.empty()) return;
  if (weights.empty()) {
    *this = other;
    return;
  }
  values.add(other.values);
  for (size_t i = 0; i < weights.size(); ++i) weights[i] += other.weights[i];
  for (size_t i = 0; i < nearest.size(); ++i) nearest[i].add(other.nearest[i]);
  for (size_t i = 0; i < shares.size(); ++i)
    for (const SurfaceShare& share : other.shares[i]) add_share(shares[i], share);
  names.insert(other.names.begin(), other.names.end());
  steps += other.steps;
}

SurfaceFilm::SurfaceFilm(const ImageBuffer& image) : format_(image.format()), sums_(std::make_shared<Sums>()) {}

bool SurfaceFilm::wanted() const {
  const std::lock_guard lock(mutex_);
  return wants_any();
}

bool SurfaceFilm::follow(const ImageBuffer& image) {
  const std::lock_guard lock(mutex_);
  const PictureFormat &old = *format_, &now = *image.format();
  const bool same = !now.surfaces.any() || (old.surfaces.collects_as(now.surfaces) && old.samples_as(now));
  format_ = image.format();
  step_.clear();
  if (!same || !now.surfaces.any()) sums_ = std::make_shared<Sums>();
  return same;
}

void SurfaceFilm::clear() {
  const std::lock_guard lock(mutex_);
  step_.clear();
  sums_ = std::make_shared<Sums>();
}

SurfaceFilm::Sums& SurfaceFilm::own_sums() {
  if (sums_.use_count() > 1) sums_ = std::make_shared<Sums>(*sums_);
  return *sums_;
}

// ---- a step ----------------------------------------------------------------------------------------------------------------

void SurfaceFilm::require_fitting(const SurfaceTile& tile) const {
  const SurfaceLayers& layers = format_->surfaces;
  const auto within = [&](const PixelArea& a) { return pixels(a) == 0 || intersection(a, format_->area) == a; };
  const size_t own = pixels(tile.area_), reached = pixels(tile.extent_);
  if (!within(tile.area_) || !within(tile.extent_) || tile.values_.size() != size_t(3 * layers.triples()) * reached ||
      tile.weights_.size() != weight_count * reached || tile.nearest_.size() != (layers.identifiers() ? own : 0) ||
      tile.shares_.size() != (layers.mattes() ? reached : 0))
    throw Error("the tile of surfaces is of another picture");
}

void SurfaceFilm::take(std::vector<SurfaceTile> tiles) {
  const std::lock_guard lock(mutex_);
  for (SurfaceTile& tile : tiles) {
    require_fitting(tile);
    step_.push_back(std::move(tile));
  }
}

void SurfaceFilm::drop_step() {
  const std::lock_guard lock(mutex_);
  step_.clear();
}

// Within a block, tiles are added as plain doubles in their order; each block is an addend of the exact sums.
void SurfaceFilm::end_step() {
  const std::lock_guard lock(mutex_);
  if (step_.empty()) return;
  const PictureFormat& format = *format_;
  const auto triples = size_t(format.surfaces.triples());
  Sums& sums = own_sums();
  std::vector<double> values;
  sums.make_room(format);
  values.resize(3 * triples * format.pixels());
  const auto end_block = [&] {
    if (++sums.steps > ExactSums::most_addends)
      throw Error(fmt::format("a film cannot take more than {} steps", ExactSums::most_addends));
    if (triples == 0) return;
    sums.values.add(0, format.pixels() * triples, values.data(), 3);
    std::ranges::fill(values, 0.0);
  };
  std::uint32_t block = step_.front().block_;
  for (const SurfaceTile& tile : step_) {
    if (tile.block_ != block) end_block();
    block = tile.block_;
    size_t at = 0;
    for (int y = tile.extent_.y0; y < tile.extent_.y1; ++y)
      for (int x = tile.extent_.x0; x < tile.extent_.x1; ++x, ++at) {
        const size_t pixel = format.index(x, y);
        for (size_t i = 0; i < 3 * triples; ++i) values[3 * triples * pixel + i] += tile.values_[3 * triples * at + i];
        for (size_t i = 0; i < weight_count; ++i)
          sums.weights[weight_count * pixel + i] += tile.weights_[weight_count * at + i];
        if (!tile.shares_.empty())
          for (const SurfaceShare& share : tile.shares_[at]) add_share(sums.shares[pixel], share);
      }
    at = 0;
    for (int y = tile.area_.y0; y < tile.area_.y1 && !tile.nearest_.empty(); ++y)
      for (int x = tile.area_.x0; x < tile.area_.x1; ++x, ++at) sums.nearest[format.index(x, y)].add(tile.nearest_[at]);
    sums.names.insert(tile.names_.begin(), tile.names_.end());
  }
  end_block();
  step_.clear();
}

// ---- the picture -----------------------------------------------------------------------------------------------------------

std::shared_ptr<const SurfaceSnapshot> SurfaceFilm::snapshot() const {
  const std::lock_guard lock(mutex_);
  if (!wants_any()) return nullptr;
  auto made = std::make_shared<SurfaceSnapshot>();
  made->format_ = format_;
  made->sums_ = sums_;
  return made;
}

double SurfaceSnapshot::value(const SurfaceChannel& channel, size_t pixel) const {
  const std::int64_t* const weights = &sums_->weights[weight_count * pixel];
  const auto whole = double(weights[weight_of_all]), met = double(weights[weight_of_positive]);
  switch (channel.source) {
    case SurfaceChannel::Source::coverage: return whole > 0 ? std::clamp(double(weights[weight_of_met]) / whole, 0.0, 1.0) : 0;
    case SurfaceChannel::Source::object: return sums_->nearest[pixel].object;
    case SurfaceChannel::Source::material: return sums_->nearest[pixel].material;
    case SurfaceChannel::Source::primitive: return sums_->nearest[pixel].primitive;
    case SurfaceChannel::Source::number: break;
  }
  const SurfaceNumber number = channel.number;
  const SurfaceLayers& layers = format_->surfaces;
  const size_t group = pixel * size_t(layers.triples()) + size_t(layers.place(number));
  const bool motion = number == SurfaceNumber::motion_previous || number == SurfaceNumber::motion_next;
  const double by = over_all_samples(number) ? whole : motion ? sums_->values.value(group, 2) : met;
  return by > 0 ? sums_->values.value(group, size_t(channel.component)) / by : 0;
}

void SurfaceSnapshot::add_channels(Image& image) const {
  const std::vector<SurfaceChannel> channels = channels_of(format_->surfaces);
  if (channels.empty()) return;
  const size_t before = image.channels.size(), after = before + channels.size(), count = format_->pixels();
  if (size_t(image.width) * size_t(image.height) != count) throw Error("the layers of surfaces are of another picture");
  std::vector<double> values(after * count);
  for (size_t i = 0; i < count; ++i) {
    std::copy_n(image.values.begin() + std::ptrdiff_t(before * i), before, values.begin() + std::ptrdiff_t(after * i));
    if (sums_->weights.empty()) continue;
    for (size_t c = 0; c < channels.size(); ++c) values[after * i + before + c] = value(channels[c], i);
  }
  for (const SurfaceChannel& channel : channels) image.channels.push_back(channel.name);
  image.values = std::move(values);
}

}  // namespace etendue
