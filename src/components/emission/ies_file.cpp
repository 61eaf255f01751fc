// Reading IES photometric files (IESNA LM-63: 1986, 1991, 1995, 2002; ANSI/IES LM-63-19).

#include "ies_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "etendue/core/error.h"
#include "files/regular_file.h"

namespace etendue {
namespace {

constexpr std::uint64_t largest_file = 32u << 20;  // bytes; real ones have some 10 kB
constexpr int most_angles = 7201;                  // 0.05 degrees all around
constexpr double degree = 3.14159265358979323846 / 180;

/// Reads lines up to TILT=, then numbers that are separated by blanks, commas and ends of lines.
class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error("'" + name_ + "', line " + std::to_string(std::max(line_, 1)) + ": " + reason);
  }

  bool at_end() const { return rest_.empty(); }
  std::string_view line() {
    ++line_;
    const size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    const std::string_view text = rest_.substr(0, end);
    size_t next = end;
    if (next < rest_.size()) next += rest_[next] == '\r' && next + 1 < rest_.size() && rest_[next + 1] == '\n' ? 2 : 1;
    rest_.remove_prefix(next);
    return text;
  }

  double number(const char* what) {
    const auto separates = [](char c) { return c == ' ' || c == '\t' || c == ',' || c == '\f' || c == '\v'; };
    while (word_.empty()) {
      while (!numbers_.empty() && separates(numbers_.front())) numbers_.remove_prefix(1);
      if (numbers_.empty()) {
        if (at_end()) fail(std::string("the file ends where ") + what + " should be");
        numbers_ = line();
        continue;
      }
      size_t end = 0;
      while (end < numbers_.size() && !separates(numbers_[end])) ++end;
      word_ = numbers_.substr(0, end);
      numbers_.remove_prefix(end);
    }
    double value = 0;
    const std::string_view digits = word_.front() == '+' ? word_.substr(1) : word_;
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || stop != digits.data() + digits.size() || !std::isfinite(value))
      fail(std::string(what) + " should be a number, but there is '" + printable(word_) + "'");
    word_ = {};
    return value;
  }

  int integer(const char* what, int low, int high) {
    const double value = number(what);
    if (value != std::floor(value) || value < low || value > high)
      fail(std::string(what) + " should be a whole number from " + std::to_string(low) + " to " + std::to_string(high) +
           ", and is " + shortest(value));
    return int(value);
  }

  /// Angles [deg] that increase, within limits.
  std::vector<double> angles(const char* what, int count, double low, double high) {
    if (size_t(count) > left())
      fail(std::string("there is no room for ") + std::to_string(count) + " " + what + "s in the file");
    std::vector<double> all;
    for (int i = 0; i < count; ++i) {
      const double a = number(what);
      if (a < low || a > high)
        fail(std::string("a ") + what + " of " + shortest(a) + " is not within " + shortest(low) + " to " + shortest(high));
      if (!all.empty() && !(a > all.back()))
        fail(std::string(what) + "s must increase, and " + shortest(a) + " follows " + shortest(all.back()));
      all.push_back(a);
    }
    return all;
  }

  /// An upper bound of how many numbers the rest of the file holds: each takes at least a digit and a blank.
  size_t left() const { return (rest_.size() + numbers_.size() + 2) / 2; }

  static std::string shortest(double x) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, x).ptr};
  }
  static std::string printable(std::string_view text) {
    std::string shown;
    for (const char c : text.substr(0, 24)) shown += c >= ' ' && c <= '~' ? c : '?';
    return text.size() > 24 ? shown + "..." : shown;
  }

 private:
  std::string_view rest_, numbers_, word_;
  std::string name_;
  int line_ = 0;
};

/// The values of the file: for each horizontal angle the intensities at all vertical angles.
struct Grid {
  std::vector<double> vertical, horizontal;
  std::vector<float> candelas;
  float at(size_t h, size_t v) const { return candelas[h * vertical.size() + v]; }
};

void read_tilt(Reader& in, std::string_view line, IesDistribution& d) {
  std::string_view what = line.substr(5);
  while (!what.empty() && what.front() == ' ') what.remove_prefix(1);
  while (!what.empty() && (what.back() == ' ' || what.back() == '\t')) what.remove_suffix(1);
  if (what == "NONE") return;
  if (what != "INCLUDE")
    in.fail("TILT=" + Reader::printable(what) + ": only TILT=NONE and TILT=INCLUDE are read; put the factors into the file");
  in.integer("the lamp's position (lamp-to-luminaire geometry)", 1, 3);
  const int count = in.integer("the number of tilt angles", 1, most_angles);
  d.tilt_angles = in.angles("tilt angle", count, 0, 180);
  for (int i = 0; i < count; ++i) {
    const double factor = in.number("a tilt factor");
    if (factor < 0 || factor > 100) in.fail("a tilt factor of " + Reader::shortest(factor) + " is not within 0 to 100");
    d.tilt_factors.push_back(factor);
  }
}

/// Type C: the horizontal angles, unfolded to the full circle.
void unfold_c(const Reader& in, const Grid& g, IesDistribution& d) {
  d.polar = g.vertical;
  const double first = g.horizontal.front(), last = g.horizontal.back();
  const auto add = [&](double azimuth, size_t h) {
    d.azimuth.push_back(azimuth);
    for (size_t v = 0; v < g.vertical.size(); ++v) d.candelas.push_back(g.at(h, v));
  };
  const size_t n = g.horizontal.size();
  if (n == 1) {  // the same all around
    add(0, 0);
    add(360, 0);
  } else if (first == 90 && last == 270) {  // symmetric about the plane of 90 and 270 degrees
    for (size_t i = 0; i < n; ++i) add(g.horizontal[i], i);
    for (size_t i = n - 1; i-- > 0;) add(540 - g.horizontal[i], i);
  } else if (first != 0) {
    in.fail("the first horizontal angle should be 0, and is " + Reader::shortest(first));
  } else if (last == 90) {  // each quadrant the same
    for (size_t i = 0; i < n; ++i) add(g.horizontal[i], i);
    for (size_t i = n - 1; i-- > 0;) add(180 - g.horizontal[i], i);
    for (size_t i = 1; i < n; ++i) add(180 + g.horizontal[i], i);
    for (size_t i = n - 1; i-- > 0;) add(360 - g.horizontal[i], i);
  } else if (last == 180) {  // both halves the same
    for (size_t i = 0; i < n; ++i) add(g.horizontal[i], i);
    for (size_t i = n - 1; i-- > 0;) add(360 - g.horizontal[i], i);
  } else if (last > 180) {
    for (size_t i = 0; i < n; ++i) add(g.horizontal[i], i);
    if (last < 360) add(360, 0);  // files that leave out what equals 0 degrees
  } else {
    in.fail("the last horizontal angle should be 0, 90, 180 or 360, and is " + Reader::shortest(last));
  }
}

/// Types A and B: the latitude with respect to the pole is the vertical angle in type A, the horizontal angle in type B. If the
/// horizontal angles begin at 0, the distribution is symmetric to both sides and is unfolded.
void unfold_ab(Grid g, IesDistribution& d) {
  if (g.horizontal.front() == 0 && g.horizontal.size() > 1) {
    Grid both;
    both.vertical = g.vertical;
    const size_t n = g.horizontal.size();
    for (size_t i = 0; i < 2 * n - 1; ++i) {
      const size_t from = i < n ? n - 1 - i : i - n + 1;
      both.horizontal.push_back(i < n - 1 ? -g.horizontal[from] : g.horizontal[from]);
      for (size_t v = 0; v < g.vertical.size(); ++v) both.candelas.push_back(g.at(from, v));
    }
    g = std::move(both);
  }
  const bool a = d.type == Photometry::a;
  d.azimuth = a ? g.horizontal : g.vertical;
  const std::vector<double>& latitude = a ? g.vertical : g.horizontal;
  for (size_t k = latitude.size(); k-- > 0;) d.polar.push_back(90 - latitude[k]);
  for (size_t i = 0; i < d.azimuth.size(); ++i)
    for (size_t k = latitude.size(); k-- > 0;) d.candelas.push_back(a ? g.at(i, k) : g.at(k, i));
}

}  // namespace

IesDistribution parse_ies(std::string_view text, const std::string& name) {
  Reader in(text, name);
  IesDistribution d;
  // Labels and keywords of any kind precede TILT; the first line of all but the oldest files names the standard.
  bool newest = false;
  for (bool first = true;; first = false) {
    if (in.at_end()) in.fail("there is no line that begins with TILT=, so this is no IES photometric file");
    const std::string_view line = in.line();
    newest |= first && line.find("LM-63-2019") != line.npos;
    if (line.substr(0, 5) != "TILT=") continue;
    read_tilt(in, line, d);
    break;
  }
  in.number("the number of lamps");
  in.number("the lumens of a lamp");
  const double multiplier = in.number("the candela multiplier");
  const int verticals = in.integer("the number of vertical angles", 2, most_angles);
  const int horizontals = in.integer("the number of horizontal angles", 1, most_angles);
  d.type = Photometry(in.integer("the photometric type", 1, 3));
  in.integer("the type of units", 1, 2);
  for (const char* what : {"the width", "the length", "the height"}) in.number(what);
  const double ballast = in.number("the ballast factor");
  const double photometric = in.number("the ballast-lamp photometric factor");
  d.input_watts = in.number("the input power");
  // LM-63-2019 replaced the ballast-lamp photometric factor by a code for how the file was made. Some programs write a factor
  // of 0 for "none".
  const double factor = multiplier * ballast * (newest || photometric == 0 ? 1 : photometric);
  if (!(factor > 0 && factor < 1e9))
    in.fail("the product of the multiplier and the ballast factors is " + Reader::shortest(factor));

  const bool c = d.type == Photometry::c;
  Grid g;
  g.vertical = in.angles("vertical angle", verticals, c ? 0 : -90, c ? 180 : 90);
  g.horizontal = in.angles("horizontal angle", horizontals, c ? 0 : -90, c ? 360 : 90);
  const size_t count = size_t(verticals) * size_t(horizontals);
  if (count > in.left())
    in.fail("the file is too short to hold " + std::to_string(verticals) + " times " + std::to_string(horizontals) +
            " candela values");
  for (size_t i = 0; i < count; ++i) {
    const double value = in.number("a candela value") * factor;
    if (value < 0) in.fail("a candela value is negative: " + Reader::shortest(value));
    if (value > 1e12) in.fail("a candela value is absurd: " + Reader::shortest(value));
    g.candelas.push_back(float(value));
    d.greatest = std::max(d.greatest, value);
  }
  if (!(d.greatest > 0)) in.fail("all candela values are zero");
  if (c) {
    unfold_c(in, g, d);
  } else {
    if (horizontals == 1) in.fail("types A and B need more than one horizontal angle");
    unfold_ab(std::move(g), d);
  }
  if (!(d.lumens() > 0)) in.fail("no light is left between the angles");
  return d;
}

IesDistribution read_ies_file(const std::string& path) {
  std::string text;
  try {
    text = read_regular_file(path, largest_file);
  } catch (const Error& e) {
    throw Error("cannot read '" + path + "': " + e.what());
  }
  return parse_ies(text, path);
}

// ---- the distribution -------------------------------------------------------------------------------------------------

float IesDistribution::at(double polar_angle, double azimuth_angle) const {
  double turn = azimuth_angle - azimuth.front();
  turn -= 360 * std::floor(turn / 360);
  const double around = azimuth.front() + turn;
  constexpr double border = 1e-9;  // [deg]; angles that rounding puts just beyond the last one count as within
  if (around > azimuth.back() + border || polar_angle < polar.front() - border || polar_angle > polar.back() + border) return 0;
  const auto cell = [](const std::vector<double>& angles, double x, float& t) {
    const size_t after = size_t(std::upper_bound(angles.begin(), angles.end(), x) - angles.begin());
    const size_t i = std::clamp<size_t>(after, 1, angles.size() - 1) - 1;
    t = float(std::clamp((x - angles[i]) / (angles[i + 1] - angles[i]), 0.0, 1.0));
    return i;
  };
  float s = 0, t = 0;
  const size_t i = cell(azimuth, around, s), k = cell(polar, polar_angle, t), n = polar.size();
  const float *low = &candelas[i * n + k], *high = low + n;
  return (1 - s) * ((1 - t) * low[0] + t * low[1]) + s * ((1 - t) * high[0] + t * high[1]);
}

/// The intensity is linear in the azimuth, so the trapezoid rule is exact there. Between two polar angles t_0 and t_1, where
/// the intensity goes from a to b, integral of (a + m (t - t_0)) sin t dt = a_0 cos t_0 - b_1 cos t_1 + m (sin t_1 - sin t_0),
/// with m the slope and a_0, b_1 the intensities at the ends of the part of the interval within [from, to].
double IesDistribution::lumens(double from, double to) const {
  double sum = 0;
  for (size_t k = 0; k + 1 < polar.size(); ++k) {
    const double t0 = std::max(polar[k], from), t1 = std::min(polar[k + 1], to);
    if (!(t1 > t0)) continue;
    double a = 0, b = 0;
    for (size_t i = 0; i + 1 < azimuth.size(); ++i) {
      const double width = (azimuth[i + 1] - azimuth[i]) * degree / 2;
      const size_t n = polar.size();
      a += width * double(candelas[i * n + k] + candelas[(i + 1) * n + k]);
      b += width * double(candelas[i * n + k + 1] + candelas[(i + 1) * n + k + 1]);
    }
    const double slope = (b - a) / (polar[k + 1] - polar[k]);
    const double begin = a + slope * (t0 - polar[k]), end = a + slope * (t1 - polar[k]);
    sum += begin * std::cos(t0 * degree) - end * std::cos(t1 * degree) +
           slope / degree * (std::sin(t1 * degree) - std::sin(t0 * degree));
  }
  return sum;
}

double IesDistribution::tilt_factor(double degrees) const {
  if (tilt_angles.empty()) return 1;
  if (degrees <= tilt_angles.front()) return tilt_factors.front();
  if (degrees >= tilt_angles.back()) return tilt_factors.back();
  const size_t i = size_t(std::upper_bound(tilt_angles.begin(), tilt_angles.end(), degrees) - tilt_angles.begin());
  const double t = (degrees - tilt_angles[i - 1]) / (tilt_angles[i] - tilt_angles[i - 1]);
  return (1 - t) * tilt_factors[i - 1] + t * tilt_factors[i];
}

}  // namespace etendue
