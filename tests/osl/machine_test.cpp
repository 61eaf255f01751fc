// Machine code and the interpreter of the shading language give the same numbers, to the bit.

#include "osl/running/machine.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <thread>

#include "osl/language/compile.h"
#include "osl/running/point_memory.h"
#include "osl/running/shader_group.h"
#include "random_shader.h"

namespace etendue::osl {
namespace {

class Recorder final : public Services {
 public:
  void print(std::string_view text) override { said += text; }
  void warn(std::string_view text, Location) override { said += std::string(text) + "\n"; }
  void error(std::string_view text, Location) override { said += std::string(text) + "\n"; }
  void* allocate(std::size_t size, std::size_t alignment) override { return memory.allocate(size, alignment); }

  std::string said;
  PointMemory memory;
};

Globals point(int i) {
  const float x = 0.13f * float(i % 4), y = 0.21f * float(i / 4);
  Globals g;
  g.u = {x, 0.01f, 0};
  g.v = {y, 0, 0.02f};
  g.P = {{2 * x - 0.3f, y, 1 - x * y}, {0.5f, 0, -y}, {0, 0.5f, -x}};
  g.I.value = {0.1f, -0.2f, -0.97f};
  g.N.value = g.Ng.value = {0, 0.6f, 0.8f};
  g.dPdu.value = {1, 0, 0};
  g.dPdv.value = {0, 1, 0};
  return g;
}

/// Not-a-number is one number; its sign is not printed either.
std::string without_signs_of_nan(std::string text) {
  for (std::size_t at; (at = text.find("-nan")) != std::string::npos;) text.erase(at, 1);
  return text;
}

/// What a run leaves: the values of outputs with their derivatives, the closure, and what was said.
std::string results(const ShaderGroup& group, const std::vector<Memory>& outputs, int i) {
  Recorder services;
  Globals globals = point(i);
  std::string text;
  Execution& execution = group.execution();
  try {
    execution.run(globals, services);
  } catch (const Error& e) {
    return e.what();
  }
  for (const Memory& m : outputs) {
    const std::byte* at = execution.value(m);
    if (m.type.base == Base::string) {
      text += (*reinterpret_cast<const String* const*>(at))->text() + "; ";
      continue;
    }
    for (int block = 0; block < (m.stride ? 3 : 1); ++block)
      for (std::size_t k = 0; k < m.type.size() / 4; ++k) {
        std::uint32_t bits;
        std::memcpy(&bits, at + std::size_t(block) * m.stride + 4 * k, 4);
        const float number = std::bit_cast<float>(bits);
        text += std::isnan(number) ? "nan " : fmt::format("{:08x} ", bits);
      }
    text += "; ";
  }
  return without_signs_of_nan(text + to_text(globals.Ci) + services.said);
}

std::shared_ptr<const ShaderGroup> group_of(const Compiled& compiled, const std::string& text) {
  if (compiled.failed()) {
    ADD_FAILURE() << to_text(compiled.diagnostics) << "\n" << text;
    return nullptr;
  }
  GroupDescription description;
  description.name = "random";
  description.layers.push_back({"random", "layer", {}, {}});
  GroupOptions options;
  options.load = [&](const std::string&, Location) { return compiled.shader; };
  options.output_derivatives = true;
  for (const Symbol* parameter : compiled.shader->parameters)
    if (parameter->role == Symbol::Role::output) options.outputs.push_back(parameter->name);
  std::vector<GroupProblem> problems;
  auto group = ShaderGroup::build(description, options, problems);
  for (const GroupProblem& problem : problems) ADD_FAILURE() << problem.text << "\n" << text;
  return group;
}

std::shared_ptr<const ShaderGroup> group_of(const std::string& text) {
  return group_of(compile_text(text, "random.osl"), text);
}

std::vector<Memory> outputs_of(const ShaderGroup& group) {
  std::vector<Memory> memory;
  for (const Symbol* parameter : group.shader(0).parameters)
    if (parameter->role == Symbol::Role::output) memory.push_back(*group.find_parameter(0, parameter->name));
  return memory;
}

/// Both ways at some points. False: they differ.
bool agree(const std::shared_ptr<const ShaderGroup>& group, const std::string& text) {
  if (!group) return false;
  const std::vector<Memory> outputs = outputs_of(*group);
  constexpr int points = 12;
  std::vector<std::string> interpreted;
  for (int i = 0; i < points; ++i) interpreted.push_back(results(*group, outputs, i));
  group->compile();
  for (int i = 0; i < points; ++i) {
    const std::string compiled = results(*group, outputs, i);
    EXPECT_EQ(interpreted[std::size_t(i)], compiled) << "at point " << i << " of\n" << text;
    if (interpreted[std::size_t(i)] != compiled) return false;
  }
  return true;
}

#define ETENDUE_NEEDS_MACHINE \
  if (!machine()) GTEST_SKIP() << "built without LLVM"

// ETENDUE_OSL_SHADERS tells how many, ETENDUE_OSL_FIRST the first seed, for longer runs.
TEST(OslMachine, AgreesWithTheInterpreterOnRandomShaders) {
  ETENDUE_NEEDS_MACHINE;
  const char *count = std::getenv("ETENDUE_OSL_SHADERS"), *first = std::getenv("ETENDUE_OSL_FIRST");
  const unsigned begin = first ? unsigned(std::atoi(first)) : 1, end = begin + unsigned(count ? std::atoi(count) : 200);
  int wrong = 0;
  for (unsigned seed = begin; seed < end && wrong < 3; ++seed) {
    const std::string text = RandomShader(seed).text();
    if (!agree(group_of(text), text)) {
      ++wrong;
      ADD_FAILURE() << "seed " << seed;
    }
  }
}

TEST(OslMachine, AgreesWithTheInterpreterOnTheExamples) {
  ETENDUE_NEEDS_MACHINE;
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(ETENDUE_SOURCE_DIR "/scenes/osl")) {
    if (entry.path().extension() != ".osl") continue;
    const std::string name = entry.path().string();
    EXPECT_TRUE(agree(group_of(compile_file(name, {}), name), name)) << name;
    ++count;
  }
  EXPECT_GE(count, 11);
}

TEST(OslMachine, StopsALoopThatNeverEndsAtItsPlace) {
  ETENDUE_NEEDS_MACHINE;
  const auto group = group_of("surface endless(output float x = 0) {\n  while (1) x += u;\n}\n");
  group->compile();
  Recorder services;
  Globals globals = point(1);
  try {
    group->execution().run(globals, services);
    ADD_FAILURE() << "it ended";
  } catch (const Error& e) {
    EXPECT_EQ(e.location.line, 2);
    EXPECT_NE(std::string(e.what()).find("does not end"), std::string::npos) << e.what();
  }
}

TEST(OslMachine, ARunEndsWhenItsRenderIsAborted) {
  ETENDUE_NEEDS_MACHINE;
  const auto group = group_of("surface endless(output float x = 0) { while (1) x += u; }");
  group->compile();
  Recorder services;
  Globals globals = point(1);
  const std::atomic<bool> abort = true;
  EXPECT_FALSE(group->execution().run(globals, services, &abort));
}

TEST(OslMachine, WhatRunsOftenIsCompiledMeanwhile) {
  ETENDUE_NEEDS_MACHINE;
  if (execution_mode() != Execute::automatic) GTEST_SKIP() << "ETENDUE_OSL is set";
  const std::string text = "surface often(output float x = 0) { for (int i = 0; i < 5; ++i) x += noise(\"perlin\", u * i); }";
  const auto group = group_of(text), other = group_of(text);
  const std::vector<Memory> outputs = outputs_of(*group);
  std::vector<std::string> expected;
  for (int i = 0; i < 12; ++i) expected.push_back(results(*other, outputs, i));
  EXPECT_FALSE(other->compiled());
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (int t = 0; t < 3; ++t)
    threads.emplace_back([&] {
      for (int n = 0; n < 400 || (!group->compiled() && n < 1'000'000); ++n)
        if (results(*group, outputs, n % 12) != expected[std::size_t(n % 12)]) ++wrong;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_TRUE(group->compiled());
  EXPECT_EQ(wrong, 0);
}

TEST(OslMachine, MemoryIsFreedWhileAGroupWaits) {
  ETENDUE_NEEDS_MACHINE;
  for (int n = 0; n < 6; ++n) {
    const auto group = group_of("surface brief(output float x = 0) { x = sin(u); }");
    const std::vector<Memory> outputs = outputs_of(*group);
    for (int i = 0; i < 300; ++i) results(*group, outputs, i % 12);
  }
}

}  // namespace
}  // namespace etendue::osl
