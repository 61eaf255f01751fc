#include "regular_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <utility>

#include "contained_file.h"
#include "etendue/core/error.h"
#include "gzip.h"
#include "input_files.h"

namespace etendue {
namespace {

[[noreturn]] void refuse(int reason) { throw Error(std::strerror(reason)); }

void require_regular(const struct stat& status) {
  const mode_t mode = status.st_mode;
  if (S_ISREG(mode)) return;
  if (S_ISDIR(mode)) throw Error("it is a folder");
  if (S_ISFIFO(mode)) throw Error("it is a pipe; only files are read, some of them more than once");
  if (S_ISSOCK(mode)) throw Error("it is a socket, not a file of data");
  throw Error("it is a device, not a file of data");
}

std::string size_text(double bytes) {
  if (bytes < 1e9) return fmt::format("{:.4g} MB", bytes * 1e-6);
  return fmt::format("{:.4g} GB", bytes * 1e-9);
}

void require_room(std::uint64_t size, std::uint64_t most) {
  if (size > most)
    throw Error(fmt::format("it is {} long, at most {} are read", size_text(double(size)), size_text(double(most))));
  require_memory(double(size), "it");
}

void read_all(RegularFile& file, char* to) {
  if (file.read_some(to, file.size()) < file.size()) throw Error("it became shorter while it was read");
}

/// An anonymous file in memory with the contents that `fill` writes.
int file_in_memory(const std::function<void(int)>& fill) {
  const int descriptor = ::memfd_create("contained", MFD_CLOEXEC);
  if (descriptor < 0) refuse(errno);
  try {
    fill(descriptor);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  ::lseek(descriptor, 0, SEEK_SET);
  return descriptor;
}

int unpacked(const ContainedFile& contained) {
  const std::string bytes = contained.unpack(contained.container, contained.name);
  return file_in_memory([&](int file) { write_to(file, bytes.data(), bytes.size()); });
}

int opened(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) refuse(errno);
  return descriptor;
}

int unpacked_gzip(const std::string& path) {
  const int packed = opened(path);
  try {
    struct stat status{};
    if (::fstat(packed, &status) != 0) refuse(errno);
    require_regular(status);
    const int descriptor = file_in_memory([&](int file) { unpack_gzip(packed, file); });
    ::close(packed);
    return descriptor;
  } catch (...) {
    ::close(packed);
    throw;
  }
}

}  // namespace

void require_memory(double bytes, const std::string& what) {
  double most = double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE));
  for (const auto resource : {RLIMIT_AS, RLIMIT_DATA}) {
    rlimit limit{};
    if (::getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) most = std::min(most, double(limit.rlim_cur));
  }
  if (bytes > most)
    throw Error(fmt::format("{} takes {}, more than the {} of memory there are", what, size_text(bytes), size_text(most)));
}

void require_regular_file(const std::string& named) {
  const std::string path = file_on_disk(named);
  struct stat status{};
  if (::stat(path.c_str(), &status) != 0) refuse(errno);
  require_regular(status);
  if (::access(path.c_str(), R_OK) != 0) refuse(errno);
  note_input(path);
}

RegularFile::RegularFile(const std::string& path) : path_(path) {
  // Checked before it is opened, because opening a device may have effects; and after, because the file may have been replaced.
  require_regular_file(path);
  const auto contained = contained_file(path);
  const bool in_memory = contained || named_gzip(path);
  const int descriptor = contained ? unpacked(*contained) : in_memory ? unpacked_gzip(path) : opened(path);
  file_.reset(::fdopen(descriptor, "rb"));
  if (!file_) {
    const int reason = errno;
    ::close(descriptor);
    refuse(reason);
  }
  struct stat status{};
  if (::fstat(descriptor, &status) != 0) refuse(errno);
  require_regular(status);
  size_ = std::uint64_t(status.st_size);
  if (in_memory) path_ = fmt::format("/proc/self/fd/{}", descriptor);
}

std::string RegularFile::path_to_open() const { return path_; }

void RegularFile::seek(std::uint64_t offset) {
  if (::fseeko(file_.get(), off_t(offset), SEEK_SET) != 0) refuse(errno);
}

std::uint64_t RegularFile::read_some(void* to, std::uint64_t bytes) {
  const size_t got = std::fread(to, 1, size_t(bytes), file_.get());
  if (got < bytes && std::ferror(file_.get())) refuse(errno);
  return got;
}

void RegularFile::read(void* to, std::uint64_t bytes) {
  if (read_some(to, bytes) < bytes) throw Error("it ends too early");
}

FileContents::FileContents(const std::string& path, std::uint64_t most) {
  RegularFile file(path);
  require_room(file.size(), most);
  bytes_.reset(new char[size_t(file.size())]);  // not filled with zeros first
  read_all(file, bytes_.get());
  size_ = file.size();
}

std::string read_regular_file(const std::string& path, std::uint64_t most) {
  RegularFile file(path);
  require_room(file.size(), most);
  std::string text(size_t(file.size()), '\0');
  read_all(file, text.data());
  return text;
}

}  // namespace etendue
