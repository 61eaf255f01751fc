#include "plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "describe/html_text.h"

namespace etendue::comparing {

const std::string_view plot_style = R"(
.c0 { --c: #0072b2; } .c1 { --c: #d55e00; } .c2 { --c: #009e73; } .c3 { --c: #b5588f; } .c4 { --c: #a97400; } .c5 { --c: #3a8fc4; }
.c6 { --c: #6b6b6b; } .c7 { --c: #7a3b00; }
@media (prefers-color-scheme: dark) {
  .c0 { --c: #56b4e9; } .c1 { --c: #ff8a4a; } .c2 { --c: #3ecf9f; } .c3 { --c: #e6a0c8; } .c4 { --c: #e6b23c; } .c5 { --c: #8ad0ff; }
  .c6 { --c: #b0b0b0; } .c7 { --c: #d9a273; }
}
.plots { display: flex; flex-wrap: wrap; gap: 1rem; }
.plot { width: 30rem; max-width: 100%; height: auto; background: var(--panel); border-radius: .3rem; }
.plot text { fill: var(--ink); font: 11px system-ui, sans-serif; }
.plot .title { font-weight: 600; font-size: 12px; }
.plot .grid { stroke: var(--line); stroke-width: 1; }
.plot .frame { stroke: var(--quiet); fill: none; }
.plot .curve { fill: none; stroke: var(--c); stroke-width: 1.8; }
.plot .dashed { stroke-dasharray: 5 4; }
.plot .band { fill: var(--c); opacity: .18; }
.plot .mark, .legend .mark { fill: var(--c); }
.plot .line { stroke: var(--quiet); stroke-dasharray: 2 3; }
.legend { width: .9em; height: .9em; vertical-align: -.05em; margin-right: .3em; }
)";

namespace {

constexpr size_t colors = 8;
constexpr double width = 480, height = 330, left = 58, right = 14, top = 28, bottom = 42;

/// Each curve has a different shape of marks, so that curves can be distinguished without colour.
std::string mark(double x, double y, size_t color) {
  constexpr double r = 3.2;
  switch (color % 4) {
    case 0: return fmt::format("<circle class=\"mark\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>", x, y, r);
    case 1:
      return fmt::format("<rect class=\"mark\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\"/>", x - r, y - r, 2 * r,
                         2 * r);
    case 2:
      return fmt::format("<path class=\"mark\" d=\"M{:.1f} {:.1f}l{} {}h{}z\"/>", x, y - 1.2 * r, 1.2 * r, 2.1 * r, -2.4 * r);
    default:
      return fmt::format("<path class=\"mark\" d=\"M{:.1f} {:.1f}l{} {} {} {} {} {}z\"/>", x, y - 1.3 * r, 1.3 * r, 1.3 * r,
                         -1.3 * r, 1.3 * r, -1.3 * r, -1.3 * r);
  }
}

std::string tick_text(double v) {
  const double power = std::round(std::log10(v));
  if (v >= 0.01 && v < 9999) return fmt::format("{:g}", v);
  if (std::abs(v / std::pow(10, power) - 1) < 1e-9) return fmt::format("10<tspan dy=\"-4\" font-size=\"8\">{}</tspan>", power);
  return fmt::format("{:.0e}", v);
}

struct Scale {
  double low = 0, high = 0, from = 0, to = 0;
  double operator()(double v) const { return from + (to - from) * std::log(v / low) / std::log(high / low); }
};

Scale scale(const Plot& plot, std::vector<double> Series::* of, double from, double to) {
  Scale s{HUGE_VAL, 0, from, to};
  for (const Series& each : plot.series)
    for (size_t i = 0; i < each.x.size(); ++i) {
      const double v = (each.*of)[i];
      if (!(each.x[i] > 0) || !(each.y[i] > 0) || !std::isfinite(v)) continue;
      s.low = std::min(s.low, v);
      s.high = std::max(s.high, v);
    }
  if (!(s.high > 0)) s.low = 0.1, s.high = 10;
  const double margin = std::max(0.04 * std::log(s.high / s.low), 0.05);
  s.low *= std::exp(-margin);
  s.high *= std::exp(margin);
  return s;
}

std::string curve(const Series& s, const Scale& x, const Scale& y) {
  std::string line, upper, lower, marks;
  for (size_t i = 0; i < s.x.size(); ++i) {
    if (!(s.x[i] > 0) || !(s.y[i] > 0)) continue;
    const double px = x(s.x[i]);
    line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", px, y(s.y[i]));
    marks += mark(px, y(s.y[i]), s.color);
    if (i < s.low.size() && s.low[i] > 0) {
      upper += fmt::format("{}{:.1f} {:.1f}", upper.empty() ? "M" : "L", px, std::clamp(y(s.high[i]), top, height - bottom));
      lower = fmt::format("L{:.1f} {:.1f}", px, std::clamp(y(s.low[i]), top, height - bottom)) + lower;
    }
  }
  std::string text = fmt::format("<g class=\"c{}\">", s.color % colors);
  if (!upper.empty()) text += fmt::format("<path class=\"band\" d=\"{}{}z\"/>", upper, lower);
  text += fmt::format("<path class=\"curve{}\" d=\"{}\"/>{}<title>{}</title></g>\n", s.dashed ? " dashed" : "", line, marks,
                      escaped(s.name));
  return text;
}

}  // namespace

std::vector<double> ticks(double low, double high) {
  std::vector<double> list;
  const bool few = std::log10(high / low) < 2.5;
  for (int e = int(std::floor(std::log10(low))); e <= int(std::ceil(std::log10(high))); ++e)
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double v = factor * std::pow(10.0, e);
      if ((factor == 1 || few) && v >= low && v <= high) list.push_back(v);
    }
  return list;
}

std::string svg(const Plot& plot) {
  const Scale x = scale(plot, &Series::x, left, width - right), y = scale(plot, &Series::y, height - bottom, top);
  std::string text = fmt::format(
      "<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n<text class=\"title\" x=\"{}\" "
      "y=\"17\">{}</text>\n",
      width, height, escaped(plot.title), left, escaped(plot.title));
  for (const double v : ticks(x.low, x.high))
    text += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
        "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>\n",
        x(v), top, height - bottom, height - bottom + 14, tick_text(v));
  for (const double v : ticks(y.low, y.high))
    text += fmt::format(
        "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>"
        "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
        left, width - right, y(v), left - 5, y(v) + 4, tick_text(v));
  if (plot.x_line > x.low && plot.x_line < x.high)
    text += fmt::format("<line class=\"line\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>\n", x(plot.x_line), top,
                        height - bottom);
  text += fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", left, top, width - left - right,
                      height - top - bottom);
  for (const Series& s : plot.series) text += curve(s, x, y);
  text += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (left + width - right) / 2, height - 9,
                      escaped(plot.x_label));
  text += fmt::format("<text transform=\"translate(13 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n</svg>\n",
                      (top + height - bottom) / 2, escaped(plot.y_label));
  return text;
}

std::string legend_mark(size_t color) {
  return fmt::format("<svg class=\"legend c{}\" viewBox=\"0 0 10 10\" aria-hidden=\"true\">{}</svg>", color % colors,
                     mark(5, 5, color));
}

}  // namespace etendue::comparing
