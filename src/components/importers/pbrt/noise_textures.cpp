// Textures of noise: as bright as pbrt's, with another pattern.
//
// pbrt sums octaves of Perlin's noise of 2002, whose amplitude is that of the noise here, without dividing by the sum of their
// weights, S = 1 + omega + ... + omega^(octaves - 1):
//
//   FBm = sum omega^i noise(1.99^i p)             = S (2 F - 1), where F is the value of an FbmMap from 0 to 1
//   Turbulence = sum omega^i |noise(1.99^i p)|    = S T, where T is that of a TurbulenceMap; plus 0.2 omega^octaves, pbrt's
//   mean
//                                                   of |noise| times the weight of one octave more
//
// Formulas of these maps keep a colour from being negative, as pbrt does with reflectances.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reader.h"

namespace etendue::pbrt {

namespace {

constexpr double lacunarity = 1.99;

/// A sum of octaves of noise.
struct Octaves {
  int count;
  double weight;  ///< of an octave relative to the one before: omega

  static Octaves of(const Parameters& p) {
    return {std::clamp(p.integer("octaves", 8), 0, 24), std::clamp(p.number("roughness", 0.5), 0.0, 1.0)};
  }
  double sum() const {
    double all = 0;
    for (int i = 0; i < count; ++i) all += std::pow(weight, i);
    return all;
  }
  /// A map of their sum divided by `sum()`.
  Value map(const Reader& reader, const char* class_name, double size, Location at) const {
    const Ref<Component> made = reader.make(class_name, at);
    set_member(*made, "space", "world", at);
    set_member(*made, "size", size, at);
    set_member(*made, "lacunarity", lacunarity, at);
    set_member(*made, "octaves", std::max(count, 1), at);
    set_member(*made, "gain", weight, at);
    return Value(made, at);
  }
  /// FBm as a formula of an FbmMap.
  std::string fbm(const char* name) const { return fmt::format("({} * (2 * {} - 1))", sum(), name); }
};

// |FBm(0.1 p)| FBm(p), of 3 and 6 octaves: waves that a wind of changing strength makes.
Ref<Component> windy(Reader& reader, Location at) {
  const Octaves wind{3, 0.5}, waves{6, 0.5};
  return formula(reader, at, fmt::format("abs({}) * {}", wind.fbm("wind"), waves.fbm("waves")),
                 {{"wind", wind.map(reader, "FbmMap", 10, at)}, {"waves", waves.map(reader, "FbmMap", 1, at)}});
}

// t = (1 + sin(y + variation FBm(p))) / 2, where p is scaled, chooses the colour: 1.5 times a cubic Bézier curve of four
// consecutive ones of nine colours, in six parts.
Ref<Component> marble(Reader& reader, const Parameters& p) {
  const Location at = p.at;
  const double scale = p.number("scale", 1), variation = scale == 0 ? 0 : p.number("variation", 0.2);
  const Octaves octaves = Octaves::of(p);
  const Ref<Component> place =
      formula(reader, at, fmt::format("0.5 + 0.5 * sin({} * y + {} * {})", scale, variation, octaves.fbm("noise")),
              {{"noise", octaves.map(reader, "FbmMap", scale == 0 ? 1 : 1 / std::abs(scale), at)}});
  set_member(*place, "space", "world", at);

  struct Knot {
    const char* name;
    std::array<double, 3> rgb;
  };
  static constexpr Knot base{"base", {0.58, 0.58, 0.6}}, grey{"grey", {0.5, 0.5, 0.5}}, warm{"warm", {0.6, 0.59, 0.58}},
      vein{"vein", {0.2, 0.2, 0.33}};
  static constexpr std::array knots{&base, &base, &base, &grey, &warm, &base, &base, &vein, &base};
  constexpr size_t parts = knots.size() - 3;
  // s counts the parts; t is kept below 1, so that the last part does not end.
  const std::string s = fmt::format("({} * min(t, 0.999999))", parts), f = fmt::format("fract({})", s);
  const std::array bernstein{fmt::format("pow(1 - {}, 3)", f), fmt::format("3 * {0} * pow(1 - {0}, 2)", f),
                             fmt::format("3 * pow({0}, 2) * (1 - {0})", f), fmt::format("pow({}, 3)", f)};
  std::string text = "base";  // plus the weighted differences of the other colours
  for (const Knot* knot : {&grey, &warm, &vein})
    for (size_t part = 0; part < parts; ++part)
      for (size_t i = 0; i < bernstein.size(); ++i)
        if (knots[part + i] == knot)
          text += fmt::format(" + (step({0}, {2}) - step({1}, {2})) * {3} * ({4} - base)", part, part + 1, s, bernstein[i],
                              knot->name);
  std::vector<std::pair<std::string, Value>> maps{{"t", Value(place, at)}};
  for (const Knot* knot : {&base, &grey, &warm, &vein}) {
    const Ref<Component> map = reader.make("ConstantMap", at);
    constexpr double brighter = 1.5;
    set_member(*map, "value", rgb_color("srgb", brighter * knot->rgb[0], brighter * knot->rgb[1], brighter * knot->rgb[2]), at);
    maps.emplace_back(knot->name, Value(map, at));
  }
  return formula(reader, at, text, maps);
}

}  // namespace

Ref<Component> noise_texture(Reader& reader, const std::string& type, const Parameters& p) {
  const Location at = p.at;
  reader.importing.inexact(fmt::format("the texture '{}' has the same character as pbrt's, not the same pattern", type), at);
  Ref<Component> map;
  if (type == "marble") {
    if (reader.version == 3)
      reader.importing.inexact("marble has the colours of version 4: those of version 3 are extrapolated far above 1", at);
    map = marble(reader, p);
  } else if (type == "windy") {
    map = windy(reader, at);
  } else {
    const Octaves octaves = Octaves::of(p);
    const bool wrinkled = type == "wrinkled";
    const std::string text = wrinkled
                                 ? fmt::format("{} * noise + {}", octaves.sum(), 0.2 * std::pow(octaves.weight, octaves.count))
                                 : octaves.fbm("noise");
    map = formula(reader, at, text, {{"noise", octaves.map(reader, wrinkled ? "TurbulenceMap" : "FbmMap", 1, at)}});
  }
  if (reader.state.ctm[0].identity()) return map;
  const Ref<Component> outer = reader.make("TransformedMap", at);
  set_member(*outer, "map", map, at);
  set_member(*outer, "transform", AnimatedTransform(reader.state.ctm[0].inverse()), at);
  set_member(*outer, "world", true, at);
  return outer;
}

}  // namespace etendue::pbrt
