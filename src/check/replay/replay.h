#pragma once
// Recomputes samples of one pixel and reports their paths vertex by vertex: as text, or as JSON for other programs.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "etendue/render/render.h"

namespace etendue {

/// One sample, with the record of its path.
struct ReplayedPath {
  std::uint32_t sample = 0;
  Point2 film;
  PathRecord record;
  bool bad = false;             ///< not a finite non-negative spectrum: the film counts it as black
  double luminance = 0;         ///< Y of its contribution to its own pixel
  double splatted = 0;          ///< Y of its splats into the image, weighted relative to `luminance`
  std::optional<double> share;  ///< its fraction of the sum over all samples of the pixel; empty: unknown, or the sum is zero
};

/// Samples of a pixel.
struct PixelReplay {
  int x = 0, y = 0;
  std::uint32_t samples = 0;        ///< number of the pixel's samples in the image
  std::optional<double> luminance;  ///< mean Y of all samples; empty: not all were computed
  std::vector<ReplayedPath> paths;  ///< brightest first
};

/// Computes one sample as it is in the image.
PixelReplay replay_sample(const Render&, int x, int y, std::uint32_t sample);
/// Computes all samples of a pixel, and records the paths of the `most` brightest ones.
PixelReplay replay_pixel(const Render&, int x, int y, size_t most);

/// The reason, given by the renderer, why no sample of the render can be replayed; empty: samples can be replayed.
std::string replay_refusal(const Render&);

/// The report as text. `picture_command` is the command line that renders the image.
std::string replay_text(const PixelReplay&, const std::string& picture_command);
/// The report as JSON; docs/finding-fireflies.md describes it. `file` is the description's.
std::string replay_json(const Job&, const PixelReplay&, const std::string& file, const std::string& picture_command);

/// The weight of a splat relative to a sample's own value, which counts 1 / n of its pixel: light subpaths are splatted over
/// the whole film, but only n of them are traced for each rendered pixel.
double splat_weight(const ImageBuffer&);

/// The command that replays one sample alone.
std::string replay_command(const std::string& picture_command, int x, int y, std::uint32_t sample);

/// A replayed path as text.
std::string path_text(const PathRecord&, Point2 film);

}  // namespace etendue
