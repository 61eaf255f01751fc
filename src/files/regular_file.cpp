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
#include <utility>

#include "contained_file.h"
#include "etendue/core/error.h"
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

/// A file in memory that holds what lies in a container.
int unpacked(const ContainedFile& contained) {
  const std::string bytes = contained.unpack(contained.container, contained.name);
  const int descriptor = ::memfd_create("contained", MFD_CLOEXEC);
  if (descriptor < 0) refuse(errno);
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t written = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int reason = errno;
      ::close(descriptor);
      refuse(reason);
    }
    done += size_t(written);
  }
  ::lseek(descriptor, 0, SEEK_SET);
  return descriptor;
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
  // Looked at before it is opened, for opening a device may do something; and after, for it may have been exchanged.
  require_regular_file(path);
  const auto contained = contained_file(path);
  const int descriptor = contained ? unpacked(*contained) : ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) refuse(errno);
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
  if (contained) path_ = fmt::format("/proc/self/fd/{}", descriptor);
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
