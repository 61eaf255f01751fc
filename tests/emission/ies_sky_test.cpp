// Measured lamps: IES photometric files.

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "components/emission/ies_file.h"
#include "etendue/describe/color.h"
#include "etendue/emission_shader.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;
using List = std::vector<double>;

/// A temporary file, removed by the destructor.
struct TemporaryFile {
  std::string path;
  explicit TemporaryFile(const std::string& name)
      : path((std::filesystem::temp_directory_path() / ("etendue-" + std::to_string(getpid()) + "-" + name)).string()) {}
  TemporaryFile(const std::string& name, const std::string& text) : TemporaryFile(name) {
    std::ofstream(path, std::ios::binary) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path); }
};

/// An IES file of a photometric type; its intensities are a function of the (vertical, horizontal) angles.
std::string ies_text(int type, const List& vertical, const List& horizontal,
                     const std::function<double(double, double)>& candela, const std::string& tilt = "TILT=NONE",
                     const std::string& multiplier = "1") {
  std::string text = "IESNA:LM-63-2002\r\n[TEST] made here\r\n" + tilt + "\r\n1 -1 " + multiplier + " " +
                     std::to_string(vertical.size()) + " " + std::to_string(horizontal.size()) + " " + std::to_string(type) +
                     " 2 0 0 0\r\n1 1 50\r\n";
  for (const double v : vertical) text += std::to_string(v) + " ";
  text += "\r\n";
  for (const double h : horizontal) text += std::to_string(h) + ",";
  text += "\r\n";
  for (const double h : horizontal) {
    for (const double v : vertical) text += std::to_string(candela(v, h)) + "\r\n";
  }
  return text;
}
List steps(double from, double to, double by) {
  List all;
  for (double a = from; a <= to + 1e-9; a += by) all.push_back(a);
  return all;
}
IesDistribution parse(const std::string& text) { return parse_ies(text, "lamp.ies"); }

constexpr double degree = M_PI / 180;

TEST(IesFile, LumensAreTheIntegralOverAllDirections) {
  const auto uniform = parse(ies_text(1, steps(0, 180, 10), {0}, [](double, double) { return 100; }));
  EXPECT_NEAR(uniform.lumens(), 400 * M_PI, 1e-6 * 400 * M_PI);
  // A Lambertian lamp of 1000 cd has 1000 pi lm, apart from the linear interpolation between angles 2.5 degrees apart.
  const auto lambertian =
      parse(ies_text(1, steps(0, 90, 2.5), {0}, [](double v, double) { return 1000 * std::cos(v * degree); }));
  EXPECT_NEAR(lambertian.lumens(), 1000 * M_PI, 1e-3 * 1000 * M_PI);
  EXPECT_EQ(lambertian.at(90.5, 0), 0);
  // By the midpoint rule over the sphere, for intensities that vary in both angles.
  const auto varied = parse(ies_text(1, steps(0, 180, 15), steps(0, 360, 30), [](double v, double h) {
    return 50 + 40 * std::cos(3 * v * degree) * std::cos(h * degree);
  }));
  double sum = 0;
  constexpr int rows = 720, columns = 360;
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < columns; ++k) {
      const double theta = 180 * (i + 0.5) / rows;
      sum +=
          double(varied.at(theta, 360 * (k + 0.5) / columns)) * std::sin(theta * degree) * 2 * M_PI * M_PI / (rows * columns);
    }
  EXPECT_NEAR(varied.lumens(), sum, 1e-5 * sum);
  EXPECT_NEAR(varied.lumens(0, 90) + varied.lumens(90, 180), sum, 1e-5 * sum);
}

TEST(IesFile, SymmetriesAreUnfolded) {
  const auto lamp = [](double v, double h) { return 100 + v + 10 * std::cos(2 * h * degree); };  // the same in all quadrants
  const auto all = parse(ies_text(1, steps(0, 90, 10), steps(0, 360, 10), lamp));
  const std::vector<IesDistribution> others = {parse(ies_text(1, steps(0, 90, 10), steps(0, 90, 10), lamp)),
                                               parse(ies_text(1, steps(0, 90, 10), steps(0, 180, 10), lamp)),
                                               parse(ies_text(1, steps(0, 90, 10), steps(90, 270, 10), lamp)),
                                               parse(ies_text(1, steps(0, 90, 10), steps(0, 350, 10), lamp))};
  for (size_t i = 0; i < others.size(); ++i)
    for (const double h : {0.0, 33.0, 90.0, 147.0, 201.0, 275.0, 355.0, -20.0})
      EXPECT_NEAR(others[i].at(35, h), all.at(35, h), 1e-3) << i << " " << h;
  // Distributions that are not symmetric in all quadrants: given for half a turn, and symmetric about the plane of 90 and 270
  // degrees.
  const auto half = parse(ies_text(1, {0, 90}, {0, 90, 180}, [](double, double h) { return 1 + h; }));
  EXPECT_NEAR(half.at(45, 270), 91, 1e-3);
  EXPECT_NEAR(half.at(45, 181), 180, 1e-3);
  const auto side = parse(ies_text(1, {0, 90}, {90, 180, 270}, [](double, double h) { return 1 + h; }));
  EXPECT_NEAR(side.at(45, 0), 181, 1e-3);
  EXPECT_NEAR(side.at(45, 45), 136, 1e-3);
}

TEST(IesFile, TiltAndMultipliers) {
  const auto d = parse(
      ies_text(1, {0, 90}, {0}, [](double, double) { return 10; }, "TILT=INCLUDE\r\n1\r\n3\r\n0 45 90\r\n1.0 0.8 0.5", "2.5"));
  EXPECT_NEAR(d.greatest, 25, 1e-6);
  EXPECT_NEAR(d.tilt_factor(0), 1, 1e-6);
  EXPECT_NEAR(d.tilt_factor(67.5), 0.65, 1e-6);
  EXPECT_NEAR(d.tilt_factor(120), 0.5, 1e-6);
}

TEST(IesFile, BrokenFilesAreRefusedWithLineAndReason) {
  const std::string good = ies_text(1, {0, 45, 90}, {0, 90}, [](double v, double h) { return 100 - v + h; });
  const auto refusal = [](std::string text, const std::string& from, const std::string& to) -> std::string {
    const size_t at = text.find(from);
    if (at == std::string::npos) return "nothing to replace";
    try {
      parse(text.replace(at, from.size(), to));
    } catch (const Error& e) {
      return e.what();
    }
    return "read";
  };
  const auto expect = [&](const std::string& from, const std::string& to, const std::string& reason) {
    const std::string said = refusal(good, from, to);
    EXPECT_NE(said.find("'lamp.ies', line "), std::string::npos) << said;
    EXPECT_NE(said.find(reason), std::string::npos) << said;
  };
  expect("TILT=NONE", "TLIT=NONE", "no line that begins with TILT=");
  expect("TILT=NONE", "TILT=../../etc/passwd", "only TILT=NONE and TILT=INCLUDE");
  expect("TILT=NONE", "TILT=INCLUDE\n1\n1000000\n", "number of tilt angles");
  expect("1 -1 1 3 2 1", "1 -1 x 3 2 1", "line 4: the candela multiplier should be a number, but there is 'x'");
  expect("1 -1 1 3 2 1", "1 -1 nan 3 2 1", "should be a number");
  expect("1 -1 1 3 2 1", "1 -1 0 3 2 1", "product of the multiplier");
  expect("1 -1 1 3 2 1", "1 -1 1 3000000000 2 1", "number of vertical angles");
  expect("1 -1 1 3 2 1", "1 -1 1 7200 7200 1", "no room for 7200");
  expect("1 -1 1 3 2 1", "1 -1 1 3 -2 1", "number of horizontal angles");
  expect("1 -1 1 3 2 1", "1 -1 1 3 2 4", "photometric type");
  expect("0.000000 45.000000", "45.000000 45.000000", "must increase");
  expect("45.000000 90.000000", "45.000000 290.000000", "not within 0 to 180");
  expect("0.000000,90.000000,", "0.000000,60.000000,", "last horizontal angle should be 0, 90, 180 or 360");
  expect("100.000000\r\n55.000000", "100.000000\r\n-55.000000", "negative");
  expect("100.000000\r\n55.000000", "1e300\r\n55.000000", "absurd");
  EXPECT_NE(refusal(std::string(1000, 'x'), "x", "").find("no line that begins"), std::string::npos);
  EXPECT_THROW(read_ies_file("/nowhere/lamp.ies"), Error);
  EXPECT_THROW(read_ies_file("/tmp"), Error);
  EXPECT_THROW(parse(ies_text(1, {0, 90}, {0}, [](double, double) { return 0; })), Error);
}

TEST(IesFile, NoTextBreaksTheReader) {
  const std::string good =
      ies_text(1, {0, 45, 90}, {0, 90}, [](double v, double h) { return 100 - v + h; }, "TILT=INCLUDE\n1\n2\n0 90\n1 .5");
  int read = 0;
  const auto attempt = [&](const std::string& text) {
    try {
      const IesDistribution d = parse(text);
      EXPECT_TRUE(std::isfinite(d.lumens()) && d.lumens() > 0);
      EXPECT_TRUE(std::isfinite(d.at(37, 211)));
      ++read;
    } catch (const Error& e) {
      EXPECT_STRNE(e.what(), "");
    }
  };
  for (size_t length = 0; length + 3 < good.size(); ++length) {  // the last number may lose a digit
    const int before = read;
    attempt(good.substr(0, length));
    if (length + 12 < good.size()) {
      EXPECT_EQ(read, before) << length;
    }
  }
  std::mt19937 random(5);
  for (int i = 0; i < 4000; ++i) {
    std::string text = good;
    for (int k = 0; k < 1 + i % 4; ++k)
      text[random() % text.size()] = i % 2 ? char(random()) : "0123456789-+.eE ,\r\n"[random() % 19];
    attempt(text);
  }
  EXPECT_GT(read, 500);  // files with changed digits or labels are still valid
}

// ---- lamps ----------------------------------------------------------------------------------------------------------

/// Luminance [cd/m^2]; for a point light, intensity [cd].
double luminance(const EmissionShader& e, const SurfacePoint& p, const Vector3& direction) {
  double sum = 0;
  for (int lambda = 362; lambda < 830; lambda += 4) {  // the spectrum is flat
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i) w.place(i, float(lambda), 1 / 470.0f);
    sum += 4 * 683.002 * observer(float(lambda)).y * double(e.radiance(p, normalize(direction), w)[0]);
  }
  return sum;
}
SurfacePoint point_of(const SceneObject& o) { return o.sample_area({0.5f, 0.5f}, 0).point; }
Ref<EmissionShader> lamp_of(const std::string& path, std::vector<test::Setting> settings = {}) {
  settings.emplace_back("file", path);
  return create<EmissionShader>("IesEmission", settings);
}

TEST(IesEmission, GivesTheFilesCandelasInItsDirections) {
  const auto point = create<SceneObject>("Point");
  const SurfacePoint p = point_of(*point);
  {
    const TemporaryFile file(
        "c.ies", ies_text(1, steps(0, 180, 10), steps(0, 360, 10), [](double v, double h) { return 1000 + v + h; }));
    const auto e = lamp_of(file.path);
    // Downwards; at 90 degrees from the axis with horizontal angle 0; the same with horizontal angle 90, which is
    // counter-clockwise seen from above: from +x towards -z.
    EXPECT_NEAR(luminance(*e, p, {0, -1, 0}), 1000 + 0 + 180, 185);  // all horizontal angles meet here
    EXPECT_NEAR(luminance(*e, p, {1, 0, -1e-3f}), 1090, 1);
    EXPECT_NEAR(luminance(*e, p, {0, 0, -1}), 1180, 1);
    EXPECT_NEAR(luminance(*e, p, {-1, -1, 0}), 1000 + 45 + 180, 1);
    const auto brighter = lamp_of(file.path, {{"multiplier", 3.0}});
    EXPECT_NEAR(luminance(*brighter, p, {0, 0, -1}), 3540, 3);
    const auto asked = lamp_of(file.path, {{"luminous_flux", 500.0}});
    const double flux = read_ies_file(file.path).lumens();
    EXPECT_NEAR(luminance(*asked, p, {0, 0, -1}), 1180 * 500 / flux, 0.01);
  }
  for (const int type : {3, 2}) {  // types A and B: a beam along -z, up is +y, so right is +x; I = 1000 + v + 2 h
    const TemporaryFile file(
        "ab.ies", ies_text(type, steps(-90, 90, 10), steps(-90, 90, 10), [](double v, double h) { return 1000 + v + 2 * h; }));
    const auto e = lamp_of(file.path, {{"axis", List{0, 0, -1}}, {"across", List{0, 1, 0}}});
    EXPECT_NEAR(luminance(*e, p, {0, 0, -1}), 1000, 1);
    const float s = std::sin(30 * float(degree)), c = std::cos(30 * float(degree));
    EXPECT_NEAR(luminance(*e, p, {0, s, -c}), 1030, 1) << type;
    EXPECT_NEAR(luminance(*e, p, {s, 0, -c}), 1060, 1) << type;
    EXPECT_EQ(luminance(*e, p, {0.1f, 0.1f, 1}), 0);
    // Away from both axes the two types differ: A rotates about the vertical, B about the horizontal axis.
    const Vector3 a{s * c, s, -c * c}, b{s, s * c, -c * c};
    EXPECT_NEAR(luminance(*e, p, type == 3 ? a : b), 1090, 1) << type;
  }
}

TEST(IesEmission, OnASurfaceTheWholeHasTheFilesIntensities) {
  const TemporaryFile file("s.ies", ies_text(1, steps(0, 180, 5), steps(0, 90, 15), [](double v, double h) {
                             return 300 * std::pow(std::cos(v * degree), 2) + (v < 90 ? h : 0) * std::sin(v * degree);
                           }));
  const auto square = create<SceneObject>("Rectangle", {{"edge_u", List{2, 0, 0}}, {"edge_v", List{0, 1.5, 0}}});
  const IesDistribution d = read_ies_file(file.path);
  for (const char* sides : {"front", "back", "both"}) {
    const auto e = lamp_of(file.path, {{"sides", sides}});
    const SurfacePoint p = point_of(*square);
    const Vector3 up = normalize(Vector3{0.3f, 0.2f, 0.8f}), down = -1.0f * up;
    const double theta = std::acos(double(up.z)) / degree, phi = std::atan2(-0.2, 0.3) / degree;
    const double front = double(d.at(theta, phi)), behind = double(d.at(180 - theta, phi + 180));
    EXPECT_NEAR(luminance(*e, p, up) * 3 * double(up.z), std::string(sides) == "back" ? 0 : front, 1e-3 * front) << sides;
    EXPECT_NEAR(luminance(*e, p, down) * 3 * double(up.z), std::string(sides) == "front" ? 0 : behind, 1e-3 * behind) << sides;
    const double flux = std::string(sides) == "front"  ? d.lumens(0, 90)
                        : std::string(sides) == "back" ? d.lumens(90, 180)
                                                       : d.lumens();
    // A flat spectrum of 1 W/nm has a luminous flux of 683.002 * 106.857 lm.
    EXPECT_NEAR(double(e->power(*square, test::wavelengths())[0]) * 683.002 * observer_y_integral(), flux, 2e-3 * flux)
        << sides;
  }
}

// A distribution without symmetry about the normals of surfaces that face different ways: it is mirrored where the object is,
// and nowhere else.
TEST(IesEmission, AboutNormalsItIsMirroredOnlyWithTheObject) {
  const TemporaryFile file("n.ies", ies_text(1, steps(0, 180, 5), steps(0, 360, 5), [](double v, double h) {
                             return 1000 + 300 * std::sin(v * degree) * std::sin(h * degree);
                           }));
  const auto e = lamp_of(file.path, {{"sides", "front"}});
  for (const float side : {1.0f, -1.0f}) {  // faces +y, -y
    const auto square =
        create<SceneObject>("Rectangle", {{"edge_u", List{0, 0, 2}}, {"edge_v", List{double(side) * 1.5, 0, 0}}});
    const SurfacePoint p = point_of(*square);
    const Vector3 normal(p.normal), right{1, 0, 0}, t = cross(right, normal);  // counter-clockwise from above
    ASSERT_FLOAT_EQ(normal.y, side);
    const Vector3 w = normalize(0.3f * right + 0.5f * t + 0.6f * normal);
    const double expected = 1000 + 300 * std::hypot(0.3, 0.5) / std::hypot(0.3, 0.5, 0.6) * (0.5 / std::hypot(0.3, 0.5));
    EXPECT_NEAR(luminance(*e, p, w) * 3 * double(dot(w, normal)), expected, 2e-3 * expected) << side;
  }
}

/// The p-value of a chi-square test of samples against their pdf, which is integrated by the midpoint rule, on a uniform grid
/// of cells. `missing`: the integral of the pdf minus the fraction of valid samples.
double samples_follow(const EmissionShader& e, const SurfacePoint& p, std::uint32_t seed, double& missing) {
  constexpr int rows = 18, columns = 18, count = 60000, fine = 900;
  const Frame frame(Normal3{0, 0, 1});
  std::vector<double> counts(rows * columns), expected(rows * columns);
  test::Random random(seed);
  int drawn = 0;
  for (int i = 0; i < count; ++i) {
    const DirectionSample s = e.sample(p, random.pair());
    if (!(s.pdf > 0)) continue;
    ++drawn;
    ++counts[test::cell_of(frame, rows, columns, s.direction)];
  }
  double total = 0;
  for (int i = 0; i < fine * fine; ++i) {
    const double z = -1 + 2 * (i % fine + 0.5) / fine, phi = 2 * M_PI * (i / fine + 0.5) / fine, r = std::sqrt(1 - z * z);
    const Vector3 d{float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)};
    const double part = double(e.pdf(p, d)) * 4 * M_PI / (fine * fine);
    total += part;
    expected[test::cell_of(frame, rows, columns, d)] += part * count;
  }
  missing = total - double(drawn) / count;
  return test::chi_square(counts, expected);
}

TEST(IesEmission, SamplesFollowDensityAndPower) {
  const TemporaryFile file("n.ies", ies_text(1, steps(0, 120, 10), steps(0, 180, 30), [](double v, double h) {
                             return 10 + 500 * std::exp(-std::pow((v - 50) / 15, 2)) * (1 + std::cos(h * degree));
                           }));
  const auto point = create<SceneObject>("Point");
  const auto square = create<SceneObject>("Rectangle");
  std::uint32_t seed = 60;
  for (const char* sides : {"front", "both"}) {
    const auto e = lamp_of(file.path, {{"sides", sides}, {"axis", List{1, 1, -1}}});
    for (const SceneObject* object : {point.get(), square.get()}) {
      const SurfacePoint p = point_of(*object);
      double missing = 0;
      EXPECT_GT(samples_follow(*e, p, seed++, missing), test::each_of(4)) << sides;
      EXPECT_NEAR(missing, 0, 0.005);
      // The estimate of the power from samples; its weights vary little: most are within a factor of 2 of their mean.
      test::Random random(seed++);
      double sum = 0, squares = 0;
      constexpr int count = 20000;
      for (int i = 0; i < count; ++i) {
        const DirectionSample s = e->sample(p, random.pair());
        if (!(s.pdf > 0)) continue;
        const float cosine = object == point.get() ? 1 : std::abs(dot(p.normal, s.direction));
        const double value = double(e->radiance(p, s.direction, test::wavelengths())[0] * cosine / s.pdf);
        sum += value / count;
        squares += value * value / count;
      }
      const double power = double(e->power(*object, test::wavelengths())[0]);
      EXPECT_NEAR(sum, power, 0.01 * power) << sides;
      EXPECT_LT(squares - sum * sum, 0.2 * sum * sum);
    }
  }
}

}  // namespace
}  // namespace etendue
