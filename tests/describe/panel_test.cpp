// What descriptions say for panels and editors: groups, sliders, meanings, lists of choices, conditions. Inconsistent
// descriptions are refused when a class is registered; those of the built-in classes are usable.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "check/conform/draw.h"
#include "etendue/describe/color.h"
#include "etendue/describe/description.h"
#include "etendue/describe/reflection.h"
#include "etendue/object_map.h"

namespace etendue {
namespace {

using Json = nlohmann::ordered_json;

enum class Mode { first, second };

/// A class of its own for each describe function.
template <auto describe_members>
class Panel final : public Component {
 public:
  using Interface = Panel;
  using Parent = Component;
  static void describe(Description<Panel>& d) {
    d.summary("A thing for tests.");
    describe_members(d);
  }
  float x = 1, y = 1;
  int whole = 1;
  bool flag = false;
  Mode mode = Mode::first;
  std::string text = "a";
  std::vector<std::string> texts;
  FilePath file;
  Color color = flat_spectrum(0.5f);
  Ref<ObjectMap> map = constant(0.5f);
};

/// The error message of registering the class, or "". Only in the latter case does the class stay registered.
template <auto describe_members>
std::string refusal() {
  using T = Panel<describe_members>;
  static RegistrationNode node{typeid(T), typeid(Component),
                               [](ClassInfo& info) {
                                 Description<T> d(info);
                                 T::describe(d);
                                 d.finish();
                               },
                               [](const ClassInfo&) { return Ref<Component>(make<T>()); }, nullptr};
  // The class name is that of a template instantiation, so it is unique.
  enlist(node);
  try {
    Registry::instance().adopt();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

#define REFUSED(words, ...)                                                               \
  do {                                                                                    \
    const std::string said = refusal<[](auto& d) {                                        \
      using T = std::remove_reference_t<decltype(d)>;                                     \
      using P = typename PanelOf<T>::Type;                                                \
      static_cast<void>(sizeof(P));                                                       \
      __VA_ARGS__;                                                                        \
    }>();                                                                                 \
    EXPECT_NE(said.find(words), std::string::npos) << #__VA_ARGS__ << "\nsaid: " << said; \
  } while (false)

template <class D>
struct PanelOf;
template <class C>
struct PanelOf<Description<C>> {
  using Type = C;
};

TEST(PanelFacts, a_slider_ends_within_the_range) {
  REFUSED("slider that ends at 11", d.template member<&P::x>("x", "1", "x", range(0, 10), soft(1, 11)));
  REFUSED("slider that ends at 0", d.template member<&P::x>("x", "1", "x", more_than(0), soft(0, 1)));
  REFUSED("slider from 2 to 1", d.template member<&P::x>("x", "1", "x", soft(2, 1)));
  REFUSED("slider from 2 to 2", d.template member<&P::x>("x", "1", "x", soft(2, 2)));
  REFUSED("not a number", d.template member<&P::flag>("flag", "", "flag", soft(0, 1)));
  REFUSED("not a number", d.template member<&P::map>("map", "1", "map", soft(0, 1)));  // not declared to be read as a number
}

TEST(PanelFacts, ratios_are_of_positive_numbers) {
  REFUSED("may be negative", d.template member<&P::x>("x", "1", "x", soft(1, 10), logarithmic));
  REFUSED("may be negative", d.template member<&P::x>("x", "1", "x", range(-1, 10), soft(1, 10), logarithmic));
  REFUSED("not positive", d.template member<&P::x>("x", "1", "x", range(0, 10), logarithmic));
  REFUSED("not positive", d.template member<&P::x>("x", "1", "x", at_least(1), logarithmic));  // no upper end
  REFUSED("not positive", d.template member<&P::x>("x", "1", "x", at_least(0), soft(0, 1), logarithmic));
}

TEST(PanelFacts, colours_alone_have_a_meaning) {
  REFUSED("read as radiance", d.template member<&P::x>("x", "1", "x", Meaning::radiance));
  REFUSED("read as number", d.template member<&P::color>("color", "1", "color", Meaning::number));
}

TEST(PanelFacts, choices_are_texts_once_each_and_hold_the_default) {
  REFUSED("not a string", d.template member<&P::x>("x", "1", "x", choices("a", "b")));
  REFUSED("twice", d.template member<&P::text>("text", "", "text", choices("a", "a")));
  REFUSED("its default is not allowed", d.template member<&P::text>("text", "", "text", choices("b", "c")));
  REFUSED("does not name its choices", d.template member<&P::mode>("mode", "", "mode"));
}

TEST(PanelFacts, groups_have_members_and_a_name) {
  REFUSED("'empty' has no members", d.group("empty"));
  REFUSED("'empty' has no members", d.group("empty").group("full").template member<&P::x>("x", "1", "x"));
  REFUSED("no name", d.group("").template member<&P::x>("x", "1", "x"));
  REFUSED("opened twice", d.group("a")
                              .template member<&P::x>("x", "1", "x")
                              .group("b")
                              .template member<&P::y>("y", "1", "y")
                              .group("a")
                              .template member<&P::flag>("flag", "", "flag"));
}

TEST(PanelFacts, conditions_name_what_can_be) {
  REFUSED("there is no member 'z'", d.template member<&P::x>("x", "1", "x", when("z", true)));
  REFUSED("the member itself", d.template member<&P::x>("x", "1", "x", when("x", 1)));
  REFUSED("no choice 'third'", d.template member<&P::mode>("mode", "", "mode", choices("first", "second"))
                                   .template member<&P::x>("x", "1", "x", when("mode", "third")));
  REFUSED("it names all", d.template member<&P::mode>("mode", "", "mode", choices("first", "second"))
                              .template member<&P::x>("x", "1", "x", when("mode", "first", "second")));
  REFUSED("can never be empty", d.template member<&P::mode>("mode", "", "mode", choices("first", "second"))
                                    .template member<&P::x>("x", "1", "x", when("mode")));
  REFUSED("never 20",
          d.template member<&P::y>("y", "1", "y", range(0, 10)).template member<&P::x>("x", "1", "x", when("y", 20)));
  REFUSED("can never be empty",
          d.template member<&P::y>("y", "1", "y", more_than(0)).template member<&P::x>("x", "1", "x", when("y")));
  REFUSED("not true or false", d.template member<&P::y>("y", "1", "y").template member<&P::x>("x", "1", "x", when("y", true)));
  REFUSED("not a number",
          d.template member<&P::flag>("flag", "", "f").template member<&P::x>("x", "1", "x", unless("flag", 1)));
  REFUSED("is required",
          d.template member<&P::flag>("flag", "", "f").template member<&P::x>("x", "1", "x", required, when("flag")));
}

class Lamp final : public Component {
 public:
  using Interface = Lamp;
  using Parent = Component;
  static void describe(Description<Lamp>& d) {
    d.summary("A lamp for tests.")
        .member<&Lamp::on>("on", "", "whether it shines")
        .group("Light")
        .member<&Lamp::mode>("mode", "", "how", choices("first", "second"))
        .member<&Lamp::power>("power", "kW", "how much", at_least(0), soft(0.01, 10), logarithmic, when("on"))
        .member<&Lamp::file>("file", "", "measured")
        .member<&Lamp::color>("color", "1", "its colour", Meaning::radiance, when("on"), unless("file"))
        .member<&Lamp::opening>("opening", "deg", "of its cone", range(0, 180), when("mode", "second"))
        .member<&Lamp::edge>("edge", "1", "of its cone", Meaning::number, when("opening", 0, 90))
        .member<&Lamp::after>("after", "1", "behind the edge", when("edge"))
        .group("Names")
        .member<&Lamp::name>("name", "", "one of some", choices("a", "b"))
        .member<&Lamp::names>("names", "", "some of some", choices("a", "b"));
  }
  bool on = false;
  Mode mode = Mode::first;
  float power = 1, opening = 45, after = 1;
  FilePath file;
  Color color = flat_spectrum(1);
  Ref<ObjectMap> edge = constant(0.5f);
  std::string name = "a";
  std::vector<std::string> names;
};
const Register<Lamp> registered_lamp;

TEST(PanelFacts, stand_in_the_class_and_are_told) {
  const ClassInfo& info = *Registry::instance().find("Lamp");
  EXPECT_EQ(info.find("on")->group, "");
  EXPECT_EQ(info.find("color")->group, "Light");
  EXPECT_EQ(info.find("names")->group, "Names");
  const Json json = Json::parse(class_json(info));
  EXPECT_EQ(json["members"][2]["slider"].dump(), "[0.01,10.0]");
  EXPECT_EQ(json["members"][2]["logarithmic"], true);
  EXPECT_EQ(json["members"][4]["meaning"], "radiance");
  EXPECT_EQ(json["members"][4]["when"].dump(), R"([{"member":"on","given":true},{"member":"file","given":false}])");
  EXPECT_EQ(json["members"][5]["when"].dump(), R"([{"member":"mode","is":["second"]}])");
  EXPECT_EQ(json["members"][6]["when"].dump(), R"([{"member":"opening","is":[0.0,90.0]}])");
  const Json schema = Json::parse(json_schema())["$defs"]["Lamp"]["properties"];
  EXPECT_EQ(schema["power"]["x-slider"].dump(), "[0.01,10.0]");
  EXPECT_EQ(schema["power"]["x-group"], "Light");
  EXPECT_EQ(schema["color"]["x-when"], json["members"][4]["when"]);
  EXPECT_EQ(schema["names"]["items"]["enum"].dump(), R"(["a","b"])");
  const std::string text = class_text(info);
  for (const char* words : {"usually 0.01 to 10", "Matters only when 'on' is true and 'file' is not given.",
                            "'mode' is second.", "'opening' is 0 or 90.", "'edge' is not 0."})
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
}

TEST(PanelFacts, say_when_a_member_matters) {
  const ClassInfo& info = *Registry::instance().find("Lamp");
  Lamp lamp;
  const auto counts = [&](const char* member) { return matters(lamp, *info.find(member)); };
  EXPECT_TRUE(counts("on"));
  EXPECT_FALSE(counts("power"));
  lamp.on = true;
  EXPECT_TRUE(counts("power"));
  EXPECT_TRUE(counts("color"));
  lamp.file.text = "lamp.ies";
  EXPECT_FALSE(counts("color"));
  EXPECT_FALSE(counts("opening"));
  lamp.mode = Mode::second;
  EXPECT_TRUE(counts("opening"));
  EXPECT_FALSE(counts("edge"));
  lamp.opening = 90;  // in the member's unit, degrees; values of the language are in radians
  EXPECT_TRUE(counts("edge"));
  EXPECT_TRUE(counts("after"));
  lamp.edge = constant(0);
  EXPECT_FALSE(counts("after"));
  lamp.edge = nullptr;
  EXPECT_FALSE(counts("after"));
}

TEST(PanelFacts, lists_of_choices_are_kept_to) {
  Lamp lamp;
  const auto error = [&](const char* member, const Value& v) {
    try {
      set(lamp, member, v);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(error("name", Value(std::string("b"))), "");
  EXPECT_EQ(error("name", Value(std::string("c"))).substr(0, 27), "Lamp.name has no choice 'c'");
  EXPECT_EQ(error("names", Value(Value::List{Value(std::string("b")), Value(std::string("a"))})), "");
  EXPECT_NE(error("names", Value(Value::List{Value(std::string("b")), Value(std::string("d"))})).find("no choice 'd'"),
            std::string::npos);
}

/// The built-in classes, which the manual lists, without those of tests.
std::vector<const ClassInfo*> built_in() {
  std::vector<const ClassInfo*> all;
  for (const ClassInfo* info : Registry::instance().all())
    if (info->provider.empty() && std::filesystem::exists(ETENDUE_SOURCE_DIR "/docs/manual/" + info->name + ".md"))
      all.push_back(info);
  return all;
}

bool is_of(const ClassInfo& info, const char* interface) { return info.is_a(*Registry::instance().find(interface)); }

TEST(PanelFacts, classes_with_many_members_have_groups) {
  for (const ClassInfo* info : built_in()) {
    if (info->members.size() <= 7 || is_of(*info, "Renderer") || is_of(*info, "Job")) continue;
    std::set<std::string> groups;
    for (const Member& m : info->members) groups.insert(m.group);
    EXPECT_GT(groups.size(), 1u) << info->name << " has " << info->members.size() << " members";
  }
}

TEST(PanelFacts, numbers_without_ends_have_a_slider) {
  // The lengths of lists, seeds, priorities and numbers of samples have no typical range.
  const std::set<std::string> without = {"seed", "priority", "points", "positions", "holes", "hole_counts", "counts", "degree"};
  for (const ClassInfo* info : built_in())
    for (const Member& m : info->members) {
      if (m.owner != info || m.list || without.contains(m.name) || is_of(*info, "Renderer") || is_of(*info, "Job")) continue;
      const bool endless = m.range && m.range->low >= 0 && !std::isfinite(m.range->high);
      const bool quantity = m.kind == Kind::number || m.kind == Kind::integer;
      if (quantity && endless) EXPECT_TRUE(m.soft) << info->name << "." << m.name;
    }
}

TEST(PanelFacts, colours_say_what_they_are_read_as) {
  for (const ClassInfo* info : built_in())
    for (const Member& m : info->members)
      if (m.owner == info && info->name != "ConstantMap" && m.name != "layers" &&  // the layers of a group are shaders
          (m.kind == Kind::color || (m.component_class == "ObjectMap" && !is_of(*info, "ObjectMap"))))
        EXPECT_NE(m.meaning, Meaning::plain) << info->name << "." << m.name;
}

/// Each end of a slider is a value that the class accepts while all other members have their defaults.
TEST(PanelFacts, sliders_end_at_values_that_are_taken) {
  // Except members that bound each other: whether an end is accepted depends on the other member's value.
  const std::set<std::string> bounded = {
      "Annulus.radius",    "Annulus.inner_radius",     "Cone.radius", "Hyperboloid.radius", "Torus.radius",
      "Torus.tube_radius", "Hyperboloid.waist_radius", "Tube.radius", "Tube.inner_radius",  "Metaballs.threshold"};
  const conform::Fixtures fixtures;
  std::mt19937_64 random(3);
  for (const ClassInfo* info : built_in()) {
    if (info->abstract()) continue;
    for (const Member& m : info->members) {
      if (!m.soft || m.list || bounded.contains(info->name + "." + m.name)) continue;
      for (const double end : {m.soft->low, m.soft->high}) {
        const conform::Drawn drawn = conform::default_part(*info, fixtures, random);
        ASSERT_TRUE(drawn.part) << info->name << ": " << drawn.refused;
        // The shutter's members depend on each other: an interval that ends before it begins is rightly refused.
        if (m.name == "shutter_open" || m.name == "shutter_close" || m.name == "shutter_opening" || m.name == "shutter_closing")
          continue;
        try {
          set(*drawn.part, m.name, Value(Number{end}));
          prepare_tree(*drawn.part);
        } catch (const Error& e) {
          ADD_FAILURE() << info->name << "." << m.name << " = " << end << ": " << e.what();
        }
      }
    }
  }
}

}  // namespace
}  // namespace etendue
