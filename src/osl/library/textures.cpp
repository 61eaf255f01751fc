// Rows of the table: lookups of images, and facts about them.

#include <fmt/format.h>

#include "choose.h"
#include "parts.h"
#include "services.h"

namespace etendue::osl {

namespace {

/// The options and the variables to fill that follow the coordinates of a lookup, pairs of a name and a value.
struct Pairs {
  TextureOptions options;
  int alpha = -1, message = -1;  ///< arguments that get the alpha and the error message, or -1

  Pairs(const Call& c, int first);

 private:
  bool number(const Call& c, int i, std::string_view name);
  bool text(const Call& c, int i, std::string_view name);
};

/// "blur", "swidth" and the like: sets one or all three axes.
template <class T>
bool set_axes(std::string_view name, std::string_view option, T (&values)[3], T value) {
  if (name == option) {
    for (T& v : values) v = value;
    return true;
  }
  if (name.size() != option.size() + 1 || !name.ends_with(option)) return false;
  const std::size_t axis = std::string_view("str").find(name[0]);
  if (axis == std::string_view::npos) return false;
  values[axis] = value;
  return true;
}

bool Pairs::number(const Call& c, int i, std::string_view name) {
  const Type& type = c.type(i);
  if (!type.is_float() && !type.is_int()) return false;
  const float value = type.is_int() ? float(c.at<int>(i)) : c.at<float>(i);
  if (set_axes(name, "blur", options.blur, value) || set_axes(name, "width", options.width, value)) return true;
  if (name == "firstchannel")
    options.first_channel = int(value);
  else if (name == "subimage")
    options.subimage = int(value);
  else if (name == "fill")
    options.fill = value;
  else if (name == "time")
    options.time = value;
  else if (name == "missingalpha")
    options.missing_alpha = value;
  else
    return false;
  return true;
}

bool Pairs::text(const Call& c, int i, std::string_view name) {
  if (!c.type(i).is_string()) return false;
  const String* value = c.string(i);
  static const String* const unset = intern_string("default");
  if (set_axes(name, "wrap", options.wrap, value == unset ? nullptr : value)) return true;
  if (name == "interp")
    options.interpolation = value;
  else if (name == "subimage")
    options.subimage_name = value;
  else if (name == "colorspace")
    options.color_space = value;
  else
    return false;
  return true;
}

Pairs::Pairs(const Call& c, int first) {
  for (int i = first; i + 1 < c.count(); i += 2) {
    if (!c.type(i).is_string()) {
      c.services.error("Options of a texture are pairs of a name and a value", c.types.place);
      return;
    }
    const std::string_view name = c.string(i)->view();
    const Type& type = c.type(i + 1);
    if (name == "alpha" && type.is_float())
      alpha = i + 1;
    else if (name == "errormessage" && type.is_string())
      message = i + 1;
    else if (name == "missingcolor" && type.is_triple())
      options.missing_color = c.at<Triple>(i + 1), options.has_missing_color = true;
    else if (!number(c, i + 1, name) && !text(c, i + 1, name))
      c.services.warn(fmt::format("Unknown texture optional argument: \"{}\", <{}>", name, type.name()), c.types.place);
  }
}

/// A file's images but the first are not read. Asking for another is refused, not answered by the first.
constexpr std::string_view no_subimages = "the option \"subimage\" is not supported: only the first image of a file is read";
std::string_view other_part(const TextureOptions& options) {
  const String* name = options.subimage_name;
  return options.subimage == 0 && (!name || name->view().empty()) ? std::string_view() : no_subimages;
}

/// Writes what a lookup found, or its failure. A color for missing files does not hide what is not supported. `chain` gives the
/// derivatives of a value by those of the coordinates.
template <bool D, class Chain>
void give(const Call& c, const Pairs& pairs, TextureLookup& found, std::string_view fault, Chain&& chain) {
  static const String* const unknown = intern_string("unknown texture error");
  if (!fault.empty()) {
    for (int k = 0; k < 4; ++k) found.value[k] = found.by_s[k] = found.by_t[k] = found.by_r[k] = 0;
    const bool refused = fault == no_subimages || fault == Services::no_solid_textures;
    if (pairs.options.has_missing_color && !refused) {
      for (int k = 0; k < found.channels; ++k) found.value[k] = pairs.options.missing_color[k];
      found.value[found.channels] = pairs.options.missing_alpha;
      fault = {};
    } else if (pairs.message < 0) {
      c.services.error(fault, c.types.place);
    }
  }
  if (pairs.message >= 0)
    c.at<const String*>(pairs.message) =
        fault.empty() ? empty_string() : (interned_bytes() < interned_limit ? intern_string(fault) : unknown);
  float* to = static_cast<float*>(c.result);
  for (int k = 0; k < found.channels; ++k)
    if constexpr (D)
      detail::set<Dual<float>>(to + k, found.channels, chain(k));
    else
      to[k] = found.value[k];
  if (pairs.alpha >= 0) c.give(pairs.alpha, chain(found.channels));
}

TextureLookup lookup_for(const Call& c, const Pairs& pairs, bool derivatives) {
  TextureLookup lookup;
  lookup.channels = c.types.result.type.is_triple() ? 3 : 1;
  lookup.wants_alpha = pairs.alpha >= 0;
  lookup.wants_derivatives = derivatives || (pairs.alpha >= 0 && c.derivatives(pairs.alpha));
  return lookup;
}

/// texture(file, s, t, ...), texture(file, s, t, dsdx, dtdx, dsdy, dtdy, ...)
template <bool given>
struct Texture {
  template <bool D>
  static void evaluate(const Call& c) {
    Dual<float> s = c.get<Dual<float>>(1), t = c.get<Dual<float>>(2);
    if (given) s.dx = c.at<float>(3), t.dx = c.at<float>(4), s.dy = c.at<float>(5), t.dy = c.at<float>(6);
    const Pairs pairs(c, given ? 7 : 3);
    TextureLookup found = lookup_for(c, pairs, D);
    std::string_view fault = other_part(pairs.options);
    if (fault.empty()) fault = c.services.texture(c.string(0), s, t, pairs.options, found);
    give<D>(c, pairs, found, fault, [&](int k) { return chain(found.value[k], found.by_s[k], s, found.by_t[k], t); });
  }
};

/// texture3d(file, p, ...), texture3d(file, p, dpdx, dpdy, dpdz, ...), environment(file, r, ...), environment(file, r, drdx,
/// drdy, ...)
template <bool solid, bool given>
struct Texture3d {
  template <bool D>
  static void evaluate(const Call& c) {
    Dual<Triple> p = c.get<Dual<Triple>>(1);
    if (given) p.dx = c.at<Triple>(2), p.dy = c.at<Triple>(3);
    const Pairs pairs(c, !given ? 2 : (solid ? 5 : 4));
    TextureLookup found = lookup_for(c, pairs, D);
    std::string_view fault = other_part(pairs.options);
    if (fault.empty())
      fault = solid ? c.services.texture3d(c.string(0), p, pairs.options, found)
                    : c.services.environment(c.string(0), p, pairs.options, found);
    give<D>(c, pairs, found, fault, [&](int k) {
      return chain(found.value[k], found.by_s[k], p[0], found.by_t[k], p[1]) + chain(0, found.by_r[k], p[2]);
    });
  }
};

/// int gettextureinfo(file, [s, t,] name, output value)
void texture_info(const Call& c) {
  const int value = c.count() - 1;
  const float at[2] = {value > 2 ? c.at<float>(1) : 0, value > 2 ? c.at<float>(2) : 0};
  c.give(int(
      c.services.texture_info(c.string(0), value > 2 ? at : nullptr, c.string(value - 1), c.type(value), c.arguments[value])));
}

constexpr Derivatives taken = Derivatives::taken;

constexpr Row rows[] = {
    {"TYPE texture(string file, float s, float t, float dsdx, float dtdx, float dsdy, float dtdy, output ...)",
     with_derivatives<Texture<true>>, Derivatives::passed, 0, nullptr, false},
    {"TYPE texture(string file, float s, float t, output ...)", with_derivatives<Texture<false>>, taken, 6, nullptr, false},
    {"TYPE texture3d(string file, point p, vector dpdx, vector dpdy, vector dpdz, output ...)",
     with_derivatives<Texture3d<true, true>>, Derivatives::passed, 0, nullptr, false},
    {"TYPE texture3d(string file, point p, output ...)", with_derivatives<Texture3d<true, false>>, taken, 2, nullptr, false},
    {"TYPE environment(string file, vector r, vector drdx, vector drdy, output ...)", with_derivatives<Texture3d<false, true>>,
     Derivatives::passed, 0, nullptr, false},
    {"TYPE environment(string file, vector r, output ...)", with_derivatives<Texture3d<false, false>>, taken, 2, nullptr,
     false},
    {"int gettextureinfo(string file, string name, output ANY value)", always<texture_info>, Derivatives::none, 0, nullptr,
     false},
    {"int gettextureinfo(string file, float s, float t, string name, output ANY value)", always<texture_info>,
     Derivatives::none, 0, nullptr, false},
};

}  // namespace

std::span<const Row> texture_rows() { return rows; }

}  // namespace etendue::osl
