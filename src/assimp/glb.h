#pragma once
// A .glb that is being written: its JSON, and the bytes of its one buffer.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace etendue::assimp_helper {

using Json = nlohmann::json;

class Glb {
 public:
  Glb();
  Json json;

  /// Adds an element to a list at the top, and gives its place.
  size_t add(const char* list, Json element);
  /// Bytes as a buffer view.
  size_t add_view(const void* bytes, size_t size);
  size_t add_floats(const std::vector<float>&, const char* type, size_t width);
  size_t add_indices(const std::vector<std::uint32_t>&);
  size_t add_joints(const std::vector<std::uint16_t>&);
  /// What could not be expressed, once for each text: the importer tells it.
  void note(const std::string&);

  /// Of all that will be written.
  std::uint64_t digest() const;
  /// To a file descriptor; false: it could not be written.
  bool write(int descriptor);

 private:
  std::string buffer_;
};

/// What is no UTF-8 becomes '?': JSON has nothing else.
std::string clean(const std::string&);

}  // namespace etendue::assimp_helper
