#include <fmt/format.h>

#include <cstring>

#include "etendue/film/image_tools.h"
#include "etendue/output.h"
#include "files/whole_file.h"

namespace etendue {
namespace {

class NpyOutput final : public Output {
  bool layers = false;

 public:
  static void describe(Description<NpyOutput>& d) {
    d.summary(
         "The film's own numbers, nothing lost: a NumPy array of doubles, shape (height, width, 3), of X, Y, Z. A tone "
         "mapped picture is turned back into linear X, Y, Z.",
         "NumPy enhancement proposal 1, the .npy format, version 1.0")
        .member<&NpyOutput::layers>("layers", "", "whether the film's layers follow as further values of each pixel",
                                    Effect::retone);
  }
  std::string extension() const override { return ".npy"; }
  bool for_display() const override { return false; }

  void write_image(const Image& given, const std::string& path) const override {
    const Image image = convert_color_space(given, "xyz");
    std::vector<size_t> kept;
    for (const char* name : {"X", "Y", "Z"})
      kept.push_back(size_t(std::find(image.channels.begin(), image.channels.end(), name) - image.channels.begin()));
    for (size_t c = 0; layers && c < image.channels.size(); ++c)
      if (image.channels[c].find('.') != std::string::npos) kept.push_back(c);

    // Magic number, version, length of the text, and the text, padded so that the numbers begin at a multiple of 64 bytes.
    std::string text = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}, {}), }}", image.height,
                                   image.width, kept.size());
    const size_t header = (10 + text.size() + 1 + 63) / 64 * 64;
    text.resize(header - 10 - 1, ' ');
    text += '\n';
    std::vector<char> bytes = {'\x93', 'N', 'U', 'M', 'P', 'Y', 1, 0, char(text.size() & 255), char(text.size() >> 8)};
    bytes.insert(bytes.end(), text.begin(), text.end());

    static_assert(std::endian::native == std::endian::little, "the numbers are written as they lie in memory");
    bytes.resize(header + sizeof(double) * kept.size() * size_t(image.width) * size_t(image.height));
    char* to = bytes.data() + header;
    for (size_t i = 0; i < image.values.size(); i += image.channels.size())
      for (const size_t c : kept) {
        std::memcpy(to, &image.values[i + c], sizeof(double));
        to += sizeof(double);
      }
    write_whole_file(path, bytes.data(), bytes.size());
  }
};

static const Register<NpyOutput> registered;

}  // namespace
}  // namespace etendue
