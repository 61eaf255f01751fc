// TriangleObject: area and sampling.

#include "etendue/core/warp.h"
#include "geometry/geometry.h"
#include "geometry/solid_angle.h"
#include "geometry/triangle_test.h"
#include "triangle_object.h"

namespace etendue {

float TriangleObject::area(float time) const {
  if (!moves()) return float(area_);
  const Transform moved = transform.at(time);
  if (const float s = similarity_scale(moved); s > 0 && !motion_.moves()) return float(area_) * s * s;
  const Moment now = moment(time);
  double sum = 0;
  for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const Corners c = stored_corners(std::uint32_t(i), now);
    sum += 0.5 * double(transform.animated() ? length(area_vector(moved(c.p[0]), moved(c.p[1]), moved(c.p[2])))
                                             : length(area_vector(c.p[0], c.p[1], c.p[2])));
  }
  return float(sum);
}

float TriangleObject::stored_area(std::uint32_t primitive) const {
  const auto& t = mesh_.triangles[primitive];
  if (!motion_.moves()) return 0.5f * length(area_vector(mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]]));
  float sum = 0;
  for (size_t key = 0; key < motion_.times.size(); ++key) {
    const Point3* p = &mesh_.positions[key * vertices_];
    sum += 0.5f * length(area_vector(p[t[0]], p[t[1]], p[t[2]]));
  }
  return sum / float(motion_.times.size());
}

const std::vector<double>& TriangleObject::cumulative_areas() const {
  std::call_once(lazy_->table_made, [this] {
    double sum = 0;
    lazy_->cumulative.reserve(mesh_.triangles.size());
    for (size_t i = 0; i < mesh_.triangles.size(); ++i)
      lazy_->cumulative.push_back(sum += double(stored_area(std::uint32_t(i))));
    for (double& c : lazy_->cumulative) c /= sum;
  });
  return lazy_->cumulative;
}

namespace {

/// A float has 24 bits, too few to choose one of millions of triangles and a point in it: lower bits are filled by a hash of
/// both numbers.
double finer(float x, float other) {
  const std::uint64_t bits = (std::uint64_t(std::bit_cast<std::uint32_t>(x)) << 32) | std::bit_cast<std::uint32_t>(other);
  return std::min(double(x) + double(mix_bits(bits + 0x9e3779b97f4a7c15ull) >> 11) * 0x1p-77, 1 - 0x1p-53);
}

}  // namespace

std::uint32_t TriangleObject::choose(float& x, float other) const {
  if (mesh_.triangles.size() == 1) return 0;
  const std::vector<double>& table = cumulative_areas();
  const double fine = finer(x, other);
  const size_t i = std::min(size_t(std::upper_bound(table.begin(), table.end(), fine) - table.begin()), table.size() - 1);
  const double low = i > 0 ? table[i - 1] : 0, width = table[i] - low;
  x = width > 0 ? clamp(float((fine - low) / width), 0, one_minus_epsilon) : 0;
  return std::uint32_t(i);
}

SurfaceSample TriangleObject::sample_area(Point2 u, float time) const {
  SurfaceSample s;
  if (mesh_.triangles.empty()) return s;
  const std::uint32_t primitive = choose(u.x, u.y);
  const Point2 b = warp::triangle(u);
  fill(primitive, b.x, b.y, time, s.point);
  s.pdf = area_pdf(s.point);
  if (!(s.pdf < infinity)) s.pdf = 0;  // a triangle that is degenerate at this time
  return s;
}

float TriangleObject::area_pdf(const SurfacePoint& p) const {
  if (!moves()) return float(1 / area_);
  const Corners c = corners(p.primitive, p.time);
  return float(stored_area(p.primitive) / area_) / (0.5f * length(area_vector(c.p[0], c.p[1], c.p[2])));
}

namespace {

/// Whether sampling by solid angle pays, judged by the distance to the nearest corner or the centroid.
bool near(const Point3& from, const Point3 (&p)[3], float area) {
  const Vector3 a = p[0] - from, b = p[1] - from, c = p[2] - from;
  const float corner = std::min({length_squared(a), length_squared(b), length_squared(c)});
  return area > worthwhile_solid_angle * std::min(corner, length_squared(a + b + c) * (1 / 9.0f));
}

}  // namespace

NormalCone TriangleObject::normals() const {
  if (moves()) return {};
  Vector3 sum{};
  const auto area_normal = [this](const auto& t) {
    return area_vector(mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]]);
  };
  for (const auto& t : mesh_.triangles) sum += area_normal(t);
  const float l = length(sum);
  if (!(l > 0)) return {};
  NormalCone cone{sum / l, 1};
  for (const auto& t : mesh_.triangles) {
    const Vector3 n = area_normal(t);
    const float m = length(n);
    if (m > 0) cone.cosine = std::min(cone.cosine, dot(cone.axis, n) / m);
  }
  cone.cosine = std::max(cone.cosine - 1e-5f, -1.0f);
  return cone;
}

void TriangleObject::build_light_tree() {
  std::vector<LightBounds> lights(mesh_.triangles.size());
  for (size_t i = 0; i < lights.size(); ++i) {
    const auto& t = mesh_.triangles[i];
    const Vector3 n = area_vector(mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]]);
    const float l = length(n);
    for (const std::uint32_t k : t) lights[i].bounds.add(mesh_.positions[k]);
    if (l > 0) lights[i].normals = {n * ((emission->sides == Sides::back ? -1 : 1) / l), 1 - 1e-6f};
    lights[i].both_sides = emission->sides == Sides::both;
    lights[i].power = l / 2;  // variation by emission maps is not taken into account
  }
  light_tree_.build(lights);
}

std::uint32_t TriangleObject::choose_visible(const Point3& from, Point2& u, float& chance) const {
  if (light_tree_.empty()) {
    const std::uint32_t primitive = choose(u.x, u.y);
    chance = visible_chance(from, primitive);
    return primitive;
  }
  double x = finer(u.x, u.y);
  const LightTree::Choice choice = light_tree_.sample(from, {}, x);
  u.x = clamp(float(x), 0, one_minus_epsilon);
  chance = choice.probability;
  return choice.emitter;
}

float TriangleObject::visible_chance(const Point3& from, std::uint32_t primitive) const {
  if (!light_tree_.empty()) return light_tree_.probability(from, {}, primitive);
  return mesh_.triangles.size() == 1 ? 1 : float(stored_area(primitive) / area_);
}

SurfaceSample TriangleObject::sample_visible(const Point3& from, Point2 u, float time) const {
  SurfaceSample s;
  if (mesh_.triangles.empty()) return s;
  float chance = 0;
  const std::uint32_t primitive = choose_visible(from, u, chance);
  if (!(chance > 0)) return s;
  const Corners c = corners(primitive, time);
  const Vector3 e1 = c.p[1] - c.p[0], e2 = c.p[2] - c.p[0], n = cross(e1, e2);
  const float area = 0.5f * length(n);
  if (near(from, c.p, area)) {
    const SphericalTriangle triangle(from, c.p[0], c.p[1], c.p[2]);
    if (triangle.usable()) {
      Ray ray;
      ray.origin = from;
      ray.direction = triangle.sample(u);
      TriangleHit h;
      intersect_triangle(ray, c.p[0], e1, e2, n, h);
      h.u = clamp(h.u, 0, 1);  // rounding may put the point just outside the triangle
      h.v = clamp(h.v, 0, 1 - h.u);
      const bool flipped = transform.animated() && transform.at(time).flips();
      fill(primitive, flipped ? h.v : h.u, flipped ? h.u : h.v, time, s.point);
      complete_by_angle(s, from, chance / triangle.solid_angle());
      return s;
    }
  }
  const Point2 b = warp::triangle(u);
  fill(primitive, b.x, b.y, time, s.point);
  complete_by_area(s, from, area > 0 ? chance / area : 0);
  return s;
}

float TriangleObject::visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint& p) const {
  const Corners c = corners(p.primitive, p.time);
  const float area = 0.5f * length(area_vector(c.p[0], c.p[1], c.p[2]));
  if (near(from, c.p, area)) {
    const SphericalTriangle triangle(from, c.p[0], c.p[1], c.p[2]);
    if (triangle.usable()) {
      return visible_chance(from, p.primitive) / triangle.solid_angle();
    }
  }
  const float cosine = std::abs(dot(p.normal, direction));
  return cosine > 0 ? visible_chance(from, p.primitive) / area * distance_squared(p.position, from) / cosine : 0;
}

}  // namespace etendue
