#include "convert.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace etendue::assimp_helper {
namespace {

using Names = std::map<std::string, size_t>;

class SceneWriter {
 public:
  SceneWriter(const aiScene& scene, Glb& glb, const std::string& ending, double unit)
      : scene_(scene), glb_(glb), ending_(ending), unit_(unit) {}

  void write() {
    convert_materials(scene_, glb_, ending_);
    for (unsigned i = 0; i < scene_.mNumMeshes; ++i) mesh(*scene_.mMeshes[i]);
    const size_t root = node(*scene_.mRootNode, 0);
    for (const auto& [at, mesh_index] : skinned_) skin(at, mesh_index);
    convert_lights(scene_, glb_, find, &names_, unit());
    glb_.json["scenes"] = Json::array({{{"nodes", {outer(root)}}}});
    glb_.json["scene"] = 0;
    if (scene_.mNumAnimations > 0) glb_.note("animations of this format are not read: it is as it was saved");
    if (glb_.json.contains("nodes") && glb_.json["extensionsUsed"].empty()) glb_.json.erase("extensionsUsed");
  }

 private:
  static size_t find(const void* names, const char* name) {
    const auto& all = *static_cast<const Names*>(names);
    const auto found = all.find(name);
    return found == all.end() ? SIZE_MAX : found->second;
  }

  /// Adds a glTF mesh with one primitive; none if the mesh has no triangles.
  void mesh(const aiMesh& m) {
    meshes_.push_back(SIZE_MAX);
    if (!(m.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) || !m.HasPositions() || m.mNumFaces == 0) return;
    const size_t n = m.mNumVertices;
    Json attributes;
    const auto vectors = [&](const aiVector3D* from) {
      std::vector<float> values;
      values.reserve(3 * n);
      for (size_t i = 0; i < n; ++i) values.insert(values.end(), {from[i].x, from[i].y, from[i].z});
      return glb_.add_floats(values, "VEC3", 3);
    };
    attributes["POSITION"] = vectors(m.mVertices);
    if (m.HasNormals()) attributes["NORMAL"] = vectors(m.mNormals);
    for (unsigned set = 0; set < AI_MAX_NUMBER_OF_TEXTURECOORDS && m.HasTextureCoords(set); ++set) {
      std::vector<float> values;
      values.reserve(2 * n);
      for (size_t i = 0; i < n; ++i) values.insert(values.end(), {m.mTextureCoords[set][i].x, 1 - m.mTextureCoords[set][i].y});
      attributes["TEXCOORD_" + std::to_string(set)] = glb_.add_floats(values, "VEC2", 2);
    }
    if (m.HasVertexColors(0) && ending_ == "blend") {
      // Assimp takes their bytes for signed ones. Blender's own renderer uses them only in materials that say so.
      glb_.note("colours of vertices of Blender are left out");
    } else if (m.HasVertexColors(0)) {
      std::vector<float> values;
      for (size_t i = 0; i < n; ++i) values.insert(values.end(), {m.mColors[0][i].r, m.mColors[0][i].g, m.mColors[0][i].b});
      attributes["COLOR_0"] = glb_.add_floats(values, "VEC3", 3);
    }
    if (m.HasBones()) weights(m, attributes);
    std::vector<std::uint32_t> corners;
    for (unsigned f = 0; f < m.mNumFaces; ++f)
      if (m.mFaces[f].mNumIndices == 3) corners.insert(corners.end(), m.mFaces[f].mIndices, m.mFaces[f].mIndices + 3);
    if (corners.empty()) return;
    Json primitive = {{"attributes", attributes}, {"indices", glb_.add_indices(corners)}};
    if (m.mMaterialIndex < scene_.mNumMaterials) primitive["material"] = m.mMaterialIndex;
    meshes_.back() = glb_.add("meshes", {{"name", clean(m.mName.C_Str())}, {"primitives", Json::array({primitive})}});
  }

  /// The four bones with the largest weights at each vertex.
  void weights(const aiMesh& m, Json& attributes) {
    std::vector<std::uint16_t> joints(4 * size_t(m.mNumVertices));
    std::vector<float> pulls(joints.size());
    for (unsigned b = 0; b < m.mNumBones && b < 65535; ++b)
      for (unsigned k = 0; k < m.mBones[b]->mNumWeights; ++k) {
        const aiVertexWeight& w = m.mBones[b]->mWeights[k];
        if (w.mVertexId >= m.mNumVertices || !(w.mWeight > 0)) continue;
        float* const of_vertex = pulls.data() + 4 * size_t(w.mVertexId);
        const auto weakest = size_t(std::min_element(of_vertex, of_vertex + 4) - of_vertex);
        if (of_vertex[weakest] >= w.mWeight) continue;
        of_vertex[weakest] = w.mWeight;
        joints[4 * size_t(w.mVertexId) + weakest] = std::uint16_t(b);
      }
    attributes["JOINTS_0"] = glb_.add_joints(joints);
    attributes["WEIGHTS_0"] = glb_.add_floats(pulls, "VEC4", 4);
  }

  size_t node(const aiNode& n, int depth) {
    if (depth > 1000) throw std::runtime_error("its nodes nest more than 1000 deep");
    Json made = {{"name", clean(n.mName.C_Str())}, {"matrix", matrix_json(n.mTransformation)}};
    const size_t place = glb_.add("nodes", made);
    names_.try_emplace(n.mName.C_Str(), place);
    Json children = Json::array();
    for (unsigned i = 0; i < n.mNumMeshes; ++i) {
      if (n.mMeshes[i] >= meshes_.size() || meshes_[n.mMeshes[i]] == SIZE_MAX) continue;
      const size_t child = glb_.add("nodes", {{"mesh", meshes_[n.mMeshes[i]]}, {"name", clean(n.mName.C_Str())}});
      if (scene_.mMeshes[n.mMeshes[i]]->HasBones()) skinned_.emplace_back(child, n.mMeshes[i]);
      children.push_back(child);
    }
    for (unsigned i = 0; i < n.mNumChildren; ++i) children.push_back(node(*n.mChildren[i], depth + 1));
    if (!children.empty()) glb_.json["nodes"][place]["children"] = children;
    return place;
  }

  void skin(size_t at, unsigned mesh_index) {
    const aiMesh& m = *scene_.mMeshes[mesh_index];
    Json joints = Json::array();
    std::vector<float> inverse;
    for (unsigned b = 0; b < m.mNumBones; ++b) {
      const size_t joint = find(&names_, m.mBones[b]->mName.C_Str());
      if (joint == SIZE_MAX) return;  // bones without nodes: the mesh stays undeformed
      joints.push_back(joint);
      const Json matrix = matrix_json(m.mBones[b]->mOffsetMatrix);
      for (const Json& x : matrix) inverse.push_back(x.get<float>());
    }
    glb_.json["nodes"][at]["skin"] =
        glb_.add("skins", {{"joints", joints}, {"inverseBindMatrices", glb_.add_floats(inverse, "MAT4", 16)}});
  }

  /// Adds a root node that converts the file's units and axes to metres and y upwards.
  size_t outer(size_t root) {
    int up = 1, sign = 1;
    // In 3MF (core specification, 3.1: the build platform is the xy plane) and in Blender z points upwards.
    if (ending_ == "3mf" || ending_ == "blend") up = 2;
    if (scene_.mMetaData) {
      scene_.mMetaData->Get("UpAxis", up);
      scene_.mMetaData->Get("UpAxisSign", sign);
    }
    const double scale = unit();
    Json made = {{"children", {root}}, {"scale", {scale, scale, scale}}};
    if (up == 2) made["rotation"] = {sign * -std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
    if (scale == 1 && up != 2) return root;
    return glb_.add("nodes", made);
  }

  /// The file's unit of length [m].
  double unit() const {
    double unit = 0;
    float unit_float = 0;
    if (scene_.mMetaData && !scene_.mMetaData->Get("UnitScaleFactor", unit) &&
        scene_.mMetaData->Get("UnitScaleFactor", unit_float))
      unit = double(unit_float);
    return unit > 0 && std::isfinite(unit) ? unit / 100 : (unit_ > 0 ? unit_ : 1);  // FBX states it in centimetres
  }

  const aiScene& scene_;
  Glb& glb_;
  const std::string& ending_;
  double unit_;
  std::vector<size_t> meshes_;  // their indices in the .glb
  std::vector<std::pair<size_t, unsigned>> skinned_;
  Names names_;
};

}  // namespace

Json matrix_json(const aiMatrix4x4& m) {
  Json columns = Json::array();
  for (unsigned c = 0; c < 4; ++c)
    for (unsigned r = 0; r < 4; ++r) columns.push_back(std::isfinite(m[r][c]) ? m[r][c] : 0.0f);
  return columns;
}

void convert(const aiScene& scene, Glb& glb, const std::string& ending, double unit) {
  SceneWriter(scene, glb, ending, unit).write();
}

}  // namespace etendue::assimp_helper
