// Whether a picture for display came out all black, nearly all black or nearly all white.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene_warnings.h"

namespace etendue {
namespace {

constexpr double middle_grey = 0.18;  // relative to white

struct Shown {
  double brightest = 0;  ///< the largest of R, G and B of the lit pixels
  double lit = 0;        ///< fraction of pixels with any light at all
  double black = 0,
         white = 0;   ///< fractions of the lit pixels that are shown as black, or with R, G and B all at their maximum
  double median = 0;  ///< luminance Y of the lit pixels
};

Shown shown(const Image& radiance, const Image& display) {
  Shown s;
  std::vector<double> y;
  size_t black = 0, white = 0;
  const size_t stride = radiance.channels.size(), channels = display.channels.size();
  for (size_t i = 0; i < size_t(radiance.width) * size_t(radiance.height); ++i) {
    const double light = radiance.values[i * stride + 1];
    if (!(light > 0) || !std::isfinite(light)) continue;
    y.push_back(light);
    const double* rgb = &display.values[i * channels];
    s.brightest = std::max({s.brightest, rgb[0], rgb[1], rgb[2]});
    black += std::max({rgb[0], rgb[1], rgb[2]}) < 1.5 / 255;
    white += std::min({rgb[0], rgb[1], rgb[2]}) >= 1 - 0.5 / 255;
  }
  if (y.empty()) return s;
  const double n = double(y.size());
  s.lit = n / (double(radiance.width) * radiance.height);
  s.black = double(black) / n;
  s.white = double(white) / n;
  const auto middle = y.begin() + std::ptrdiff_t(y.size() / 2);
  std::nth_element(y.begin(), middle, y.end());
  s.median = *middle;
  return s;
}

}  // namespace

std::vector<SceneWarning> picture_warnings(const Job& job, const std::vector<Ref<Output>>& outputs, const Image& radiance) {
  std::vector<SceneWarning> list;
  if (!shows_light(*job.renderer)) return list;
  if (radiance.channels.size() < 3) return list;
  const bool any = std::any_of(radiance.values.begin(), radiance.values.end(), [](double v) { return v > 0; });
  if (!any) {
    list.push_back(
        {"black picture",
         "the picture is black: no light reached the camera; 'etendue check' lists the light that a renderer cannot find",
         job.location_of("renderer")});
    return list;
  }
  for (const Ref<Output>& output : outputs) {
    const ToneMap* tone = output->tone_map ? output->tone_map.get() : job.tone_map.get();
    if (!output->for_display() || !tone) continue;
    const Shown s = shown(radiance, tone->apply(radiance));
    const Location at = output->tone_map ? output->location_of("tone_map") : job.location_of("tone_map");
    if (constexpr double least_shown = 1.0 / 255; s.median > 0 && s.brightest < least_shown) {
      list.push_back({"black picture",
                      fmt::format("the picture is black: no pixel of {} reaches 1/255; the median luminance of the lit pixels, "
                                  "{:.3g}, becomes middle grey with 'tone_map: ExposureToneMap {{ stops: {:.1f} }}'",
                                  output->class_info().name, s.median, std::log2(middle_grey / s.median)),
                      at});
      break;
    }
    constexpr double most = 0.9;
    const bool dark = s.black >= most, bright = s.white >= most;
    // An image of a few lit pixels on a black background, such as a starry sky, is not reported.
    if (!(s.median > 0) || s.lit < 0.05 || (!dark && !bright)) continue;
    const double stops = std::log2(middle_grey / s.median);
    const double factor = dark ? middle_grey / s.median : s.median / middle_grey;
    list.push_back(
        {"tone",
         fmt::format("{:.0f} % of the lit pixels are {} in {}: the median luminance, {:.3g}, is {:.3g} times {} middle "
                     "grey; 'tone_map: ExposureToneMap {{ stops: {:.1f} }}' maps it to middle grey",
                     100 * (dark ? s.black : s.white), dark ? "black" : "white", output->class_info().name, s.median, factor,
                     dark ? "darker than" : "as bright as", stops),
         at});
    break;
  }
  return list;
}

}  // namespace etendue
