#pragma once
// Curves as SVG, for HTML pages.

#include <string>
#include <string_view>
#include <vector>

namespace etendue::comparing {

/// One curve; points that are not positive are omitted, as both scales are logarithmic.
struct Series {
  std::string name;
  std::vector<double> x, y;
  std::vector<double> low, high;  ///< the confidence band; empty: none
  size_t color = 0;               ///< index of the colour and of the shape of marks
  bool dashed = false;
};

/// Both scales are logarithmic.
struct Plot {
  std::string title, x_label, y_label;
  std::vector<Series> series;
  double x_line = 0;  ///< a vertical line; 0: none
};
std::string svg(const Plot&);

/// The CSS colours that `svg` uses, for light and dark pages: after Okabe & Ito 2008, which people with colour deficiencies can
/// distinguish.
extern const std::string_view plot_style;
/// The mark of a curve, for a legend.
std::string legend_mark(size_t color);

/// The tick values of a logarithmic scale from low to high: powers of ten, and 2 and 5 times those if there are few.
std::vector<double> ticks(double low, double high);

}  // namespace etendue::comparing
