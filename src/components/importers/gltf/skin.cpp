#include "skin.h"

#include <algorithm>

#include "accessor.h"

namespace etendue::gltf {
namespace {

Accessor of_vertices(const Document& document, const Json& attributes, const char* name, size_t vertices, size_t width) {
  Accessor accessor(document, needed_whole(attributes, name));
  if (accessor.width != width || accessor.count != vertices)
    throw Error(fmt::format("its {} does not fit its {} vertices", name, vertices));
  return accessor;
}

/// Adds a weighted morph target's colours and texture coordinates, whose v points downwards.
void morph_attributes(const Document& document, const Json& target, float weight, size_t uv_set, MeshData& mesh) {
  const size_t n = mesh.positions.size();
  const std::string uvs = fmt::format("TEXCOORD_{}", uv_set);
  if (find(target, uvs.c_str()) && !mesh.uvs.empty()) {
    const std::vector<float> moved = of_vertices(document, target, uvs.c_str(), n, 2).floats();
    for (size_t v = 0; v < n; ++v)
      mesh.uvs[v] = {mesh.uvs[v].x + weight * moved[2 * v], mesh.uvs[v].y - weight * moved[2 * v + 1]};
  }
  if (!find(target, "COLOR_0")) return;
  const size_t width = Accessor(document, needed_whole(target, "COLOR_0")).width == 3 ? 3 : 4;
  const std::vector<float> moved = of_vertices(document, target, "COLOR_0", n, width).floats();
  for (VertexAttribute& a : mesh.attributes) {
    const bool alpha = a.name == "alpha";
    if ((a.name != "color" && !alpha) || (alpha && width < 4)) continue;
    for (size_t i = 0; i < a.values.size(); ++i)
      a.values[i] += weight * (alpha ? moved[4 * i + 3] : moved[width * (i / 3) + i % 3]);
  }
}

void morph(const Document& document, const Json& primitive, const std::vector<double>& weights, size_t uv_set, MeshData& mesh) {
  const Json& targets = list_in(primitive, "targets");
  const size_t n = mesh.positions.size();
  for (size_t i = 0; i < std::min(targets.size(), weights.size()); ++i) {
    const auto weight = float(weights[i]);
    if (weight == 0) continue;
    within(fmt::format("targets[{}]", i), [&] {
      if (find(targets[i], "POSITION")) {
        const std::vector<float> moved = of_vertices(document, targets[i], "POSITION", n, 3).floats();
        for (size_t v = 0; v < n; ++v)
          mesh.positions[v] = mesh.positions[v] + weight * Vector3{moved[3 * v], moved[3 * v + 1], moved[3 * v + 2]};
      }
      if (find(targets[i], "NORMAL") && !mesh.normals.empty()) {
        const std::vector<float> moved = of_vertices(document, targets[i], "NORMAL", n, 3).floats();
        for (size_t v = 0; v < n; ++v)
          mesh.normals[v] =
              Normal3(Vector3(mesh.normals[v]) + weight * Vector3{moved[3 * v], moved[3 * v + 1], moved[3 * v + 2]});
      }
      morph_attributes(document, targets[i], weight, uv_set, mesh);
    });
  }
  if (std::ranges::any_of(targets, [](const Json& t) { return find(t, "COLOR_0") != nullptr; }))
    for (VertexAttribute& a : mesh.attributes)
      if (a.name == "color" || a.name == "alpha")
        for (float& x : a.values) x = std::min(std::max(x, 0.0f), 1.0f);
}

/// From the skin's space to scene space, for each joint.
std::vector<Transform> joint_transforms(const Document& document, size_t skin, const Pose& pose) {
  const Json& s = document.element("skins", skin);
  const std::vector<size_t> joints = places(s, "joints", document.count("nodes"));
  std::vector<float> inverse;
  if (const auto accessor = whole(s, "inverseBindMatrices")) {
    const Accessor matrices(document, *accessor);
    if (matrices.width != 16 || matrices.count < joints.size()) throw Error("its 'inverseBindMatrices' do not fit its joints");
    inverse = matrices.floats();
  }
  std::vector<Transform> all;
  for (size_t i = 0; i < joints.size(); ++i) {
    Transform bind;
    if (!inverse.empty()) {
      const float* m = inverse.data() + 16 * i;
      Transform::DoubleMatrix rows{};
      for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 4; ++c) rows[4 * r + c] = double(m[4 * c + r]);
      bind = Transform(rows);
    }
    all.push_back(pose.global(joints[i]) * bind);
  }
  return all;
}

// Linear blend skinning (glTF 2.0, 3.7.3.3).
void skin_vertices(const Document& document, const Json& attributes, const std::vector<Transform>& joints, MeshData& mesh) {
  const size_t n = mesh.positions.size();
  std::vector<Transform::DoubleMatrix> sums(n);
  std::vector<double> totals(n);
  for (int set = 0; find(attributes, fmt::format("JOINTS_{}", set).c_str()); ++set) {
    const std::vector<float> which = of_vertices(document, attributes, fmt::format("JOINTS_{}", set).c_str(), n, 4).floats();
    const std::vector<float> weights = of_vertices(document, attributes, fmt::format("WEIGHTS_{}", set).c_str(), n, 4).floats();
    for (size_t i = 0; i < which.size(); ++i) {
      if (!(weights[i] > 0)) continue;
      if (!(which[i] >= 0 && which[i] < float(joints.size())))
        throw Error(fmt::format("it refers to joint {} of {}", which[i], joints.size()));
      const Transform::DoubleMatrix& m = joints[size_t(which[i])].exact();
      for (size_t k = 0; k < 12; ++k) sums[i / 4][k] += double(weights[i]) * m[k];
      totals[i / 4] += double(weights[i]);
    }
  }
  for (size_t v = 0; v < n; ++v) {
    if (!(totals[v] > 0)) continue;
    for (double& x : sums[v]) x /= totals[v];
    const Transform t(sums[v]);
    mesh.positions[v] = Point3(t(DoublePoint3(mesh.positions[v])));
    if (!mesh.normals.empty() && t.valid()) mesh.normals[v] = t(mesh.normals[v]);
  }
}

}  // namespace

void bend(const Document& document, const Json& primitive, size_t node, const Pose& pose, size_t uv_set, MeshData& mesh) {
  morph(document, primitive, pose.weights(node), uv_set, mesh);
  const auto skin = whole(document.element("nodes", node), "skin");
  if (!skin) return;
  within(fmt::format("skins[{}]", *skin),
         [&] { skin_vertices(document, object_in(primitive, "attributes"), joint_transforms(document, *skin, pose), mesh); });
}

}  // namespace etendue::gltf
