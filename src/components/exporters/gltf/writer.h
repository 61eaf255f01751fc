#pragma once
// Writes a job as a glTF 2.0 file.

#include <fmt/format.h>

#include <array>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>

#include "components/exporters/amounts.h"
#include "components/exporters/members.h"
#include "components/exporters/triangles/exported_mesh.h"
#include "etendue/exporter.h"
#include "etendue/render/job.h"

namespace etendue::gltf_export {

using Json = nlohmann::ordered_json;

/// A file name as a URI reference: percent-encodes all but letters, digits and unreserved marks (RFC 3986).
std::string as_uri(const std::string& name);

constexpr float at_d_line = 587.6f;  // [nm] wavelength at which indices of refraction are stated

/// Return a nested object, created if it is missing; `metal`: the object pbrMetallicRoughness of a material.
Json& child(Json& of, const char* name);
Json& metal(Json& material);
std::array<double, 3> clamped(std::array<double, 3> rgb);
Json with_alpha(const std::array<double, 3>& rgb);
/// Whether a member has a map that is not white, so that it changes what it multiplies.
bool colored(const Component& of, const char* member);

class Writer {
 public:
  Writer(const Job& j, Exporting& e) : job(j), exporting(e) {}
  /// The complete .glb file, or the JSON alone with the buffer in a file beside it.
  std::string write(bool binary);

 private:
  // nodes.cpp: each returns the node's index.
  size_t node(Json);
  /// A node that transforms its children; `children` are indices.
  size_t group(const Transform&, Json children);
  Json nodes_of(const Scene&);
  /// Nothing: the object is left out.
  std::optional<size_t> node_of(const SceneObject&);
  std::optional<size_t> light_node(const SceneObject&, bool& is_light);
  size_t camera_node();
  Transform still(const AnimatedTransform&, const Component& of);

  // meshes.cpp
  /// The index of an object's mesh; `placed`: vertices include the object's transform. Nothing: it has no triangles.
  std::optional<size_t> mesh(const SceneObject&, bool& placed);
  /// The attribute COLOR_0 of an object's vertices; see vertex_colors.cpp.
  std::optional<std::vector<float>> vertex_colors(const SceneObject&, size_t vertices, size_t material);
  size_t accessor(const void* data, size_t bytes, size_t count, int component_type, const char* type, int target);

  // bodies.cpp
  void glass(Json& m, const Component& shader, bool thin);
  void principled(Json& m, const Component& shader);
  void principled_base(Json& m, const Component& shader, double clear);
  void note_left_out(const Component& shader, std::initializer_list<const char*> members);

  // materials.cpp
  /// The index of the material that combines an object's shader, emission, sides and interior.
  std::optional<size_t> material(const SceneObject&);
  void surface(Json& m, const Component& shader);
  void metal_and_roughness(Json& m, const Component& principled);
  void normals(Json& m, const Component& shader);
  void absorption(Json& m, const Component& interior);

  // light.cpp
  void holes(Json& m, const Component& of, const char* member);
  void emission(Json& m, const SceneObject&, const Component& emission);
  /// The radiance of a diffuse emission of the same power; nothing, with a warning: the power cannot be computed.
  Color mean_radiance(const SceneObject&, const Component& emission);

  // textures.cpp
  /// An image and its texture coordinate transform: scale, then rotation, then shift.
  struct Placed {
    const Component* image = nullptr;
    std::array<double, 2> scale{1, 1}, shift{0, 0};
    double angle = 0;  ///< [rad]
  };
  static std::optional<Placed> placed_of(const Component& map);
  /// A number, times a channel of an image, times a vertex attribute.
  struct Amount {
    double factor = 1;
    std::optional<Placed> image = {};
    std::string channel = {}, of_vertices = {};
    bool grey = false;  ///< red, green and blue of the image are equal
  };
  /// Nothing: the map cannot be expressed in this form.
  static std::optional<Amount> amount_of(const Component& map);
  /// The amount of a member if it is an image whose channel glTF reads.
  std::optional<Amount> textured_amount(const Component& of, const char* member, const char* channel);
  /// Returns the factor, and writes the texture that it multiplies to `to` under `key`.
  double number(const Component& of, const char* member, double otherwise, const char* channel, Json& to, const char* key);
  /// A number from a member, at the d line if it is a spectrum; if it is not constant, warns and returns `otherwise`.
  double scalar(const Component& of, const char* member, double otherwise);
  /// A colour as a factor, a texture, and vertex colours (`by_vertex`: the colour of meshes that have none).
  struct Look {
    std::array<double, 3> factor{1, 1, 1};
    std::optional<Json> texture = {};
    std::optional<std::array<double, 3>> by_vertex = {};
  };
  /// `base`: the member is the base colour, which may have vertex colours.
  Look look(const Component& of, const char* member, ColorUse, bool base = false);
  Look look_of(const Component& map, ColorUse);
  void base_color(Json& m, const Look&);
  /// The JSON entry of an image: in a .glb its bytes are in the buffer, otherwise it names the file.
  Json image_entry(const Component& image, const std::string& ending, bool colors);
  std::string as_png(const Component& image, bool colors);
  /// `colors`: the image contains colours, not numbers.
  std::optional<Json> texture(const Placed&, bool colors);
  void extend(Json& m, const char* extension, Json content);

  const Job& job;
  Exporting& exporting;
  bool binary_ = false;
  Json document_;
  std::string buffer_;
  size_t made_nodes_ = 0;
  std::map<const SceneObject*, std::pair<std::optional<size_t>, bool>> meshes_;
  std::map<std::tuple<const Component*, const Component*, const Component*, std::string>, size_t> materials_;
  std::map<std::pair<std::string, std::string>, size_t> textures_;
  /// Vertex attributes that a material uses.
  struct FromVertices {
    std::optional<std::array<double, 3>> color;  ///< the colour of meshes without vertex colours
    bool alpha = false;
  };
  std::map<size_t, FromVertices> from_vertices_;  // by material index
  FromVertices of_this_;                          // of the material being written
};

}  // namespace etendue::gltf_export
