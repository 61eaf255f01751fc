// Lists by comprehension, conditions, functions: their results, the errors in them, and that they terminate.

#include <gtest/gtest.h>

#include <ctime>

#include "support/language_test_support.h"

namespace etendue::language_test {
namespace {

/// The counts of the parts that `list` makes.
std::vector<int> counts(const std::string& list, const std::string& before = {}) {
  std::vector<int> found;
  const auto whole = part(before + "\nLanguagePart { parts: " + list + " }");
  for (const auto& p : whole->parts) found.push_back(p->count);
  return found;
}

using Ints = std::vector<int>;

TEST(Comprehension, MakesAnEntryForEachTurn) {
  EXPECT_EQ(counts("[ LanguagePart { count: i } for i in 0..4 ]"), (Ints{0, 1, 2, 3}));
  EXPECT_EQ(counts("[ LanguagePart { count: 10 * i + j } for i in 1..4 for j in 0..i ]"), (Ints{10, 20, 21, 30, 31, 32}));
  EXPECT_EQ(counts("[ LanguagePart { count: i } for i in 0..10 if mod(i, 3) == 1 if i != 4 ]"), (Ints{1, 7}));
  EXPECT_EQ(counts("[\n LanguagePart { count: i }\n  for i in 0 .. 3 # three\n\n if i > 0\n]"), (Ints{1, 2}));
  EXPECT_EQ(counts("[ LanguagePart { count: i } for i in 3..0 ]"), Ints{});
  EXPECT_EQ(counts("[ LanguagePart { count: i } for i in [5, 7] ]"), (Ints{5, 7}));
  EXPECT_EQ(counts("[ LanguagePart { count: p[1] } for p in [[5, 7], [8, 9]] ]"), (Ints{7, 9}));
}

TEST(Comprehension, PacksNumbersAsAListWrittenOutDoes) {
  const auto p = part("LanguagePart { indices: [2 * i for i in 0..4], points: [[i, 0, 0] mm for i in 1..3], weights: 0..3 }");
  EXPECT_EQ(p->indices, (Ints{0, 2, 4, 6}));
  ASSERT_EQ(p->points.size(), 2u);
  EXPECT_FLOAT_EQ(p->points[1].x, 0.002f);
  EXPECT_EQ(p->weights, (std::vector<float>{0, 1, 2}));
  EXPECT_EQ(parse_value("[[10 * i + j for j in 0..2] for i in 0..2]"), parse_value("[[0, 1], [10, 11]]"));
}

// Each iteration makes objects of its own; a name from outside is one shared object, however often it is used.
TEST(Comprehension, MakesObjectsOfItsOwnAndSharesNames) {
  const auto p = part("one = LanguagePart {}\nLanguagePart { parts: [ LanguagePart { child: one } for i in 0..2 ] }");
  ASSERT_EQ(p->parts.size(), 2u);
  EXPECT_NE(p->parts[0].get(), p->parts[1].get());
  EXPECT_EQ(p->parts[0]->child.get(), p->parts[1]->child.get());
  const auto q =
      part("few = [LanguagePart { count: i } for i in 0..2]\nLanguagePart { parts: [x for k in 0..2 for x in few] }");
  ASSERT_EQ(q->parts.size(), 4u);
  EXPECT_EQ(q->parts[0].get(), q->parts[2].get());
}

TEST(Comprehension, NamesAreItsOwn) {
  EXPECT_EQ(counts("[ LanguagePart { count: i } for i in [x, x + 1] for x in [i, 2 * i] ]", "i = 50\nx = 3"),
            (Ints{3, 3, 4, 4}));
  EXPECT_EQ(counts("[ LanguagePart { count: i } for i in [0, n] ]", "n = i\ni = 50"), (Ints{0, 50}));
  EXPECT_EQ(part_errors("LanguagePart { indices: [i for i in 0..2], count: i }"),
            "1:51: 'i' is not defined (did you mean 'pi'?)");
  EXPECT_EQ(part_errors("LanguagePart { indices: [i for i in 0..2 for i in 3..5] }"),
            "1:46: there is a 'for i' already, at line 1:32");
  EXPECT_EQ(part("LanguagePart { modes: [mode for mode in [\"hidden\", \"visible\"]] }")->modes,
            (std::vector<LanguageMode>{LanguageMode::hidden, LanguageMode::visible}));
}

// Keywords that have a meaning between values are ordinary names where a name is expected.
TEST(Comprehension, ItsWordsStayNames) {
  EXPECT_EQ(
      counts("[LanguagePart { count: for }, in, if]", "for = 3\nin = LanguagePart { count: 4 }; if = LanguagePart {count: 5}"),
      (Ints{3, 4, 5}));
  EXPECT_EQ(
      part("time = 4\nframe = 2\nwith = 1\nas = 1\nnot = 1\nLanguagePart { count: time + frame + with + as + not }")->count, 9);
}

TEST(Conditions, ChooseAndCompare) {
  for (const char* text :
       {"1 < 2", "2 <= 2", "3 > 2", "2 >= 2", "2 == 2", "2 != 3", "1 m == 100 cm", "not 2 == 3", "true or 1 > 2",
        "1 < 2 and 2 < 3", "not (true and false)", "\"a\" == \"a\"", "none == none", "[1, 2] == [1, 2]", "[1, 2] != [1, 3]",
        "true != false", "1 + 1 == 2", "false or not false and true", "1 m < 1 km"})
    EXPECT_EQ(parse_value(text), Value(true)) << text;
  for (const char* text : {"1 > 2", "2 < 2", "1 != 1", "not true", "false and true or false", "1 == 1 and false"})
    EXPECT_EQ(parse_value(text), Value(false)) << text;
  EXPECT_EQ(number("if 1 < 2 then 3 else 4"), 3);
  EXPECT_EQ(number("1 + (if 1 > 2\n then 3\n else if true then 5 else 6)"), 6);
  EXPECT_EQ(number("count([1, 2, 3]) + count([]) + count(0..5) + ([4, 5, 6])[0] * 0 + (join([1, 2], [], [7]))[2]"), 15);
  // The branch that is not chosen is not evaluated, but the names in it are checked.
  EXPECT_EQ(number("if true then 1 else 1 / 0"), 1);
  EXPECT_EQ(value_errors("if true then 1 else q"), "1:21: 'q' is not defined");
  EXPECT_EQ(value_errors("true or q"), "1:9: 'q' is not defined");
  EXPECT_EQ(value_errors("if true then 1 else [LanguagePart { cout: 1 m }, f(3)]"),
            "1:37: LanguagePart has no member 'cout' (did you mean 'count'?)\n1:50: there is no function 'f'");
}

TEST(Conditions, AreRefusedWhereTheyHaveNoMeaning) {
  EXPECT_EQ(value_errors("1 m < 1"), "1:5: cannot compare a length with a number by '<'");
  EXPECT_EQ(value_errors("\"a\" < \"b\""), "1:5: cannot compare a string with a string by '<'");
  EXPECT_EQ(value_errors("1 == \"1\""), "1:3: cannot compare a number with a string by '=='");
  EXPECT_EQ(value_errors("if 1 then 2 else 3"), "1:4: the condition of 'if' must be true or false, not a number");
  EXPECT_EQ(value_errors("1 < 2 < 3"), "1:7: comparisons cannot be chained: write a < b and b < c");
  EXPECT_EQ(value_errors("0..2.5"), "1:2: a range goes from a whole number to a whole number, not 2.5");
  EXPECT_EQ(value_errors("0..2 m"), "1:2: a range goes from a whole number to a whole number, not a length");
  EXPECT_EQ(part_errors("a = [1, 2]\nLanguagePart { indices: [a[2], a[-1], a[0.5]] }"),
            "2:28: there is no entry 2: the list has 2, from 0 to 1\n2:34: there is no entry -1: the list has 2, from 0 to 1\n"
            "2:41: an index is a whole number, not 0.5");
}

TEST(RandomNumbers, AreEvenAndUnrelated) {
  // Over 10,000 numbers, the mean and the mean product of neighbours are 1/2 and 1/4, with standard deviations 0.0029 and
  // 0.0026.
  const Value value = parse_value("[random(7, i) for i in 0..10000]");
  const std::vector<double>& x = value.as<Numbers>()->values;
  double mean = 0, product = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    EXPECT_TRUE(x[i] >= 0 && x[i] < 1);
    mean += x[i] / double(x.size());
    product += x[i] * x[(i + 1) % x.size()] / double(x.size());
  }
  EXPECT_NEAR(mean, 0.5, 5 * 0.0029);
  EXPECT_NEAR(product, 0.25, 5 * 0.0026);
  EXPECT_EQ(number("random(1, 2)"), number("random(1, 2)"));
  EXPECT_NE(number("random(1, 2)"), number("random(2, 1)"));
}

TEST(Functions, TakeArgumentsByPlaceAndName) {
  const std::string f = "f(a, b = 2 * a, c = b + 1) = LanguagePart { count: 100 * a + 10 * b + c }\n";
  EXPECT_EQ(counts("[f(1), f(1, 5), f(c = 3, a = 1), f(2, c = 9)]", f), (Ints{123, 156, 123, 249}));
  EXPECT_EQ(part_errors(f + "LanguagePart { parts: [f(), f(1, 2, 3, 4), f(1, d = 2), f(1, a = 2), f(a = 1, 2)] }"),
            "2:24: expects f(a, b = …, c = …): 'a' is missing\n2:40: expects f(a, b = …, c = …); 4 arguments were given\n"
            "2:49: 'f' has no parameter 'd' (did you mean 'a'?)\n2:62: 'a' is given twice\n"
            "2:79: an argument by its place cannot follow one by its name");
  // Names at the place of a call are not visible inside the function.
  EXPECT_EQ(part_errors("f(x) = x + i\nLanguagePart { indices: [f(1) for i in 0..2] }"),
            "1:12: 'i' is not defined (did you mean 'pi'?)");
}

TEST(Functions, MakeNewObjectsEachTimeAndAreNamedByTheirUse) {
  const auto p = part("f(n) = LanguagePart { count: n }\none = f(4)\nLanguagePart { parts: [one, one, f(4)] }");
  ASSERT_EQ(p->parts.size(), 3u);
  EXPECT_EQ(p->parts[0].get(), p->parts[1].get());
  EXPECT_NE(p->parts[0].get(), p->parts[2].get());
  EXPECT_EQ(p->parts[0]->origin->name, "one");
  const auto again = part(write_description(*p));
  EXPECT_TRUE(equal(Value(Ref<Component>(p)), Value(Ref<Component>(again))));
}

TEST(Functions, MayCallThemselves) {
  const std::string tree = "tree(n) = LanguagePart { count: n, parts: if n > 0 then [tree(n - 1), tree(n - 1)] else [] }\n";
  Ref<LanguagePart> p = part(tree + "LanguagePart { child: tree(6) }")->child;
  for (int n = 6; n > 0; --n) {
    EXPECT_EQ(p->count, n);
    ASSERT_EQ(p->parts.size(), 2u);
    p = p->parts[1];
  }
  EXPECT_EQ(number("count([1])"), 1);
}

// A list that a function builds recursively is as deep as its entries, not as the calls were.
TEST(Functions, GrowListsWithoutDepth) {
  const auto p = part(
      "grow(n) = if n == 0 then [LanguagePart {}] else [x for i in 0..2 for x in grow(n - 1)]\n"
      "LanguagePart { parts: [p for k in 0..3 for p in grow(9)] }");
  EXPECT_EQ(p->parts.size(), 3u * 512u);
}

TEST(Functions, ErrorsTellTheWay) {
  EXPECT_EQ(
      part_errors("f(n) = LanguagePart { count: n }\ng(n) = f(1000 * n)\n"
                  "LanguagePart { parts: [LanguagePart { child: g(i) } for i in 0..5] }"),
      "1:30: LanguagePart.count must be from 0 to 1000, not 2000 (in 'f', called at line 2:8, in 'g', called at line 3:46, "
      "with i = 2)");
  // An error in a function is reported once, however often the function is called, and also if it is never called.
  EXPECT_EQ(part_errors("f(n) = LanguagePart { cunt: n }\nLanguagePart { parts: [f(1), f(2)] }"),
            "1:23: LanguagePart has no member 'cunt' (did you mean 'count'?)");
  EXPECT_EQ(part_errors("f(n) = [q, 3 * 3 kg, g(2)]\nLanguagePart {}"),
            "1:9: 'q' is not defined (did you mean 'n'?)\n1:18: unknown unit 'kg' (did you mean 'km'?)\n"
            "1:22: there is no function 'g' (did you mean 'f'?)");
  EXPECT_EQ(part_errors("f(n) = n\nLanguagePart { count: f, flag: n(2) }\n"),
            "2:23: 'f' is a function: write f(…)\n2:32: there is no function 'n' (did you mean 'f'?)");
  EXPECT_EQ(part_errors("a = 3\nLanguagePart { count: a(2) }"),
            "2:23: 'a' is not a function: it is a value, defined at line 1:1");
  EXPECT_EQ(part_errors("sqrt(x) = x\npi(y) = y\nf(x, x) = x\nLanguagePart {}"),
            "1:1: 'sqrt' is a function of the language and cannot be defined again\n2:1: 'pi' is reserved and cannot be "
            "defined\n3:6: there is a parameter 'x' already");
}

/// Expects the error `said` within a CPU time; other processes may be running.
void expect_refused(const std::string& text, const std::string& said, double most_seconds = 30) {
  const std::clock_t begin = std::clock();
  const std::string errors = part_errors(text);
  EXPECT_NE(errors.find(said), std::string::npos) << text << "\n" << errors;
  EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, most_seconds) << text;
}

TEST(BoundedWork, IsRefusedBeforeItIsBegun) {
  expect_refused("LanguagePart { indices: [i for i in 0..1000000000] }", "1:38: the range has 1000000000 numbers", 1);
  expect_refused("LanguagePart { parts: [LanguagePart {} for i in 0..10000 for j in 0..10000] }",
                 "1:23: the list would have 1e+08 entries, more than the 1000000 that 'for' may make", 1);
  expect_refused("a = 0..1000000\nLanguagePart { indices: [i for i in a for j in a] }", "1e+12 entries", 1);
}

TEST(BoundedWork, EndsWhereItCannotBeForeseen) {
  expect_refused("f(x) = f(x)\nLanguagePart { child: f(1) }", "1:8: 'f' is called within 100 other calls");
  expect_refused("f(n) = [f(n - 1), f(n - 1)]\nLanguagePart { parts: f(60) }", "other calls");
  expect_refused("f(n) = if n == 0 then 1 else f(n - 1) + f(n - 1)\nLanguagePart { count: f(60) }", "too much work");
  expect_refused("LanguagePart { parts: [LanguagePart { parts: [LanguagePart {} for j in 0..i] } for i in 0..10000] }",
                 "too many components");
  expect_refused("LanguagePart { indices: [i for i in 0..1000 for j in i..i + 2000] }", "more than the 1000000 entries");
  expect_refused("LanguagePart { points: [[0..1000 for k in 0..1000] for j in 0..1000] }", "lists within lists");
  expect_refused("a = 0..1000000\nLanguagePart { indices: [count(join(a)) for i in 0..1000000] }", "too much work");
  expect_refused(
      "f(x) = LanguagePart { child: LanguagePart { child: x } }\ng(x) = f(f(f(f(x))))\nh(x) = g(g(g(g(x))))\n"
      "k(x) = h(h(h(h(x))))\nm(x) = k(k(k(k(x))))\nLanguagePart { child: m(LanguagePart {}) }",
      "nested too deeply");
}

// An element of a named list is read without copying the list: 100,000 elements of a list of 100,000 take no longer than
// 100,000 numbers.
TEST(BoundedWork, PlacesInListsAreNoCopies) {
  const auto p = part("a = [2 * i for i in 0..100000]\nLanguagePart { indices: [a[i] for i in 0..count(a)] }");
  ASSERT_EQ(p->indices.size(), 100000u);
  EXPECT_EQ(p->indices.back(), 199998);
}

}  // namespace
}  // namespace etendue::language_test
