// PbrtImporter: scenes of pbrt, versions 3 and 4.
//
// The conventions are those of Pharr, Jakob & Humphreys 2016 and 2023, Physically Based Rendering, third and fourth edition,
// and of the pages "pbrt-v3 Input File Format" and "pbrt-v4 Input File Format".

#include "reader.h"

namespace etendue {

namespace {

/// Comments are removed since they often contain a directive of another version.
std::string without_comments(std::string_view text) {
  std::string kept;
  bool quoted = false, comment = false;
  for (const char c : text) {
    if (c == '\n') comment = false;
    if (c == '"' && !comment) quoted = !quoted;
    if (c == '#' && !quoted) comment = true;
    if (!comment) kept += c;
  }
  return kept;
}

/// The version, 3 or 4. In nearly every file the film's type decides; otherwise words that exist only in one version.
int version_of(std::string_view whole) {
  const std::string text = without_comments(whole.substr(0, size_t(4) << 20));
  for (size_t film = text.find("Film"); film != text.npos; film = text.find("Film", film + 4)) {
    const std::string_view after = std::string_view(text).substr(film + 4, 40);
    if (after.find("\"image\"") != after.npos) return 3;
    for (const char* type : {"\"rgb\"", "\"gbuffer\"", "\"spectral\""})
      if (after.find(type) != after.npos) return 4;
  }
  for (const char* word : {"\"point3 ", "\"point2 ", "\"vector3 ", "\"coateddiffuse\"", "\"dielectric\"", "\"conductor\"",
                           "\"rgb reflectance\"", "ColorSpace"})
    if (text.find(word) != text.npos) return 4;
  for (const char* word : {"\"matte\"", "\"plastic\"", "\"uber\"", "\"glass\"", "\"mirror\"", "\"substrate\"", "\"metal\"",
                           "\"point P\"", "\"point from\"", "\"color ", "\"string mapname\"", "WorldEnd", "TransformBegin"})
    if (text.find(word) != text.npos) return 3;
  return 4;
}

class PbrtImporter final : public Importer {
 public:
  static void describe(Description<PbrtImporter>& d) {
    d.summary("Reads scenes of pbrt, versions 3 and 4, whose files end in .pbrt.");
  }

  std::vector<std::string> extensions() const override { return {"pbrt"}; }

  Ref<Component> import(Importing& importing) const override {
    std::string contents = importing.contents();
    pbrt::Reader reader(importing, version_of(contents));
    read_directives(reader, contents);
    std::string().swap(contents);
    return reader.finish();
  }
};

const Register<PbrtImporter> registered;

}  // namespace

}  // namespace etendue
