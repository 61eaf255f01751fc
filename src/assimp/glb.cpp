#include "glb.h"

#include <unistd.h>

#include <cerrno>
#include <string_view>

namespace etendue::assimp_helper {

Glb::Glb() { json = {{"asset", {{"version", "2.0"}}}, {"extensionsUsed", Json::array()}}; }

size_t Glb::add(const char* list, Json element) {
  Json& all = json[list];
  all.push_back(std::move(element));
  return all.size() - 1;
}

size_t Glb::add_view(const void* bytes, size_t size) {
  buffer_.resize((buffer_.size() + 3) / 4 * 4);
  const size_t offset = buffer_.size();
  buffer_.append(static_cast<const char*>(bytes), size);
  return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
}

namespace {

Json accessor(size_t view, int component, const char* type, size_t count) {
  return {{"bufferView", view}, {"componentType", component}, {"type", type}, {"count", count}};
}

}  // namespace

size_t Glb::add_floats(const std::vector<float>& values, const char* type, size_t width) {
  constexpr int float32 = 5126;
  const size_t view = add_view(values.data(), values.size() * sizeof(float));
  return add("accessors", accessor(view, float32, type, values.size() / width));
}

size_t Glb::add_indices(const std::vector<std::uint32_t>& values) {
  constexpr int uint32 = 5125;
  const size_t view = add_view(values.data(), values.size() * sizeof(std::uint32_t));
  return add("accessors", accessor(view, uint32, "SCALAR", values.size()));
}

size_t Glb::add_joints(const std::vector<std::uint16_t>& values) {
  constexpr int uint16 = 5123;
  const size_t view = add_view(values.data(), values.size() * sizeof(std::uint16_t));
  return add("accessors", accessor(view, uint16, "VEC4", values.size() / 4));
}

void Glb::note(const std::string& text) {
  Json& notes = json["asset"]["extras"]["notes"];
  for (const Json& known : notes)
    if (known == text) return;
  notes.push_back(text);
}

namespace {

bool write_all(int descriptor, const std::string& bytes) {
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t written = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    done += size_t(written);
  }
  return true;
}

void append_word(std::string& to, std::uint32_t value) { to.append(reinterpret_cast<const char*>(&value), 4); }

}  // namespace

std::uint64_t Glb::digest() const {
  const std::hash<std::string_view> hash;
  return hash(buffer_) * 0x9e3779b97f4a7c15ull + hash(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

bool Glb::write(int descriptor) {
  if (!buffer_.empty()) json["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  buffer_.resize((buffer_.size() + 3) / 4 * 4);
  if (text.size() + buffer_.size() + 28 > UINT32_MAX) return false;
  std::string head = "glTF";
  append_word(head, 2);
  append_word(head, std::uint32_t(28 + text.size() + buffer_.size()));
  append_word(head, std::uint32_t(text.size()));
  head += "JSON";
  std::string second;
  append_word(second, std::uint32_t(buffer_.size()));
  second += std::string("BIN\0", 4);
  return write_all(descriptor, head) && write_all(descriptor, text) && write_all(descriptor, second) &&
         write_all(descriptor, buffer_);
}

std::string clean(const std::string& text) {
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

}  // namespace etendue::assimp_helper
