// Rewrites ZIP archives (PKWARE, APPNOTE 4.3): entries, each with a local header, followed by a central directory with their
// offsets.

#include <cstdint>
#include <cstring>

#include "prepared.h"

namespace etendue::assimp_helper {
namespace {

constexpr size_t end_record = 22, longest_comment = 65535, list_record = 46, local_record = 30;

template <class T>
T number_at(std::string_view bytes, size_t at) {
  T value = 0;
  if (at <= bytes.size() && bytes.size() - at >= sizeof value) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}
void set_number(std::string& bytes, size_t at, std::uint32_t value, size_t size) {
  std::memcpy(bytes.data() + at, &value, size);
}

bool is_wanted(std::string_view name) { return name.ends_with(".model") || name.ends_with(".rels") || name.ends_with(".xml"); }

}  // namespace

std::optional<std::string> package_without_images(std::string_view zip) {
  const std::string_view tail = zip.substr(zip.size() - std::min(zip.size(), end_record + longest_comment));
  const size_t end = tail.rfind("PK\5\6");
  if (end == std::string_view::npos) return std::nullopt;
  std::string made, list;
  std::uint32_t count = 0;
  for (size_t at = number_at<std::uint32_t>(tail, end + 16); at + list_record <= zip.size() && zip.substr(at, 4) == "PK\1\2";) {
    const size_t name_size = number_at<std::uint16_t>(zip, at + 28);
    const size_t size =
        list_record + name_size + number_at<std::uint16_t>(zip, at + 30) + number_at<std::uint16_t>(zip, at + 32);
    const std::string_view name = zip.substr(std::min(at + list_record, zip.size()), name_size);
    const size_t head = number_at<std::uint32_t>(zip, at + 42), packed = number_at<std::uint32_t>(zip, at + 20);
    if (is_wanted(name)) {
      const size_t begin =
          head + local_record + number_at<std::uint16_t>(zip, head + 26) + number_at<std::uint16_t>(zip, head + 28);
      if (head > zip.size() || begin > zip.size() || packed > zip.size() - begin || at + size > zip.size()) return std::nullopt;
      std::string local(zip.substr(head, local_record)), entry(zip.substr(at, list_record));
      // The central directory states the sizes; if the writer left them to follow the data (flag bit 3), they are copied to the
      // local header.
      constexpr std::uint32_t follows = 8;
      const std::uint32_t flags = number_at<std::uint16_t>(zip, at + 8) & ~follows;
      set_number(local, 6, flags, 2);
      set_number(entry, 8, flags, 2);
      std::memcpy(local.data() + 14, entry.data() + 16, 12);
      set_number(local, 26, std::uint32_t(name_size), 2);
      set_number(local, 28, 0, 2);
      set_number(entry, 30, 0, 2);
      set_number(entry, 32, 0, 2);
      set_number(entry, 42, std::uint32_t(made.size()), 4);
      made.append(local).append(name).append(zip.substr(begin, packed));
      list.append(entry).append(name);
      ++count;
    }
    at += size;
  }
  if (count == 0) return std::nullopt;
  std::string last(end_record, '\0');
  std::memcpy(last.data(), "PK\5\6", 4);
  set_number(last, 8, count, 2);
  set_number(last, 10, count, 2);
  set_number(last, 12, std::uint32_t(list.size()), 4);
  set_number(last, 16, std::uint32_t(made.size()), 4);
  return made + list + last;
}

}  // namespace etendue::assimp_helper
