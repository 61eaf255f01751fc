// A sensor's digital numbers against the formulas of the standard, and its colours against computed ones.

#include "film/sensor.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "support/program_support.h"

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
  const Image raw = digital_numbers(
      picture_of({[&](double l) { return scale * daylight(l); }, [&](double l) { return 2 * scale * daylight(l); },
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
    const Image raw = digital_numbers(picture_of(radiances), sensor), picture = developed(raw, sensor, *lamp);
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

// The variance of a channel is that of the photons and of the read-out: (n + r^2) electrons^2. 4000 pixels: the estimate has a
// standard error of 2.2 %, and is held to 5 of them.
TEST(SensorNoiseTest, HasTheVarianceOfPhotonsAndReadOut) {
  Sensor sensor = colorimetric();
  sensor.bits = 16;
  sensor.noise = SensorNoise{1000, 8, 3};
  constexpr int count = 4000;
  const Image clean = digital_numbers(picture_of({[](double l) { return 0.03 * daylight(l); }}), [&] {
    Sensor quiet = sensor;
    quiet.noise.reset();
    return quiet;
  }());
  const Image noisy = digital_numbers(
      picture_of(std::vector<std::function<double(double)>>(count, [](double l) { return 0.03 * daylight(l); })), sensor);
  for (size_t c = 0; c < 3; ++c) {
    const double electrons = clean.at(0, 0, c) / 65535 * 1000;
    double sum = 0, squares = 0;
    for (int p = 0; p < count; ++p) {
      const double e = noisy.at(p, 0, c) / 65535 * 1000;
      sum += e;
      squares += e * e;
    }
    const double mean = sum / count, variance = squares / count - mean * mean, expected = electrons + 64;
    EXPECT_NEAR(mean, electrons, 5 * std::sqrt(expected / count));
    EXPECT_NEAR(variance / expected, 1, 0.11);
  }
  EXPECT_NE(noisy.metadata.at("noise"), "");
  EXPECT_EQ(
      noisy.values,
      digital_numbers(
          picture_of(std::vector<std::function<double(double)>>(count, [](double l) { return 0.03 * daylight(l); })), sensor)
          .values);
}

TEST(SensorErrors, AreSaid) {
  const Image image = picture_of({daylight});
  Sensor sensor = colorimetric();
  sensor.sensitivities[1] = table_spectrum({400, 500}, {1, -1});
  EXPECT_THROW(digital_numbers(image, sensor), Error);
  sensor.sensitivities[1] = flat_spectrum(0);
  EXPECT_THROW(digital_numbers(image, sensor), Error);
  EXPECT_THROW(digital_numbers(Image(1, 1, {"X", "Y", "Z"}), colorimetric()), Error);
  Image narrow(1, 1, {"X", "Y", "Z", "S0.500nm", "S0.510nm"});
  EXPECT_THROW(digital_numbers(narrow, colorimetric()), Error);
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
                          "--shutter", "0.0005", "--white", "D65", "--full-well", "20000"});
  ASSERT_EQ(photo.first, 0) << photo.second;
  EXPECT_EQ(run({"image", "sensor", folder / "a.exr", folder / "b.png", "--sensitivities", folder / "camera.csv", "--columns",
                 "red,green"})
                .first,
            2);
  EXPECT_EQ(run({"image", "sensor", folder / "a.exr", folder / "b.png", "--sensitivities", folder / "none.csv"}).first, 2);
}

}  // namespace
}  // namespace etendue
