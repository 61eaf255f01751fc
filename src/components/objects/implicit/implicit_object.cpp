// Implicit surfaces f = 0 in a box: ray intersection, surface points and the box. Area and samples are in implicit_area.cpp.

#include "implicit_object.h"

#include "implicit_area.h"

namespace etendue {
namespace {

int next(int k) { return (k + 1) % 3; }

Place at(const DoubleRay& r, double t) { return {r.at(t, 0), r.at(t, 1), r.at(t, 2)}; }

/// The part of hits on the surface. A point on the surface has one of the primitives below `first_face` instead, the face of
/// the box from which its surface coordinates are taken.
constexpr int surface = 0;

}  // namespace

ImplicitObject::ImplicitObject() = default;
ImplicitObject::~ImplicitObject() = default;

// ---- the box ------------------------------------------------------------------------------------------------------------

double ImplicitObject::edge(int k, int i) const {
  return i == count_[k] ? high_[k] : low_[k] + (high_[k] - low_[k]) * i / count_[k];
}

void ImplicitObject::cell_box(const Cell& cell, Place& low, Place& high) const {
  for (int k = 0; k < 3; ++k) {
    low[k] = edge(k, cell[k]);
    high[k] = edge(k, cell[k] + 1);
  }
}

/// Bisects a block of cells recursively until the field has one sign in it, or it is a single cell, which is stored.
void ImplicitObject::find_cells(const std::array<int, 3>& from, const std::array<int, 3>& to) {
  Place low, high;
  int longest = 0;
  for (int k = 0; k < 3; ++k) {
    low[k] = edge(k, from[k]);
    high[k] = edge(k, to[k]);
    if (to[k] - from[k] > to[longest] - from[longest]) longest = k;
  }
  if (!may_cross(low, high)) return;
  if (to[longest] - from[longest] == 1) {
    crossed_.push_back({std::uint8_t(from[0]), std::uint8_t(from[1]), std::uint8_t(from[2])});
    return;
  }
  auto end = to, begin = from;
  end[longest] = begin[longest] = (from[longest] + to[longest]) / 2;
  find_cells(from, end);
  find_cells(begin, to);
}

/// Visits cells at the border of the box whose outer face may be partly in the solid; `inside` is the state at the face's
/// centre.
void ImplicitObject::visit_borders(const std::function<void(const Cell&, int face, bool inside)>& visit) const {
  for (int face = 0; face < 6; ++face) {
    const int k = face / 2, a = next(k), b = next(a);
    Cell cell{};
    cell[k] = std::uint8_t(face % 2 ? count_[k] - 1 : 0);
    for (int i = 0; i < count_[a]; ++i)
      for (int j = 0; j < count_[b]; ++j) {
        cell[a] = std::uint8_t(i);
        cell[b] = std::uint8_t(j);
        Place low, high, middle;
        cell_box(cell, low, high);
        low[k] = high[k] = face % 2 ? high_[k] : low_[k];
        for (int m = 0; m < 3; ++m) middle[m] = 0.5 * (low[m] + high[m]);
        const bool inside = field(middle) < 0;
        if (inside || may_cross(low, high)) visit(cell, face, inside);
      }
  }
}

/// Traces more and more lines through the cells until one hits the surface.
bool ImplicitObject::any_surface() const {
  for (const int lines : {1, 2, 5})
    for (const Cell& cell : crossed_)
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < lines * lines; ++i) {
          bool found = false;
          visit_line(cell, k, (i % lines + 0.5) / lines, (i / lines + 0.5) / lines,
                     [&](const Place&, const Place&) { found = true; });
          if (found) return true;
        }
  return false;
}

void ImplicitObject::settle(const Point3& low, const Point3& high, bool capped, const char* member) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    if (!(std::isfinite(low[k]) && std::isfinite(high[k]))) fail(member, "the box must be finite");
    if (!(low[k] < high[k])) fail(member, "the box is empty: 'low' must be below 'high' along each axis");
    low_[k] = double(low[k]);
    high_[k] = double(high[k]);
    longest = std::max(longest, high_[k] - low_[k]);
  }
  for (int k = 0; k < 3; ++k) count_[k] = std::clamp(int(std::ceil(cells * (high_[k] - low_[k]) / longest)), 1, cells);
  capped_ = capped;
  crossed_.clear();
  find_cells({0, 0, 0}, {count_[0], count_[1], count_[2]});

  own_bounds_ = {};
  const auto add = [&](const Cell& cell) {
    Place from, to;
    cell_box(cell, from, to);
    own_bounds_.add(Point3{float(from[0]), float(from[1]), float(from[2])});
    own_bounds_.add(Point3{float(to[0]), float(to[1]), float(to[2])});
  };
  for (const Cell& cell : crossed_) add(cell);
  bool cut = false, face_inside = false;
  visit_borders([&](const Cell& cell, int, bool inside) {
    cut = true;
    face_inside = face_inside || inside;
    if (capped_) add(cell);
  });
  closed_ = capped_ || !cut;
  if (!any_surface() && !(capped_ && face_inside)) fail(member, "there is no surface in the box");

  lazy_.reset();  // so that place() does not sample
  place();
  lazy_ = std::make_unique<Lazy>();
}

// ---- rays ---------------------------------------------------------------------------------------------------------------

/// Calls visit(t, part) for crossings in order of t >= from, until it returns true.
template <class F>
void ImplicitObject::visit_crossings(const DoubleRay& r, double from, const F& visit) const {
  double enter = from, leave = r.maximum;
  int in = -1, out = -1;
  for (int k = 0; k < 3; ++k) {
    const double inverse = 1 / r.direction[k];
    double t0 = (low_[k] - r.origin[k]) * inverse, t1 = (high_[k] - r.origin[k]) * inverse;
    const bool backwards = inverse < 0;
    if (backwards) std::swap(t0, t1);
    // For a ray parallel to a slab both are infinite; in the plane of a face they may be NaN, and the interval is unchanged.
    if (t0 > enter) enter = t0, in = 2 * k + backwards;
    if (t1 < leave) leave = t1, out = 2 * k + !backwards;
  }
  if (!(enter < leave)) return;
  bool inside = field(at(r, enter)) < 0;
  if (capped_ && inside && in >= 0 && visit(enter, first_face + in)) return;
  const double step = 1e-9 * (leave - enter);
  double begin = enter, t = 0;
  // The number of crossings is limited, in case the field is mere noise.
  for (int i = 0; i < 1000 && begin < leave && next_crossing(r, begin, leave, inside, t); ++i) {
    if (visit(t, surface)) return;
    begin = t + step;
  }
  if (capped_ && inside && out >= 0) visit(leave, first_face + out);
}

bool ImplicitObject::local_intersect(const Ray& ray, Hit& hit) const {
  bool found = false;
  visit_crossings(DoubleRay(ray), 0, [&](double t, int part) {
    const float near = float(t);
    if (!(near > 0)) return false;
    found = near < ray.maximum;
    if (found) {
      hit.distance = near;
      hit.primitive = std::uint32_t(part);
      hit.u = float(t - double(near));  // rounding error of the float distance
      hit.v = 0;
    }
    return true;
  });
  return found;
}

void ImplicitObject::local_point(const Ray& ray, const Hit& hit, LocalPoint& p) const {
  const DoubleRay r(ray);
  const double t = double(hit.distance) + double(hit.u);
  Place x = at(r, t);
  for (int k = 0; k < 3; ++k) x[k] = std::clamp(x[k], low_[k], high_[k]);
  double d2 = 0;
  for (int k = 0; k < 3; ++k) d2 += r.direction[k] * r.direction[k];
  // t may have the rounding error of a longer ray, if the object is an operand of a solid.
  point_at(x, int(hit.primitive), p, 0x1p-22 * t * std::sqrt(d2));
}

// ---- points -------------------------------------------------------------------------------------------------------------

/// Fills a surface point from a position near the surface (within the rounding error `off`) or near a face. Surface coordinates
/// are those of the box's face towards which the normal points: u and v run along the next two axes, u reversed on a low face,
/// so that dpdu x dpdv is along the normal.
void ImplicitObject::point_at(Place x, int part, LocalPoint& p, double off) const {
  double n[3]{}, beyond = 0;
  const bool on_face = part >= first_face;
  if (on_face) {
    const int face = part - first_face, k = face / 2;
    x[k] = face % 2 ? high_[k] : low_[k];
    n[k] = face % 2 ? 1 : -1;
  } else {
    // Newton's method along the gradient: x is off by the rounding error of the ray's float t.
    double farthest = off;
    for (int k = 0; k < 3; ++k) farthest = std::max(farthest, 1e-4 * (high_[k] - low_[k]));
    Place g = gradient(x);
    for (int i = 0; i < 4; ++i) {
      const double g2 = g[0] * g[0] + g[1] * g[1] + g[2] * g[2], step = field(x) / g2;
      beyond = std::abs(step) * std::sqrt(g2);
      if (!(beyond < farthest)) {  // at a cusp, where the gradient is unreliable
        beyond = off;
        break;
      }
      for (int k = 0; k < 3; ++k) x[k] = std::clamp(x[k] - step * g[k], low_[k], high_[k]);
      const Place turned = gradient(x);
      if (turned[0] * g[0] + turned[1] * g[1] + turned[2] * g[2] <= 0) break;
      g = turned;
      if (beyond < 1e-13 * farthest) break;
    }
    const double norm = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    for (int k = 0; k < 3; ++k) n[k] = norm > 0 && std::isfinite(norm) ? g[k] / norm : double(k == 2);
    beyond = std::min(beyond, std::max(1e-9 * farthest, off));
  }
  p.position = {float(x[0]), float(x[1]), float(x[2])};
  p.normal = normalize(Normal3(float(n[0]), float(n[1]), float(n[2])));
  p.shading_normal = on_face ? Normal3{} : shading_normal(x, p.normal);

  int k = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(n[i]) > std::abs(n[k])) k = i;
  const int a = next(k), b = next(a), high = n[k] > 0;
  const double side = high ? 1 : -1, size_a = high_[a] - low_[a], size_b = high_[b] - low_[b];
  const double along_a = (x[a] - low_[a]) / size_a, along_b = (x[b] - low_[b]) / size_b;
  p.uv = {float(high ? along_a : 1 - along_a), float(along_b)};
  double du[3], dv[3];
  du[a] = side * size_a;
  du[b] = 0;
  du[k] = -du[a] * n[a] / n[k];
  dv[a] = 0;
  dv[b] = size_b;
  dv[k] = -dv[b] * n[b] / n[k];
  p.dpdu = {float(du[0]), float(du[1]), float(du[2])};
  p.dpdv = {float(dv[0]), float(dv[1]), float(dv[2])};
  p.primitive = std::uint32_t((on_face ? first_face : surface) + 2 * k + high);
  p.u = p.v = 0;
  // Rounding of the position, of an offset ray origin, and of the field in double.
  const double reach = std::max({high_[0] - low_[0], high_[1] - low_[1], high_[2] - low_[2]});
  const Vector3 here{std::abs(p.position.x), std::abs(p.position.y), std::abs(p.position.z)};
  p.error = rounding_bound(4) * along(p.normal, here) + float(1e-10 * reach + beyond);
}

}  // namespace etendue
