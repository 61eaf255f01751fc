#include "compression.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "accessor.h"
#include "compressed/draco.h"
#include "compressed/meshopt.h"
#include "document.h"

namespace etendue::gltf {
namespace {

constexpr const char* meshopt_extensions[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
constexpr const char* draco = "KHR_draco_mesh_compression";

template <class T, size_t n>
T named(const Json& object, const char* key, const char* otherwise, const std::pair<const char*, T> (&names)[n]) {
  const std::string name = text(object, key, otherwise);
  for (const auto& [known, value] : names)
    if (name == known) return value;
  throw Error(fmt::format("'{}' '{}' is unknown", key, name.substr(0, 30)));
}

MeshoptLayout layout_of(const Json& meshopt, std::uint64_t view_size) {
  MeshoptLayout layout;
  layout.mode = named<MeshoptMode>(
      meshopt, "mode", "",
      {{"ATTRIBUTES", MeshoptMode::attributes}, {"TRIANGLES", MeshoptMode::triangles}, {"INDICES", MeshoptMode::indices}});
  layout.filter = named<MeshoptFilter>(meshopt, "filter", "NONE",
                                       {{"NONE", MeshoptFilter::none},
                                        {"OCTAHEDRAL", MeshoptFilter::octahedral},
                                        {"QUATERNION", MeshoptFilter::quaternion},
                                        {"EXPONENTIAL", MeshoptFilter::exponential},
                                        {"COLOR", MeshoptFilter::color}});
  layout.count = needed_whole(meshopt, "count");
  layout.stride = needed_whole(meshopt, "byteStride");
  if (layout.mode != MeshoptMode::attributes && layout.filter != MeshoptFilter::none)
    throw Error("a 'filter' is for the mode ATTRIBUTES alone");
  if (layout.stride == 0 || layout.count != view_size / layout.stride || view_size % layout.stride != 0)
    throw Error(
        fmt::format("{} elements of {} bytes are not the {} bytes of the view", layout.count, layout.stride, view_size));
  return layout;
}

/// Whether an accessor's data is stored uncompressed.
bool is_there(const Document& document, size_t accessor) {
  return find(document.element("accessors", accessor), "bufferView") != nullptr;
}

/// Whether a primitive exists only in Draco-compressed form.
bool needs_draco(const Document& document, const Json& primitive) {
  constexpr size_t triangles = 4;
  const Json& attributes = object_in(primitive, "attributes");
  const auto positions = whole(attributes, "POSITION"), indices = whole(primitive, "indices");
  if (!has_extension(primitive, draco) || !positions || whole(primitive, "mode").value_or(triangles) < triangles) return false;
  if (!is_there(document, *positions) || (indices && !is_there(document, *indices))) return true;
  for (const auto& [name, id] : object_in(extension(primitive, draco), "attributes").items())
    if (const auto accessor = whole(attributes, name.c_str()); accessor && !is_there(document, *accessor)) return true;
  return false;
}

/// A primitive that Draco compressed, and the index of its request.
struct Compressed {
  size_t mesh, primitive, request;
  struct Attribute {
    std::string name;
    size_t accessor, place;  ///< the accessor that describes it, and its index in the request
  };
  std::vector<Attribute> attributes;

  std::string where() const { return fmt::format("meshes[{}].primitives[{}]: {}", mesh, primitive, draco); }
};

/// The requests to Draco: each buffer view once, even if several primitives use it.
class Requests {
 public:
  explicit Requests(const Document& document) : document_(document) {}
  std::vector<DracoRequest> requests;
  std::vector<Compressed> primitives;

  void add(size_t mesh, size_t primitive, const Json& p) {
    Compressed one{mesh, primitive, 0, {}};
    within(one.where(), [&] {
      one.request = request_of(needed_whole(extension(p, draco), "bufferView"));
      const Json& attributes = object_in(p, "attributes");
      const Json& ids = object_in(extension(p, draco), "attributes");
      for (const auto& [name, id] : ids.items())
        if (const auto accessor = whole(attributes, name.c_str())) {
          const size_t component = needed_whole(document_.element("accessors", *accessor), "componentType");
          (void)size_of_component(int(std::min<size_t>(component, 1 << 20)));
          const size_t wanted = needed_whole(ids, name.c_str());
          if (wanted > UINT32_MAX) throw Error(fmt::format("there is no attribute {}", wanted));
          one.attributes.push_back(
              {name, *accessor, place_of(requests[one.request], std::uint32_t(wanted), std::uint32_t(component))});
        }
      if (!find(ids, "POSITION") && !is_there(document_, needed_whole(attributes, "POSITION")))
        throw Error("it has no POSITION");
    });
    primitives.push_back(std::move(one));
  }

 private:
  size_t request_of(size_t view) {
    const auto [known, is_new] = by_view_.emplace(view, requests.size());
    if (!is_new) return known->second;
    bytes_ += document_.view_size(view);
    if (bytes_ > document_.buffer_bytes()) throw Error("the compressed bytes of several meshes are the same");
    requests.push_back({document_.view_bytes(view), {}});
    return requests.size() - 1;
  }
  static size_t place_of(DracoRequest& request, std::uint32_t id, std::uint32_t component) {
    auto& all = request.attributes;
    const auto found = std::ranges::find_if(all, [&](const auto& a) { return a.id == id && a.component == component; });
    if (found == all.end()) return all.push_back({id, component}), all.size() - 1;
    return size_t(found - all.begin());
  }

  const Document& document_;
  std::map<size_t, size_t> by_view_;
  std::uint64_t bytes_ = 0;
};

/// Adds accessors and buffer views for the decompressed data to the JSON, each only once.
class Additions {
 public:
  Additions(Json& json, const DracoMeshes& made, size_t buffer) : json_(json), made_(made), buffer_(buffer) {}

  void replace(const Compressed& one) {
    const DracoMesh& mesh = made_.meshes[one.request];
    Json& primitive = json_["meshes"][one.mesh]["primitives"][one.primitive];
    for (const auto& [name, accessor, place] : one.attributes) {
      const DracoMesh::Attribute& made = mesh.attributes[place];
      const auto [known, is_new] = known_.emplace(std::tuple(one.request, place, accessor), count("accessors"));
      if (is_new) {
        Json described = json_["accessors"][accessor];
        described["bufferView"] = view(made.offset, mesh.vertices * made.bytes);
        described["count"] = mesh.vertices;
        described["type"] = made.width == 1 ? "SCALAR" : fmt::format("VEC{}", made.width);
        described.erase("byteOffset");
        json_["accessors"].push_back(std::move(described));
      }
      primitive["attributes"][name] = known->second;
    }
    const auto [known, is_new] = known_.emplace(std::tuple(one.request, SIZE_MAX, SIZE_MAX), count("accessors"));
    if (is_new)
      json_["accessors"].push_back({{"bufferView", view(mesh.indices, mesh.triangles * 3 * sizeof(std::uint32_t))},
                                    {"componentType", 5125},
                                    {"type", "SCALAR"},
                                    {"count", 3 * mesh.triangles}});
    primitive["indices"] = known->second;
    primitive["mode"] = 4;  // triangles, whatever the mode was: Draco decodes to triangle lists
  }

 private:
  size_t count(const char* list) const { return json_.contains(list) ? json_[list].size() : 0; }
  size_t view(std::uint64_t offset, std::uint64_t size) {
    json_["bufferViews"].push_back({{"buffer", buffer_}, {"byteOffset", offset}, {"byteLength", size}});
    return count("bufferViews") - 1;
  }

  Json& json_;
  const DracoMeshes& made_;
  size_t buffer_;
  std::map<std::tuple<size_t, size_t, size_t>, size_t> known_;  // indices of accessors
};

}  // namespace

bool is_fallback(const Json& buffer) {
  return std::ranges::any_of(meshopt_extensions,
                             [&](const char* name) { return truth(extension(buffer, name), "fallback", false); });
}

// Each decompressed view gets a buffer of its own. The compressed bytes of two views should not overlap; if they do, their
// decompressed size in total is limited to what the whole file could encode.
void Document::decompress_views() {
  std::uint64_t room = 1024 * buffer_bytes();
  for (size_t i = 0; i < count("bufferViews"); ++i) {
    const Json& view = element("bufferViews", i);
    for (const char* name : meshopt_extensions) {
      const Json& meshopt = extension(view, name);
      const auto original = whole(view, "buffer");
      if (meshopt.empty() || !original || *original >= buffers_.size() || !buffers_[*original].missing) continue;
      Buffer made = within(fmt::format("bufferViews[{}]: {}", i, name), [&] {
        const MeshoptLayout layout = layout_of(meshopt, needed_whole(view, "byteLength"));
        const std::string compressed = bytes_of(needed_whole(meshopt, "buffer"), whole(meshopt, "byteOffset").value_or(0),
                                                needed_whole(meshopt, "byteLength"));
        Buffer buffer;
        buffer.bytes = decode_meshopt(compressed, layout);
        buffer.size = layout.count * layout.stride;
        buffer.decompressed = true;
        if (buffer.size > room) throw Error("the compressed bytes of several views are the same");
        room -= buffer.size;
        return buffer;
      });
      json_["bufferViews"][i]["buffer"] = buffers_.size();
      json_["bufferViews"][i]["byteOffset"] = 0;
      buffers_.push_back(std::move(made));
      break;
    }
  }
}

// All data that Draco decodes is stored in one buffer, which new accessors of the primitives refer to.
void Document::decompress_meshes() {
  Requests asked(*this);
  for (size_t m = 0; m < count("meshes"); ++m) {
    const Json& primitives = list_in(element("meshes", m), "primitives");
    for (size_t p = 0; p < primitives.size(); ++p)
      if (within(fmt::format("meshes[{}].primitives[{}]", m, p), [&] { return needs_draco(*this, primitives[p]); }))
        asked.add(m, p, primitives[p]);
  }
  if (asked.requests.empty()) return;
  DracoMeshes made;
  size_t failed = 0;
  try {
    made = decode_draco(asked.requests, failed);
  } catch (const Error& error) {
    const auto first = std::ranges::find(asked.primitives, failed, &Compressed::request);
    throw Error(first->where() + ": " + error.what());
  }
  Additions additions(json_, made, buffers_.size());
  for (const Compressed& one : asked.primitives) additions.replace(one);
  Buffer buffer;
  buffer.size = made.bytes.size();
  buffer.bytes = std::move(made.bytes);
  buffer.decompressed = true;
  buffers_.push_back(std::move(buffer));
}

}  // namespace etendue::gltf
