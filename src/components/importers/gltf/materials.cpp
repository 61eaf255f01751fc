#include "materials.h"

#include <algorithm>

#include "data_uri.h"

namespace etendue::gltf {
namespace {

constexpr const char* known_extensions[] = {"KHR_materials_transmission",
                                            "KHR_materials_diffuse_transmission",
                                            "KHR_materials_volume",
                                            "KHR_materials_ior",
                                            "KHR_materials_specular",
                                            "KHR_materials_clearcoat",
                                            "KHR_materials_sheen",
                                            "KHR_materials_iridescence",
                                            "KHR_materials_dispersion",
                                            "KHR_materials_anisotropy",
                                            "KHR_materials_unlit",
                                            "KHR_materials_emissive_strength",
                                            "KHR_materials_pbrSpecularGlossiness"};

/// Image formats that replace the image of a texture, or are an alternative to it. No library of Debian 12 reads Basis
/// Universal; for the others see docs/decisions/017-image-library.md.
struct UnreadFormat {
  const char *extension, *name;
};
constexpr UnreadFormat unread_formats[] = {
    {"KHR_texture_basisu", "Basis Universal's KTX2"}, {"EXT_texture_avif", "AVIF"}, {"MSFT_texture_dds", "DDS"}};

}  // namespace

bool is_known_texture_extension(std::string_view name) {
  return name == "EXT_texture_webp" ||
         std::ranges::find(unread_formats, name, &UnreadFormat::extension) != std::end(unread_formats);
}

bool is_known_material_extension(std::string_view name) {
  return std::ranges::find(known_extensions, name) != std::end(known_extensions);
}

const Material& Materials::get(std::optional<size_t> material, bool colored, bool faded) {
  const Key key{material, colored, faded};
  if (const auto known = made_.find(key); known != made_.end()) return known->second;
  uv_set_.reset();
  if (material && document_.converted()) {
    const Json& source = extension(document_.element("materials", *material), "ETENDUE_materialx");
    if (auto made = source.empty() ? std::nullopt : materialx(source)) return made_[key] = std::move(*made);
  }
  Surface surface;
  if (material)
    surface = within(fmt::format("materials[{}]", *material), [&] { return read(document_.element("materials", *material)); });
  surface.base_color.by_vertex = surface.transmission_color.by_vertex = colored;
  if (faded && material && text(document_.element("materials", *material), "alphaMode", "OPAQUE") != "OPAQUE")
    surface.opacity.attribute = "alpha";
  Material made;
  made.made = make_surface(importing_, surface, at());
  made.uv_set = uv_set_.value_or(0);
  made.by_tangents = surface.normals || surface.anisotropy.value > 0;
  // The emissive strength is used for lamps only; an emission without it that is at most white may be a screen.
  const bool strong = material && has_extension(document_.element("materials", *material), "KHR_materials_emissive_strength");
  const std::array<double, 3>& light = surface.emission.value;
  if (!surface.unlit && std::ranges::any_of(light, [&](double x) { return x > (strong ? 0.0 : 1.0); })) {
    std::array<double, 3> mean{1, 1, 1};
    if (surface.emission.texture) mean = mean_of_image(surface.emission.texture->file).value_or(mean);
    made.glow = 0.2126 * light[0] * mean[0] + 0.7152 * light[1] * mean[1] + 0.0722 * light[2] * mean[2];
  }
  return made_[key] = std::move(made);
}

Surface Materials::read(const Json& m) {
  Surface s;
  s.name = text(m, "name");
  const Json& extensions = object_in(m, "extensions");
  note_unknown(extensions);
  if (has_extension(m, "KHR_materials_pbrSpecularGlossiness"))
    read_specular_glossiness(object_in(extensions, "KHR_materials_pbrSpecularGlossiness"), s);
  else
    read_metal(object_in(m, "pbrMetallicRoughness"), s);
  read_extensions(extensions, s);
  s.emission = color(m, "emissiveFactor", "emissiveTexture", 0);
  const double strength = gltf::number(extension(m, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
  for (double& x : s.emission.value) x *= strength;
  s.emits_backwards = truth(m, "doubleSided", false);
  s.unlit = has_extension(m, "KHR_materials_unlit");
  if (auto normals = texture(m, "normalTexture")) {
    const double scale = gltf::number(object_in(m, "normalTexture"), "scale", 1);
    s.normals = SurfaceNormals{*normals, scale, false};
  }
  if (document_.converted()) read_described(object_in(extensions, "ETENDUE_surface"), s);
  const std::string mode = text(m, "alphaMode", "OPAQUE");
  if (mode == "OPAQUE") s.opacity = 1.0;
  if (mode == "MASK") s.opacity_cutoff = gltf::number(m, "alphaCutoff", 0.5);
  if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND") throw Error("'alphaMode' '" + mode.substr(0, 20) + "' is unknown");
  return s;
}

void Materials::read_metal(const Json& pbr, Surface& s) {
  const auto factor = numbers<4>(pbr, "baseColorFactor").value_or(std::array<double, 4>{1, 1, 1, 1});
  s.base_color.value = {factor[0], factor[1], factor[2]};
  bool has_alpha = false;
  s.base_color.texture = texture(pbr, "baseColorTexture", &has_alpha);
  s.opacity = factor[3];
  if (has_alpha) {
    s.opacity.texture = s.base_color.texture;
    s.opacity.channel = "A";
  }
  s.metalness = number(pbr, "metallicFactor", 1, "metallicRoughnessTexture", "B");
  s.roughness = number(pbr, "roughnessFactor", 1, "metallicRoughnessTexture", "G");
}

// The older workflow, which expresses metals by the colour of their specular reflection.
void Materials::read_specular_glossiness(const Json& old, Surface& s) {
  const auto factor = numbers<4>(old, "diffuseFactor").value_or(std::array<double, 4>{1, 1, 1, 1});
  bool has_alpha = false;
  s.base_color.value = {factor[0], factor[1], factor[2]};
  s.base_color.texture = texture(old, "diffuseTexture", &has_alpha);
  s.opacity = factor[3];
  if (has_alpha) {
    s.opacity.texture = s.base_color.texture;
    s.opacity.channel = "A";
  }
  const double glossiness = gltf::number(old, "glossinessFactor", 1);
  const auto map = texture(old, "specularGlossinessTexture");
  s.roughness = 1 - glossiness;
  if (map) {
    s.roughness = 1;
    s.roughness.texture = map;
    s.roughness.channel = "A";
    s.roughness.inverted = true;
    s.roughness.inverted_share = std::clamp(glossiness, 0.0, 1.0);
    importing_.inexact("KHR_materials_pbrSpecularGlossiness with a texture: its colours of reflections are left out", at());
  } else {
    reflect(rgb(old, "specularFactor", 1), s);
  }
}

/// Whether 'extensionsUsed' lists the extension: unsupported ones in that list are reported once.
bool Materials::is_listed(const std::string& extension) const {
  return std::ranges::any_of(list_in(document_.json(), "extensionsUsed"), [&](const Json& x) { return x == Json(extension); });
}

void Materials::note_unknown(const Json& extensions) {
  for (const auto& [name, value] : extensions.items())
    if (!is_known_material_extension(name) && !(document_.converted() && name == "ETENDUE_surface") && !is_listed(name))
      importing_.inexact(fmt::format("the extension {} of materials is not known", name), at());
}

SurfaceColor Materials::color(const Json& object, const char* factor, const char* texture_key, double otherwise) {
  SurfaceColor c = rgb(object, factor, otherwise);
  c.texture = texture(object, texture_key);
  return c;
}

SurfaceNumber Materials::number(const Json& object, const char* factor, double otherwise, const char* texture_key,
                                const char* channel) {
  SurfaceNumber n = gltf::number(object, factor, otherwise);
  if (n.value == 0) return n;
  bool has_alpha = false;
  n.texture = texture(object, texture_key, &has_alpha);
  n.channel = channel;
  if (n.channel == "A" && !has_alpha) n.texture.reset();
  return n;
}

/// The image of a texture; nothing, with a warning, if it has no image in a supported format.
std::optional<size_t> Materials::image_of(const Json& texture) {
  if (const auto webp = whole(extension(texture, "EXT_texture_webp"), "source")) return webp;
  const auto source = whole(texture, "source");
  bool told = false;
  for (const UnreadFormat& format : unread_formats) {
    if (!has_extension(texture, format.extension)) continue;
    importing_.inexact(fmt::format("images in {} ({}) are not read: {}", format.name, format.extension,
                                   source ? "those that stand beside them are used" : "they are left out"),
                       at());
    told = true;
  }
  if (!source && !told) importing_.inexact("a texture has no image", at());
  return source;
}

std::optional<SurfaceTexture> Materials::texture(const Json& object, const char* key, bool* has_alpha) {
  const Json& info = object_in(object, key);
  if (info.empty()) return std::nullopt;
  return within(key, [&]() -> std::optional<SurfaceTexture> {
    const Json& t = document_.element("textures", needed_whole(info, "index"));
    const Json& transform = extension(info, "KHR_texture_transform");
    const size_t uv = whole(transform, "texCoord").value_or(whole(info, "texCoord").value_or(0));
    if (uv_set_ && *uv_set_ != uv)
      importing_.inexact("all textures of a material use the surface coordinates of its first", at());
    if (!uv_set_) uv_set_ = uv;
    const std::optional<size_t> source = image_of(t);
    if (!source) return std::nullopt;
    const Image& found = image(*source);
    if (has_alpha) *has_alpha = found.has_alpha;
    if (!found.texture) return std::nullopt;
    SurfaceTexture made = *found.texture;
    if (const auto sampler = whole(t, "sampler")) {
      const Json& s = document_.element("samplers", *sampler);
      constexpr size_t clamped = 33071, mirrored = 33648, repeated = 10497, nearest = 9728;
      const size_t u = whole(s, "wrapS").value_or(repeated), v = whole(s, "wrapT").value_or(repeated);
      const auto named = [](size_t code) { return code == clamped ? "clamp" : (code == mirrored ? "mirror" : "repeat"); };
      made.wrap = named(u);
      made.wrap_v = named(v);
      made.nearest = whole(s, "magFilter") == nearest;
    }
    // In the file's coordinates, with v downwards, the transform is T R S. Flipping v keeps the rotation angle and changes the
    // shift.
    const auto scale = numbers<2>(transform, "scale").value_or(std::array<double, 2>{1, 1});
    const auto offset = numbers<2>(transform, "offset").value_or(std::array<double, 2>{0, 0});
    const double angle = gltf::number(transform, "rotation", 0), c = std::cos(angle), sine = std::sin(angle);
    made.scale = scale;
    made.angle = angle;
    made.shift = {offset[0] + sine * scale[1], 1 - c * scale[1] - offset[1]};
    return made;
  });
}

std::optional<SurfaceTexture> Materials::image_texture(size_t index, bool* has_alpha) {
  const Image& found = image(index);
  if (has_alpha) *has_alpha = found.has_alpha;
  return found.texture;
}

const Materials::Image& Materials::image(size_t index) {
  if (const auto known = images_.find(index); known != images_.end()) return known->second;
  Image& made = images_[index];
  const std::string inner = document_.inner_image(index);
  std::optional<std::string> file;
  if (inner.empty())
    file = optional_image(importing_, decode_percents(text(document_.element("images", index), "uri")), at());
  else
    file = importing_.path() + "#" + inner;
  if (file) made.texture = readable_texture(importing_, *file, at(), &made.has_alpha);
  return made;
}

}  // namespace etendue::gltf
