#include "gzip.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <vector>

#include "etendue/core/error.h"
#include "regular_file.h"

namespace etendue {
namespace {

std::string small_letters(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return text;
}

struct Close {
  void operator()(gzFile_s* file) const { gzclose(file); }
};

}  // namespace

bool named_gzip(const std::string& path) { return path.size() > 3 && small_letters(path.substr(path.size() - 3)) == ".gz"; }

std::string ending_of_contents(const std::string& path) {
  const std::string name = named_gzip(path) ? path.substr(0, path.size() - 3) : path;
  const size_t dot = name.find_last_of("./");
  return dot == std::string::npos || name[dot] == '/' ? std::string() : small_letters(name.substr(dot + 1));
}

void write_to(int file, const char* bytes, size_t count) {
  for (size_t done = 0; done < count;) {
    const ssize_t written = ::write(file, bytes + done, count - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw Error(std::strerror(errno));
    done += size_t(written);
  }
}

void unpack_gzip(int from, int to) {
  // Typical meshes shrink to a fifth, text to a tenth. Only data such as zeros shrink to a thousandth, and no real scene is
  // made of zeros.
  constexpr std::uint64_t most_times = 64, always = 256 << 20;
  struct stat status{};
  if (::fstat(from, &status) != 0) throw Error(std::strerror(errno));
  const std::uint64_t most = std::max(always, most_times * std::uint64_t(status.st_size));
  const int own = ::dup(from);  // gzclose closes the duplicate
  const std::unique_ptr<gzFile_s, Close> file(own < 0 ? nullptr : gzdopen(own, "rb"));
  if (!file) {
    if (own >= 0) ::close(own);
    throw Error(no_memory_to_read);
  }
  std::vector<char> some(1 << 20);
  std::uint64_t all = 0;
  while (const int got = gzread(file.get(), some.data(), unsigned(some.size()))) {
    if (got < 0) break;
    all += std::uint64_t(got);
    if (all > most) throw Error(fmt::format("it holds more than {} MB, over {} times its own size", most >> 20, most_times));
    require_memory(double(all), "what it holds");
    write_to(to, some.data(), size_t(got));
  }
  int reason = Z_OK;
  gzerror(file.get(), &reason);
  if (reason == Z_BUF_ERROR) throw Error("it ends too early");
  if (reason != Z_OK && reason != Z_STREAM_END) throw Error("its compressed data are damaged");
}

}  // namespace etendue
