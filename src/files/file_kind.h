#pragma once
// What a file holds, by its first bytes: files get wrong names, and some are not there but only something that stands for them.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

struct FileKind {
  std::string_view what;                  ///< "a PNG image"
  std::vector<std::string_view> endings;  ///< that such files have, without dots, in small letters; the usual one first
  std::string_view advice = {};           ///< for what is no format that anything should be read from
};

/// Of a file of this size that begins so; null: it is nothing that is known. A text may begin like several things, and is
/// taken for one of them when nothing else begins like that.
const FileKind* kind_of(std::string_view beginning, std::uint64_t size);

/// What is wrong with a file whose contents are not of the kind that its name says, in words that go on "'name': "; empty: it
/// is what it says, or nobody knows. For those who failed to read it.
std::string mistaken_contents(const std::string& path);
/// The same of a text that was read, from a file with this ending.
std::string mistaken_contents(std::string_view contents, const std::string& ending);

}  // namespace etendue
