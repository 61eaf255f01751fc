// Faulty plugins: they are refused with a reason and a remedy, or, when they throw, reported by class and file. None of them
// ends the program.

#include <gtest/gtest.h>

#include <cstdlib>

#include "support/program_support.h"

namespace etendue {
namespace {

class PluginHandshake : public RunsProgram {
 protected:
  void SetUp() override { ::unsetenv("ETENDUE_HOSTILE"); }
  void TearDown() override { ::unsetenv("ETENDUE_HOSTILE"); }

  static std::string library(const std::string& name) { return ETENDUE_HOSTILE_PLUGINS "/lib" + name + ".so"; }
  /// The messages of the program when the plugin misbehaves in a given way while its classes are listed or a scene is rendered
  /// with them.
  std::string listing(const std::string& how) {
    ::setenv("ETENDUE_HOSTILE", how.c_str(), 1);
    EXPECT_EQ(run({"classes", "--plugin", library("hostile")}), 2) << how << ": " << err;
    return err;
  }
  std::string rendering(const std::string& how, const std::string& shader = "HostileShader {}",
                        const std::string& radiance = "1", int expected = 2) {
    const std::string scene =
        "Job { camera: PerspectiveCamera { from: [0, 0, 5], to: [0, 0, 0] }, image: ImageBuffer { width: 8, height: 8 }\n"
        " scene: BruteForceScene { objects: [ Sphere { shader: " +
        shader + " }, Environment { emission: DiffuseEmission { radiance: " + radiance + " } } ] } }";
    folder.write("scene.etd", scene);
    ::setenv("ETENDUE_HOSTILE", how.c_str(), 1);
    EXPECT_EQ(run({"render", "scene.etd", "--samples", "2", "--quiet", "--plugin", library("hostile"), "-o", "x.npy"}),
              expected)
        << how << ": " << err;
    return err;
  }
  /// Compiles a few lines of C++ that do not include Étendue's headers to a library, and loads it as a plugin.
  std::string loading(const std::string& code) {
    const std::string source = folder.write("code.cpp", code), made = folder / "libcode.so";
    EXPECT_EQ(std::system(("c++ -shared -fPIC -w " + source + " -o " + made).c_str()), 0);
    EXPECT_EQ(run({"classes", "--plugin", made}), 2) << err;
    EXPECT_TRUE(has(err, made)) << err;
    return err;
  }
};

TEST_F(PluginHandshake, a_right_one_renders) { EXPECT_EQ(rendering("", "HostileShader {}", "1", 0), ""); }

TEST_F(PluginHandshake, refuses_another_instruction_set_with_the_remedy) {
#if defined(__AVX__)
  EXPECT_EQ(run({"classes", "HostileShader", "--plugin", library("hostile_plain")}), 2) << err;
  EXPECT_TRUE(has(err, library("hostile_plain"))) << err;
  EXPECT_TRUE(has(err, "'spectra in memory', this program is 'spectra in one vector register'")) << err;
  EXPECT_TRUE(has(err, "-march=native")) << err;
#else
  GTEST_SKIP() << "the program itself uses no vector registers that others might not have";
#endif
}

TEST_F(PluginHandshake, two_that_define_one_class_are_an_error_that_names_both) {
  EXPECT_EQ(run({"classes", "--plugin", library("hostile"), "--plugin", library("hostile_twin")}), 2) << err;
  for (const std::string& part : {library("hostile"), library("hostile_twin"), std::string("HostileShader")})
    EXPECT_TRUE(has(err, part)) << part << "\n" << err;
  // Loading the same plugin twice is no error.
  EXPECT_EQ(run({"classes", "HostileShader", "--plugin", library("hostile"), "--plugin", library("hostile")}), 0) << err;
}

TEST_F(PluginHandshake, survives_what_happens_while_it_is_loaded) {
  for (const std::string place : {"open", "describe", "construct"})
    for (const std::string what : {"int", "runtime", "error", "crash", "abort", "exit"}) {
      const std::string said = listing(place + " " + what);
      EXPECT_TRUE(has(said, library("hostile"))) << place << " " << what << ": " << said;
      const bool thrown = what == "int" || what == "runtime" || what == "error";
      if (place != "open" && thrown) {
        EXPECT_TRUE(has(said, "HostileShader")) << said;
        EXPECT_TRUE(has(said, what == "int" ? "of type int" : what == "runtime" ? "boom" : "bang")) << said;
      }
      if (what == "crash") {
        EXPECT_TRUE(has(said, "crashed")) << said;
      }
    }
}

TEST_F(PluginHandshake, does_not_wait_for_ever) { EXPECT_TRUE(has(listing("open hang"), "no answer within")) << err; }

TEST_F(PluginHandshake, names_class_and_file_of_what_is_thrown) {
  const auto named = [&](const std::string& said, const std::string& who, const std::string& what) {
    return has(said, who) && has(said, library("hostile")) && has(said, what) && has(said, "scene.etd:2:");
  };
  for (const auto& [what, text] : {std::pair("int", "of type int"), {"runtime", "boom"}, {"error", "bang"}}) {
    EXPECT_TRUE(named(rendering(std::string("prepare ") + what), "HostileShader", text)) << err;
    EXPECT_TRUE(named(rendering(std::string("bind ") + what), "HostileShader", text)) << err;
  }
  // Exceptions thrown by a nested part, and outside of any shader.
  EXPECT_TRUE(named(rendering("color int", "Lambertian { color: HostileMap {} }"), "HostileMap", "of type int")) << err;
  const std::string said = rendering("color int", "Lambertian {}", "HostileMap {}");
  EXPECT_TRUE(has(said, "HostileMap") && has(said, library("hostile")) && has(said, "of type int")) << said;
  // Commands that try parts out report exceptions too.
  ::setenv("ETENDUE_HOSTILE", "bind int", 1);
  EXPECT_EQ(run({"conform", "HostileShader", "--quick", "--plugin", library("hostile")}), 1) << err;
  EXPECT_TRUE(has(out, "HostileShader")) << out;
}

TEST_F(PluginHandshake, refuses_what_cannot_be_asked) {
  EXPECT_TRUE(has(loading("extern \"C\" const char* etendue_plugin_abi() { return nullptr; }"), "not an Étendue plugin"))
      << err;
  EXPECT_TRUE(has(loading("extern \"C\" const char* etendue_plugin_abi() { return (const char*)16; }"), "crashed")) << err;
  EXPECT_TRUE(has(loading("extern \"C\" { extern const char etendue_plugin_abi[] = \"interfaces 4\"; }"), "crashed")) << err;
  EXPECT_TRUE(has(loading("extern \"C\" const char* etendue_plugin_abi() { return \"interfaces 0\"; }"), "build it again"))
      << err;
  loading(
      "extern \"C\" const char* etendue_plugin_abi() { static char endless[1 << 20]; "
      "for (char& c : endless) c = 'x'; return endless; }");
}

TEST_F(PluginHandshake, refuses_cut_and_garbled_libraries) {
  const std::string whole = file_text(library("hostile"));
  ASSERT_GT(whole.size(), 10000u);
  for (const double part : {0.001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97}) {
    const std::string cut = folder.write("libcut.so", whole.substr(0, size_t(part * double(whole.size()))));
    const int status = run({"classes", "--plugin", cut});
    if (status == 0 && part > 0.7) continue;  // only sections for linkers and debuggers are missing
    EXPECT_EQ(status, 2) << part << ": " << err;
    EXPECT_TRUE(has(err, cut)) << part << ": " << err;
  }
  std::string garbled = whole;
  for (size_t i = 4096; i < garbled.size(); i += 7) garbled[i] = char(i * 2654435761u >> 24);
  EXPECT_EQ(run({"classes", "--plugin", folder.write("libgarbled.so", garbled)}), 2) << err;
  EXPECT_TRUE(has(err, "libgarbled.so")) << err;
}

}  // namespace
}  // namespace etendue
