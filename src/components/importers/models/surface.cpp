#include "surface.h"

#include <algorithm>
#include <cmath>

#include "components/shaders/layered/sheen.h"
#include "etendue/describe/color.h"
#include "language/writer.h"
#include "surface_maps.h"

namespace etendue {
namespace {

constexpr double coat_ior = 1.5;
constexpr double sharpest_fibres = double(SheenLobe::sharpest);

class SurfaceMaker {
 public:
  SurfaceMaker(Importing& importing, const Surface& surface, Location at)
      : importing_(importing), s_(surface), at_(at), maps_(importing, at) {}

  MadeSurface make() {
    MadeSurface made;
    const bool partly = s_.opacity.texture || !s_.opacity.attribute.empty() || s_.opacity.value < 1;
    if (partly) opacity_ = maps_.opacity(s_);
    if (s_.unlit) {
      made.shader = part("Lambertian", s_.name);
      set_member(*made.shader, "color", 0.0, at_);
      made.emission = emission(s_.base_color);
      importing_.inexact("what is unlit gives off its colour as light, on to other surfaces too", at_);
    } else {
      made.shader = principled();
      if (!s_.emission.black()) made.emission = emission(s_.emission);
      made.interior = interior();
    }
    if (s_.normals) made.shader = with_normals(made.shader);
    if (s_.bumps && s_.bump_height != 0) made.shader = with_bumps(made.shader);
    if (partly) made.shader = with_holes(made.shader);
    return made;
  }

 private:
  Ref<Component> part(const char* class_name, const std::string& name = {}) const {
    return importing_.make(class_name, at_, name.empty() ? name : plain_name(name));
  }
  static void put(Component& to, std::string_view member, const Ref<Component>& value, Location at) {
    set(to, member, Value(value, at));
  }

  /// Sets a member to a number or a map of numbers.
  void number(Component& to, std::string_view member, const SurfaceNumber& n) const {
    const double said = std::isfinite(n.value) ? n.value : 0, value = n.squared ? said * said : said;
    if (Ref<Component> map = maps_.number(n))
      put(to, member, map, at_);
    else
      set_member(to, member, value, at_);
  }

  void color(Component& to, std::string_view member, const SurfaceColor& c) const {
    if (std::ranges::any_of(c.value, [](double x) { return x > 1; }))
      importing_.inexact("a surface cannot reflect more light than it gets: colours above 1 become 1", at_);
    if (Ref<Component> map = maps_.color(c))
      put(to, member, map, at_);
    else
      set(to, member, color_value(c.value, at_));
  }

  double within(double value, double low, double high, const char* what) const {
    const double kept = std::clamp(std::isfinite(value) ? value : low, low, high);
    if (kept != value)
      importing_.inexact(fmt::format("{} outside of {} to {} becomes the nearer of them", what, low, high), at_);
    return kept;
  }

  Ref<Component> principled() const {
    Ref<Component> shader = part("Principled", s_.name);
    Component& p = *shader;
    color(p, "base_color", s_.base_color);
    if (is_there(s_.metalness)) number(p, "base_metalness", s_.metalness);
    number(p, "specular_roughness", s_.roughness);
    if (const double ior = ior_below_coat(); ior != 1.5)
      set_member(p, "specular_ior", within(ior, 1, 4, "an index of refraction"), at_);
    if (s_.specular.value != 1 || s_.specular.texture) number(p, "specular_weight", s_.specular);
    if (s_.specular_color.value != std::array<double, 3>{1, 1, 1} || s_.specular_color.texture)
      color(p, "specular_color", s_.specular_color);
    if (is_there(s_.anisotropy)) {
      number(p, "specular_roughness_anisotropy", s_.anisotropy);
      if (s_.anisotropy_rotation != 0) set_member(p, "geometry_tangent_rotation", s_.anisotropy_rotation, at_);
    }
    if (is_there(s_.transmission)) {
      number(p, "transmission_weight", s_.transmission);
      color(p, "transmission_color", s_.transmission_color);
      if (s_.thin) set_member(p, "thin_walled", true, at_);
      if (is_there(s_.translucence) && !s_.thin)
        importing_.inexact("what is matt of a body that refracts lets no light through", at_);
      if (s_.abbe_number > 0) {
        set_member(p, "transmission_dispersion_scale", 1.0, at_);
        set_member(p, "transmission_dispersion_abbe_number", within(s_.abbe_number, 5, 1000, "an Abbe number"), at_);
      }
    }
    if (is_there(s_.translucence) && (s_.thin || !is_there(s_.transmission))) {
      set_member(p, "thin_walled", true, at_);
      number(p, "subsurface_weight", s_.translucence);
      color(p, "subsurface_color", s_.translucent_color);
      set_member(p, "subsurface_scatter_anisotropy", 1.0, at_);
    }
    if (is_there(s_.coat)) {
      number(p, "coat_weight", s_.coat);
      number(p, "coat_roughness", s_.coat_roughness);
      set_member(p, "coat_ior", coat_ior, at_);
      const bool metal = s_.metalness.value >= 1 && !s_.metalness.texture;
      if (!metal && (s_.coat.texture || is_there(s_.transmission)))
        importing_.inexact("what is under a coat reflects by its index against the coat's, not against air's", at_);
      set_member(p, "coat_darkening", 0.0, at_);
    }
    if (!s_.sheen_color.black()) sheen(p);
    if (is_there(s_.film)) {
      number(p, "thin_film_weight", s_.film);
      number(p, "thin_film_thickness", s_.film_thickness);
      set_member(p, "thin_film_ior", within(s_.film_ior, 1, 4, "an index of refraction"), at_);
    }
    return shader;
  }

  // In glTF, MTL and UsdPreviewSurface a coated surface reflects as if it were bare. In Principled its reflectance depends on
  // the ratio of its index to the coat's, so that the index is raised accordingly. Surfaces that refract or have a thin film
  // need their actual index.
  double ior_below_coat() const {
    if (!is_there(s_.coat) || s_.coat.texture || is_there(s_.transmission) || is_there(s_.film)) return s_.ior;
    const double covered = std::min(s_.coat.value, 1.0);
    return s_.ior / (1 - covered + covered / coat_ior);
  }

  // The base below the sheen is scaled by 1 - max(colour) E (KHR_materials_sheen), so that max(colour) becomes the fraction of
  // the surface that has fibres, fuzz_weight.
  void sheen(Component& p) const {
    SurfaceColor fibres = s_.sheen_color;
    const double most = std::ranges::max(fibres.value), weight = std::min(most, 1.0);
    if (most < 1)
      for (double& x : fibres.value) x /= most;
    if (fibres.texture)
      importing_.inexact("fibres whose colour is an image's hide as much everywhere as where it is white", at_);
    const SurfaceNumber& r = s_.sheen_roughness;
    if (const double least = r.squared ? std::sqrt(sharpest_fibres) : sharpest_fibres; !r.texture && r.value < least)
      importing_.inexact(fmt::format("a roughness of fibres below {0:.2f} becomes {0:.2f}", least), at_);
    set_member(p, "fuzz_weight", weight, at_);
    color(p, "fuzz_color", fibres);
    number(p, "fuzz_roughness", s_.sheen_roughness);
  }

  static bool is_there(const SurfaceNumber& n) { return n.value > 0; }

  Ref<Component> emission(const SurfaceColor& c) const {
    Ref<Component> emission = part("DiffuseEmission");
    std::array<double, 3> same = c.value;
    if (!opacity_)
      for (double& x : same) x *= SurfaceMaps::same_opacity(s_);
    SurfaceColor light = c;
    light.value = same;
    if (Ref<Component> map = maps_.emitted(light, opacity_))
      put(*emission, "radiance", map, at_);
    else
      set(*emission, "radiance", color_value(same, at_));
    if (s_.emits_backwards) set_member(*emission, "sides", "both", at_);
    return emission;
  }

  /// The absorption of the interior: of white light the attenuation colour is left after the attenuation distance, so sigma_a =
  /// -ln(colour) / distance. The logarithm is taken per wavelength, of the colour's spectrum; a spectrum made from the
  /// logarithm's RGB would leave another colour (0.82, 0.40, 0.19 for 0.9, 0.4, 0.2).
  Ref<Component> interior() const {
    if (!(is_there(s_.transmission) || is_there(s_.translucence)) || s_.thin || !(s_.attenuation_distance > 0) ||
        !std::isfinite(s_.attenuation_distance))
      return nullptr;
    if (!is_there(s_.transmission)) {
      importing_.inexact("what lets light through diffusely is a sheet here: nothing is lost on the way through its inside",
                         at_);
      return nullptr;
    }
    std::array<double, 3> left = s_.attenuation_color;
    for (double& x : left) x = std::clamp(std::isfinite(x) ? x : 1, 0.0, 1.0);
    if (left == std::array<double, 3>{1, 1, 1}) return nullptr;
    const Color color = rgb_color("srgb", left[0], left[1], left[2]);
    const auto absorbed = [&](float nm) {
      return float(-std::log(std::clamp(double(color->at(nm, ColorUse::reflectance)), 1e-4, 1.0)) / s_.attenuation_distance);
    };
    Color all = flat_spectrum(absorbed(550));
    if (left[0] != left[1] || left[1] != left[2]) {
      std::vector<float> wavelengths, values;
      for (float nm = wavelength_low; nm <= wavelength_high; nm += 10) {
        wavelengths.push_back(nm);
        values.push_back(absorbed(nm));
      }
      all = table_spectrum(std::move(wavelengths), std::move(values));
    }
    Ref<Component> medium = part("HomogeneousVolume", s_.name.empty() ? "" : s_.name + "_inside");
    set(*medium, "absorption", Value(all, at_));
    return medium;
  }

  // A rotated image transform changes only the lookup: the normals in the image still refer to the mesh's own u and v.
  Ref<Component> with_normals(const Ref<Component>& shader) const {
    const SurfaceTexture& t = s_.normals->texture;
    Ref<Component> tilted = part("NormalMapShader");
    put(*tilted, "shader", shader, at_);
    const auto whole = [](double x) { return std::abs(x - std::round(x)) < 1e-6; };
    const bool repeats = t.wrap == "repeat" && (t.wrap_v.empty() || t.wrap_v == t.wrap);
    if (repeats && !t.nearest && std::abs(t.angle) < 1e-6 && whole(t.shift[0]) && whole(t.shift[1])) {
      set_member(*tilted, "file", FilePath{t.file, {}}, at_);
      if (t.scale[0] != 1 || t.scale[1] != 1)
        set_member(*tilted, "repeat", Numbers{{t.scale[0], t.scale[1]}, 1, Dimension::none}, at_);
    } else {
      put(*tilted, "map", maps_.image(t, {}, true), at_);
    }
    if (const double strength = s_.normals->strength; std::isfinite(strength) && strength != 1)
      set_member(*tilted, "strength", strength, at_);
    if (s_.normals->downwards) set_member(*tilted, "flip_y", true, at_);
    return tilted;
  }

  Ref<Component> with_bumps(const Ref<Component>& shader) const {
    Ref<Component> bumpy = part("BumpShader");
    put(*bumpy, "shader", shader, at_);
    put(*bumpy, "height", maps_.image(*s_.bumps, {}, true), at_);
    set_member(*bumpy, "scale", s_.bump_height, at_);
    return bumpy;
  }

  Ref<Component> with_holes(const Ref<Component>& shader) const {
    Ref<Component> mask = part("MaskShader");
    put(*mask, "shader", shader, at_);
    if (opacity_)
      put(*mask, "opacity", opacity_, at_);
    else
      set_member(*mask, "opacity", SurfaceMaps::same_opacity(s_), at_);
    return mask;
  }

  Importing& importing_;
  const Surface& s_;
  Location at_;
  SurfaceMaps maps_;
  Ref<Component> opacity_;  // null: the opacity is constant
};

}  // namespace

MadeSurface make_surface(Importing& importing, const Surface& surface, Location at) {
  return SurfaceMaker(importing, surface, at).make();
}

Ref<Component> surface_color_map(Importing& importing, const SurfaceColor& c, Location at) {
  return SurfaceMaps(importing, at).color(c);
}

Value color_value(const std::array<double, 3>& rgb, Location at) {
  const auto usable = [](double x) { return std::isfinite(x) && x > 0 ? std::min(x, 1e30) : 0.0; };
  const double r = usable(rgb[0]), g = usable(rgb[1]), b = usable(rgb[2]);
  return Value(rgb_color("srgb", r, g, b), at);
}

std::string plain_name(const std::string& name) { return language::plain_name(name); }

}  // namespace etendue
