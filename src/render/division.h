#pragma once
// Division: the items of work of a step that renders camera paths.

#include <algorithm>
#include <vector>

#include "etendue/film/image_buffer.h"
#include "etendue/render/process.h"
#include "film/pixel_area.h"
#include "parallel_schedule.h"

namespace etendue {

/// Divides the picture and the samples of a step into items: tiles, and for small pictures parts of the sample range as well.
/// The division depends only on the picture's size and the pass, so results do not depend on threads.
///
/// A crop uses the tiles of the whole picture, without those outside of it. Each pixel is then the same sum, of the same terms
/// in the same order, as in the whole picture. A pass of a crop contains several passes of the whole picture, one after the
/// other: a small crop has few tiles, and more items keep more threads busy.
class Division {
 public:
  struct Item {
    PixelArea area;
    std::uint32_t first, last;  ///< samples [first, last)
    std::uint32_t block;        ///< the pass of the whole picture they belong to, by its first sample
  };

  Division(const ImageBuffer& image, IndexRange pass) : area_(image.sampled_area()) {
    const PixelArea whole{0, 0, image.width, image.height};
    column_ = area_.x0 / tile;
    row_ = area_.y0 / tile;
    columns_ = (area_.x1 + tile - 1) / tile - column_;
    const int rows = (area_.y1 + tile - 1) / tile - row_;
    tiles_ = std::uint64_t(columns_) * std::uint64_t(rows);

    constexpr std::uint64_t enough = 64;
    const auto along = [](int pixels) { return std::uint64_t((pixels + tile - 1) / tile); };
    const std::uint64_t all_tiles = along(whole.width()) * along(whole.height());
    const std::uint32_t step = samples_per_step(whole);
    for (std::uint32_t begin = pass.begin; begin < pass.end;) {
      const std::uint32_t end = std::uint32_t(std::min<std::uint64_t>(pass.end, (std::uint64_t(begin) / step + 1) * step));
      const std::uint32_t n = end - begin;
      const auto wanted = std::uint32_t(std::clamp<std::uint64_t>((enough + all_tiles - 1) / all_tiles, 1, n));
      const std::uint32_t chunk = (n + wanted - 1) / wanted, chunks = (n + chunk - 1) / chunk;
      parts_.push_back({begin, end, chunk, chunks, count_});
      count_ += tiles_ * chunks;
      begin = end;
    }
  }

  std::uint64_t count() const { return count_; }

  Item item(std::uint64_t number) const {
    const Part& part = *(std::ranges::upper_bound(parts_, number, {}, &Part::first_item) - 1);
    const std::uint64_t rest = number - part.first_item;
    const int t = int(rest / part.chunks), x = (column_ + t % columns_) * tile, y = (row_ + t / columns_) * tile;
    const std::uint32_t first = part.begin + std::uint32_t(rest % part.chunks) * part.chunk;
    return {intersection({x, y, x + tile, y + tile}, area_), first, std::min(first + part.chunk, part.end), part.begin};
  }

 private:
  static constexpr int tile = 16;
  /// A pass of the whole picture.
  struct Part {
    std::uint32_t begin, end, chunk, chunks;
    std::uint64_t first_item;
  };

  PixelArea area_;
  int column_ = 0, row_ = 0, columns_ = 1;
  std::uint64_t tiles_ = 1, count_ = 0;
  std::vector<Part> parts_;
};

}  // namespace etendue
