// Light path expressions and their automaton: what matches, compared with a matcher of another kind; both directions agree;
// mistakes are told with their place, whatever the text.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <random>

#include "etendue/core/error.h"
#include "etendue/paths/path_automaton.h"

namespace etendue {
namespace {

/// An event of a test path: its kind and the class of its labels.
struct TestEvent {
  PathEvent event;
  int label_class = 0;
};
using TestPath = std::vector<TestEvent>;

/// A path from text: "C RD TS L", with a digit for the class of labels: "C RD1 L2".
TestPath path_of(const std::string& text) {
  TestPath path;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == ' ') continue;
    TestEvent e{};
    switch (text[i]) {
      case 'C': e.event = PathEvent::camera; break;
      case 'V': e.event = PathEvent::volume; break;
      case 'L': e.event = PathEvent::light; break;
      case 'B': e.event = PathEvent::background; break;
      case 'O': e.event = PathEvent::emission; break;
      default: {
        const bool reflected = text[i++] == 'R';
        e.event = text[i] == 'D'   ? (reflected ? PathEvent::diffuse_reflection : PathEvent::diffuse_transmission)
                  : text[i] == 'G' ? (reflected ? PathEvent::glossy_reflection : PathEvent::glossy_transmission)
                                   : (reflected ? PathEvent::specular_reflection : PathEvent::specular_transmission);
      }
    }
    if (i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9') e.label_class = text[++i] - '0';
    path.push_back(e);
  }
  return path;
}

PathAutomaton::Matches forward(const PathAutomaton& a, const TestPath& path) {
  PathAutomaton::State state = PathAutomaton::after_camera;
  for (size_t i = 1; i + 1 < path.size(); ++i) state = a.scattered(state, path[i].event, path[i].label_class);
  return a.ended(state, path.back().event, path.back().label_class);
}

/// Expects that a path cut at any vertex gives the same.
void expect_joined(const PathAutomaton& a, const TestPath& path) {
  const PathAutomaton::Matches whole = forward(a, path);
  PathAutomaton::State rest = a.end(path.back().event, path.back().label_class);
  for (size_t cut = path.size() - 1; cut > 0; --cut) {
    PathAutomaton::State first = PathAutomaton::after_camera;
    for (size_t i = 1; i < cut; ++i) first = a.scattered(first, path[i].event, path[i].label_class);
    EXPECT_EQ(a.joined(first, rest), whole) << "cut at " << cut;
    if (cut > 1) rest = a.scattered_before(rest, path[cut - 1].event, path[cut - 1].label_class);
  }
}

struct Compiled {
  PathLabelNames names;
  std::vector<PathExpression> expressions;
  PathAutomaton automaton;
  explicit Compiled(const std::vector<std::string>& texts, const std::vector<std::vector<std::string>>& classes = {{}}) {
    for (const std::string& text : texts) expressions.emplace_back(text, names);
    std::vector<PathLabels> sets;
    for (const auto& labels : classes) {
      PathLabels set = 0;
      for (const std::string& label : labels) set |= PathLabels(1) << names.index(label);
      sets.push_back(set);
    }
    automaton = PathAutomaton(expressions, sets);
  }
};

bool matches(const std::string& expression, const std::string& path,
             const std::vector<std::vector<std::string>>& classes = {{}}) {
  const Compiled c({expression}, classes);
  expect_joined(c.automaton, path_of(path));
  return forward(c.automaton, path_of(path)) == 1;
}

TEST(PathExpressions, MatchAsTheirGrammarSays) {
  EXPECT_TRUE(matches("CL", "C L"));
  EXPECT_FALSE(matches("CL", "C RD L"));
  EXPECT_FALSE(matches("CL", "C B"));
  EXPECT_TRUE(matches("C<RD>L", "C RD L"));
  EXPECT_FALSE(matches("C<RD>L", "C TD L"));
  EXPECT_TRUE(matches("C<RD>.*L", "C RD L"));
  EXPECT_TRUE(matches("C<RD>.*L", "C RD TS RG V L"));
  EXPECT_FALSE(matches("C<RD>.*L", "C RG RD L"));
  EXPECT_TRUE(matches("CD+S*L", "C TD RD TS RS L"));
  EXPECT_FALSE(matches("CD+S*L", "C TS RD L"));
  EXPECT_TRUE(matches("C<RD>S+L", "C RD TS TS L"));
  EXPECT_FALSE(matches("C<RD>S+L", "C RD L"));
  EXPECT_TRUE(matches("C[LBO]", "C B"));
  EXPECT_TRUE(matches("C.*[LBO]", "C V V O"));
  EXPECT_TRUE(matches("C[^D]*L", "C RG TS V L"));
  EXPECT_FALSE(matches("C[^D]*L", "C RG TD L"));
  EXPECT_TRUE(matches("C<[RT][^D]>L", "C TG L"));
  EXPECT_FALSE(matches("C<[RT][^D]>L", "C TD L"));
  EXPECT_FALSE(matches("C<[RT][^D]>L", "C V L"));
  EXPECT_TRUE(matches("C<.S>{2}L", "C RS TS L"));
  EXPECT_FALSE(matches("C<.S>{2}L", "C RS TS TS L"));
  EXPECT_TRUE(matches("CS{1,3}L", "C RS TS TS L"));
  EXPECT_FALSE(matches("CS{1,3}L", "C RS TS TS RS L"));
  EXPECT_TRUE(matches("CS{2,}L", "C RS TS TS RS L"));
  EXPECT_FALSE(matches("CS{2,}L", "C RS L"));
  EXPECT_TRUE(matches("CG?L", "C L"));
  EXPECT_TRUE(matches("C(DS)*L", "C RD TS RD RS L"));
  EXPECT_FALSE(matches("C(DS)*L", "C RD TS RD L"));
  EXPECT_TRUE(matches("C D|G L", "C RG L")) << "'|' binds more strongly than a sequence";
  EXPECT_TRUE(matches("C(DD)|(GG)L", "C RG RG L"));
  EXPECT_FALSE(matches("C(DD)|(GG)L", "C RD RG L"));
  EXPECT_TRUE(matches("C(D*|G*)*L", "C RD RG RD L"));
  EXPECT_TRUE(matches("CV<.x>L", "C V V L"));
  EXPECT_FALSE(matches("CV<.x>L", "C V RD L"));
}

TEST(PathExpressions, KnowLabels) {
  const std::vector<std::vector<std::string>> classes = {{}, {"wall"}, {"key"}, {"wall", "key"}};
  EXPECT_TRUE(matches("C<RD'wall'><L.'key'>", "C RD1 L2", classes));
  EXPECT_TRUE(matches("C<RD'wall'><L'key'>", "C RD3 L3", classes));
  EXPECT_FALSE(matches("C<RD'wall'><L.'key'>", "C RD L2", classes));
  EXPECT_FALSE(matches("C<RD'wall'><L.'key'>", "C RD1 L1", classes));
  EXPECT_TRUE(matches("C'wall'L", "C TS1 L", classes));
  EXPECT_TRUE(matches("C.<L.[^'key']>", "C RD L1", classes));
  EXPECT_FALSE(matches("C.<L.[^'key']>", "C RD L2", classes));
  EXPECT_TRUE(matches("C.<L.['wall''key']>", "C RD L2", classes));
  EXPECT_TRUE(matches("C[^'wall']*L", "C RD2 TS L1", classes)) << "the end is no part of the repetition";
  EXPECT_FALSE(matches("C[^'wall']*L", "C RD2 TS1 L", classes));
  EXPECT_TRUE(matches("C<.D'wall''key'>L", "C RD3 L", classes));
  EXPECT_FALSE(matches("C<.D'wall''key'>L", "C RD1 L", classes));
}

// Several expressions in one automaton; those that divide all paths match each path once.
TEST(PathExpressions, DividePaths) {
  const Compiled c({"C[LBO]", "C<.D>[LBO]", "C<.[^D]>[LBO]", "C.{2,}[LBO]", "C.*L"});
  std::mt19937 numbers(1);
  for (int i = 0; i < 2000; ++i) {
    TestPath path{{PathEvent::camera}};
    for (unsigned n = numbers() % 6; n > 0; --n) path.push_back({PathEvent(1 + numbers() % 7)});
    path.push_back({PathEvent(8 + numbers() % 3)});
    const PathAutomaton::Matches found = forward(c.automaton, path);
    EXPECT_EQ(std::popcount(found & 15u), 1);
    EXPECT_EQ((found & 16u) != 0, path.back().event == PathEvent::light);
    expect_joined(c.automaton, path);
  }
}

// ---- another matcher: the derivative of the syntax tree, by brute force
// ----------------------------------------------------------

/// The ends of all parts of a path that begin at `from` and match a node.
std::vector<size_t> ends(const PathExpression& e, int index, const TestPath& path, const std::vector<PathLabels>& classes,
                         const std::vector<size_t>& from, int depth = 0) {
  const PathExpression::Node& node = e.nodes()[size_t(index)];
  const auto merge = [](std::vector<size_t>& a, const std::vector<size_t>& b) {
    a.insert(a.end(), b.begin(), b.end());
    std::ranges::sort(a);
    a.erase(std::unique(a.begin(), a.end()), a.end());
  };
  std::vector<size_t> found;
  switch (node.kind) {
    case PathExpression::Node::Kind::event:
      for (const size_t at : from)
        if (at < path.size() && e.tests()[size_t(node.test)].matches(path[at].event, classes[size_t(path[at].label_class)]))
          found.push_back(at + 1);
      return found;
    case PathExpression::Node::Kind::sequence:
      found = from;
      for (const int part : node.parts) found = ends(e, part, path, classes, found, depth + 1);
      return found;
    case PathExpression::Node::Kind::choice:
      for (const int part : node.parts) merge(found, ends(e, part, path, classes, from, depth + 1));
      return found;
    case PathExpression::Node::Kind::repeated: {
      std::vector<size_t> now = from;
      if (node.least == 0) merge(found, now);
      const int most = node.most < 0 ? node.least + int(path.size()) : node.most;
      for (int i = 1; i <= most && !now.empty(); ++i) {
        now = ends(e, node.parts[0], path, classes, now, depth + 1);
        if (i >= node.least) merge(found, now);
      }
      return found;
    }
  }
  return found;
}

// 10^5 texts, made by changing expressions character by character: either an error that tells the place, or an automaton that
// agrees with brute force on random paths. Time and states are bounded.
TEST(PathExpressions, MayBeAnyText) {
  const std::vector<std::string> good = {"C<RD>.*L",           "C<RD>S+L",       "C[^D]*[LBO]",     "C(D|G){1,3}<L.'key'>",
                                         "C<.S'glass'>{2}D*B", "CD+S*L",         "C.*<L.[^'key']>", "C<[RT][DG]>?V*O",
                                         "C(DS)*|(SD)*L",      "C.{2,}<L'key'>", "C'wall'.*.*L",    "C(((D*)*)*)+S{3}L"};
  const std::string letters = "CRTVLBODGSsx.<>[]()^|*+?{},'0123456789 keywall\xff";
  const std::vector<PathLabels> classes = {0, 1, 2, 3};
  std::mt19937 numbers(7);
  int fine = 0, refused = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 100000; ++i) {
    std::string text = good[numbers() % good.size()];
    for (unsigned n = 1 + numbers() % 4; n > 0; --n) {
      const size_t at = numbers() % (text.size() + 1);
      const char c = letters[numbers() % letters.size()];
      switch (numbers() % 4) {
        case 0: text.insert(at, 1, c); break;
        case 1:
          if (at < text.size()) text.erase(at, 1 + numbers() % 3);
          break;
        case 2:
          if (at < text.size()) text[at] = c;
          break;
        case 3: text.insert(at, text.substr(numbers() % (text.size() + 1), numbers() % 8)); break;
      }
    }
    PathLabelNames names;
    std::vector<PathExpression> one;
    try {
      one.emplace_back(text, names);
    } catch (const Error& e) {
      ++refused;
      EXPECT_NE(std::string(e.what()).find(", character "), std::string::npos) << text << ": " << e.what();
      continue;
    }
    PathAutomaton automaton;
    try {
      automaton = PathAutomaton(one, classes);
    } catch (const Error&) {
      ++refused;
      continue;
    }
    ++fine;
    EXPECT_LE(automaton.forward_states(), 1024u);
    EXPECT_LE(automaton.backward_states(), 1024u);
    for (int n = 0; n < 3; ++n) {
      TestPath path{{PathEvent::camera}};
      for (unsigned k = numbers() % 5; k > 0; --k) path.push_back({PathEvent(1 + numbers() % 7), int(numbers() % 4)});
      path.push_back({PathEvent(8 + numbers() % 3), int(numbers() % 4)});
      const std::vector<size_t> found = ends(one[0], one[0].root(), path, classes, {0});
      const bool expected = std::ranges::find(found, path.size()) != found.end();
      EXPECT_EQ(forward(automaton, path) == 1, expected) << text;
      expect_joined(automaton, path);
    }
  }
  EXPECT_GT(fine, 10000);
  EXPECT_GT(refused, 20000);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
}

std::string refusal(const std::string& text) {
  try {
    const Compiled c({text});
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(PathExpressions, TellWhereMistakesAre) {
  for (const auto& [text, place] :
       {std::pair("C<RQ>L", "character 4"), std::pair("C<RD L", "character 6"), std::pair("C<RD", "character 2"),
        std::pair("CD)L", "character 3"), std::pair("C(DL", "character 2"), std::pair("C*+", "matches no path"),
        std::pair("CD{2L", "character 5"), std::pair("CD{3,1}L", "character 3"), std::pair("C<Ts>L", "straight"),
        std::pair("C[]L", "character 2"), std::pair("C'key L", "character 2"), std::pair("", "character 1"),
        std::pair("*L", "repeats nothing"), std::pair("C<VD>L", "no event of this type"),
        std::pair("C<DR>L", "the type comes before"), std::pair("CD|L|", "character 6"), std::pair("DL", "matches no path"),
        std::pair("C<RD>", "matches no path"), std::pair("LDC", "matches no path")})
    EXPECT_NE(refusal(text).find(place), std::string::npos) << text << ": " << refusal(text);
}

// What would take too much is refused soon.
TEST(PathExpressions, HaveBounds) {
  const auto begin = std::chrono::steady_clock::now();
  for (const char* text : {"C(.*D.{20})L", "C(((D{1000}){1000}){1000})L", "C((((D?){30}){30}){30})L", "C(()){3}L",
                           "C(D*){2000}L", "C(.|D|G|S){300}L"})
    EXPECT_FALSE(refusal(text).empty()) << text;
  EXPECT_FALSE(refusal("C" + std::string(5000, '(') + "D" + std::string(5000, ')') + "L").empty());
  EXPECT_FALSE(refusal("C" + std::string(20000, 'D') + "L").empty());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

}  // namespace
}  // namespace etendue
