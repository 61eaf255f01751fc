#include "surface_maps.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

Numbers three(const std::array<double, 3>& x) { return {{x[0], x[1], x[2]}, 1, Dimension::none}; }

}  // namespace

Ref<Component> SurfaceMaps::color(const SurfaceColor& c) const {
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
  put(*all, "first", map);
  if (texture && vertices) put(*all, "second", vertices);
  if (c.value != one) set_member(*all, "factor", three(c.value), at_);
  if (moved) set_member(*all, "offset", three(c.offset), at_);
  return all;
}

// A surface of partial coverage emits L = alpha * colour, channel by channel; what is behind it is seen through the rest (glTF
// 2.0, 3.9.4: alpha is coverage).
Ref<Component> SurfaceMaps::emitted(const SurfaceColor& c, const Ref<Component>& opacity) const {
  const Ref<Component> colors = color(c);
  if (!opacity) return colors;
  Ref<Component> all = part("RgbProductMap");
  put(*all, "first", colors ? colors : opacity);
  if (colors)
    put(*all, "second", opacity);
  else
    set_member(*all, "factor", three(c.value), at_);
  return all;
}

// In a grey image (fewer than three channels, none of this name) any of R, G, B stands for the grey value.
std::string SurfaceMaps::channel_there(const std::string& file, const std::string& channel) const {
  if (channel != "R" && channel != "G" && channel != "B") return channel;
  try {
    const std::vector<std::string>& all = channels_of_image(importing_, file);
    return all.size() < 3 && std::ranges::count(all, channel) == 0 ? "" : channel;
  } catch (const Error&) {
    return channel;  // reported when the image is opened
  }
}

Ref<Component> SurfaceMaps::image(const SurfaceTexture& t, const std::string& channel, bool linear) const {
  Ref<Component> map = part("ImageMap");
  set_member(*map, "file", FilePath{t.file, {}}, at_);
  if (const std::string named = channel_there(t.file, channel); !named.empty()) set_member(*map, "channel", named, at_);
  if (!t.transfer.empty())
    set_member(*map, "transfer", t.transfer, at_);
  else if (linear)
    set_member(*map, "transfer", "linear", at_);
  set_member(*map, "wrap", t.wrap, at_);
  const bool differ = !t.wrap_v.empty() && t.wrap_v != t.wrap;
  if (differ) set_member(*map, "wrap_v", t.wrap_v, at_);
  if (t.nearest) set_member(*map, "interpolation", "nearest", at_);
  const auto pair = [](const std::array<double, 2>& p) { return Numbers{{p[0], p[1]}, 1, Dimension::none}; };
  std::array<double, 2> shift = t.shift, scale = t.scale;
  for (double& x : scale)
    if (x == 0) x = 1e-6;  // reads a single row or column; 0 would make the map's transform singular
  if (t.wrap == "repeat" && !differ && std::abs(t.angle) < 1e-9)
    for (double& x : shift)
      if (std::abs(x - std::round(x)) < 1e-9) x = 0;
  if (std::abs(t.angle) < 1e-9 && shift[0] == 0 && shift[1] == 0) {
    if (scale[0] != 1 || scale[1] != 1) set_member(*map, "repeat", pair(scale), at_);
    return map;
  }
  Ref<Component> moved = part("UvTransformMap");
  put(*moved, "map", map);
  if (scale[0] != 1 || scale[1] != 1) set_member(*moved, "scale", pair(scale), at_);
  if (t.angle != 0) set_member(*moved, "angle", Number{t.angle, Dimension::angle}, at_);
  set_member(*moved, "shift", pair(shift), at_);
  return moved;
}

Ref<Component> SurfaceMaps::product(const Ref<Component>& first, const Value& second) const {
  Ref<Component> map = part("MultiplyMap");
  put(*map, "first", first);
  set(*map, "second", second);
  return map;
}

Ref<Component> SurfaceMaps::number(const SurfaceNumber& n) const {
  Ref<Component> map;
  if (n.texture && n.value != 0) {
    map = image(*n.texture, n.channel, n.channel != "A");
    if (n.inverted) {
      Ref<Component> turned = part("RemapMap");
      put(*turned, "input", map);
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
    put(*moved, "input", map);
    set_member(*moved, "to", Numbers{{n.offset, n.offset + n.value}, 1, Dimension::none}, at_);
    return moved;
  }
  if (map && n.value != 1) map = product(map, Value(Number{n.value}, at_));
  if (map && n.squared) {
    Ref<Component> square = part("PowerMap");
    put(*square, "base", map);
    set_member(*square, "exponent", 2.0, at_);
    return square;
  }
  return map;
}

double SurfaceMaps::same_opacity(const Surface& s) {
  if (s.opacity_cutoff) return s.opacity.value >= *s.opacity_cutoff ? 1 : 0;
  return std::isfinite(s.opacity.value) ? s.opacity.value : 0;
}

Ref<Component> SurfaceMaps::opacity(const Surface& s) const {
  Ref<Component> map = number(s.opacity);
  if (!map || !s.opacity_cutoff) return map;
  Ref<Component> step = part("RemapMap");
  put(*step, "input", map);
  set_member(*step, "from", Numbers{{*s.opacity_cutoff - 1e-3, *s.opacity_cutoff}, 1, Dimension::none}, at_);
  return step;
}

}  // namespace etendue
