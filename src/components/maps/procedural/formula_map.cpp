// A formula over other maps.

#include "components/maps/combining/combination.h"
#include "components/maps/footprint.h"
#include "etendue/describe/bands.h"
#include "etendue/object_map.h"
#include "formula.h"

namespace etendue {
namespace {

enum class Space : std::uint8_t { object, world };

// As a colour, the formula is computed at each of the path's wavelengths from the maps' spectra; as a number, from their
// numbers. Coordinates are in metres, and the same at each wavelength.
class FormulaMap final : public ObjectMap {
 public:
  static void describe(Description<FormulaMap>& d) {
    d.summary("A formula over other maps and coordinates.")
        .member<&FormulaMap::formula>(
            "formula", "",
            "of numbers, names, + - * / ( ) and functions (abs sqrt exp log sin cos tan atan2 floor fract mod pow min max step "
            "clamp mix smoothstep, and mean over wavelengths; angles in radians). Names are those below, u, v, x, y, z, nx, ny "
            "and "
            "nz (the direction of the true surface's normal) and pi. "
            "What is not a finite number, such as 1 / 0, is 0. A colour is kept from being negative, and a reflectance below 1")
        .member<&FormulaMap::names>("names", "", "what the maps are called in the formula")
        .member<&FormulaMap::maps>("maps", "1", "a map for each name")
        .member<&FormulaMap::space>("space", "",
                                    "whether x, y, z and the normal are the object's own or those of the whole scene",
                                    choices("object", "world"));
  }

  void prepare() override {
    if (names.size() != maps.size())
      fail("maps", std::to_string(maps.size()) + " maps for " + std::to_string(names.size()) + " names: give as many");
    if (names.size() > most_maps) fail("names", "at most " + std::to_string(most_maps) + " maps can be named");
    std::vector<std::string> known = coordinates();
    for (size_t i = 0; i < names.size(); ++i) {
      if (!maps[i]) fail("maps", "a map is needed for '" + names[i] + "'");
      if (!valid_name(names[i])) fail("names", "'" + names[i] + "' is no name: letters, digits and _ make one");
      if (names[i] == "pi" || std::find(known.begin(), known.end(), names[i]) != known.end())
        fail("names", "'" + names[i] + "' is a name already");
      known.push_back(names[i]);
    }
    // In a file the formula begins one column after the quote. With escape sequences the columns would not correspond.
    const Location at = location_of("formula");
    const bool plain = at.known() && formula.find_first_of("\"\\\n\t") == std::string::npos;
    try {
      program_ = Formula(formula, known, "formula", plain ? at.column + 1 : 1);
    } catch (const Error& e) {
      const std::string what = "FormulaMap.formula: " + std::string(e.what());
      if (plain) throw Error(what, {at.file, at.line, e.location.column});
      throw Error(what + " (at character " + std::to_string(e.location.column) + " of the formula)", at);
    }
  }

  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    const Spectrum result = as_used(compute(p, [&](const ObjectMap& map) { return map.color(p, w, use); }), use);
    return maps.empty() ? used_number(result[0], use, w) : result;
  }
  float scalar(const SurfacePoint& p) const override {
    return compute(p, [&](const ObjectMap& map) { return Spectrum(map.scalar(p)); })[0];
  }

  std::string formula = "0";
  std::vector<std::string> names;
  std::vector<Ref<ObjectMap>> maps;
  Space space = Space::object;

 private:
  static constexpr size_t most_maps = 16, coordinate_count = 8;
  static std::vector<std::string> coordinates() { return {"u", "v", "x", "y", "z", "nx", "ny", "nz"}; }

  static bool valid_name(const std::string& s) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    const auto part = [&](char c) { return letter(c) || (c >= '0' && c <= '9'); };
    return !s.empty() && letter(s[0]) && std::all_of(s.begin(), s.end(), part) && s != "true" && s != "false" && s != "none";
  }

  template <class Value>
  Spectrum compute(const SurfacePoint& p, Value value) const {
    const Point3 at = space == Space::object ? p.object_position : Point3(world_position(p));
    const Normal3& n = space == Space::object ? p.object_normal : p.normal;
    Spectrum values[coordinate_count + most_maps] = {p.uv.x, p.uv.y, at.x, at.y, at.z, n.x, n.y, n.z};
    for (size_t i = 0; i < maps.size(); ++i)
      if (program_.used()[coordinate_count + i]) values[coordinate_count + i] = value(*maps[i]);
    return program_.run(values);
  }

  Formula program_;
};

const Register<FormulaMap> registered;

}  // namespace
}  // namespace etendue
