#pragma once
// A glTF 2.0 file (.gltf, .glb): its JSON, and the bytes of its buffers and images. Buffer data is read from the file on
// demand. Source: The Khronos Group 2021, glTF 2.0 Specification (ISO/IEC 12113:2022).

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "etendue/importer.h"
#include "json_access.h"

namespace etendue::gltf {

/// Bytes in a file; if `path` is empty, in the memory of a converted file.
struct Slice {
  std::string path;
  std::uint64_t offset = 0;
};
struct Buffer {
  std::variant<Slice, std::string> bytes;
  std::uint64_t size = 0;
  bool missing = false;       ///< not stored: only a size, for compressed views that also name a fallback buffer
  bool decompressed = false;  ///< result of decompression
};

class Document {
 public:
  /// Opens a file, or returns the document opened before. Files of other formats are converted (see register_converter), in
  /// their state at a time [s]. If an Importing is given, its options determine that time and the other files that may be
  /// opened. Throws Error; without an Importing its message is the reason without a location.
  static std::shared_ptr<const Document> open(const std::string& path, const Importing* = nullptr, double time = 0);

  /// Whether it was converted from another format, and the time of the conversion [s]; 0 for other files.
  bool converted() const { return converted_; }
  double time() const { return time_; }

  const Json& json() const { return json_; }
  /// An element of a top-level list: element("meshes", 3).
  const Json& element(const char* list, size_t i) const;
  size_t count(const char* list) const { return list_in(json_, list).size(); }

  /// Size of all buffers [bytes], as a limit for the triangles they can describe. A decompressed buffer counts one byte for
  /// each 12 bytes, the size of a triangle's indices.
  std::uint64_t buffer_bytes() const;
  /// Reads bytes of a buffer view from an offset. Throws Error if they lie outside of the view or its buffer.
  void read_view(size_t view, std::uint64_t offset, std::uint64_t bytes, void* to) const;
  std::string view_bytes(size_t view) const;
  /// Size of a buffer view [bytes], and the distance between its elements, or 0.
  std::uint64_t view_size(size_t view) const;
  size_t view_stride(size_t view) const;

  /// The name of an image inside this file: "images[3].png"; empty for an image in a file of its own.
  std::string inner_image(size_t image) const;
  /// The bytes of such an embedded image.
  std::string image_bytes(const std::string& inner) const;

 private:
  void parse(std::string_view text);
  void read_container(const std::string& path, const std::string* bytes);
  void find_buffers(const Importing&);
  Buffer find_buffer(const Json& description, size_t index, const Importing&) const;
  // Replace compressed data by plain buffers; see compression.cpp.
  void decompress_views();
  void decompress_meshes();
  std::string bytes_of(size_t buffer, std::uint64_t offset, std::uint64_t bytes) const;
  void require_bytes(size_t buffer, std::uint64_t offset, std::uint64_t bytes) const;
  void read_buffer(size_t buffer, std::uint64_t begin, std::uint64_t bytes, void* to) const;

  Json json_;
  std::optional<Buffer> chunk_;  // the binary chunk of a .glb
  std::vector<Buffer> buffers_;
  std::string own_bytes_;  // content of a converted file
  bool converted_ = false;
  double time_ = 0;
};

/// Registers the reading of meshes and images inside of files with these endings. Called at program start.
bool register_parts(const std::vector<std::string>& endings);

/// Converts a file of another format to a .glb in memory. Throws Error with the reason, without a location.
using Converter = std::string (*)(const std::string& path, const Importing&);
/// Registers the converter for files with these endings, and their parts as register_parts does.
bool register_converter(const std::vector<std::string>& endings, Converter);

}  // namespace etendue::gltf
