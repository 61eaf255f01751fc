// Splits an OBJ file into one mesh per material.

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <span>

#include "files/regular_file.h"
#include "files/text_encoding.h"
#include "mesh_data.h"

namespace etendue {
namespace {

constexpr const char* prefix = "usemtl ";

/// Extracts some triangles with the vertices that they use. `now` is scratch space: for each vertex of the whole mesh its
/// number in the part; all entries are `unknown` before and after the call.
constexpr std::uint32_t unknown = 0xffffffffu;
MeshData taken_out(const MeshData& mesh, std::span<const std::uint32_t> triangles, std::vector<std::uint32_t>& now) {
  MeshData part;
  part.centre = mesh.centre;
  part.triangles.reserve(triangles.size());
  for (const VertexAttribute& a : mesh.attributes) part.attributes.push_back({a.name, a.width, {}});
  for (const std::uint32_t i : triangles) {
    std::array<std::uint32_t, 3> t{};
    for (size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[i][k];
      if (now[vertex] == unknown) {
        now[vertex] = std::uint32_t(part.positions.size());
        part.positions.push_back(mesh.positions[vertex]);
        if (!mesh.normals.empty()) part.normals.push_back(mesh.normals[vertex]);
        if (!mesh.uvs.empty()) part.uvs.push_back(mesh.uvs[vertex]);
        for (size_t a = 0; a < mesh.attributes.size(); ++a) {
          const auto from = mesh.attributes[a].values.begin() + std::ptrdiff_t(vertex) * mesh.attributes[a].width;
          part.attributes[a].values.insert(part.attributes[a].values.end(), from, from + mesh.attributes[a].width);
        }
      }
      t[k] = now[vertex];
    }
    part.triangles.push_back(t);
  }
  for (const std::uint32_t i : triangles)
    for (const std::uint32_t vertex : mesh.triangles[i]) now[vertex] = unknown;
  return part;
}

/// Cache of the parts of recently read files, until each is requested: a single part cannot be read without parsing the whole
/// file.
struct ReadFile {
  std::filesystem::file_time_type written;
  std::uintmax_t size = 0;
  std::vector<std::string> names;
  std::map<std::string, MeshData> parts;
};
std::mutex mutex;
std::map<std::string, ReadFile>& known_files() {
  static auto* all = new std::map<std::string, ReadFile>;
  return *all;
}

ReadFile read_parts(const std::string& path) {
  ReadFile file;
  std::error_code none;
  file.written = std::filesystem::last_write_time(path, none);
  file.size = std::filesystem::file_size(path, none);
  const FileContents contents(path);
  if (contents.text().empty()) throw Error("the file is empty");
  MeshData mesh = has_byte_order_mark(contents.text()) ? read_obj(as_utf8(contents.text())) : read_obj(contents.text());
  tell_remarks(mesh, path);
  if (mesh.triangle_materials.empty()) {
    file.names = {""};
    file.parts[""] = std::move(mesh);
    return file;
  }
  // Counting sort of the triangles by material: those of material m are at begin[m] to begin[m + 1].
  const auto place = [&](std::uint32_t m) { return m == MeshData::no_material ? mesh.materials.size() : size_t(m); };
  std::vector<std::uint32_t> begin(mesh.materials.size() + 2), sorted(mesh.triangles.size());
  for (const std::uint32_t m : mesh.triangle_materials) ++begin[place(m) + 1];
  for (size_t m = 1; m < begin.size(); ++m) begin[m] += begin[m - 1];
  std::vector<std::uint32_t> next = begin;
  for (size_t i = 0; i < sorted.size(); ++i) sorted[next[place(mesh.triangle_materials[i])]++] = std::uint32_t(i);
  std::vector<std::uint32_t> now(mesh.positions.size(), unknown);
  for (size_t m = 0; m + 1 < begin.size(); ++m) {
    const std::span<const std::uint32_t> own(sorted.data() + begin[m], begin[m + 1] - begin[m]);
    if (own.empty()) continue;
    const bool named = m < mesh.materials.size();
    const std::string& name = file.names.emplace_back(named ? mesh.materials[m] : "");
    MeshData& part = file.parts[name];
    if (own.size() < mesh.triangles.size()) {
      part = taken_out(mesh, own, now);
    } else {
      part = std::move(mesh);
      break;
    }
  }
  for (auto& [name, part] : file.parts) {
    part.materials = {};
    part.triangle_materials = {};
  }
  return file;
}

/// The cached file, read if necessary. Call with the lock held.
ReadFile& known(const std::string& path) {
  auto& all = known_files();
  std::error_code none;
  const auto found = all.find(path);
  if (found != all.end() && found->second.written == std::filesystem::last_write_time(path, none) &&
      found->second.size == std::filesystem::file_size(path, none))
    return found->second;
  constexpr size_t most = 8;
  if (all.size() >= most) all.clear();
  return all[path] = read_parts(path);
}

MeshData read_obj_part(const std::string& path, const std::string& part) {
  if (!part.starts_with(prefix)) throw Error("a part of an OBJ file is written \"usemtl\" and the name of a material");
  const std::string name = part.substr(std::string_view(prefix).size());
  const std::lock_guard lock(mutex);
  ReadFile* file = &known(path);
  if (!file->parts.contains(name)) {
    if (!std::ranges::count(file->names, name))
      throw Error("no face has a material '" + name + "'" + suggestion(name, file->names));
    known_files().erase(path);  // the part was already requested, so the file is read again
    file = &known(path);
  }
  MeshData mesh = std::move(file->parts.extract(name).mapped());
  return mesh;
}

const bool registered = register_mesh_format({"obj"}, read_obj_part);

}  // namespace

std::vector<std::string> obj_parts(const std::string& path) {
  const std::lock_guard lock(mutex);
  return known(path).names;
}

}  // namespace etendue
