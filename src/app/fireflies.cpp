// Lists the samples with the largest contributions.

#include "fireflies.h"

#include <fmt/format.h>

#include <cmath>

#include "check/replay/replay.h"

namespace etendue {

std::string fireflies_text(const Render& render, const std::string& picture_command) {
  const std::vector<LargeSample> largest = render.film().largest_samples();
  if (largest.empty()) return "All samples are black.\n";

  const Image picture = render.film().develop();
  const PixelArea& area = render.job().image->area();
  const std::string refusal = replay_refusal(render);
  std::string text = largest.size() == 1 ? "The brightest sample; " : fmt::format("The {} brightest samples; ", largest.size());
  if (!refusal.empty())
    text += fmt::format("no path can be shown ({}):\n", refusal);
  else
    text += largest.size() == 1 ? "to see its path:\n" : "to see the path of one:\n";
  for (const LargeSample& sample : largest) {
    const std::string which = refusal.empty() ? replay_command(picture_command, sample.x, sample.y, sample.sample) + "   "
                                              : fmt::format("pixel {},{}", sample.x, sample.y);
    text += fmt::format("  {} # Y {:.6g}", which, sample.luminance);
    // A light subpath's contribution is splatted into another pixel than the one of its sample index.
    const int x = sample.splat ? int(std::floor(sample.film.x)) : sample.x;
    const int y = sample.splat ? int(std::floor(sample.film.y)) : sample.y;
    if (sample.splat) text += fmt::format(" splatted at ({:.2f}, {:.2f})", sample.film.x, sample.film.y);
    if (area.contains(x, y)) {
      const double value = picture.at(x - area.x0, y - area.y0, 1);
      if (value > 0) text += fmt::format(", {:.4g} times its pixel's final value", sample.luminance / value);
    }
    text += "\n";
  }
  return text;
}

void report_fireflies(const Render& render, const std::string& picture_command, std::FILE* to) {
  fmt::print(to, "{}", fireflies_text(render, picture_command));
  std::fflush(to);
}

}  // namespace etendue
