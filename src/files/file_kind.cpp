#include "file_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "etendue/core/error.h"
#include "gzip.h"
#include "regular_file.h"
#include "text_encoding.h"

namespace etendue {

namespace {

constexpr size_t looked_at = 8192;  // bytes of a file that are inspected

struct Magic {
  std::string_view bytes;
  FileKind kind;
};

using namespace std::string_view_literals;

/// Formats that always begin with the same bytes. Among those with a common beginning, the longer ones come first.
const std::vector<Magic>& magics() {
  static const std::vector<Magic> all{
      {"version https://git-lfs.github.com/spec/"sv,
       {"a pointer of Git LFS, not the file itself", {}, "'git lfs pull' brings the file"}},
      {"\x89PNG\r\n\x1a\n"sv, {"a PNG image", {"png"}}},
      {"\xff\xd8\xff"sv, {"a JPEG image", {"jpg", "jpeg", "jpe", "jfif"}}},
      {"GIF87a"sv, {"a GIF image", {"gif"}}},
      {"GIF89a"sv, {"a GIF image", {"gif"}}},
      {"II*\0"sv, {"a TIFF image", {"tif", "tiff", "tx"}}},
      {"MM\0*"sv, {"a TIFF image", {"tif", "tiff", "tx"}}},
      {"\x76\x2f\x31\x01"sv, {"an OpenEXR image", {"exr"}}},
      {"#?RADIANCE"sv, {"a Radiance image", {"hdr", "rgbe", "pic"}}},
      {"#?RGBE"sv, {"a Radiance image", {"hdr", "rgbe", "pic"}}},
      {"DDS "sv, {"a DirectDraw image", {"dds"}}},
      {"\xabKTX"sv, {"a KTX image", {"ktx2", "ktx"}}},
      {"8BPS"sv, {"an image of Photoshop", {"psd", "psb"}}},
      {"PF\n"sv, {"a PFM image", {"pfm"}}},
      {"Pf\n"sv, {"a PFM image", {"pfm"}}},
      {"\x93NUMPY"sv, {"a NumPy array", {"npy"}}},
      {"\x1f\x8b"sv, {"something compressed by gzip", {"gz", "blend"}}},
      {"\x28\xb5\x2f\xfd"sv, {"something compressed by Zstandard", {"zst", "blend"}}},
      {"PK\x03\x04"sv, {"a ZIP archive", {"zip", "3mf", "usdz", "npz"}}},
      {"7z\xbc\xaf\x27\x1c"sv, {"a 7z archive", {"7z"}}},
      {"Rar!\x1a"sv, {"a RAR archive", {"rar"}}},
      {"%PDF-"sv, {"a PDF document", {"pdf"}}},
      {"\x7f"
       "ELF"sv,
       {"a program", {"so"}}},
      {"glTF"sv, {"binary glTF", {"glb", "gltf", "vrm"}}},
      {"Kaydara FBX Binary"sv, {"an FBX model", {"fbx"}}},
      {"; FBX "sv, {"an FBX model", {"fbx"}}},
      {"BLENDER"sv, {"a file of Blender", {"blend"}}},
      {"PXR-USDC"sv, {"a USD stage", {"usdc", "usd"}}},
      {"#usda "sv, {"a USD stage", {"usda", "usd"}}},
      {"xof 0"sv, {"a DirectX model", {"x"}}},
      {"ply\nformat "sv, {"a PLY mesh", {"ply"}}},
      {"ply\r\nformat "sv, {"a PLY mesh", {"ply"}}},
      {"#VRML V"sv, {"a VRML model", {"wrl", "vrml"}}},
      {"ISO-10303-21;"sv, {"a STEP model", {"step", "stp"}}},
      {"3D Geometry File Format"sv, {"a file of Rhino", {"3dm"}}},
      {"//Maya ASCII"sv, {"a scene of Maya", {"ma"}}},
      {"AutoCAD Binary DXF"sv, {"a DXF drawing", {"dxf"}}},
      {"*3DSMAX_ASCIIEXPORT"sv, {"an ASE model", {"ase"}}},
      {"AC3D"sv, {"an AC3D model", {"ac"}}},
      {"MS3D000000"sv, {"a MilkShape model", {"ms3d"}}},
      {"MD5Version"sv, {"an MD5 model", {"md5mesh"}}},
      {"LWSC"sv, {"a scene of LightWave", {"lws"}}},
      {"BB3D"sv, {"a Blitz3D model", {"b3d"}}},
      {"Ogawa"sv, {"an Alembic scene", {"abc"}}},
      {" BDV"sv, {"an OpenVDB grid", {"vdb"}}},
      {"NanoVDB"sv, {"a NanoVDB grid", {"nvdb"}}},
      {"VOL\x03"sv, {"a grid of Mitsuba", {"vol"}}},
      {"##RenderMan RIB"sv, {"a RIB scene", {"rib"}}},
      {"IESNA"sv, {"measured light of a lamp (IES)", {"ies"}}},
  };
  return all;
}

std::uint32_t number_at(std::string_view bytes, size_t place) {  // little endian
  std::uint32_t n = 0;
  for (size_t i = 4; i-- > 0;) n = n << 8 | static_cast<unsigned char>(bytes[place + i]);
  return n;
}

/// Formats that are recognized by a length field, or by a second word after the first.
const FileKind* by_numbers(std::string_view b, std::uint64_t size) {
  static const FileKind webp{"a WebP image", {"webp"}}, bmp{"a BMP image", {"bmp"}}, lwo{"a LightWave model", {"lwo"}},
      autodesk{"a 3DS model", {"3ds"}}, stl{"an STL mesh", {"stl"}};
  if (b.size() >= 12 && b.starts_with("RIFF") && b.substr(8, 4) == "WEBP") return &webp;
  if (b.size() >= 12 && b.starts_with("FORM") && b.substr(8, 3) == "LWO") return &lwo;
  if (b.size() >= 6 && b.starts_with("BM") && number_at(b, 2) == size) return &bmp;
  if (b.size() >= 6 && b.starts_with("MM") && number_at(b, 2) == size) return &autodesk;
  constexpr std::uint64_t head = 84, triangle = 50;
  if (b.size() >= head && number_at(b, 80) > 0 && head + triangle * number_at(b, 80) == size) return &stl;
  return nullptr;
}

bool same_letters(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::string_view without_blanks(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  return first == text.npos ? std::string_view() : text.substr(first);
}

/// The name of the outermost XML element.
std::string_view element_of(std::string_view text) {
  for (size_t at = text.find('<'); at != text.npos; at = text.find('<', at + 1)) {
    const std::string_view from = text.substr(at + 1);
    if (from.starts_with("!--"))
      at = std::min(text.find("-->", at), text.size() - 1);
    else if (!from.empty() && from[0] != '?' && from[0] != '!')
      return from.substr(0, from.find_first_of(" \t\r\n/>"));
  }
  return {};
}

const FileKind* by_markup(std::string_view text) {
  static const FileKind html{"a web page (HTML)", {"html", "htm"}, "perhaps a download failed"},
      collada{"a Collada model (XML)", {"dae"}}, x3d{"an X3D model (XML)", {"x3d"}},
      mitsuba{"a scene of Mitsuba (XML)", {"xml"}}, svg{"a drawing (SVG)", {"svg"}}, amf{"an AMF model (XML)", {"amf"}},
      materialx{"a MaterialX document (XML)", {"mtlx"}}, xml{"XML", {"xml", "dae", "x3d", "svg", "mtlx", "amf", "scene"}};
  for (const std::string_view begin : {"<!doctype html"sv, "<html"sv, "<head"sv})
    if (same_letters(text.substr(0, begin.size()), begin)) return &html;
  if (!text.starts_with("<")) return nullptr;
  const std::string_view element = element_of(text);
  if (same_letters(element, "html")) return &html;
  const std::pair<std::string_view, const FileKind*> known[] = {
      {"COLLADA", &collada}, {"X3D", &x3d}, {"scene", &mitsuba}, {"svg", &svg}, {"amf", &amf}, {"materialx", &materialx}};
  for (const auto& [name, kind] : known)
    if (element == name) return kind;
  return text.starts_with("<?xml") ? &xml : nullptr;
}

/// Calls `call` with the first word of each line and the rest of the line, until it returns false. Comment lines are skipped.
template <class Call>
void for_lines(std::string_view text, Call call) {
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = without_blanks(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line[0] == '#') continue;
    const size_t word = std::min(line.find_first_of(" \t\r{"), line.size());
    if (!call(line.substr(0, word), without_blanks(line.substr(word)))) return;
  }
}

bool is_digit(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '.'; }

/// Text formats without a magic number, by the first words of their lines.
const FileKind* by_lines(std::string_view text) {
  static const FileKind pbrt{"a scene of pbrt", {"pbrt"}}, obj{"an OBJ mesh", {"obj"}},
      mtl{"materials of an OBJ mesh", {"mtl"}}, own{"a render description", {"etd"}}, dxf{"a DXF drawing", {"dxf"}},
      stl{"an STL mesh", {"stl"}}, off{"an OFF mesh", {"off"}};
  const FileKind* found = nullptr;
  size_t line = 0, vertices = 0;
  std::string first;
  for_lines(text, [&](std::string_view word, std::string_view rest) {
    ++line;
    if (line == 1) first = word;
    if (line == 2 && first == "0" && word == "SECTION") found = &dxf;
    if (line == 2 && first == "solid" && word == "facet" && rest.starts_with("normal")) found = &stl;
    if (line == 2 && (first == "OFF" || first == "COFF" || first == "NOFF") && !word.empty() && is_digit(word[0])) found = &off;
    if (word == "WorldBegin" && rest.empty()) found = &pbrt;
    for (const char* directive : {"Camera", "Film", "Sampler", "Integrator", "Shape", "Material", "LightSource"})
      if (word == directive && rest.starts_with("\"")) found = &pbrt;
    if (word == "Job" && rest.starts_with("{")) found = &own;
    if (word == "newmtl" && line == 1) found = &mtl;
    if (word == "v" && !rest.empty() && is_digit(rest[0])) ++vertices;
    for (const char* keyword : {"mtllib", "usemtl"})
      if (word == keyword && !rest.empty() && (std::isalnum(static_cast<unsigned char>(rest[0])) || rest[0] == '.'))
        found = &obj;
    if (vertices == 3) found = &obj;
    return !found;
  });
  return found;
}

const FileKind* by_braces(std::string_view text) {
  static const FileKind gltf{"glTF (JSON)", {"gltf"}}, json{"JSON", {"json", "gltf"}};
  if (!text.starts_with("{") && !text.starts_with("[")) return nullptr;
  if (!without_blanks(text.substr(1)).starts_with("\"") && !without_blanks(text.substr(1)).starts_with("{")) return nullptr;
  const size_t asset = text.find("\"asset\"");
  if (asset != text.npos) {
    const std::string_view after = without_blanks(text.substr(asset + 7));
    const size_t end = std::min(after.find('}'), after.size());
    if (after.starts_with(":") && after.substr(0, end).find("\"version\"") != after.npos) return &gltf;
  }
  return &json;
}

std::string in_words(const FileKind& kind) {
  std::string text = fmt::format("it is {}", kind.what);
  if (!kind.endings.empty()) text += fmt::format(", whose files end in .{}", kind.endings.front());
  if (!kind.advice.empty()) text += fmt::format("; {}", kind.advice);
  return text;
}

}  // namespace

const FileKind* kind_of(std::string_view beginning, std::uint64_t size) {
  const std::string plain = has_byte_order_mark(beginning) ? as_utf8(beginning) : std::string();
  const std::string_view bytes = plain.empty() ? beginning : std::string_view(plain);
  for (const Magic& magic : magics())
    if (bytes.starts_with(magic.bytes)) return &magic.kind;
  if (const FileKind* kind = by_numbers(bytes, size)) return kind;
  if (bytes.find('\0') != bytes.npos) return nullptr;
  const std::string_view text = without_blanks(bytes);
  for (const auto by : {by_markup, by_braces, by_lines})
    if (const FileKind* kind = by(text)) return kind;
  return nullptr;
}

std::string mistaken_contents(std::string_view contents, const std::string& ending) {
  const FileKind* kind = kind_of(contents.substr(0, looked_at), contents.size());
  return kind && !std::ranges::count(kind->endings, ending) ? in_words(*kind) : std::string();
}

std::string mistaken_contents(const std::string& path) {
  try {
    RegularFile file(path);
    std::string beginning(looked_at, '\0');
    beginning.resize(file.read_some(beginning.data(), beginning.size()));
    const FileKind* kind = kind_of(beginning, file.size());
    return kind && !std::ranges::count(kind->endings, ending_of_contents(path)) ? in_words(*kind) : std::string();
  } catch (const Error&) {
    return {};  // the caller that failed to read the file reports why
  }
}

}  // namespace etendue
