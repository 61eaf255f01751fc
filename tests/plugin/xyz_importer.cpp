// An importer in one file, out of tree: molecules in XYZ files, with a sphere for each atom.
#include <algorithm>
#include <charconv>
#include <sstream>

#include "etendue/describe/color.h"
#include "etendue/importer.h"
#include "etendue/scene.h"

using namespace etendue;

// An XYZ file has the number of atoms in its first line, a comment in its second, and then a line "symbol x y z" for each atom,
// with coordinates in angstrom. One angstrom becomes 1 m. Radii are those of Bondi 1964, "van der Waals volumes and radii";
// colours are those of the program Jmol, with hydrogen darker than white, since no surface reflects all light.
struct Element {
  std::string_view symbol;  // empty: all other elements
  double radius;            // [angstrom]
  unsigned color;           // 0xRRGGBB, encoded as sRGB
};
constexpr Element elements[] = {{"H", 1.20, 0xe0e0e0}, {"C", 1.70, 0x909090}, {"N", 1.55, 0x3050f8},  {"O", 1.52, 0xff0d0d},
                                {"P", 1.80, 0xff8000}, {"S", 1.80, 0xffff30}, {"Cl", 1.75, 0x1ff01f}, {"", 1.70, 0xff69b4}};

/// The words of a line, with the location of the last one.
struct Line {
  std::string_view text;
  Location at;
  size_t end = 0;
  std::string_view word() {
    const size_t begin = std::min(text.find_first_not_of(" \t\r", end), text.size());
    end = std::min(text.find_first_of(" \t\r", begin), text.size());
    at.column = int(begin) + 1;
    return text.substr(begin, end - begin);
  }
  double number(const std::string& what) {
    const std::string_view w = word();
    double value = 0;
    const auto [stop, error] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (error == std::errc() && stop == w.data() + w.size() && std::isfinite(value)) return value;
    throw Error("a number is expected here: " + what, at);
  }
};

class XyzImporter final : public Importer {
 public:
  static void describe(Description<XyzImporter>& d) {
    d.summary("XYZ files: molecules, a sphere for each atom, 1 m for an angstrom. -D radius=0.3: smaller ones.", "Bondi 1964");
  }
  std::vector<std::string> extensions() const override { return {"xyz"}; }

  Ref<Component> import(Importing& importing) const override {
    const Value radius = parse_value(importing.parameter("radius").value_or("1"), "-D radius");
    const Number* factor = radius.as<Number>();
    if (!factor || !(factor->value > 0)) throw Error("'radius' must be a number above 0", radius.location);
    const Ref<Scene> scene = ref_cast<Scene>(importing.make(imported_structure, importing.at()));
    std::map<const Element*, Ref<Component>> shaders;
    std::istringstream file(importing.contents());
    int row = 0;
    double last = 3;  // the row of the last atom
    for (std::string text; row < last && std::getline(file, text);) {
      const Location at = importing.at(++row, 1);
      Line line{text, at};
      if (row == 1) last = 2 + line.number("how many atoms there are");
      if (row == 2 && text.find("Lattice=") != text.npos) importing.inexact("the lattice is not repeated", at);
      if (row <= 2) continue;
      const std::string_view symbol = line.word();
      const auto* element = std::ranges::find_if(elements, [&](auto& e) { return e.symbol.empty() || e.symbol == symbol; });
      if (element->symbol.empty()) importing.inexact("this element has no radius here: 1.7 angstrom, pink", at);
      const double x = line.number("x"), y = line.number("y"), z = line.number("z");
      if (!line.word().empty()) importing.inexact("what follows coordinates is left out", line.at);
      Ref<Component>& shader = shaders[element];
      if (!shader) {
        shader = importing.make("Lambertian", at, std::string(element->symbol));
        const auto byte = [&](int shift) { return (element->color >> shift & 255) / 255.0; };
        set_member(*shader, "color", srgb_color(byte(16), byte(8), byte(0)), at);
      }
      const Ref<Component> sphere = importing.make("Sphere", at);
      set_member(*sphere, "centre", Numbers{{x, y, z}}, at);
      set_member(*sphere, "radius", factor->value * element->radius, at);
      set_member(*sphere, "shader", shader, at);
      scene->objects.push_back(ref_cast<SceneObject>(sphere));
    }
    if (row < last || shaders.empty())
      throw Error(row > 0 ? "it has no atoms, or fewer than it says" : "the file is empty", importing.at(row, 1));
    if (std::string more; file >> more) importing.inexact("only the first frame is read", importing.at(row + 1, 1));
    return scene;
  }
};

static const Register<XyzImporter> registered;
