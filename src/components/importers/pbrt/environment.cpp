// Infinite lights.

#include <fmt/format.h>

#include "reader.h"

namespace etendue::pbrt {

namespace {

constexpr double pi = 3.14159265358979323846;

/// From the space of this program's environment, with y up, to that of pbrt's light, with z up. v4's images are equal-area
/// squares that this program unfolds in such a way that a rotation remains. v3's are in longitude and latitude; its longitude
/// runs from +x to +y and ours from -z to +x, with opposite handedness, so that the transform also mirrors.
Transform to_light(bool square) {
  using M = Transform::DoubleMatrix;
  return Transform(square ? M{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0} : M{0, 0, -1, 0, 1, 0, 0, 0, 0, 1, 0, 0});
}

/// An environment's transform without translation and overall scale, since pbrt applies it to directions only.
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

/// The factor of the image from v3's "L" and either version's "scale".
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
  // If the image is missing, version 3 continues with the constant light.
  if (p.has(name) && !file && !v3) return p.forget();
  if (file) {
    set_member(*emission, "file", *file, p.place(name));
    if (!v3) set_member(*emission, "layout", "equal_area", at);
    set_member(*emission, "scale", image_scale(reader, p), at);
    // The scale also multiplies a given illuminance. pbrt sums texels as if they covered 2 pi instead of 4 pi, and so produces
    // twice the requested illuminance.
    if (lux > 0) set_member(*emission, "illuminance", 2 * lux * luminous_unit * image_scale(reader, p), at);
  } else {
    // With a portal pbrt uses an image of one texel, whose light is not divided by its luminance.
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
