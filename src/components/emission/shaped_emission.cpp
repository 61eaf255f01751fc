// The amounts of light that an object emits, by quadrature over its points.

#include "shaped_emission.h"

#include "etendue/core/warp.h"

namespace etendue {
namespace {

constexpr double pi_exactly = 3.14159265358979323846;
constexpr int side = 32, count = side * side;

bool along_axis(Quantity q) { return q == Quantity::intensity || q == Quantity::illuminance; }

Point2 midpoint(int i) { return {(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side}; }

/// A lattice of the golden ratio: evenly distributed, and without aliasing with periodic maps such as bricks or checks.
Point2 place(int i) {
  const double x = (i + 0.5) * 0.61803398874989485;
  return {float(x - std::floor(x)), (float(i) + 0.5f) / count};
}

}  // namespace

void ShapedEmission::prepare_amounts(std::string_view name) {
  quantity_ = Quantity::power;
  amount_ = 0;
  const std::pair<Quantity, double> asked[] = {
      {Quantity::power, watts}, {Quantity::flux, lumens}, {Quantity::intensity, candelas}, {Quantity::illuminance, lux}};
  for (const auto& [quantity, amount] : asked) {
    if (!(amount > 0)) continue;
    if (amount_asked()) {
      const std::string first(amount_name());
      quantity_ = quantity;
      fail(amount_name(), "is asked for besides " + first + "; only one of them can be had");
    }
    quantity_ = quantity;
    amount_ = amount;
    if (!std::isfinite(amount)) fail(amount_name(), "must be finite");
  }

  if (!map) fail(name, "a map or a colour is needed");
  constant_ = map->constant();
  integral_ = 0;
  if (constant_) {
    integral_ = integrate_spectrum(quantity_, [&](float lambda) {
      const float value = constant_->at(lambda, ColorUse::radiance);
      if (!(value >= 0 && std::isfinite(value)))
        fail(name, "must be neither negative nor infinite, and is " + fmt::format("{} at {} nm", value, int(lambda)));
      return value;
    });
    if (amount_asked() && !(integral_ > 0))
      fail(name, "is black" + std::string(quantity_ == Quantity::power ? "" : " to the eye") +
                     ", so it cannot have the shape of the spectrum of a " + std::string(amount_name()));
  }
  measured_.forget();
  if (!(constant_ && same_on_surfaces() && !along_axis(quantity_))) measured_.expect();
}

std::string_view ShapedEmission::amount_name() const {
  constexpr std::string_view names[] = {"power", "luminous_flux", "luminous_intensity", "illuminance"};
  return names[size_t(quantity_)];
}

Vector3 ShapedEmission::checked_direction(const Vector3& v, std::string_view name) const {
  // In double: the square of a length may be too large or too small for a float.
  const double x = double(v.x), y = double(v.y), z = double(v.z), l = std::sqrt(x * x + y * y + z * z);
  if (!(l > 0 && std::isfinite(l))) fail(name, "must be finite and not zero");
  return normalize(Vector3{float(x / l), float(y / l), float(z / l)});
}

Spectrum ShapedEmission::power(const SceneObject& object, const Wavelengths& w) const {
  const float area = object.area();
  if (!(area > 0)) return {};
  if (amount_asked() && !(measured(object) > 0)) {
    if (object.infinite() && quantity_ == Quantity::intensity)
      fail(amount_name(), "what lies at infinity has none; ask for an illuminance");
    fail(amount_name(),
         "nothing leaves the object that way: its radiance is black, or the light lies on a side that does not emit");
  }
  return mean(object, Quantity::power, w) * (area * (amount_asked() ? scale(object, 0) : 1));
}

float ShapedEmission::scale(const SceneObject& object, float time) const {
  // The illuminance from infinity does not depend on an area.
  const bool by_area = !(quantity_ == Quantity::illuminance && object.infinite());
  const double below = (by_area ? double(object.area(time)) : 1) * measured(object);
  return below > 0 ? float(amount_ / below) : 0;
}

/// mean(K) where it needs no quadrature [sr].
std::optional<double> ShapedEmission::mean_share(const SceneObject& object) const {
  if (object.infinite() && object.delta()) {
    double share = 0;
    for_infinity(object, Quantity::power, [&](const SurfacePoint&, double weight) { share = weight; });
    return share;
  }
  if (object.infinite()) return sides == Sides::back ? 0 : solid_angle() / 4;
  if (object.delta()) return solid_angle() / 4;
  if (!same_on_surfaces()) return std::nullopt;
  SurfacePoint any;
  any.normal = {0, 0, 1};
  any.object = &object;
  return surface_share(any);
}

/// The amount per area with k = 1 [W/m^2 or the like].
double ShapedEmission::measured(const SceneObject& object) const {
  if (constant_ && !along_axis(quantity_))
    if (const std::optional<double> share = mean_share(object)) return integral_ * *share;
  return measured_.get(object, [&] {
    if (!constant_) return integrate_wavelengths(quantity_, [&](const Wavelengths& w) { return mean(object, quantity_, w); });
    double share = 0;
    for_points(object, quantity_, [&](const SurfacePoint&, double weight) { share += weight; });
    return integral_ * share;
  });
}

/// The same as a spectrum, not weighted over wavelengths. It is also called for the power when another quantity was requested.
Spectrum ShapedEmission::mean(const SceneObject& object, Quantity quantity, const Wavelengths& w) const {
  if (constant_ && quantity == quantity_)
    return integral_ > 0 ? constant_->evaluate(w, ColorUse::radiance) * float(measured(object) / integral_) : Spectrum();
  if (constant_ && !along_axis(quantity))
    if (const std::optional<double> share = mean_share(object))
      return constant_->evaluate(w, ColorUse::radiance) * float(*share);
  Spectrum sum;
  double share = 0;
  for_points(object, quantity, [&](const SurfacePoint& p, double weight) {
    if (!(weight > 0)) return;
    if (constant_)
      share += weight;
    else
      sum += map->color(p, w, ColorUse::radiance) * float(weight);
  });
  return constant_ ? constant_->evaluate(w, ColorUse::radiance) * float(share) : sum;
}

/// Calls add(point, weight) with points and weights such that the quantity per area is the sum of weight * M(point).
template <class F>
void ShapedEmission::for_points(const SceneObject& object, Quantity quantity, const F& add) const {
  if (object.infinite()) return for_infinity(object, quantity, add);
  if (!object.delta()) return for_surface(object, quantity, add);
  const SurfacePoint p = object.sample_area({0.5f, 0.5f}, 0).point;
  if (along_axis(quantity)) {
    // M f(a) * 1 m^2, per area of the point. Without an axis f is replaced by its mean over all directions.
    const Vector3 axis = own_axis(p);
    const double intensity = axis == Vector3{} ? solid_angle() / (4 * pi_exactly) : double(profile(p, axis));
    const double r = quantity == Quantity::illuminance ? double(distance) : 1;
    add(p, intensity / (double(object.area()) * r * r));
  } else {
    add(p, solid_angle() / 4);
  }
}

template <class F>
void ShapedEmission::for_infinity(const SceneObject& object, Quantity quantity, const F& add) const {
  if (quantity == Quantity::intensity) return;
  if (object.delta()) {
    const SurfaceSample s = object.sample_visible({}, {0.5f, 0.5f}, 0);
    const double f = emits(s.point, -s.direction) ? double(profile(s.point, -s.direction)) : 0;
    add(s.point, quantity == Quantity::illuminance ? f : pi_exactly * f);
    return;
  }
  for (int i = 0; i < count; ++i) {
    const Vector3 v = warp::sphere(midpoint(i));  // its z, along which the points are exact midpoints, becomes y
    const DirectionSample d =
        knows_incident() ? sample_incident(midpoint(i)) : DirectionSample{{v.y, v.z, v.x}, warp::sphere_pdf};
    if (!(d.pdf > 0)) continue;
    Ray ray;
    ray.direction = normalize(object.transform.still()(d.direction));
    SurfacePoint p;
    object.surface_point(ray, {}, p);
    if (!emits(p, -ray.direction)) continue;
    double weight = double(profile(p, -ray.direction) / d.pdf) / count;
    if (quantity == Quantity::illuminance) {
      const Vector3 own = own_axis(p);
      weight *= double(std::max(own == Vector3{} ? d.direction.y : -dot(own, ray.direction), 0.0f));
    } else {
      weight /= 4;
    }
    add(p, weight);
  }
}

template <class F>
void ShapedEmission::for_surface(const SceneObject& object, Quantity quantity, const F& add) const {
  // The first pass computes what the second needs: the sum of weights, the centroid and the mean normal.
  double weights = 0, middle[3] = {}, normal[3] = {};
  Vector3 axis{};
  for (int i = 0; i < count; ++i) {
    const SurfaceSample s = object.sample_area(constant_ ? midpoint(i) : place(i), 0);
    if (!(s.pdf > 0)) continue;
    const double weight = double(1 / s.pdf);
    weights += weight;
    for (int k = 0; k < 3; ++k) {
      middle[k] += weight * double(s.point.position[k]);
      normal[k] += weight * double(s.point.normal[k]);
    }
    if (axis == Vector3{}) axis = own_axis(s.point);
  }
  if (!(weights > 0)) return;
  const bool on_axis = along_axis(quantity);
  if (on_axis && axis == Vector3{} && !object.closed()) {
    const Vector3 n{float(normal[0] / weights), float(normal[1] / weights), float(normal[2] / weights)};
    if (length(n) > 1e-3f) axis = (sides == Sides::back ? -1.0f : 1.0f) * normalize(n);
  }
  const Point3 centre{float(middle[0] / weights), float(middle[1] / weights), float(middle[2] / weights)};
  const double everywhere = quantity == Quantity::illuminance ? 4 * pi_exactly * double(square(distance)) : 4 * pi_exactly;

  Normal3 known;  // for flat objects, whose normals are equal, K is computed once
  double share = 0;
  for (int i = 0; i < count; ++i) {
    const SurfaceSample s = object.sample_area(constant_ ? midpoint(i) : place(i), 0);
    if (!(s.pdf > 0)) continue;
    const double part = 1 / (double(s.pdf) * weights);
    const SurfacePoint& p = s.point;
    if (on_axis && axis != Vector3{}) {
      Vector3 to = axis;
      double squares = 1, across = 1;
      if (quantity == Quantity::illuminance) {
        to = centre + distance * axis - p.position;
        squares = double(length_squared(to));
        if (!(squares > 0)) continue;
        to = normalize(to);
        across = std::max(double(dot(to, axis)), 0.0);
      }
      const double cosine = std::abs(double(dot(p.normal, to)));
      add(p, emits(p, to) ? part * double(profile(p, to)) * cosine * across / squares : 0);
    } else {
      if (!(p.normal == known)) {
        known = p.normal;
        share = surface_share(p);
      }
      add(p, part * (on_axis ? share / everywhere : share));
    }
  }
}

}  // namespace etendue
