#include "placed_luminaire.h"

#include "etendue/describe/registry.h"
#include "geometry/scene_record.h"
#include "nested_luminaires.h"

namespace etendue {
namespace {

/// In double: for a scene a millimetre wide the determinant in float might underflow to 0.
double determinant(const Transform& transform) {
  const auto& m = transform.matrix();
  const auto minor = [&](size_t a, size_t b) {
    return double(m[4 + a]) * double(m[8 + b]) - double(m[4 + b]) * double(m[8 + a]);
  };
  return double(m[0]) * minor(1, 2) - double(m[1]) * minor(0, 2) + double(m[2]) * minor(0, 1);
}

}  // namespace

// ---- WayOut ----------------------------------------------------------------------------------------------------------------

WayOut::WayOut(const Placement* innermost, float time) {
  for (const Placement* p = innermost; p != nullptr; p = p->outer) {
    const AnimatedTransform& t = p->scene->transform;
    if (t.animated()) {
      steps_[size_] = &moved_[size_].emplace(t.at(time));
      ++size_;
    } else if (!t.still().identity()) {
      steps_[size_++] = &t.still();
    }
  }
}

Point3 WayOut::back(Point3 p) const {
  for (int i = size_; i-- > 0;) p = steps_[i]->back(p);
  return p;
}
Vector3 WayOut::back(Vector3 v) const {
  for (int i = size_; i-- > 0;) v = steps_[i]->back(v);
  return v;
}
Vector3 WayOut::operator()(Vector3 v) const {
  for (int i = 0; i < size_; ++i) v = (*steps_[i])(v);
  return v;
}
Normal3 WayOut::carry(Normal3 n) const {
  for (int i = 0; i < size_; ++i) n = (*steps_[i])(n);
  return n;
}

void WayOut::carry_out(SurfacePoint& p) const {
  for (int i = 0; i < size_; ++i) {
    if (p.normal == Normal3{})
      p.position = (*steps_[i])(p.position);  // of a delta light, whose position has no error
    else
      carry_out_of_scene(*steps_[i], p);
  }
}

// From the nested scene to the outermost one a distance along the normal is scaled by 1 / |M^-T n|, with n the unit normal in
// the nested scene; this equals |M^T n| with n the unit normal in the outermost scene.
void WayOut::take_in(SurfacePoint& p) const {
  p.dpdu = p.dpdv = {};
  for (int i = size_; i-- > 0;) {
    p.position = steps_[i]->back(p.position);
    if (p.normal == Normal3{}) continue;
    const Normal3 n = normal_into(*steps_[i], p.normal);
    const float stretch = length(Vector3(n));
    p.normal = Normal3(Vector3(n) / stretch);
    p.shading_normal = normalize(normal_into(*steps_[i], p.shading_normal));
    p.error /= stretch;
  }
}

Ray WayOut::into(const Ray& ray) const {
  Ray local = ray;
  for (int i = size_; i-- > 0;) local = ray_into(*steps_[i], local);
  return local;
}

double WayOut::volume() const {
  double product = 1;
  for (int i = 0; i < size_; ++i) product *= std::abs(determinant(*steps_[i]));
  return product;
}

double WayOut::area_stretch(const Normal3& n) const { return volume() * double(length(Vector3(carry(n)))); }

float WayOut::similarity() const {
  float product = 1;
  for (int i = 0; i < size_; ++i) product *= similarity_scale(*steps_[i]);
  return product;
}

// ---- NormalSpread ----------------------------------------------------------------------------------------------------------

// Of triangles every normal is used. Other objects are sampled with the Fibonacci lattice (x, y) = (i / F_n, i F_(n-1) / F_n)
// (Niederreiter 1992, "Random number generation and quasi-Monte Carlo methods", chapter 5), whose accuracy depends neither on
// the borders between an object's parts nor on their sizes.
NormalSpread::NormalSpread(const SceneObject& object, float time) {
  if (const std::optional<TriangleView> view = still_triangles(object)) {
    for (const auto& t : view->triangles) {
      const Point3& corner = view->positions[t[0]];
      const Vector3 area = cross(view->positions[t[1]] - corner, view->positions[t[2]] - corner);
      const float l = length(area);
      if (l > 0) fine_.push_back({Normal3(area / l), l});
    }
    return;
  }
  const auto fill = [&](std::vector<Part>& parts, int count, int generator) {
    for (int i = 0; i < count; ++i) {
      const double y = (double(std::int64_t(i) * generator % count) + 0.5) / count;
      const SurfaceSample s = object.sample_area({float((i + 0.5) / count), float(y)}, time);
      if (s.pdf > 0) parts.push_back({s.point.normal, 1 / s.pdf});
    }
  };
  fill(fine_, 10946, 6765);
  fill(coarse_, 2584, 1597);
}

NormalSpread::Stretch NormalSpread::stretch(const WayOut& way) const {
  const auto mean = [&](const std::vector<Part>& parts) {
    double sum = 0, weights = 0;
    for (const Part& p : parts) {
      sum += double(p.weight) * double(length(Vector3(way.carry(p.normal))));
      weights += double(p.weight);
    }
    return weights > 0 ? sum / weights : 0;
  };
  const double fine = mean(fine_), coarse = coarse_.empty() ? fine : mean(coarse_);
  return {way.volume() * fine, fine > 0 ? std::abs(fine - coarse) / fine : 0};
}

// ---- PlacedLuminaire -------------------------------------------------------------------------------------------------------

void PlacedLuminaire::describe(Description<PlacedLuminaire>& d) {
  d.summary(
      "What stands for a luminaire in a nested scene, in one of the places where that scene stands. It is made by scenes "
      "alone.");
}

PlacedLuminaire::PlacedLuminaire(const SceneObject& inner, const Placement& place, const NestedLuminaires& all)
    : inner_(&inner), place_(place), all_(all) {
  transform = inner.transform;
  for (const Placement* p = &place; p != nullptr; p = p->outer) transform = p->scene->transform * transform;
  copy_surface_of(inner, *this);
}

bool PlacedLuminaire::intersect(const Ray& ray, Hit& hit) const {
  if (!inner_->intersect(WayOut(&place_, ray.time).into(ray), hit)) return false;
  hit.object = this;
  hit.depth = 0;
  return true;
}

bool PlacedLuminaire::occludes(const Ray& ray) const { return inner_->occludes(WayOut(&place_, ray.time).into(ray)); }

void PlacedLuminaire::surface_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const {
  const WayOut way(&place_, ray.time);
  inner_->surface_point(way.into(ray), hit, p);
  way.carry_out(p);
  p.object = this;
}

void PlacedLuminaire::tangents(SurfacePoint& p) const {
  if (p.dpdu != Vector3{} || p.dpdv != Vector3{}) return;  // set already, when the hit was located
  const WayOut way(&place_, p.time);
  SurfacePoint there = inside(way, p);
  inner_->tangents(there);
  p.dpdu = way(there.dpdu);
  p.dpdv = way(there.dpdv);
}

SurfacePoint PlacedLuminaire::inside(const WayOut& way, const SurfacePoint& p) const {
  SurfacePoint there = p;
  way.take_in(there);
  there.object = inner_.get();
  return there;
}

void PlacedLuminaire::own(const WayOut& way, SurfaceSample& s) const {
  way.carry_out(s.point);
  s.point.object = this;
}

// ---- areas -----------------------------------------------------------------------------------------------------------------

double PlacedLuminaire::area_under(const WayOut& way, float time) const {
  const double own = double(inner_->area(time));
  if (const float scale = way.similarity(); scale > 0) return own * double(scale) * double(scale);
  // If the object moves in its scene, its normals are computed anew for this time.
  const NormalSpread* still = inner_->transform.animated() ? nullptr : all_.spread(*inner_);
  return own * (still ? *still : NormalSpread(*inner_, time)).stretch(way).value;
}

void PlacedLuminaire::find_stretch(const NormalSpread* still) {
  if (delta() || infinite() || transform.animated()) return;
  const WayOut way(&place_, 0);
  const double scale = double(way.similarity());
  const NormalSpread::Stretch stretch = still ? still->stretch(way) : NormalSpread::Stretch{scale * scale, 0};
  stretch_ = float(stretch.value);
  stretch_error_ = float(stretch.error);
}

float PlacedLuminaire::area(float time) const {
  if (infinite()) return square(all_.radius());  // as the area of Distant
  if (delta()) return inner_->area(time);
  return transform.animated() ? float(area_under(WayOut(&place_, time), time)) : stretch_ * inner_->area(time);
}

SurfaceSample PlacedLuminaire::sample_area(Point2 u, float time) const {
  SurfaceSample s = inner_->sample_area(u, time);
  if (!(s.pdf > 0)) return s;
  const WayOut way(&place_, time);
  if (!s.delta) s.pdf = float(double(s.pdf) / way.area_stretch(s.point.normal));
  own(way, s);
  return s;
}

float PlacedLuminaire::area_pdf(const SurfacePoint& p) const {
  const WayOut way(&place_, p.time);
  const SurfacePoint there = inside(way, p);
  const float pdf = inner_->area_pdf(there);
  return delta() ? pdf : float(double(pdf) / way.area_stretch(there.normal));
}

// ---- solid angles ----------------------------------------------------------------------------------------------------------

SurfaceSample PlacedLuminaire::sample_visible(const Point3& from, Point2 u, float time) const {
  const WayOut way(&place_, time);
  SurfaceSample s = inner_->sample_visible(way.back(from), u, time);
  if (!(s.pdf > 0)) return s;
  if (s.infinite) {  // a single direction
    s.direction = normalize(way(s.direction));
    s.point.position = from + (2 * all_.radius() + distance(from, all_.centre())) * s.direction;
    s.point.object = this;
    return s;
  }
  const double jacobian = s.delta ? 0 : std::pow(double(length(way(s.direction))), 3) / way.volume();
  const float per_area = s.delta ? inner_->area_pdf(s.point) : 0;
  own(way, s);
  if (s.delta)
    complete_by_angle(s, from, per_area * distance_squared(from, s.point.position));
  else
    complete_by_angle(s, from, float(double(s.pdf) * jacobian));
  return s;
}

float PlacedLuminaire::visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint& p) const {
  if (delta()) return 0;  // no ray hits a delta light, it can only be sampled
  const WayOut way(&place_, p.time);
  const Vector3 w = way.back(direction);
  const double stretch = double(length(w));  // |M^-1 w| with w outside is 1 / |M w| with w inside
  const float pdf = inner_->visible_pdf(way.back(from), w / float(stretch), inside(way, p));
  return float(double(pdf) / (stretch * stretch * stretch * way.volume()));
}

// ---- bounds ----------------------------------------------------------------------------------------------------------------

Bounds3 PlacedLuminaire::swept_out(Bounds3 box) const {
  for (const Placement* p = &place_; p != nullptr && !box.empty(); p = p->outer) box = swept(p->scene->transform, box);
  return box;
}

LuminaireBounds PlacedLuminaire::luminaire_bounds() const {
  const LuminaireBounds inner = inner_->luminaire_bounds();
  return {swept_out(inner.box), carried_out(inner.normals)};
}

// With N = M^-T, the axis a, and a normal n = cos(t) a + sin(t) b, b perpendicular to a: the component of N n along N a is at
// least cos(t) |N a| - sin(t) s, and the perpendicular component at most sin(t) s, with s an upper bound of |N b|. So the angle
// between N n and N a is at most
//     atan(sin(t) s / (cos(t) |N a| - sin(t) s)),
// unless the denominator is not positive. A similarity preserves angles.
NormalCone PlacedLuminaire::carried_out(const NormalCone& cone) const {
  for (const Placement* p = &place_; p != nullptr; p = p->outer)
    if (p->scene->transform.animated()) return {};
  if (cone.cosine <= -1) return {};
  const WayOut way(&place_, 0);
  const Vector3 axis(way.carry(Normal3(cone.axis)));
  const float along = length(axis);
  constexpr float rounding = 1e-5f;
  if (way.similarity() > 0) return {axis / along, std::max(cone.cosine - rounding, -1.0f)};
  const Frame frame{Normal3(cone.axis)};
  const float across =
      std::sqrt(length_squared(Vector3(way.carry(Normal3(frame.s)))) + length_squared(Vector3(way.carry(Normal3(frame.t)))));
  const float sine = safe_sqrt(1 - square(cone.cosine));
  const float x = cone.cosine * along - sine * across, y = sine * across;
  if (!(x > 0)) return {};
  return {axis / along, x / std::hypot(x, y) - rounding};
}

// Registered, so that the class has a name, but without a function to create it by this name.
[[maybe_unused]] static const bool placed_luminaire_known = [] {
  static RegistrationNode node{typeid(PlacedLuminaire), parent_type<PlacedLuminaire>(),
                               [](ClassInfo& info) {
                                 Description<PlacedLuminaire> d(info);
                                 PlacedLuminaire::describe(d);
                               },
                               nullptr, nullptr};
  enlist(node);
  return true;
}();

}  // namespace etendue
