#include "ply_attributes.h"

#include <cstring>

#include "etendue/describe/color.h"

namespace etendue::ply {

std::vector<Group> groups_of(const Element& e, std::vector<bool> taken) {
  std::vector<Group> groups;
  const auto free = [&](int p) { return p >= 0 && !e.properties[size_t(p)].list && !taken[size_t(p)]; };
  const auto add = [&](const std::string& name, const std::vector<int>& properties, Column::Meaning meaning) {
    for (const int p : properties) taken[size_t(p)] = true;
    if (std::ranges::none_of(groups, [&](const Group& g) { return g.name == name; }))
      groups.push_back({name, properties, meaning});
  };
  const std::vector<int> rgb{e.find({"red", "r", "diffuse_red"}), e.find({"green", "g", "diffuse_green"}),
                             e.find({"blue", "b", "diffuse_blue"})};
  if (std::ranges::all_of(rgb, free)) add("color", rgb, Column::Meaning::color);
  for (size_t p = 0; p < e.properties.size(); ++p) {
    if (groups.size() >= 256) break;  // limit against malicious files, since the cost of comparing names is quadratic
    if (!free(int(p))) continue;
    const std::string& name = e.properties[p].name;
    if (name.size() > 2 && name.ends_with("_0")) {
      const std::string stem = name.substr(0, name.size() - 2);
      std::vector<int> parts{int(p)};
      for (int k = 1; k < 4; ++k) {
        const int next = e.find({stem + "_" + std::to_string(k)});
        if (!free(next)) break;
        parts.push_back(next);
      }
      // Colours in this form are left unchanged: programs that write it write floats.
      add(stem, parts, Column::Meaning::number);
    } else {
      add(name, {int(p)}, name == "alpha" ? Column::Meaning::fraction : Column::Meaning::number);
    }
  }
  return groups;
}

void add_attributes(const Element& e, std::vector<Column>& columns, MeshData& mesh) {
  std::vector<bool> taken(e.properties.size());
  for (const Column& c : columns) taken[size_t(c.property)] = true;
  for (const Group& g : groups_of(e, taken)) {
    const size_t width = g.properties.size();
    mesh.attributes.push_back({g.name, int(width), std::vector<float>(size_t(e.count) * width)});
    char* const to = reinterpret_cast<char*>(mesh.attributes.back().values.data());
    for (size_t c = 0; c < width; ++c) columns.push_back({g.properties[c], to + 4 * c, 4 * width, g.meaning});
  }
}

FaceAttributes::FaceAttributes(const Element& e, int indices, MeshData& mesh) : element_(e), mesh_(mesh) {
  std::vector<bool> taken(e.properties.size());
  taken[size_t(indices)] = true;
  groups_ = groups_of(e, taken);
  for (const Group& g : groups_) mesh.face_attributes.push_back({"face_" + g.name, int(g.properties.size()), {}});
}

void FaceAttributes::add(const std::vector<float>& row) {
  for (; triangles_ < mesh_.triangles.size(); ++triangles_)
    for (size_t g = 0; g < groups_.size(); ++g)
      for (const int p : groups_[g].properties) mesh_.face_attributes[g].values.push_back(row[size_t(p)]);
}

void FaceAttributes::finish() {
  if (triangles_ == 0) return;
  Element triangles = element_;
  triangles.count = triangles_;
  if (!triangles_) return;  // there is no data to point to
  std::vector<Column> columns;
  for (size_t g = 0; g < groups_.size(); ++g) {
    const size_t width = groups_[g].properties.size();
    char* const to = reinterpret_cast<char*>(mesh_.face_attributes[g].values.data());
    for (size_t c = 0; c < width; ++c) columns.push_back({groups_[g].properties[c], to + 4 * c, 4 * width, groups_[g].meaning});
  }
  decode_fractions(triangles, columns);
  replace_infinite_colors(mesh_.face_attributes, mesh_);
}

void replace_infinite_colors(std::vector<VertexAttribute>& attributes, MeshData& mesh) {
  for (VertexAttribute& a : attributes)
    if (a.width == 3 && (a.name == "color" || a.name == "face_color")) etendue::replace_infinite_colors(a.values, mesh);
}

void decode_fractions(const Element& e, const std::vector<Column>& columns) {
  for (const Column& c : columns) {
    const Type type = e.properties[size_t(c.property)].type;
    if (c.meaning == Column::Meaning::number || type == Type::float32 || type == Type::float64) continue;
    const bool is_signed = type == Type::int8 || type == Type::int16 || type == Type::int32;
    const size_t bits = 8 * size_of(type) - (is_signed ? 1 : 0);
    const double most = double((std::uint64_t(1) << bits) - 1);
    const bool color = c.meaning == Column::Meaning::color;
    const auto decoded = [&](double x) {
      const double fraction = std::min(std::max(x / most, 0.0), 1.0);
      return float(color ? decode_transfer("srgb", fraction) : fraction);
    };
    std::vector<float> table(bits <= 16 ? size_t(most) + 1 : 0);
    for (size_t i = 0; i < table.size(); ++i) table[i] = decoded(double(i));
    char* at = c.to;
    for (std::uint64_t i = 0; i < e.count; ++i, at += c.step) {
      float value = 0;
      std::memcpy(&value, at, 4);
      value = !table.empty() && value >= 0 && value <= float(most) ? table[size_t(value)] : decoded(double(value));
      std::memcpy(at, &value, 4);
    }
  }
}

}  // namespace etendue::ply
