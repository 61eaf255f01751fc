// Tiles as bytes, in which they travel to the film of another process.

#include <algorithm>
#include <mutex>

#include "etendue/core/packing.h"
#include "etendue/film/film.h"
#include "film_members.h"
#include "tile_values.h"

namespace etendue {
namespace {

bool lies_within(const PixelArea& part, const PixelArea& whole) {
  return pixels(part) == 0 || (part.x0 >= whole.x0 && part.y0 >= whole.y0 && part.x1 <= whole.x1 && part.y1 <= whole.y1);
}

}  // namespace

// Light that is zero everywhere is left out: tiles of splats have no light, and dark parts of a picture none either.
void ImageTile::pack(std::vector<std::byte>& to) const {
  Packing::pack(to, format_ != nullptr);
  if (!format_) return;
  Packing::pack(to, block_);
  for (const PixelArea& area : {sampled_, area_, extent_}) Packing::pack(to, area);
  Packing::pack(to, lit_);
  if (lit_) {
    Packing::pack(to, light_);
    Packing::pack(to, parts_);
  } else if (format_->bands) {
    Packing::pack(to, std::vector<double>(parts_.begin() + std::ptrdiff_t(pixel_values(*format_, extent_)), parts_.end()));
  }
  Packing::pack(to, samples_);
  Packing::pack(to, weights_);
  Packing::pack(to, largest_);
  Packing::pack(to, splats_);
  Packing::pack(to, bad_);
  Packing::pack(to, bad_count_);
  Packing::pack(to, paths_);
}

void Film::unpack(std::span<const std::byte>& from, ImageTile& tile) const {
  const std::shared_ptr<const PictureFormat> format = [&] {
    const std::lock_guard lock(members_->mutex);
    return members_->format;
  }();
  bool begun = false;
  Packing::unpack(from, begun);
  tile.format_ = begun ? format : nullptr;
  if (!begun) return;
  Packing::unpack(from, tile.block_);
  for (PixelArea* area : {&tile.sampled_, &tile.area_, &tile.extent_}) Packing::unpack(from, *area);
  const size_t own = pixels(tile.area_), reached = pixels(tile.extent_);
  Packing::unpack(from, tile.lit_);
  if (tile.lit_) {
    Packing::unpack(from, tile.light_);
    Packing::unpack(from, tile.parts_);
  } else {
    tile.light_.assign(4 * reached, 0);
    tile.parts_.assign(pixel_values(*format, tile.extent_), 0);
    if (format->bands) {
      std::vector<double> of_splats;
      Packing::unpack(from, of_splats);
      tile.parts_.insert(tile.parts_.end(), of_splats.begin(), of_splats.end());
    }
  }
  Packing::unpack(from, tile.samples_);
  Packing::unpack(from, tile.weights_);
  Packing::unpack(from, tile.largest_);
  Packing::unpack(from, tile.splats_);
  Packing::unpack(from, tile.bad_);
  Packing::unpack(from, tile.bad_count_);
  Packing::unpack(from, tile.paths_);
  const bool sound = lies_within(tile.area_, format->area) && lies_within(tile.extent_, format->area) &&
                     tile.light_.size() == 4 * reached &&
                     tile.parts_.size() == pixel_values(*format, tile.extent_) + splat_values(*format) * tile.splats_.size() &&
                     tile.samples_.size() == own && (tile.weights_.empty() || tile.weights_.size() == own);
  if (!sound) throw Error("the packed tile is of another picture");
}

}  // namespace etendue
