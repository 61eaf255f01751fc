#pragma once
// Files that lie in another file: the images in a model. Their path is that of the container, '#' and their name within it,
// such as "model.glb#images[3].png", and RegularFile opens them like any other.

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// The bytes of what has a name in a container that is a file. Throws Error with the reason alone. From any thread.
using Unpack = std::string (*)(const std::string& container, const std::string& name);
/// Says who knows containers with these endings (without dots, small letters). At the program's start.
bool register_container(const std::vector<std::string>& endings, Unpack);

struct ContainedFile {
  std::string container;  ///< its path
  std::string name;       ///< within it
  Unpack unpack;
};
/// None when the path is that of a file of its own, or of no known container.
std::optional<ContainedFile> contained_file(const std::string& path);

/// The file that holds what the path names: the container, or the path itself.
std::string file_on_disk(const std::string& path);

}  // namespace etendue
