// One missing or superfluous character is one mistake and gives one error; errors that only follow from it are not reported.

#include <gtest/gtest.h>

#include "etendue/render/job.h"
#include "support/language_test_support.h"

namespace etendue::language_test {
namespace {

constexpr const char* ball =
    R"(glass_ball = Sphere { centre: [0, 0.5, 0] m, radius: 50 cm, shader: Dielectric { ior: glass("N-BK7") } }
param samples = 2 * (64 + 64)

Job {
    renderer: PathTracer { samples: samples }
    camera:   PerspectiveCamera { from: [0, 1, 4] m, to: [0, 0.5, 0] m, fov: 30 deg }
    image:    ImageBuffer { width: 400, height: 300 }
    scene:    BvhScene { objects: [
        glass_ball
        Disc { radius: 5 m, transform: rotate(-90, "x"), shader: Lambertian { color: srgb("#c08050") } }
        Sphere { centre: [2, 4, 1] m, radius: 0.5 m, emission: DiffuseEmission { radiance: blackbody(3000 K), power: 6 kW } }
        Environment { emission: DiffuseEmission { radiance: 0.1 * illuminant("D65") } }
    ] }
    tone_map: SchlickToneMap {}
    outputs:  [ PngOutput {}, ExrOutput {} ]
}
)";

constexpr const char* tall = R"(
white = Lambertian {
    color: 0.75
}
floor = Torus {
    radius: 2
    tube_radius: 0.5
    shader: white
}

Job {
    scene: BvhScene {
        objects: [
            floor
            Sphere {
                radius: 1
                shader: MixShader {
                    first: white
                    second: Conductor {
                        roughness: 0.2
                    }
                    amount: 0.25
                }
            }
            Point {
                position: [
                    0,
                    1,
                    2
                ]
                emission: SpotEmission {
                    outer_angle: 30
                }
            }
        ]
    }
    camera: PerspectiveCamera {
        from: [0, 0, 5]
        to: [0, 0, 0]
    }
    renderer: PathTracer {
        samples: 4
    }
}
)";

struct Told {
  size_t errors = 0;
  std::string text;
};

Told told(const std::string& text, const std::string& folder = {}) {
  Told all;
  testing::internal::CaptureStderr();  // warnings about names that are no longer used
  try {
    load_job_text(text, "text", folder);
  } catch (const Errors& e) {
    all.errors = e.errors.size();
    Location last;
    for (const Error& error : e.errors) {
      all.text += show(error) + "\n";
      EXPECT_GE(std::pair(error.location.line, error.location.column), std::pair(last.line, last.column)) << all.text;
      last = error.location;
    }
  }
  testing::internal::GetCapturedStderr();
  return all;
}

/// Checks that the text without any one character of `kind` gives at most one error; prints the failures.
void expect_one_error(const std::string& text, const std::string& kind) {
  ASSERT_EQ(told(text).errors, 0u) << told(text).text;
  for (size_t i = 0; i < text.size(); ++i) {
    if (kind.find(text[i]) == std::string::npos) continue;
    const Told here = told(text.substr(0, i) + text.substr(i + 1));
    EXPECT_LE(here.errors, 1u) << "without the '" << text[i] << "' of line "
                               << std::count(text.begin(), text.begin() + long(i), '\n') + 1 << " at " << text.substr(i, 20)
                               << ":\n"
                               << here.text;
  }
}

TEST(OneMistake, AMissingBracketGivesOneError) {
  for (const char* text : {ball, tall}) {
    expect_one_error(text, "{");
    expect_one_error(text, "}");
    expect_one_error(text, "[]");
    expect_one_error(text, "()");
  }
}

TEST(OneMistake, AMissingSeparatorOrQuoteGivesOneError) {
  for (const char* text : {ball, tall}) {
    expect_one_error(text, ",:=");
    expect_one_error(text, "\"");
  }
}

TEST(OneMistake, ABracketTooManyGivesOneError) {
  for (const std::string text : {ball, tall})
    for (size_t i = 0; i < text.size(); ++i) {
      if (std::string("{}[]()").find(text[i]) == std::string::npos) continue;
      const Told here = told(text.substr(0, i) + text[i] + text.substr(i));
      EXPECT_EQ(here.errors, 1u) << "with two '" << text[i] << "' in line "
                                 << std::count(text.begin(), text.begin() + long(i), '\n') + 1 << " at " << text.substr(i, 20)
                                 << ":\n"
                                 << here.text;
    }
}

// Every seventh bracket, separator and quote of the examples is removed: the intended text cannot always be recovered, but
// nearly always.
TEST(OneMistake, InExamplesGivesOneErrorNearlyAlways) {
  size_t tried = 0, several = 0;
  std::string those;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(ETENDUE_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".etd" || entry.file_size() > 6000) continue;
    std::ostringstream read;
    read << std::ifstream(entry.path()).rdbuf();
    const std::string text = read.str();
    const std::string folder = entry.path().parent_path().string();
    if (text.find("data/highland_cow") != std::string::npos) continue;  // its 60 000 hairs take long to read
    if (text.find("Job {") == std::string::npos || told(text, folder).errors > 0) continue;
    bool comment = false;
    for (size_t i = 0; i < text.size(); ++i) {
      comment = text[i] != '\n' && (comment || (text[i] == '#' && (i == 0 || text[i - 1] != '"')));
      if (comment || std::string("{}[](),:=\"").find(text[i]) == std::string::npos || ++tried % 7 != 0) continue;
      const Told here = told(text.substr(0, i) + text.substr(i + 1), folder);
      if (here.errors > 1) ++several, those += entry.path().string() + ":\n" + here.text;
    }
  }
  EXPECT_GT(tried, 7000u);
  EXPECT_LE(several, tried / 7 / 200) << those;
}

TEST(OneMistake, TwoMistakesAreToldInOrder) {
  const std::string text =
      "Job {\n camera: PerspectiveCamera  from: [0, 0, 5] }\n scene: BvhScene { objects: [ Sphere { radus: 1 } ] }\n}";
  const Told both = told(text);
  EXPECT_EQ(both.errors, 2u);
  EXPECT_NE(both.text.find("text:2:29: expected '{' after 'PerspectiveCamera', not 'from'"), std::string::npos) << both.text;
  EXPECT_NE(both.text.find("did you mean 'radius'?"), std::string::npos) << both.text;
}

TEST(OneMistake, SaysWhatIsMissing) {
  const auto first = [](const std::string& text) {
    const std::string all = told(text).text;
    return all.substr(0, all.find('\n'));
  };
  const std::string rest = " scene: BvhScene { objects: [ Sphere {} ] }\n}\n";
  EXPECT_EQ(
      first("Job { renderer: PathTracer { samples: 4\n camera: PerspectiveCamera {}\n" + rest),
      "text:2:2: a '}' is missing before 'camera': PathTracer, whose '{' is at line 1:28, has no such member, but Job has");
  EXPECT_EQ(first("Job { renderer: PathTracer { samples: 4 } }\n camera: PerspectiveCamera {}\n" + rest),
            "text:1:43: a '}' too many: here Job ends, but 'camera' follows at line 2:2");
  EXPECT_EQ(first("Job { renderer: PathTracer { samples: 4 } camera: PerspectiveCamera {}\n" + rest),
            "text:1:43: expected ',' or a new line before the next member, not 'camera'");
  EXPECT_EQ(first("Job { camera: PerspectiveCamera { from: 0, 0, 5] m }\n" + rest),
            "text:1:44: expected a member name or '}', not '0': is a '[' missing before the value of 'from'?");
  EXPECT_EQ(first("Job { camera: PerspectiveCamera {}\n scene: BvhScene { objects: Sphere {} ] }\n}\n"),
            "text:2:39: this ']' closes nothing: is a '[' missing before the value of 'objects'?");
  EXPECT_EQ(first("Job { camera: PerspectiveCamera {}\n" + rest + "}\n"),
            "text:4:1: this '}' closes nothing: there is one too many, or a '{' is missing");
}

TEST(OneMistake, PowersAreWritten) {
  EXPECT_EQ(number("2^10"), 1024);
  EXPECT_EQ(number("-2^2"), -4);
  EXPECT_EQ(number("2^3^2"), 512);
  EXPECT_EQ(number("2^-1 * 3"), 1.5);
  EXPECT_EQ(number("(1 + 1)^0.5 * (1+1)^.5"), 2.0000000000000004);
  EXPECT_EQ(value_errors("2 m ^ 2"), "1:5: cannot raise a length to the power of a plain number: both must be plain numbers");
  EXPECT_EQ(value_errors("[1, 2] ^ 2"), "1:8: cannot raise a list of 2 numbers to the power of a number");
  EXPECT_EQ(value_errors("(-1) ^ 0.5"), "1:6: -1 to the power of 0.5 is not a finite number");
  EXPECT_EQ(value_errors("10 ^ 400"), "1:4: 10 to the power of 400 is not a finite number");
}

}  // namespace
}  // namespace etendue::language_test
