#include "head_of_3mf.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "etendue/core/error.h"
#include "files/regular_file.h"

namespace etendue {
namespace {

constexpr size_t looked_at = 1 << 16;  // [bytes] of the model that are decompressed and searched

template <class T>
T number_at(const std::string& bytes, size_t at) {
  T value = 0;
  if (at <= bytes.size() && bytes.size() - at >= sizeof value) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::string part_of(RegularFile& file, std::uint64_t offset, std::uint64_t count) {
  if (offset >= file.size()) return {};
  std::string bytes(size_t(std::min(count, file.size() - offset)), '\0');
  file.seek(offset);
  file.read(bytes.data(), bytes.size());
  return bytes;
}

/// Decompresses the beginning of a ZIP entry's deflate stream (at most 4 * looked_at bytes).
std::string inflated(std::string bytes) {
  z_stream stream{};
  if (::inflateInit2(&stream, -MAX_WBITS) != Z_OK) return {};
  std::string text(4 * looked_at, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_in = uInt(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = uInt(text.size());
  (void)::inflate(&stream, Z_SYNC_FLUSH);
  text.resize(text.size() - stream.avail_out);
  ::inflateEnd(&stream);
  return text;
}

/// The beginning of the file's first model. A ZIP archive ends with a record that gives the offset of the central directory;
/// each entry of the directory gives the offset of a local header, which the entry's bytes follow (PKWARE, APPNOTE 4.3).
std::string begin_of_model(RegularFile& file) {
  constexpr size_t end_record = 22, longest_comment = 65535, entry_record = 46, local_record = 30;
  const std::uint64_t from = file.size() - std::min<std::uint64_t>(file.size(), end_record + longest_comment);
  const std::string tail = part_of(file, from, end_record + longest_comment);
  const size_t end = tail.rfind("PK\5\6");
  if (end == std::string::npos) return {};
  constexpr std::uint32_t most = 1 << 24;
  const std::string list =
      part_of(file, number_at<std::uint32_t>(tail, end + 16), std::min(number_at<std::uint32_t>(tail, end + 12), most));
  for (size_t at = 0; at + entry_record <= list.size() && list.compare(at, 4, "PK\1\2") == 0;) {
    const size_t name_size = number_at<std::uint16_t>(list, at + 28);
    const std::string name = list.substr(std::min(at + entry_record, list.size()), name_size);
    if (name.ends_with(".model")) {
      const std::uint64_t head = number_at<std::uint32_t>(list, at + 42);
      const std::string local = part_of(file, head, local_record);
      const std::uint64_t begin =
          head + local_record + number_at<std::uint16_t>(local, 26) + number_at<std::uint16_t>(local, 28);
      std::string bytes = part_of(file, begin, looked_at);
      return number_at<std::uint16_t>(list, at + 10) == 0 ? bytes : inflated(std::move(bytes));
    }
    at += entry_record + name_size + number_at<std::uint16_t>(list, at + 30) + number_at<std::uint16_t>(list, at + 32);
  }
  return {};
}

}  // namespace

// 3MF core specification 3.4: the unit is the attribute `unit` of the element `model`. Resources precede the build items, so
// that colour resources are mostly near the beginning; a file may choose any prefix for their XML namespaces.
HeadOf3mf head_of_3mf(const std::string& path) {
  HeadOf3mf head;
  std::string text;
  try {
    RegularFile file(path);
    text = begin_of_model(file);
  } catch (const Error&) {
    return head;
  }
  const size_t model = text.find("<model"), end = text.find('>', model);
  if (model == std::string::npos) return head;
  const std::string element = text.substr(model, end - model);
  for (const auto& [name, length] :
       {std::pair{"micron", 1e-6}, {"centimeter", 1e-2}, {"inch", 0.0254}, {"foot", 0.3048}, {"meter", 1.0}})
    for (const char* mark : {"\"", "'"})
      if (element.find(std::string(" unit=") + mark + name + mark) != std::string::npos) head.unit = length;
  for (const char* name : {":colorgroup", ":texture2dgroup", ":compositematerials", ":multiproperties"})
    head.face_colors = head.face_colors || text.find(name) != std::string::npos;
  const size_t component = text.find("<component ");
  head.parts_elsewhere = component != std::string::npos && text.find(":path=", component) != std::string::npos;
  return head;
}

}  // namespace etendue
