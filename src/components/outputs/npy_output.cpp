#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>

#include "etendue/film/image_tools.h"
#include "etendue/output.h"
#include "files/whole_file.h"
#include "film/image_bands.h"

namespace etendue {
namespace {

class NpyOutput final : public Output {
  bool layers = false, spectrum = false;

 public:
  static void describe(Description<NpyOutput>& d) {
    d.summary(
         "The film's own numbers, nothing lost: a NumPy array of doubles, shape (height, width, 3), of X, Y, Z. A tone "
         "mapped picture is turned back into linear X, Y, Z.",
         "NumPy enhancement proposal 1, the .npy format, version 1.0")
        .member<&NpyOutput::layers>("layers", "", "whether the film's layers follow as further values of each pixel",
                                    Effect::retone)
        .member<&NpyOutput::spectrum>("spectrum", "",
                                      "whether the bands of a SpectralFilm are written instead, shape (height, width, bands); "
                                      "the bands' edges [nm] are then written to a second file, NAME.edges.npy",
                                      Effect::retone);
  }
  std::string extension() const override { return ".npy"; }
  bool for_display() const override { return false; }

  void write_image(const Image& given, const std::string& path) const override {
    if (spectrum) {
      if (const std::vector<size_t> bands = spectral_channels(given); !bands.empty()) return write_spectrum(given, bands, path);
      // The picture is kept rather than lost after a long render.
      warn("'" + path +
           "' has X, Y, Z: the picture has no spectrum; the image is no SpectralFilm, or the picture was denoised");
    }
    const Image image = convert_color_space(given, "xyz");
    std::vector<size_t> kept;
    for (const char* name : {"X", "Y", "Z"})
      kept.push_back(size_t(std::find(image.channels.begin(), image.channels.end(), name) - image.channels.begin()));
    for (size_t c = 0; layers && c < image.channels.size(); ++c)
      if (image.channels[c].find('.') != std::string::npos) kept.push_back(c);

    write_array(path, {size_t(image.height), size_t(image.width), kept.size()}, image, kept);
  }

 private:
  static std::vector<size_t> spectral_channels(const Image& image) {
    std::vector<size_t> channels;
    for (const ImageBand& band : bands_of(image)) channels.push_back(band.channel);
    for (size_t c = 0; channels.empty() && c < image.channels.size(); ++c)
      if (measures_spectrum(image.channels[c])) channels.push_back(c);
    return channels;
  }

  /// The bands alone, and their edges in a file of their own.
  static void write_spectrum(const Image& image, const std::vector<size_t>& kept, const std::string& path) {
    write_array(path, {size_t(image.height), size_t(image.width), kept.size()}, image, kept);
    const std::vector<double> edges = band_edges_of(image);
    if (!edges.empty()) write_array(path.substr(0, path.rfind('.')) + ".edges.npy", {edges.size()}, edges);
  }

  static void write_array(const std::string& path, const std::vector<size_t>& shape, const Image& image,
                          const std::vector<size_t>& channels) {
    std::vector<double> values;
    values.reserve(shape[0] * shape[1] * shape[2]);
    for (size_t i = 0; i < image.values.size(); i += image.channels.size())
      for (const size_t c : channels) values.push_back(image.values[i + c]);
    write_array(path, shape, values);
  }

  static void write_array(const std::string& path, const std::vector<size_t>& shape, const std::vector<double>& values) {
    // Magic number, version, length of the text, and the text, padded so that the numbers begin at a multiple of 64 bytes.
    std::string text = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}{}), }}", fmt::join(shape, ", "),
                                   shape.size() == 1 ? "," : "");
    const size_t header = (10 + text.size() + 1 + 63) / 64 * 64;
    text.resize(header - 10 - 1, ' ');
    text += '\n';
    std::vector<char> bytes = {'\x93', 'N', 'U', 'M', 'P', 'Y', 1, 0, char(text.size() & 255), char(text.size() >> 8)};
    bytes.insert(bytes.end(), text.begin(), text.end());

    static_assert(std::endian::native == std::endian::little, "the numbers are written as they lie in memory");
    bytes.resize(header + sizeof(double) * values.size());
    std::memcpy(bytes.data() + header, values.data(), sizeof(double) * values.size());
    write_whole_file(path, bytes.data(), bytes.size());
  }
};

static const Register<NpyOutput> registered;

}  // namespace
}  // namespace etendue
