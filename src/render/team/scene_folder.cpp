#include "scene_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include "core/hash.h"
#include "etendue/core/error.h"
#include "files/sent_files.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

constexpr const char* prefix = "etendue-scene-";

std::string folder_of_temporary_files() {
  const char* const chosen = std::getenv("TMPDIR");
  return chosen && *chosen ? chosen : "/tmp";
}

[[noreturn]] void refuse(const std::string& what, int reason) {
  throw Error(fmt::format("{}: {} (TMPDIR chooses another folder for the scene's files)", what, std::strerror(reason)));
}

/// The lock of a folder; -1: another process holds it, or the folder is not ours.
int locked(const std::string& folder) {
  const int lock = ::open((folder + "/lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (lock >= 0 && ::flock(lock, LOCK_EX | LOCK_NB) == 0) return lock;
  if (lock >= 0) ::close(lock);
  return -1;
}

/// Removes the folders of processes that were killed. Others may do the same at the same time.
void remove_leftovers(const fs::path& parent) {
  std::error_code error;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(parent, fs::directory_options::skip_permission_denied, error)) {
    const std::string name = entry.path().filename().string();
    // A folder without a lock is being made, or removed.
    std::error_code ignored;
    if (!name.starts_with(prefix) || entry.is_symlink(ignored) || !fs::exists(entry.path() / "lock", ignored)) continue;
    const int lock = locked(entry.path().string());
    if (lock < 0) continue;
    fs::remove_all(entry.path(), ignored);
    ::close(lock);
  }
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) refuse(fmt::format("the folder '{}' cannot be made", folder.string()), error.value());
}

}  // namespace

SceneFolder::SceneFolder() {
  std::error_code error;
  const fs::path parent = fs::canonical(folder_of_temporary_files(), error);
  if (error) refuse(fmt::format("'{}'", folder_of_temporary_files()), error.value());
  remove_leftovers(parent);
  std::string name = (parent / (std::string(prefix) + "XXXXXX")).string();
  if (!::mkdtemp(name.data())) refuse(fmt::format("no folder can be made in '{}'", parent.string()), errno);
  path_ = name;
  lock_ = locked(path_);
  const int reason = errno;
  if (lock_ < 0) {
    remove();
    refuse(fmt::format("'{}' cannot be locked", name), reason);
  }
  witness_.emplace(Witness::Task{.remove = path_, .file = {}, .text = {}});
  make_folder(path_ + "/contents");
}

SceneFolder::~SceneFolder() {
  remove();
  if (lock_ >= 0) ::close(lock_);
}

void SceneFolder::remove() {
  set_sent_folder({});
  std::error_code ignored;
  fs::current_path("/", ignored);
  fs::remove_all(path_, ignored);
}

std::string SceneFolder::content_path(const SentFile& file) const {
  return fmt::format("{}/contents/{:016x}-{}", path_, file.hash, file.size);
}

bool SceneFolder::has(const SentFile& file) const {
  std::error_code ignored;
  return fs::exists(content_path(file), ignored);
}

void SceneFolder::require_room(std::uint64_t bytes) const {
  std::error_code error;
  const fs::space_info space = fs::space(path_, error);
  if (error || space.available >= bytes) return;
  throw Error(fmt::format("the scene's files take {}, and the disk of '{}' has {} left: set TMPDIR to another folder",
                          amount_text(bytes), path_, amount_text(space.available)));
}

bool SceneFolder::take_from(const std::string& other_folder, const SentFile& file) {
  const std::string from = fmt::format("{}/contents/{:016x}-{}", other_folder, file.hash, file.size), to = content_path(file);
  std::error_code error;
  fs::create_hard_link(from, to, error);
  if (!error) return true;
  const std::string part = to + ".part";
  const bool copied = fs::copy_file(from, part, fs::copy_options::overwrite_existing, error);
  if (copied && content_on_disk(part).hash == file.hash) fs::rename(part, to, error);
  return copied && !error && has(file);
}

// ---- a content that arrives -------------------------------------------------------------------------------------------------

SceneFolder::Arriving::Arriving(const SceneFolder& folder, const SentFile& file)
    : file_(file), whole_(folder.content_path(file)), part_(whole_ + ".part") {
  descriptor_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (descriptor_ < 0) refuse(fmt::format("'{}' cannot be written", part_), errno);
}

SceneFolder::Arriving::~Arriving() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void SceneFolder::Arriving::add(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) refuse(fmt::format("'{}' cannot be written", part_), errno);
    bytes = bytes.subspan(size_t(written));
  }
}

void SceneFolder::Arriving::finish() {
  const int closed = ::close(std::exchange(descriptor_, -1));
  if (closed != 0) refuse(fmt::format("'{}' cannot be written", part_), errno);
  const FileContent content = content_on_disk(part_);
  if (content.size != file_.size || content.hash != file_.hash)
    throw Error(fmt::format("'{}' has changed while it was sent", file_.path));
  if (::rename(part_.c_str(), whole_.c_str()) != 0) refuse(fmt::format("'{}' cannot be written", whole_), errno);
}

// ---- the files under their names --------------------------------------------------------------------------------------------

void SceneFolder::show(const std::vector<SentFile>& files, const std::string& working_folder) {
  const std::string root = path_ + "/files";
  std::error_code error;
  fs::current_path("/", error);
  fs::remove_all(root, error);
  make_folder(root + working_folder);
  for (const SentFile& file : files) {
    // Folders before a ".." must be there, too: "maps/../a.png".
    const fs::path named = root + file.path, normal = named.lexically_normal();
    if (!normal.string().starts_with(root + "/")) throw Error(fmt::format("'{}' is no path of a file", file.path));
    fs::path folder;
    for (const fs::path& part : named.parent_path()) {
      folder /= part;
      if (part != "..") make_folder(folder);
    }
    fs::create_hard_link(content_path(file), normal, error);
    if (error == std::errc::file_exists && content_on_disk(normal.string()).hash == file.hash) continue;
    if (error == std::errc::file_exists)
      throw Error(fmt::format("'{}' cannot be sent: a symbolic link makes '..' lead elsewhere", file.path));
    if (error) refuse(fmt::format("'{}' cannot be made", normal.string()), error.value());
  }
  fs::current_path(root + working_folder, error);
  if (error) refuse(fmt::format("'{}'", root + working_folder), error.value());
  set_sent_folder(root);
}

std::string amount_text(std::uint64_t bytes) {
  const auto n = double(bytes);
  return n < 1e6   ? fmt::format("{:.1f} kB", n * 1e-3)
         : n < 1e9 ? fmt::format("{:.1f} MB", n * 1e-6)
                   : fmt::format("{:.1f} GB", n * 1e-9);
}

FileContent content_on_disk(const std::string& path) {
  constexpr FileContent none{std::uint64_t(-1), 0};
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return none;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) return none;
  Hash hash;
  FileContent content;
  std::vector<std::byte> block(size_t(1) << 20);
  while (const size_t got = std::fread(block.data(), 1, block.size(), file.get())) {
    hash.add({block.data(), got});
    content.size += got;
  }
  content.hash = hash.value();
  return std::ferror(file.get()) ? none : content;
}

bool sees_all(const std::vector<SentFile>& files) {
  for (const SentFile& file : files) {
    const FileContent content = content_on_disk(file.path);
    if (content.size != file.size || content.hash != file.hash) return false;
  }
  return true;
}

}  // namespace etendue
