// Reads images and builds their MIP levels.

#include "cached_texture.h"

#include <unistd.h>

#include <algorithm>

#include "etendue/core/error.h"
#include "files/shared_contents.h"
#include "image_cache.h"
#include "linear_input.h"
#include "refuse.h"

namespace etendue {
namespace {

/// Reduces N texels to M = max(1, floor(N / 2)) along each side by area averages: texel i of M covers [i N / M, (i + 1) N / M).
/// If N is odd, neighbours share texels, so that the mean over the whole image is preserved.
class Halving {
 public:
  Halving(int source_width, int source_height, int channels)
      : width(std::max(source_width / 2, 1)),
        height(std::max(source_height / 2, 1)),
        texels(size_t(width) * size_t(height) * size_t(channels)),
        source_width_(source_width),
        source_height_(source_height),
        channels_(size_t(channels)),
        row_(size_t(width) * size_t(channels)) {}

  /// Adds part of a row of texels, starting at column `begin`.
  void add(int y, int begin, int count, const float* values) {
    std::fill(row_.begin(), row_.end(), 0.0f);
    for (int x = begin; x < begin + count; ++x, values += channels_)
      share(x, source_width_, width, [&](size_t i, float part) {
        for (size_t c = 0; c < channels_; ++c) row_[i * channels_ + c] += part * values[c];
      });
    share(y, source_height_, height, [&](size_t i, float part) {
      float* const out = texels.data() + i * row_.size();
      for (size_t k = 0; k < row_.size(); ++k) out[k] += part * row_[k];
    });
  }

  int width, height;
  std::vector<float> texels;

 private:
  /// The destination texels that source texel x overlaps, with the overlap of each in units of 1 / M texels.
  template <class Use>
  static void share(std::int64_t x, std::int64_t n, std::int64_t m, Use use) {
    const std::int64_t begin = x * m, end = begin + m;
    for (std::int64_t i = begin / n; i * n < end; ++i)
      use(size_t(i), float(std::min(end, (i + 1) * n) - std::max(begin, i * n)) / float(n));
  }

  int source_width_, source_height_;
  size_t channels_;
  std::vector<float> row_;
};

/// No image has more MIP levels, so that references into `levels_` stay valid while further levels are made.
constexpr size_t most_levels = 32;

/// Half of the machine's memory. Textures are looked up at full resolution and in random order, and after a cache miss a strip
/// of the file is read again.
float cache_megabytes() {
  const double bytes = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  return float(std::max(2048.0, bytes / 2 / (1 << 20)));
}

}  // namespace

OIIO::ImageCache& image_cache() {
  // Never destroyed. From version 3 on, OpenImageIO returns a shared pointer, before that a plain one.
  static auto& cache = *new auto([] {
    auto c = OIIO::ImageCache::create(false);
    c->attribute("autotile", CachedTexture::tile_side);
    c->attribute("accept_untiled", 1);
    c->attribute("accept_unmipped", 1);
    c->attribute("max_memory_MB", cache_megabytes());
    return c;
  }());
  return *cache;
}

std::shared_ptr<const CachedTexture> CachedTexture::open(const std::string& path, const std::string& transfer,
                                                         const std::string& channel) {
  static auto& known = *new SharedContents<std::string, bool, CachedTexture>;
  const std::string key = linear_image_key(path, transfer, channel);
  return known.get(key, true, [&]() -> std::shared_ptr<const CachedTexture> {
    const auto texture = std::make_shared<CachedTexture>();
    try {
      texture->read(key);
    } catch (const Error& e) {
      // OpenImageIO's messages contain the cache's key; the user expects the path.
      std::string reason = e.what();
      for (size_t at; (at = reason.find(key)) != std::string::npos;) reason.replace(at, key.size(), path);
      image_cache().invalidate(OIIO::ustring(key));
      refuse(std::move(reason));
    }
    return texture;
  });
}

std::shared_ptr<const CachedTexture> CachedTexture::of(const ListedImage& image) {
  const auto texture = std::make_shared<CachedTexture>();
  texture->channels_ = image.channels;
  texture->pixels_x_ = image.width;
  texture->pixels_y_ = image.height;
  texture->levels_.reserve(most_levels);
  texture->levels_.push_back({image.width, image.height, {}});
  for (const float value : image.texels) texture->largest_ = std::max(texture->largest_, value);
  texture->kept_ = std::make_unique<KeptTexels>(image.texels.size());
  const size_t row = size_t(image.width) * size_t(image.channels);
  for (size_t begin = 0; begin < image.texels.size(); begin += row) texture->kept_->add(image.texels.data() + begin, row);
  texture->kept_whole_ = true;
  return texture;
}

void CachedTexture::read_header(const OIIO::ImageSpec& spec) {
  channels_ = spec.nchannels;
  from_cube_ = spec.get_int_attribute(made_of_cube) != 0;
  left_ = spec.full_x;
  top_ = spec.full_y;
  begin_x_ = spec.x - left_;
  begin_y_ = spec.y - top_;
  pixels_x_ = spec.width;
  pixels_y_ = spec.height;
  const int width = spec.full_width, height = spec.full_height;
  const double area = double(width) * height;
  if (width < 1 || height < 1) throw Error("its display window is empty");
  if (area > 0x1p26 && area > 16.0 * pixels_x_ * pixels_y_) throw Error("its display window is far larger than what it shows");
  levels_.reserve(most_levels);
  levels_.push_back({width, height, {}});
}

/// Stores all texels in memory if they fit; false: they do not.
bool CachedTexture::keep(const std::string& key) {
  const std::unique_ptr<OIIO::ImageInput> input(make_linear_input());
  OIIO::ImageSpec spec;
  if (!input->open(key, spec)) throw Error(input->geterror());
  read_header(spec);
  const size_t row = size_t(pixels_x_) * size_t(channels_), count = row * size_t(pixels_y_);
  if (!KeptTexels::allowed(count)) return false;
  try {
    std::vector<float> values(row);
    auto kept = std::make_unique<KeptTexels>(count);
    for (int y = 0; y < pixels_y_; ++y) {
      if (!input->read_native_scanline(0, 0, spec.y + y, 0, values.data())) throw Error(input->geterror());
      for (const float value : values) largest_ = value > largest_ ? value : largest_;
      kept->add(values.data(), row);
    }
    kept_ = std::move(kept);
    kept_whole_ = begin_x_ == 0 && begin_y_ == 0 && pixels_x_ == levels_[0].width && pixels_y_ == levels_[0].height;
  } catch (const std::bad_alloc&) {  // memory is used otherwise
    return false;
  }
  return true;
}

void CachedTexture::read(const std::string& key) {
  if (keep(key)) return;
  OIIO::ImageCache& cache = image_cache();
  name_ = OIIO::ustring(key);
  if (!cache.add_file(name_, make_linear_input)) throw Error(cache.geterror());
  handle_ = cache.get_image_handle(name_);
  // Reads the whole file, so that damage is detected now.
  const size_t row = size_t(pixels_x_) * size_t(channels_);
  const auto use = [&](int begin, int end, const float* strip) {
    for (const float* value = strip; value != strip + row * size_t(end - begin); ++value)
      largest_ = *value > largest_ ? *value : largest_;
  };
  if (!read_rows(use)) throw Error(cache.geterror());
}

template <class Use>
bool CachedTexture::read_rows(Use use) const {
  constexpr int rows = 64;
  const int left = left_ + begin_x_, top = top_ + begin_y_;
  const size_t row = size_t(pixels_x_) * size_t(channels_);
  std::vector<float> strip(row * rows);
  for (int y = 0; y < pixels_y_; y += rows) {
    const int end = std::min(y + rows, pixels_y_);
    if (kept_) {
      for (size_t i = 0; i < row * size_t(end - y); ++i) strip[i] = (*kept_)[row * size_t(y) + i];
    } else if (!image_cache().get_pixels(name_, 0, 0, left, left + pixels_x_, top + y, top + end, 0, 1, OIIO::TypeDesc::FLOAT,
                                         strip.data())) {
      return false;
    }
    use(y, end, strip.data());
  }
  return true;
}

/// If a file was removed after it was opened, the part that cannot be read is black.
void CachedTexture::make_levels() const {
  const int width = levels_[0].width, height = levels_[0].height;
  Halving half(width, height, channels_);
  const size_t row = size_t(pixels_x_) * size_t(channels_);
  const int first = std::max(begin_x_, 0), last = std::min(begin_x_ + pixels_x_, width);  // in the display window
  read_rows([&](int begin, int end, const float* strip) {
    for (int i = begin; i < end; ++i)
      if (begin_y_ + i >= 0 && begin_y_ + i < height && first < last)
        half.add(begin_y_ + i, first, last - first,
                 strip + size_t(i - begin) * row + size_t(first - begin_x_) * size_t(channels_));
  });
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    levels_.push_back({half.width, half.height, std::move(half.texels)});
    const Level& l = levels_.back();
    half = Halving(l.width, l.height, channels_);
    for (int y = 0; y < l.height; ++y)
      half.add(y, 0, l.width, l.texels.data() + size_t(y) * size_t(l.width) * size_t(channels_));
  }
}

}  // namespace etendue
