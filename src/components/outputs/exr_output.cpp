#include <cmath>

#include "encoded_image.h"
#include "etendue/describe/color.h"
#include "etendue/film/image_tools.h"
#include "etendue/output.h"
#include "film/image_bands.h"

namespace etendue {
namespace {

class ExrOutput final : public Output {
  enum class Precision : std::uint8_t { half, single };
  Precision precision = Precision::single;
  std::string color_space = "srgb";
  bool layers = true;

 public:
  static void describe(Description<ExrOutput>& d) {
    d.summary(
         "OpenEXR: linear values without bounds, the film's layers (light groups as light.NAME.R, .G, .B, light path "
         "expressions as path.NAME.R, Stokes vectors as S1.R, …; the bands of a SpectralFilm as S0.405nm, …), and what is "
         "known "
         "of the picture as attributes. The "
         "encoding of a tone map is undone, as the format holds linear values by definition.",
         "Kainz, Bogart & Hess 2004, The OpenEXR image file format; Fichet, Pacanowski & Wilkie 2021, An OpenEXR layout for "
         "spectral "
         "images")
        .member<&ExrOutput::precision>("precision", "", "of the colours: 16 or 32 bits", choices("half", "float"),
                                       Effect::retone)
        .member<&ExrOutput::color_space>("color_space", "", "the RGB space the colours are written in, or xyz", Effect::retone,
                                         rgb_space_names())
        .member<&ExrOutput::layers>("layers", "", "whether the film's layers are written as well", Effect::retone);
  }
  void prepare() override { require_image_library(); }
  std::string extension() const override { return ".exr"; }
  bool for_display() const override { return false; }

  void write_image(const Image& given, const std::string& path) const override {
    Image image = convert_color_space(given, color_space);
    convert_parts(image, rgb_space(color_space));
    std::vector<size_t> kept;
    for (size_t c = 0; c < image.channels.size(); ++c)
      if (layers || image.channels[c].find('.') == std::string::npos) kept.push_back(c);

    std::vector<ImageHeader::Channel> channels;
    for (const size_t c : kept) {
      // A half represents integers only up to 2048 and lengths to three digits, so layers are written in single precision.
      const bool color = image.channels[c].find('.') == std::string::npos;
      channels.push_back({image.channels[c], precision == Precision::half && color ? NumberType::half : NumberType::single});
    }
    ImageHeader header(image.width, image.height, std::move(channels));
    const RgbSpace& space = rgb_space(color_space);
    header.chromaticities.emplace();
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 2; ++j) (*header.chromaticities)[2 * i + j] = float(space.primaries[i][j]);
    for (size_t j = 0; j < 2; ++j) (*header.chromaticities)[6 + j] = float(space.white[j]);
    header.texts = image.metadata;
    state_layout(header);
    place(header, image);

    std::vector<float> values(size_t(image.width) * size_t(image.height) * kept.size());
    size_t over = 0, at = 0;
    for (size_t i = 0; i < image.values.size(); i += image.channels.size())
      for (size_t k = 0; k < kept.size(); ++k) {
        const double v = image.values[i + kept[k]];
        const double limit = header.channels[k].type == NumberType::half ? 65504 : double(std::numeric_limits<float>::max());
        // Infinite values, such as an unknown variance, are intended and are written.
        const bool exceeds = std::isfinite(v) && std::abs(v) > limit;
        over += exceeds;
        values[at++] = float(exceeds ? std::copysign(limit, v) : v);
      }
    if (over > 0)
      warn("'" + path + "': " + std::to_string(over) + " values exceed what the chosen precision can hold and were limited");
    write_encoded(path, extension(), header, values);
  }

 private:
  /// The attributes that the layout for spectral images requires. The unit is the only one that the published reader accepts;
  /// the values are per nanometre.
  static void state_layout(ImageHeader& header) {
    const bool spectral = std::ranges::any_of(header.channels, [](const auto& c) {
      const std::optional<ImageBand> band = band_of_name(c.name);
      return band && band->kind == BandKind::emissive;
    });
    if (!spectral) return;
    header.texts["spectralLayoutVersion"] = "1.0";
    header.texts["emissiveUnits"] = "W.m^-2.sr^-1";
  }
  /// Converts light groups, layers by light path expression and Stokes vectors to the RGB space of the image, so that other
  /// programs can add them up.
  static void convert_parts(Image& image, const RgbSpace& space) {
    if (space.name == "xyz") return;
    const auto is = [&](size_t c, const char* end) {
      const std::string& name = image.channels[c];
      const bool stokes = name.size() == 4 && name[0] == 'S' && name[1] >= '1' && name[1] <= '3';
      return (name.starts_with("light.") || name.starts_with("path.") || stokes) && image.channels[c].ends_with(end);
    };
    for (size_t c = 0; c + 2 < image.channels.size(); ++c) {
      if (!is(c, ".X") || !is(c + 1, ".Y") || !is(c + 2, ".Z")) continue;
      for (size_t i = 0; i < 3; ++i) image.channels[c + i].back() = "RGB"[i];
      const auto& m = space.from_xyz;
      for (size_t at = c; at < image.values.size(); at += image.channels.size()) {
        const double xyz[3] = {image.values[at], image.values[at + 1], image.values[at + 2]};
        for (size_t i = 0; i < 3; ++i) image.values[at + i] = m[3 * i] * xyz[0] + m[3 * i + 1] * xyz[1] + m[3 * i + 2] * xyz[2];
      }
    }
  }
  /// Sets the position of a cropped image within the whole image.
  static void place(ImageHeader& header, const Image& image) {
    const auto number = [&](const char* key, int otherwise) {
      const auto found = image.metadata.find(key);
      return found == image.metadata.end() ? otherwise : std::atoi(found->second.c_str());
    };
    header.x = number("crop_x", 0);
    header.y = number("crop_y", 0);
    header.whole = {0, 0, number("full_width", image.width), number("full_height", image.height)};
    for (const char* key : {"crop_x", "crop_y", "full_width", "full_height"}) header.texts.erase(key);
  }
};

static const Register<ExrOutput> registered;

}  // namespace
}  // namespace etendue
