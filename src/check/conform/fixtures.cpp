#include "fixtures.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "images/image_library.h"
#include "rgl_fixture.h"

namespace etendue::conform {
namespace {

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), long(bytes.size()));
  if (!file.flush()) throw Error("cannot write '" + path + "'");
}

/// An image in the format its name says.
template <class F>
void write_image(const std::string& path, int width, int height, NumberType type, F&& pixel) {
  std::vector<float> data;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const float value : pixel((float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height)))
        data.push_back(value);
  const std::string ending = std::filesystem::path(path).extension().string();
  const std::vector<unsigned char> bytes = image_library().encode(ending, ImageHeader(width, height, 3, type), data);
  write_bytes(path, std::string(bytes.begin(), bytes.end()));
}

using Rgb = std::array<float, 3>;

/// Soft stripes and a dark corner.
void write_texture(const std::string& path) {
  write_image(path, 16, 8, NumberType::uint8,
              [](float u, float v) { return Rgb{0.5f + 0.4f * std::sin(12 * u), 0.15f + 0.7f * v, u * v}; });
}

/// Tangent-space normals of gentle waves, n = 2 c - 1.
void write_normals(const std::string& path) {
  write_image(path, 16, 16, NumberType::uint8, [](float u, float v) {
    const Vector3 n = normalize(Vector3{0.3f * std::sin(2 * pi * u), 0.3f * std::cos(2 * pi * v), 1});
    return Rgb{(n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2};
  });
}

/// A bright spot in a blue sky over a dark ground.
void write_environment(const std::string& path) {
  write_image(path, 32, 16, NumberType::single, [](float u, float v) {
    const float sun = std::exp(-200 * (square(u - 0.3f) + square(v - 0.25f)));
    return Rgb{(v < 0.5f ? 0.3f : 0.1f) + 20 * sun, (v < 0.5f ? 0.5f : 0.08f) + 18 * sun, (v < 0.5f ? 0.9f : 0.05f) + 14 * sun};
  });
}

/// A closed tetrahedron with its faces outwards.
constexpr const char* mesh =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

/// A luminaire that is not symmetric: two planes, widest at 45 degrees (IES LM-63-2002, type C).
constexpr const char* luminaire =
    "IESNA:LM-63-2002\n[TEST] made up\n[MANUFAC] none\nTILT=NONE\n1 1000 1 7 3 1 2 0 0 0\n1 1 20\n"
    "0 15 30 45 60 75 90\n0 45 90\n"
    "300 320 350 360 200 60 0\n300 310 320 300 150 40 0\n300 300 290 240 120 20 0\n";

/// The layout of Matusik et al. 2003: 90 x 90 x 180 values of three colours over half and difference angles, to be divided by
/// 1500, 1500 / 1.15 and 1500 / 1.66. A matt surface with a wide highlight.
void write_merl(const std::string& path) {
  constexpr int halves = 90, differences = 90, azimuths = 180;
  std::string bytes;
  const auto append = [&](const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); };
  const int sizes[3] = {halves, differences, azimuths};
  append(sizes, sizeof sizes);
  const double scales[3] = {1500, 1500 / 1.15, 1500 / 1.66}, base[3] = {0.1, 0.06, 0.03};
  std::vector<double> plane;
  for (int color = 0; color < 3; ++color)
    for (int h = 0; h < halves; ++h) {
      const double angle = (h + 0.5) * (h + 0.5) / 90 * M_PI / 180;
      plane.assign(size_t(differences * azimuths), (base[color] + 0.3 * std::exp(-20 * angle * angle)) * scales[color]);
      append(plane.data(), plane.size() * sizeof(double));
    }
  write_bytes(path, bytes);
}

struct Sample {
  const char* name;
  void (*write)(const std::string& path);
};
constexpr Sample samples[] = {
    {"texture.png", write_texture},
    {"normals.png", write_normals},
    {"environment.exr", write_environment},
    {"mesh.ply", [](const std::string& path) { write_bytes(path, mesh); }},
    {"luminaire.ies", [](const std::string& path) { write_bytes(path, luminaire); }},
    {"material.binary", write_merl},
    {"material.bsdf", [](const std::string& path) { write_bytes(path, rgl_material()); }},
};

/// Which sample a member wants, by what its class says.
const char* wanted(const ClassInfo& info, const Member& member) {
  const auto says = [&](const char* word) {
    return info.name.find(word) != std::string::npos || member.text.find(word) != std::string::npos ||
           member.name.find(word) != std::string::npos;
  };
  if (says("MERL") || says("Merl")) return "material.binary";
  if (says("RGL") || says("Rgl") || says(".bsdf")) return "material.bsdf";
  if (says("IES") || says("Ies")) return "luminaire.ies";
  if (says("Normal") || says("normal map")) return "normals.png";
  if (says("PLY") || says("OBJ")) return "mesh.ply";
  if (says("Environment")) return "environment.exr";
  if (says("image") || says("Image") || says("picture")) return "texture.png";
  return nullptr;
}

}  // namespace

Fixtures::Fixtures() {
  std::string pattern = (std::filesystem::temp_directory_path() / "etendue-conform-XXXXXX").string();
  if (!mkdtemp(pattern.data())) throw Error("cannot make a temporary folder '" + pattern + "'");
  folder_ = pattern;
}

Fixtures::~Fixtures() {
  std::error_code ignored;
  if (!keep_) std::filesystem::remove_all(folder_, ignored);
}

std::string Fixtures::file_for(const ClassInfo& info, const Member& member) const {
  const char* name = wanted(info, member);
  if (!name) return {};
  const std::string path = folder_ + "/" + name;
  const std::lock_guard lock(mutex_);
  if (!written_.contains(name)) {
    for (const Sample& sample : samples)
      if (std::string_view(sample.name) == name) sample.write(path);
    written_.insert(name);
  }
  return path;
}

}  // namespace etendue::conform
