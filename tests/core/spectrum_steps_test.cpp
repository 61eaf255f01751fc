// Tables with steps have the tabulated values at every wavelength: for every kind of table, both in evaluate(), at the
// wavelengths of a path, and in at(), at a single wavelength; and a medium's transmittance follows.

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "etendue/describe/color.h"
#include "etendue/render/job.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

Wavelengths at_wavelengths(float first, float step) {
  Wavelengths w;
  for (int i = 0; i < spectrum_size; ++i) w.place(i, first + step * float(i), 1.0f / 470);
  return w;
}

/// The value that the table defines: linear between entries, 0 outside.
double written(const std::vector<float>& x, const std::vector<float>& y, float w) {
  if (w < x.front() || w > x.back()) return 0;
  for (size_t i = 1; i < x.size(); ++i)
    if (w <= x[i]) {
      const double f = (double(w) - double(x[i - 1])) / (double(x[i]) - double(x[i - 1]));
      return (1 - f) * double(y[i - 1]) + f * double(y[i]);
    }
  return 0;
}

struct Table {
  const char* name;
  std::vector<float> x, y;
};

const std::vector<Table>& tables() {
  static const std::vector<Table> all = {
      {"step between whole nanometres", {400, 500, 500.001f, 700}, {1, 1, 3, 3}},
      {"step around a whole nanometre", {400, 499.9995f, 500.0005f, 700}, {1, 1, 3, 3}},
      {"step inside a nanometre", {400, 500.4f, 500.401f, 700}, {1, 1, 0, 0}},
      {"box", {499.999f, 500, 520, 520.001f}, {0, 2, 2, 0}},
      {"narrow box", {550.3f, 550.301f, 551.2f, 551.201f}, {0, 2, 2, 0}},
      {"ends that are not zero", {420, 640}, {2, 1}},
      {"ends inside a nanometre", {420.3f, 640.7f}, {2, 1}},
      {"bends that are not whole", {400.5f, 450.5f, 500.5f, 600.5f}, {0, 4, 1, 1}},
      {"finer than a nanometre", {500, 500.25f, 500.5f, 500.75f, 501, 501.5f, 700}, {0, 1, 0, 1, 2, 2, 0}},
      {"whole nanometres", {400, 500, 501, 700}, {1, 1, 3, 3}},
  };
  return all;
}

TEST(SpectrumSteps, EvaluateIsWhatIsWritten) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> any(360, 830 - 8), near(-3, 3);
  for (const Table& t : tables()) {
    const Color plain = table_spectrum(t.x, t.y), scaled = scaled_spectrum(2, plain);
    double most = 0;
    for (const float y : t.y) most = std::max(most, double(y));
    for (int i = 0; i < 4000; ++i) {
      const float first = i % 2 == 0 ? any(random) : t.x[size_t(i / 2) % t.x.size()] + near(random);
      const Wavelengths w = at_wavelengths(first, 0.37f);
      for (const ColorUse use : {ColorUse::reflectance, ColorUse::coefficient, ColorUse::radiance}) {
        const Spectrum s = plain->evaluate(w, use), twice = scaled->evaluate(w, use);
        for (int k = 0; k < spectrum_size; ++k) {
          const double expected = written(t.x, t.y, w[k]);
          ASSERT_NEAR(s[k], expected, 2e-3 * most) << t.name << " at " << w[k];
          ASSERT_NEAR(twice[k], 2 * expected, 4e-3 * most) << t.name << " at " << w[k];
          ASSERT_NEAR(plain->at(w[k], use), expected, 1e-5 * most) << t.name << " at " << w[k];
        }
      }
    }
  }
}

TEST(SpectrumSteps, FilesAndIndices) {
  const std::string path = testing::TempDir() + "steps.csv";
  std::ofstream(path) << "nm,k\n400,1\n499.5,1\n499.501,3\n700,3\n";
  const Color file = file_spectrum({path, {}});
  const Color index = complex_index(flat_spectrum(1.5f), file);
  const Wavelengths w = at_wavelengths(499.0f, 0.2f);
  for (int k = 0; k < spectrum_size; ++k) {
    const float expected = w[k] <= 499.5f ? 1.0f : 3.0f;
    EXPECT_NEAR(file->evaluate(w, ColorUse::coefficient)[k], expected, 1e-3f) << w[k];
    EXPECT_NEAR(index->imaginary()->evaluate(w, ColorUse::coefficient)[k], expected, 1e-3f) << w[k];
  }
}

// An illuminant is 0 outside its table: F11's begins at 380 nm.
TEST(SpectrumSteps, IlluminantsEndWhereTheirTablesDo) {
  const Color lamp = illuminant_spectrum("F11");
  const Wavelengths w = at_wavelengths(379.0f, 0.14f);
  const Spectrum s = lamp->evaluate(w, ColorUse::radiance);
  for (int k = 0; k < spectrum_size; ++k) {
    if (w[k] < 380)
      EXPECT_EQ(s[k], 0) << w[k];
    else
      EXPECT_GT(s[k], 0) << w[k];
    EXPECT_EQ(lamp->at(w[k], ColorUse::radiance), s[k]);
  }
}

// Spectral lines that randomly sampled wavelengths would rarely hit keep their power as light (seen through a slit of 2 nm); as
// absorption they keep their values.
TEST(SpectrumSteps, NarrowLinesOfLightAreSeenThroughASlit) {
  const Color line = table_spectrum({550.20f, 550.21f, 550.22f}, {0, 100, 0});  // its integral is 1
  double sum = 0, highest = 0;
  for (float x = 548; x < 553; x += 0.01f) {
    const double value = line->evaluate(at_wavelengths(x, 0.0f), ColorUse::radiance)[0];
    EXPECT_NEAR(line->at(x, ColorUse::radiance), value, 1e-4);
    sum += 0.01 * value;
    highest = std::max(highest, value);
  }
  EXPECT_NEAR(sum, 1, 0.01);
  EXPECT_LT(highest, 1.1);
  EXPECT_NEAR(line->evaluate(at_wavelengths(550.21f, 0), ColorUse::coefficient)[0], 100, 0.5);
  EXPECT_EQ(line->evaluate(at_wavelengths(550.23f, 0), ColorUse::coefficient)[0], 0);
}

// A medium that is clear below 555.5 nm and black above, lit in the last nanometre below the step or in the first one above:
// all of the former light gets through and none of the latter.
TEST(SpectrumSteps, AMediumWithAStep) {
  const auto seen = [](const std::string& light) {
    return measure(job_text("PathTracer { samples: 4096 }",
                            "OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 1e-3 }", 4,
                            "Sphere { shader: PassThrough {}, interior: HomogeneousVolume { absorption: spectrum([360, 555.5, "
                            "555.501, 830], [0, 0, 50, 50]) } }\n"
                            "Environment { emission: EnvironmentEmission { radiance: " +
                                light + " } }\n"))
        .mean.y;
  };
  const double before = seen("spectrum([554.5, 554.501, 555.499, 555.5], [0, 100, 100, 0])"),
               behind = seen("spectrum([555.501, 555.502, 556.5, 556.501], [0, 100, 100, 0])");
  EXPECT_GT(before, 0.7);  // about 100 nm times ybar = 1 over 106.857 nm
  EXPECT_LT(behind, 1e-6 * before);
}

TEST(SpectrumSteps, RangesKnowWhatLiesBetweenWholeNanometres) {
  const ValueRange r = range_of(*table_spectrum({400, 500.3f, 500.4f, 500.5f, 700}, {1, 1, -2, 7, 1}), ColorUse::coefficient);
  EXPECT_EQ(r.least, -2);
  EXPECT_EQ(r.most, 7);
  EXPECT_EQ(r.least_at, 500.4f);
  EXPECT_EQ(r.most_at, 500.5f);
  // Negative absorption throws Error, wherever in the table it is; so does a reflectance above 1.
  const auto check = [](const std::string& object) {
    prepare_tree(
        *load_job_text(job_text("PathTracer {}", "PerspectiveCamera { from: [0, 0, 5], to: [0, 0, 0] }", 4, object), "t.etd"));
  };
  EXPECT_THROW(check("Sphere { shader: PassThrough {}, interior: HomogeneousVolume { absorption: spectrum([400, 500.3, 500.4, "
                     "500.5, 700], [1, 1, -2, 1, 1]) } }"),
               Error);
  EXPECT_THROW(
      check("Sphere { shader: Lambertian { color: spectrum([400, 551.3, 551.4, 551.5, 700], [0.5, 0.5, 1.2, 0.5, 0.5]) } }"),
      Error);
}

}  // namespace
}  // namespace etendue::test
