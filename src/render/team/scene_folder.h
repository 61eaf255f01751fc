#pragma once
// SceneFolder: the temporary folder of a process that does not see the files of a scene.
//
// `contents` holds each content once, under its hash and size, `files` names them by the paths that they have on the leader's
// machine. So a series of renders is sent only what is new, and relative paths between files stay valid.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "files/file_content.h"
#include "witness.h"

namespace etendue {

/// A file of the leader's.
struct SentFile {
  std::string path;  ///< absolute; may contain ".."
  std::uint64_t size = 0, hash = 0;
};

class SceneFolder {
 public:
  /// Makes the folder below $TMPDIR, or /tmp, for this user alone, and removes those there that killed processes have left
  /// behind. Throws Error.
  SceneFolder();
  /// Removes the folder, which is removed as well if this process is killed.
  ~SceneFolder();
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;

  const std::string& path() const { return path_; }
  bool has(const SentFile&) const;
  /// Throws Error if the disk has no room for so many bytes.
  void require_room(std::uint64_t bytes) const;
  /// Links or copies a content of another process's folder on this machine. False: it cannot be reached.
  bool take_from(const std::string& other_folder, const SentFile&);

  /// A content that arrives in pieces, in their order.
  class Arriving {
   public:
    Arriving(const SceneFolder&, const SentFile&);
    ~Arriving();
    Arriving(const Arriving&) = delete;
    Arriving& operator=(const Arriving&) = delete;
    void add(std::span<const std::byte>);
    /// Throws Error unless size and hash are those that were announced.
    void finish();

   private:
    const SentFile file_;
    const std::string whole_, part_;
    int descriptor_ = -1;
  };

  /// Makes `files` show exactly these, whose contents are all there, and changes the working folder to the counterpart of
  /// `working_folder`. From then on absolute paths lead there, too (files/sent_files.h). Throws Error.
  void show(const std::vector<SentFile>&, const std::string& working_folder);

 private:
  std::string content_path(const SentFile&) const;
  void remove();
  std::string path_;  ///< without symbolic links
  int lock_ = -1;     ///< held while the process lives
  std::optional<Witness> witness_;
};

/// "3.2 MB"
std::string amount_text(std::uint64_t bytes);

/// Size and hash of the bytes on the disk: unlike content_of, without unpacking what is compressed. For a file that cannot be
/// read, the size is 2^64 - 1.
FileContent content_on_disk(const std::string& path);

/// Whether all these files are at the same paths here.
bool sees_all(const std::vector<SentFile>&);

}  // namespace etendue
