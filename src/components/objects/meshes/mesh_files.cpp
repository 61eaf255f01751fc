#include "mesh_files.h"

#include <filesystem>
#include <tuple>

#include "files/shared_contents.h"

namespace etendue {

std::shared_ptr<const MeshData> mesh_from_file(const std::string& path, const std::string& part, bool whole) {
  using Version = std::pair<std::filesystem::file_time_type, std::uintmax_t>;
  static auto& all = *new SharedContents<std::tuple<std::string, std::string, bool>, Version, MeshData>;
  std::error_code none;  // errors are reported when the file is read
  const Version version(std::filesystem::last_write_time(path, none), std::filesystem::file_size(path, none));
  return all.get({path, part, whole}, version, [&] {
    MeshData mesh = read_mesh(path, part);
    if (!whole) drop_unusable(mesh, "'" + path + "'", {}, part.empty());
    make_shareable(mesh);
    return std::make_shared<const MeshData>(std::move(mesh));
  });
}

}  // namespace etendue
