// The syntax of other languages gives one error, which says how to write it here.

#include <gtest/gtest.h>

#include "etendue/render/job.h"
#include "support/language_test_support.h"

namespace etendue::language_test {
namespace {

/// All errors of a text, one per line as "line:column: message".
std::string told(std::string text) {
  // A job needs a camera: it is inserted on a line of its own, after everything that is tested.
  const std::string end = "] } }";
  if (const size_t at = text.rfind(end); at != std::string::npos)
    text.insert(at + end.size() - 1, "\n camera: PerspectiveCamera {} ");
  std::string all;
  testing::internal::CaptureStderr();
  try {
    load_job_text(text, "text");
  } catch (const Errors& e) {
    for (const Error& error : e.errors)
      all += (all.empty() ? "" : "\n") + std::to_string(error.location.line) + ":" + std::to_string(error.location.column) +
             ": " + error.what();
  } catch (const Error& error) {
    all = error.what();
  }
  testing::internal::GetCapturedStderr();
  return all;
}

/// A job with the given first line, which uses its name `white`.
std::string using_white(const std::string& line, const std::string& use = "white") {
  return line + "\nJob { scene: BvhScene { objects: [Sphere { shader: " + use + " }, Box { shader: " + use + " }] } }\n";
}

TEST(OtherHabits, ADefinitionThatFailedIsKnownAllTheSame) {
  EXPECT_EQ(told(using_white("white: Lambertian { color: 0.5 }")), "1:6: a name is defined by '=', not ':': write white = …");
  EXPECT_EQ(told(using_white("let white = Lambertian {}")), "1:1: a definition has no 'let' before it: write white = …");
  EXPECT_EQ(told(using_white("def white(c) = Lambertian { color: c }", "white(0.5)")),
            "1:1: a definition has no 'def' before it: write white(…) = …");
  EXPECT_EQ(told(using_white("white(c, 3) = Lambertian { color: c }", "white(0.5, 2)")),
            "1:10: expected the name of a parameter, not '3'");
  // Also after the Job, which has no such member; the inserted camera takes a line of its own.
  EXPECT_EQ(told("Job { scene: BvhScene { objects: [Sphere { shader: white }] } }\nwhite: Lambertian {}\n"),
            "3:6: a name is defined by '=', not ':': write white = …");
}

/// Checks that the text of a value gives one error that contains `hint`.
void expect_hint(const std::string& value, const std::string& hint) {
  const std::string all =
      told("p = [1, 2, 3]\ns = Sphere {}\nJob { seed: " + value + "\n scene: BvhScene { objects: [s, Box { size: p }] } }\n");
  EXPECT_NE(all.find(hint), std::string::npos) << value << "\n" << all;
  EXPECT_EQ(all.find('\n'), std::string::npos) << value << "\n" << all;
}

TEST(OtherHabits, OfOperatorsAndWords) {
  expect_hint("if 1 < 2 && 2 < 3 then 1 else 2", "write 'and'");
  expect_hint("if 1 < 2 || 2 < 3 then 1 else 2", "write 'or'");
  expect_hint("if !(1 < 2) then 1 else 2", "write 'not'");
  expect_hint("(1 < 2) ? 1 : 2", "write if … then … else …");
  expect_hint("2 ** 3", "powers are written x^2");
  expect_hint("7 % 3", "mod(x, n)");
  expect_hint("'text'", "double quotes");
  expect_hint("4 // four", "# begins a comment");
  expect_hint("4 /* four */", "# begins a comment");
  expect_hint("if 1 = 2 then 1 else 2", "'=='");
  expect_hint("if 1 < 2 then 1 elif 2 < 3 then 2 else 3", "not 'elif' (write else if)");
  expect_hint("count([1 for i in 0...3])", "a range is written with two dots: 0..3");
  expect_hint("p [0]", "list[0]");
  expect_hint("len(p)", "count(list)");
  expect_hint("count(range(0, 3))", "0..3");
  expect_hint("null", "here it is 'none'");
  expect_hint("True", "here it is 'true'");
  expect_hint("s.radius", "members of components cannot be read");
  expect_hint("count([s] + [s])", "join(a, b)");
  expect_hint("Sphere(radius = 1)", "write Sphere { … }");
  EXPECT_NE(told("// a comment\nJob { scene: BvhScene { objects: [Sphere {}] } }").find("# begins a comment"),
            std::string::npos);
  EXPECT_NE(told("import \"x.etd\"\nJob { scene: BvhScene { objects: [Sphere {}] } }").find("here it is include \"file\""),
            std::string::npos);
}

TEST(OtherHabits, OfColoursAndTransforms) {
  const auto object = [](const std::string& member) {
    return told("Job { scene: BvhScene { objects: [Sphere { " + member + "\n radius: 1 }] } }");
  };
  EXPECT_EQ(object("emission: DiffuseEmission { radiance: illuminant(D65) }"),
            "1:93: 'D65' is not defined: strings are written in quotes, \"D65\"");
  EXPECT_NE(object("transform: rotate(30 deg, y)").find("strings are written in quotes, \"y\""), std::string::npos);
  EXPECT_NE(object("shader: Lambertian { color: rgb([1, 0, 0.5]) }").find("write rgb(1, 0, 0.5)"), std::string::npos);
  EXPECT_NE(object("shader: Lambertian { color: [1, 0, 0.5] }").find("write rgb(1, 0, 0.5)"), std::string::npos);
  EXPECT_NE(object("transform: matrix([1,0,0,0], [0,1,0,0], [0,0,1,0])").find("write matrix([[…], […], […]])"),
            std::string::npos);
  EXPECT_NE(told("Job { scene: BvhScene { objects: [Sphere {}, [Box {}, Sphere {}]] } }").find("join(a, b)"),
            std::string::npos);
}

TEST(OtherHabits, AHashBeginsAComment) {
  const auto shader = [](const std::string& inside) {
    return told("Job { scene: BvhScene { objects: [Sphere { shader: Lambertian {\n" + inside + "\n} }] } }");
  };
  EXPECT_EQ(shader("color: #ff0000"), "2:8: a value is missing: '#' begins a comment; write srgb(\"#ff0000\")");
  EXPECT_EQ(told("red = #ff0000\n" + using_white("white = Lambertian { color: red }")),
            "1:7: a value is missing: '#' begins a comment; write srgb(\"#ff0000\")");
  EXPECT_EQ(shader("color: # red"), "2:8: a value is missing before the '#', which begins a comment");
  EXPECT_EQ(shader("color: # of brick\n 0.5"), "");
}

TEST(OtherHabits, EnormousNamesAreNotQuotedWhole) {
  std::string name = "a";
  for (int i = 0; i < 100'000; ++i) name += ".a";
  const std::string all = told("Job { seed: " + name + "\n scene: BvhScene { objects: [Sphere {}] } }");
  EXPECT_NE(all.find("is not defined"), std::string::npos);
  EXPECT_LT(all.size(), 400u);
}

}  // namespace
}  // namespace etendue::language_test
