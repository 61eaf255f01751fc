#include "frame.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "etendue/describe/color.h"
#include "half.h"

namespace etendue::studio {

namespace {

/// A power of two by which a picture's values are divided, so that typical values are near 1 and half floats can hold the
/// others. The previous scale is kept while it is suitable, since a new one requires that all tiles are sent again.
float scale_for(const Image& image, size_t channel, float before) {
  const size_t stride = image.channels.size();
  double sum = 0;
  size_t count = 0;
  for (size_t i = channel; i < image.values.size(); i += stride * 7) {  // every seventh pixel is a sufficient sample
    const double v = std::abs(image.values[i]);
    if (v > 0 && std::isfinite(v)) sum += std::log2(v), ++count;
  }
  if (count == 0) return before;
  const double wanted = std::clamp(sum / double(count), -120.0, 120.0), had = std::log2(double(before));
  constexpr double slack = 5;  // halves have 15 powers of two above 1
  return std::abs(wanted - had) <= slack ? before : float(std::exp2(std::round(wanted)));
}

/// How many channels from `first` on are shown: all three of a colour, or those of a layer, "uv.U" and "uv.V". One is shown in
/// grey, two in red and green.
size_t channels_shown(const Image& image, size_t first) {
  const auto layer = [&](size_t c) { return image.channels[c].substr(0, image.channels[c].rfind('.')); };
  const bool color = image.channels[first].find('.') == std::string::npos;
  size_t count = 1;
  while (count < 3 && first + count < image.channels.size() && (color || layer(first + count) == layer(first))) ++count;
  return count;
}

void put(std::vector<std::uint8_t>& to, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) to.push_back(std::uint8_t(value >> (8 * i)));
}
void put16(std::vector<std::uint8_t>& to, int value) {
  to.push_back(std::uint8_t(value));
  to.push_back(std::uint8_t(value >> 8));
}

}  // namespace

void Frame::lay_out() {
  size_t begin = 0;
  for (int y = 0; y < height_; y += tile)
    for (int x = 0; x < width_; x += tile) {
      Tile t{x, y, std::min(tile, width_ - x), std::min(tile, height_ - y), begin, 0, number_};
      t.size = size_t(t.width) * size_t(t.height) * pixel_size();
      begin += t.size;
      tiles_.push_back(t);
    }
  bytes_.resize(begin);
}

std::shared_ptr<const Frame> Frame::make(Kind kind, const Image& image, size_t first, bool xyz, const FrameInfo& info,
                                         std::uint64_t number, const Frame* before) {
  auto frame = std::make_shared<Frame>();
  Frame& f = *frame;
  f.kind_ = kind;
  f.width_ = image.width;
  f.height_ = image.height;
  f.info_ = info;
  f.number_ = number;
  const bool same_kind = before && before->kind_ == kind;
  if (kind == Kind::linear) f.scale_ = scale_for(image, first + (xyz ? 1 : 0), same_kind ? before->scale_ : 1.0f);
  f.lay_out();
  const auto& m = rgb_space("srgb").from_xyz;
  const size_t stride = image.channels.size(), shown = channels_shown(image, first);
  const double factor = 1 / double(f.scale_);
  const bool comparable = before && f.continues(*before);
  for (size_t index = 0; index < f.tiles_.size(); ++index) {
    Tile& t = f.tiles_[index];
    std::uint8_t* to = f.bytes_.data() + t.begin;
    for (int y = t.y; y < t.y + t.height; ++y)
      for (int x = t.x; x < t.x + t.width; ++x) {
        const double* p = &image.values[(size_t(y) * size_t(image.width) + size_t(x)) * stride];
        const double c[3] = {p[first], shown == 1 ? p[first] : p[first + 1], shown == 2 ? 0 : p[first + shown - 1]};
        for (int k = 0; k < 3; ++k) {
          const double v = xyz ? m[size_t(3 * k)] * c[0] + m[size_t(3 * k + 1)] * c[1] + m[size_t(3 * k + 2)] * c[2] : c[k];
          if (kind == Kind::linear) {
            const std::uint16_t half = to_half(float(v * factor));
            *to++ = std::uint8_t(half);
            *to++ = std::uint8_t(half >> 8);
          } else {
            *to++ = std::uint8_t(std::lround(std::clamp(v, 0.0, 1.0) * 255));
          }
        }
      }
    if (comparable && std::memcmp(f.bytes_.data() + t.begin, before->bytes_.data() + t.begin, t.size) == 0)
      t.changed = before->tiles_[index].changed;
  }
  return frame;
}

bool Frame::continues(const Frame& o) const {
  return kind_ == o.kind_ && width_ == o.width_ && height_ == o.height_ && scale_ == o.scale_ && info_.x0 == o.info_.x0 &&
         info_.y0 == o.info_.y0 && info_.full_width == o.info_.full_width && info_.full_height == o.info_.full_height &&
         info_.coarse == o.info_.coarse;
}

std::vector<std::uint8_t> Frame::message(std::uint64_t after, int slot) const {
  std::vector<const Tile*> changed;
  size_t size = 64;
  for (const Tile& t : tiles_)
    if (t.changed > after) changed.push_back(&t), size += 4 + t.size;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(size);
  put(bytes, std::uint32_t(kind_));
  put(bytes, info_.generation);
  put(bytes, std::uint32_t(width_));
  put(bytes, std::uint32_t(height_));
  put(bytes, info_.x0);
  put(bytes, info_.y0);
  put(bytes, info_.full_width);
  put(bytes, info_.full_height);
  put(bytes, std::bit_cast<std::uint32_t>(scale_));
  put(bytes, info_.samples);
  put(bytes, std::uint32_t(info_.coarse) | std::uint32_t(info_.finished) << 1 | std::uint32_t(slot) << 8);
  put(bytes, std::uint32_t(changed.size()));
  for (const Tile* t : changed) {
    put16(bytes, t->x / tile);
    put16(bytes, t->y / tile);
  }
  for (const Tile* t : changed) bytes.insert(bytes.end(), bytes_.data() + t->begin, bytes_.data() + t->begin + t->size);
  return bytes;
}

const std::uint8_t* Frame::pixel(int x, int y) const {
  const size_t across = size_t((width_ + tile - 1) / tile);
  const Tile& t = tiles_[size_t(y / tile) * across + size_t(x / tile)];
  return bytes_.data() + t.begin + (size_t(y - t.y) * size_t(t.width) + size_t(x - t.x)) * pixel_size();
}

}  // namespace etendue::studio
