#include "input_files.h"

#include <sys/stat.h>

#include <filesystem>
#include <mutex>

#include "contained_file.h"

namespace etendue {
namespace {

struct Noted {
  std::mutex mutex;
  std::set<std::string> paths;
  std::set<InputsRead*> listeners;
};

Noted& noted() {
  static auto* all = new Noted;  // never destroyed: files are read until the program ends
  return *all;
}

/// Only regular files are compared: a terminal or a pipe may be both read and written.
bool plain(const std::string& path, struct stat& status) {
  return ::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
}

}  // namespace

void note_input(const std::string& named) {
  if (named.empty()) return;
  const std::string path = file_on_disk(named);
  std::error_code error;
  const std::filesystem::path full = std::filesystem::absolute(path, error);  // the working directory may change
  Noted& all = noted();
  const std::lock_guard lock(all.mutex);
  const std::string noted_path = error ? path : full.string();  // ".." stays, since after a link it leads elsewhere
  all.paths.insert(noted_path);
  for (InputsRead* const listener : all.listeners) listener->paths_.insert(noted_path);
}

InputsRead::InputsRead() {
  Noted& all = noted();
  const std::lock_guard lock(all.mutex);
  all.listeners.insert(this);
}

InputsRead::~InputsRead() {
  Noted& all = noted();
  const std::lock_guard lock(all.mutex);
  all.listeners.erase(this);
}

std::set<std::string> InputsRead::paths() const {
  Noted& all = noted();
  const std::lock_guard lock(all.mutex);
  return paths_;
}

std::string input_at(const std::string& path) {
  struct stat wanted{}, other{};
  if (!plain(path, wanted)) return {};
  Noted& all = noted();
  const std::lock_guard lock(all.mutex);
  // Compares the files' present inodes, not those at the time of note_input: an inode number is reused after a file is deleted.
  for (const std::string& input : all.paths)
    if (plain(input, other) && other.st_dev == wanted.st_dev && other.st_ino == wanted.st_ino) return input;
  return {};
}

}  // namespace etendue
