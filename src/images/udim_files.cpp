#include "udim_files.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace etendue {

std::vector<UdimFile> udim_files(const std::string& pattern) {
  const std::filesystem::path whole(pattern);
  const std::string name = whole.filename().string();
  const size_t mark = name.find(udim_mark);
  std::vector<UdimFile> files;
  if (mark == std::string::npos) return files;
  const std::string before = name.substr(0, mark), after = name.substr(mark + std::string_view(udim_mark).size());
  const std::filesystem::path folder = whole.has_parent_path() ? whole.parent_path() : std::filesystem::path(".");
  std::error_code error;
  for (std::filesystem::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    const std::string found = i->path().filename().string();
    constexpr size_t digits = 4;
    if (found.size() != before.size() + digits + after.size() || !found.starts_with(before) || !found.ends_with(after))
      continue;
    const char* const begin = found.data() + before.size();
    int number = 0;
    const auto [stop, code] = std::from_chars(begin, begin + digits, number);
    if (code != std::errc() || stop != begin + digits || number < 1001) continue;
    files.push_back({(number - 1001) % 10, (number - 1001) / 10, i->path().string()});
  }
  std::sort(files.begin(), files.end(), [](const UdimFile& a, const UdimFile& b) { return a.path < b.path; });
  return files;
}

}  // namespace etendue
