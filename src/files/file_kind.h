#pragma once
// The kind of a file by its first bytes: files may have a wrong extension, or be placeholders of the real file.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

struct FileKind {
  std::string_view what;                  ///< "a PNG image"
  std::vector<std::string_view> endings;  ///< extensions of such files, without dots, in lower case; the usual one first
  std::string_view advice = {};           ///< for a kind that no reader should be used for
};

/// The kind of a file of this size with this beginning; null: unknown. For texts this is a guess, since several formats may
/// begin alike.
const FileKind* kind_of(std::string_view beginning, std::uint64_t size);

/// A message, to follow "'name': ", for a file whose contents are not of the kind that its extension says. Empty: they match,
/// or the kind is unknown. To be called after reading the file has failed.
std::string mistaken_contents(const std::string& path);
/// The same for a text already read from a file with this extension.
std::string mistaken_contents(std::string_view contents, const std::string& ending);

}  // namespace etendue
