// Tests of the interpreter of the shading language: small shaders, and what they print or compute.

#include "osl/running/shader_group.h"

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <thread>

#include "osl/language/compile.h"
#include "osl/running/point_memory.h"

namespace etendue::osl {
namespace {

/// Collects what shaders print, and the faults that are reported.
class Recorder final : public Services {
 public:
  void print(std::string_view text) override { printed += text; }
  void warn(std::string_view text, Location) override { faults += std::string(text) + "\n"; }
  void error(std::string_view text, Location) override { faults += std::string(text) + "\n"; }
  void* allocate(std::size_t size, std::size_t alignment) override { return memory.allocate(size, alignment); }

  std::string printed, faults;
  PointMemory memory;
};

/// Shaders by name, and the network of them that a test runs.
struct Network {
  std::map<std::string, std::string> shaders;
  std::string group;
  GroupOptions options;

  std::shared_ptr<const ShaderGroup> build(std::vector<GroupProblem>& problems) {
    options.load = [this](const std::string& name, Location) {
      const Compiled compiled = compile_text(shaders.at(name), name + ".osl");
      EXPECT_FALSE(compiled.failed()) << to_text(compiled.diagnostics);
      return compiled.shader;
    };
    GroupDescription description = parse_group(group, "test");
    description.name = "test_group";
    return ShaderGroup::build(description, options, problems);
  }
};

Globals point() {
  Globals g;
  g.u = {0.25f, 0.5f, 0};
  g.v = {0.75f, 0, 0.5f};
  g.P = {{0.25f, 0.75f, 1}, {0.5f, 0, 0}, {0, 0.5f, 0}};
  g.N.value = g.Ng.value = {0, 0, 1};
  return g;
}

/// What a network prints at one point, with its faults behind.
std::string printed(Network network) {
  std::vector<GroupProblem> problems;
  const auto group = network.build(problems);
  std::string text;
  for (const GroupProblem& problem : problems) text += problem.text + "\n";
  if (!group) return text;
  Recorder recorder;
  Globals globals = point();
  group->execution().run(globals, recorder);
  return text + recorder.printed + recorder.faults;
}

/// The same of a shader with this body.
std::string printed(const std::string& body, const std::string& before = "") {
  return printed(Network{{{"test", before + "\nshader test() {\n" + body + "\n}\n"}}, "shader test layer;", {}});
}

TEST(OslRunning, DerivativesFollowTheRulesOfDifferentiation) {
  EXPECT_EQ(printed("float f = u * u / v; printf(\"%g %g %g\", f, Dx(f), Dy(f));"), "0.0833333 0.333333 -0.0555556");
  EXPECT_EQ(printed("color c = color(u, v, u * v); c[1] = u; printf(\"%g\", Dx(c));"), "0.5 0.5 0.375");
  EXPECT_EQ(printed("float a[2]; a[0] = u; a[1] = v * 2; int i = 1; printf(\"%g %g\", Dy(a[i]), Dx(a[0]));"), "1 0.5");
}

TEST(OslRunning, DivisionByZeroIsZero) {
  EXPECT_EQ(printed("float z = u - 0.25; int i = (int) z; printf(\"%g %g %d %d\", 1 / z, vector(1) / z, 7 / i, 7 % i);"),
            "0 0 0 0 0 0");
}

TEST(OslRunning, AnIndexOutOfRangeIsReportedAndClamped) {
  const std::string text =
      printed("int i = 5; float a[3] = {1, 2, 3}; printf(\"%g\\n\", a[i]); a[i - 7] = 9; printf(\"%g\\n\", a[0]);");
  EXPECT_NE(text.find("3\n9\n"), std::string::npos) << text;
  EXPECT_NE(text.find("Index [5] out of range a[0..2]: test.osl:3 (group test_group, layer 0 layer, shader test)"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("Index [-2] out of range a[0..2]"), std::string::npos) << text;
}

TEST(OslRunning, ArgumentsAreReferences) {
  EXPECT_EQ(printed("float x = 3; f(x, x); printf(\"%g\", x);", "void f(float a, output float b) { b = 1; b += a; }"), "2");
  EXPECT_EQ(printed("float a[3] = {1, 2, 3}; int i = 1; g(a[i], i); printf(\"%g %g %g %d\", a[0], a[1], a[2], i);",
                    "void g(output float x, output int i) { x *= 10; i = 2; }"),
            "1 20 3 2");
  EXPECT_EQ(printed("printf(\"%g\", h(h(h(2))));", "float h(float x) { float y = x + 1; return y * y; }"), "10201");
}

TEST(OslRunning, OperandsAreEvaluatedInOrder) {
  const std::string functions = "int say(string s, int i) { printf(\"%s\", s); return i; }";
  EXPECT_EQ(printed("int i = say(\"a\", 1) + say(\"b\", 2) * say(\"c\", 3); printf(\"%d\", i);", functions), "abc7");
  EXPECT_EQ(printed("if (say(\"a\", 0) && say(\"b\", 1)) printf(\"x\"); if (say(\"c\", 1) || say(\"d\", 1)) printf(\"y\");",
                    functions),
            "acy");
  EXPECT_EQ(printed("int i = 1; int a[3] = {0, 0, 0}; a[i++] = i; printf(\"%d%d%d %d\", a[0], a[1], a[2], i);"), "020 2");
}

TEST(OslRunning, LoopsAndJumps) {
  EXPECT_EQ(printed("for (int i = 0; i < 6; ++i) { if (i == 1) continue; if (i == 4) break; printf(\"%d\", i); }"), "023");
  EXPECT_EQ(printed("int i = 3; do { printf(\"%d\", i); --i; if (i == 1) continue; } while (i > 0);"), "321");
  EXPECT_EQ(
      printed("printf(\"%d!\", f(3));", "int f(int n) { int k = n; while (1) { k += 1; if (k > 5) return k; } return 0; }"),
      "6!");
  EXPECT_EQ(printed("printf(\"a\"); f(); printf(\"b\");", "void f() { printf(\"f\"); exit(); }"), "af");
}

TEST(OslRunning, VariablesWithoutAValueBeginAsZero) {
  EXPECT_EQ(printed("for (int i = 0; i < 2; ++i) { float x; string s; printf(\"%g'%s' \", x, s); x = 1; s = \"t\"; }"),
            "0'' 0'' ");
}

TEST(OslRunning, LayersRunOnceAndOnlyIfTheyAreNeeded) {
  const std::string up =
      "shader up(float k = 1, output float o = 0, output color c = 0)\n{ printf(\"up%g \", k); o = k * u; c = color(1, 2, 3); "
      "}\n";
  const std::string down =
      "shader down(float a = 5, float b = 6, color c = 7, int want = 1)\n{ if (want) printf(\"%g %g %g \", a, c, Dx(a)); }\n";
  EXPECT_EQ(printed(Network{{{"up", up}, {"down", down}},
                            "param float k 2; shader up one; shader up two; shader down last; connect one.o last.a; "
                            "connect one.c[2] last.c[1]; connect two.o last.b;",
                            {}}),
            "up2 0.5 7 3 7 1 ");
  EXPECT_EQ(printed(Network{
                {{"up", up}, {"down", down}}, "shader up one; param int want 0; shader down last; connect one.o last.a;", {}}),
            "");
}

TEST(OslRunning, ConnectionsAreChecked) {
  const std::string up = "shader up(output matrix m = 1, float in = 0) { }",
                    down = "shader down(float a = 0 [[int allowconnect = 0]], float b = 0) { }";
  const auto connected = [&](const std::string& connection) {
    return printed(Network{{{"up", up}, {"down", down}}, "shader up one; shader down two; connect " + connection + ";", {}});
  };
  EXPECT_NE(connected("one.m two.b").find("cannot connect a matrix (m) to a float (b)"), std::string::npos);
  EXPECT_NE(connected("one.m two.a").find("allowconnect=0"), std::string::npos);
  EXPECT_NE(connected("one.nothing two.b").find("\"nothing\" is not a parameter"), std::string::npos);
  EXPECT_NE(connected("two.b one.in").find("has to be declared before"), std::string::npos);
  EXPECT_NE(connected("one.in two.b").find("is not an output"), std::string::npos);
}

TEST(OslRunning, ValuesOfTheWrongTypeAreReported) {
  const std::string shader = "shader test(float b = 1) { printf(\"%g\", b); }";
  EXPECT_EQ(printed(Network{{{"test", shader}}, "param string b \"x\"; shader test layer;", {}}),
            "attempting to set parameter with wrong type: b (expected 'float', received 'string')\n1");
  EXPECT_EQ(printed(Network{{{"test", shader}}, "param float b 2.5; shader test layer;", {}}), "2.5");
}

TEST(OslRunning, MessagesPassFromLayerToLayer) {
  EXPECT_EQ(printed("setmessage(\"m\", color(u, v, 0)); color c; int ok = getmessage(\"m\", c); float f; "
                    "printf(\"%d %g %d\", ok, c, getmessage(\"m\", f));"),
            "1 0.25 0.75 0 0type mismatch for message \"m\" (created as color here: test.osl:3) cannot fetch as float from "
            "test.osl:3\n");
}

TEST(OslRunning, ClosuresAreSumsOfProducts) {
  EXPECT_EQ(printed("Ci = 0.5 * diffuse(N) * color(1, 0.5, 0) + 0 * emission() + emission(); printf(\"%s\", Ci);"),
            "(0.5, 0.25, 0) * diffuse ((0, 0, 1), \"label\", \"\")\n\t+ (1, 1, 1) * emission ()");
}

TEST(OslRunning, AnEndlessLoopStopsWithTheRender) {
  Network network{{{"test", "shader test() { while (1) { } }"}}, "shader test layer;", {}};
  std::vector<GroupProblem> problems;
  const auto group = network.build(problems);
  ASSERT_TRUE(group);
  const std::atomic<bool> abort = true;
  Recorder recorder;
  Globals globals = point();
  EXPECT_FALSE(group->execution().run(globals, recorder, &abort));
}

TEST(OslRunning, AnEndlessLoopIsAnErrorAtItsPlace) {
  Network network{{{"test", "shader test(float k = 0)\n{\n  for (int i = 0; i < 10 + k; i++)\n    while (1) { }\n}"}},
                  "shader test layer;",
                  {}};
  std::vector<GroupProblem> problems;
  const auto group = network.build(problems);
  ASSERT_TRUE(group);
  Recorder recorder;
  Globals globals = point();
  try {
    group->execution().run(globals, recorder);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.location.line, 4);
  }
}

TEST(OslRunning, StepsOfLoopsAreCountedForEachRunAlone) {
  Network network{{{"test", "shader test() { for (int i = 0; i < 3000000; i++) { } }"}}, "shader test layer;", {}};
  std::vector<GroupProblem> problems;
  const auto group = network.build(problems);
  ASSERT_TRUE(group);
  Recorder recorder;
  for (int i = 0; i < 4; ++i) {
    Globals globals = point();
    EXPECT_TRUE(group->execution().run(globals, recorder));
  }
}

TEST(OslRunning, EndlessSumsOfClosuresAreAnError) {
  Network network{{{"test", "shader test() { while (1) Ci += emission(); }"}}, "shader test layer;", {}};
  std::vector<GroupProblem> problems;
  const auto group = network.build(problems);
  ASSERT_TRUE(group);
  Recorder recorder;
  Globals globals = point();
  EXPECT_THROW(group->execution().run(globals, recorder), Error);
}

TEST(OslRunning, TheTextOfAGroupIsReadWithPlaces) {
  const GroupDescription g = parse_group(
      "param float scale 3.5 ; # a comment\nparam string name \"a;b\" [[ int lockgeom=0 ]] ;\nshader \"s\" l1;\nconnect a.x "
      "l1.y[2]",
      "f");
  ASSERT_EQ(g.layers.size(), 1u);
  EXPECT_EQ(g.layers[0].parameters[1].words, std::vector<std::string>{"a;b"});
  EXPECT_TRUE(g.layers[0].parameters[1].interpolated);
  EXPECT_EQ(g.connections[0].to, "y[2]");
  for (const auto& [text, line, column] : {std::tuple("shader a b;\nwrong x;", 2, 1), std::tuple("param float", 1, 12),
                                           std::tuple("connect a b;", 1, 9), std::tuple("param string s \"x", 1, 16)}) {
    try {
      parse_group(text, "f");
      ADD_FAILURE() << text;
    } catch (const Error& e) {
      EXPECT_EQ(e.location.line, line) << text << ": " << e.what();
      EXPECT_EQ(e.location.column, column) << text << ": " << e.what();
    }
  }
}

}  // namespace
}  // namespace etendue::osl
