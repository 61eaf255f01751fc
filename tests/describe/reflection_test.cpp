// The registry's descriptions of classes, in JSON, JSON Schema, text and Markdown.

#include "etendue/describe/reflection.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "describe/reflection_values.h"
#include "etendue/language/language.h"

namespace etendue {
namespace {

using Json = nlohmann::ordered_json;

Member made_member(const char* name, const char* unit, Kind kind, Value value) {
  Member member;
  member.name = name;
  member.unit = unit;
  member.text = "made for a test";
  member.kind = kind;
  member.default_value = std::move(value);
  return member;
}

TEST(ReflectionTest, numbers_are_told_in_the_unit_of_the_member) {
  const double degree = 3.14159265358979323846 / 180;
  const Member angle = made_member("angle", "deg", Kind::number, Value(Number{double(float(39.3)) * degree, Dimension::angle}));
  EXPECT_EQ(value_text(angle.default_value, angle), "39.3 deg");
  EXPECT_DOUBLE_EQ(value_json(angle.default_value, angle).get<double>(), 39.3);
  const Member length = made_member("length", "m", Kind::number, Value(Number{double(0.1f), Dimension::length}));
  EXPECT_EQ(value_text(length.default_value, length), "0.1 m");
  const Member precise = made_member("precise", "1", Kind::number, Value(Number{3.14159265358979, Dimension::none}));
  EXPECT_DOUBLE_EQ(value_json(precise.default_value, precise).get<double>(), 3.14159265358979);
  const Member seed = made_member("seed", "1", Kind::integer, Value(Number{9007199254740992.0 / 16, Dimension::none}));
  EXPECT_EQ(value_text(seed.default_value, seed), "562949953421312");
  const Member place = made_member("place", "m", Kind::point3, Value(Numbers{{0, 0.5, -2}, 1, Dimension::length}));
  EXPECT_EQ(value_text(place.default_value, place), "[0, 0.5, -2] m");
  EXPECT_EQ(value_json(place.default_value, place).dump(), "[0,0.5,-2]");
}

TEST(ReflectionTest, a_class_in_json_says_what_its_description_says) {
  ClassInfo info;
  info.name = "MadePart";
  info.summary = "A part.";
  info.source = "nobody 1999";
  info.members.push_back(made_member("weight", "1", Kind::number, Value(Number{2})));
  info.members.back().range = Range{0, 10, true};
  info.members.push_back(made_member("side", "", Kind::choice, Value(std::string("both"))));
  info.members.back().choices = {"both", "front"};
  info.members.push_back(made_member("file", "", Kind::file, Value(std::string())));
  info.members.back().required = true;

  const Json json = Json::parse(class_json(info));
  EXPECT_EQ(json["name"], "MadePart");
  EXPECT_EQ(json["source"], "nobody 1999");
  EXPECT_TRUE(json["abstract"]);
  ASSERT_EQ(json["members"].size(), 3u);
  EXPECT_EQ(json["members"][0]["range"].dump(), R"({"more_than":0.0,"high":10.0})");
  EXPECT_EQ(json["members"][0]["default"], 2);
  EXPECT_FALSE(json["members"][0].contains("required"));
  EXPECT_EQ(json["members"][1]["choices"].dump(), R"(["both","front"])");
  EXPECT_EQ(json["members"][1]["type"], "choice");
  EXPECT_TRUE(json["members"][2]["required"]);

  const std::string text = class_text(info);
  EXPECT_EQ(text.find("default"), std::string::npos) << text;  // the class is abstract
  for (const char* word : {"MadePart", "A part.", "nobody 1999", "weight", "more than 0", "both, front", "must be given"})
    EXPECT_NE(text.find(word), std::string::npos) << word << " is not in\n" << text;
}

TEST(ReflectionTest, all_classes_and_members_are_in_the_json) {
  const Json json = Json::parse(classes_json());
  const auto all = described_classes();
  ASSERT_EQ(json.size(), all.size());
  for (size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(json[i]["name"], all[i]->name);
    ASSERT_EQ(json[i]["members"].size(), all[i]->members.size()) << all[i]->name;
    for (size_t m = 0; m < all[i]->members.size(); ++m) EXPECT_EQ(json[i]["members"][m]["name"], all[i]->members[m].name);
  }
}

/// A validator for the part of JSON Schema that our schema uses. Returns what is wrong, or "".
std::string problem(const Json& schema, const Json& value, const Json& root, const std::string& at = "$") {
  const auto wrong = [&](const std::string& what) { return at + " " + what + ": " + value.dump(); };
  if (schema.contains("$ref")) {
    const std::string reference = schema["$ref"];
    const std::string name = reference.substr(reference.rfind('/') + 1);
    if (!reference.starts_with("#/$defs/") || !root["$defs"].contains(name)) return at + ": nothing defines " + reference;
    return problem(root["$defs"][name], value, root, at);
  }
  if (schema.contains("not")) return wrong("nothing fits here");
  if (schema.contains("anyOf")) {
    std::string all;
    for (const Json& one : schema["anyOf"]) {
      const std::string p = problem(one, value, root, at);
      if (p.empty()) return {};
      all.append(p).append("\n");
    }
    return all;
  }
  if (schema.contains("const") && schema["const"] != value) return wrong("is not the constant");
  if (schema.contains("enum") && std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
    return wrong("is no choice");
  if (schema.contains("type")) {
    const std::string type = schema["type"];
    const bool fits = type == "object"    ? value.is_object()
                      : type == "array"   ? value.is_array()
                      : type == "string"  ? value.is_string()
                      : type == "boolean" ? value.is_boolean()
                      : type == "integer" ? value.is_number_integer()
                      : type == "number"  ? value.is_number()
                      : type == "null"    ? value.is_null()
                                          : false;
    if (!fits) return wrong("is no " + type);
  }
  if (value.is_string() && value.get<std::string>().size() < schema.value("minLength", 0u)) return wrong("is too short");
  if (value.is_number()) {
    if (schema.contains("minimum") && value < schema["minimum"]) return wrong("is too small");
    if (schema.contains("exclusiveMinimum") && value <= schema["exclusiveMinimum"]) return wrong("is too small");
    if (schema.contains("maximum") && value > schema["maximum"]) return wrong("is too large");
  }
  if (value.is_array()) {
    if (schema.contains("minItems") && value.size() < schema["minItems"]) return wrong("is too short");
    if (schema.contains("maxItems") && value.size() > schema["maxItems"]) return wrong("is too long");
    if (schema.contains("items"))
      for (const Json& item : value)
        if (const std::string p = problem(schema["items"], item, root, at + "[]"); !p.empty()) return p;
  }
  if (value.is_object()) {
    for (const Json& name : schema.value("required", Json::array()))
      if (!value.contains(name.get<std::string>())) return wrong("lacks " + name.get<std::string>());
    for (const auto& [name, item] : value.items()) {
      if (schema["properties"].contains(name)) {
        if (const std::string p = problem(schema["properties"][name], item, root, at + "." + name); !p.empty()) return p;
      } else if (!schema.value("additionalProperties", true)) {
        return wrong("has an unknown " + name);
      }
    }
  }
  return {};
}

void collect_references(const Json& json, std::set<std::string>& found) {
  if (json.is_object() && json.contains("$ref")) found.insert(json["$ref"].get<std::string>());
  if (json.is_structured())
    for (const Json& item : json) collect_references(item, found);
}

TEST(ReflectionTest, the_schema_has_every_class_and_all_its_references_resolve) {
  const Json schema = Json::parse(json_schema());
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  for (const ClassInfo* info : described_classes()) {
    EXPECT_TRUE(schema["$defs"].contains(info->name + ".any")) << info->name;
    EXPECT_EQ(schema["$defs"].contains(info->name), !info->abstract()) << info->name;
  }
  std::set<std::string> references;
  collect_references(schema, references);
  EXPECT_GT(references.size(), 5u);
  for (const std::string& reference : references) {
    ASSERT_TRUE(reference.starts_with("#/$defs/")) << reference;
    EXPECT_TRUE(schema["$defs"].contains(reference.substr(8))) << reference;
  }
}

TEST(ReflectionTest, defaults_fit_the_schema_and_wrong_members_do_not) {
  const Json schema = Json::parse(json_schema());
  int ranges = 0;
  for (const ClassInfo* info : described_classes()) {
    if (info->abstract()) continue;
    Json object;
    object["class"] = info->name;
    const Json& definition = schema["$defs"][info->name];
    bool complete = true;
    for (const Member& member : info->members) {
      complete = complete && !member.required;
      if (member.required) continue;
      object[member.name] = value_json(member.default_value, member);
      EXPECT_EQ(problem(definition["properties"][member.name], object[member.name], schema, info->name + "." + member.name),
                "");
      // A value below the range must not be valid.
      if (member.range && std::isfinite(member.range->low) && !member.list &&
          (member.kind == Kind::number || member.kind == Kind::integer)) {
        ++ranges;
        const Json low = member.kind == Kind::integer ? Json(std::int64_t(member.range->low) - 1) : Json(member.range->low - 1);
        EXPECT_NE(problem(definition["properties"][member.name], low, schema), "") << info->name << "." << member.name;
      }
    }
    if (complete) {
      EXPECT_EQ(problem(definition, object, schema, info->name), "");
    }
    Json unknown = object;
    unknown["no_such_member"] = 1;
    EXPECT_NE(problem(definition, unknown, schema), "") << info->name;
    Json other = object;
    other["class"] = "NoSuchClass";
    EXPECT_NE(problem(definition, other, schema), "") << info->name;
  }
  EXPECT_GT(ranges, 3);
}

/// A member's value as it may be written in JSON, and whether it is accepted.
struct Written {
  const char *class_name, *member, *json;
  bool right;
};

// Checking a scene against the schema gives the same verdict as the program, as far as a schema can: about values, not about
// the results of expressions in strings.
TEST(ReflectionTest, the_schema_refuses_what_the_program_refuses) {
  const Json schema = Json::parse(json_schema());
  const char* const twelve = "[1, 0, 0, 4, 0, 1, 0, 5, 0, 0, 1, 6]";
  const char* const sixteen = "[1, 0, 0, 4, 0, 1, 0, 5, 0, 0, 1, 6, 0, 0, 0, 1]";
  const Written rows[] = {{"Sphere", "radius", "2", true},
                          {"Sphere", "radius", "\"10 cm\"", true},
                          {"Sphere", "radius", "0", false},
                          {"Sphere", "radius", "-1", false},
                          {"Sphere", "radius", "true", false},
                          {"Sphere", "radius", "null", false},
                          {"Sphere", "radius", "[1]", false},
                          {"Sphere", "radius", "{\"class\": \"Sphere\"}", false},
                          {"Sphere", "radius", "\"\"", false},
                          {"Sphere", "no_such_member", "1", false},
                          {"Sphere", "transform", twelve, true},
                          {"Sphere", "transform", sixteen, true},
                          {"Sphere", "transform", "[1, 0, 0]", false},
                          {"Sphere", "transform", "1", false},
                          {"Sphere", "transform", "\"translate(1, 2, 3)\"", true},
                          {"Sphere", "sides", "\"front\"", true},
                          {"Sphere", "sides", "3", false},
                          {"Sphere", "sides", "true", false},
                          {"Sphere", "priority", "3", true},
                          {"Sphere", "priority", "1.5", false},
                          {"Sphere", "shader", "{\"class\": \"Lambertian\"}", true},
                          {"Sphere", "shader", "null", true},
                          {"Sphere", "shader", "{\"class\": \"Sphere\"}", false},
                          {"Sphere", "shader", "{}", false},
                          {"Sphere", "shader", "0.5", false},
                          {"Sphere", "shader", "{\"class\": \"Lambertian\", \"color\": true}", false},
                          {"Lambertian", "color", "0.5", true},
                          {"Lambertian", "color", "[1, 0, 0.5]", true},
                          {"Lambertian", "color", "\"blackbody(3000 K)\"", true},
                          {"Lambertian", "color", "{\"class\": \"CheckerMap\", \"first\": 0.1}", true},
                          {"Lambertian", "color", "[1, 0]", false},
                          {"Lambertian", "color", "true", false},
                          {"Lambertian", "color", "{\"class\": \"Lambertian\"}", false},
                          {"Box", "size", "[1, 2, 3]", true},
                          {"Box", "size", "[\"10 cm\", \"2 m\", \"3 m\"]", true},
                          {"Box", "size", "\"[1, 2, 3] cm\"", true},
                          {"Box", "size", "[1, 2]", false},
                          {"Box", "size", "[1, 2, 3, 4]", false},
                          {"Box", "size", "[1, 2, true]", false},
                          {"Box", "size", "1", false},
                          {"TriangleMesh", "positions", "[[0, 0, 0], [1, 0, 0]]", true},
                          {"TriangleMesh", "positions", "[0, 0, 0, 1, 0, 0]", true},
                          {"TriangleMesh", "positions", "[]", true},
                          {"TriangleMesh", "positions", "[[0, 0], [1, 0]]", false},
                          {"TriangleMesh", "positions", "1", false},
                          {"TriangleMesh", "positions", "[null]", false},
                          {"TriangleMesh", "triangles", "[[0, 1, 2]]", true},
                          {"TriangleMesh", "triangles", "[0, 1, 2]", true},
                          {"TriangleMesh", "triangles", "[[0, 1.5, 2]]", false},
                          {"TriangleMesh", "file", "\"a.ply\"", true},
                          {"TriangleMesh", "file", "3", false},
                          {"PathTracer", "samples", "4", true},
                          {"PathTracer", "samples", "0", false},
                          {"PathTracer", "samples", "2.5", false},
                          {"PathTracer", "samples", "100000000000000000000", false},
                          {"PathTracer", "next_event", "false", true},
                          {"PathTracer", "next_event", "1", false},
                          {"PathTracer", "heuristic", "\"balance\"", true},
                          {"RampMap", "along", "\"v\"", true},
                          {"RampMap", "positions", "[0, \"1/2\", 1]", true},
                          {"RampMap", "colors", "[[1, 0, 0], [0, 1, 0]]", true},
                          {"RampMap", "colors", "[[1, 0], [0, 1]]", false},
                          {"RampMap", "colors", "0.1", false},
                          {"BvhScene", "objects", "[{\"class\": \"Sphere\"}]", true},
                          {"BvhScene", "objects", "{\"class\": \"Sphere\"}", false},
                          {"BvhScene", "objects", "[{\"class\": \"Lambertian\"}]", false}};
  for (const Written& row : rows) {
    const std::string text = fmt::format(R"({{ "class": "{}", "{}": {} }})", row.class_name, row.member, row.json);
    std::string thrown;
    try {
      parse_component(text, "text.json");
    } catch (const std::exception& e) {
      thrown = e.what();
    }
    EXPECT_EQ(thrown.empty(), row.right) << text << "\n" << thrown;
    // Validates the member alone, without the other members that its class requires.
    const Json value = Json::parse(text);
    const Json& properties = schema["$defs"][row.class_name]["properties"];
    const std::string wrong =
        properties.contains(row.member) ? problem(properties[row.member], value[row.member], schema) : "has no such member";
    EXPECT_EQ(wrong.empty(), row.right) << text << "\n" << wrong;
  }
}

TEST(ReflectionTest, the_manual_has_a_page_for_every_class_and_no_dead_links) {
  const auto pages = manual_pages();
  std::map<std::string, const ManualPage*> by_file;
  for (const ManualPage& page : pages) EXPECT_TRUE(by_file.emplace(page.file, &page).second) << page.file << " comes twice";
  for (const ClassInfo* info : described_classes()) {
    ASSERT_TRUE(by_file.contains(info->name + ".md")) << info->name;
    const std::string& text = by_file[info->name + ".md"]->text;
    EXPECT_TRUE(text.starts_with("# " + info->name + "\n"));
    for (const Member& member : info->members)
      EXPECT_NE(text.find("| `" + member.name + "` |"), std::string::npos) << info->name << "." << member.name;
  }
  const std::regex link(R"(\]\(([^)]*)\))");
  std::set<std::string> reached{"index.md"};
  std::vector<std::string> to_follow{"index.md"};
  while (!to_follow.empty()) {
    const std::string file = to_follow.back();
    to_follow.pop_back();
    ASSERT_TRUE(by_file.contains(file)) << file;
    const std::string& text = by_file[file]->text;
    for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it) {
      const std::string target = (*it)[1];
      EXPECT_TRUE(by_file.contains(target)) << file << " links to " << target;
      if (reached.insert(target).second) to_follow.push_back(target);
    }
  }
  EXPECT_EQ(reached.size(), pages.size());
}

TEST(ReflectionTest, the_tree_lists_every_class_once) {
  std::map<std::string, int> seen;
  std::istringstream lines(class_tree_text());
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    // Class names stand in a column of their own; words in the continuation line of a summary are not counted.
    if (Registry::instance().find(first) && line.find(first + "  ") != std::string::npos) ++seen[first];
  }
  for (const ClassInfo* info : described_classes()) EXPECT_EQ(seen[info->name], 1) << info->name;
}

TEST(ReflectionTest, a_class_in_text_names_all_its_members) {
  for (const ClassInfo* info : described_classes()) {
    const std::string text = class_text(*info);
    EXPECT_TRUE(text.starts_with(info->name));
    for (const Member& member : info->members)
      EXPECT_NE(text.find("\n  " + member.name + " "), std::string::npos) << info->name << "." << member.name;
  }
}

}  // namespace
}  // namespace etendue
