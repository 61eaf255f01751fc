#include "mtl.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "components/objects/meshes/obj_lines.h"
#include "files/regular_file.h"
#include "files/text_encoding.h"
#include "mtl_lines.h"

namespace etendue {
namespace {

std::string lower(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = char(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

double strongest(const std::array<double, 3>& c) { return std::ranges::max(c); }

class MtlReader {
 public:
  MtlReader(Importing& importing, const std::string& path)
      : importing_(importing), path_(path), folder_(std::filesystem::path(path).parent_path().string()), file_(intern(path)) {}

  void read(std::map<std::string, MtlMaterial>& all) {
    const FileContents contents(path_);
    const std::string text = as_utf8(contents.text());
    std::vector<MtlLines> materials;
    bool by_meshlab = false;
    for (Lines lines(text); lines.next();) {
      const std::string word = lower(lines.keyword());
      const Location at{file_, int(lines.line()), 0};
      if (!word.empty() && word[0] == '#')
        by_meshlab = by_meshlab || (word + lower(lines.left())).find("meshlab") != std::string::npos;
      if (word.empty() || word[0] == '#') continue;
      if (word == "newmtl") {
        materials.push_back({std::string(lines.rest()), at, {}, {}, {}});
        continue;
      }
      if (materials.empty()) continue;
      try {
        line(lines, word, at, materials.back());
      } catch (const Error& error) {
        throw Error(error.what(), at);
      }
    }
    tr_is_opacity_ = tr_is_opacity(importing_, materials, by_meshlab);
    for (const MtlLines& said : materials) finish(said, all);
  }

 private:
  void line(Lines& lines, const std::string& word, Location at, MtlLines& said) {
    static const std::vector<std::string> colors{"kd", "ks", "ke", "tf"},
        numbers{"ns", "ni", "d", "tr", "illum", "pr", "pm", "ps", "pc", "pcr", "aniso", "anisor"},
        textures{"map_kd",   "map_ks", "map_ke", "map_ns", "map_d",  "map_tr",
                 "map_bump", "bump",   "norm",   "map_pr", "map_pm", "map_ps"},
        ignored{"ka", "map_ka", "sharpness", "map_aat"};
    if (std::ranges::count(colors, word)) {
      read_color(lines, word, at, said);
    } else if (std::ranges::count(numbers, word)) {
      if (word == "d" && lines.rest().starts_with("-halo")) {
        lines.keyword();
        importing_.inexact("'d -halo' is the same from all sides", at);
      }
      said.numbers[word] = lines.number<double>();
    } else if (std::ranges::count(textures, word)) {
      if (auto texture = read_texture(lines, at)) said.textures[word == "bump" ? "map_bump" : word] = *texture;
    } else if (!std::ranges::count(ignored, word)) {
      importing_.inexact(fmt::format("'{}' is not expressed", word.substr(0, 20)), at);
    }
  }

  void read_color(Lines& lines, const std::string& word, Location at, MtlLines& said) {
    if (lines.rest().starts_with("spectral") || lines.rest().starts_with("xyz")) {
      importing_.inexact("a colour that is a spectrum's file or CIE XYZ is not read", at);
      return;
    }
    std::array<double, 3> c{};
    c[0] = lines.number<double>();
    c[1] = lines.at_end() ? c[0] : lines.number<double>();
    c[2] = lines.at_end() ? c[0] : lines.number<double>();
    said.colors[word] = c;
  }

  std::optional<MtlTexture> read_texture(Lines& lines, Location at) {
    MtlTexture texture;
    SurfaceTexture placed;
    while (lines.rest().starts_with("-")) {
      const std::string option = lower(lines.keyword());
      lines.at_end();
      const auto numbers = [&](size_t most) {
        std::vector<double> all;
        while (all.size() < most && !lines.at_end() && numeric(lines.rest())) all.push_back(lines.number<double>());
        return all;
      };
      if (option == "-s" || option == "-o" || option == "-t") {
        const std::vector<double> n = numbers(3);
        auto& to = option == "-s" ? placed.scale : placed.shift;
        if (option != "-t")
          for (size_t i = 0; i < std::min<size_t>(n.size(), 2); ++i) to[i] = n[i];
        else
          importing_.inexact("a texture's turbulence (-t) is left out", at);
      } else if (option == "-bm") {
        const std::vector<double> n = numbers(1);
        texture.bump = n.empty() ? 1 : n[0];
      } else if (option == "-mm") {
        const std::vector<double> n = numbers(2);
        if (n.size() == 2) texture.base = n[0], texture.gain = n[1];
      } else if (option == "-imfchan") {
        const std::string channel = lower(lines.keyword());
        if (channel == "r" || channel == "g" || channel == "b") texture.channel = char(std::toupper(channel[0]));
        if (channel == "m") texture.channel = "A";
      } else if (option == "-clamp") {
        if (lower(lines.keyword()) == "on") placed.wrap = "black";
      } else if (option == "-boost" || option == "-texres") {
        if (const std::vector<double> n = numbers(1); option == "-boost" && !n.empty() && n[0] != 0)
          importing_.inexact("a texture is not made sharper (-boost)", at);
      } else if (lower(lines.keyword()) == "on" && option == "-cc") {  // -blendu, -blendv, -type: filtering
        importing_.inexact("a texture's correction of colours (-cc) is left out", at);
      }
      lines.at_end();
    }
    const std::string name(lines.rest());
    const auto file = optional_image(importing_, name, at, folder_);
    if (!file) return std::nullopt;
    const auto found = readable_texture(importing_, *file, at, &texture.has_alpha);
    if (!found) return std::nullopt;
    if (texture.channel == "A" && !texture.has_alpha) {
      importing_.inexact("the image has no alpha for '-imfchan m': its colours are used", at);
      texture.channel.clear();
    }
    placed.file = found->file;
    texture.image = placed;
    texture.has_colors = channels_of_image(importing_, *file).size() >= 3;
    return texture;
  }

  static bool numeric(std::string_view text) {
    const char c = text.empty() ? 'x' : text[0];
    const char next = text.size() > 1 ? text[1] : 'x';
    const auto digit = [](char d) { return d >= '0' && d <= '9'; };
    return digit(c) || ((c == '-' || c == '+' || c == '.') && (digit(next) || next == '.'));
  }

  void finish(const MtlLines& said, std::map<std::string, MtlMaterial>& all) {
    Surface s;
    s.name = said.name;
    base(said, s);
    if (said.has("pr") || said.has("pm") || said.has("map_pr") || said.has("map_pm"))
      pbr(said, s);
    else
      phong(said, s);
    transparency(said, s);
    shape(said, s);
    all.try_emplace(said.name, MtlMaterial{s, said.at});
  }

  static void put(const MtlTexture* texture, SurfaceColor& color) {
    if (!texture) return;
    color.texture = texture->image;
    for (size_t i = 0; i < 3; ++i) {
      color.offset[i] = color.value[i] * texture->base;
      color.value[i] *= texture->gain;
    }
  }
  static void put(const MtlTexture* texture, SurfaceNumber& number) {
    if (!texture) return;
    number.texture = texture->image;
    number.channel = texture->channel;
    if (texture->gain == 0) {
      number = number.value * texture->base;
      return;
    }
    number.offset = number.value * texture->base;
    number.value *= texture->gain;
  }

  void base(const MtlLines& said, Surface& s) const {
    const MtlTexture* texture = said.texture("map_kd");
    // Exporters often leave Kd black when a texture replaces it.
    s.base_color = said.color("kd", texture ? 1 : 0.8);
    if (texture && s.base_color.black()) s.base_color.value = {1, 1, 1};
    put(texture, s.base_color);
    s.emission = said.color("ke", said.texture("map_ke") ? 1 : 0);
    if (said.texture("map_ke") && s.emission.black()) s.emission.value = {1, 1, 1};
    put(said.texture("map_ke"), s.emission);
    s.ior = std::clamp(said.number("ni", 1.5), 1.0, 4.0);
    if (s.ior == 1) s.ior = 1.5;  // exporters without an index of refraction write 1
  }

  static void pbr(const MtlLines& said, Surface& s) {
    s.metalness = said.number("pm", said.texture("map_pm") ? 1 : 0);
    s.roughness = said.number("pr", said.texture("map_pr") ? 1 : 0.5);
    put(said.texture("map_pm"), s.metalness);
    put(said.texture("map_pr"), s.roughness);
  }

  // Phong's exponent n is about that of a Beckmann distribution with alpha^2 = 2 / (n + 2) (Walter et al. 2007, section 5.3),
  // and alpha is the square of the roughness.
  static void phong(const MtlLines& said, Surface& s) {
    s.roughness = std::pow(2 / (std::max(said.number("ns", 0), 0.0) + 2), 0.25);
    const std::array<double, 3> reflected = said.color("ks", said.texture("map_ks") ? 1 : 0);
    const double most = strongest(reflected), illum = said.number("illum", 2);
    if (most <= 0 || illum < 2) {
      s.specular = 0;
      return;
    }
    const bool dark = strongest(s.base_color.value) < 0.05 && !s.base_color.texture;
    if (dark && most > 0.3 && illum != 6 && illum != 7) {
      s.metalness = 1;
      s.base_color = reflected;
      put(said.texture("map_ks"), s.base_color);
      return;
    }
    // Exporters write 0.5 for the reflectance of 4 % that plastics, paints and glass have.
    s.specular = std::min(2 * most, 1.0);
    s.specular_color = std::array<double, 3>{reflected[0] / most, reflected[1] / most, reflected[2] / most};
    put(said.texture("map_ks"), s.specular_color);
  }

  void transparency(const MtlLines& said, Surface& s) const {
    const double illum = said.number("illum", 2);
    const double there = mtl_opacity(importing_, said, tr_is_opacity_);
    const bool refracts = illum == 6 || illum == 7 || ((illum == 4 || illum == 9) && (there < 1 || said.has("tf")));
    if (refracts) {
      s.transmission = there < 1 ? 1 - there : 1;
      s.transmission_color = said.color("tf", 1);
      if (s.transmission_color.black()) s.transmission_color = 1.0;  // exporters write 0 for "unused"
      s.thin = false;
      s.specular = 1;
      s.specular_color = 1.0;
      return;
    }
    s.opacity = there;
    const MtlTexture* holes = said.texture("map_d");
    if (!holes) holes = said.texture("map_tr");
    if (!holes) return;
    if (s.opacity.value == 0) s.opacity = 1;
    const double most = s.opacity.value;
    put(holes, s.opacity);
    s.opacity.inverted = !said.texture("map_d");
    if (s.opacity.inverted && s.opacity.offset != 0) {  // most * (1 - base - gain * texel)
      s.opacity.inverted = false;
      s.opacity.value *= -1;
      s.opacity.offset = most - s.opacity.offset;
    }
    if (holes->channel.empty() && holes->has_alpha) s.opacity.channel = "A";
  }

  void shape(const MtlLines& said, Surface& s) const {
    const MtlTexture* sheens = said.texture("map_ps");
    if (const double sheen = said.number("ps", sheens ? 1 : 0); sheen > 0) {
      s.sheen_color = sheen;
      s.sheen_roughness = 0.5;
      put(sheens, s.sheen_color);
      if (sheens) s.sheen_color.texture->transfer = "linear";  // a number, not a colour
    }
    if (said.texture("map_ns"))
      importing_.inexact("an image of the exponent Ns is left out: it is the same everywhere", said.at);
    s.coat = said.number("pc", 0);
    s.coat_roughness = said.number("pcr", 0);
    s.anisotropy = std::clamp(said.number("aniso", 0), 0.0, 1.0);
    s.anisotropy_rotation = said.number("anisor", 0);
    if (const MtlTexture* normals = said.texture("norm"))
      s.normals = SurfaceNormals{normals->image, normals->bump, false};
    else if (const MtlTexture* bumps = said.texture("map_bump")) {
      if (bumps->has_colors && is_of_normals(bumps->image.file)) {
        s.normals = SurfaceNormals{bumps->image, bumps->bump, false};
      } else {
        constexpr double height = 0.01;
        s.bumps = bumps->image;
        s.bump_height = height * bumps->bump;
        importing_.inexact("the height of bumps has no unit: '-bm 1' is taken for 0.01", said.at);
      }
    }
  }

  bool is_of_normals(const std::string& file) const {
    const auto known = of_normals_.find(file);
    return known != of_normals_.end() ? known->second : of_normals_[file] = looks_like_normals(file);
  }

  Importing& importing_;
  mutable std::map<std::string, bool> of_normals_;  // cache: whether an image is a normal map, by file
  std::string path_, folder_;
  const char* file_;
  bool tr_is_opacity_ = false;
};

}  // namespace

void read_mtl(Importing& importing, const std::string& path, std::map<std::string, MtlMaterial>& all) {
  MtlReader(importing, path).read(all);
}

}  // namespace etendue
