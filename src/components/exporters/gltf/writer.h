#pragma once
// A job on its way into a file of glTF 2.0.

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

/// A file's name as a URI reference: all but letters, digits and what never means anything in one as percents (RFC 3986).
std::string as_uri(const std::string& name);

constexpr float at_d_line = 587.6f;  // [nm] where indices are told

/// An object in another one, made if it is not there; of a material that of metal and roughness.
Json& child(Json& of, const char* name);
Json& metal(Json& material);
std::array<double, 3> clamped(std::array<double, 3> rgb);
Json with_alpha(const std::array<double, 3>& rgb);
/// Whether a map colours what it is multiplied with.
bool colored(const Component& of, const char* member);

class Writer {
 public:
  Writer(const Job& j, Exporting& e) : job(j), exporting(e) {}
  /// The JSON and its buffer in one file, or the JSON alone with the buffer beside it.
  std::string write(bool binary);

 private:
  // nodes.cpp: each gives the node's index.
  size_t node(Json);
  /// A node that moves what stands in it; `children` are indices.
  size_t group(const Transform&, Json children);
  Json nodes_of(const Scene&);
  /// Nothing: the object is left out.
  std::optional<size_t> node_of(const SceneObject&);
  std::optional<size_t> light_node(const SceneObject&, bool& is_light);
  size_t camera_node();
  Transform still(const AnimatedTransform&, const Component& of);

  // meshes.cpp
  /// The index of the mesh of an object; `placed`: with the object's transform done. Nothing: it has no triangles.
  std::optional<size_t> mesh(const SceneObject&, bool& placed);
  /// COLOR_0 of an object's vertices; see vertex_colors.cpp.
  std::optional<std::vector<float>> vertex_colors(const SceneObject&, size_t vertices, size_t material);
  size_t accessor(const void* data, size_t bytes, size_t count, int component_type, const char* type, int target);

  // bodies.cpp
  void glass(Json& m, const Component& shader, bool thin);
  void principled(Json& m, const Component& shader);
  void principled_base(Json& m, const Component& shader, double clear);
  void note_left_out(const Component& shader, std::initializer_list<const char*> members);

  // materials.cpp
  /// The index of what an object's shader, emission, sides and interior are in one.
  std::optional<size_t> material(const SceneObject&);
  void surface(Json& m, const Component& shader);
  void metal_and_roughness(Json& m, const Component& principled);
  void normals(Json& m, const Component& shader);
  void absorption(Json& m, const Component& interior);

  // light.cpp
  void holes(Json& m, const Component& of, const char* member);
  void emission(Json& m, const SceneObject&, const Component& emission);
  /// What an emission sends out, as if it did so alike in all directions; nothing and a note: it cannot be told.
  Color mean_radiance(const SceneObject&, const Component& emission);

  // textures.cpp
  /// An image as it lies on a surface: coordinates are scaled, turned, shifted.
  struct Placed {
    const Component* image = nullptr;
    std::array<double, 2> scale{1, 1}, shift{0, 0};
    double angle = 0;  ///< [rad]
  };
  static std::optional<Placed> placed_of(const Component& map);
  /// A number, times a channel of an image, times what vertices have.
  struct Amount {
    double factor = 1;
    std::optional<Placed> image = {};
    std::string channel = {}, of_vertices = {};
    bool grey = false;  ///< the image: its red, green and blue are the same
  };
  /// Nothing: the map is more than that.
  static std::optional<Amount> amount_of(const Component& map);
  /// Of a member, where it is an image of which glTF reads this channel.
  std::optional<Amount> textured_amount(const Component& of, const char* member, const char* channel);
  /// A factor, and the texture it multiplies under `key`.
  double number(const Component& of, const char* member, double otherwise, const char* channel, Json& to, const char* key);
  /// The mean over wavelengths as a number; what is no constant is noted, and `otherwise`.
  double scalar(const Component& of, const char* member, double otherwise);
  /// A colour as factor, texture, and colours of vertices (which are such where a mesh has none).
  struct Look {
    std::array<double, 3> factor{1, 1, 1};
    std::optional<Json> texture = {};
    std::optional<std::array<double, 3>> by_vertex = {};
  };
  /// `base`: vertices may have colours of it.
  Look look(const Component& of, const char* member, ColorUse, bool base = false);
  Look look_of(const Component& map, ColorUse);
  void base_color(Json& m, const Look&);
  /// An image's entry: in a .glb its bytes are in the buffer, otherwise its file is named.
  Json image_entry(const std::string& file, const std::string& ending);
  /// `colors`: the image is of colours, not of numbers.
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
  /// What a material takes from vertices.
  struct FromVertices {
    std::optional<std::array<double, 3>> color;  ///< where there is none
    bool alpha = false;
  };
  std::map<size_t, FromVertices> from_vertices_;  // of materials
  FromVertices of_this_;                          // of the one that is being written
};

}  // namespace etendue::gltf_export
