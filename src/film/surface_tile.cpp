#include "surface_tile.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "etendue/core/packing.h"
#include "filter_window.h"
#include "pixel_area.h"
#include "tile_values.h"

namespace etendue {
namespace {

/// Whether a film point is finite and of ordinary size; false for NaN.
bool ordinary(Point2 film) { return std::abs(film.x) < 1e7f && std::abs(film.y) < 1e7f; }

struct Three {
  double x = 0, y = 0, z = 0;
};

Three three(const Vector3& v) { return {double(v.x), double(v.y), double(v.z)}; }

/// The third number counts the samples with a known motion.
Three three(const std::optional<Vector2>& motion) { return motion ? Three{double(motion->x), double(motion->y), 1} : Three{}; }

Three number_of(const FirstSurface& s, SurfaceNumber number) {
  switch (number) {
    case SurfaceNumber::albedo: return three(s.albedo);
    case SurfaceNumber::normal: return three(s.normal);
    case SurfaceNumber::geometric_normal: return three(s.geometric_normal);
    case SurfaceNumber::position: return {s.position.x, s.position.y, s.position.z};
    case SurfaceNumber::depth: return {s.depth};
    case SurfaceNumber::uv: return {double(s.uv.x), double(s.uv.y)};
    case SurfaceNumber::roughness: return {double(s.roughness)};
    case SurfaceNumber::motion_previous: return three(s.motion_previous);
    case SurfaceNumber::motion_next: return three(s.motion_next);
    case SurfaceNumber::count: break;
  }
  return {};
}

bool finite(const Three& t) { return std::isfinite(t.x) && std::isfinite(t.y) && std::isfinite(t.z); }

}  // namespace

void add_share(SurfaceShares& shares, const SurfaceShare& more) {
  const auto at = std::ranges::lower_bound(shares, more.key, {}, &SurfaceShare::key);
  if (at != shares.end() && at->key == more.key)
    at->weight += more.weight;
  else
    shares.insert(at, more);
}

void SurfaceTile::begin(const ImageBuffer& image, const PixelArea& area, std::uint32_t block) {
  *this = {};
  format_ = image.format();
  block_ = block;
  const SurfaceLayers& layers = format_->surfaces;
  sampled_ = intersection(area, format_->sampled_area);
  area_ = intersection(area, format_->area);
  extent_ = intersection(widened(area, format_->reach()), format_->area);
  values_.resize(size_t(3 * layers.triples()) * pixels(extent_));
  weights_.resize(weight_count * pixels(extent_));
  if (layers.identifiers()) nearest_.resize(pixels(area_));
  if (layers.mattes()) shares_.resize(pixels(extent_));
}

void SurfaceTile::add(Point2 film, int px, int py, std::uint32_t sample, const FirstSurface& surface) {
  if (!sampled_.contains(px, py)) return;
  if (!ordinary(film)) film = {float(px) + 0.5f, float(py) + 0.5f};
  if (!nearest_.empty() && area_.contains(px, py)) {
    const float dx = film.x - (float(px) + 0.5f), dy = film.y - (float(py) + 0.5f);
    const size_t pixel = size_t(py - area_.y0) * size_t(area_.width()) + size_t(px - area_.x0);
    nearest_[pixel].add({std::bit_cast<std::uint32_t>(dx * dx + dy * dy), sample, surface.key ? surface.object : 0,
                         surface.key ? surface.material : 0, surface.key ? surface.primitive + 1 : 0});
  }
  const auto pixel = [&](int x, int y) { return size_t(y - extent_.y0) * size_t(extent_.width()) + size_t(x - extent_.x0); };
  if (format_->box) {
    if (extent_.contains(px, py)) add_weighted(pixel(px, py), format_->fixed_weights.front(), surface);
    return;
  }
  constexpr int size = PictureFormat::table_size;
  const FilterWindow across(film.x, format_->radius, size, extent_.x0, extent_.x1);
  const FilterWindow down(film.y, format_->radius, size, extent_.y0, extent_.y1);
  for (int j = 0; j < down.count; ++j) {
    const std::int64_t* const row = &format_->fixed_weights[size_t(down.cells[size_t(j)]) * size];
    for (int i = 0; i < across.count; ++i)
      add_weighted(pixel(across.first + i, down.first + j), row[across.cells[size_t(i)]], surface);
  }
}

void SurfaceTile::add_weighted(size_t pixel, std::int64_t weight, const FirstSurface& surface) {
  std::int64_t* const weights = &weights_[weight_count * pixel];
  weights[weight_of_all] += weight;
  if (surface.key == 0) return;
  const std::int64_t positive = std::max<std::int64_t>(weight, 0);
  weights[weight_of_met] += weight;
  weights[weight_of_positive] += positive;
  if (!shares_.empty()) add_share(shares_[pixel], {surface.key, weight});
  const SurfaceLayers& layers = format_->surfaces;
  for (size_t n = 0; n < surface_numbers && !values_.empty(); ++n) {
    const auto number = SurfaceNumber(n);
    const int place = layers.place(number);
    if (place < 0) continue;
    const Three value = number_of(surface, number);
    if (!finite(value)) continue;
    const auto factor = double(over_all_samples(number) ? weight : positive);
    double* const sum = &values_[3 * (size_t(layers.triples()) * pixel + size_t(place))];
    sum[0] += factor * value.x;
    sum[1] += factor * value.y;
    sum[2] += factor * value.z;
  }
}

void SurfaceTile::pack(std::vector<std::byte>& to) const {
  Packing::pack(to, block_);
  for (const PixelArea& area : {sampled_, area_, extent_}) Packing::pack(to, area);
  Packing::pack(to, values_);
  Packing::pack(to, weights_);
  Packing::pack(to, nearest_);
  Packing::pack(to, shares_);
  Packing::pack(to, std::uint64_t(names_.size()));
  for (const auto& [key, names] : names_) {
    Packing::pack(to, key);
    for (const std::string& name : names) Packing::pack(to, std::vector<char>(name.begin(), name.end()));
  }
}

SurfaceTile SurfaceTile::unpack(std::span<const std::byte>& from) {
  SurfaceTile tile;
  Packing::unpack(from, tile.block_);
  for (PixelArea* area : {&tile.sampled_, &tile.area_, &tile.extent_}) Packing::unpack(from, *area);
  Packing::unpack(from, tile.values_);
  Packing::unpack(from, tile.weights_);
  Packing::unpack(from, tile.nearest_);
  Packing::unpack(from, tile.shares_);
  std::uint64_t count = 0;
  Packing::unpack(from, count);
  for (; count > 0; --count) {
    std::uint64_t key = 0;
    Packing::unpack(from, key);
    for (std::string& name : tile.names_[key]) {
      std::vector<char> letters;
      Packing::unpack(from, letters);
      name.assign(letters.begin(), letters.end());
    }
  }
  return tile;
}

}  // namespace etendue
