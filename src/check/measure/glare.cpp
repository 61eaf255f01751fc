// Glare of the sources i with the luminance L_i [cd/m2], the solid angle w_i [sr] and the position index P_i:
//
//   UGR = 8 log10( 0.25 / L_b * sum L_i^2 w_i / P_i^2 )                                        (CIE 117:1995, eq. 4.1)
//     with the background's luminance L_b = E_i / pi, where E_i is the illuminance on the plane of the eye without the
//     sources' own;
//   DGP = 5.87e-5 E_v + 9.18e-2 log10( 1 + sum L_i^2 w_i / (E_v^1.87 P_i^2) ) + 0.16
//     with the illuminance E_v of the eye from everything (Wienold & Christoffersen 2006, Evaluation methods and development
//     of a new glare prediction model for daylight environments with the use of CCD cameras, Energy and Buildings 38(7)).
//
// Position index above the line of sight (Guth 1963; as a formula in the IESNA Lighting Handbook):
//   ln P = (35.2 - 0.31889 t - 1.22 e^(-2 t / 9)) 1e-3 s + (21 + 0.26667 t - 0.002963 t^2) 1e-5 s^2
//   with the angle s [deg] from the line of sight and the angle t [deg] of the plane through both from the vertical.
// Below it (Iwata & Tokura 1997, Position index for a glare source located below the line of vision):
//   P = 1 + 0.8 R / D where R < 0.6 D, else 1 + 1.2 R / D, with the distance R from the line of sight in a plane across it at
//   the distance D, so R / D = tan(s). Beyond their data it stays as at R / D = 3. P is at most 16. Both bounds are those of
//   Radiance's evalglare, by which DGP is usually computed.

#include "glare.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "etendue/film/image_tools.h"
#include "geometry/equal_area_square.h"

namespace etendue::measure {
namespace {

constexpr double exact_pi = 3.14159265358979323846, degree = exact_pi / 180;

struct Direction {
  double x, y, z;  // to the right, upwards, forwards
};

/// A direction of the picture and the solid angle of a unit of the picture's area there.
struct Seen {
  Direction direction;
  double solid_angle;
};

/// What a point of the picture shows, u to the right and v downwards from 0 to 1; empty: nothing, as the corners of a fisheye.
std::optional<Seen> seen_at(double u, double v, const GlareOptions& options) {
  if (options.mapping == FisheyeMapping::equirectangular) {
    const double longitude = 2 * exact_pi * (u - 0.5), theta = exact_pi * v, sine = std::sin(theta);
    return Seen{{sine * std::sin(longitude), std::cos(theta), sine * std::cos(longitude)}, 2 * exact_pi * exact_pi * sine};
  }
  if (options.mapping == FisheyeMapping::equal_area) {
    const SquareDirection d = equal_area_direction({u, v});
    return Seen{{d.x, -d.y, d.z}, 4 * exact_pi};
  }
  // Polar coordinates in the picture, 1 at its edges: du dv = r dr dphi / 4.
  const double a = 2 * u - 1, b = 1 - 2 * v, r = std::hypot(a, b);
  if (!(r < 1)) return std::nullopt;
  if (options.mapping == FisheyeMapping::hemispherical) {
    const double cosine = std::sqrt((1 - r) * (1 + r));
    return Seen{{a, b, cosine}, 4 / cosine};
  }
  const double half = options.angle / 2 * degree, sine = std::sin(r * half);
  const double scale = r > 0 ? sine / r : half;
  return Seen{{scale * a, scale * b, std::cos(r * half)}, 4 * half * scale};
}

/// What the eye sees of a pixel.
struct PixelView {
  Direction sum{0, 0, 0};            // of its directions, weighted with solid angle
  double solid_angle = 0;            // in front of the eye [sr]
  double projected_solid_angle = 0;  // on the plane of the eye [sr]
};

/// The eye's coordinates in those of the picture.
struct Gaze {
  Direction right, up, forward;
};
Gaze gaze_of(const GlareOptions& options) {
  const double cy = std::cos(options.yaw * degree), sy = std::sin(options.yaw * degree);
  const double cp = std::cos(options.pitch * degree), sp = std::sin(options.pitch * degree);
  return {{cy, 0, -sy}, {-sy * sp, cp, -cy * sp}, {sy * cp, sp, cy * cp}};
}

double dot(const Direction& a, const Direction& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Integrates over a pixel by the middles of n x n parts.
PixelView view_of(int x, int y, const Image& image, const GlareOptions& options, const Gaze& gaze, int n) {
  PixelView view;
  const double area = 1 / (double(image.width) * double(image.height) * n * n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const std::optional<Seen> seen = seen_at((x + (i + 0.5) / n) / image.width, (y + (j + 0.5) / n) / image.height, options);
      if (!seen) continue;
      const double cosine = dot(seen->direction, gaze.forward), w = seen->solid_angle * area;
      if (!(cosine > 0)) continue;
      view.solid_angle += w;
      view.projected_solid_angle += w * cosine;
      view.sum.x += w * dot(seen->direction, gaze.right);
      view.sum.y += w * dot(seen->direction, gaze.up);
      view.sum.z += w * cosine;
    }
  return view;
}

void check_shape(const Image& image, const GlareOptions& options) {
  const bool wide = options.mapping == FisheyeMapping::equirectangular;
  if (image.width != (wide ? 2 : 1) * image.height)
    throw Error(fmt::format("a picture in {} mapping is {}; this one has {} x {} pixels",
                            wide ? "equirectangular" : "equal-area, angular or hemispherical",
                            wide ? "twice as wide as high" : "square", image.width, image.height));
  const bool whole = wide || options.mapping == FisheyeMapping::equal_area;
  if (!whole && (options.yaw != 0 || options.pitch != 0))
    throw Error("only a picture of the whole sphere, equirectangular or equal_area, can be seen in another direction");
}

std::vector<double> luminances_of(const Image& given, const GlareOptions& options) {
  const Image image = convert_color_space(given, "xyz");
  const size_t count = image.channels.size();
  const auto y = size_t(std::ranges::find(image.channels, "Y") - image.channels.begin());
  if (y == count) throw Error("the picture has no colours that have a luminance");
  const double scale = options.luminance_of > 0 ? options.luminance_of : 683 * observer_y_integral();
  std::vector<double> values(image.values.size() / count);
  for (size_t i = 0; i < values.size(); ++i) {
    values[i] = scale * image.values[i * count + y];
    if (!std::isfinite(values[i]))
      throw Error(fmt::format("the pixel {},{} is not finite", i % size_t(image.width), i / size_t(image.width)));
  }
  return values;
}

/// Sets of pixels that are merged (union by the smaller index, with paths halved).
class PixelSets {
 public:
  explicit PixelSets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), size_t(0)); }
  size_t find(size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void merge(size_t i, size_t j) {
    i = find(i), j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<size_t> parent_;
};

/// The neighbour of a pixel, across the edges of a picture where what it shows goes on at another edge; empty: there is none.
std::optional<size_t> neighbour(int x, int y, int width, int height, FisheyeMapping mapping) {
  if (mapping == FisheyeMapping::equirectangular) x = (x + width) % width;
  if (mapping == FisheyeMapping::equal_area) fold_equal_area(x, y, width);
  if (x < 0 || y < 0 || x >= width || y >= height) return std::nullopt;
  return size_t(y) * size_t(width) + size_t(x);
}

/// Merges pixels of the same class other than 0 that touch by a side or a corner.
PixelSets connected(const std::vector<std::uint8_t>& classes, int width, int height, FisheyeMapping mapping) {
  PixelSets sets(classes.size());
  for (size_t i = 0; i < classes.size(); ++i) {
    if (classes[i] == 0) continue;
    const int x = int(i % size_t(width)), y = int(i / size_t(width));
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (const auto j = neighbour(x + dx, y + dy, width, height, mapping); j && classes[*j] == classes[i]) sets.merge(i, *j);
  }
  if (mapping != FisheyeMapping::equirectangular) return sets;
  // All pixels of the first row touch at the pole, and those of the last.
  for (const int y : {0, height - 1}) {
    std::array<std::optional<size_t>, 3> first;
    for (int x = 0; x < width; ++x) {
      const size_t i = size_t(y) * size_t(width) + size_t(x);
      if (classes[i] == 0) continue;
      if (first[classes[i]]) sets.merge(*first[classes[i]], i);
      first[classes[i]] = i;
    }
  }
  return sets;
}

/// In the pixels at a peak's edge it is mixed with what is around, by the film's filter. Where nothing but such an edge is
/// above the threshold, it is no source of its own but belongs to the peak: sets of the class 1 whose pixels all lie within two
/// pixels of a peak become class 2.
void join_edges_to_peaks(std::vector<std::uint8_t>& classes, int width, int height, FisheyeMapping mapping) {
  if (std::ranges::find(classes, 2) == classes.end()) return;
  PixelSets sets = connected(classes, width, height, mapping);
  std::vector<std::uint8_t> reaches_further(classes.size());
  const auto near_peak = [&](int x, int y) {
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        // In steps of one pixel, as the edges of an equal-area picture are crossed.
        const auto half = neighbour(x + dx / 2, y + dy / 2, width, height, mapping);
        if (!half) continue;
        const int hx = int(*half % size_t(width)), hy = int(*half / size_t(width));
        const auto j = neighbour(hx + dx - dx / 2, hy + dy - dy / 2, width, height, mapping);
        if (j && classes[*j] == 2) return true;
      }
    return false;
  };
  for (size_t i = 0; i < classes.size(); ++i)
    if (classes[i] == 1 && !near_peak(int(i % size_t(width)), int(i / size_t(width)))) reaches_further[sets.find(i)] = 1;
  for (size_t i = 0; i < classes.size(); ++i)
    if (classes[i] == 1 && reaches_further[sets.find(i)] == 0) classes[i] = 2;
}

/// Sums over a source's pixels, turned into what a source is.
struct SourceSums {
  GlareSource source;
  Direction light{0, 0, 0};
};

GlareSource finished(const SourceSums& sums) {
  GlareSource s = sums.source;
  s.luminance /= s.solid_angle;
  s.azimuth = std::atan2(sums.light.x, sums.light.z) / degree;
  s.elevation = std::atan2(sums.light.y, std::hypot(sums.light.x, sums.light.z)) / degree;
  s.position_index = position_index(s.azimuth, s.elevation);
  return s;
}

/// Its share in the sums of UGR and DGP.
double weight(const GlareSource& s) {
  return s.luminance * s.luminance * s.solid_angle / (s.position_index * s.position_index);
}

void add_notes(Glare& g) {
  if (g.covered < 0.99 * 2 * exact_pi)
    g.notes.push_back(fmt::format(
        "the picture covers {:.3g} of the 2 pi sr in front of the eye; light from elsewhere is missing", g.covered));
  if (!(g.illuminance > 380) || g.dgp < 0.2 || g.dgp > 0.8)
    g.notes.emplace_back("DGP was fitted for values of 0.2 to 0.8 and more than 380 lx at the eye");
  const auto fits = [](const GlareSource& s) { return s.solid_angle >= 0.0003 && s.solid_angle <= 0.1; };
  if (!std::ranges::all_of(g.sources, fits)) g.notes.emplace_back("UGR is defined for sources of 0.0003 to 0.1 sr");
  const auto few = [](const GlareSource& s) { return s.pixels < 10; };
  if (const auto count = std::ranges::count_if(g.sources, few); count > 0)
    g.notes.push_back(
        fmt::format("{} of the sources have less than 10 pixels: noise, or small lamps in too small a picture", count));
}

}  // namespace

double position_index(double azimuth, double elevation) {
  const double x = std::sin(azimuth * degree) * std::cos(elevation * degree), y = std::sin(elevation * degree);
  const double z = std::cos(azimuth * degree) * std::cos(elevation * degree), across = std::hypot(x, y);
  double index = 0;
  if (y < 0) {
    const double ratio = z > 0 ? std::min(across / z, 3.0) : 3.0;
    index = 1 + (ratio < 0.6 ? 0.8 : 1.2) * ratio;
  } else {
    const double s = std::atan2(across, z) / degree, t = std::atan2(std::abs(x), y) / degree;
    index = std::exp((35.2 - 0.31889 * t - 1.22 * std::exp(-2 * t / 9)) * 1e-3 * s +
                     (21 + 0.26667 * t - 0.002963 * t * t) * 1e-5 * s * s);
  }
  return std::min(index, 16.0);
}

Glare glare_of(const Image& image, const GlareOptions& options) {
  check_shape(image, options);
  const std::vector<double> luminance = luminances_of(image, options);
  const Gaze gaze = gaze_of(options);
  const int parts = luminance.size() > 2'000'000 ? 1 : 4;
  Glare g;
  std::vector<PixelView> views(luminance.size());
  double sum = 0;
  for (size_t i = 0; i < views.size(); ++i) {
    views[i] = view_of(int(i % size_t(image.width)), int(i / size_t(image.width)), image, options, gaze, parts);
    g.covered += views[i].solid_angle;
    g.illuminance += luminance[i] * views[i].projected_solid_angle;
    sum += luminance[i] * views[i].solid_angle;
  }
  if (!(sum > 0) || !(g.illuminance > 0)) throw Error("what the picture shows in front of the eye is black");
  g.mean = sum / g.covered;
  g.threshold = options.threshold > 0 ? options.threshold : options.factor * g.mean;

  std::vector<std::uint8_t> classes(views.size());  // 1: above the threshold, 2: a peak
  for (size_t i = 0; i < views.size(); ++i)
    if (views[i].solid_angle > 0 && luminance[i] >= g.threshold)
      classes[i] = options.peak > g.threshold && luminance[i] >= options.peak ? 2 : 1;
  join_edges_to_peaks(classes, image.width, image.height, options.mapping);
  PixelSets sets = connected(classes, image.width, image.height, options.mapping);
  std::vector<SourceSums> sums;
  std::vector<size_t> number(views.size());  // of the source, from 1, at a set's first pixel
  double own = 0;                            // illuminance of all sources
  for (size_t i = 0; i < views.size(); ++i) {
    if (classes[i] == 0) continue;
    size_t& n = number[sets.find(i)];
    if (n == 0) {
      sums.emplace_back();
      n = sums.size();
    }
    SourceSums& s = sums[n - 1];
    ++s.source.pixels;
    s.source.luminance += luminance[i] * views[i].solid_angle;
    s.source.maximum = std::max(s.source.maximum, luminance[i]);
    s.source.solid_angle += views[i].solid_angle;
    s.source.illuminance += luminance[i] * views[i].projected_solid_angle;
    s.light.x += luminance[i] * views[i].sum.x;
    s.light.y += luminance[i] * views[i].sum.y;
    s.light.z += luminance[i] * views[i].sum.z;
    own += luminance[i] * views[i].projected_solid_angle;
  }
  double total = 0;
  for (const SourceSums& s : sums) {
    g.sources.push_back(finished(s));
    total += weight(g.sources.back());
  }
  std::ranges::sort(g.sources, std::ranges::greater(), weight);
  // Without background, what is left of it are rounding errors.
  const double rest = g.illuminance - own;
  g.background = rest > 1e-12 * g.illuminance ? rest / exact_pi : 0;
  g.ugr = 8 * std::log10(0.25 * total / g.background);
  if (g.sources.empty()) g.ugr = -std::numeric_limits<double>::infinity();
  g.dgp = 5.87e-5 * g.illuminance + 9.18e-2 * std::log10(1 + total / std::pow(g.illuminance, 1.87)) + 0.16;
  add_notes(g);
  return g;
}

std::string glare_text(const Glare& g) {
  std::string text;
  if (g.sources.empty())
    text += "UGR                  none: no source\n";
  else if (std::isinf(g.ugr))
    text += "UGR                  not defined: the background is black\n";
  else
    text += fmt::format("UGR                  {:.2f}\n", g.ugr);
  text += fmt::format("DGP                  {:.4f}\n", g.dgp);
  text += fmt::format("illuminance          {:.6g} lx   (on the plane of the eye)\n", g.illuminance);
  text += fmt::format("background           {:.6g} cd/m2\n", g.background);
  text += fmt::format("mean luminance       {:.6g} cd/m2\n", g.mean);
  text += fmt::format("threshold            {:.6g} cd/m2\n", g.threshold);
  if (!g.sources.empty())
    text +=
        "\nsource  luminance [cd/m2]     maximum  solid angle [sr]  illuminance [lx]  azimuth [deg]  elevation [deg]  "
        "position index  pixels\n";
  for (size_t i = 0; i < g.sources.size(); ++i) {
    const GlareSource& s = g.sources[i];
    text +=
        fmt::format("{:>6}  {:>17.6g}  {:>10.6g}  {:>16.6g}  {:>16.6g}  {:>13.2f}  {:>15.2f}  {:>14.3f}  {:>6}\n", i + 1,
                    s.luminance, s.maximum, s.solid_angle, s.illuminance, s.azimuth, s.elevation, s.position_index, s.pixels);
  }
  if (!g.notes.empty()) text += "\n";
  for (const std::string& note : g.notes) text += "note: " + note + "\n";
  return text;
}

std::string glare_json(const Glare& g) {
  using Json = nlohmann::ordered_json;
  Json sources = Json::array();
  for (const GlareSource& s : g.sources)
    sources.push_back({{"luminance", s.luminance},
                       {"maximum", s.maximum},
                       {"solid_angle", s.solid_angle},
                       {"illuminance", s.illuminance},
                       {"azimuth", s.azimuth},
                       {"elevation", s.elevation},
                       {"position_index", s.position_index},
                       {"pixels", s.pixels}});
  const Json json = {{"ugr", std::isfinite(g.ugr) ? Json(g.ugr) : Json()},  // null: not defined
                     {"dgp", g.dgp},
                     {"illuminance", g.illuminance},
                     {"background", g.background},
                     {"mean", g.mean},
                     {"threshold", g.threshold},
                     {"covered", g.covered},
                     {"sources", sources},
                     {"notes", g.notes}};
  return json.dump(2) + "\n";
}

}  // namespace etendue::measure
