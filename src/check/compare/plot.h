#pragma once
// Curves as SVG, for pages of HTML.

#include <string>
#include <string_view>
#include <vector>

namespace etendue::comparing {

/// One curve; points that are not positive cannot be shown on logarithmic scales and are left out.
struct Series {
  std::string name;
  std::vector<double> x, y;
  std::vector<double> low, high;  ///< the band around it; empty: none
  size_t color = 0;               ///< which of the page's colours, and which mark
  bool dashed = false;
};

/// Both scales are logarithmic.
struct Plot {
  std::string title, x_label, y_label;
  std::vector<Series> series;
  double x_line = 0;  ///< a vertical line; 0: none
};
std::string svg(const Plot&);

/// The colours that `svg` speaks of, for light and dark pages: after Okabe & Ito 2008, which people with colour deficiencies
/// can tell apart.
extern const std::string_view plot_style;
/// The sign of a curve, to stand beside its name elsewhere.
std::string legend_mark(size_t color);

/// Values that a logarithmic scale from low to high is marked at: powers of ten, and 2 and 5 times those where they are few.
std::vector<double> ticks(double low, double high);

}  // namespace etendue::comparing
