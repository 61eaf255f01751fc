// ImplicitSurface: the surface where a formula of x, y and z is 0.

#include "formula_field.h"

namespace etendue {
namespace {

// Along a ray, interval arithmetic bounds f and f' over a range of t. A range in which f cannot be 0 is discarded; a range in
// which f' cannot be 0 has at most one root, which is bracketed if the ends have different signs; other ranges are bisected
// (Mitchell 1990, "Robust ray intersection with interval arithmetic"; Duff 1992, "Interval arithmetic and recursive subdivision
// for implicit functions and constructive solid geometry"). A second bound of f uses its value in the middle and the bounds of
// f'.
//
// A formula may be so irregular that its bounds are useless. To limit the cost of a ray, at most `most_ranges` ranges are
// bisected in one search (typically some tens, or hundreds along silhouettes); the remaining ranges are then treated as
// shortest ones: only the signs at their ends are compared. A root found in this way is a crossing, but earlier ones may have
// been missed.
class ImplicitSurface final : public ImplicitObject {
 public:
  static void describe(Description<ImplicitSurface>& d) {
    d.summary(
         "The surface in a box where a formula of x, y and z is 0; the solid is where it is negative. By default a torus. "
         "Surface "
         "coordinates are those of the face of the box the surface faces most, from 0 to 1 as on a Box.",
         "Mitchell 1990, \"Robust ray intersection with interval arithmetic\"")
        .group("Shape")
        .member<&ImplicitSurface::formula>(
            "formula", "",
            "of numbers, x, y, z (in m, the object's own), pi, + - * / ( ) and functions (abs sqrt exp log sin cos tan atan2 "
            "floor "
            "fract mod pow min max step clamp mix smoothstep; angles in radians). pow takes negative numbers when its exponent "
            "is a whole number. What is not a finite number, such as 1 / 0, is 0",
            Effect::rebuild)
        .group("Box")
        .member<&ImplicitSurface::low>("low", "m", "the corner of the box with the lowest coordinates", Effect::rebuild)
        .member<&ImplicitSurface::high>("high", "m", "the corner with the highest", Effect::rebuild)
        .member<&ImplicitSurface::capped>(
            "capped", "", "whether the solid has faces where the box cuts it, and so is closed; else it is open there",
            Effect::rebuild)
        .member<&ImplicitSurface::tolerance>(
            "tolerance", "1",
            "parts of the solid, and gaps, may be missed where a ray is in them for less than this, in longest edges "
            "of the box; and thicker ones where a ray would take more than 16384 steps, of which there is a warning",
            range(1e-12, 1e-3), Effect::rebuild, logarithmic);
  }

  void prepare() override {
    // In a file, the formula starts after the quote; escape sequences would shift the column.
    const Location at = location_of("formula");
    const bool plain = at.known() && formula.find_first_of("\"\\\n\t") == std::string::npos;
    try {
      field_ = FormulaField(Formula(formula, {"x", "y", "z"}, "formula", plain ? at.column + 1 : 1));
    } catch (const Error& e) {
      const std::string what = "ImplicitSurface.formula: " + std::string(e.what());
      if (plain) throw Error(what, {at.file, at.line, e.location.column});
      throw Error(what + " (at character " + std::to_string(e.location.column) + " of the formula)", at);
    }
    shortest_ = tolerance * double(max_component(high - low));
    ranges_left_ = most_prepared;
    preparing_ = true;
    try {
      settle(low, high, capped, "formula");
    } catch (...) {
      preparing_ = false;
      throw;
    }
    preparing_ = false;
    warn_of_long_searches();
  }

  std::string formula = "pow(sqrt(x*x + y*y) - 0.65, 2) + z*z - 0.09";
  Point3 low{-1, -1, -1}, high{1, 1, 1};
  bool capped = true;
  double tolerance = 1e-6;

 protected:
  double field(const Place& x) const override { return field_.value(x); }

  Place gradient(const Place& x) const override {
    Place g = field_.gradient(x);
    const double norm = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
    if (norm > 0 && std::isfinite(norm)) return g;
    // Where the formula is discontinuous: central differences over a short distance.
    for (size_t k = 0; k < 3; ++k) {
      Place before = x, behind = x;
      before[k] -= shortest_;
      behind[k] += shortest_;
      g[k] = (field_.value(behind) - field_.value(before)) / (2 * shortest_);
    }
    return g;
  }

  bool next_crossing(const DoubleRay& r, double from, double to, bool& inside, double& t) const override {
    if ((value_at(r, from) < 0) != inside) {  // rounding moved the start across the surface
      inside = !inside;
      t = from;
      return true;
    }
    double speed = 0;
    for (const double d : r.direction) speed += d * d;
    // Preparation traces many lines, which share one limit of ranges.
    int ranges = preparing_ ? int(std::min<std::int64_t>(ranges_left_, most_ranges)) : most_ranges;
    const int allowed = ranges;
    const bool found = first_in({r, shortest_ / std::sqrt(speed), inside, ranges}, from, to, t);
    if (preparing_) ranges_left_ -= allowed - std::max(ranges, 0);
    if (!found) return false;
    inside = !inside;
    return true;
  }

  bool may_cross(const Place& from, const Place& to) const override {
    return field_.range({Interval(from[0], to[0]), Interval(from[1], to[1]), Interval(from[2], to[2])}).contains(0);
  }

 private:
  struct Search {
    const DoubleRay& ray;
    double shortest;  // shortest range of t
    bool inside;      // before the crossing
    int& ranges;      // number of ranges that may still be bisected
  };
  static constexpr int most_ranges = 1 << 14;
  static constexpr std::int64_t most_prepared = 1 << 22;  // limit during preparation, for all lines together

  /// Traces some lines through the box and warns if the search was cut short on any of them.
  void warn_of_long_searches() const {
    constexpr int lines = 64;
    int ended = 0;
    for (int i = 0; i < lines; ++i) {
      // Through or near the centre of the box, in uniformly distributed directions (a Fibonacci spiral).
      const double z = 1 - (2 * i + 1.0) / lines, r = std::sqrt(1 - z * z), phi = 2.399963229728653 * i;
      const double direction[3] = {r * std::cos(phi), r * std::sin(phi), z};
      Ray ray;
      double reach = infinity;
      for (int k = 0; k < 3; ++k) {
        const double half = 0.5 * (double(high[k]) - double(low[k]));
        ray.origin[k] = float(double(low[k]) + half * (1 + 0.3 * direction[(k + 1) % 3]));
        ray.direction[k] = float(direction[k]);
        reach = std::min(reach, 0.7 * half / std::max(std::abs(direction[k]), 1e-6));
      }
      const DoubleRay line(ray);
      int ranges = most_ranges;
      double t = 0;
      first_in({line, shortest_, value_at(line, 0) < 0, ranges}, 0, reach, t);
      ended += ranges <= 0;
    }
    if (ended > 0)
      warn("ImplicitSurface: " + std::to_string(ended) + " of " + std::to_string(lines) + " lines tried take more than " +
               std::to_string(most_ranges) + " steps and were not searched to the end: parts of the surface may be missed",
           location_of("formula"));
  }

  double value_at(const DoubleRay& r, double t) const { return field_.value({r.at(t, 0), r.at(t, 1), r.at(t, 2)}); }

  /// The first crossing in [from, to]; the start of the range is on the side `s.inside`.
  bool first_in(const Search& s, double from, double to, double& t) const {
    std::array<Interval, 3> box;
    for (int k = 0; k < 3; ++k) {
      const double a = s.ray.at(from, k), b = s.ray.at(to, k);
      box[size_t(k)] = Interval::around(std::min(a, b), std::max(a, b));
    }
    Interval slope;
    const Interval f = field_.range(box, s.ray.direction, slope);
    if (!f.contains(0)) return false;
    // f >= 0 in the whole range: all of it is outside. (A lower bound that is negative only by rounding counts as 0.)
    if (f.low > -1e-200) {
      if (s.inside) t = from;
      return s.inside;
    }
    const double middle = 0.5 * (from + to);
    if (!slope.contains(0) || to - from <= s.shortest || middle <= from || middle >= to || s.ranges <= 0) {
      if ((value_at(s.ray, to) < 0) == s.inside) return false;
      t = root(s, from, to);
      return true;
    }
    --s.ranges;
    const double half = 0.5 * (to - from), f_middle = value_at(s.ray, middle);
    const double reach = half * std::max(std::abs(slope.low), std::abs(slope.high)) * (1 + 1e-12);
    const double rounding = 1e-12 * std::max(std::abs(f.low), std::abs(f.high));
    if (std::abs(f_middle) > reach + rounding) return false;
    if (first_in(s, from, middle, t)) return true;
    if ((f_middle < 0) != s.inside) {  // a root that the first half missed by rounding
      t = middle;
      return true;
    }
    return first_in(s, middle, to, t);
  }

  /// The root between ends of different sign: the Illinois method (Dowell & Jarratt 1971), a secant method that halves the
  /// weight of an end which is retained, with bisection where it converges slowly, as at a discontinuity.
  double root(const Search& s, double left, double right) const {
    double f_left = value_at(s.ray, left), f_right = value_at(s.ray, right), width = right - left;
    int side = 0;
    for (int i = 0; i < 120; ++i) {
      if (right - left <= 4e-16 * std::max(std::abs(left), std::abs(right))) break;
      double t = (left * f_right - right * f_left) / (f_right - f_left);
      if (i % 3 == 2) {
        if (right - left > 0.5 * width) t = 0.5 * (left + right);
        width = right - left;
      }
      if (!(t > left && t < right)) t = 0.5 * (left + right);
      if (!(t > left && t < right)) break;
      const double f = value_at(s.ray, t);
      if (f == 0) return t;
      if ((f < 0) == s.inside) {
        left = t;
        f_left = f;
        if (side == 1) f_right *= 0.5;
        side = 1;
      } else {
        right = t;
        f_right = f;
        if (side == -1) f_left *= 0.5;
        side = -1;
      }
    }
    return right;
  }

  FormulaField field_;
  double shortest_ = 0;  // [m]
  bool preparing_ = false;
  mutable std::int64_t ranges_left_ = 0;  // during preparation
};

const Register<ImplicitSurface> registered;

}  // namespace
}  // namespace etendue
