// Names, components and files of the render description language, and the messages about errors in them.

#include <gtest/gtest.h>

#include "etendue/render/job.h"
#include "support/language_test_support.h"

namespace etendue::language_test {
namespace {

// ---- names ----------------------------------------------------------------------------------------------------------

TEST(Language, NamesAreSharedInAnyOrder) {
  const auto p = part("LanguagePart { child: b, parts: [a, b] }\n b = a; a = LanguagePart { length: size }\n size = 2 * 1 m");
  EXPECT_EQ(p->child, p->parts[0]);
  EXPECT_EQ(p->child, p->parts[1]);
  EXPECT_EQ(p->child->length, 2);
  ASSERT_TRUE(p->child->origin);
  EXPECT_EQ(p->child->origin->name, "a");
  EXPECT_EQ(p->child->origin->location, (Location{intern("text"), 2, 13}));
  EXPECT_EQ(p->child->location_of("length"), (Location{intern("text"), 2, 36}));
}

TEST(Language, ChoicesComeBeforeNames) {
  EXPECT_EQ(part("visible = 3\nLanguagePart { mode: visible, count: visible }")->mode, LanguageMode::visible);
  EXPECT_EQ(part("m = \"hidden\"\nLanguagePart { mode: m }")->mode, LanguageMode::hidden);
  EXPECT_EQ(part_errors("LanguagePart { mode: visble }"),
            "1:22: LanguagePart.mode has no choice 'visble' (did you mean 'visible'?); known are visible, hidden");
  EXPECT_EQ(part_errors("LanguagePart { modes: [visible, hiden] }"),
            "1:33: LanguagePart.modes has no choice 'hiden' (did you mean 'hidden'?); known are visible, hidden");
}

TEST(Language, NameErrors) {
  EXPECT_EQ(part_errors("white = 1\nLanguagePart { count: whit + white }"),
            "2:23: 'whit' is not defined (did you mean 'white'?)");
  EXPECT_EQ(part_errors("a = 1\n  a = 2\nLanguagePart { count: a }"), "2:3: 'a' is already defined at line 1:1");
  EXPECT_EQ(part_errors("a = b\nb = c\nc = a\nLanguagePart { count: b }"), "1:5: 'b' is defined by itself: b → c → a → b");
  EXPECT_EQ(part_errors("a = LanguagePart { child: a }\nLanguagePart { child: a }"), "1:27: 'a' is defined by itself: a → a");
  EXPECT_EQ(part_errors("a = 1 m + 1\nLanguagePart { count: a, length: a }"), "1:9: cannot add a length to a plain number");
  EXPECT_EQ(part_errors("pi = 3\nLanguagePart {}"), "1:1: 'pi' is reserved and cannot be defined");
  EXPECT_EQ(part_errors("LanguagePart { child: LanguageConstant }"),
            "1:23: 'LanguageConstant' is a class: write LanguageConstant {}");
  EXPECT_EQ(part_errors("LanguagePart { color: rgb }"), "1:23: 'rgb' is a function: write rgb(…)");
}

TEST(Language, UnusedNamesAreCheckedAndWarnedOf) {
  EXPECT_EQ(part_errors("a = nothing\nLanguagePart {}"), "1:5: 'nothing' is not defined");
  testing::internal::CaptureStderr();
  part("lonely_name_1 = 1\nused = 2\nLanguagePart { count: used }");
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("text:1:1: warning: 'lonely_name_1' is defined but not used"), std::string::npos) << said;
  EXPECT_EQ(said.find("'used'"), std::string::npos);
}

TEST(Language, ParamsAreReplaced) {
  const std::string text = "param seed = 1\nparam name = \"a\"\nparam mode = 2 + seed\n" + job_with("seed: seed + mode");
  const auto seed = [&](const LoadOptions& options) { return load_job_text(text, "params", {}, options)->seed; };
  EXPECT_EQ(seed({}), 4u);
  EXPECT_EQ(seed({{{"seed", "10"}}}), 22u);
  EXPECT_EQ(seed({{{"mode", "2 * 3"}, {"name", "bare words, even \"these\""}}}), 7u);
  const auto errors = [&](const LoadOptions& options) { return job_errors(text, options); };
  EXPECT_EQ(errors({{{"sed", "1"}}}), "there is no param 'sed' (did you mean 'seed'?)");
  EXPECT_EQ(errors({{{"seed", "1"}, {"seed", "2"}}}), "'seed' is given a value twice");
  EXPECT_EQ(errors({{{"seed", "1 +"}}}), "1:4: expected a value, not the end of the text");
  EXPECT_EQ(job_errors("s = 1\n" + job_with("seed: s"), {{{"s", "2"}}}), "'s' is not a param: only those can be replaced");
  try {
    load_job_text(text, "params", {}, {{{"seed", "what"}}});
    ADD_FAILURE();
  } catch (const Errors& e) {
    EXPECT_EQ(show(e.errors.front()), "-D seed:1:1: 'what' is not defined\n    1 | what\n      | ^");
  }
}

// ---- components -----------------------------------------------------------------------------------------------------

TEST(Language, ComponentErrors) {
  EXPECT_EQ(part_errors("LanguagePart { cout: 4 }"), "1:16: LanguagePart has no member 'cout' (did you mean 'count'?)");
  EXPECT_EQ(part_errors("LanguagPart { count: 4 }"), "1:1: there is no class 'LanguagPart' (did you mean 'LanguagePart'?)");
  EXPECT_EQ(part_errors("LanguagePart { count: 4, flag: true\n count: 5 }"), "2:2: 'count' is already set at line 1:16");
  EXPECT_EQ(part_errors("LanguageNeedy {}"), "1:1: LanguageNeedy needs 'source'");
  EXPECT_EQ(part("LanguagePart { child: LanguageNeedy { source: \"x\" } }")->child->class_info().name, "LanguageNeedy");
  EXPECT_EQ(part_errors("LanguagePart { count: 4000 }"), "1:23: LanguagePart.count must be from 0 to 1000, not 4000");
  EXPECT_EQ(part_errors("LanguagePart { count: 1.5 }"), "1:23: LanguagePart.count expects a whole number, not 1.5");
  EXPECT_EQ(part_errors("LanguagePart { length: 3 K }"), "1:24: LanguagePart.length expects a length [m], not a temperature");
  EXPECT_EQ(part_errors("x = \"s\"\nLanguagePart { length: x }"), "2:24: LanguagePart.length expects a number, not a string");
  EXPECT_EQ(part_errors("LanguagePart { child: \"s\" }").substr(0, 6), "1:23: ");
}

TEST(Language, FindsManyErrorsInOneRun) {
  EXPECT_EQ(part_errors("a = LanguagePart { cout: 1, count: wrong, length: 1 K }\n"
                        "b = = 2\n"
                        "LanguagePart { child: a, count: b, parts: [ LanguagePart { flag: 1 }, LanguagePat { x: y } ],\n"
                        "  mode 3, title: \"open\n"
                        "  uv: [1, 2 }\n"),
            "1:20: LanguagePart has no member 'cout' (did you mean 'count'?)\n"
            "1:36: 'wrong' is not defined\n"
            "1:51: LanguagePart.length expects a length [m], not a temperature\n"
            "2:5: expected a value, not '='\n"
            "3:66: LanguagePart.flag expects true or false, not a number\n"
            "3:71: there is no class 'LanguagePat' (did you mean 'LanguagePart'?)\n"
            "4:8: expected ':' after the member name 'mode', not '3'\n"
            "4:18: the string is not closed in its line: a '\"' is missing\n"
            "5:13: expected ',' or ']', not '}'");
  std::string many = "LanguagePart {\n";
  for (int i = 0; i < 100; ++i) many += "  wrong" + std::to_string(i) + ": 1\n";
  try {
    parse_component(many + "}");
    ADD_FAILURE();
  } catch (const Errors& e) {
    EXPECT_EQ(e.errors.size(), 50u);
  }
}

TEST(Language, SyntaxErrors) {
  EXPECT_EQ(part_errors("LanguagePart { count: 1 length: 2 }"), "1:25: expected ',' or a new line before 'length'");
  EXPECT_EQ(part_errors("LanguagePart { flag: true count: 2 }"),
            "1:27: expected ',' or a new line before the next member, not 'count'");
  EXPECT_EQ(part_errors("LanguagePart { count: }"), "1:23: expected a value, not '}'");
  EXPECT_EQ(part_errors("LanguagePart {\n count: 1"), "1:14: '{' is never closed");
  EXPECT_EQ(part_errors("LanguagePart {\n indices: [1, 2"), "2:11: '[' is never closed");
  EXPECT_EQ(part_errors("LanguagePart {} }"), "1:17: expected a new line or ';' after the statement, not '}'");
  EXPECT_EQ(part_errors("LanguagePart { count: 1 @ }"), "1:25: unexpected character '@'");
  EXPECT_EQ(part_errors("LanguagePart { title: \"ä\\q\" }"), "1:25: unknown escape in a string; there are \\\" \\\\ \\n \\t");
  EXPECT_EQ(part_errors("pram x = 1\nLanguagePart { count: x }"),
            "1:1: unknown statement 'pram' (did you mean 'param'?)\n2:23: 'x' is not defined");
  EXPECT_EQ(part_errors("white LanguagePart {}\nLanguagePart { child: white }"),
            "1:7: expected '=' or '{' after 'white', not 'LanguagePart'");
  EXPECT_EQ(part_errors("3\nLanguagePart {}"),
            "1:1: expected a statement (name = value, param, include, plugin, class or a component), not '3'");
  EXPECT_EQ(part_errors("include 3\nLanguagePart {}"), "1:9: expected the file to include, in quotes, not '3'");
  EXPECT_EQ(value_errors("1 2"), "1:3: expected the end of the expression, not '2'");
  EXPECT_EQ(value_errors(""), "1:1: expected a value, not the end of the text");
  EXPECT_EQ(value_errors("(1"), "1:1: '(' is never closed");
  EXPECT_EQ(value_errors("(1, 2)"), "1:3: expected ')', not ','");
}

TEST(Language, JobErrors) {
  EXPECT_EQ(job_errors(""), "there is no Job: a render description needs one Job { … }");
  EXPECT_EQ(job_errors("# nothing\n"), "there is no Job: a render description needs one Job { … }");
  const std::string job = job_with("seed: 1");
  EXPECT_EQ(job_errors(job + "\n" + job), "2:1: there is a Job already, at line 1:1");
  EXPECT_EQ(job_errors("LanguagePart {}\n" + job),
            "1:1: only the Job needs no name; give this component one: name = LanguagePart { … }");
  EXPECT_EQ(job_errors("Jbo {}"),
            "1:1: only the Job needs no name (did you mean 'Job'?); give this component one: name = Jbo { … }\n"
            "1:1: there is no class 'Jbo' (did you mean 'Job'?)");
  EXPECT_EQ(load_job_text(job_with("seed: 12"), "text")->seed, 12u);
}

TEST(Language, TextIsUtf8) {
  EXPECT_EQ(part("\xEF\xBB\xBFLanguagePart { title: \"日本\" }")->title, "日本");
  EXPECT_EQ(part_errors("\xEF\xBB\xBFx"), "1:2: expected '=' or '{' after 'x', not the end of the text");
  EXPECT_EQ(part_errors("LanguagePart { title: \"日本\", cout: 1 }"),
            "1:29: LanguagePart has no member 'cout' (did you mean 'count'?)");
  EXPECT_EQ(part_errors("\nä\xFF"), "2:2: the text is not valid UTF-8: byte 0xFF");
  for (const char* wrong : {"\x80", "\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82"})
    EXPECT_NE(part_errors(std::string("# ") + wrong).find("not valid UTF-8"), std::string::npos);
  EXPECT_EQ(part_errors("LanguagePart { ä: 1 }"), "1:16: unexpected character 'ä'");
  EXPECT_EQ(part("LanguagePart {\r\n  count: 4\r\n  length: 2\r\n}\r\n")->length, 2);
}

TEST(Language, DepthIsBounded) {
  for (const std::string open : {"[", "(", "-", "sqrt(", "LanguagePart{child:", "translate(["}) {
    std::string deep;
    for (int i = 0; i < 100000; ++i) deep += open;
    EXPECT_NE(value_errors(deep).find("too deeply nested: more than 256 levels"), std::string::npos) << open;
  }
  std::string sum = "1", chain = "n0 = LanguagePart {}\n", forward = "n0 = LanguagePart {}\n";
  for (int i = 1; i < 100000; ++i) sum += "+1";
  EXPECT_EQ(number(sum), 100000);
  for (int i = 1; i < 20000; ++i) {
    const std::string line = "n" + std::to_string(i) + " = LanguagePart { child: n" + std::to_string(i - 1) + " }\n";
    chain += line;
    forward.insert(0, line);
  }
  for (const auto& text : {chain, forward})
    EXPECT_NE(part_errors(text + "LanguagePart { child: n19999 }").find("nested too deeply"), std::string::npos);
}

// ---- files ----------------------------------------------------------------------------------------------------------

TEST(Language, IncludesShareOneNamespace) {
  const Folder folder;
  folder.write("sub/common.etd", "include \"../other.etd\"\nred = LanguagePart { file: \"red.ply\", count: n }\n");
  folder.write("other.etd", "n = 5\n");
  const std::string text = "include \"sub/common.etd\"\ninclude \"other.etd\"\nLanguagePart { child: red, file: \"me.ply\" }";
  const auto p = part(text, folder.path());
  EXPECT_EQ(p->child->count, 5);
  EXPECT_EQ(p->file.resolved(), folder.path() + "/me.ply");
  EXPECT_EQ(std::filesystem::path(p->child->file.resolved()).lexically_normal(),
            std::filesystem::path(folder.path()) / "sub/red.ply");

  folder.write("a.etd", "include \"b.etd\"\n" + job_with("seed: 1"));
  folder.write("b.etd", "\n  include \"a.etd\"\n");
  try {
    load_job(folder.path() + "/a.etd");
    ADD_FAILURE();
  } catch (const Errors& e) {
    const std::string a = folder.path() + "/a.etd", b = folder.path() + "/b.etd";
    ASSERT_EQ(e.errors.size(), 1u);
    EXPECT_STREQ(e.what(), ("the file includes itself: " + a + " → " + b + " → " + a).c_str());
    EXPECT_EQ(e.errors[0].location, (Location{intern(b), 2, 11}));
    EXPECT_EQ(show(e.errors[0]), b + ":2:11: " + e.what() + "\n    2 |   include \"a.etd\"\n      |           ^");
  }
}

TEST(Language, FileErrors) {
  const Folder folder;
  EXPECT_EQ(errors_of([&] { load_job(folder.path() + "/none.etd"); }),
            "cannot read '" + folder.path() + "/none.etd': No such file or directory");
  EXPECT_EQ(errors_of([&] { load_job(folder.path()); }), "cannot read '" + folder.path() + "': it is a folder");
  EXPECT_EQ(errors_of([&] { parse_component("include \"none.etd\"\nLanguagePart { count: unknown }", "text", folder.path()); }),
            "1:9: cannot read '" + folder.path() + "/none.etd': No such file or directory");
  EXPECT_NE(job_errors("plugin \"./none.so\"\n" + job_with("seed: 1")).find("1:8: "), std::string::npos);
  LoadOptions closed;
  closed.allow_files = false;
  EXPECT_EQ(job_errors("include \"a\"\nplugin \"b\"\nc = spectrum(\"d\")\n" + job_with("seed: 1"), closed),
            "1:9: files are not allowed here\n2:8: plugins are not allowed here\n3:14: files are not allowed here");
  EXPECT_EQ(load_job(folder.write("good.etd", job_with("seed: 9")))->seed, 9u);
}

// ---- messages -------------------------------------------------------------------------------------------------------

TEST(Language, ShowsTheLineWithACaret) {
  const auto shown = [](const std::string& text) {
    try {
      parse_component(text, "shown.etd");
    } catch (const Errors& e) {
      return show(e.errors.front());
    }
    return std::string();
  };
  EXPECT_EQ(shown("\n\tLanguagePart { cout: 4 }\r\n"),
            "shown.etd:2:17: LanguagePart has no member 'cout' (did you mean 'count'?)\n    2 |  LanguagePart { cout: 4 }\n    "
            "  |                 ^");
  const std::string long_line =
      shown("LanguagePart { title: \"" + std::string(500, 'x') + "é\", cout: 4, title: \"" + std::string(500, 'y') + "\" }");
  const size_t line = long_line.find("\n    1 | …");
  ASSERT_NE(line, std::string::npos) << long_line;
  EXPECT_LT(long_line.size(), 500u);
  // The caret stands under the first letter of the name.
  const std::string second = long_line.substr(line + 1, long_line.find('\n', line + 1) - line - 1);
  const std::string third = long_line.substr(long_line.rfind('\n') + 1);
  const size_t bytes_more = 2 + 1;  // of "…" and "é"
  EXPECT_EQ(second.find("cout"), third.find('^') + bytes_more) << long_line;
  EXPECT_EQ(show(Error("no place")), "no place");
  EXPECT_EQ(show(Error("no line", {intern("f.etd"), 0, 0})), "f.etd: no line");
  EXPECT_EQ(show(Error("no such line", {intern("shown.etd"), 99, 1})), "shown.etd:99:1: no such line");
}

}  // namespace
}  // namespace etendue::language_test
