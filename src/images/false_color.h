#pragma once
// Pictures whose colours stand for numbers, with a legend.

#include <string>
#include <vector>

#include "etendue/core/image.h"

namespace etendue {

/// Linear light's components are not meant here: R, G, B as they are displayed, 0 to 1, encoded in sRGB.
struct DisplayColor {
  double r = 0, g = 0, b = 0;
};

/// "viridis", "inferno", "turbo", "grey".
std::vector<std::string> color_map_names();
/// The colour of a position from 0 to 1; positions outside are moved to the ends. Throws Error for an unknown name.
DisplayColor color_of(const std::string& color_map, double position);

struct ColorScale {
  std::string color_map = "viridis", unit;
  double low = 0, high = 1;
  bool logarithmic = true;  ///< needs low > 0

  double position(double value) const;  ///< from 0 at `low` to 1 at `high`, unbounded
};

/// Numbers at which the legend has its marks: of the form 1, 2 or 5 times a power of ten, `most` at most.
std::vector<double> scale_marks(const ColorScale&, int most);

/// A picture of the values, width x height row by row from the top, with a legend at its right. Values that are not finite are
/// magenta.
Image false_color(const std::vector<double>& values, int width, int height, const ColorScale&);

/// The range that a logarithmic scale would show, from whole power of ten to whole power of ten: it contains all but the
/// largest and smallest thousandth of the positive values, and at most `decades` from the top. Throws Error if none is
/// positive.
ColorScale decades_of(const std::vector<double>& values, int decades);

}  // namespace etendue
