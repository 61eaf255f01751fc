#include "whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <thread>
#include <vector>

#include "etendue/core/error.h"

namespace etendue {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw Error(fmt::format("cannot write '{}': {}", path, reason));
}

std::string reason(int code) { return std::generic_category().message(code); }

/// Returns 0 or the error number.
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

/// Where the bytes are written.
struct Place {
  std::filesystem::path target;  ///< symbolic links are followed: the link stays, its target is replaced
  std::filesystem::path folder;
  bool existed = false;
  struct stat old{};

  bool plain() const { return !existed || S_ISREG(old.st_mode); }
  /// The temporary file, until it is complete.
  std::string beside() const { return (folder / fmt::format(".{}.part-{}", target.filename().string(), ::getpid())).string(); }
};

constexpr int most_links = 40;

/// Throws Error if nothing can be written to the path.
Place place_of(const std::string& path) {
  namespace fs = std::filesystem;
  if (path.empty()) refuse(path, "the file has no name");
  Place place;
  std::error_code code;
  place.target = path;
  // A chain of links to a file that does not exist yet is followed step by step.
  for (int links = 0; !fs::exists(place.target, code) && fs::is_symlink(fs::symlink_status(place.target, code)); ++links) {
    if (links == most_links) refuse(path, reason(ELOOP));
    place.target = place.target.parent_path() / fs::read_symlink(place.target, code);
    if (code) refuse(path, code.message());
  }
  code.clear();
  if (fs::exists(place.target, code)) {
    const fs::path canonical = fs::canonical(place.target, code);
    if (!code) place.target = canonical;  // a pipe as /dev/stdout exists, but has no canonical path
    code.clear();
  }
  if (code) refuse(path, code.message());
  place.existed = ::stat(place.target.c_str(), &place.old) == 0;
  if (!place.target.has_filename() || (place.existed && S_ISDIR(place.old.st_mode))) refuse(path, "it is a folder");
  if (place.existed && ::access(place.target.c_str(), W_OK) != 0) refuse(path, reason(errno));
  place.folder = place.target.has_parent_path() ? place.target.parent_path() : fs::path(".");
  if (place.plain() && !fs::exists(place.folder, code))
    refuse(path, fmt::format("there is no folder '{}'", place.folder.string()));
  return place;
}

/// Opens a target that is no regular file. Opening a pipe without a reader would block forever: the reader gets a few seconds.
/// -1: see errno.
int open_special(const std::filesystem::path& target) {
  constexpr int tries = 50;
  constexpr std::chrono::milliseconds between(100);
  int descriptor = -1;
  for (int i = 0; i < tries && descriptor < 0; ++i) {
    if (i > 0) std::this_thread::sleep_for(between);
    descriptor = ::open(target.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0 && errno != ENXIO) return -1;
  }
  if (descriptor >= 0) ::fcntl(descriptor, F_SETFL, O_WRONLY);  // blocking writes, since the reader may be slow
  return descriptor;
}

int open_beside(const Place& place, const std::string& path) {
  const int descriptor = ::open(place.beside().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) refuse(path, reason(errno));
  return descriptor;
}

}  // namespace

void require_writable(const std::string& path) {
  const Place place = place_of(path);
  int failure = 0;
  if (place.plain()) {
    const int descriptor = open_beside(place, path);
    ::unlink(place.beside().c_str());
    // Writes one block: file systems may store a few bytes together with the file's name even when the disk is full.
    const std::vector<std::byte> block(4096);
    const std::span<const std::byte> piece(block);
    failure = write_all(descriptor, std::span(&piece, 1));
    if (::close(descriptor) != 0 && !failure) failure = errno;
  } else if (S_ISCHR(place.old.st_mode) || S_ISBLK(place.old.st_mode)) {  // opening the other types may block or have effects
    const int descriptor = ::open(place.target.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (descriptor < 0) refuse(path, reason(errno));
    if (::write(descriptor, "", 0) < 0 && errno != EAGAIN) failure = errno;  // no bytes, but a full device reports an error
    ::close(descriptor);
  }
  if (failure) refuse(path, reason(failure));
}

void write_whole_file(const std::string& path, const void* data, size_t size) {
  const std::span<const std::byte> piece(static_cast<const std::byte*>(data), size);
  write_whole_file(path, std::span(&piece, 1));
}

void write_whole_file(const std::string& path, const std::string& text) { write_whole_file(path, text.data(), text.size()); }

void write_whole_file(const std::string& path, std::span<const std::span<const std::byte>> pieces) {
  const Place place = place_of(path);
  if (!place.plain()) {
    const int descriptor = open_special(place.target);
    if (descriptor < 0) refuse(path, errno == ENXIO ? "it is a pipe that nobody reads" : reason(errno));
    const int failure = write_all(descriptor, pieces);
    ::close(descriptor);
    if (failure) refuse(path, reason(failure));
    return;
  }

  const std::string beside = place.beside();
  const int descriptor = open_beside(place, path);
  int failure = write_all(descriptor, pieces);
  if (!failure && place.existed && ::fchmod(descriptor, place.old.st_mode & 07777) != 0) failure = errno;
  if (!failure && ::fsync(descriptor) != 0) failure = errno;
  if (::close(descriptor) != 0 && !failure) failure = errno;
  if (!failure && ::rename(beside.c_str(), place.target.c_str()) != 0) failure = errno;
  if (failure) {
    ::unlink(beside.c_str());
    refuse(path, reason(failure));
  }
  // The new directory entry reaches the disk with its folder; some file systems cannot sync folders, hence no error.
  const int folder_descriptor = ::open(place.folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_descriptor >= 0) {
    ::fsync(folder_descriptor);
    ::close(folder_descriptor);
  }
}

}  // namespace etendue
