#pragma once
// Builds a .glb file: its JSON, and the bytes of its single buffer.

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

  /// Adds an element to a top-level list and returns its index.
  size_t add(const char* list, Json element);
  /// Adds bytes as a buffer view.
  size_t add_view(const void* bytes, size_t size);
  size_t add_floats(const std::vector<float>&, const char* type, size_t width);
  size_t add_indices(const std::vector<std::uint32_t>&);
  size_t add_joints(const std::vector<std::uint16_t>&);
  /// Stores a warning about an inexact conversion, once for each text; the importer reports it.
  void note(const std::string&);

  /// A hash of the content to be written.
  std::uint64_t digest() const;
  /// Writes to a file descriptor; returns false on failure.
  bool write(int descriptor);

 private:
  std::string buffer_;
};

/// Replaces invalid UTF-8 by U+FFFD, since JSON must be UTF-8.
std::string clean(const std::string&);

}  // namespace etendue::assimp_helper
