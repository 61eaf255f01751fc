#pragma once
// Shared by tests of the language: small components, and texts that are parsed as components, values or jobs.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "etendue/describe/description.h"
#include "etendue/language/language.h"
#include "etendue/render/job.h"

namespace etendue {

enum class LanguageMode : std::uint8_t { visible, hidden };

/// A component with every kind of member.
class LanguagePart : public Component {
 public:
  using Interface = LanguagePart;
  using Parent = Component;

  bool flag = false;
  int count = 3;
  std::uint64_t large = 0;
  float length = 0.5f;
  float angle = 45;
  float wavelength = 550;
  double precise = 0;
  std::string title;
  FilePath file;
  LanguageMode mode = LanguageMode::visible;
  Vector2 uv;
  Vector3 direction{0, 0, 1};
  Point3 from;
  Color color = flat_spectrum(0.5f);
  AnimatedTransform transform;
  Ref<LanguagePart> child;
  std::vector<Ref<LanguagePart>> parts;
  std::vector<Point3> points;
  std::vector<int> indices;
  std::vector<float> weights;
  std::vector<std::string> words;
  std::vector<LanguageMode> modes;

  static void describe(Description<LanguagePart>& d) {
    d.summary("A part for tests.")
        .member<&LanguagePart::flag>("flag", "", "a switch")
        .member<&LanguagePart::count>("count", "1", "a whole number", range(0, 1000))
        .member<&LanguagePart::large>("large", "1", "a large whole number")
        .member<&LanguagePart::length>("length", "m", "a length", at_least(0))
        .member<&LanguagePart::angle>("angle", "deg", "an angle")
        .member<&LanguagePart::wavelength>("wavelength", "nm", "a wavelength")
        .member<&LanguagePart::precise>("precise", "1", "a double")
        .member<&LanguagePart::title>("title", "", "a string")
        .member<&LanguagePart::file>("file", "", "a file")
        .member<&LanguagePart::mode>("mode", "", "a choice", choices("visible", "hidden"))
        .member<&LanguagePart::uv>("uv", "1", "a 2-vector")
        .member<&LanguagePart::direction>("direction", "1", "a vector")
        .member<&LanguagePart::from>("from", "m", "a point")
        .member<&LanguagePart::color>("color", "1", "a colour")
        .member<&LanguagePart::transform>("transform", "", "a transform")
        .member<&LanguagePart::child>("child", "", "another part")
        .member<&LanguagePart::parts>("parts", "", "more parts")
        .member<&LanguagePart::points>("points", "m", "points")
        .member<&LanguagePart::indices>("indices", "1", "whole numbers")
        .member<&LanguagePart::weights>("weights", "1", "numbers")
        .member<&LanguagePart::words>("words", "", "strings")
        .member<&LanguagePart::modes>("modes", "", "choices", choices("visible", "hidden"));
  }
};

/// A part that a plain number in the text stands for.
class LanguageConstant final : public LanguagePart {
 public:
  float value = 0;
  static void describe(Description<LanguageConstant>& d) {
    d.summary("A number as a part, for tests.")
        .member<&LanguageConstant::value>("value", "1", "the number", range(-10, 10))
        .literal("value");
  }
};

class LanguageNeedy final : public LanguagePart {
 public:
  FilePath source;
  static void describe(Description<LanguageNeedy>& d) {
    d.summary("A part with a required member, for tests.")
        .member<&LanguageNeedy::source>("source", "", "must be there", required);
  }
};

}  // namespace etendue

namespace etendue::language_test {

inline Ref<LanguagePart> part(const std::string& text, const std::string& folder = {}) {
  try {
    return ref_cast<LanguagePart>(parse_component(text, "text", folder));
  } catch (const Errors& e) {
    for (const Error& error : e.errors) ADD_FAILURE() << show(error);
    return make<LanguagePart>();
  }
}

/// All errors of a text as "line:column: message" lines.
template <class Load>
std::string errors_of(Load&& load) {
  std::string all;
  const auto line = [&](const Error& e) {
    if (!all.empty()) all += "\n";
    if (e.location.line > 0) all += std::to_string(e.location.line) + ":" + std::to_string(e.location.column) + ": ";
    all += e.what();
    EXPECT_TRUE(e.location.known()) << e.what();
  };
  try {
    load();
  } catch (const Errors& e) {
    for (const Error& error : e.errors) line(error);
  } catch (const Error& e) {
    line(e);
  }
  return all;
}

inline std::string part_errors(const std::string& text) {
  return errors_of([&] { parse_component(text); });
}
inline std::string value_errors(const std::string& text) {
  return errors_of([&] { parse_value(text); });
}
inline std::string job_errors(const std::string& text, const LoadOptions& options = {}) {
  return errors_of([&] { load_job_text(text, "job", {}, options); });
}

/// The text of a Job that is complete enough to be loaded.
inline std::string job_with(const std::string& members) { return "Job { camera: none, scene: none, " + members + " }"; }

inline double number(const std::string& text) {
  try {
    const Value v = parse_value(text);
    if (const auto* n = v.as<Number>()) return n->value;
    ADD_FAILURE() << text << " is " << v.kind();
  } catch (const Errors& e) {
    ADD_FAILURE() << show(e.errors.front());
  }
  return 0;
}

/// A temporary folder, removed by the destructor.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("etendue_language_" + std::to_string(std::hash<const void*>()(this) ^ size_t(getpid())))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_ / "sub");
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return (path_ / name).string();
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace etendue::language_test
