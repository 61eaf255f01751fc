#pragma once
// RegularFile: all input files are opened here. Named pipes, devices and sockets are refused, since reading them could wait
// forever or fill the memory. Files are not mapped into memory, because a mapped file that another program shortens would crash
// this one. Each opened file is noted as an input (input_files.h), which no output may replace.

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace etendue {

/// A regular file, open for reading. Errors contain the reason alone; the caller adds the name.
class RegularFile {
 public:
  /// Throws Error with the system's reason, or with the type of a path that is no regular file. Never blocks.
  explicit RegularFile(const std::string& path);

  /// A name by which a library can open the same bytes, as long as this object exists.
  std::string path_to_open() const;
  /// Size when the file was opened [bytes].
  std::uint64_t size() const { return size_; }
  void seek(std::uint64_t offset);
  /// Throws Error if there are fewer bytes.
  void read(void* to, std::uint64_t bytes);
  /// Reads as many bytes as there are, at most `bytes`; returns their number, 0 at the end.
  std::uint64_t read_some(void* to, std::uint64_t bytes);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t size_ = 0;
  std::string path_;
};

/// Checks a file that another library will open by name: throws what RegularFile would throw.
void require_regular_file(const std::string& path);

/// All bytes of a regular file, of the size at its opening. Throws Error with the reason alone; a file larger than `most`
/// bytes, or than the memory, is refused before anything is read.
class FileContents {
 public:
  explicit FileContents(const std::string& path, std::uint64_t most = UINT64_MAX);
  std::string_view text() const { return {bytes_.get(), size_t(size_)}; }

 private:
  std::unique_ptr<char[]> bytes_;
  std::uint64_t size_ = 0;
};
/// The same, as a string.
std::string read_regular_file(const std::string& path, std::uint64_t most = UINT64_MAX);

/// Throws Error("<what> takes 12.5 GB, more than …") if the machine does not have that much memory, or the process may not use
/// it.
void require_memory(double bytes, const std::string& what);

/// The error message when memory ran out while a file was read.
inline constexpr const char* no_memory_to_read = "there is not enough memory to read it";

}  // namespace etendue
