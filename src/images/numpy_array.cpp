#include "numpy_array.h"

#include <charconv>
#include <cstring>

#include "etendue/core/error.h"

namespace etendue {
namespace {

/// The text after a key of the header's dictionary, such as `'shape':`.
std::string_view after(std::string_view text, std::string_view key) {
  const size_t at = text.find(key);
  if (at == std::string_view::npos) throw Error("its header lacks " + std::string(key));
  text.remove_prefix(at + key.size());
  text.remove_prefix(std::min(text.find_first_not_of(": "), text.size()));
  return text;
}

}  // namespace

// NumPy enhancement proposal 1: "\x93NUMPY", two bytes of version, the header's length in two bytes (four from version 2
// on), the header as the text of a Python dictionary, the numbers.
NumpyArray parse_numpy_header(std::string_view bytes) {
  constexpr std::string_view magic = "\x93NUMPY";
  if (!bytes.starts_with(magic) || bytes.size() < 12) throw Error("it is not a NumPy array");
  const auto byte = [&](size_t i) { return size_t(static_cast<unsigned char>(bytes[i])); };
  const bool long_header = byte(6) >= 2;
  const size_t start = long_header ? 12 : 10;
  size_t length = byte(8) | byte(9) << 8;
  if (long_header) length |= byte(10) << 16 | byte(11) << 24;
  if (length > bytes.size() - start) throw Error("it ends within the header");
  const std::string_view text = bytes.substr(start, length), data = bytes.substr(start + length);

  const std::string_view type = after(text, "'descr'");
  const bool doubles = type.starts_with("'<f8'");
  if (!doubles && !type.starts_with("'<f4'")) throw Error("its numbers are neither float32 nor float64, little endian");
  if (!after(text, "'fortran_order'").starts_with("False")) throw Error("it is stored column by column");
  std::string_view shape = after(text, "'shape'");
  std::vector<size_t> sizes;
  shape.remove_prefix(std::min(shape.find('(') == std::string_view::npos ? shape.size() : shape.find('(') + 1, shape.size()));
  while (true) {
    shape.remove_prefix(std::min(shape.find_first_not_of(", "), shape.size()));
    size_t n = 0;
    const auto [end, code] = std::from_chars(shape.data(), shape.data() + shape.size(), n);
    if (code != std::errc()) break;
    sizes.push_back(n);
    shape.remove_prefix(size_t(end - shape.data()));
  }
  const size_t width = doubles ? 8 : 4;
  size_t room = NumpyArray::most_numbers;  // by division, as the product of the sizes may overflow
  for (const size_t n : sizes) {
    if (n == 0) throw Error("its shape is empty");
    if (n > room) throw Error("its shape is too large: at most 2^30 numbers are read");
    room /= n;
  }
  size_t needed = width;
  for (const size_t n : sizes) needed *= n;
  if (data.size() < needed) throw Error("it ends too early");
  if (data.size() > needed) throw Error("it is longer than its shape says");
  return {std::move(sizes), data, doubles};
}

double NumpyArray::operator[](size_t i) const {
  double number = 0;
  if (doubles) {
    std::memcpy(&number, data.data() + 8 * i, 8);
  } else {
    float f;
    std::memcpy(&f, data.data() + 4 * i, 4);
    number = double(f);
  }
  return number;
}

Image parse_numpy_array(std::string_view bytes) {
  const NumpyArray array = parse_numpy_header(bytes);
  std::vector<size_t> sizes = array.shape;
  if (sizes.size() == 2) sizes.push_back(1);
  if (sizes.size() != 3 || sizes[2] == 2)
    throw Error("its shape is not (height, width), (height, width, 1) or (height, width, 3 or more)");
  std::vector<std::string> channels;
  if (sizes[2] == 1) channels = {"Y"};
  for (size_t c = 0; sizes[2] > 1 && c < sizes[2]; ++c)
    channels.push_back(c < 3 ? std::string(1, char('X' + c)) : "channel." + std::to_string(c));
  Image image{int(sizes[1]), int(sizes[0]), std::move(channels)};
  for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = array[i];
  image.metadata["color_space"] = "xyz";
  return image;
}

}  // namespace etendue
