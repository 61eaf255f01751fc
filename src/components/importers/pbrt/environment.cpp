// Light from infinitely far away.

#include <fmt/format.h>

#include "reader.h"

namespace etendue::pbrt {

namespace {

constexpr double pi = 3.14159265358979323846;

/// From our environment's coordinates, where y is up, to pbrt's light's, where z is. v4's images are squares that this
/// program unfolds so that it is but a turn. v3's are in longitude and latitude, with longitude from +x to +y where ours goes
/// from -z to +x, seen from outside instead of inside: it mirrors.
Transform to_light(bool square) {
  using M = Transform::DoubleMatrix;
  return Transform(square ? M{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0} : M{0, 0, -1, 0, 1, 0, 0, 0, 0, 1, 0, 0});
}

/// An environment can be turned and mirrored, but what stretches it is left out, as pbrt does with directions.
Transform directions_only(Reader& reader, const Transform& inner, Location at) {
  const Transform whole = reader.of_light(inner, at);
  if (!whole.valid()) throw Error("the light's transform cannot be inverted", at);
  Transform::DoubleMatrix m = whole.exact();
  double longest = 0;
  for (size_t c = 0; c < 3; ++c)
    longest = std::max(longest, std::sqrt(m[c] * m[c] + m[4 + c] * m[4 + c] + m[8 + c] * m[8 + c]));
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) m[4 * r + c] /= longest;
    m[4 * r + 3] = 0;
  }
  return Transform(m);
}

/// How many times brighter than its image v3's "L" and either version's "scale" make it.
double image_scale(Reader& reader, const Parameters& p) {
  double scale = reader.exposure;
  for (const char* name : {"L", "scale"}) {
    const Parameter* given = p.find(name);
    if (!given) continue;
    if (given->is("float") || (given->is("spectrum") && given->numbers.size() == 1)) {
      scale *= given->numbers.at(0);
      continue;
    }
    const Color color = spectrum_of(reader, p, *given, Use::coefficient);
    const ValueRange range = range_of(*color, ColorUse::coefficient);
    if (range.most - range.least > 1e-3f * range.most)
      reader.importing.inexact(fmt::format("a coloured '{}' of an environment's image is its brightness here", name),
                               given->at);
    scale *= double(to_xyz(*color, ColorUse::coefficient).y);
  }
  return scale;
}

}  // namespace

void make_environment(Reader& reader, const Parameters& p) {
  const Location at = p.at;
  const bool v3 = reader.version == 3;
  const Ref<Component> emission = reader.make("EnvironmentEmission", at);
  const char* name = p.has("mapname") ? "mapname" : "filename";
  const double lux = v3 ? -1 : p.number("illuminance", -1);
  const std::optional<FilePath> file = p.has(name) ? image_file(reader, p, name) : std::nullopt;
  // Where the image is missing, version 3 goes on with the light alone.
  if (p.has(name) && !file && !v3) return p.forget();
  if (file) {
    set_member(*emission, "file", *file, p.place(name));
    if (!v3) set_member(*emission, "layout", "equal_area", at);
    set_member(*emission, "scale", image_scale(reader, p), at);
    // The scale counts beside an illuminance too. pbrt adds up texels as if all of them were 2 pi instead of 4 pi, and gets
    // twice the illuminance that is asked for.
    if (lux > 0) set_member(*emission, "illuminance", 2 * lux * luminous_unit * image_scale(reader, p), at);
  } else {
    // What shines through a portal is an image of one texel, whose light is not divided by its luminance.
    const Light light = light_of(reader, p, "L", p.has("portal") ? Use::coefficient : Use::light);
    set_member(*emission, "radiance", light.color, at);
    set_member(*emission, "scale", light.scale * (lux > 0 ? lux / pi : 1), at);
  }
  if (p.has("portal"))
    reader.importing.inexact(
        "the portal is left out: the environment shines in wherever the scene is open, as it does in pbrt in a room that is "
        "closed but for the portal",
        p.place("portal"));
  const Ref<Component> object = reader.make("Environment", at);
  set_member(*object, "transform", AnimatedTransform(directions_only(reader, to_light(!v3), at)), at);
  set_emission(*object, emission, at);
  reader.add_light(object);
}

}  // namespace etendue::pbrt
