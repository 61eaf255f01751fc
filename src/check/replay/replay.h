#pragma once
// Samples of one pixel computed again, and told vertex by vertex: to people as text, to programs as JSON.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "etendue/render/render.h"

namespace etendue {

/// One sample, with all that its path did.
struct ReplayedPath {
  std::uint32_t sample = 0;
  Point2 film;
  PathRecord record;
  bool bad = false;             ///< not a finite non-negative spectrum: it counts as black
  double luminance = 0;         ///< Y of the radiance it brings to its own pixel
  double splatted = 0;          ///< Y of what it brings to places of the picture by splats, as it counts beside the above
  std::optional<double> share;  ///< of the light that all samples of the pixel bring there; empty: not known, or no light
};

/// Samples of a pixel.
struct PixelReplay {
  int x = 0, y = 0;
  std::uint32_t samples = 0;        ///< how many the pixel has in the picture
  std::optional<double> luminance;  ///< mean Y of all of them; empty: they were not all computed
  std::vector<ReplayedPath> paths;  ///< brightest first
};

/// One sample alone, as it is in the picture.
PixelReplay replay_sample(const Render&, int x, int y, std::uint32_t sample);
/// Computes all samples of a pixel and tells the paths of the `most` that bring most light.
PixelReplay replay_pixel(const Render&, int x, int y, size_t most);

/// Why no sample of the render can be replayed, as its renderer tells; empty: they can.
std::string replay_refusal(const Render&);

/// For people to read. `picture_command` is the command line that renders the picture.
std::string replay_text(const PixelReplay&, const std::string& picture_command);
/// For programs to read; docs/finding-fireflies.md describes it. `file` is the description's.
std::string replay_json(const Job&, const PixelReplay&, const std::string& file, const std::string& picture_command);

/// What a splat counts for beside a sample's own value, which counts 1 / n of its pixel: paths from luminaires spread over
/// the whole film, but there are only n of them for each pixel that is rendered.
double splat_weight(const ImageBuffer&);

/// The command that replays one sample alone.
std::string replay_command(const std::string& picture_command, int x, int y, std::uint32_t sample);

/// A replayed path for people to read.
std::string path_text(const PathRecord&, Point2 film);

}  // namespace etendue
