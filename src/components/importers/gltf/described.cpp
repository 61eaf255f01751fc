#include "described.h"

#include "accessor.h"

namespace etendue::gltf {
namespace {

class Describer {
 public:
  Describer(Importing& importing, const Document& document, Materials& materials)
      : importing_(importing), document_(document), materials_(materials) {}

  Ref<Component> part(const Json& json, const std::string& name) {
    Ref<Component> made = importing_.make(text(json, "class"), at(), name);
    members(json, *made);
    return made;
  }

  void members(const Json& json, Component& of) {
    for (const auto& [name, value] : object_in(json, "members").items())
      within(name, [&] {
        Value made = read(value);
        if (!made.none()) set(of, name, made);
      });
  }

 private:
  Value read(const Json& json) {
    if (json.is_boolean()) return Value(json.get<bool>(), at());
    if (json.is_number()) return Value(Number{json.get<double>()}, at());
    if (json.is_string()) return Value(json.get<std::string>(), at());
    if (json.is_array()) {
      Numbers list;
      for (const Json& one : json) {
        if (!one.is_number()) throw Error("it is no list of numbers");
        list.values.push_back(one.get<double>());
      }
      return Value(std::move(list), at());
    }
    if (find(json, "class")) return Value(part(json, {}), at());
    if (find(json, "angle")) return Value(Number{number(json, "angle", 0), Dimension::angle}, at());
    if (const auto rgb = numbers<3>(json, "rgb")) return color_value(*rgb, at());
    if (find(json, "color")) {
      const SurfaceColor color = materials_.described_color(object_in(json, "color"));
      if (Ref<Component> map = surface_color_map(importing_, color, at())) return Value(map, at());
      return color_value(color.value, at());
    }
    if (find(json, "path")) return Value(FilePath{importing_.file(text(json, "path"), at()), {}}, at());
    if (const auto image = whole(json, "image")) {
      const auto found = materials_.image_texture(*image);
      return found ? Value(FilePath{found->file, {}}, at()) : Value();
    }
    const Accessor accessor(document_, needed_whole(json, "accessor"));
    Numbers list;
    list.width = int(accessor.width);
    if (accessor.whole_numbers()) {
      const std::vector<std::uint32_t> values = accessor.indices();
      list.values.assign(values.begin(), values.end());
    } else {
      const std::vector<float> values = accessor.floats();
      list.values.assign(values.begin(), values.end());
    }
    return Value(std::move(list), at());
  }

  Location at() const { return importing_.at(); }

  Importing& importing_;
  const Document& document_;
  Materials& materials_;
};

}  // namespace

Ref<Component> described_part(Importing& importing, const Document& document, Materials& materials, const Json& json,
                              const std::string& name) {
  return Describer(importing, document, materials).part(json, name);
}

void set_described_members(Importing& importing, const Document& document, Materials& materials, const Json& json,
                           Component& of) {
  Describer(importing, document, materials).members(json, of);
}

// ---- the material extension ETENDUE_surface -----------------------------------------------------------------------------

namespace {

/// Sets a member if the key is present.
template <class Read, class T>
void take(const Json& json, const char* key, T& member, Read read) {
  if (find(json, key)) within(key, [&] { member = read(object_in(json, key)); });
}

}  // namespace

std::optional<SurfaceTexture> Materials::described_texture(const Json& json, bool* has_alpha) {
  const Json& t = object_in(json, "texture");
  if (t.empty()) return std::nullopt;
  const size_t uv = whole(t, "uv_set").value_or(0);
  if (uv_set_ && *uv_set_ != uv)
    importing_.inexact("all textures of a material use the surface coordinates of its first", at());
  if (!uv_set_) uv_set_ = uv;
  auto made = image_texture(needed_whole(t, "image"), has_alpha);
  if (!made) return std::nullopt;
  const Json& wraps = list_in(t, "wrap");
  if (wraps.size() == 2 && wraps[0].is_string() && wraps[1].is_string()) {
    made->wrap = wraps[0].get<std::string>();
    made->wrap_v = wraps[1].get<std::string>();
  }
  made->transfer = text(t, "transfer");
  made->scale = numbers<2>(t, "scale").value_or(made->scale);
  made->shift = numbers<2>(t, "shift").value_or(made->shift);
  made->angle = gltf::number(t, "angle", 0);
  return made;
}

SurfaceColor Materials::described_color(const Json& json) {
  SurfaceColor c = numbers<3>(json, "value").value_or(std::array<double, 3>{1, 1, 1});
  c.texture = described_texture(json, nullptr);
  if (c.texture) c.offset = numbers<3>(json, "offset").value_or(c.offset);
  if (!c.texture && find(json, "texture")) c.value = numbers<3>(json, "without").value_or(c.value);
  return c;
}

SurfaceNumber Materials::described_number(const Json& json) {
  SurfaceNumber n = gltf::number(json, "value", 1);
  bool has_alpha = false;
  n.texture = described_texture(json, &has_alpha);
  n.channel = text(json, "channel");
  if (n.channel == "A" && !has_alpha) n.texture.reset();  // a missing channel counts as 1
  if (n.texture) n.offset = gltf::number(json, "offset", 0);
  if (!n.texture && find(json, "texture")) n.value = gltf::number(json, "without", n.value);
  return n;
}

void Materials::read_described(const Json& json, Surface& s) {
  const auto color = [&](const Json& j) { return described_color(j); };
  const auto number = [&](const Json& j) { return described_number(j); };
  take(json, "base_color", s.base_color, color);
  take(json, "specular_color", s.specular_color, color);
  take(json, "emission", s.emission, color);
  take(json, "metalness", s.metalness, number);
  take(json, "roughness", s.roughness, number);
  take(json, "opacity", s.opacity, number);
  take(json, "coat", s.coat, number);
  take(json, "coat_roughness", s.coat_roughness, number);
  if (const Json& n = object_in(json, "normals"); !n.empty())
    if (auto texture = described_texture(n, nullptr))
      s.normals = SurfaceNormals{*texture, gltf::number(n, "strength", 1), truth(n, "downwards", false)};
}

}  // namespace etendue::gltf
