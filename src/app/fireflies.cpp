// The samples that brought most light.

#include "fireflies.h"

#include <fmt/format.h>

#include <cmath>

#include "check/replay/replay.h"

namespace etendue {

std::string fireflies_text(const Render& render, const std::string& picture_command) {
  const std::vector<LargeSample> largest = render.film().largest_samples();
  if (largest.empty()) return "No sample brought any light.\n";

  const Image picture = render.film().develop();
  const PixelArea& area = render.job().image->area();
  std::string text = largest.size() == 1
                         ? "The sample that brought most light; to see its path:\n"
                         : fmt::format("The {} samples that brought most light; to see the path of one:\n", largest.size());
  for (const LargeSample& sample : largest) {
    text +=
        fmt::format("  {}    # Y {:.6g}", replay_command(picture_command, sample.x, sample.y, sample.sample), sample.luminance);
    // Light of a path from a luminaire falls into another pixel than its own.
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
