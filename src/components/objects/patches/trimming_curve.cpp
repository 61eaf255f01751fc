#include "trimming_curve.h"

#include "bezier_patch.h"
#include "nurbs_basis.h"

namespace etendue {

using bezier::Control;
using bezier::Vector;

void TrimmingCurve::describe(Description<TrimmingCurve>& d) {
  d.summary("A rational spline curve in the parameters of a NurbsSurface, to trim it; of degree 1, a polyline.",
            "Piegl & Tiller 1997, \"The NURBS book\"")
      .member<&TrimmingCurve::degree>("degree", "1", "the degree", range(1, bezier::highest_degree), Effect::rebuild)
      .member<&TrimmingCurve::knots>("knots", "1",
                                     "as many as points + degree + 1, not decreasing; none: even ones, such that the curve "
                                     "begins at the first point and ends at the last",
                                     Effect::rebuild)
      .member<&TrimmingCurve::points>("points", "1", "the control points (u, v), in the units of the surface's knots",
                                      Effect::rebuild)
      .member<&TrimmingCurve::weights>("weights", "1", "a weight for each control point, or none", more_than(0),
                                       Effect::rebuild);
}

void TrimmingCurve::prepare() {
  for (const Point2& p : points)
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) fail("points", "a control point is not finite");
  if (!weights.empty() && weights.size() != points.size())
    fail("weights", std::to_string(weights.size()) + " weights for " + std::to_string(points.size()) + " points");
  for (const float w : weights)
    if (!(w > 0 && w < infinity)) fail("weights", "weights must be positive and finite");
  knots_ = knots;
  if (knots_.empty() && points.size() > size_t(degree)) {
    const size_t pieces = points.size() - size_t(degree);
    knots_.assign(size_t(degree) + 1, 0);
    for (size_t i = 1; i < pieces; ++i) knots_.push_back(float(i));
    knots_.insert(knots_.end(), size_t(degree) + 1, float(pieces));
  }
  if (const std::string fault = nurbs::knots_fault(knots_, degree, points.size()); !fault.empty())
    fail(points.size() <= size_t(degree) ? "points" : "knots", fault);
}

namespace {

/// The largest distance of the control points from the chord; an upper bound of the curve's distance.
double bulge(const Control* net, int degree) {
  const Vector a = bezier::position(net[0]), b = bezier::position(net[degree]), chord = b - a;
  const double square = dot(chord, chord);
  double most = 0;
  for (int i = 1; i < degree; ++i) {
    const Vector from = bezier::position(net[i]) - a;
    const double along = square > 0 ? std::clamp(dot(from, chord) / square, 0.0, 1.0) : 0;
    most = std::max(most, length(from - along * chord));
  }
  return most;
}

void halve(const Control* net, int degree, double tolerance, int depth, std::vector<std::array<double, 2>>& points) {
  if (depth == 0 || bulge(net, degree) <= tolerance) {
    const Vector end = bezier::position(net[degree]);
    points.push_back({end.x, end.y});
    return;
  }
  Control low[bezier::highest_degree + 1] = {}, high[bezier::highest_degree + 1] = {};
  bezier::split(degree, 0, true, 0.5, net, low, high);
  halve(low, degree, tolerance, depth - 1, points);
  halve(high, degree, tolerance, depth - 1, points);
}

}  // namespace

void TrimmingCurve::flatten(double tolerance, std::vector<std::array<double, 2>>& to) const {
  std::vector<Control> net;
  for (size_t i = 0; i < points.size(); ++i)
    net.push_back(bezier::control({double(points[i].x), double(points[i].y), 0}, weights.empty() ? 1 : double(weights[i])));
  bool first = true;
  for (const nurbs::Span& span : nurbs::spans(knots_, degree)) {
    Control piece[bezier::highest_degree + 1] = {};
    nurbs::bezier_values(knots_, degree, span, net.data(), 1, piece);
    if (std::exchange(first, false)) {
      const Vector begin = bezier::position(piece[0]);
      to.push_back({begin.x, begin.y});
    }
    halve(piece, degree, tolerance, 14, to);
  }
}

static const Register<TrimmingCurve> registered;

}  // namespace etendue
