// Names that are used twice by names that are used twice …: whatever doubles with every line is bounded, and the message says
// so.

#include <gtest/gtest.h>

#include <chrono>
#include <functional>

#include "etendue/render/render.h"
#include "support/language_test_support.h"

namespace etendue::language_test {
namespace {

/// A chain of definitions a0, a1, …, each of which uses the one before in place of each @ in `link`.
std::string chain(const std::string& first, const std::string& link, int length) {
  std::string text = "a0 = " + first + "\n";
  for (int i = 1; i <= length; ++i) {
    std::string line = link;
    const std::string before = "a" + std::to_string(i - 1);
    for (size_t at = line.find('@'); at != std::string::npos; at = line.find('@', at)) line.replace(at, 1, before);
    text += "a" + std::to_string(i) + " = " + line + "\n";
  }
  return text;
}

std::string lit(const std::string& object) {
  return "Job {\n renderer: PathTracer { samples: 1 }\n camera: PerspectiveCamera { from: [0, 0, 5] m }\n"
         "image: ImageBuffer { width: 4, height: 4 }\n outputs: []\n"
         "scene: BvhScene { objects: [\n" +
         object + "\nEnvironment { emission: DiffuseEmission { radiance: 1 } } ] } }\n";
}

/// The errors of loading and preparing a job.
std::string said(const std::string& text) {
  return errors_of([&] { prepare_tree(*load_job_text(text, "text")); });
}

double seconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST(Expansion, OfMapsAndShadersIsBounded) {
  const std::string maps = chain("NoiseMap {}", "AddMap { first: @, second: @ }", 30);
  EXPECT_EQ(said(maps + lit("Sphere { shader: Lambertian { color: a30 } }")),
            "13:7: 'a12' evaluates 16383 components at every hit, as 'a0' is used in 4096 places in it; there are only 15 "
            "different ones, and 10000 evaluations are the most that shared components may cause");
  const std::string mixes = chain("Lambertian {}", "MixShader { first: @, second: @, amount: a0a }", 20);
  EXPECT_NE(said("a0a = NoiseMap {}\n" + mixes + lit("Sphere { shader: a20 }")).find("evaluates 1"), std::string::npos);
  // Two chains that cross: no part uses the same part twice.
  std::string crossed = "a0 = NoiseMap {}\nb0 = NoiseMap { seed: 2 }\n";
  for (int i = 1; i <= 30; ++i) {
    const std::string n = std::to_string(i), m = std::to_string(i - 1);
    crossed += "a" + n + " = AddMap { first: a" + m + ", second: b" + m + " }\nb" + n + " = AddMap { first: b" + m +
               ", second: a" + m + " }\n";
  }
  EXPECT_NE(said(crossed + lit("Sphere { shader: Lambertian { color: a30 } }")).find("components at every hit"),
            std::string::npos);
}

TEST(Expansion, OfSolidsIsBounded) {
  const std::string solids = chain("Sphere {}", "Union { operands: [@, @] }", 30);
  const std::string text = said(solids + lit("a30"));
  EXPECT_NE(text.find("'a13' evaluates 16383 components at every hit, as 'a0' is used in 8192 places"), std::string::npos)
      << text;
}

// Scenes of many objects that share a few parts, and scenes within scenes, are the purpose of sharing and are not bounded.
TEST(Expansion, OfScenesIsNot) {
  std::string objects;
  for (int i = 0; i < 3000; ++i) objects += "Sphere { shader: plain }\n";
  EXPECT_EQ(said("plain = Lambertian { color: AddMap { first: n, second: n } }\nn = NoiseMap {}\n" + lit(objects)), "");
  const std::string forest =
      chain("BvhScene { objects: [Sphere {}] }",
            "BvhScene { objects: [Instance { scene: @ }, Instance { scene: @, transform: translate(3, 0, 0) }] }", 6);
  EXPECT_EQ(said(forest + lit("Instance { scene: a6 }")), "");
}

// Parts that are written out may be many.
TEST(Expansion, OfWhatIsWrittenIsAllowed) {
  std::string sum = "NoiseMap {}", text;
  for (int level = 0; level < 7; ++level) sum = "AddMap { first: " + sum + ", second: " + sum + " }";
  for (int i = 0; i < 100; ++i) text += "m" + std::to_string(i) + " = " + sum + "\n";
  for (int i = 1; i < 100; ++i)
    text += "s" + std::to_string(i) + " = AddMap { first: " + (i == 1 ? "m0" : "s" + std::to_string(i - 1)) + ", second: m" +
            std::to_string(i) + " }\n";
  EXPECT_EQ(said(text + lit("Sphere { shader: Lambertian { color: s99 } }")), "");
}

// Just below the bound it renders.
TEST(Expansion, BelowTheBoundRenders) {
  const std::string text = chain("Lambertian {}", "MixShader { first: @, second: @ }", 11) + lit("Sphere { shader: a11 }");
  Render render(load_job_text(text, "text"), {.threads = 1});
  EXPECT_LT(seconds([&] { render.run(); }), 5.0);
}

TEST(Expansion, OfListsIsBounded) {
  const std::string lists = chain("[1, 1]", "[@, @]", 30);
  EXPECT_EQ(part_errors(lists + "LanguagePart { indices: a30 }"),
            "20:7: the list holds 1048576 values, more than the 1000000 that lists within lists may: 'a18' alone holds 524288");
  // A list that is as long as it was written is no expansion.
  std::string rows = "v = [1, 2, 3]\nLanguagePart { points: [";
  for (int i = 0; i < 400000; ++i) rows += "v,";
  EXPECT_EQ(part(rows + "] }")->points.size(), 400000u);
}

TEST(Expansion, LongChainsOfNamesNeedNoDepth) {
  constexpr int length = 100000;
  std::string forward = chain("1 m", "@ + 0 m", length), backward;
  size_t end = forward.size() - 1;
  while (end != std::string::npos && end > 0) {
    const size_t begin = forward.rfind('\n', end - 1) + 1;
    backward += forward.substr(begin, end - begin + 1);
    end = begin == 0 ? 0 : begin - 1;
  }
  const std::string use = "LanguagePart { length: a" + std::to_string(length) + " }";
  EXPECT_EQ(part(forward + use)->length, 1);
  EXPECT_EQ(part(backward + use)->length, 1);
  EXPECT_EQ(part_errors(chain("LanguagePart {}", "LanguagePart { child: @ }", length) + "LanguagePart { child: a100000 }"),
            "500:30: 'a498' is nested too deeply: its parts go 996 levels down, and it stands at level 4; 1000 levels are the "
            "most in all");
  const std::string circle = "a0 = a" + std::to_string(length) + "\n" + chain("1", "@", length).substr(7);
  EXPECT_NE(part_errors(circle + use).find("too deeply"), std::string::npos);
}

// The deepest nesting that is allowed can be prepared, written, read again, copied, compared and destroyed.
TEST(Expansion, TheDeepestThatIsAllowedWorks) {
  const std::string deep = chain("LanguagePart {}", "LanguagePart { child: @ }", 495) + "LanguagePart { child: a495 }";
  const Ref<LanguagePart> made = part(deep);
  prepare_tree(*made);
  const std::string written = write_description(*made);
  EXPECT_TRUE(equal(Value(Ref<Component>(made)), Value(Ref<Component>(part(written)))));
  EXPECT_TRUE(equal(Value(Ref<Component>(made)), Value(copy(*made))));
}

}  // namespace
}  // namespace etendue::language_test
