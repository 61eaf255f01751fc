#include "outputs/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "etendue/error.h"

namespace etendue {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw Error(fmt::format("cannot write '{}': {}", path, reason));
}

std::string reason(int code) { return std::generic_category().message(code); }

/// 0 or what went wrong.
int write_all(int descriptor, std::span<const std::span<const std::byte>> pieces) {
  for (std::span<const std::byte> rest : pieces)
    while (!rest.empty()) {
      const ssize_t done = ::write(descriptor, rest.data(), rest.size());
      if (done < 0 && errno == EINTR) continue;
      if (done <= 0) return done < 0 ? errno : EIO;
      rest = rest.subspan(size_t(done));
    }
  return 0;
}

}  // namespace

void write_whole_file(const std::string& path, const void* data, size_t size) {
  const std::span<const std::byte> piece(static_cast<const std::byte*>(data), size);
  write_whole_file(path, std::span(&piece, 1));
}

void write_whole_file(const std::string& path, std::span<const std::span<const std::byte>> pieces) {
  namespace fs = std::filesystem;
  if (path.empty()) refuse(path, "the file has no name");
  std::error_code code;
  fs::path target = path;
  if (fs::exists(target, code)) target = fs::canonical(target, code);  // a link stays and its file is replaced
  if (code) refuse(path, code.message());
  struct stat old{};
  const bool existed = ::stat(target.c_str(), &old) == 0;
  if (existed && S_ISDIR(old.st_mode)) refuse(path, "it is a folder");
  if (existed && ::access(target.c_str(), W_OK) != 0) refuse(path, reason(errno));

  if (existed && !S_ISREG(old.st_mode)) {
    const int descriptor = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) refuse(path, reason(errno));
    const int failure = write_all(descriptor, pieces);
    ::close(descriptor);
    if (failure) refuse(path, reason(failure));
    return;
  }

  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::exists(folder, code)) refuse(path, fmt::format("there is no folder '{}'", folder.string()));
  const std::string beside = (folder / fmt::format(".{}.part-{}", target.filename().string(), ::getpid())).string();
  const int descriptor = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) refuse(path, reason(errno));
  int failure = write_all(descriptor, pieces);
  if (!failure && existed && ::fchmod(descriptor, old.st_mode & 07777) != 0) failure = errno;
  if (!failure && ::fsync(descriptor) != 0) failure = errno;
  if (::close(descriptor) != 0 && !failure) failure = errno;
  if (!failure && ::rename(beside.c_str(), target.c_str()) != 0) failure = errno;
  if (failure) {
    ::unlink(beside.c_str());
    refuse(path, reason(failure));
  }
  // The new name itself reaches the disk with its folder; not all file systems can say so, hence no error.
  const int folder_descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_descriptor >= 0) {
    ::fsync(folder_descriptor);
    ::close(folder_descriptor);
  }
}

}  // namespace etendue
