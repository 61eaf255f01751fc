// Checks of every tone map: an image of any numbers becomes displayable, black stays black, grey stays grey, and more light is
// never shown darker.

#include "etendue/tone_map.h"

#include <fmt/format.h>

#include "conformance.h"
#include "etendue/describe/color.h"
#include "etendue/exposed_tone_map.h"

namespace etendue::conform {
namespace {

Image picture(int width, int height) {
  Image image(width, height, {"X", "Y", "Z"});
  image.metadata["color_space"] = "xyz";
  return image;
}

/// Sets a pixel to the white of the tone map's colour space times a factor.
void set_grey(Image& image, size_t pixel, const RgbSpace& space, double value) {
  for (size_t c = 0; c < 3; ++c)
    image.values[3 * pixel + c] = value * (space.to_xyz[3 * c] + space.to_xyz[3 * c + 1] + space.to_xyz[3 * c + 2]);
}

class ToneMapTrial {
 public:
  ToneMapTrial(Trial& t, ToneMap& map) : trial(t), map_(map), space_(rgb_space(map.color_space)) {}

  void check() {
    check_form();
    check_any_numbers();
    check_greys();
    check_one_value();
    check_places();
    if (auto* exposed = dynamic_cast<ExposedToneMap*>(&map_)) check_exposure(*exposed);
  }

 private:
  /// Colours of all kinds with positive XYZ, with scales from 1e-3 to 1e3.
  Image colors(int width, int height) {
    Image image = picture(width, height);
    for (size_t i = 0; i < image.values.size(); i += 3) {
      const double scale = std::exp(double(lerp(trial.uniform(), -7, 7)));
      for (size_t c = 0; c < 3; ++c) image.values[i + c] = scale * double(lerp(trial.uniform(), 0.1f, 1));
    }
    return image;
  }

  bool displayable(double v) const { return map_.clips() ? v >= 0 && v <= 1 : std::isfinite(v); }

  /// Checks channel names, sizes and metadata; the input is unchanged; further channels and the order of channels have no
  /// effect.
  void check_form() {
    Image in = colors(5, 3);
    in.metadata["seed"] = "7";
    const Image before = in, out = map_.apply(in);
    trial.expect(in.values == before.values && in.metadata == before.metadata, "the picture given is left as it is");
    const auto text = [&](const char* key) { return out.metadata.contains(key) ? out.metadata.at(key) : ""; };
    trial.expect(out.width == 5 && out.height == 3 && out.channels == std::vector<std::string>{"R", "G", "B"} &&
                     out.values.size() == 45 && text("color_space") == map_.color_space && text("transfer") == map_.transfer &&
                     text("seed") == "7",
                 "the result is R G B of the same size, with its space, its transfer and the texts of the picture");
    trial.expect(map_.apply(in).values == out.values, "the same picture gives the same result");
    Image more(5, 3, {"layer.a", "Z", "Y", "X"});
    for (size_t i = 0; i < 15; ++i)
      for (size_t c = 0; c < 3; ++c) more.values[4 * i + 3 - c] = in.values[3 * i + c];
    trial.expect(map_.apply(more).values == out.values, "channels are found by their names");
  }

  void check_any_numbers() {
    constexpr double inf = std::numeric_limits<double>::infinity();
    const double odd[] = {0, -1, 1e-300, -1e-300, 1e300, -1e300, inf, -inf, std::nan(""), 5e-324};
    for (int i = trial.samples(40); i > 0; --i) {
      Image in = colors(1 + int(trial.random() % 12), 1 + int(trial.random() % 12));
      // Odd values among valid ones, or nothing but odd values.
      const float share = i % 4 == 0 ? 1 : trial.uniform();
      for (double& v : in.values)
        if (trial.uniform() < share) v = odd[trial.random() % std::size(odd)];
      const Image out = map_.apply(in);
      for (size_t k = 0; k < out.values.size() && map_.clips(); ++k)
        trial.expect(displayable(out.values[k]), "whatever a picture holds, what is shown lies in [0, 1]", [&] {
          return fmt::format("{} of X Y Z = {} {} {}", out.values[k], in.values[k / 3 * 3], in.values[k / 3 * 3 + 1],
                             in.values[k / 3 * 3 + 2]);
        });
    }
    const Image good = map_.apply(colors(16, 16));
    for (const double v : good.values)
      trial.expect(displayable(v), "what is shown of a right picture is finite, and in [0, 1] if the map clips",
                   [&] { return fmt::format("{}", v); });
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 4}}) {
      const Image out = map_.apply(picture(width, height));
      for (const double v : out.values)
        trial.expect(v == 0, "a black picture stays black", [&] { return fmt::format("{}", v); });
    }
  }

  /// Greys from black to very bright in one image.
  void check_greys() {
    constexpr int count = 256;
    for (const double brightest : {0.01, 1.0, 1e4}) {
      Image in = picture(16, count / 16);
      for (int i = 1; i < count; ++i) set_grey(in, size_t(i), space_, brightest * std::exp2(0.08 * (i - count + 1)));
      const Image out = map_.apply(in);
      trial.expect(out.values[0] == 0, "a black pixel stays black", [&] { return fmt::format("{}", out.values[0]); });
      double last = 0;
      for (int i = 0; i < count; ++i) {
        const double* v = &out.values[3 * size_t(i)];
        const auto detail = [&] {
          return fmt::format("{}: {} {} {} after {}", in.values[3 * size_t(i) + 1], v[0], v[1], v[2], last);
        };
        const double tolerance = 1e-5 * (1 + std::abs(v[1]));
        trial.expect(std::abs(v[0] - v[1]) < tolerance && std::abs(v[2] - v[1]) < tolerance, "greys stay grey", detail);
        if (!map_.local()) trial.expect(v[1] >= last - 1e-9, "what is brighter is not shown darker", detail);
        last = v[1];
      }
    }
  }

  /// Images of one uniform value, of one pixel and of several.
  void check_one_value() {
    double last[2] = {0, 0};
    for (double value = 1e-6; value < 1e7; value *= 3)
      for (const int side : {1, 9}) {
        Image in = picture(side, side);
        for (size_t i = 0; i < size_t(side) * size_t(side); ++i) set_grey(in, i, space_, value);
        const Image out = map_.apply(in);
        double &before = last[side > 1], shown = out.values[1];
        const auto detail = [&] {
          return fmt::format("{} for {} of {} x {} pixels, {} for less", shown, value, side, side, before);
        };
        for (const double v : out.values)
          trial.expect(std::abs(v - shown) < 1e-5 * (1 + std::abs(shown)), "a picture of one grey is one", detail);
        trial.expect(displayable(shown) && shown >= before - 1e-5, "a brighter picture of one grey is not shown darker",
                     detail);
        before = shown;
      }
  }

  void check_places() {
    if (map_.local()) return;
    Image in = colors(12, 8);
    for (size_t i = 0; i < 48; ++i) std::copy_n(&in.values[3 * i], 3, &in.values[3 * (95 - i)]);
    const Image out = map_.apply(in);
    for (size_t i = 0; i < 48; ++i)
      for (size_t c = 0; c < 3; ++c)
        trial.expect(out.values[3 * i + c] == out.values[3 * (95 - i) + c],
                     "equal pixels are shown equal by a map that is not local",
                     [&] { return fmt::format("{} and {}", out.values[3 * i + c], out.values[3 * (95 - i) + c]); });
  }

  /// One stop less halves the radiance, and automatic exposure cancels a factor of the whole image.
  void check_exposure(ExposedToneMap& map) {
    const float stops = map.stops;
    const Image in = colors(9, 9);
    const auto scaled = [&](double factor) {
      Image image = in;
      for (double& v : image.values) v *= factor;
      return image;
    };
    const auto same = [&](const Image& a, const Image& b, const char* check) {
      for (size_t i = 0; i < a.values.size(); ++i)
        if (!trial.expect(std::abs(a.values[i] - b.values[i]) < 1e-6, check, [&] {
              return fmt::format("{} and {} of Y = {}", a.values[i], b.values[i], in.values[i / 3 * 3 + 1]);
            }))
          return;
    };
    if (map.exposure == ExposedToneMap::Exposure::fixed) {
      const Image half = map.apply(scaled(0.5));
      map.stops = stops - 1;
      same(map.apply(in), half, "an exposure of one stop less halves what goes in");
    } else {
      same(map.apply(scaled(0x1p-12)), map.apply(in), "automatic exposure makes up for the brightness of the whole");
      same(map.apply(scaled(1000)), map.apply(in), "automatic exposure makes up for the brightness of the whole");
    }
    map.stops = stops;
  }

  Trial& trial;
  ToneMap& map_;
  const RgbSpace& space_;
};

void check_tone_map(Trial& trial) { ToneMapTrial(trial, trial.part<ToneMap>()).check(); }

const RegisterCheck<ToneMap> registered(check_tone_map);

}  // namespace
}  // namespace etendue::conform
