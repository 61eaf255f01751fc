// Writes numbers, spectra and transforms in pbrt's syntax.

#include "writer.h"

namespace etendue::pbrt_export {

std::string matrix(const Transform& t) {
  const auto& m = t.exact();
  return fmt::format("[ {} {} {} 0 {} {} {} 0 {} {} {} 0 {} {} {} 1 ]", m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10],
                     m[3], m[7], m[11]);
}

namespace {

std::string triple(const std::array<double, 3>& rgb) { return fmt::format("[ {} {} {} ]", rgb[0], rgb[1], rgb[2]); }

std::string samples(const Color& c, ColorUse use, double factor = 1) {
  std::string text = "[";
  for (const auto& [nm, x] : sampled(c, use)) text += fmt::format(" {} {:.7g}", nm, factor * x);
  return text + " ]";
}

}  // namespace

std::string Writer::spectrum(const char* name, const Color& c, ColorUse use) const {
  if (const auto rgb = written_rgb(c)) return fmt::format(" \"rgb {}\" {}", name, triple(*rgb));
  if (!c->varies()) {
    const float value = c->at(550, use);
    if (use == ColorUse::reflectance) return fmt::format(" \"rgb {}\" [ {} {} {} ]", name, value, value, value);
    return fmt::format(" \"spectrum {}\" [ 360 {} 830 {} ]", name, value, value);
  }
  return fmt::format(" \"spectrum {}\" {}", name, samples(c, use));
}

std::string Writer::light(const char* name, const Color& c) const {
  if (const auto rgb = written_rgb(c)) return fmt::format(" \"rgb {}\" {}", name, triple(*rgb));
  const double y = to_xyz(*c, ColorUse::radiance).y;
  if (!(y > 0)) return fmt::format(" \"rgb {}\" [ 0 0 0 ]", name);
  return fmt::format(" \"spectrum {}\" {} \"float scale\" {}", name, samples(c, ColorUse::radiance, 1 / y), y);
}

std::string Writer::light_of(const Component& emission, const char* name, const SceneObject& object) {
  const Ref<Component> map = part_of(emission, "radiance");
  const Color c = map ? constant_of(*map) : nullptr;
  if (!c) {
    exporting.inexact("light that differs from place to place or with directions is white of 1", &emission);
    return {};
  }
  const double factor = amount_of(emission, *c, object);
  return light(name, factor == 1 ? c : scaled_spectrum(factor, c));
}

// A diffuse luminaire of area A emits pi A times its radiance on each side, a point light 4 pi times its intensity.
double Writer::amount_of(const Component& emission, const SpectralFunction& radiance, const SceneObject& object) {
  for (const char* amount : {"luminous_intensity", "illuminance"})
    if (emission.class_info().find(amount) && number_of(emission, amount) > 0)
      exporting.inexact(fmt::format("an amount of light in '{}' is left out: it is as strong as its radiance says", amount),
                        &emission);
  if (!emission.class_info().find("power")) return 1;
  const double watts = number_of(emission, "power"), lumens = number_of(emission, "luminous_flux");
  if (watts == 0 && lumens == 0) return 1;
  const bool point = object.class_info().name == "Point";
  if (emission.class_info().name != "DiffuseEmission" || object.infinite() || object.class_info().name == "Distant") {
    exporting.inexact("an amount of light is left out: it is as strong as its radiance says", &emission);
    return 1;
  }
  double sum = 0, seen = 0;  // over wavelengths, in W and lm per m^2 and sr
  for (int nm = 360; nm <= 830; ++nm) {
    const auto value = double(radiance.at(float(nm), ColorUse::radiance));
    sum += value;
    seen += 683.002 * observer(float(nm)).y * value;
  }
  // A copy, as preparing may change an object's members.
  const Ref<SceneObject> twin = ref_cast<SceneObject>(copy(object));
  if (!point) prepare_tree(*twin);
  const double each = point ? 4 : double(twin->area(0)) * (word_of(emission, "sides") == "both" ? 2 : 1);
  const double given = 3.14159265358979323846 * each * (watts > 0 ? sum : seen);
  return given > 0 ? (watts > 0 ? watts : lumens) / given : 1;
}

std::string Writer::transform_of(const AnimatedTransform& t, const char* directive) {
  const auto& keys = t.keys();
  if (keys.size() == 1) return t.still().identity() ? "" : fmt::format("{} {}\n", directive, matrix(t.still()));
  if (keys.size() > 2) exporting.inexact("of a motion with more than two keys the first and the last are kept");
  return fmt::format("ActiveTransform StartTime {0} {1}\nActiveTransform EndTime {0} {2}\nActiveTransform All\n", directive,
                     matrix(keys.front().transform), matrix(keys.back().transform));
}

}  // namespace etendue::pbrt_export
