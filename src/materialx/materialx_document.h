#pragma once
// MaterialX documents: their materials as shaders in the Open Shading Language, written by PyPI's package `materialx` in a
// process of its own (etendue_materialx.py, which says what it prints).

#include <atomic>
#include <memory>
#include <string>
#include <vector>

namespace etendue {

/// A shader of a material: its name and its parameters with their values. The rest of its text many materials share.
struct MaterialXShader {
  std::string frame;
  std::size_t text = 0;  ///< in MaterialXDocument::texts
  bool empty() const { return frame.empty(); }
};

struct MaterialXMaterial {
  std::string name;              ///< its path in the document
  std::string class_name;        ///< of its shader: after the file, with several materials after file and material
  std::string problem;           ///< why it cannot be read; empty: it can
  MaterialXShader surface;       ///< its closure Ci is the material
  MaterialXShader displacement;  ///< it has the output `height`, or x, y and z; empty: it moves nothing
  bool vector = false;           ///< the displacement has x, y and z, along the tangents and the normal
  bool emits = false;            ///< with the values that the document gives to its parameters

  /// The class of its displacement.
  std::string displacement_class() const { return class_name + "Displacement"; }
};

struct MaterialXDocument {
  std::vector<std::string> files;            ///< that were read: the document and what it includes, or the scene
  std::vector<std::string> include_folders;  ///< of the headers that the shaders include
  std::vector<std::string> notes;            ///< what is lost or missing
  /// Of shaders: what stands before the frame, and the body behind it.
  std::vector<std::pair<std::string, std::string>> texts;
  std::vector<MaterialXMaterial> materials;
  mutable std::atomic<bool> told = false;  ///< whoever reads it next need not tell `notes` and problems again
};

/// Reads a document, or the networks of MaterialX in a USD scene, or returns what was read before, if no file of it has changed
/// since. Only files in its own folder and in `allowed_folders` are read and named in shaders; others are an Error. Throws
/// Error with the reason, without the file's name.
std::shared_ptr<const MaterialXDocument> read_materialx(const std::string& path,
                                                        const std::vector<std::string>& allowed_folders);
/// The same for what may name all files, as a description may, which names the document as a plugin.
std::shared_ptr<const MaterialXDocument> read_materialx(const std::string& path);

/// Reads what etendue_materialx.py prints. Throws Error.
std::shared_ptr<MaterialXDocument> parse_materialx(const std::string& json);

}  // namespace etendue
