// Image files as linear numbers.

#include "maps/linear_image.h"

#include <filesystem>

#include "etendue/color.h"
#include "etendue/error.h"

namespace etendue {
namespace {

/// Undoes a transfer function for numbers that come from integers or floats.
class Decoder {
 public:
  Decoder() = default;
  Decoder(const std::string& transfer, OIIO::TypeDesc format) : transfer_(transfer) {
    const bool integer = !format.is_floating_point();
    if (transfer_ == automatic_transfer) transfer_ = integer ? "srgb" : "linear";
    if (transfer_ == "linear" || !integer) return;
    // 65536 entries hold every 8 and 16 bit number exactly: 255 divides 65535.
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

class LinearInput final : public OIIO::ImageInput {
 public:
  const char* format_name() const override { return "etendue_linear"; }

  bool open(const std::string& key, OIIO::ImageSpec& spec) override {
    const size_t first = key.find(separator), second = key.find(separator, first + 1), third = key.find(separator, second + 1);
    if (third == std::string::npos) {
      errorfmt("'{}' is no key of an image", key);
      return false;
    }
    const std::string path = key.substr(third + 1);
    file_ = OIIO::ImageInput::open(path);
    if (!file_) {
      errorfmt("{}", OIIO::geterror());
      return false;
    }
    const OIIO::ImageSpec& native = file_->spec();
    if (native.deep || native.nchannels < 1 || native.depth > 1) {
      errorfmt("it is a deep or volume image");
      file_.reset();
      return false;
    }
    decoder_ = Decoder(key.substr(first + 1, second - first - 1), native.format);
    strip_begin_ = strip_end_ = native.y;
    // Only what places the pixels is taken over: other attributes speak of the numbers as they are in the file.
    m_spec = OIIO::ImageSpec(native.width, native.height, native.nchannels >= 3 ? 3 : 1, OIIO::TypeDesc::FLOAT);
    m_spec.x = native.x;
    m_spec.y = native.y;
    m_spec.full_x = native.full_x;
    m_spec.full_y = native.full_y;
    m_spec.full_width = native.full_width;
    m_spec.full_height = native.full_height;
    spec = m_spec;
    return true;
  }

  bool close() override {
    file_.reset();
    return true;
  }

  bool read_native_scanline(int subimage, int level, int y, int, void* data) override {
    lock_guard lock(*this);
    if (!file_ || subimage != 0 || level != 0) return false;
    if (y < strip_begin_ || y >= strip_end_) {
      if (!read_strip(y)) return false;
    }
    const size_t row = size_t(m_spec.width) * size_t(m_spec.nchannels);
    std::copy_n(strip_.data() + size_t(y - strip_begin_) * row, row, static_cast<float*>(data));
    return true;
  }

 private:
  /// Reads the row of tiles, or the few scanlines, that hold a scanline.
  bool read_strip(int y) {
    const OIIO::ImageSpec& native = file_->spec();
    const int channels = m_spec.nchannels, end = native.y + native.height;
    const int rows = native.tile_width ? native.tile_height : 16;
    const int begin = native.y + (y - native.y) / rows * rows, stop = std::min(begin + rows, end);
    strip_.resize(size_t(native.width) * size_t(rows) * size_t(channels));
    const bool good = native.tile_width
                          ? file_->read_tiles(0, 0, native.x, native.x + native.width, begin, stop, 0, 1, 0, channels,
                                              OIIO::TypeDesc::FLOAT, strip_.data())
                          : file_->read_scanlines(0, 0, begin, stop, 0, 0, channels, OIIO::TypeDesc::FLOAT, strip_.data());
    if (!good) {
      strip_begin_ = strip_end_ = native.y;
      errorfmt("{}", file_->geterror());
      return false;
    }
    strip_begin_ = begin;
    strip_end_ = stop;
    decoder_(strip_.data(), size_t(native.width) * size_t(stop - begin) * size_t(channels));
    return true;
  }

  std::unique_ptr<OIIO::ImageInput> file_;
  Decoder decoder_;
  std::vector<float> strip_;
  int strip_begin_ = 0, strip_end_ = 0;
};

}  // namespace

void check_transfer(const std::string& transfer) {
  if (transfer == automatic_transfer) return;
  std::vector<std::string> known = transfer_names();
  known.push_back(automatic_transfer);
  if (std::find(known.begin(), known.end(), transfer) == known.end())
    throw Error("unknown transfer function '" + transfer + "'" + suggestion(transfer, known));
}

OIIO::ImageInput* make_linear_input() { return new LinearInput; }

std::string linear_image_key(const std::string& path, const std::string& transfer) {
  std::error_code ignored;
  const auto changed = std::filesystem::last_write_time(path, ignored).time_since_epoch().count();
  return std::string("etendue") + separator + transfer + separator + std::to_string(changed) + separator + path;
}

LinearImage read_linear_image(const std::string& path, const std::string& transfer) {
  LinearInput input;
  OIIO::ImageSpec spec;
  const auto fail = [&](std::string reason) {
    while (!reason.empty() && (reason.back() == '\n' || reason.back() == ' ')) reason.pop_back();
    throw Error("cannot read '" + path + "': " + (reason.empty() ? "it is no image" : reason));
  };
  if (!input.open(linear_image_key(path, transfer), spec)) fail(input.geterror());
  LinearImage image;
  image.width = spec.width;
  image.height = spec.height;
  image.rgb.resize(size_t(spec.width) * size_t(spec.height) * 3);
  std::vector<float> row(size_t(spec.width) * size_t(spec.nchannels));
  for (int y = 0; y < spec.height; ++y) {
    if (!input.read_native_scanline(0, 0, spec.y + y, 0, row.data())) fail(input.geterror());
    float* out = image.rgb.data() + size_t(y) * size_t(spec.width) * 3;
    for (size_t x = 0; x < size_t(spec.width); ++x)
      for (size_t c = 0; c < 3; ++c) out[3 * x + c] = spec.nchannels == 3 ? row[3 * x + c] : row[x];
  }
  return image;
}

}  // namespace etendue
