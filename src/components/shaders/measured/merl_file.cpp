#include "merl_file.h"

#include <cmath>

#include "etendue/core/error.h"
#include "files/regular_file.h"

namespace etendue {
namespace {

constexpr int most_cells = 1024;  // in each dimension
constexpr double most = 1e12;     // magnitude of any number
constexpr double scales[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};

/// The cells whose centres enclose a coordinate, and the fraction towards the second. Constant beyond the outermost centres.
struct Span {
  int low, high;
  float fraction;
};
Span span_of(float coordinate, int cells) {
  const float x = clamp(coordinate * float(cells) - 0.5f, 0, float(cells - 1));
  const int low = std::min(int(x), cells - 1);
  return {low, std::min(low + 1, cells - 1), x - float(low)};
}
/// The same for a periodic coordinate.
Span span_around(float turn, int cells) {
  const float x = turn * float(cells) - 0.5f, floor = std::floor(x);
  const int low = (int(floor) + cells) % cells;
  return {low, (low + 1) % cells, x - floor};
}

}  // namespace

MerlTable::MerlTable(const std::string& path) {
  RegularFile file(path);
  const std::uint64_t size = file.size();
  std::int32_t cells[3] = {0, 0, 0};
  if (file.read_some(cells, sizeof cells) < sizeof cells) throw Error("it is too short for a MERL file");
  const std::string shape = std::to_string(cells[0]) + " x " + std::to_string(cells[1]) + " x " + std::to_string(cells[2]);
  for (const std::int32_t n : cells)
    if (n < 1 || n > most_cells) throw Error("it is no MERL file, or of no size that makes sense: " + shape + " cells");
  const size_t count = size_t(cells[0]) * size_t(cells[1]) * size_t(cells[2]);
  const std::uint64_t needed = sizeof cells + std::uint64_t(count) * 3 * sizeof(double);
  if (size != needed)
    throw Error(shape + " cells take " + std::to_string(needed) + " bytes, but it is " + std::to_string(size) + " bytes long");
  half_ = cells[0];
  difference_ = cells[1];
  azimuth_ = cells[2];

  values_.assign(count, Value{{0, 0, 0, 0}});
  std::vector<double> row(static_cast<size_t>(azimuth_));
  std::vector<bool> measured(count);
  for (int channel = 0; channel < 3; ++channel) {
    size_t found = 0;
    for (size_t at = 0; at < count; at += row.size()) {
      file.read(row.data(), row.size() * sizeof(double));
      for (size_t i = 0; i < row.size(); ++i) {
        if (!(std::abs(row[i]) <= most)) throw Error("it holds " + std::to_string(row[i]) + ", out of any range");
        measured[at + i] = row[i] >= 0;
        found += measured[at + i];
        values_[at + i].c[channel] = float(std::max(row[i], 0.0) * scales[channel]);
      }
    }
    if (found == 0) throw Error("a whole colour of it is marked as not measured");
    fill_unmeasured(channel, measured);
  }
}

// Most cells without a measurement contain directions below the horizon. They take the value of the nearest measured cell
// towards smaller theta_d, so that interpolation at the border is not darkened; if there is none, that of smaller theta_h.
void MerlTable::fill_unmeasured(int channel, const std::vector<bool>& measured) {
  for (int h = 0; h < half_; ++h)
    for (int p = 0; p < azimuth_; ++p)
      for (int d = 0; d < difference_; ++d)
        if (!measured[index(h, d, p)] && (d > 0 || h > 0))
          values_[index(h, d, p)].c[channel] = values_[d > 0 ? index(h, d - 1, p) : index(h - 1, d, p)].c[channel];
}

// With unit vectors a and b, a + b lies along the half-vector h and a - b is perpendicular to it: their lengths are 2
// cos(theta_d) and 2 sin(theta_d), and exchanging a and b negates the second.
Rgb MerlTable::evaluate(const Vector3& a, const Vector3& b) const {
  const Vector3 sum = a + b, difference = a - b;
  const float across = std::sqrt(sum.x * sum.x + sum.y * sum.y), whole = length(sum);
  const float theta_h = std::atan2(across, sum.z), theta_d = std::atan2(length(difference), whole);
  // The frame around h: t in the plane of h and the normal, s at right angles to both.
  const float cos_phi = across > 0 ? sum.x / across : 1, sin_phi = across > 0 ? sum.y / across : 0;
  const float cos_theta = sum.z / whole, sin_theta = across / whole;
  float x = cos_theta * (cos_phi * difference.x + sin_phi * difference.y) - sin_theta * difference.z;
  float y = cos_phi * difference.y - sin_phi * difference.x;
  if (y < 0 || (y == 0 && x < 0)) {
    x = -x;
    y = -y;
  }
  const Span h = span_of(std::sqrt(theta_h * (2 * inverse_pi)), half_), d = span_of(theta_d * (2 * inverse_pi), difference_);
  const Span p = span_around(std::atan2(y, x) * inverse_pi, azimuth_);

  Rgb rgb;
  const auto add = [&](int ih, int id, float weight) {
    const Value &low = values_[index(ih, id, p.low)], &high = values_[index(ih, id, p.high)];
    rgb.r += weight * lerp(p.fraction, low.c[0], high.c[0]);
    rgb.g += weight * lerp(p.fraction, low.c[1], high.c[1]);
    rgb.b += weight * lerp(p.fraction, low.c[2], high.c[2]);
  };
  add(h.low, d.low, (1 - h.fraction) * (1 - d.fraction));
  add(h.low, d.high, (1 - h.fraction) * d.fraction);
  add(h.high, d.low, h.fraction * (1 - d.fraction));
  add(h.high, d.high, h.fraction * d.fraction);
  return rgb;
}

}  // namespace etendue
