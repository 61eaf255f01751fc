#pragma once
// Files contained in another file, such as the images in a model. Their path is the path of the container, '#' and their name
// within it, such as "model.glb#images[3].png"; RegularFile opens them like any other file.

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// Returns the bytes of a named item of a container file. Throws Error with the reason alone. Thread-safe.
using Unpack = std::string (*)(const std::string& container, const std::string& name);
/// Registers the unpacking function of containers with these extensions (without dots, lower case). Called at program start.
bool register_container(const std::vector<std::string>& endings, Unpack);

struct ContainedFile {
  std::string container;  ///< path of the container
  std::string name;       ///< within the container
  Unpack unpack;
};
/// Splits a path into container and name. Nothing if the path is that of a file of its own, or of no known container.
std::optional<ContainedFile> contained_file(const std::string& path);

/// The file on disk for a path: the container, or the path itself.
std::string file_on_disk(const std::string& path);

}  // namespace etendue
