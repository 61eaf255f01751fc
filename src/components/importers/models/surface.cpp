#include "surface.h"

#include <algorithm>
#include <cmath>

#include "components/shaders/layered/sheen.h"
#include "etendue/describe/color.h"
#include "language/writer.h"

namespace etendue {
namespace {

constexpr double coat_ior = 1.5;
constexpr double sharpest_fibres = double(SheenLobe::sharpest);

class SurfaceMaker {
 public:
  SurfaceMaker(Importing& importing, const Surface& surface, Location at) : importing_(importing), s_(surface), at_(at) {}

  MadeSurface make() {
    MadeSurface made;
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
    if (s_.opacity.texture || !s_.opacity.attribute.empty() || s_.opacity.value < 1) {
      made.shader = with_holes(made.shader);
      if (made.emission) importing_.inexact("the light of a surface does not become less where it is transparent", at_);
    }
    return made;
  }

  /// None: it is the same everywhere.
  Ref<Component> color_map(const SurfaceColor& c) const {
    const std::array<double, 3> none{0, 0, 0}, one{1, 1, 1};
    Ref<Component> texture, vertices;
    if (c.texture && (!c.black() || c.offset != none)) texture = image(*c.texture, {}, false);
    if (c.by_vertex) {
      vertices = part("AttributeMap");
      set_member(*vertices, "otherwise", 1.0, at_);
    }
    const Ref<Component> map = texture ? texture : vertices;
    const bool moved = texture && c.offset != none;
    if (!map || (c.value == one && !moved && !(texture && vertices))) return map;
    Ref<Component> all = part("RgbProductMap");
    put(*all, "first", map, at_);
    if (texture && vertices) put(*all, "second", vertices, at_);
    const auto three = [](const std::array<double, 3>& x) { return Numbers{{x[0], x[1], x[2]}, 1, Dimension::none}; };
    if (c.value != one) set_member(*all, "factor", three(c.value), at_);
    if (moved) set_member(*all, "offset", three(c.offset), at_);
    return all;
  }

 private:
  Ref<Component> part(const char* class_name, const std::string& name = {}) const {
    return importing_.make(class_name, at_, name.empty() ? name : plain_name(name));
  }
  static void put(Component& to, std::string_view member, const Ref<Component>& value, Location at) {
    set(to, member, Value(value, at));
  }

  Ref<Component> image(const SurfaceTexture& t, const std::string& channel, bool linear) const {
    Ref<Component> map = part("ImageMap");
    set_member(*map, "file", FilePath{t.file, {}}, at_);
    if (!channel.empty()) set_member(*map, "channel", channel, at_);
    if (!t.transfer.empty())
      set_member(*map, "transfer", t.transfer, at_);
    else if (linear)
      set_member(*map, "transfer", "linear", at_);
    set_member(*map, "wrap", t.wrap, at_);
    const bool differ = !t.wrap_v.empty() && t.wrap_v != t.wrap;
    if (differ) set_member(*map, "wrap_v", t.wrap_v, at_);
    if (t.nearest) set_member(*map, "interpolation", "nearest", at_);
    const auto pair = [](const std::array<double, 2>& p) { return Numbers{{p[0], p[1]}, 1, Dimension::none}; };
    std::array<double, 2> shift = t.shift;
    if (t.wrap == "repeat" && !differ && std::abs(t.angle) < 1e-9)
      for (double& x : shift)
        if (std::abs(x - std::round(x)) < 1e-9) x = 0;
    if (std::abs(t.angle) < 1e-9 && shift[0] == 0 && shift[1] == 0) {
      if (t.scale[0] != 1 || t.scale[1] != 1) set_member(*map, "repeat", pair(t.scale), at_);
      return map;
    }
    Ref<Component> moved = part("UvTransformMap");
    put(*moved, "map", map, at_);
    if (t.scale[0] != 1 || t.scale[1] != 1) set_member(*moved, "scale", pair(t.scale), at_);
    if (t.angle != 0) set_member(*moved, "angle", Number{t.angle, Dimension::angle}, at_);
    set_member(*moved, "shift", pair(shift), at_);
    return moved;
  }

  Ref<Component> product(const Ref<Component>& first, const Value& second) const {
    Ref<Component> map = part("MultiplyMap");
    put(*map, "first", first, at_);
    set(*map, "second", second);
    return map;
  }

  /// Sets a member that is a number or a map of numbers; when it is the default nothing is written.
  void number(Component& to, std::string_view member, const SurfaceNumber& n) const {
    const double said = std::isfinite(n.value) ? n.value : 0, value = n.squared ? said * said : said;
    if (Ref<Component> map = number_map(n))
      put(to, member, map, at_);
    else
      set_member(to, member, value, at_);
  }

  /// None: it is the same everywhere.
  Ref<Component> number_map(const SurfaceNumber& n) const {
    Ref<Component> map;
    if (n.texture && n.value != 0) {
      map = image(*n.texture, n.channel, n.channel != "A");
      if (n.inverted) {
        Ref<Component> turned = part("RemapMap");
        put(*turned, "input", map, at_);
        set_member(*turned, "to", Numbers{{1, 1 - n.inverted_share}, 1, Dimension::none}, at_);
        map = turned;
      }
    }
    if (!n.attribute.empty()) {
      Ref<Component> vertices = part("AttributeMap");
      set_member(*vertices, "name", n.attribute, at_);
      set_member(*vertices, "otherwise", 1.0, at_);
      map = map ? product(map, Value(vertices, at_)) : vertices;
    }
    if (map && n.offset != 0) {
      Ref<Component> moved = part("RemapMap");
      put(*moved, "input", map, at_);
      set_member(*moved, "to", Numbers{{n.offset, n.offset + n.value}, 1, Dimension::none}, at_);
      return moved;
    }
    if (map && n.value != 1) map = product(map, Value(Number{n.value}, at_));
    if (map && n.squared) {
      Ref<Component> square = part("PowerMap");
      put(*square, "base", map, at_);
      set_member(*square, "exponent", 2.0, at_);
      return square;
    }
    return map;
  }

  void color(Component& to, std::string_view member, const SurfaceColor& c) const {
    if (std::ranges::any_of(c.value, [](double x) { return x > 1; }) && member != "radiance")
      importing_.inexact("a surface cannot reflect more light than it gets: colours above 1 become 1", at_);
    if (Ref<Component> map = color_map(c))
      put(to, member, map, at_);
    else
      set(to, member, color_value(c.value, at_));
  }

  double within(double value, double low, double high, const char* what) const {
    const double kept = std::clamp(std::isfinite(value) ? value : low, low, high);
    if (kept != value) importing_.inexact(fmt::format("{} of {} becomes {}", what, value, kept), at_);
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

  // What a coat covers reflects in glTF, MTL and UsdPreviewSurface as if it were bare; in Principled by its index against the
  // coat's, which must therefore be higher by as much. Of what refracts or has a film the index itself is needed.
  double ior_below_coat() const {
    if (!is_there(s_.coat) || s_.coat.texture || is_there(s_.transmission) || is_there(s_.film)) return s_.ior;
    const double covered = std::min(s_.coat.value, 1.0);
    return s_.ior / (1 - covered + covered / coat_ior);
  }

  // Light gets to what is below as far as the strongest colour of the fibres leaves it (KHR_materials_sheen: 1 - max(colour)
  // E), so that this is the fraction of the surface which has them.
  void sheen(Component& p) const {
    SurfaceColor fibres = s_.sheen_color;
    const double most = std::ranges::max(fibres.value), weight = std::min(most, 1.0);
    if (most < 1)
      for (double& x : fibres.value) x /= most;
    if (fibres.texture)
      importing_.inexact("fibres whose colour is an image's hide as much everywhere as where it is white", at_);
    const SurfaceNumber& r = s_.sheen_roughness;
    if (const double least = r.squared ? std::sqrt(sharpest_fibres) : sharpest_fibres; !r.texture && r.value < least)
      importing_.inexact(fmt::format("a roughness of fibres of {} becomes {:.2f}", r.value, least), at_);
    set_member(p, "fuzz_weight", weight, at_);
    color(p, "fuzz_color", fibres);
    number(p, "fuzz_roughness", s_.sheen_roughness);
  }

  static bool is_there(const SurfaceNumber& n) { return n.value > 0; }

  Ref<Component> emission(const SurfaceColor& c) const {
    Ref<Component> emission = part("DiffuseEmission");
    color(*emission, "radiance", c);
    if (s_.emits_backwards) set_member(*emission, "sides", "both", at_);
    return emission;
  }

  /// What light loses on its way: after the distance the colour is left of white, so that it loses -ln(colour) / distance.
  /// The spectrum of the colour says how much of each wavelength is left; of a spectrum whose colour is the logarithm's,
  /// another colour would be left (0.82, 0.40, 0.19 for 0.9, 0.4, 0.2).
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

  // An image that is turned is only looked up elsewhere: its normals still lean along the mesh's own u and v.
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
      put(*tilted, "map", image(t, {}, true), at_);
    }
    if (const double strength = s_.normals->strength; std::isfinite(strength) && strength != 1)
      set_member(*tilted, "strength", strength, at_);
    if (s_.normals->downwards) set_member(*tilted, "flip_y", true, at_);
    return tilted;
  }

  Ref<Component> with_bumps(const Ref<Component>& shader) const {
    Ref<Component> bumpy = part("BumpShader");
    put(*bumpy, "shader", shader, at_);
    put(*bumpy, "height", image(*s_.bumps, {}, true), at_);
    set_member(*bumpy, "scale", s_.bump_height, at_);
    return bumpy;
  }

  Ref<Component> with_holes(const Ref<Component>& shader) const {
    Ref<Component> mask = part("MaskShader");
    put(*mask, "shader", shader, at_);
    Ref<Component> map = number_map(s_.opacity);
    if (!s_.opacity_cutoff) {
      number(*mask, "opacity", s_.opacity);
    } else if (!map) {
      set_member(*mask, "opacity", s_.opacity.value >= *s_.opacity_cutoff ? 1.0 : 0.0, at_);
    } else {
      Ref<Component> step = part("RemapMap");
      put(*step, "input", map, at_);
      set_member(*step, "from", Numbers{{*s_.opacity_cutoff - 1e-3, *s_.opacity_cutoff}, 1, Dimension::none}, at_);
      put(*mask, "opacity", step, at_);
    }
    return mask;
  }

  Importing& importing_;
  const Surface& s_;
  Location at_;
};

}  // namespace

MadeSurface make_surface(Importing& importing, const Surface& surface, Location at) {
  return SurfaceMaker(importing, surface, at).make();
}

Ref<Component> surface_color_map(Importing& importing, const SurfaceColor& c, Location at) {
  const Surface none;
  return SurfaceMaker(importing, none, at).color_map(c);
}

Value color_value(const std::array<double, 3>& rgb, Location at) {
  const auto usable = [](double x) { return std::isfinite(x) && x > 0 ? std::min(x, 1e30) : 0.0; };
  const double r = usable(rgb[0]), g = usable(rgb[1]), b = usable(rgb[2]);
  return Value(rgb_color("srgb", r, g, b), at);
}

std::string plain_name(const std::string& name) { return language::plain_name(name); }

}  // namespace etendue
