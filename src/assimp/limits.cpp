#include "limits.h"

#include <assimp/MemoryIOWrapper.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "prepared.h"

namespace etendue::assimp_helper {
namespace {

/// A stream on a C library file.
class File final : public Assimp::IOStream {
 public:
  explicit File(std::FILE* file) : file_(file) {}
  ~File() override { std::fclose(file_); }
  size_t Read(void* to, size_t size, size_t count) override { return std::fread(to, size, count, file_); }
  size_t Write(const void*, size_t, size_t) override { return 0; }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    const int from = origin == aiOrigin_SET ? SEEK_SET : (origin == aiOrigin_CUR ? SEEK_CUR : SEEK_END);
    return ::fseeko(file_, off_t(offset), from) == 0 ? aiReturn_SUCCESS : aiReturn_FAILURE;
  }
  size_t Tell() const override { return size_t(::ftello(file_)); }
  size_t FileSize() const override {
    struct stat status{};
    return ::fstat(::fileno(file_), &status) == 0 ? size_t(status.st_size) : 0;
  }
  void Flush() override {}

 private:
  std::FILE* file_;
};

}  // namespace

FilesWithin::FilesWithin(std::vector<std::string> folders) {
  for (const std::string& folder : folders) {
    std::error_code error;
    folders_.push_back(std::filesystem::weakly_canonical(std::filesystem::absolute(folder, error), error).string() + "/");
  }
}

std::string FilesWithin::allowed(const std::string& path) const {
  std::error_code error;
  const std::string real = std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error).string();
  const bool inside = std::ranges::any_of(folders_, [&](const std::string& folder) { return real.starts_with(folder); });
  return !error && inside && std::filesystem::is_regular_file(real, error) ? real : std::string();
}

bool FilesWithin::Exists(const char* path) const { return !allowed(path).empty(); }

Assimp::IOStream* FilesWithin::Open(const char* path, const char*) {
  const std::string found = allowed(path);
  if (found.empty()) return nullptr;
  opened_.insert(path);
  // Assimp opens a file several times: to detect its format, and to read it.
  auto known = prepared_.find(found);
  if (known == prepared_.end()) known = prepared_.emplace(found, prepared(found)).first;
  if (const std::optional<std::string>& text = known->second) {
    auto* const bytes = new std::uint8_t[text->size() + 1];
    std::copy_n(text->c_str(), text->size() + 1, bytes);
    return new Assimp::MemoryIOStream(bytes, text->size(), true);
  }
  std::FILE* file = std::fopen(found.c_str(), "rb");
  return file ? new File(file) : nullptr;
}

void FilesWithin::Close(Assimp::IOStream* stream) { delete stream; }

}  // namespace etendue::assimp_helper
