#include "linear_input.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "checked_open.h"
#include "cube_map.h"
#include "etendue/describe/color.h"
#include "files/contained_file.h"
#include "files/regular_file.h"
#include "images/linear_image.h"
#include "refuse.h"

namespace etendue {
namespace {

/// Decodes a transfer function for values that were stored as integers or floats.
class Decoder {
 public:
  Decoder() = default;
  Decoder(const std::string& transfer, const OIIO::TypeDesc& format) : transfer_(transfer) {
    const bool integer = !format.is_floating_point();
    if (transfer_ == automatic_transfer) transfer_ = integer ? "srgb" : "linear";
    if (transfer_ == "linear" || !integer) return;
    // 65536 entries represent every 8- and 16-bit number exactly: 255 divides 65535.
    table_.resize(65536);
    for (size_t i = 0; i < table_.size(); ++i) table_[i] = float(decode_transfer(transfer_, double(i) / 65535));
  }

  void operator()(float* values, size_t count) const {
    if (transfer_ == "linear") return;
    for (size_t i = 0; i < count; ++i)
      values[i] = table_.empty() ? float(decode_transfer(transfer_, double(values[i])))
                                 : table_[size_t(std::min(std::max(values[i], 0.0f), 1.0f) * 65535 + 0.5f)];
  }

 private:
  std::string transfer_ = "linear";
  std::vector<float> table_;
};

constexpr char separator = '|';

bool same_name(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  });
}

/// The indices of the selected channels, one or three; empty: there are none.
std::vector<int> find_channels(const OIIO::ImageSpec& spec, const std::string& channel) {
  if (channel.empty()) return spec.nchannels >= 3 ? std::vector<int>{0, 1, 2} : std::vector<int>{0};
  const auto place = [&](const std::string& name) {
    for (size_t i = 0; i < spec.channelnames.size(); ++i)
      if (same_name(spec.channelnames[i], name)) return int(i);
    return -1;
  };
  if (const int one = place(channel); one >= 0) return {one};
  std::vector<int> layer{place(channel + ".R"), place(channel + ".G"), place(channel + ".B")};
  if (std::find(layer.begin(), layer.end(), -1) == layer.end()) return layer;
  if (const int one = place(channel + ".Y"); one >= 0) return {one};
  return {};
}

class LinearInput final : public OIIO::ImageInput {
 public:
  const char* format_name() const override { return "etendue_linear"; }

  bool open(const std::string& key, OIIO::ImageSpec& spec) override {
    size_t at[5] = {};  // behind each separator
    for (size_t i = 1; i < 5; ++i) {
      at[i] = key.find(separator, at[i - 1]) + 1;
      if (at[i] == 0) {
        errorfmt("'{}' is no key of an image", key);
        return false;
      }
    }
    const auto part = [&](size_t i) { return key.substr(at[i], at[i + 1] - 1 - at[i]); };
    const std::string path = key.substr(at[4]);
    try {
      file_ = open_checked(path);
    } catch (const Error& e) {
      errorfmt("{}", e.what());
      return false;
    } catch (const std::bad_alloc&) {
      errorfmt("{}", no_memory_to_read);
      return false;
    }
    const OIIO::ImageSpec& native = file_->spec();
    channels_ = find_channels(native, part(2));
    if (channels_.empty()) {
      errorfmt("it has no channel '{}'", part(2));
      file_ = {};
      return false;
    }
    // Alpha is a fraction, not light: it is never encoded.
    const bool alpha = channels_.size() == 1 && channels_[0] == native.alpha_channel && part(1) == automatic_transfer;
    decoder_ = Decoder(alpha ? "linear" : part(1), native.format);
    strip_begin_ = strip_end_ = native.y;
    // Only the windows are copied: other attributes describe the values as stored in the file.
    m_spec = OIIO::ImageSpec(native.width, native.height, int(channels_.size()), OIIO::TypeDesc::FLOAT);
    m_spec.x = native.x;
    m_spec.y = native.y;
    m_spec.full_x = native.full_x;
    m_spec.full_y = native.full_y;
    m_spec.full_width = native.full_width;
    m_spec.full_height = native.full_height;
    if (file_.cube && !open_cube()) return false;
    spec = m_spec;
    return true;
  }

  bool close() override {
    file_ = {};
    cube_.reset();
    return true;
  }

  bool read_native_scanline(int subimage, int level, int y, int, void* data) override {
    lock_guard lock(*this);
    if (!file_ || subimage != 0 || level != 0) return false;
    if (cube_) {
      cube_->row(y, static_cast<float*>(data));
      return true;
    }
    if (y < strip_begin_ || y >= strip_end_) {
      if (!read_strip(y)) return false;
    }
    const size_t row = size_t(m_spec.width) * size_t(m_spec.nchannels);
    std::copy_n(strip_.data() + size_t(y - strip_begin_) * row, row, static_cast<float*>(data));
    return true;
  }

  bool from_cube() const { return cube_.has_value(); }

 private:
  /// Reads all pixels of a cube map, since each row of the resulting image depends on all faces.
  bool open_cube() {
    const int side = m_spec.width;
    if (std::int64_t(m_spec.height) != 6 * std::int64_t(side)) {
      errorfmt("it says that it is a cube of surroundings (envmap), but has {} x {} pixels: the faces of a cube are N x 6 N",
               side, m_spec.height);
      return false;
    }
    const size_t row = size_t(side) * size_t(m_spec.nchannels);
    std::vector<float> pixels(row * size_t(m_spec.height));
    for (int y = 0; y < m_spec.height; ++y)
      if (!read_native_scanline(0, 0, m_spec.y + y, 0, pixels.data() + size_t(y) * row)) return false;
    strip_ = {};
    cube_.emplace(std::move(pixels), side, m_spec.nchannels);
    m_spec.x = m_spec.y = m_spec.full_x = m_spec.full_y = 0;
    m_spec.width = m_spec.full_width = cube_->width();
    m_spec.height = m_spec.full_height = cube_->height();
    m_spec.attribute(made_of_cube, 1);
    return true;
  }

  /// Reads the row of tiles, or the few scanlines, that contain a scanline.
  bool read_strip(int y) {
    const OIIO::ImageSpec& native = file_->spec();
    // Reads all channels from the first to the last selected one, then picks the selected ones.
    const auto [least, most] = std::minmax_element(channels_.begin(), channels_.end());
    const int first = *least, stop_channel = *most + 1, end = native.y + native.height;
    const size_t channels = size_t(stop_channel - first);
    const int rows = native.tile_width ? native.tile_height : 16;
    const int begin = native.y + (y - native.y) / rows * rows, stop = std::min(begin + rows, end);
    strip_.resize(size_t(native.width) * size_t(rows) * channels);
    const bool good = native.tile_width ? file_->read_tiles(0, 0, native.x, native.x + native.width, begin, stop, 0, 1, first,
                                                            stop_channel, OIIO::TypeDesc::FLOAT, strip_.data())
                                        : file_->read_scanlines(0, 0, begin, stop, 0, first, stop_channel,
                                                                OIIO::TypeDesc::FLOAT, strip_.data());
    if (!good) {
      strip_begin_ = strip_end_ = native.y;
      errorfmt("{}", file_->geterror());
      return false;
    }
    strip_begin_ = begin;
    strip_end_ = stop;
    const size_t pixels = size_t(native.width) * size_t(stop - begin), wanted = channels_.size();
    if (wanted != channels || !std::is_sorted(channels_.begin(), channels_.end())) pick(pixels, channels, first);
    decoder_(strip_.data(), pixels * wanted);
    return true;
  }

  /// Keeps only the selected channels of each pixel, in place: there are never more than were read.
  void pick(size_t pixels, size_t channels, int first) {
    float pixel[3] = {};
    for (size_t i = 0; i < pixels; ++i) {
      for (size_t c = 0; c < channels_.size(); ++c) pixel[c] = strip_[i * channels + size_t(channels_[c] - first)];
      std::copy_n(pixel, channels_.size(), strip_.data() + i * channels_.size());
    }
  }

  CheckedInput file_;
  std::optional<CubeMap> cube_;
  Decoder decoder_;
  std::vector<int> channels_;
  std::vector<float> strip_;
  int strip_begin_ = 0, strip_end_ = 0;
};

}  // namespace

void check_file_channel(const std::string& path, const std::string& channel) {
  CheckedInput file;
  try {
    file = open_checked(path);
  } catch (const Error&) {
    return;  // reported when the image is read
  }
  const std::vector<std::string>& known = file->spec().channelnames;
  if (channel.find(separator) == std::string::npos && !find_channels(file->spec(), channel).empty()) return;
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  throw Error("'" + path + "' has no channel '" + channel + "'" + suggestion(channel, known) + "; it has " + list);
}

OIIO::ImageInput* make_linear_input() { return new LinearInput; }

std::string linear_image_key(const std::string& path, const std::string& transfer, const std::string& channel) {
  std::error_code ignored;
  const auto changed = std::filesystem::last_write_time(file_on_disk(path), ignored).time_since_epoch().count();
  return std::string("etendue") + separator + transfer + separator + channel + separator + std::to_string(changed) + separator +
         path;
}

LinearImage read_linear_file(const std::string& path, const std::string& transfer, const std::string& channel) {
  LinearInput input;
  OIIO::ImageSpec spec;
  if (!input.open(linear_image_key(path, transfer, channel), spec)) refuse(input.geterror());
  LinearImage image;
  image.width = spec.width;
  image.height = spec.height;
  image.from_cube = input.from_cube();
  image.rgb.resize(size_t(spec.width) * size_t(spec.height) * 3);
  std::vector<float> row(size_t(spec.width) * size_t(spec.nchannels));
  for (int y = 0; y < spec.height; ++y) {
    if (!input.read_native_scanline(0, 0, spec.y + y, 0, row.data())) refuse(input.geterror());
    float* out = image.rgb.data() + size_t(y) * size_t(spec.width) * 3;
    for (size_t x = 0; x < size_t(spec.width); ++x)
      for (size_t c = 0; c < 3; ++c) out[3 * x + c] = spec.nchannels == 3 ? row[3 * x + c] : row[x];
  }
  return image;
}

}  // namespace etendue
