#pragma once
// Images, crops of them and maps for the report.

#include "analysis.h"
#include "etendue/tone_map.h"

namespace etendue::comparing {

/// An 8-bit sRGB image.
struct Shown {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;
  Shown part(const PixelArea&) const;
  std::string uri() const;
};

/// Tone maps images as if they were one, so that all have the same exposure.
std::vector<Shown> show_alike(const ToneMap&, const std::vector<std::vector<double>>& pictures, int width, int height);

/// Parts of the image where the errors of the variants differ most; they do not overlap.
std::vector<PixelArea> most_different(const SceneImages&, const SceneResult&, size_t count);

/// Maps of where the first run of each variant is brighter (red) or darker (blue) than the reference, relative to it. All have
/// the same scale, which ends at `full`, the 98th percentile of the absolute differences.
struct DifferenceMaps {
  double full = 0;
  std::vector<Shown> maps;
};
DifferenceMaps difference_maps(const SceneImages&, const SceneResult&);

/// Maps of the variance of Y in each pixel after one second of processor time, all with one logarithmic scale.
struct VarianceMaps {
  double low = 0, high = 0;
  std::vector<Shown> maps;
};
VarianceMaps variance_maps(const SceneImages&, const SceneResult&);
/// The colour at a position from 0 to 1 on that scale.
std::array<unsigned char, 3> scale_color(double t);

}  // namespace etendue::comparing
