#pragma once
// Files that are read. All of them are opened here: a named pipe, a device or a socket would be waited for without end or fill
// the memory, and a file that another program shortens would end this one if it were mapped into memory. What is opened is
// noted as an input (input_files.h), which no output may replace.

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace etendue {

/// A regular file, open for reading. Errors are the reason alone; who knows what the file is for adds its name.
class RegularFile {
 public:
  /// Throws Error with the system's reason, or with what the path is when it is no regular file. Never waits.
  explicit RegularFile(const std::string& path);

  /// A name by which a library can open the same bytes, as long as this is there.
  std::string path_to_open() const;
  /// In bytes, when it was opened.
  std::uint64_t size() const { return size_; }
  void seek(std::uint64_t offset);
  /// Throws Error when that many bytes are not there.
  void read(void* to, std::uint64_t bytes);
  /// As many bytes as are there, at most these; 0 at the end.
  std::uint64_t read_some(void* to, std::uint64_t bytes);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t size_ = 0;
  std::string path_;
};

/// For what other libraries open by its name: throws what RegularFile would.
void require_regular_file(const std::string& path);

/// All bytes of a regular file, as they were when it was opened. Throws Error with the reason alone; what is larger than `most`
/// bytes, or than the memory, is refused before anything is read.
class FileContents {
 public:
  explicit FileContents(const std::string& path, std::uint64_t most = UINT64_MAX);
  std::string_view text() const { return {bytes_.get(), size_t(size_)}; }

 private:
  std::unique_ptr<char[]> bytes_;
  std::uint64_t size_ = 0;
};
/// The same as a string.
std::string read_regular_file(const std::string& path, std::uint64_t most = UINT64_MAX);

/// Throws Error("<what> takes 12.5 GB, more than …") when that much memory cannot be had whatever else is freed.
void require_memory(double bytes, const std::string& what);

/// What is said when memory ran out while a file was read.
inline constexpr const char* no_memory_to_read = "there is not enough memory to read it";

}  // namespace etendue
