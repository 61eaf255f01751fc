#pragma once
// Which files this process may open: it reads formats whose reader has faults that are known.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <assimp/IOSystem.hpp>

namespace etendue::assimp_helper {

/// Files in these folders and below, for reading alone. Assimp asks it for everything it opens.
class FilesWithin : public Assimp::IOSystem {
 public:
  explicit FilesWithin(std::vector<std::string> folders);
  bool Exists(const char* path) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* path, const char* mode) override;
  void Close(Assimp::IOStream*) override;

 private:
  /// The path to open, or "".
  std::string allowed(const std::string& path) const;
  std::vector<std::string> folders_;                            // with all links followed
  std::map<std::string, std::optional<std::string>> prepared_;  // by the path
};

}  // namespace etendue::assimp_helper
