#include "draco.h"

#include <cstring>
#include <span>

#include "etendue/core/error.h"
#include "files/helper_process.h"

namespace etendue::gltf {
namespace {

using draco_wire::AttributeAsked, draco_wire::AttributeMade, draco_wire::MeshAsked, draco_wire::MeshMade;

template <class T>
void append(std::string& to, const T& value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// The helper's answer, read from its beginning; arrays are skipped.
class Answer {
 public:
  explicit Answer(const std::string& bytes) : bytes_(bytes) {}

  template <class T>
  T value() {
    T v;
    const std::uint64_t begin = pass(1, sizeof v);
    std::memcpy(&v, bytes_.data() + begin, sizeof v);
    return v;
  }
  /// Skips an array and returns its offset.
  std::uint64_t pass(std::uint64_t count, std::uint64_t size) {
    if (size > 0 && count > (bytes_.size() - at_) / size) throw Error("what etendue_draco made of it ends too early");
    at_ += count * size;
    return at_ - count * size;
  }

 private:
  const std::string& bytes_;
  std::uint64_t at_ = 0;
};

DracoMeshes decode_all(std::span<const DracoRequest> requests) {
  std::string asked;
  for (const DracoRequest& request : requests) {
    append(asked, MeshAsked{request.compressed.size(), request.attributes.size()});
    for (const AttributeAsked& attribute : request.attributes) append(asked, attribute);
    asked += request.compressed;
  }
  DracoMeshes all{run_helper("etendue_draco", {}, asked), {}};
  Answer answer(all.bytes);
  for (const DracoRequest& request : requests) {
    DracoMesh& mesh = all.meshes.emplace_back();
    const auto made = answer.value<MeshMade>();
    mesh.triangles = made.triangles;
    mesh.vertices = made.vertices;
    for (size_t i = 0; i < request.attributes.size(); ++i) {
      const auto attribute = answer.value<AttributeMade>();
      mesh.attributes.push_back({0, attribute.width, attribute.bytes});
    }
    mesh.indices = answer.pass(mesh.triangles, 3 * sizeof(std::uint32_t));
    for (DracoMesh::Attribute& attribute : mesh.attributes) attribute.offset = answer.pass(mesh.vertices, attribute.bytes);
  }
  return all;
}

}  // namespace

// One process decodes all meshes: starting one takes as long as reading some thousand triangles. On failure bisection finds the
// first mesh that fails.
DracoMeshes decode_draco(const std::vector<DracoRequest>& requests, size_t& failed) {
  try {
    return decode_all(requests);
  } catch (const Error& error) {
    size_t begin = 0, end = requests.size();
    std::string reason = error.what();
    while (end - begin > 1) {
      const size_t middle = (begin + end) / 2;
      try {
        (void)decode_all(std::span(requests).subspan(begin, middle - begin));
        begin = middle;
      } catch (const Error& inner) {
        end = middle;
        reason = inner.what();
      }
    }
    failed = begin;
    throw Error(reason);
  }
}

}  // namespace etendue::gltf
