// The layout of `etendue format`: what it changes, and that it changes nothing else.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "language/format/formatter.h"
#include "language/format/same_syntax.h"
#include "support/language_test_support.h"

namespace etendue::language_test {
namespace {

std::string layout(const std::string& text) { return language::formatted({intern("text"), {}, text}); }

TEST(Layout, IsThis) {
  EXPECT_EQ(layout("\xEF\xBB\xBF\n\n# first\na=3  *(x -1) ;b = [ 1,2 ,3 ]  mm\r\n\n\n\nf( x ,y=2 )=if x<y and not(x==0) "
                   "then-x^ - 2 else y[ 0 ]\n"
                   "Job{ renderer :PathTracer { samples:a }   # how\n  scene: BvhScene { objects: [ # many\n\n"
                   "Sphere {} # one\n\t# its own line\n[1,\n-2]\nf (1)\n] } } # end  "),
            "# first\na = 3 * (x - 1); b = [1, 2, 3] mm\n\nf(x, y = 2) = if x < y and not (x == 0) then -x^-2 else y[0]\n"
            "Job { renderer: PathTracer { samples: a }  # how\n    scene: BvhScene { objects: [           # many\n\n"
            "        Sphere {}  # one\n        # its own line\n        [1,\n            -2]\n"
            "        f(1)\n    ] } }  # end\n")
      << layout("a=3");
}

TEST(Layout, OfListsByComprehensionAndIncludes) {
  EXPECT_EQ(layout("include \"a.etd\"with{x:3,y:4}as b\no=[b.x[i]\nfor i in 0 .. 3\nif i!=1]\nz = if a\nthen 1\nelse 2\n"),
            "include \"a.etd\" with { x: 3, y: 4 } as b\no = [b.x[i]\n    for i in 0..3\n    if i != 1]\nz = if a\n    then "
            "1\n    else 2\n");
  EXPECT_EQ(layout("a = 1. .. 3\n"), "a = 1. ..3\n");
}

TEST(Layout, OfWhatCannotBeReadIsRefused) {
  EXPECT_EQ(errors_of([] { layout("a = [1, 2"); }), "1:5: '[' is never closed");
  EXPECT_EQ(errors_of([] { layout("a = \xFF"); }), "the text is not valid UTF-8");
}

// The comparison by which layouts are tested, same_syntax, does detect differences.
TEST(Layout, IsComparedByMeaning) {
  const auto read = [](const std::string& text) {
    language::Diagnostics none;
    return parse_document({intern("text"), {}, text}, none);
  };
  const std::string text =
      "include \"a\" with { b: 1 } as c\nf(x, y = 2) = [[x, [1, 2], i] for i in 0..y]\nJob { seed: f(1, y = 3) }\n";
  EXPECT_TRUE(same_syntax(read(text), read("# other\n" + text + "\n")));
  for (const char* word : {"a", "b: 1", " c", "f(x", "= 2", "1, 2", "0", "seed", "= 3"}) {
    std::string other = text;
    other.replace(other.find(word), 1,
                  word[0] == ' '                     ? " z"
                  : word[0] == '='                   ? "= 1 *"
                  : word[0] == '0' || word[0] == '1' ? "5"
                                                     : "z");
    EXPECT_FALSE(same_syntax(read(text), read(other))) << other;
  }
}

// Every description of the project keeps its meaning and its comments, and a second formatting changes nothing.
TEST(Layout, KeepsWhatTheScenesMean) {
  size_t files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(ETENDUE_SOURCE_DIR) / "scenes")) {
    if (entry.path().extension() != ".etd" || entry.file_size() > 500000) continue;
    std::ostringstream text;
    text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    const language::Source before{intern("before"), {}, text.str()};
    const language::Source after{intern("after"), {}, layout(text.str())};
    language::Diagnostics none;
    EXPECT_TRUE(language::same_syntax(parse_document(before, none), parse_document(after, none))) << entry.path();
    EXPECT_EQ(layout(after.text), after.text) << entry.path();
    EXPECT_EQ(std::count(before.text.begin(), before.text.end(), '#'), std::count(after.text.begin(), after.text.end(), '#'));
    ++files;
  }
  EXPECT_GT(files, 5u);
}

}  // namespace
}  // namespace etendue::language_test
