#include "curve_tube.h"

namespace etendue {

TubePiece::TubePiece(const CurveVertex& from, const CurveVertex& to) : from_(from), to_(to) {
  p_ = Double3(from.position);
  const Double3 d = Double3(to.position) - p_;
  length_ = length(d);
  a_ = (1 / length_) * d;
  r_ = double(from.radius);
  k_ = (double(to.radius) - r_) / length_;
  c2_ = 1 - k_ * k_;
  c_ = std::sqrt(c2_);
  const Double3 e(from.reference);
  e1_ = normalize(e - dot(e, a_) * a_);
  e2_ = cross(e1_, a_);
  n0_ = Double3(from.across);
  o0_ = double(from.offset);
  if (from.flat) n0_ = a_, o0_ = 0;
  n1_ = Double3(to.across);
  o1_ = double(to.offset) + dot(n1_, d);
  if (to.flat) n1_ = a_, o1_ = length_;
}

// n.y = o with y = s a + (r + k s) m: s = (o - r n.m) / (n.a + k n.m).
TubePiece::Line TubePiece::line(double psi) const {
  const double cosine = std::cos(psi), sine = std::sin(psi);
  Line l;
  l.out = cosine * e1_ + sine * e2_;
  l.around = cosine * e2_ - sine * e1_;
  l.normal = c_ * l.out - k_ * a_;
  const auto cut = [&](const Double3& n, double o, double& derivative) {
    const double m = dot(n, l.normal), dm = c_ * dot(n, l.around), below = dot(n, a_) + k_ * m, s = (o - r_ * m) / below;
    derivative = -(r_ + k_ * s) * dm / below;
    return s;
  };
  l.s0 = cut(n0_, o0_, l.ds0);
  l.s1 = cut(n1_, o1_, l.ds1);
  return l;
}

// s depends on psi only through n.e, and monotonically, so its extremes are at the extremes of n.e.
bool TubePiece::extent(Extent& x) const {
  const auto cut = [&](const Double3& n, double o, double& first, double& last) {
    const double along = dot(n, a_), across = std::sqrt(std::max(0.0, 1 - along * along));
    double s[2];
    for (const int i : {0, 1}) {
      const double m = (i ? c_ : -c_) * across - k_ * along, below = along + k_ * m;
      if (!(below > 1e-3)) return false;
      s[i] = (o - r_ * m) / below;
    }
    first = std::min(s[0], s[1]);
    last = std::max(s[0], s[1]);
    return true;
  };
  return cut(n0_, o0_, x.first0, x.last0) && cut(n1_, o1_, x.first1, x.last1);
}

bool TubePiece::proper() const {
  Extent x;
  const double least = -1e-9 * (r_ + length_);
  return extent(x) && x.last0 < x.first1 && r_ + k_ * x.first0 >= least && r_ + k_ * x.last1 >= least;
}

Bounds3 TubePiece::bounds() const {
  Extent x{};
  extent(x);
  Bounds3 box;
  for (const double s : {std::min(x.first0, x.first1), std::max(x.last0, x.last1)}) {
    const Double3 y = p_ + s * a_;
    const Point3 middle{float(y.x), float(y.y), float(y.z)};
    const float radius = float(std::max(r_ + k_ * s, 0.0));
    const float margin = rounding_bound(8) * (max_component(abs(middle - Point3{})) + radius);
    const Vector3 reach{radius + margin, radius + margin, radius + margin};
    box.add(middle - reach);
    box.add(middle + reach);
  }
  return box;
}

bool TubePiece::intersect(const DoubleRay& ray, float maximum, float& t, Face& face, float& u, float& v) const {
  // The ray starts at its point nearest to the piece's middle; coordinates are relative to the piece's beginning.
  const Double3 d(ray.direction), o = Double3(ray.origin) - p_;
  const double start = dot(0.5 * length_ * a_ - o, d) / dot(d, d);
  const Double3 q = o + start * d;
  const double z = dot(q, a_), dz = dot(d, a_);
  const Double3 across = q - z * a_, d_across = d - dz * a_;
  float nearest = maximum;
  bool found = false;
  const auto take = [&](double s, Face where) {
    const float there = float(start + s);
    if (!(there > 0 && there < nearest)) return false;
    nearest = there;
    face = where;
    return found = true;
  };

  // c^2 |across|^2 = (r + k z)^2
  const double w = r_ + k_ * z, dw = k_ * dz;
  const double qa = c2_ * dot(d_across, d_across) - dw * dw, qb = c2_ * dot(across, d_across) - dw * w,
               qc = c2_ * dot(across, across) - w * w;
  if (const double discriminant = qb * qb - qa * qc; discriminant >= 0) {
    // The planes are moved outwards by `slack`: better to hit a point twice, once on each piece, than to let a ray through
    // between them.
    const double slack = 1e-7 * (r_ + double(to_.radius));
    const double root = -(qb + std::copysign(std::sqrt(discriminant), qb));
    for (const double s : {root / qa, qc / root}) {  // one may be infinite or NaN: then all tests fail
      const Double3 y = q + s * d;
      if (!(w + s * dw >= 0 && dot(n0_, y) >= o0_ - slack && dot(n1_, y) <= o1_ + slack) || !take(s, round)) continue;
      double psi = std::atan2(dot(y, e2_), dot(y, e1_));
      if (psi < 0) psi += 2 * M_PI;
      const Line l = line(psi);
      const double along = (dot(y, a_) + k_ * r_) / c2_;
      u = float(std::clamp((along - l.s0) / (l.s1 - l.s0), 0.0, 1.0));
      v = float(psi / (2 * M_PI));
    }
  }
  for (const Face end_face : {begin, end}) {
    if (!has(end_face)) continue;
    const double s = ((end_face == begin ? 0 : length_) - z) / dz, radius = end_radius(end_face);
    const Double3 y = across + s * d_across;
    if (!(dot(y, y) <= radius * radius) || !take(s, end_face)) continue;
    u = float(0.5 + 0.5 * dot(y, e1_) / radius);
    v = float(0.5 + (end_face == begin ? 0.5 : -0.5) * dot(y, e2_) / radius);
  }
  t = nearest;
  return found;
}

void TubePiece::point(Face face, float u, float v, bool smooth, LocalPoint& p) const {
  Double3 y, du, dv, n, shading;
  if (face == round) {
    const Line l = line(2 * M_PI * double(v));
    const double along = double(u), s = l.s0 + along * (l.s1 - l.s0), r = r_ + k_ * s;
    const Double3 step = a_ + k_ * l.normal;
    n = shading = l.normal;
    y = s * a_ + r * n;
    du = ((l.s1 - l.s0) / double(to_.u - from_.u)) * step;
    dv = (2 * M_PI) * ((l.ds0 + along * (l.ds1 - l.ds0)) * step + r * c_ * l.around);
    if (smooth) {  // normal about the spline's tangent, which is interpolated from the normals of the planes
      const Double3 tangent = normalize((1 - along) * n0_ + along * n1_);
      shading = c_ * normalize(l.out - dot(l.out, tangent) * tangent) - k_ * tangent;
    }
    p.uv = {lerp(u, from_.u, to_.u), v};
  } else {
    const double radius = end_radius(face), side = face == begin ? 1 : -1;
    y = (face == begin ? 0 : length_) * a_ + radius * (2 * double(u) - 1) * e1_ + side * radius * (2 * double(v) - 1) * e2_;
    du = 2 * radius * e1_;
    dv = side * 2 * radius * e2_;
    n = shading = -side * a_;
    p.uv = {u, v};
  }
  p.position = Point3{} + Vector3(p_ + y);
  p.normal = Normal3(Vector3(n));
  p.shading_normal = Normal3(Vector3(shading));
  p.dpdu = Vector3(du);
  p.dpdv = Vector3(dv);
  p.u = u;
  p.v = v;
  // Rounding of the position in any direction, since it may fall into the next piece, and of the offset ray origin;
  // intersection itself is in double.
  p.error = rounding_bound(3) * (length(p.position - Point3{}) + from_.radius + to_.radius);
}

double TubePiece::round_area(int steps) const {
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += integral(line(2 * M_PI * (i + 0.5) / steps));
  return c2_ * sum * 2 * M_PI / steps;
}

// For a smooth periodic function of an angle the mean over equal steps converges exponentially; for a cylinder cut by planes it
// is exact.
double TubePiece::area(Face face) const {
  if (face != round) return M_PI * end_radius(face) * end_radius(face);
  return round_area(16);
}

double TubePiece::area_error() const {
  const double fine = round_area(16);
  return fine > 0 ? std::abs(round_area(8) - fine) / fine : 0;
}

Point2 TubePiece::sample(Face face, Point2 u) const {
  if (face != round) {
    float sine = 0, cosine = 0;
    sin_cos_turn(u.y, sine, cosine);
    const float r = std::sqrt(u.x);
    return {0.5f + 0.5f * r * cosine, 0.5f + 0.5f * r * sine};
  }
  const Line l = line(2 * M_PI * double(u.y));  // u.y as the angle, and along the line in proportion to the radius
  const double r0 = r_ + k_ * l.s0, r1 = r_ + k_ * l.s1, x = double(u.x);
  const double along = x * (r0 + r1) / (r0 + std::sqrt((1 - x) * r0 * r0 + x * r1 * r1));
  return {float(std::clamp(along, 0.0, 1.0)), u.y};
}

double TubePiece::pdf(Face face, float, float v) const {
  if (face != round) return 1 / area(face);
  return 1 / (2 * M_PI * c2_ * integral(line(2 * M_PI * double(v))));
}

size_t append_tube(std::span<const StrandPoint> points, double turned_by, std::vector<CurveVertex>& vertices) {
  constexpr double sharpest = -0.5;  // cosine of the turn beyond which a corner's tip would be too long: 120 degrees
  const size_t n = points.size();
  // First two vertices for each point, all with flat ends.
  std::vector<CurveVertex> ends(2 * n);
  for (size_t i = 0; i < 2 * n; ++i) {
    const StrandPoint& p = points[i / 2];
    ends[i].position = {float(p.position[0]), float(p.position[1]), float(p.position[2])};
    ends[i].radius = float(p.radius);
    ends[i].u = float(p.u);
    ends[i].flat = true;
    ends[i].reference = {1, 0, 0};
  }
  const auto piece = [&](size_t i) { return TubePiece(ends[2 * i + 1], ends[2 * i + 2]); };
  std::vector<double> tilt(n, 2);  // least cosine between the plane's normal and the axes of the adjacent pieces; 2: cut
  Double3 e;
  for (size_t i = 0; i + 1 < n; ++i) {
    const TubePiece after = piece(i);
    const Double3 b = after.axis();
    if (i == 0) {
      const Frame frame{Normal3(Vector3(b))};
      e = Double3(std::cos(float(turned_by)) * frame.s + std::sin(float(turned_by)) * frame.t);
    } else {
      const TubePiece before = piece(i - 1);
      const Double3 a = before.axis(), half = a + b;
      // The frame is reflected, so that v is continuous (Wang et al. 2008, "Computation of rotation minimizing frames").
      if (dot(half, half) > 1e-6) {
        const Double3 m = normalize(half);
        e = e - 2 * dot(e, m) * m;
      }
      const double ca = std::sqrt(1 - before.slope() * before.slope()), cb = std::sqrt(1 - after.slope() * after.slope());
      const Double3 plane = (1 / ca) * a + (1 / cb) * b;
      if (dot(a, b) > sharpest) {
        const double size = length(plane);
        for (const size_t k : {2 * i, 2 * i + 1}) {
          ends[k].across = Vector3((1 / size) * plane);
          ends[k].offset = float(-double(ends[k].radius) * (before.slope() / ca + after.slope() / cb) / size);
          ends[k].flat = false;
        }
        tilt[i] = std::min(dot(plane, a), dot(plane, b)) / size;
      }
    }
    e = normalize(e - dot(e, b) * b);
    ends[2 * i + 1].reference = Vector3(e);
  }
  // Where a tube bends within its own radius, the planes would intersect inside it: it is cut at the plane that leans most.
  const auto cut = [&](size_t i) {
    ends[2 * i].flat = ends[2 * i + 1].flat = true;
    tilt[i] = 2;
  };
  for (size_t i = 0; i + 1 < n; ++i) {
    if ((ends[2 * i + 1].flat && ends[2 * i + 2].flat) || piece(i).proper()) continue;
    const size_t where = tilt[i] < tilt[i + 1] ? i : i + 1;
    cut(where);
    i -= std::min<size_t>(i + 1, where == i ? 2 : 1);  // changed pieces are tested again
  }
  size_t cuts = 0;
  for (size_t i = 0; i < n; ++i) {
    const bool inner = i > 0 && i + 1 < n;
    if (i == 0 || (inner && tilt[i] == 2)) {
      if (inner) vertices.push_back(ends[2 * i]);
      cuts += inner;
    }
    vertices.push_back(i + 1 < n ? ends[2 * i + 1] : ends[2 * i]);
  }
  return cuts;
}

}  // namespace etendue
