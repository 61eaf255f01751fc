// Descriptions with errors in them: they load, or are rejected with a location, whatever the error.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <regex>
#include <sstream>

#include "etendue/describe/registry.h"
#include "etendue/language/language.h"
#include "etendue/render/job.h"

namespace etendue {
namespace {

constexpr const char* built_in = R"(# All of the language's syntax.
param start = 2 * (1 + 2)
name = "text"; limit = 500 ms
Job {
  camera: none, scene: none
  renderer: PathTracer { samples: max(start, 4) }
  wavelengths: HeroWavelengths {}
  seed: start + abs(-1) * [1, 2, 3] / 2
  time_limit: limit
  outputs: []
}
grow(n, of = [1, 2]) = if n > 0 and not (n == 7) then join(of, grow(n - 1)) else [k[0] for k in [of, of] if k[1] != 5]
many = [[i, j * frame] for i in 0..3 for j in grow(2)]
unused = [translate(0, 1 m, [1, 2, 3] cm), rotate(30 deg, "x") * scale(2), 0.5 * rgb(0.1, 0.2, 0.3), blackbody(2856 K), name]
)";

struct Example {
  std::string name, folder, text;
};

std::vector<Example> examples() {
  std::vector<Example> all = {{"built-in", {}, built_in}};
  const std::filesystem::path scenes = std::filesystem::path(ETENDUE_SOURCE_DIR) / "scenes";
  std::error_code error;
  for (std::filesystem::recursive_directory_iterator i(scenes, error), end; !error && i != end; i.increment(error)) {
    if (i->path().extension() != ".etd" || i->file_size() > 200000) continue;
    std::ostringstream text;
    text << std::ifstream(i->path()).rdbuf();
    if (text.str().find("Job {") == std::string::npos) continue;              // a part that others include
    if (text.str().find("data/highland_cow") != std::string::npos) continue;  // 60 000 hairs take long to read
    all.push_back({i->path().string(), i->path().parent_path().string(), text.str()});
  }
  std::sort(all.begin(), all.end(), [](const Example& a, const Example& b) { return a.name < b.name; });
  return all;
}

enum class Outcome { loaded, rejected };

/// Loads a text. Any outcome but success or Errors with locations is a failure of the test.
Outcome load(const Example& example, const std::string& text) {
  const auto check = [&](const Error& e) {
    EXPECT_TRUE(e.location.known()) << e.what() << "\n" << text;
    EXPECT_FALSE(std::string(e.what()).empty());
    EXPECT_FALSE(show(e).empty());
    if (std::string_view(e.location.file) != "mutant") return;
    const auto lines = int(std::count(text.begin(), text.end(), '\n')) + 1;
    EXPECT_LE(e.location.line, lines) << e.what();
  };
  try {
    load_job_text(text, "mutant", example.folder);
    return Outcome::loaded;
  } catch (const Errors& e) {
    EXPECT_FALSE(e.errors.empty());
    EXPECT_LE(e.errors.size(), 50u);
    for (const Error& error : e.errors) check(error);
  } catch (const Error& e) {
    check(e);
  } catch (const std::exception& e) {
    ADD_FAILURE() << "not an Error: " << e.what() << "\n" << text;
  }
  return Outcome::rejected;
}

/// The words, numbers and symbols of a text, with the blanks between them.
std::vector<std::string> tokens(const std::string& text) {
  static const std::regex token(R"([A-Za-z_]\w*|[0-9.]+|"[^"\n]*"|\s+|[\s\S])");
  return {std::sregex_token_iterator(text.begin(), text.end(), token), {}};
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += part;
  return text;
}

/// Changes a sequence of characters or tokens in one place.
template <class Sequence, class Item>
void mutate(Sequence& s, const Item& inserted, std::mt19937& random) {
  if (s.empty()) return;
  const auto place = [&] { return long(random() % s.size()); };
  switch (random() % 5) {
    case 0: s.erase(s.begin() + place()); break;
    case 1: {
      const auto from = place();
      const Item item = s[size_t(from)];
      s.insert(s.begin() + from, item);
      break;
    }
    case 2: std::swap(s[size_t(place())], s[size_t(place())]); break;
    case 3: s.insert(s.begin() + place(), inserted); break;
    default: s[size_t(place())] = inserted;
  }
}

TEST(LanguageMutation, ExamplesLoadAndReadBackAsTheyWere) {
  for (const Example& example : examples()) {
    if (example.name == "built-in") continue;  // it has deliberate mistakes
    try {
      const Ref<Job> job = load_job_text(example.text, example.name, example.folder);
      for (const bool all : {false, true}) {
        const std::string written = write_description(*job, all, example.folder);
        const Ref<Job> again = load_job_text(written, example.name + " written", example.folder);
        EXPECT_TRUE(equal(Value(Ref<Component>(job)), Value(Ref<Component>(again)))) << written;
        EXPECT_EQ(write_description(*again, all, example.folder), written);
      }
    } catch (const Errors& e) {
      for (const Error& error : e.errors) ADD_FAILURE() << show(error);
    }
  }
}

TEST(LanguageMutation, MutantsLoadOrAreRejectedWithAPlace) {
  static constexpr const char* inserted[] = {"{",
                                             "}",
                                             "[",
                                             "]",
                                             "(",
                                             ")",
                                             ":",
                                             ",",
                                             "=",
                                             ";",
                                             "-",
                                             "/",
                                             "*",
                                             "\"",
                                             "#",
                                             "\n",
                                             "m",
                                             "K",
                                             "nm",
                                             "1e999",
                                             "1e-400",
                                             "0",
                                             "none",
                                             "true",
                                             "Job",
                                             "x",
                                             "é",
                                             "\\",
                                             "include \"x\"\n",
                                             "param ",
                                             "rgb(",
                                             "\xFF",
                                             "[[1,2],[3,4]]",
                                             "pi",
                                             "for i in 0..3",
                                             "f(x) = f(x)\n",
                                             "if ",
                                             "..",
                                             "not ",
                                             "spectrum(\"/\")"};
  std::mt19937 random(20021101);
  testing::internal::CaptureStderr();  // warnings of unused names
  int rejected = 0, all = 0;
  for (const Example& example : examples()) {
    for (int i = 0; i < 200; ++i) {
      std::string text = example.text;
      const int changes = 1 + int(random() % 3);
      for (int k = 0; k < changes; ++k) {
        switch (random() % 8) {
          case 0: text.resize(random() % (text.size() + 1)); break;
          case 1:
          case 2:
          case 3: mutate(text, inserted[random() % std::size(inserted)][0], random); break;
          default: {
            std::vector<std::string> parts = tokens(text);
            mutate(parts, std::string(inserted[random() % std::size(inserted)]), random);
            text = joined(parts);
          }
        }
      }
      rejected += load(example, text) == Outcome::rejected;
      ++all;
      if (testing::Test::HasFailure()) break;
    }
  }
  testing::internal::GetCapturedStderr();
  EXPECT_GT(rejected, all / 3);  // most mutations are errors
}

TEST(LanguageMutation, UnknownNamesAreNeverAccepted) {
  testing::internal::CaptureStderr();
  for (const Example& example : examples()) {
    const std::vector<std::string> parts = tokens(example.text);
    bool comment = false;
    int renamed = 0;
    for (size_t i = 0; i < parts.size() && renamed < 60; ++i) {
      if (parts[i] == "#") comment = true;
      if (parts[i].find('\n') != std::string::npos) comment = false;
      const bool word = std::isalpha(static_cast<unsigned char>(parts[i][0])) != 0;
      size_t after = i + 1;
      while (after < parts.size() && std::isspace(static_cast<unsigned char>(parts[after][0])) != 0) ++after;
      const bool member = after < parts.size() && parts[after] == ":";
      const bool class_name = Registry::instance().find(parts[i]) != nullptr && after < parts.size() && parts[after] == "{";
      if (comment || !word || !(member || class_name)) continue;
      ++renamed;
      std::vector<std::string> changed = parts;
      changed[i] += "_unknown";
      const std::string text = joined(changed);
      EXPECT_EQ(load(example, text), Outcome::rejected)
          << parts[i] << " of " << example.name << " was accepted as " << changed[i];
    }
    EXPECT_GT(renamed, 0) << example.name;
  }
  testing::internal::GetCapturedStderr();
}

}  // namespace
}  // namespace etendue
