// Converts Assimp's lights and cameras to glTF.

#include <algorithm>
#include <cmath>

#include "convert.h"

namespace etendue::assimp_helper {
namespace {

constexpr double pi = 3.14159265358979323846;

/// The transform from a space with -z forward to one in which `forward` is.
aiMatrix4x4 looking(const aiVector3D& from, aiVector3D forward, aiVector3D up) {
  if (!(forward.SquareLength() > 0)) forward = {0, 0, -1};
  forward.Normalize();
  aiVector3D right = forward ^ up;
  if (!(right.SquareLength() > 1e-12f))
    right = forward ^ (std::abs(forward.y) < 0.9f ? aiVector3D(0, 1, 0) : aiVector3D(1, 0, 0));
  right.Normalize();
  const aiVector3D above = right ^ forward;
  return {right.x, above.x, -forward.x, from.x, right.y, above.y, -forward.y, from.y,
          right.z, above.z, -forward.z, from.z, 0,       0,       0,          1};
}

aiMatrix4x4 global(const aiNode* node) {
  aiMatrix4x4 m;
  for (; node; node = node->mParent) m = node->mTransformation * m;
  return m;
}

void bounds(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, aiVector3D& low, aiVector3D& high) {
  const aiMatrix4x4 here = above * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D p = here * mesh.mVertices[v];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) bounds(scene, *node.mChildren[i], here, low, high);
}

/// Adds a child to a node, or to the root if `parent` is SIZE_MAX.
void add_below(Glb& glb, size_t parent, Json node) {
  const size_t place = glb.add("nodes", std::move(node));
  glb.json["nodes"][parent == SIZE_MAX ? 0 : parent]["children"].push_back(place);  // node 0 is the root
}

// These formats do not state the strength of lights. Their colour is taken for the irradiance at the centre of the model, such
// that a white surface there would have that colour.
void add_light(const aiScene& scene, Glb& glb, const aiLight& light, size_t parent, const aiVector3D& middle, double unit) {
  const std::string name = clean(light.mName.C_Str());
  if (light.mType == aiLightSource_AMBIENT) return glb.note("light that comes from everywhere ('ambient') is left out");
  const bool distant = light.mType == aiLightSource_DIRECTIONAL, spot = light.mType == aiLightSource_SPOT;
  double most = double(std::max({light.mColorDiffuse.r, light.mColorDiffuse.g, light.mColorDiffuse.b}));
  if (!std::isfinite(most) || most <= 0) return glb.note("lights without colour are left out");
  Json made = {{"name", name}, {"type", distant ? "directional" : (spot ? "spot" : "point")}};
  made["color"] = {light.mColorDiffuse.r / most, light.mColorDiffuse.g / most, light.mColorDiffuse.b / most};
  most = std::min(most, 1.0);
  const aiVector3D place = global(scene.mRootNode->FindNode(light.mName)) * light.mPosition;
  const double distance = unit * std::max(double((place - middle).Length()), 1e-6);  // [m]
  made["intensity"] = pi * most * (distant ? 1 : distance * distance);
  if (!distant)
    glb.note("lights fall off with the square of the distance, and are so strong that the middle is lit as the file says");
  if (light.mType == aiLightSource_AREA) glb.note("lights with an area are points");
  if (spot) {
    const double outer = std::clamp(double(light.mAngleOuterCone) / 2, 0.01, pi / 2);
    made["spot"] = {{"outerConeAngle", outer},
                    {"innerConeAngle", std::clamp(double(light.mAngleInnerCone) / 2, 0.0, outer * 0.999)}};
  }
  Json& all = glb.json["extensions"]["KHR_lights_punctual"]["lights"];
  all.push_back(made);
  const size_t index = all.size() - 1;
  add_below(glb, parent,
            {{"name", name},
             {"matrix", matrix_json(looking(light.mPosition, light.mDirection, {0, 1, 0}))},
             {"extensions", {{"KHR_lights_punctual", {{"light", index}}}}}});
}

/// Whether the model's bounding box is outside of a camera's view: for some formats Assimp computes a wrong view direction.
bool sees_nothing(const aiScene& scene, const aiCamera& camera, const aiVector3D& low, const aiVector3D& high) {
  const aiMatrix4x4 place = global(scene.mRootNode->FindNode(camera.mName));
  const aiVector3D from = place * camera.mPosition;
  aiVector3D forward = aiMatrix3x3(place) * camera.mLookAt;
  forward.NormalizeSafe();
  const double radius = double((high - low).Length()) / 2, distance = double(((low + high) * 0.5f - from).Length());
  if (low.x > high.x || distance <= radius) return false;
  const double cosine = double(forward * ((low + high) * 0.5f - from)) / distance;
  return std::acos(std::clamp(cosine, -1.0, 1.0)) > std::asin(radius / distance) + double(camera.mHorizontalFOV) / 2;
}

// Clipping planes are omitted: Assimp does not report whether the file states them.
void add_camera(Glb& glb, const aiCamera& camera, size_t parent) {
  const std::string name = clean(camera.mName.C_Str());
  const double aspect = camera.mAspect > 0 && std::isfinite(camera.mAspect) ? double(camera.mAspect) : 4.0 / 3;
  Json made = {{"name", name}};
  if (camera.mOrthographicWidth > 0) {
    made["type"] = "orthographic";
    made["orthographic"] = {{"xmag", camera.mOrthographicWidth}, {"ymag", camera.mOrthographicWidth / aspect}};
  } else {
    const double across = std::clamp(double(camera.mHorizontalFOV), 0.01, 3.0);
    made["type"] = "perspective";
    made["perspective"] = {{"yfov", 2 * std::atan(std::tan(across / 2) / aspect)}, {"aspectRatio", aspect}};
  }
  const size_t index = glb.add("cameras", made);
  add_below(
      glb, parent,
      {{"name", name}, {"camera", index}, {"matrix", matrix_json(looking(camera.mPosition, camera.mLookAt, camera.mUp))}});
}

}  // namespace

void convert_lights(const aiScene& scene, Glb& glb, size_t (*node_of)(const void*, const char*), const void* names,
                    double unit) {
  aiVector3D low(1e30f, 1e30f, 1e30f), high(-1e30f, -1e30f, -1e30f);
  bounds(scene, *scene.mRootNode, aiMatrix4x4(), low, high);
  const aiVector3D middle = low.x <= high.x ? (low + high) * 0.5f : aiVector3D();
  for (unsigned i = 0; i < scene.mNumLights; ++i)
    add_light(scene, glb, *scene.mLights[i], node_of(names, scene.mLights[i]->mName.C_Str()), middle, unit);
  for (unsigned i = 0; i < scene.mNumCameras; ++i)
    if (sees_nothing(scene, *scene.mCameras[i], low, high))
      glb.note("a camera that sees nothing of the model is left out");
    else
      add_camera(glb, *scene.mCameras[i], node_of(names, scene.mCameras[i]->mName.C_Str()));
}

}  // namespace etendue::assimp_helper
