// Converts lights and area emission.

#include <fmt/format.h>

#include <cmath>

#include "images/linear_image.h"
#include "reader.h"

namespace etendue::pbrt {

namespace {

constexpr double pi = 3.14159265358979323846;

}  // namespace

// Version 3's scale is a spectrum.
Light light_of(Reader& reader, const Parameters& p, const char* name, Use use) {
  const Parameter* given = p.find(name);
  const Color color = given ? spectrum_of(reader, p, *given, use) : rgb_color(p.space ? p.space->name : "srgb", 1, 1, 1);
  double scale = reader.exposure;
  if (const Parameter* s = p.find("scale")) {
    if (s->is("float")) {
      scale *= p.number("scale", 1);
    } else if (s->numbers.size() == 3) {
      // v3's scale is a colour.
      const auto& n = s->numbers;
      if (n[0] == n[1] && n[1] == n[2]) {
        scale *= n[0];
      } else if (given && given->numbers.size() == 3) {
        Parameter product = *given;
        for (size_t i = 0; i < 3; ++i) product.numbers[i] *= n[i];
        return {spectrum_of(reader, p, product, use), scale};
      } else {
        reader.importing.inexact("a scale that is a colour is its mean here", s->at);
        scale *= (n[0] + n[1] + n[2]) / 3;
      }
    } else {
      scale *= double(to_xyz(*spectrum_of(reader, p, *s, Use::coefficient), ColorUse::coefficient).y);
    }
  }
  if (!(scale >= 0)) throw Error("a light's scale must not be negative", p.place("scale"));
  return {color, scale};
}

Transform Reader::of_light(const Transform& inner, Location at) {
  if (to_world(inner).animated())
    importing.inexact("this light does not move: it stands where it is at the first of the two times, as in pbrt", at);
  return state.ctm[0] * inner;
}

namespace {

/// The colour of light_of multiplied by its scale and by `more`.
Color scaled_light(Reader& reader, const Parameters& p, const char* name, double more = 1) {
  const Light light = light_of(reader, p, name, Use::light);
  const double scale = light.scale * more;
  return scale == 1 ? light.color : scaled_spectrum(scale, light.color);
}

/// The factor for v4's "power" [lm], which replaces the power from the scale; `per_unit` is the power of an intensity of 1.
double power_factor(const Parameters& p, double per_unit) {
  const double power = p.number("power", -1);
  return power > 0 ? power / per_unit : 1;
}

Numbers list(const DoublePoint3& p) { return {{p.x, p.y, p.z}, 1, Dimension::none}; }
Numbers way(const DoublePoint3& from, const DoublePoint3& to, const Parameters& p) {
  if (from == to) throw Error(fmt::format("'from' and 'to' of {} are the same point", p.of), p.place("to"));
  return {{to.x - from.x, to.y - from.y, to.z - from.z}, 1, Dimension::none};
}

Ref<Component> placed(Reader& reader, const char* class_name, const Parameters& p, const Transform& inner = {}) {
  const Ref<Component> object = reader.make(class_name, p.at);
  const Transform transform = reader.of_light(inner, p.at);
  if (!transform.valid()) throw Error(fmt::format("{} cannot be placed: its transform cannot be inverted", p.of), p.at);
  set_member(*object, "transform", AnimatedTransform(transform), p.at);
  return object;
}

void add_light(Reader& reader, const Ref<Component>& object, const Ref<Component>& emission, Location at) {
  set_emission(*object, emission, at);
  reader.add_light(object);
}

void point(Reader& reader, const Parameters& p) {
  const Ref<Component> emission = reader.make("DiffuseEmission", p.at);
  set_member(*emission, "radiance", scaled_light(reader, p, "I", power_factor(p, 4 * pi)), p.at);
  const Ref<Component> object = placed(reader, "Point", p);
  set_member(*object, "position", list(p.point("from", {0, 0, 0})), p.at);
  add_light(reader, object, emission, p.at);
}

void spot(Reader& reader, const Parameters& p) {
  const double outer = p.number("coneangle", 30);
  // pbrt uses only the cosine of the angle: if the border is wider than the cone, it begins on the other side of the axis.
  double inner = std::abs(outer - p.number("conedeltaangle", 5));
  if (!(outer > 0 && outer <= 180)) throw Error("'coneangle' must be more than 0 and at most 180", p.place("coneangle"));
  if (!(inner <= outer)) {
    reader.importing.inexact("a 'conedeltaangle' that ends outside of the cone is no border here", p.place("conedeltaangle"));
    inner = outer;
  }
  const double begin = std::cos(inner * pi / 180), end = std::cos(outer * pi / 180);
  const bool quartic = reader.version == 3;
  const Ref<Component> emission = reader.make(quartic ? "ForeignSpotEmission" : "SpotEmission", p.at);
  set_member(*emission, "radiance", scaled_light(reader, p, "I", power_factor(p, 2 * pi * ((1 - begin) + (begin - end) / 2))),
             p.at);
  const DoublePoint3 from = p.point("from", {0, 0, 0});
  set_member(*emission, "axis", way(from, p.point("to", {0, 0, 1}), p), p.at);
  set_member(*emission, "inner_angle", inner, p.at);
  set_member(*emission, "outer_angle", outer, p.at);
  if (quartic) set_member(*emission, "edge", "quartic", p.at);
  const Ref<Component> object = placed(reader, "Point", p);
  set_member(*object, "position", list(from), p.at);
  add_light(reader, object, emission, p.at);
}

void distant(Reader& reader, const Parameters& p) {
  const Ref<Component> emission = reader.make("DiffuseEmission", p.at);
  // A radiance of 1 means an irradiance of 1 on a plane perpendicular to the light; v4's "illuminance" states it instead.
  const double lux = p.number("illuminance", -1);
  set_member(*emission, "radiance", scaled_light(reader, p, "L", lux > 0 ? lux : 1), p.at);
  const Ref<Component> object = placed(reader, "Distant", p);
  set_member(*object, "direction", way(p.point("from", {0, 0, 0}), p.point("to", {0, 0, 1}), p), p.at);
  add_light(reader, object, emission, p.at);
}

/// The integral of an image's luminance over directions as pbrt computes it: evaluated at texel centres, where an area on the
/// plane at distance 1 covers cos^3 times as much solid angle.
double projected_power(const FilePath& file, double fov) {
  LinearImage image;
  try {
    image = read_linear_image(file.resolved(), automatic_transfer);
  } catch (const Error&) {
    return 0;  // reported by the light
  }
  const double aspect = double(image.width) / image.height, half = std::tan(fov * pi / 360), a = half * std::max(aspect, 1.0),
               b = half * std::max(1 / aspect, 1.0);
  const auto& xyz = rgb_space("srgb").to_xyz;
  double sum = 0;
  for (size_t i = 0; i < image.rgb.size() / 3; ++i) {
    const double x = a * (2 * (double(i % size_t(image.width)) + 0.5) / image.width - 1),
                 y = b * (2 * (double(i / size_t(image.width)) + 0.5) / image.height - 1);
    for (size_t c = 0; c < 3; ++c) sum += xyz[3 + c] * double(image.rgb[3 * i + c]) * std::pow(1 + x * x + y * y, -1.5);
  }
  return sum * 4 * a * b / (double(image.width) * image.height);
}

/// pbrt's light faces +z with the image's right towards +x and its top towards -y: ours rotated by 180 degrees.
void projection(Reader& reader, const Parameters& p) {
  const auto file = image_file(reader, p, p.has("mapname") ? "mapname" : "filename");
  if (!file) return;
  const Ref<Component> emission = reader.make("ProjectorEmission", p.at);
  set_member(*emission, "file", *file, p.at);
  const double fov = p.number("fov", reader.version == 3 ? 45 : 90);
  set_member(*emission, "fov", fov, p.at);
  set_member(*emission, "fov_axis", "smaller", p.at);
  set_member(*emission, "even", "directions", p.at);
  double scale = p.number("scale", 1) * reader.exposure;
  if (const double power = p.number("power", -1); power > 0)
    if (const double given = projected_power(*file, fov); given > 0) scale *= power / given;
  set_member(*emission, "scale", scale, p.at);
  if (p.has("I")) reader.importing.inexact("the intensity of a projection light is that of its image", p.place("I"));
  if (reader.version == 4)
    reader.importing.inexact("a projected image is smooth between the middles of its texels, which are squares in pbrt", p.at);
  add_light(reader, placed(reader, "Point", p, Transform::rotate(pi, {0, 0, 1})), emission, p.at);
}

// v4's image is an equal-area square with +y at the centre, x to the right and z downwards, without interpolation between
// texels; only the mean of its channels counts. v3's is in longitude, from +x over +z, and latitude, from +y.
void goniometric(Reader& reader, const Parameters& p) {
  const bool v3 = reader.version == 3;
  const char* name = p.has("mapname") ? "mapname" : "filename";
  const double power = p.number("power", -1);
  const std::optional<FilePath> file = p.has(name) ? image_file(reader, p, name) : std::nullopt;
  if (!file) {
    const Ref<Component> emission = reader.make("DiffuseEmission", p.at);
    set_member(*emission, "radiance", scaled_light(reader, p, "I", power_factor(p, 4 * pi)), p.at);
    add_light(reader, placed(reader, "Point", p), emission, p.at);
    return;
  }
  const Ref<Component> emission = reader.make("GoniometricEmission", p.at);
  set_member(*emission, "file", *file, p.place(name));
  set_member(*emission, "radiance", scaled_light(reader, p, "I"), p.at);
  if (!v3) {
    set_member(*emission, "layout", "equal_area", p.at);
    set_member(*emission, "interpolation", "nearest", p.at);
    if (power > 0) set_member(*emission, "luminous_flux", power * p.number("scale", 1) * luminous_unit * reader.exposure, p.at);
  } else if (colored(*file)) {
    reader.importing.inexact("of the image of a goniometric light the mean of red, green and blue counts", p.place(name));
  }
  using M = Transform::DoubleMatrix;
  const Transform inner = v3 ? Transform(M{0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0}) : Transform::scale({1, 1, -1});
  add_light(reader, placed(reader, "Point", p, inner), emission, p.at);
}

}  // namespace

void set_emission(Component& object, const Ref<Component>& emission, Location at) {
  set_member(object, "emission", emission, at);
}

Ref<Component> area_emission(Reader& reader, AreaLight& light, bool turned, size_t pieces) {
  Ref<Component>& made = light.made[turned ? 1 : 0];
  const Parameters& p = light.parameters;
  const double power = p.number("power", -1);
  if (made && power <= 0) return made;
  const Location at = p.at;
  const bool two_sided = p.boolean("twosided", false);
  const Ref<Component> emission = reader.make("DiffuseEmission", at);
  set_member(*emission, "sides", two_sided ? "both" : turned ? "back" : "front", at);
  if (p.has("filename")) {
    if (const auto file = image_file(reader, p, "filename")) {
      const Ref<Component> image = reader.make("ImageMap", at), product = reader.make("MultiplyMap", at);
      set_member(*image, "file", *file, at);
      set_member(*image, "wrap", "clamp", at);
      set_member(*product, "first", image, at);
      set_member(*product, "second", p.number("scale", 1) * reader.exposure, at);
      set_member(*emission, "radiance", product, at);
    }
  } else {
    set_member(*emission, "radiance", scaled_light(reader, p, "L"), at);
  }
  if (power > 0) {
    // In pbrt each triangle is a light of this power, times its scale.
    set_member(*emission, "luminous_flux", power * p.number("scale", 1) * luminous_unit * reader.exposure * double(pieces), at);
    if (pieces > 1)
      reader.importing.inexact("each triangle of a light has the power given in pbrt; here they have it together, by area", at);
  }
  p.ignore({"nsamples", "samples"});
  if (!made) p.tell_unused(reader.importing);
  made = emission;
  return made;
}

void make_light(Reader& reader, const std::string& type, Parameters&& p) {
  p.ignore({"nsamples", "samples"});
  if (type == "point")
    point(reader, p);
  else if (type == "spot")
    spot(reader, p);
  else if (type == "distant")
    distant(reader, p);
  else if (type == "infinite" || type == "exinfinite")
    make_environment(reader, p);
  else if (type == "projection")
    projection(reader, p);
  else if (type == "goniometric")
    goniometric(reader, p);
  else
    throw LeftOut(fmt::format("there is no light '{}'{}", type,
                              suggestion(type, {"point", "spot", "distant", "infinite", "projection", "goniometric"})),
                  p.at);
  p.tell_unused(reader.importing);
}

}  // namespace etendue::pbrt
