#include "ply_attributes.h"

#include <cstring>

#include "etendue/describe/color.h"

namespace etendue::ply {

void add_attributes(const Element& e, std::vector<Column>& columns, MeshData& mesh) {
  std::vector<bool> taken(e.properties.size());
  for (const Column& c : columns) taken[size_t(c.property)] = true;
  const auto free = [&](int p) { return p >= 0 && !e.properties[size_t(p)].list && !taken[size_t(p)]; };
  const auto add = [&](const std::string& name, int width) {
    mesh.attributes.push_back({name, width, std::vector<float>(size_t(e.count) * size_t(width))});
    return reinterpret_cast<char*>(mesh.attributes.back().values.data());
  };
  const int rgb[3] = {e.find({"red", "r", "diffuse_red"}), e.find({"green", "g", "diffuse_green"}),
                      e.find({"blue", "b", "diffuse_blue"})};
  if (free(rgb[0]) && free(rgb[1]) && free(rgb[2])) {
    char* const to = add("color", 3);
    for (int c = 0; c < 3; ++c) {
      columns.push_back({rgb[c], to + 4 * c, 12, Column::Meaning::color});
      taken[size_t(rgb[c])] = true;
    }
  }
  for (size_t p = 0; p < e.properties.size(); ++p) {
    if (mesh.attributes.size() >= 256) break;  // more than anyone has; names are compared with one another
    const std::string& name = e.properties[p].name;
    const auto same = [&](const VertexAttribute& a) { return a.name == name; };
    if (!free(int(p)) || std::any_of(mesh.attributes.begin(), mesh.attributes.end(), same)) continue;
    columns.push_back({int(p), add(name, 1), 4, name == "alpha" ? Column::Meaning::fraction : Column::Meaning::number});
  }
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
