// Edits of a description's text: everything that is not edited stays the same byte for byte, including comments and layout.

#include "studio/text/text_edits.h"

#include <gtest/gtest.h>

#include "studio/text/places.h"

namespace etendue::studio {
namespace {

/// The value of the one definition in a text.
const language::Node& value_of(const Outline& outline, const std::string& name = "x") {
  return outline.definition(name)->value;
}

std::string set(const std::string& text, const std::string& member, const std::string& value) {
  const Outline outline(text, intern("test"));
  return with_member(outline, value_of(outline), member, value);
}
std::string unset(const std::string& text, const std::string& member) {
  const Outline outline(text, intern("test"));
  return without_member(outline, value_of(outline), member);
}
std::string add(const std::string& text, size_t index, const std::string& item) {
  const Outline outline(text, intern("test"));
  return with_item(outline, outline.entries(value_of(outline)), index, item);
}
std::string remove(const std::string& text, size_t index) {
  const Outline outline(text, intern("test"));
  return without_item(outline, outline.entries(value_of(outline)), index);
}

TEST(StudioText, SetsMembersWhereTheyAreWritten) {
  EXPECT_EQ(set("x = A { a: 1, b: 2 } # c", "a", "10 cm"), "x = A { a: 10 cm, b: 2 } # c");
  EXPECT_EQ(set("# é {\nx = A {  # {\n  a: (1 + 2) # why\n  b: B { c: [1, 2] mm }\n}", "a", "3"),
            "# é {\nx = A {  # {\n  a: 3 # why\n  b: B { c: [1, 2] mm }\n}");
  EXPECT_EQ(set("x = A { a: 2 * y ^ 2, b: f(1, 2)\n}", "b", "0"), "x = A { a: 2 * y ^ 2, b: 0\n}");
  EXPECT_EQ(set("x = A { a: -y\n b: [\n 1 # one\n 2] mm # two\n}", "b", "[3]"), "x = A { a: -y\n b: [3] # two\n}");
}

TEST(StudioText, WritesMembersThatWereNot) {
  EXPECT_EQ(set("x = A {}", "a", "1"), "x = A { a: 1 }");
  EXPECT_EQ(set("x = A { b: 2 }", "a", "1"), "x = A { b: 2, a: 1 }");
  EXPECT_EQ(set("x = A { b: 2, }", "a", "1"), "x = A { b: 2, a: 1, }");
  EXPECT_EQ(set("  x = A {\n      b: 2 # why\n  }\n", "a", "1"), "  x = A {\n      b: 2 # why\n      a: 1\n  }\n");
  EXPECT_EQ(set("x = A {\n  b: 2, # why\n}", "a", "1"), "x = A {\n  b: 2, # why\n  a: 1,\n}");
  EXPECT_EQ(set("x = A {\r\n  b: 2\r\n}", "a", "1"), "x = A {\r\n  b: 2\r\n  a: 1\r\n}");
  EXPECT_EQ(set("x = A {\n  b: 2 }", "a", "1"), "x = A {\n  b: 2, a: 1 }");
  EXPECT_EQ(set("x = A { # none\n}", "a", "1"), "x = A { # none\n    a: 1\n}");
}

TEST(StudioText, TakesMembersAway) {
  EXPECT_EQ(unset("x = A { a: 1 }", "a"), "x = A {  }");
  EXPECT_EQ(unset("x = A { a: 1, b: 2 }", "a"), "x = A { b: 2 }");
  EXPECT_EQ(unset("x = A { a: 1, b: 2 }", "b"), "x = A { a: 1 }");
  EXPECT_EQ(unset("x = A {\n  a: 1\n  b: 2 # why\n}", "a"), "x = A {\n  b: 2 # why\n}");
  EXPECT_EQ(unset("x = A {\n  a: 1\n  b: 2, # why\n}", "b"), "x = A {\n  a: 1\n  # why\n}");
  EXPECT_EQ(unset("x = A { a: 1 }", "b"), "x = A { a: 1 }");
}

TEST(StudioText, EditsLists) {
  EXPECT_EQ(add("x = []", 0, "A {}"), "x = [A {}]");
  EXPECT_EQ(add("x = [ A {} ]", 1, "B {}"), "x = [ A {}, B {} ]");
  EXPECT_EQ(add("x = [\n  A {}  # one\n  B {}  # two\n]", 1, "C {}"), "x = [\n  A {}  # one\n  C {},\n  B {}  # two\n]");
  EXPECT_EQ(add("x = [\n  A {}  # one\n]", 1, "C {}"), "x = [\n  A {}  # one\n  C {}\n]");
  EXPECT_EQ(remove("x = [\n  A {}  # one\n  B {}\n]", 1), "x = [\n  A {}  # one\n]");
  EXPECT_EQ(remove("x = [1, 2, 3] mm", 1), "x = [1, 3] mm");
  EXPECT_EQ(remove("x = [[1, 2],\n [3, 4], [5, 6]]", 2), "x = [[1, 2],\n [3, 4]]");
  EXPECT_EQ(add("x = [1\n -2]", 1, "7"), "x = [1\n 7,\n -2]");
}

TEST(StudioText, TakesExpressionsAlone) {
  EXPECT_EQ(lone_expression(" 30 cm # long "), "30 cm");
  for (const char* wrong : {"1, b: 2", "1 } x = {", "", "#", "1 2 3", "A {", "\"open"})
    EXPECT_ANY_THROW(lone_expression(wrong)) << wrong;
}

TEST(StudioText, FindsTheSmallestDifference) {
  for (const auto& [before, after] :
       {std::pair{"abc", "abXc"}, {"aaa", "aa"}, {"aa", "aaa"}, {"", "a"}, {"é", "è"}, {"x", "x"}}) {
    const TextChange change = difference(before, after);
    EXPECT_EQ(applied_to(before, change), after);
    EXPECT_LE(change.insert.size(), 2u);
  }
  EXPECT_EQ(difference("aéb", "aèb").begin, 1u) << "never within a character";
}

TEST(StudioText, CountsPlacesAsBrowsersDo) {
  const std::string text = "a\xF0\x9F\x98\x80é\nb";  // 1, 2 and 1 units, a line feed, one more
  const Places places(text);
  EXPECT_EQ(places.size(), 6u);
  EXPECT_EQ(places.units(5), 3u);
  EXPECT_EQ(places.byte(size_t(3)), 5u);
  EXPECT_EQ(places.byte(size_t(2)), std::string::npos) << "within a character";
  EXPECT_EQ(places.byte(size_t(7)), std::string::npos);
  EXPECT_EQ(places.byte(Location{"", 2, 1}), 8u);
  std::string longer;
  for (int i = 0; i < 1000; ++i) longer += "é" + std::to_string(i);
  const Places many(longer);
  for (size_t unit = 0; unit <= many.size(); unit += 7) EXPECT_EQ(many.units(many.byte(unit)), unit);
}

}  // namespace
}  // namespace etendue::studio
