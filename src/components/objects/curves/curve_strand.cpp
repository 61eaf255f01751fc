#include "curve_strand.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {
namespace {

constexpr size_t channels = 7;  // position, radius, normal
using Channels = std::array<double, channels>;

/// The interpolated channels at a control point.
Channels control(const StrandControl& s, size_t i) {
  const Point3& p = s.points[i];
  const Normal3 n = s.normals.empty() ? Normal3{} : s.normals[s.normals.size() == 1 ? 0 : i];
  return {double(p.x), double(p.y), double(p.z), double(s.radii[s.radii.size() == 1 ? 0 : i]),
          double(n.x), double(n.y), double(n.z)};
}

/// A cubic in powers of t in [0, 1].
struct Span {
  std::array<Channels, 4> power;

  Channels at(double t) const {
    Channels r;
    for (size_t k = 0; k < channels; ++k) r[k] = ((power[3][k] * t + power[2][k]) * t + power[1][k]) * t + power[0][k];
    return r;
  }
  std::array<double, 3> tangent(double t) const {
    std::array<double, 3> r;
    for (size_t k = 0; k < 3; ++k) r[k] = (3 * power[3][k] * t + 2 * power[2][k]) * t + power[1][k];
    return r;
  }
};

// Row k gives the coefficient of t^k from four control points (Catmull & Rom 1974; de Boor 1978).
using Matrix = double[4][4];
constexpr Matrix bezier = {{1, 0, 0, 0}, {-3, 3, 0, 0}, {3, -6, 3, 0}, {-1, 3, -3, 1}};
constexpr Matrix b_spline = {
    {1 / 6.0, 4 / 6.0, 1 / 6.0, 0}, {-0.5, 0, 0.5, 0}, {0.5, -1, 0.5, 0}, {-1 / 6.0, 0.5, -0.5, 1 / 6.0}};
constexpr Matrix catmull_rom = {{0, 1, 0, 0}, {-0.5, 0, 0.5, 0}, {1, -2.5, 2, -0.5}, {-0.5, 1.5, -1.5, 0.5}};

Span span_of(const Matrix& m, const std::array<Channels, 4>& c) {
  Span s{};
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = 0; j < 4; ++j)
      for (size_t k = 0; k < channels; ++k) s.power[i][k] += m[i][j] * c[j][k];
  return s;
}

/// The number of straight pieces into which a span is cut.
int pieces_of(const Span& s, double turn) {
  constexpr int steps = 8, most = 256;
  double turned = 0;
  std::array<double, 3> before{};
  for (int i = 0; i <= steps; ++i) {
    const std::array<double, 3> now = s.tangent(double(i) / steps);
    const double x = before[1] * now[2] - before[2] * now[1], y = before[2] * now[0] - before[0] * now[2],
                 z = before[0] * now[1] - before[1] * now[0];
    const double dot = before[0] * now[0] + before[1] * now[1] + before[2] * now[2];
    if (i > 0) turned += std::atan2(std::sqrt(x * x + y * y + z * z), dot);
    before = now;
  }
  // Linear interpolation of a function is off by at most 1/8 of its second derivative times the square of the step.
  const double bend = std::max(std::abs(2 * s.power[2][3]), std::abs(2 * s.power[2][3] + 6 * s.power[3][3]));
  const double largest = std::max({s.at(0)[3], s.at(0.5)[3], s.at(1)[3]});
  const double swell = bend > 0 && largest > 0 ? std::sqrt(bend / (8 * 0.01 * largest)) : 0;
  return int(std::ceil(std::clamp(std::max(turned / turn, swell) - 1e-6, 1.0, double(most))));
}

StrandPoint point_of(const Channels& c, double u) { return {{c[0], c[1], c[2]}, {c[4], c[5], c[6]}, std::max(c[3], 0.0), u}; }

}  // namespace

StrandSize strand_size(CurveBasis basis) {
  switch (basis) {
    case CurveBasis::bezier: return {4, 3};
    case CurveBasis::b_spline: return {4, 1};
    default: return {2, 1};
  }
}

void flatten(const StrandControl& s, CurveBasis basis, double turn, std::vector<StrandPoint>& out) {
  const size_t n = s.points.size();
  if (basis == CurveBasis::linear) {
    for (size_t i = 0; i < n; ++i) out.push_back(point_of(control(s, i), double(i) / double(n - 1)));
    return;
  }
  // A Catmull-Rom spline is extended by a mirrored control point at each end, so that it passes through all of its points.
  const auto mirrored = [&](size_t end, size_t inner) {
    const Channels a = control(s, end), b = control(s, inner);
    Channels r;
    for (size_t k = 0; k < channels; ++k) r[k] = 2 * a[k] - b[k];
    return r;
  };
  const size_t spans = basis == CurveBasis::bezier ? (n - 1) / 3 : (basis == CurveBasis::b_spline ? n - 3 : n - 1);
  for (size_t i = 0; i < spans; ++i) {
    Span span{};
    if (basis == CurveBasis::bezier) {
      span = span_of(bezier, {control(s, 3 * i), control(s, 3 * i + 1), control(s, 3 * i + 2), control(s, 3 * i + 3)});
    } else if (basis == CurveBasis::b_spline) {
      span = span_of(b_spline, {control(s, i), control(s, i + 1), control(s, i + 2), control(s, i + 3)});
    } else {
      span = span_of(catmull_rom, {i > 0 ? control(s, i - 1) : mirrored(0, 1), control(s, i), control(s, i + 1),
                                   i + 2 < n ? control(s, i + 2) : mirrored(n - 1, n - 2)});
    }
    const int pieces = pieces_of(span, turn);
    for (int k = i == 0 ? 0 : 1; k <= pieces; ++k) {
      const double t = double(k) / pieces;
      out.push_back(point_of(span.at(t), (double(i) + t) / double(spans)));
    }
  }
}

}  // namespace etendue
