#include "etendue/tone_map.h"

#include "core/over_range.h"
#include "etendue/describe/color.h"
#include "tabulated.h"

namespace etendue {
void ToneMap::describe(Description<ToneMap>& d) {
  d.summary("From a picture in CIE XYZ without bounds to the RGB values a display or file takes.")
      .group("Encoding")
      .member<&ToneMap::color_space>("color_space", "", "primaries and white of the result: the name of an RGB space",
                                     Effect::retone, rgb_space_names())
      .member<&ToneMap::transfer>("transfer", "", "encoding of the result: srgb, linear, rec709 or gamma2.2", Effect::retone,
                                  transfer_names());
}

static const Register<ToneMap> registered;

Image ToneMap::apply(const Image& xyz) const {
  size_t from[3];
  for (size_t c = 0; c < 3; ++c) {
    const auto found = std::find(xyz.channels.begin(), xyz.channels.end(), std::string(1, char('X' + c)));
    if (found == xyz.channels.end()) throw Error("only a picture in X Y Z can be tone mapped");
    from[c] = size_t(found - xyz.channels.begin());
  }
  Image image(xyz.width, xyz.height, {"X", "Y", "Z"});
  const size_t pixels = size_t(xyz.width) * size_t(xyz.height), channels = xyz.channels.size();
  for (size_t i = 0; i < pixels; ++i)
    for (size_t c = 0; c < 3; ++c) image.values[3 * i + c] = xyz.values[i * channels + from[c]];

  image.metadata = xyz.metadata;
  map(image);

  const std::array<double, 9> m = rgb_space(color_space).from_xyz;
  const bool clip = clips(), encoded = transfer != "linear";
  const auto encode = [&](double value) { return encode_transfer(transfer, value); };
  // A value of 2^-30 is encoded as 0 even in 16 bits.
  const std::optional<Tabulated> table = clip && encoded ? std::optional<Tabulated>({-30, 0, encode}) : std::nullopt;
  over_range(pixels, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      double* v = &image.values[3 * i];
      const double x = v[0], y = v[1], z = v[2];
      for (size_t c = 0; c < 3; ++c) {
        double value = m[3 * c] * x + m[3 * c + 1] * y + m[3 * c + 2] * z;
        if (clip) value = value > 0 ? std::min(value, 1.0) : 0;  // NaN becomes 0
        v[c] = table ? (*table)(value) : encoded ? encode(value) : value;
      }
    }
  });
  image.channels = {"R", "G", "B"};
  image.metadata["color_space"] = color_space;
  image.metadata["transfer"] = transfer;
  return image;
}

}  // namespace etendue
