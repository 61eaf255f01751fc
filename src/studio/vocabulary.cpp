// The data about the program: its classes, units, functions and names of colours, and the manual.

#include "etendue/describe/color.h"
#include "etendue/describe/reflection.h"
#include "etendue/describe/sensor_curves.h"
#include "language/calls.h"
#include "studio.h"

namespace etendue::studio {

namespace {

/// The descriptions of all classes. They change when plugins are loaded, and when a shader's file is read again: its class is
/// then declared anew. Descriptions are never destroyed, so their addresses tell whether these are still the same.
Json known_classes() {
  static std::mutex guard;
  static std::vector<const ClassInfo*> known;
  static Json descriptions;
  const std::lock_guard lock(guard);
  std::vector<const ClassInfo*> now = Registry::instance().all();
  if (now != known) {
    descriptions = Json::parse(classes_json());
    known = std::move(now);
  }
  return descriptions;
}

}  // namespace

Json vocabulary_json() {
  Json all_units = Json::array(), functions = Json::array();
  for (const Unit& unit : units())
    all_units.push_back({{"name", unit.name}, {"dimension", name(unit.dimension)}, {"factor", unit.factor}});
  for (const auto list : {language::color_functions(), language::transform_functions(), language::math_functions()})
    for (const language::Function& f : list) functions.push_back({{"name", f.name}, {"usage", f.usage}});
  return {{"version", ETENDUE_VERSION},
          {"classes", known_classes()},
          {"units", all_units},
          {"functions", functions},
          {"names",
           {{"illuminants", illuminant_names()},
            {"glasses", glass_names()},
            {"metals", metal_names()},
            {"sensors", sensor_names()},
            {"rgb_spaces", rgb_space_names()}}}};
}

std::string Studio::manual_page(const std::string& class_name) {
  const ClassInfo* info = Registry::instance().find(class_name);
  return info ? "# " + info->name + "\n\n```\n" + class_text(*info) + "```\n" : std::string();
}

}  // namespace etendue::studio
