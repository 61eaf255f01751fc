// Faults that could pass without a message, but are reported.

#include <gtest/gtest.h>

#include <functional>

#include "etendue/film/image_tools.h"
#include "etendue/render/job.h"
#include "images/stated_encoding.h"
#include "support/language_test_support.h"

namespace etendue::language_test {
namespace {

std::string warnings(const std::function<void()>& work) {
  testing::internal::CaptureStderr();
  work();
  return testing::internal::GetCapturedStderr();
}

TEST(NothingSilent, BytesThatAreNoText) {
  EXPECT_EQ(part_errors("\xFF\xFEL\0"), "1:1: the text is not valid UTF-8: byte 0xFF; it seems to be UTF-16");
  EXPECT_EQ(part_errors(std::string("LanguagePart {\n\0}", 17)), "2:1: unexpected character U+0000");
  EXPECT_EQ(part_errors("LanguagePart { title: \"a\0b\" }"), "1:23: the string is not closed in its line: a '\"' is missing");
  EXPECT_EQ(part_errors("# a comment\rLanguagePart { count: 1 }\r"),
            "1:1: a line ends with a carriage return alone: lines end with a line feed, or with both");
  EXPECT_EQ(part("# a comment\r\nLanguagePart { count: 1 }\r\n")->count, 1);
}

TEST(NothingSilent, NumbersThatDoNotFit) {
  EXPECT_EQ(part_errors("LanguagePart { length: 1e999 }"), "1:24: the number 1e999 is outside the range of double precision");
  EXPECT_EQ(part_errors("LanguagePart { length: 1e39 }"),
            "1:24: LanguagePart.length must be at most 3.40282e+38 in magnitude, not 1e+39");
  EXPECT_EQ(part_errors("LanguagePart { count: 1e39 }"), "1:23: LanguagePart.count must be from 0 to 1000, not 1e+39");
  EXPECT_EQ(part_errors("LanguagePart { large: 9007199254740993 }"),
            "1:23: LanguagePart.large must be less than 2^53 = 9007199254740992");
  EXPECT_EQ(part_errors("LanguagePart { length: 1e300 * 1e300 }"), "1:30: the result is too large for a number");
  // Positive, but 0 in single precision.
  EXPECT_EQ(part_errors("x = BricksMap { joint: 0 }\ny = Torus { tube_radius: 1e-50 }\nLanguagePart {}").substr(0, 5), "2:26:");
}

TEST(NothingSilent, NumbersOfCallsTellTheirBounds) {
  EXPECT_EQ(
      value_errors("rgb(1e39, 0, 0)"),
      "1:5: rgb(red, green, blue) or rgb(\"space\", red, green, blue): argument 1 must be from -3.40282e+38 to 3.40282e+38, "
      "not 1e+39");
  EXPECT_EQ(
      errors_of([] { prepare_tree(*parse_component("Conductor { ior: complex(0, 100) }")); }),
      "1:18: Conductor.ior: n must be more than 0 and less than 100, and is 0; k must be at least 0 and less than 100, and "
      "is 100 at 360 nm");
  EXPECT_EQ(errors_of([] { prepare_tree(*parse_component("Conductor { ior: complex(1, -1) }")); }),
            "1:18: Conductor.ior: k must be at least 0 and less than 100, and is -1 at 360 nm");
}

TEST(NothingSilent, WhatToWriteInstead) {
  const auto said = [](const std::string& text) { return part_errors("x = " + text + "\nLanguagePart {}"); };
  EXPECT_EQ(said("Dielectric { ior: \"N-BK7\" }"),
            "1:23: Dielectric.ior expects a colour or spectrum, not a string: write glass(\"N-BK7\")");
  EXPECT_NE(said("Conductor { ior: \"Au\" }").find("not a string: write metal(\"Au\")"), std::string::npos);
  EXPECT_NE(said("DiffuseEmission { radiance: \"D65\" }").find("write illuminant(\"D65\")"), std::string::npos);
  EXPECT_NE(said("DiffuseEmission { radiance: \"#ff8000\" }").find("write srgb(\"#ff8000\")"), std::string::npos);
  EXPECT_NE(said("DiffuseEmission { radiance: \"paint.csv\" }").find("write spectrum(\"paint.csv\")"), std::string::npos);
  EXPECT_NE(said("DiffuseEmission { radiance: \"red\" }").find("expects a colour or spectrum, not a string"),
            std::string::npos);
  EXPECT_NE(
      said("BvhScene { objects: Sphere {} }").find("BvhScene.objects expects a list, even of one: write [ Sphere { … } ]"),
      std::string::npos);
}

// A warning is given only if the definition could have been meant: a part cannot stand for a choice, but the name of another
// choice can.
TEST(NothingSilent, NamesOfChoicesThatWereMeant) {
  const auto told = [](const std::string& definition) {
    return warnings([&] {
      load_job_text(
          definition + "\nJob { camera: PerspectiveCamera {}, scene: BvhScene { objects: [ Curve { form: ribbon } ] } }", "t");
    });
  };
  EXPECT_EQ(told("ribbon = Curve { form: ribbon }\nothers = BvhScene { objects: [ ribbon ] }").find("is the choice here"),
            std::string::npos);
  EXPECT_EQ(told("ribbon = rgb(1, 0, 0)").find("is the choice here"), std::string::npos);
  EXPECT_EQ(told("ribbon = [1, 2]").find("is the choice here"), std::string::npos);
  EXPECT_EQ(told("param ribbon = \"leather\"").find("is the choice here"), std::string::npos);
  EXPECT_NE(told("param ribbon = \"tube\"").find("'ribbon' is the choice here, not the 'ribbon' defined at line 1:7"),
            std::string::npos);
  EXPECT_NE(told("k = 1\nribbon = if k == 1 then \"tube\" else \"ribbon\"").find("is the choice here"), std::string::npos);
  EXPECT_NE(told("flat = \"tube\"\n\nribbon = flat").find("is the choice here"), std::string::npos);
}

TEST(NothingSilent, NamesThatMeanSomethingElse) {
  EXPECT_NE(warnings([] {
              part("visible = 3\nLanguagePart {   mode: visible, count: visible }");
            }).find("text:2:24: warning: 'visible' is the choice here, not the 'visible' defined at line 1:1"),
            std::string::npos);
  EXPECT_NE(warnings([] {
              load_job_text("param spare_one = 1\n" + job_with("seed: 1"), "t", {}, {{{"spare_one", "2"}}});
            }).find("-D spare_one: warning: has no effect: nothing uses the param 'spare_one'"),
            std::string::npos);
}

// A PNG chunk as in the specification; checksums are not tested.
std::string chunk(const std::string& type, const std::string& data) {
  const auto n = static_cast<std::uint32_t>(data.size());
  return std::string{char(n >> 24), char(n >> 16), char(n >> 8), char(n)} + type + data + "crc!";
}

TEST(NothingSilent, EncodingsThatFilesState) {
  const Folder folder;
  const std::string start = std::string("\x89PNG\r\n\x1a\n") + chunk("IHDR", std::string(13, '\1'));
  const auto said = [&](const std::string& bytes) {
    std::string all;
    for (const std::string& line : stated_encoding(folder.write("x.png", bytes))) all += line + "\n";
    return all;
  };
  EXPECT_EQ(said(start + chunk("gAMA", std::string("\0\0\xB1\x8F", 4)) + chunk("sRGB", std::string(1, '\0')) +
                 chunk("cICP", std::string("\x09\x10\0\1", 4)) + chunk("iCCP", std::string("P3\0\0", 4)) + chunk("IDAT", "")),
            "gAMA: 0.45455, values are light to the power of 1 / 2.2\n"
            "sRGB: rendering intent perceptual\n"
            "cICP: primaries 9 (BT.2020), transfer 16 (PQ), matrix 0, full range\n"
            "iCCP: a profile called 'P3'\n");
  EXPECT_EQ(said(start + chunk("IDAT", "") + chunk("gAMA", "abcd")), "");
  EXPECT_EQ(said(start + "\x7F\xFF\xFF\xFFgAMA"), "");
  EXPECT_EQ(said(""), "");
  std::string header("\x76\x2f\x31\x01\x02\0\0\0chromaticities\0chromaticities\0\x20\0\0\0", 42);
  const float xy[8] = {0.708f, 0.292f, 0.17f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.329f};
  EXPECT_EQ(said(header + std::string(reinterpret_cast<const char*>(xy), sizeof xy) + std::string(1, '\0')),
            "chromaticities: red 0.708 0.292, green 0.17 0.797, blue 0.131 0.046, white 0.3127 0.329\n");
}

// The encoding that our own outputs state, as shown by the program's description of an image.
TEST(NothingSilent, APicturesDescriptionTellsItsEncoding) {
  const Folder folder;
  Image image(2, 1, {"R", "G", "B"});
  image.values.assign(6, 0.5);
  image.metadata = {{"color_space", "rec2020"}, {"transfer", "linear"}};
  write_any(image, folder.path() + "/a.exr");
  write_any(image, folder.path() + "/a.png");
  EXPECT_NE(describe_image(folder.path() + "/a.exr").find("the file says chromaticities: red 0."), std::string::npos)
      << describe_image(folder.path() + "/a.exr");
  EXPECT_NE(describe_image(folder.path() + "/a.exr").find("stored as linear"), std::string::npos);
  EXPECT_NE(describe_image(folder.path() + "/a.png").find("stored as srgb"), std::string::npos);
  image.metadata.clear();
}

}  // namespace
}  // namespace etendue::language_test
