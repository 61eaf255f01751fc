#pragma once
// A glTF 2.0 file (.gltf, .glb): its JSON, and the bytes of its buffers and images. What is read of a buffer is read when it is
// asked for. Source: The Khronos Group 2021, glTF 2.0 Specification (ISO/IEC 12113:2022).

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "etendue/importer.h"
#include "json_access.h"

namespace etendue::gltf {

/// Bytes of a file; of a converted one, which is in memory, when there is no path.
struct Slice {
  std::string path;
  std::uint64_t offset = 0;
};
struct Buffer {
  std::variant<Slice, std::string> bytes;
  std::uint64_t size = 0;
  bool missing = false;       ///< there is a size alone, for views that are compressed and name a buffer besides
  bool decompressed = false;  ///< made of what is compressed
};

class Document {
 public:
  /// Opens a file, or gives it as it was opened before. Files of other formats are converted (see register_converter), as they
  /// are at a time [s]. With an Importing its options say that time and which other files may be opened. Throws Error, or with
  /// no Importing the reason alone.
  static std::shared_ptr<const Document> open(const std::string& path, const Importing* = nullptr, double time = 0);

  /// Whether a program of ours made it of a file of another format, and at which time of that [s]; 0 of others.
  bool converted() const { return converted_; }
  double time() const { return time_; }

  const Json& json() const { return json_; }
  /// A member of one of the lists at the top: element("meshes", 3).
  const Json& element(const char* list, size_t i) const;
  size_t count(const char* list) const { return list_in(json_, list).size(); }

  /// Of all buffers together [bytes]; what was compressed counts for what it can tell apart, not for its size.
  std::uint64_t buffer_bytes() const;
  /// Bytes of a buffer view, from an offset in it on. Throws Error when that lies outside of the view or its buffer.
  void read_view(size_t view, std::uint64_t offset, std::uint64_t bytes, void* to) const;
  std::string view_bytes(size_t view) const;
  /// Of a buffer view [bytes]; what lies between its elements, or 0.
  std::uint64_t view_size(size_t view) const;
  size_t view_stride(size_t view) const;

  /// What lies in this file: "images[3].png"; empty for an image that is a file of its own.
  std::string inner_image(size_t image) const;
  /// The bytes of such an image.
  std::string image_bytes(const std::string& inner) const;

 private:
  void parse(std::string_view text);
  void read_container(const std::string& path, const std::string* bytes);
  void find_buffers(const Importing&);
  Buffer find_buffer(const Json& description, size_t index, const Importing&) const;
  // What is compressed becomes buffers as if it had never been; see compression.cpp.
  void decompress_views();
  void decompress_meshes();
  std::string bytes_of(size_t buffer, std::uint64_t offset, std::uint64_t bytes) const;
  void require_bytes(size_t buffer, std::uint64_t offset, std::uint64_t bytes) const;
  void read_buffer(size_t buffer, std::uint64_t begin, std::uint64_t bytes, void* to) const;

  Json json_;
  std::optional<Buffer> chunk_;  // of a .glb
  std::vector<Buffer> buffers_;
  std::string own_bytes_;  // of a converted file
  bool converted_ = false;
  double time_ = 0;
};

/// Lets meshes and images be read where they lie in files with these endings. At the program's start.
bool register_parts(const std::vector<std::string>& endings);

/// Makes a .glb of a file of another format, in memory. Throws Error with the reason alone.
using Converter = std::string (*)(const std::string& path, const Importing&);
/// Says who converts files with these endings, whose parts are registered too.
bool register_converter(const std::vector<std::string>& endings, Converter);

}  // namespace etendue::gltf
