#include "document.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>

#include "compression.h"
#include "data_uri.h"
#include "files/contained_file.h"
#include "files/file_kind.h"
#include "files/gzip.h"
#include "files/regular_file.h"
#include "formats/permissions.h"
#include "primitive.h"

namespace etendue::gltf {
namespace {

std::map<std::string, Converter>& converters() {
  static auto* all = new std::map<std::string, Converter>;
  return *all;
}

struct Opened {
  std::filesystem::file_time_type written;
  std::uintmax_t size = 0;
  std::shared_ptr<const Document> document;
};
std::mutex mutex;

/// The file name ending for an image of this size [bytes], from its first bytes or its media type.
std::string image_ending(std::string_view start, std::uint64_t size, const std::string& type) {
  if (start.starts_with("BM")) return "bmp";
  if (const FileKind* kind = kind_of(start, size); kind && kind->what.find("image") != kind->what.npos)
    return std::string(kind->endings.front());
  if (type == "image/jpeg") return "jpg";
  if (type == "image/x-tga") return "tga";
  return "png";
}

std::uint32_t word(const char* at) {
  std::uint32_t value = 0;
  std::memcpy(&value, at, 4);
  return value;
}

}  // namespace

bool register_converter(const std::vector<std::string>& endings, Converter convert) {
  for (const std::string& ending : endings) converters()[ending] = convert;
  return register_parts(endings);
}

bool register_parts(const std::vector<std::string>& endings) {
  register_container(endings, [](const std::string& container, const std::string& name) {
    return Document::open(container)->image_bytes(name);
  });
  return register_mesh_format(endings, [](const std::string& path, const std::string& part) {
    const PartName name = PartName::parse(part);
    MeshData mesh = read_primitive(*Document::open(path, nullptr, name.converted_at), name);
    tell_remarks(mesh, path);
    return mesh;
  });
}

std::shared_ptr<const Document> Document::open(const std::string& path, const Importing* given, double time) {
  static auto& known = *new std::map<std::pair<std::string, double>, Opened>;
  const std::lock_guard lock(mutex);
  std::error_code none;
  const auto written = std::filesystem::last_write_time(path, none);
  const auto size = std::filesystem::file_size(path, none);
  const auto converter = converters().find(ending_of_contents(path));
  if (given) time = given->options().time;
  if (converter == converters().end()) time = 0;  // times of a glTF file's animation are part of its parts' names
  const std::pair key(path, time);
  if (const auto found = known.find(key);
      found != known.end() && found->second.written == written && found->second.size == size && size != 0)
    return found->second.document;
  ImportOptions options = import_permissions();
  options.time = time;
  const Importing own(path, options);
  const Importing& importing = given ? *given : own;
  auto document = std::make_shared<Document>();
  if (converter != converters().end()) {
    require_regular_file(path);
    document->own_bytes_ = converter->second(path, importing);
    document->converted_ = true;
    document->time_ = time;
    document->read_container(path, &document->own_bytes_);
  } else {
    document->read_container(path, nullptr);
  }
  document->find_buffers(importing);
  document->decompress_views();
  document->decompress_meshes();
  constexpr size_t most = 8;
  if (known.size() >= most) known.clear();
  known[key] = {written, size, document};
  return document;
}

void Document::parse(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  try {
    json_ = Json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    std::string reason = error.what();
    if (const size_t end = reason.find("] "); end != std::string::npos) reason.erase(0, end + 2);
    for (char& c : reason)
      if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
    throw Error("it is no right JSON: " + reason);
  }
  if (!json_.is_object()) throw Error("it is no glTF: its JSON is not an object");
  const std::string version = within("asset", [&] { return etendue::gltf::text(object_in(json_, "asset"), "version"); });
  if (!find(json_, "asset")) throw Error("it is no glTF: there is no 'asset'");
  if (!version.starts_with("2.")) throw Error("it is of glTF version '" + version + "'; 2.0 is read");
}

// A .glb has a header of 12 bytes ("glTF", version, length), then chunks, each a length, a type and bytes: JSON, then BIN.
void Document::read_container(const std::string& path, const std::string* bytes) {
  std::unique_ptr<RegularFile> file;
  if (!bytes) file = std::make_unique<RegularFile>(path);
  const std::uint64_t size = bytes ? bytes->size() : file->size();
  const auto read = [&](std::uint64_t offset, std::uint64_t count, void* to) {
    if (offset > size || count > size - offset) throw Error("it ends too early");
    if (bytes) {
      std::memcpy(to, bytes->data() + offset, count);
    } else {
      file->seek(offset);
      file->read(to, count);
    }
  };
  const auto text_at = [&](std::uint64_t offset, std::uint64_t count) {
    if (offset > size || count > size - offset) throw Error("it ends too early");
    std::string text(count, ' ');
    read(offset, count, text.data());
    return text;
  };
  char head[12] = {};
  read(0, std::min<std::uint64_t>(size, 12), head);
  if (std::memcmp(head, "glTF", 4) != 0) {
    if (size == 0) throw Error("the file is empty");
    return parse(text_at(0, size));
  }
  if (size < 12) throw Error("it ends within its head");
  if (word(head + 4) != 2) throw Error("it is a .glb of version " + std::to_string(word(head + 4)) + "; 2 is read");
  bool has_json = false;
  for (std::uint64_t at = 12; at + 8 <= size;) {
    char chunk[8];
    read(at, 8, chunk);
    const std::uint64_t length = word(chunk);
    if (length > size - at - 8) throw Error("a chunk of it is longer than the file");
    constexpr std::uint32_t json = 0x4E4F534A, binary = 0x004E4942;
    if (word(chunk + 4) == json && !has_json) {
      parse(text_at(at + 8, length));
      has_json = true;
    } else if (word(chunk + 4) == binary && !chunk_) {
      chunk_ = Buffer{bytes ? std::variant<Slice, std::string>(Slice{"", at + 8}) : Slice{path, at + 8}, length};
    }
    at += 8 + length;
  }
  if (!has_json) throw Error("it has no JSON");
}

Buffer Document::find_buffer(const Json& description, size_t index, const Importing& importing) const {
  Buffer missing;
  missing.missing = true;
  const std::string uri = text(description, "uri");
  if (uri.empty()) return index == 0 && chunk_ ? *chunk_ : missing;
  Buffer buffer;
  if (is_data_uri(uri)) {
    buffer.bytes = decode_data_uri(uri).bytes;
    buffer.size = std::get<std::string>(buffer.bytes).size();
    return buffer;
  }
  try {
    const std::string path = importing.file(decode_percents(uri), importing.at());
    buffer.bytes = Slice{path, 0};
    buffer.size = RegularFile(path).size();
  } catch (const Error&) {
    if (!is_fallback(description)) throw;
    return missing;  // the data is also stored in compressed form
  }
  return buffer;
}

void Document::find_buffers(const Importing& importing) {
  const Json& list = list_in(json_, "buffers");
  for (size_t i = 0; i < list.size(); ++i)
    within(fmt::format("buffers[{}]", i), [&] {
      const std::uint64_t length = needed_whole(list[i], "byteLength");
      Buffer buffer = find_buffer(list[i], i, importing);
      if (!buffer.missing && length > buffer.size)
        throw Error(fmt::format("it should have {} bytes, but there are {}", length, buffer.size));
      buffers_.push_back(std::move(buffer));
    });
}

const Json& Document::element(const char* list, size_t i) const {
  const Json& all = list_in(json_, list);
  if (i >= all.size()) throw Error(fmt::format("there is no {}[{}], there are {}", list, i, all.size()));
  if (!all[i].is_object()) throw Error(fmt::format("{}[{}] is not an object", list, i));
  return all[i];
}

std::uint64_t Document::buffer_bytes() const {
  constexpr std::uint64_t bytes_of_a_triangle = 12;
  std::uint64_t sum = 0;
  for (const Buffer& buffer : buffers_) sum += buffer.decompressed ? buffer.size / bytes_of_a_triangle : buffer.size;
  return sum;
}

std::uint64_t Document::view_size(size_t view) const {
  const Json& v = element("bufferViews", view);
  return within(fmt::format("bufferViews[{}]", view), [&] {
    const size_t buffer = needed_whole(v, "buffer"), length = needed_whole(v, "byteLength");
    require_bytes(buffer, whole(v, "byteOffset").value_or(0), length);
    return std::uint64_t(length);
  });
}

void Document::require_bytes(size_t buffer, std::uint64_t offset, std::uint64_t bytes) const {
  if (buffer >= buffers_.size()) throw Error(fmt::format("there is no buffers[{}]", buffer));
  if (buffers_[buffer].missing)
    throw Error(fmt::format("buffers[{}] has no 'uri', and there is no binary part for it", buffer));
  if (offset > buffers_[buffer].size || bytes > buffers_[buffer].size - offset)
    throw Error(
        fmt::format("it reaches to byte {} of buffers[{}], which has {}", offset + bytes, buffer, buffers_[buffer].size));
}

size_t Document::view_stride(size_t view) const {
  const size_t stride = whole(element("bufferViews", view), "byteStride").value_or(0);
  if (stride > 252) throw Error(fmt::format("bufferViews[{}]: a 'byteStride' of {}, at most 252 is allowed", view, stride));
  return stride;
}

void Document::read_view(size_t view, std::uint64_t offset, std::uint64_t bytes, void* to) const {
  const std::uint64_t size = view_size(view);
  if (offset > size || bytes > size - offset)
    throw Error(fmt::format("bufferViews[{}] has {} bytes, and {} are needed", view, size, offset + bytes));
  const Json& v = element("bufferViews", view);
  read_buffer(needed_whole(v, "buffer"), whole(v, "byteOffset").value_or(0) + offset, bytes, to);
}

void Document::read_buffer(size_t index, std::uint64_t begin, std::uint64_t bytes, void* to) const {
  const Buffer& buffer = buffers_[index];
  if (const auto* text = std::get_if<std::string>(&buffer.bytes)) {
    std::memcpy(to, text->data() + begin, bytes);
    return;
  }
  const Slice& slice = std::get<Slice>(buffer.bytes);
  if (slice.path.empty()) {
    std::memcpy(to, own_bytes_.data() + slice.offset + begin, bytes);
    return;
  }
  RegularFile file(slice.path);
  file.seek(slice.offset + begin);
  file.read(to, bytes);
}

std::string Document::bytes_of(size_t buffer, std::uint64_t offset, std::uint64_t bytes) const {
  require_bytes(buffer, offset, bytes);
  std::string read(bytes, '\0');
  read_buffer(buffer, offset, bytes, read.data());
  return read;
}

std::string Document::view_bytes(size_t view) const {
  std::string bytes(view_size(view), '\0');
  read_view(view, 0, bytes.size(), bytes.data());
  return bytes;
}

std::string Document::inner_image(size_t image) const {
  const Json& i = element("images", image);
  return within(fmt::format("images[{}]", image), [&]() -> std::string {
    const std::string uri = text(i, "uri"), type = text(i, "mimeType");
    if (const auto view = whole(i, "bufferView")) {
      char start[16] = {};
      read_view(*view, 0, std::min<std::uint64_t>(view_size(*view), sizeof start), start);
      return fmt::format("images[{}].{}", image, image_ending({start, sizeof start}, view_size(*view), type));
    }
    if (uri.empty()) throw Error("it has neither a 'uri' nor a 'bufferView'");
    if (!is_data_uri(uri)) return {};
    const UriData data = decode_data_uri(std::string_view(uri).substr(0, uri.find(',') + 25));
    return fmt::format("images[{}].{}", image, image_ending(data.bytes, data.bytes.size(), data.type));
  });
}

std::string Document::image_bytes(const std::string& inner) const {
  size_t image = 0;
  int read = 0;
  if (std::sscanf(inner.c_str(), "images[%zu]%n", &image, &read) != 1 || read == 0 || inner[size_t(read) - 1] != ']')
    throw Error("there is nothing of the name '" + inner + "' in it");
  const Json& i = element("images", image);
  if (const auto view = whole(i, "bufferView")) return view_bytes(*view);
  const std::string uri = text(i, "uri");
  if (!is_data_uri(uri)) throw Error("its images[" + std::to_string(image) + "] is a file of its own");
  return decode_data_uri(uri).bytes;
}

}  // namespace etendue::gltf
