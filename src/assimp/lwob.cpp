// Converts LightWave's old object format to its new one (NewTek, "LWOB: LightWave 3D object file format" and "LWO2: LightWave
// 3D 2001 object file format", of the LightWave SDK). Both consist of chunks of a name, a big-endian length and that many
// bytes; they differ in how faces refer to surfaces, and how a surface's numbers are written.

#include <bit>
#include <cstdint>
#include <cstring>

#include "prepared.h"

namespace etendue::assimp_helper {
namespace {

std::uint32_t number(std::string_view bytes, size_t count) {
  std::uint32_t n = 0;
  for (size_t i = 0; i < count; ++i) n = n << 8 | static_cast<unsigned char>(bytes[i]);
  return n;
}
void put(std::string& to, std::uint32_t value, int bytes) {
  for (int i = bytes; i-- > 0;) to += char(value >> 8 * i & 0xff);
}
void put(std::string& to, float value) { put(to, std::bit_cast<std::uint32_t>(value), 4); }
/// An index in LWO2's variable-length encoding, of two or four bytes.
void put_index(std::string& to, std::uint32_t index) {
  if (index < 0xff00)
    put(to, index, 2);
  else
    put(to, 0xff000000u | index, 4);
}
/// A zero-terminated name, padded to an even length.
void put_name(std::string& to, std::string_view name) {
  to += name;
  to.append(name.size() % 2 ? 1 : 2, '\0');
}
void put_chunk(std::string& to, std::string_view kind, const std::string& content, int bytes_of_length = 4) {
  to += kind;
  put(to, std::uint32_t(content.size()), bytes_of_length);
  to += content;
  if (content.size() % 2) to += '\0';
}

/// The unread rest of the file; `sound` becomes false when something claims to be longer than the file.
struct Rest {
  std::string_view bytes;
  bool sound = true;
  std::string_view take(size_t count) {
    if (count > bytes.size()) sound = false;
    const std::string_view taken = bytes.substr(0, count);
    bytes.remove_prefix(taken.size());
    return taken;
  }
  std::uint32_t take_number(size_t count) {
    const std::string_view taken = take(count);
    return taken.size() == count ? number(taken, count) : 0;
  }
  std::string_view take_name() {
    const size_t end = bytes.find('\0');
    if (end == std::string_view::npos) {
      sound = false;
      return take(bytes.size());
    }
    const std::string_view name = take(end + 1);
    if (name.size() % 2) take(1);
    return name.substr(0, end);
  }
  /// The next chunk's name and content.
  std::pair<std::string_view, std::string_view> take_chunk(size_t bytes_of_length) {
    const std::string_view kind = take(4);
    const std::uint32_t length = take_number(bytes_of_length);
    const std::string_view content = take(length);
    if (length % 2 && !bytes.empty()) take(1);
    return {kind, content};
  }
};

/// Converts faces and the surface of each. A negative surface number means that a count and detail polygons, which lie on the
/// face, follow.
void convert_faces(Rest rest, std::string& faces, std::string& surfaces, bool& sound) {
  std::uint32_t count = 0;
  faces = "FACE";
  surfaces = "SURF";
  while (rest.bytes.size() >= 2 && rest.sound) {
    const std::uint32_t corners = rest.take_number(2);
    if (corners > 1023) sound = false;
    put(faces, corners, 2);
    for (std::uint32_t i = 0; i < corners && rest.sound; ++i) put_index(faces, rest.take_number(2));
    int surface = static_cast<std::int16_t>(rest.take_number(2));
    if (surface < 0) {
      surface = -surface;
      rest.take_number(2);
    }
    put_index(surfaces, count++);
    put(surfaces, std::uint32_t(surface > 0 ? surface - 1 : 0), 2);
  }
  sound = sound && rest.sound;
}

/// A strength, in LWOB an integer of which 256 is full or a float of which 1 is, in LWO2 a float.
struct Strength {
  const char *whole, *fraction, *now;
};
constexpr Strength strengths[] = {{"DIFF", "VDIF", "DIFF"},
                                  {"LUMI", "VLUM", "LUMI"},
                                  {"SPEC", "VSPC", "SPEC"},
                                  {"REFL", "VRFL", "REFL"},
                                  {"TRAN", "VTRN", "TRAN"}};

void convert_surface_part(std::string_view kind, std::string_view content, std::string& to, bool& textures) {
  Rest rest{content};
  std::string made;
  for (const Strength& s : strengths) {
    if (kind == s.whole) put(made, float(static_cast<std::int16_t>(rest.take_number(2))) / 256);
    if (kind == s.fraction) put(made, std::bit_cast<float>(rest.take_number(4)));
    if (made.empty()) continue;
    put(made, 0, 2);
    return put_chunk(to, s.now, made, 2);
  }
  if (kind == "COLR") {
    for (int i = 0; i < 3; ++i) put(made, float(rest.take_number(1)) / 255);
    put(made, 0, 2);
    put_chunk(to, kind, made, 2);
  } else if (kind == "GLOS") {  // an exponent of 16, 64, 256 or 1024; in LWO2 it is 2^(10 g + 2)
    const std::uint32_t exponent = rest.take_number(2);
    put(made, exponent >= 1024 ? 0.8f : (exponent >= 256 ? 0.6f : (exponent >= 64 ? 0.4f : 0.2f)));
    put(made, 0, 2);
    put_chunk(to, kind, made, 2);
  } else if (kind == "SMAN") {
    put_chunk(to, kind, std::string(content.substr(0, 4)), 2);
  } else if (kind == "FLAG") {
    constexpr std::uint32_t smooth = 4, double_sided = 256;
    const std::uint32_t flags = rest.take_number(2);
    if (flags & double_sided) put_chunk(to, "SIDE", std::string("\0\3", 2), 2);
    if (flags & smooth) {
      put(made, 1.56f);  // [rad], LightWave's default
      put_chunk(to, "SMAN", made, 2);
    }
  } else if (kind.size() == 4 && kind.substr(1) == "TEX") {
    textures = true;
  }
}

void convert_surface(Rest rest, std::string& to, bool& textures, bool& sound) {
  std::string made;
  put_name(made, rest.take_name());
  put_name(made, "");
  while (rest.bytes.size() >= 6 && rest.sound) {
    const auto [kind, content] = rest.take_chunk(2);
    convert_surface_part(kind, content, made, textures);
  }
  sound = sound && rest.sound;
  put_chunk(to, "SURF", made);
}

}  // namespace

std::optional<std::string> lwob_as_lwo2(std::string_view file, bool& textures) {
  if (file.size() < 12 || file.substr(0, 4) != "FORM" || file.substr(8, 4) != "LWOB") return std::nullopt;
  std::string points, faces, of_faces, names, surfaces;
  bool sound = true;
  for (Rest rest{file.substr(12)}; rest.bytes.size() >= 8;) {
    const auto [kind, content] = rest.take_chunk(4);
    sound = sound && rest.sound;
    if (kind == "PNTS") points = content;
    if (kind == "SRFS")
      for (Rest list{content}; !list.bytes.empty() && list.sound;) put_name(names, list.take_name());
    if (kind == "POLS") convert_faces({content}, faces, of_faces, sound);
    if (kind == "SURF") convert_surface({content}, surfaces, textures, sound);
  }
  if (!sound || points.empty() || faces.empty()) return std::nullopt;
  std::string made = "LWO2", layer;
  put_chunk(made, "TAGS", names);
  layer.append(4 + 3 * 4, '\0');
  put_name(layer, "");
  put_chunk(made, "LAYR", layer);
  put_chunk(made, "PNTS", points);
  put_chunk(made, "POLS", faces);
  put_chunk(made, "PTAG", of_faces);
  made += surfaces;
  std::string whole;
  put_chunk(whole, "FORM", made);
  return whole;
}

}  // namespace etendue::assimp_helper
