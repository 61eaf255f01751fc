#pragma once
// Restricts the files that this process may open, because Assimp's readers have known vulnerabilities.

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <assimp/IOSystem.hpp>

namespace etendue::assimp_helper {

/// Read access to files in these folders and below. Assimp opens all files through this class.
class FilesWithin : public Assimp::IOSystem {
 public:
  explicit FilesWithin(std::vector<std::string> folders);
  bool Exists(const char* path) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* path, const char* mode) override;
  void Close(Assimp::IOStream*) override;
  /// All files that were opened, by the names that they were opened by.
  const std::set<std::string>& opened() const { return opened_; }

 private:
  /// The path to open, or "" if it is not allowed.
  std::string allowed(const std::string& path) const;
  std::vector<std::string> folders_;  // with all symbolic links resolved
  std::set<std::string> opened_;
  std::map<std::string, std::optional<std::string>> prepared_;  // result of prepared(), by path
};

}  // namespace etendue::assimp_helper
