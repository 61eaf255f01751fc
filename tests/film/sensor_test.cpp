// A sensor's digital numbers against the formulas of the standard, and its colours against computed ones.

#include "film/sensor.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "etendue/describe/sensor_curves.h"
#include "etendue/film/image_tools.h"
#include "images/raw_file.h"
#include "support/program_support.h"
#include "support/render_support.h"

namespace etendue {
namespace {

constexpr int bands = 470;

/// A picture of one pixel for each radiance, in bands of 1 nm; without X, Y, Z.
Image picture_of(const std::vector<std::function<double(double)>>& radiances) {
  std::vector<std::string> names = {"X", "Y", "Z"};
  std::string edges = "360";
  for (int b = 0; b < bands; ++b) {
    names.push_back(fmt::format("S0.{},5nm", 360 + b));
    edges += fmt::format(" {}", 361 + b);
  }
  Image image(int(radiances.size()), 1, names);
  for (size_t p = 0; p < radiances.size(); ++p)
    for (int b = 0; b < bands; ++b) image.at(int(p), 0, size_t(3 + b)) = radiances[p](360.5 + b);
  image.metadata = {{"color_space", "xyz"}, {"band_edges", edges}};
  return image;
}

/// Sensitivities from a matrix times the observer's curves: such a sensor sees all colours right (Luther condition). Negative
/// values would be refused.
Sensor colorimetric() {
  Sensor sensor;
  const double mix[3][3] = {{0.9, 0.3, 0}, {0.1, 1, 0.05}, {0, 0.1, 0.7}};
  for (size_t c = 0; c < 3; ++c) {
    std::vector<float> wavelengths, values;
    for (int l = 360; l <= 830; ++l) {
      const Xyz eye = observer(float(l));
      wavelengths.push_back(float(l));
      values.push_back(float(mix[c][0] * eye.x + mix[c][1] * eye.y + mix[c][2] * eye.z));
    }
    sensor.sensitivities[c] = table_spectrum(wavelengths, values);
  }
  return sensor;
}

double daylight(double l) {
  static const Color d65 = illuminant_spectrum("D65");
  return double(d65->at(float(l), ColorUse::radiance));
}

// H = 0.65 L t / N^2 and H_sat = 78 / S: a grey in daylight of the luminance L fills its strongest channel to H / H_sat.
TEST(SensorFormula, ExposureIsThatOfTheStandard) {
  Sensor sensor = colorimetric();
  sensor.iso = 200;
  sensor.shutter = 1 / 50.0;
  sensor.f_number = 4;
  const double luminance = 120, scale = luminance / (683 * observer_y_integral());  // the illuminant has Y = 1
  const Image raw =
      recorded(picture_of({[&](double l) { return scale * daylight(l); }, [&](double l) { return 2 * scale * daylight(l); },
                           [&](double l) { return 1e4 * scale * daylight(l); }, [](double) { return 0; }}),
               sensor);
  const double expected = 0.65 * luminance / 50 / 16 * 200 / 78;
  const auto strongest = [&](int p) { return std::max({raw.at(p, 0, 0), raw.at(p, 0, 1), raw.at(p, 0, 2)}); };
  EXPECT_NEAR(strongest(0) / 16383, expected, 1e-3 * expected);
  EXPECT_NEAR(strongest(1), 2 * strongest(0), 2);
  EXPECT_EQ(raw.at(2, 0, 0), 16383);
  EXPECT_EQ(raw.at(3, 0, 0), 0);
  EXPECT_EQ(raw.metadata.at("clipped"), "0.25");
  EXPECT_NEAR(exposure_value(12.5), 6.643856, 1e-6);  // log2(100)
}

// A sensor that meets the Luther condition sees reflectances in daylight as the observer does; in the light of a lamp a white
// stays neutral.
TEST(SensorColours, AreThoseOfTheObserver) {
  Sensor sensor = colorimetric();
  sensor.bits = 16;
  std::vector<Color> papers = {flat_spectrum(1)};
  for (const double r : {0.05, 0.4, 0.8}) papers.push_back(rgb_color("srgb", r, 0.3, 0.85 - r));
  for (const char* light : {"D65", "A"}) {
    const Color lamp = illuminant_spectrum(light);
    std::vector<std::function<double(double)>> radiances;
    // At 1 / 100 s, f/8 and ISO 100 a luminance of 7680 cd/m^2 saturates; Y = 1 is 72983.
    for (const Color& paper : papers)
      radiances.push_back([&, paper](double l) {
        return 0.09 * double(lamp->at(float(l), ColorUse::radiance)) * double(paper->at(float(l), ColorUse::reflectance));
      });
    const Image raw = recorded(picture_of(radiances), sensor), picture = developed(raw, sensor, *lamp);
    EXPECT_EQ(raw.metadata.at("clipped"), "0");
    const double white = picture.at(0, 0, 1);
    EXPECT_GT(white, 0.2);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(picture.at(0, 0, c) / white, 1, 3e-3) << light;
    for (int p = 1; light == std::string("D65") && p < picture.width; ++p) {
      const Xyz expected = to_xyz(*papers[size_t(p)], ColorUse::reflectance, lamp.get());
      const auto& m = rgb_space("srgb").from_xyz;
      for (size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(picture.at(p, 0, c) / white, m[3 * c] * expected.x + m[3 * c + 1] * expected.y + m[3 * c + 2] * expected.z,
                    4e-3)
            << p << " " << c;
    }
  }
}

// Standard output sensitivity: 18 % of saturation at 10 / S lx s, where the saturation based rule has 18 % at 14.04 / S.
TEST(SensorFormula, SpeedHasTwoRules) {
  Sensor sensor = colorimetric();
  sensor.bits = 16;
  const Image picture = picture_of({[](double l) { return 0.01 * daylight(l); }});
  const Image by_saturation = recorded(picture, sensor);
  sensor.speed_rule = SpeedRule::standard_output;
  const Image by_output = recorded(picture, sensor);
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(by_output.at(0, 0, c) / by_saturation.at(0, 0, c), 78 * 0.18 / 10, 2e-3);
  EXPECT_NE(by_output.metadata.at("sensor"), by_saturation.metadata.at("sensor"));
}

// A luminance of L fills H / H_sat of what saturates: full well / (S / S_0) electrons, and the largest voltage.
TEST(SensorFormula, ElectronsVoltsAndNumbers) {
  Sensor sensor = colorimetric();
  sensor.iso = 800;
  sensor.shutter = 1 / 200.0;
  sensor.f_number = 5.6;
  sensor.black_level = 512;
  sensor.photosites = {60000, 100, 25};
  const double luminance = 90, scale = luminance / (683 * observer_y_integral());
  const Image picture = picture_of({[&](double l) { return scale * daylight(l); }, [](double) { return 0; },
                                    [&](double l) { return 1e4 * scale * daylight(l); }});
  const double filled = 0.65 * luminance / 200 / (5.6 * 5.6) * 800 / 78;
  const auto strongest = [](const Image& raw, int p) { return std::max({raw.at(p, 0, 0), raw.at(p, 0, 1), raw.at(p, 0, 2)}); };
  const Image electrons = recorded(picture, sensor, SensorQuantity::electrons);
  EXPECT_NEAR(strongest(electrons, 0), filled * 60000 / 8, 1e-3 * filled * 60000 / 8);
  EXPECT_EQ(strongest(electrons, 2), 60000);
  const Image volts = recorded(picture, sensor, SensorQuantity::volts);
  EXPECT_NEAR(strongest(volts, 0), filled * 60000 * 25e-6, 1e-3 * filled * 1.5);
  EXPECT_NEAR(strongest(volts, 2), 1.5, 1e-12);
  const Image numbers = recorded(picture, sensor);
  EXPECT_NEAR(strongest(numbers, 0), 512 + filled * (16383 - 512), 16);
  EXPECT_EQ(strongest(numbers, 1), 512);
  EXPECT_EQ(strongest(numbers, 2), 16383);
  for (const Image* image : {&electrons, &volts, &numbers}) {
    EXPECT_EQ(image->metadata.at("noise"), "none");
    EXPECT_EQ(image->metadata.at("clipped"), "0.3333");
  }
  // log2(5.6^2 200) - log2(8)
  EXPECT_NEAR(exposure_value(sensor), 9.61471, 1e-5);
}

// The variance of a channel is that of photons, of electrons in the dark and of the read-out, n + d t + r^2 electrons^2; its
// mean n + d t. Four times the speed leaves a quarter of the electrons for the same number. 4000 pixels: the estimate of the
// variance has a standard error of 2.2 %, and is held to 5 of them.
TEST(SensorNoiseTest, HasTheVarianceOfPhotonsAndReadOut) {
  for (const double iso : {100.0, 400.0}) {
    Sensor sensor = colorimetric();
    sensor.bits = 16;
    sensor.iso = iso;
    sensor.photosites.full_well = 4000;
    constexpr int count = 4000;
    const auto grey = [&](double l) { return 0.03 * 100 / iso * daylight(l); };
    const Image clean = recorded(picture_of({grey}), sensor);
    sensor.noise = SensorNoise{8, 2500, 3};
    const Image all = picture_of(std::vector<std::function<double(double)>>(count, grey)), noisy = recorded(all, sensor);
    const double full = 4000 * 100 / iso;
    for (size_t c = 0; c < 3; ++c) {
      const double electrons = clean.at(0, 0, c) / 65535 * full + 25;  // 2500 electrons/s for 0.01 s
      double sum = 0, squares = 0;
      for (int p = 0; p < count; ++p) {
        const double e = noisy.at(p, 0, c) / 65535 * full;
        sum += e;
        squares += e * e;
      }
      const double mean = sum / count, variance = squares / count - mean * mean, expected = electrons + 64;
      EXPECT_NEAR(mean, electrons, 5 * std::sqrt(expected / count)) << iso;
      EXPECT_NEAR(variance / expected, 1, 0.11) << iso;
    }
    EXPECT_NE(noisy.metadata.at("noise").find("8 electrons"), std::string::npos);
    EXPECT_NE(noisy.metadata.at("noise").find("seed 3"), std::string::npos);
    EXPECT_EQ(noisy.values, recorded(all, sensor).values);
    sensor.noise->seed = 4;
    EXPECT_NE(noisy.values, recorded(all, sensor).values);
  }
}

// Values of the published tables (Darrodi et al. 2015; rawtoaces), between them, and none outside.
TEST(SensorCurves, AreThePublishedOnes) {
  const auto at = [](const char* camera, const char* channel, float l) {
    return sensor_curve(camera, channel)->at(l, ColorUse::coefficient);
  };
  EXPECT_NEAR(at("Nikon D5100", "green", 530), 1, 1e-6);
  EXPECT_NEAR(at("Nikon D5100", "red", 582.5f), (0.564503 + 0.853601) / 2, 1e-6);
  EXPECT_NEAR(at("Sigma SD1 Merrill", "blue", 400), 0.162159, 1e-6);
  EXPECT_NEAR(at("canon eos 5d mark ii", "Red", 380), 0.0354, 1e-6);
  EXPECT_EQ(at("Sigma SD1 Merrill", "red", 399), 0);
  EXPECT_EQ(sensor_names().size(), 3u);
  EXPECT_EQ(sensor_curve("Nikon 5100 (NPL)", "red")->expression(), "sensor(\"Nikon D5100\", \"red\")");
  EXPECT_THROW(sensor_curve("Nikon D5200", "red"), Error);
  EXPECT_THROW(sensor_curve("Nikon D5100", "cyan"), Error);
}

// Curves are used by name wherever a curve is taken. A film with them as responses measures what the bands of 1 nm do.
TEST(SensorCurves, AreResponsesOfAFilm) {
  const auto means = [](const std::string& film) {
    const Image image =
        test::rendered(load_job_text("Job { renderer: PathTracer { samples: 2048 }\n image: SpectralFilm { width: 2, "
                                     "height: 2, " +
                                         film +
                                         " }\n camera: PerspectiveCamera { from: [0, 0, -3] m, to: [0, 0, 0] m, fov: 20 deg }\n"
                                         "scene: BruteForceScene { objects: [ Sphere { emission: DiffuseEmission { radiance: "
                                         "illuminant(\"A\") } } ] } }",
                                     "test.etd"))
            ->picture();
    std::vector<double> all;
    for (size_t c = 3; c < image.channels.size(); ++c) {
      all.push_back(0);
      for (int p = 0; p < 4; ++p) all.back() += image.at(p % 2, p / 2, c) / 4;
    }
    return all;
  };
  const std::vector<double> curves =
      means("responses: [sensor(\"Nikon D5100\", \"red\"), sensor(\"Nikon D5100\", \"blue\")], response_names: [\"r\", \"b\"]");
  ASSERT_EQ(curves.size(), 2u);
  const Color lamp = illuminant_spectrum("A");
  for (size_t i = 0; i < 2; ++i) {
    const Color curve = sensor_curve("Nikon D5100", i ? "blue" : "red");
    double sum = 0, whole = 0;
    for (int l = 360; l <= 830; ++l) {
      const double r = double(curve->at(float(l), ColorUse::coefficient));
      sum += r * double(lamp->at(float(l), ColorUse::radiance));
      whole += r;
    }
    EXPECT_NEAR(curves[i], sum / whole, 0.01 * sum / whole);  // four pixels of 2048 samples: 0.2 %
  }
}

// A file of 16 bits, by the library that reads images.
TEST(SensorFiles, TiffHoldsTheNumbers) {
  Image image(3, 2, {"R", "G", "B"});
  for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = double(i * 3000 + 17);
  const std::string file = (std::filesystem::temp_directory_path() / "etendue_sensor_test.tif").string();
  write_linear_tiff(image, 65535, file);
  const Image back = read_image(file);
  std::filesystem::remove(file);
  ASSERT_EQ(back.width, 3);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x)
      for (size_t c = 0; c < 3; ++c) EXPECT_GT(back.at(x, y, c), 0) << x << y << c;
}

TEST(SensorErrors, AreSaid) {
  const Image image = picture_of({daylight});
  Sensor sensor = colorimetric();
  sensor.sensitivities[1] = table_spectrum({400, 500}, {1, -1});
  EXPECT_THROW(recorded(image, sensor), Error);
  sensor.sensitivities[1] = flat_spectrum(0);
  EXPECT_THROW(recorded(image, sensor), Error);
  EXPECT_THROW(recorded(Image(1, 1, {"X", "Y", "Z"}), colorimetric()), Error);
  sensor = colorimetric();
  sensor.noise = SensorNoise{};
  sensor.iso = 50;  // below the base speed
  EXPECT_THROW(recorded(image, sensor), Error);
  sensor = colorimetric();
  sensor.black_level = 16383;
  EXPECT_THROW(recorded(image, sensor), Error);
  Image narrow(1, 1, {"X", "Y", "Z", "S0.500nm", "S0.510nm"});
  EXPECT_THROW(recorded(narrow, colorimetric()), Error);
}

class SensorProgram : public RunsProgram {};

// The command writes whole numbers, and a colour picture.
TEST_F(SensorProgram, WritesNumbersAndPictures) {
  std::ofstream csv(folder / "camera.csv");
  csv << "nm,red,green,blue\n";
  for (int l = 360; l <= 830; l += 10)
    csv << l << "," << std::exp(-std::pow((l - 600) / 40.0, 2)) << "," << std::exp(-std::pow((l - 540) / 40.0, 2)) << ","
        << std::exp(-std::pow((l - 460) / 30.0, 2)) << "\n";
  csv.close();
  std::ofstream scene(folder / "scene.etd");
  scene << "Job { renderer: PathTracer { samples: 64 }\n image: SpectralFilm { width: 8, height: 8 }\n"
           "camera: PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 10 deg }\n"
           "scene: BruteForceScene { objects: [Sphere { emission: DiffuseEmission { radiance: illuminant(\"D65\") } }] } }";
  scene.close();
  const auto run = [&](std::vector<std::string> arguments) {
    Process process(ETENDUE_BINARY_DIR "/etendue", arguments, folder);
    const int status = process.wait();
    return std::pair(status, process.out() + process.err());
  };
  ASSERT_EQ(run({"render", folder / "scene.etd", "-o", folder / "a.exr", "--quiet"}).first, 0);
  const auto raw = run({"image", "sensor", folder / "a.exr", folder / "raw.npy", "--sensitivities", folder / "camera.csv",
                        "--columns", "red,green,blue", "--shutter", "0.0005"});
  ASSERT_EQ(raw.first, 0) << raw.second;
  EXPECT_NE(raw.second.find("exposure value 19.1"), std::string::npos) << raw.second;  // log2(72983 * 8) = 19.155
  const auto photo = run({"image", "sensor", folder / "a.exr", folder / "photo.png", "--sensitivities", folder / "camera.csv",
                          "--shutter", "0.0005", "--white", "D65", "--noise", "--full-well", "20000"});
  ASSERT_EQ(photo.first, 0) << photo.second;
  EXPECT_EQ(run({"image", "sensor", folder / "a.exr", folder / "b.png", "--sensitivities", folder / "camera.csv", "--columns",
                 "red,green"})
                .first,
            2);
  EXPECT_EQ(run({"image", "sensor", folder / "a.exr", folder / "b.png", "--sensitivities", folder / "none.csv"}).first, 2);
  // A measured camera by its name. What would be ignored is refused.
  const auto named = run({"image", "sensor", folder / "a.exr", folder / "raw.dng", "--camera", "Nikon D5100", "--shutter",
                          "0.0005", "--mosaic", "RGGB"});
  EXPECT_EQ(named.first, 0) << named.second;
  EXPECT_NE(named.second.find("2.19 stops brighter"), std::string::npos) << named.second;
  for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{
           {"b.png", "--camera", "Nikon D5100", "--full-well", "20000"},
           {"b.npy", "--camera", "Nikon D5100", "--read-noise", "2"},
           {"b.png", "--camera", "Nikon D5100", "--mosaic", "RGGB"},
           {"b.png", "--camera", "Nikon D5100", "--quantity", "volts"},
           {"b.npy", "--camera", "Nikon D5100", "--quantity", "electrons", "--conversion-gain", "3"},
           {"b.dng", "--camera", "Nikon D5100", "--mosaic", "XYZW"},
           {"b.png", "--camera", "Nikon D9"},
           {"b.png"}}) {
    std::vector<std::string> arguments = {"image", "sensor", folder / "a.exr"};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    const auto refused = run(arguments);
    EXPECT_EQ(refused.first, 2) << wrong.back() << ": " << refused.second;
  }
}

}  // namespace
}  // namespace etendue
