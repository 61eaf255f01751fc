#pragma once
// Pictures, parts of them and maps for the report.

#include "analysis.h"
#include "etendue/tone_map.h"

namespace etendue::comparing {

/// 8-bit sRGB.
struct Shown {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;
  Shown part(const PixelArea&) const;
  std::string uri() const;
};

/// Pictures as a tone map shows them: all with one exposure, as if they were one.
std::vector<Shown> show_alike(const ToneMap&, const std::vector<std::vector<double>>& pictures, int width, int height);

/// Parts of the picture in which the errors of the variants differ most, which do not overlap.
std::vector<PixelArea> most_different(const SceneImages&, const SceneResult&, size_t count);

/// Where the first run of each variant is brighter (red) or darker (blue) than the reference, relative to it, all on one scale
/// that is at its end at `full`: two in a hundred of all pixels are beyond.
struct DifferenceMaps {
  double full = 0;
  std::vector<Shown> maps;
};
DifferenceMaps difference_maps(const SceneImages&, const SceneResult&);

/// The variance of Y that one second of the processor leaves in each pixel, all on one logarithmic scale.
struct VarianceMaps {
  double low = 0, high = 0;
  std::vector<Shown> maps;
};
VarianceMaps variance_maps(const SceneImages&, const SceneResult&);
/// The colour of a place on that scale, from 0 to 1.
std::array<unsigned char, 3> scale_color(double t);

}  // namespace etendue::comparing
