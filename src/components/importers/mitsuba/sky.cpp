// Converts skies and suns.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/emission/sky_model.h"
#include "components/emission/sun_position.h"
#include "converter.h"
#include "etendue/core/vector.h"
#include "etendue/describe/color.h"

namespace etendue::mitsuba {

namespace {

Numbers three(const DoubleVector3& v) { return {{v.x, v.y, v.z}, 1, Dimension::none}; }

constexpr double largest_sun = 20;  // [deg] the largest angular diameter of the sun in a SkyEmission

/// The direction towards the sun from location and time, in the coordinates of a SkyEmission. The defaults are those of all
/// versions of Mitsuba; its sky has x east and y up in version 0.x, and x south, y west and z up in version 3.
DoubleVector3 sun_by_time(const Element& e) {
  const auto whole = [&](const char* name, std::int64_t otherwise) { return e.integer(name, otherwise); };
  const double hours = e.number("hour", 15) + e.number("minute", 0) / 60 + e.number("second", 0) / 3600;
  const std::string day = fmt::format("{:04}-{:02}-{:02}T00:00:00Z", whole("year", 2010), whole("month", 7), whole("day", 10));
  try {
    UniversalTime time = parse_time(day);
    time.days += (hours - e.number("timezone", 9)) / 24;
    const Vector3 sun = sun_direction(time, e.number("latitude", 35.6894), e.number("longitude", 139.6917));
    if (e.old) return {double(sun.x), double(sun.y), double(sun.z)};
    return {double(sun.z), double(sun.y), double(sun.x)};
  } catch (const Error& error) {
    throw Error(error.what(), e.at);
  }
}

/// The mean radiance of the sun's disc, from the same model as the sky.
Color radiance_of_sun(double turbidity, const Color& albedo, double elevation, double factor) {
  std::array<float, SkyModel::channels> ground;
  for (int c = 0; c < SkyModel::channels; ++c) ground[size_t(c)] = albedo->at(SkyModel::wavelength(c), ColorUse::reflectance);
  const SkyModel model(float(turbidity), ground, float(elevation));
  constexpr int first = 360, last = 830, step = 10, rings = 64;  // wavelengths [nm]; rings of equal area
  std::vector<float> wavelengths, values;
  for (int nm = first; nm <= last; nm += step) {
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i) w.place(i, float(nm), 1);
    double sum = 0;
    for (int k = 0; k < rings; ++k) sum += double(model.sun(float(elevation), float(std::sqrt(1 - (k + 0.5) / rings)), w)[0]);
    wavelengths.push_back(float(nm));
    values.push_back(float(factor * sum / rings));
  }
  return table_spectrum(std::move(wavelengths), std::move(values));
}

}  // namespace

void Converter::pair_sun_and_sky(const Element& scene) {
  for (const Property& p : scene.properties) {
    const auto* nested = std::get_if<Nested>(&p.value);
    if (!nested || !nested->reference.empty() || nested->element->tag != "emitter") continue;
    if (nested->element->type == "sun" && !sun_of_sky_) sun_of_sky_ = nested->element;
    if (nested->element->type == "sky" && !sky_with_sun_) sky_with_sun_ = nested->element;
  }
  if (!sun_of_sky_ || !sky_with_sun_) sun_of_sky_ = sky_with_sun_ = nullptr;
}

void Converter::aim_sun(Component& emission, const Element& e, const AnimatedTransform& stands) {
  if (e.has("sun_direction")) {
    const DoubleVector3 to_sun = e.vector("sun_direction", {0, 1, 0});
    const Transform& world = stands.still();
    const DoublePoint3 end = world.back(DoublePoint3{to_sun.x, to_sun.y, to_sun.z}), begin = world.back(DoublePoint3{0, 0, 0});
    set_member(emission, "sun_direction", three({end.x - begin.x, end.y - begin.y, end.z - begin.z}),
               e.location_of("sun_direction"));
  } else if (e.type == "timed_sunsky") {
    inexact(e, "the sun's way over the sky is not read: it stands in the direction (1, 1, 1)");
  } else {
    set_member(emission, "sun_direction", three(sun_by_time(e)), e.at);
  }
}

void Converter::set_sun_diameter(Component& emission, const Element& e) {
  const char* const name = e.old ? "sun_radius_scale" : "sun_aperture";
  if (!e.has(name)) return;
  constexpr double one = 0.5358;  // [deg] angular diameter in version 0.x
  const double across = e.number(name, 1) * (e.old ? one : 1);
  if (across > 0 && across <= largest_sun)
    set_member(emission, "sun_diameter", across, e.location_of(name));
  else
    importing_.inexact("the sun is as large as it is seen from the earth", e.location_of(name));
}

// In its own space the sky's up axis is y in Mitsuba 0.x, as here, and z in version 3; the sun's direction is in world space in
// both.
Ref<Component> Converter::sky(const Element& e) {
  const Transform y_to_z(Transform::DoubleMatrix{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0});
  TransformValue stands = e.transform();
  if (!e.old) stands.transform = stands.transform * AnimatedTransform(y_to_z);
  Ref<Component> emission = make("SkyEmission", e, "");
  // In version 0.x a separate sun plugin may belong to the sky.
  const Element* const own = &e == sky_with_sun_ ? sun_of_sky_ : nullptr;
  const double scale = e.number("scale", 1), sky_scale = scale * e.number("sky_scale", 1),
               sun_scale = own ? own->number("scale", 1) : scale * e.number("sun_scale", 1);
  const bool sun = (own || e.type != "sky") && sun_scale > 0;
  set_member(*emission, "sun", sun, e.at);
  if (sun) set_sun_diameter(*emission, own ? *own : e);
  if (e.has("turbidity")) set_member(*emission, "turbidity", e.number("turbidity", 3), e.location_of("turbidity"));
  if (e.has("albedo") || e.old) set_member(*emission, "ground_albedo", spectrum_of(e, "albedo", 0.2), e.location_of("albedo"));
  aim_sun(*emission, own && !e.has("sun_direction") ? *own : e, stands.transform);
  if (own) {
    if (own->number("turbidity", 3) != e.number("turbidity", 3))
      importing_.inexact("the sun shines through the air of its sky", own->location_of("turbidity"));
    const DoubleVector3 of_sky = e.vector("sun_direction", {}), of_sun = own->vector("sun_direction", of_sky);
    if (e.has("sun_direction") && length(of_sky - of_sun) > 1e-6)
      importing_.inexact("the sun stands where its sky has it", own->location_of("sun_direction"));
    own->dismiss();
  }
  const bool alone = sun && sky_scale <= 0;
  set_member(*emission, "scale", alone ? sun_scale : sky_scale, e.location_of(e.has("sky_scale") ? "sky_scale" : "scale"));
  if (alone)
    importing_.inexact("the sky shines with its sun, although 'sky_scale' is 0", e.location_of("sky_scale"));
  else if (sun && sun_scale != sky_scale)
    importing_.inexact("the sun is brightened with its sky: the scale of the sun is taken to be that of the sky",
                       own ? own->location_of("scale") : e.location_of("sun_scale"));
  inexact(e, fmt::format("'{}' is a model of measured skies whose brightness differs from Mitsuba's", e.type));
  if (e.number("stretch", 1) != 1)
    importing_.inexact("'stretch' is left out: the sky ends at the horizon", e.location_of("stretch"));
  if (e.boolean("extend", false))
    importing_.inexact("'extend' is left out: there is no light from below the horizon", e.location_of("extend"));
  e.ignore({"resolution"});
  Ref<Component> object = make("Environment", e);
  set_member(*object, "emission", emission, e.at);
  set_transform(*object, stands, e.location_of("to_world"));
  return object;
}

// The sun's disc alone: a SkyEmission has a disc only together with its sky.
Ref<Component> Converter::lone_sun(const Element& e) {
  const TransformValue stands = e.transform();
  const Ref<Component> sky = make("SkyEmission", e, "");
  aim_sun(*sky, e, stands.transform);
  set_sun_diameter(*sky, e);
  const Value direction = get(*sky, "sun_direction"), diameter = get(*sky, "sun_diameter");
  const std::vector<double>& d = direction.as<Numbers>()->values;
  const double sine = d[1] / std::hypot(d[0], d[1], d[2]);
  if (!(sine >= 0)) {
    inexact(e, "the sun is below the horizon: it is left out");
    e.dismiss();
    return nullptr;
  }
  const Value usual = get(*make("SkyEmission", e, ""), "sun_diameter");
  const double across = diameter.as<Number>()->value;  // [rad], the unit in which members are read back
  const double darker = std::pow(std::sin(usual.as<Number>()->value / 2) / std::sin(across / 2), 2);
  Ref<Component> emission = make("SpotEmission", e, "");
  set_member(*emission, "radiance",
             radiance_of_sun(std::clamp(e.number("turbidity", 3), 1.0, 10.0), spectrum_of(e, "albedo", 0.2),
                             std::asin(std::min(sine, 1.0)), e.number("scale", 1) * darker),
             e.at);
  set_member(*emission, "axis", three({-d[0], -d[1], -d[2]}), e.at);
  set_member(*emission, "inner_angle", across / 2 * 180 / std::numbers::pi, e.at);
  set_member(*emission, "outer_angle", across / 2 * 180 / std::numbers::pi, e.at);
  inexact(e, "'sun' is of a model of measured skies whose brightness differs from Mitsuba's");
  e.ignore({"resolution"});
  Ref<Component> object = make("Environment", e);
  set_member(*object, "emission", emission, e.at);
  set_transform(*object, stands, e.location_of("to_world"));
  return object;
}

}  // namespace etendue::mitsuba
