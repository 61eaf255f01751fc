// GridVolume, and media described by extinction and albedo. Monte Carlo means have fixed seeds.

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "etendue/describe/color.h"
#include "etendue/transport/medium.h"
#include "support/image_file.h"
#include "support/luminaire_test_support.h"

namespace etendue::test {
namespace {

Ref<VolumeShader> volume(const std::string& text) { return prepared_as<VolumeShader>(text); }

float extinction(const VolumeShader& v, const Point3& p) { return v.coefficients(p, 0, wavelengths()).extinction()[0]; }

/// A file in Mitsuba's volume format; its header may be invalid.
struct VolumeFile {
  ImageFile place;
  VolumeFile(const std::string& name, const std::vector<std::int32_t>& header, const std::vector<float>& box,
             const std::vector<float>& values, const char* magic = "VOL\3")
      : place(name) {
    std::ofstream file(place.path, std::ios::binary);
    file.write(magic, 4);
    file.write(reinterpret_cast<const char*>(header.data()), std::streamsize(header.size() * 4));
    file.write(reinterpret_cast<const char*>(box.data()), std::streamsize(box.size() * 4));
    file.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size() * 4));
  }
};

TEST(HomogeneousVolume, ExtinctionAndAlbedoSayTheSame) {
  const Ref<VolumeShader> a = volume("HomogeneousVolume { extinction: 3, albedo: rgb(0.9, 0.5, 0.2) }");
  const Wavelengths w = wavelengths();
  const Color albedo = rgb_color("srgb", 0.9, 0.5, 0.2);
  const VolumeCoefficients c = a->coefficients({}, 0, w);
  for (int i = 0; i < spectrum_size; ++i) {
    EXPECT_NEAR(c.extinction()[i], 3, 1e-6f);
    EXPECT_NEAR(c.scattering[i], 3 * albedo->at(w[i], ColorUse::reflectance), 1e-5f);
  }
  expect_refused("HomogeneousVolume { extinction: 3, scattering: 1 }", "extinction", "only one way");
  expect_refused("HomogeneousVolume { extinction: 3, albedo: 1.2 }", "albedo", "between 0 and 1");
  expect_refused("HomogeneousVolume { extinction: -3 }", "extinction", "negative");
}

// The values of cells are a linear function of their centres, so interpolation gives that function; x varies fastest.
TEST(GridVolume, IsLinearBetweenTheMiddlesOfCells) {
  const auto wanted = [](const Point3& p) { return 1 + 2 * p.x + 3 * p.y + 5 * p.z; };
  std::string numbers;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x)
        numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ",
                               wanted({(float(x) + 0.5f) / 4, (float(y) + 0.5f) / 3, (float(z) + 0.5f) / 2}));
  const std::string grid = "resolution: [4, 3, 2], density: [" + numbers + "], extinction: 2, albedo: 0.5";
  const Ref<VolumeShader> v = volume("GridVolume { " + grid + " }");
  for (const Point3 p : {Point3{0.2f, 0.3f, 0.4f}, Point3{0.5f, 0.8f, 0.7f}, Point3{0.125f, 0.5f, 0.25f}})
    EXPECT_NEAR(extinction(*v, p), 2 * wanted(p), 1e-4f);
  // Outside of the grid: the value at the border by default, else as `outside` specifies. The border is at the centres of the
  // outermost cells.
  EXPECT_NEAR(extinction(*v, {-7, 0.5f, 0.5f}), 2 * wanted({0.125f, 0.5f, 0.5f}), 1e-4f);
  EXPECT_NEAR(extinction(*v, {0.5f, 9, 1.2f}), 2 * wanted({0.5f, 5 / 6.0f, 0.75f}), 1e-4f);
  EXPECT_EQ(extinction(*volume("GridVolume { " + grid + ", outside: empty }"), {1.01f, 0.5f, 0.5f}), 0);
  EXPECT_EQ(extinction(*volume("GridVolume { " + grid + ", outside: cut }"), {1.01f, 0.5f, 0.5f}), 0);
  // In the border itself: with `empty` the cells outside count for half, with `cut` they do not count.
  EXPECT_NEAR(extinction(*volume("GridVolume { " + grid + ", outside: empty }"), {1, 0.5f, 0.5f}), wanted({0.875f, 0.5f, 0.5f}),
              1e-4f);
  EXPECT_NEAR(extinction(*volume("GridVolume { " + grid + ", outside: cut }"), {1, 0.5f, 0.5f}),
              2 * wanted({0.875f, 0.5f, 0.5f}), 1e-4f);
  EXPECT_NEAR(extinction(*volume("GridVolume { " + grid + ", outside: repeat }"), {1.3f, -0.6f, 0.4f}),
              2 * wanted({0.3f, 0.4f, 0.4f}), 1e-4f);
  EXPECT_NEAR(extinction(*volume("GridVolume { " + grid + ", outside: mirror }"), {1.3f, -0.6f, 0.4f}),
              2 * wanted({0.7f, 0.6f, 0.4f}), 1e-4f);
  EXPECT_NEAR(extinction(*volume("GridVolume { " + grid + ", filter: nearest }"), {0.26f, 0.3f, 0.9f}),
              2 * wanted({0.375f, 1 / 6.0f, 0.75f}), 1e-4f);
  // The placement of the grid in object space.
  EXPECT_NEAR(
      extinction(*volume("GridVolume { " + grid + ", placement: translate([1, 0, 0]) * scale(2) }"), {1.4f, 0.6f, 0.8f}),
      2 * wanted({0.2f, 0.3f, 0.4f}), 1e-4f);
  EXPECT_NEAR(v->majorant(wavelengths())[0], 2 * wanted({0.875f, 5 / 6.0f, 0.75f}), 1e-3f);
}

TEST(GridVolume, ReadsFiles) {
  const std::vector<float> values{1, 2, 3, 4, 5, 6, 7, 8}, box{-1, -1, -1, 3, 3, 3};
  const VolumeFile file("eight.vol", {1, 2, 2, 2, 1}, box, values);
  const Ref<VolumeShader> of_file = volume("GridVolume { file: \"" + file.place.path + "\", extinction: 1 }"),
                          in_box = volume("GridVolume { file: \"" + file.place.path + "\", extinction: 1, file_box: true }"),
                          of_list =
                              volume("GridVolume { resolution: [2, 2, 2], density: [1, 2, 3, 4, 5, 6, 7, 8], extinction: 1 }");
  for (const Point3 p : {Point3{0.1f, 0.2f, 0.9f}, Point3{0.6f, 0.3f, 0.4f}}) {
    EXPECT_EQ(extinction(*of_file, p), extinction(*of_list, p));
    EXPECT_NEAR(extinction(*in_box, {4 * p.x - 1, 4 * p.y - 1, 4 * p.z - 1}), extinction(*of_list, p), 1e-5f);
  }
  // An RGB grid of albedos.
  std::vector<float> colors;
  for (int i = 0; i < 8; ++i) colors.insert(colors.end(), {i % 2 ? 0.8f : 0.2f, 0.5f, 0.5f});
  const VolumeFile albedo("albedo.vol", {1, 2, 2, 2, 3}, box, colors);
  const Ref<VolumeShader> both =
      volume("GridVolume { extinction: 2, albedo_file: \"" + albedo.place.path + "\", filter: nearest }");
  const Wavelengths w = wavelengths();
  for (const float x : {0.2f, 0.8f})
    for (int i = 0; i < spectrum_size; ++i) {
      const VolumeCoefficients c = both->coefficients({x, 0.2f, 0.2f}, 0, w);
      EXPECT_NEAR(c.scattering[i] / c.extinction()[i],
                  rgb_color("srgb", x > 0.5f ? 0.8 : 0.2, 0.5, 0.5)->at(w[i], ColorUse::reflectance), 2e-3f);
    }
}

TEST(GridVolume, RefusesWhatIsNoGrid) {
  const std::vector<float> eight(8, 1), box{0, 0, 0, 1, 1, 1};
  const auto refused = [](const VolumeFile& file, const char* words, const char* more = "") {
    expect_refused("GridVolume { file: \"" + file.place.path + "\"" + more + " }", "file", words);
  };
  refused({"a.vol", {1, 2, 2, 2, 1}, box, eight, "POL\3"}, "VOL");
  refused({"b.vol", {1, 2, 2, 2, 1}, box, eight, "VOL\2"}, "version");
  refused({"c.vol", {4, 2, 2, 2, 1}, box, eight}, "encoded");
  refused({"d.vol", {1, 2, 2, 3, 1}, box, eight}, "bytes long");
  refused({"e.vol", {1, -2, 2, 2, 1}, box, eight}, "no size");
  refused({"f.vol", {1, 2000000000, 2000000000, 2000000000, 3}, box, eight}, "no size");
  refused({"g.vol", {1, 2, 2, 1, 2}, box, eight}, "channel");
  refused({"h.vol", {1, 1, 1, 1, 1}, box, {-1}}, "negative");
  refused({"i.vol", {1, 1, 1, 1, 1}, box, {std::nanf("")}}, "no number");
  refused({"j.vol", {1}, {}, {}}, "too short");
  refused({"k.vol", {1, 1, 1, 1, 1}, {0, 0, 0, 1, 0, 1}, {1}}, "box", ", file_box: true");
  expect_refused("GridVolume { resolution: [2, 2, 2], density: [1, 2] }", "density", "for a grid of 8");
  expect_refused("GridVolume { resolution: [2, 0, 2] }", "resolution", "at least 1");
  expect_refused("GridVolume { density: [-1] }", "density", "negative");
  // Values that filters leave slightly below 0 count as 0.
  const Ref<VolumeShader> rounded = volume("GridVolume { resolution: [2, 1, 1], density: [-0.004, 1], extinction: 1 }");
  EXPECT_EQ(extinction(*rounded, {0.25f, 0.5f, 0.5f}), 0);
  expect_refused("GridVolume { resolution: [2, 1, 1], density: [-0.1, 1] }", "density", "negative");
}

// The optical depth of a ramp along x from 1/4 to 3/4: with densities 0 and 4 at the centres of two cells it is 8 (x - 1/4),
// whose integral over this half is 1, times an extinction of 3.
TEST(GridVolume, LetsThroughWhatTheIntegralSays) {
  const Ref<VolumeShader> v = volume("GridVolume { resolution: [2, 1, 1], density: [0, 4], extinction: 3, albedo: 0.5 }");
  const Ref<SceneObject> inside = create<SceneObject>("Sphere");
  const Medium medium{v.get(), inside.get()};
  const Ref<Sampler> sampler = create<Sampler>("IndependentSampler");
  Ray ray;
  ray.origin = {0.25f, 0.3f, 0.3f};
  ray.direction = {1, 0, 0};
  const Wavelengths w = wavelengths();
  double sum = 0, squares = 0;
  constexpr int n = 40000;
  for (int i = 0; i < n; ++i) {
    NumberStream stream(*sampler, SampleKey(7, 0, 0, std::uint32_t(i)));
    const double t = double(transmittance(medium, ray, 0.5f, w, stream)[0]);
    sum += t / n;
    squares += t * t / n;
  }
  EXPECT_NEAR(sum, std::exp(-3.0), 4 * std::sqrt((squares - sum * sum) / n));
}

// A ray that has slipped through an edge of the surface would stay in the medium for ever. The medium ends with its object:
// from the middle the optical depth of the ramp and of the rest, density 4 over a length of 1/4, is 3/4 + 1, and outside it is
// none. (Without the end this test would not finish.)
TEST(GridVolume, EndsWithItsObjectWhereNothingElseEndsARay) {
  const Ref<VolumeShader> v = volume("GridVolume { resolution: [2, 1, 1], density: [0, 4], extinction: 1, outside: cut }");
  const Ref<SceneObject> box = prepared_as<SceneObject>("Box { centre: [0.5, 0.5, 0.5] m, size: [1, 1, 1] m }");
  const Medium medium{v.get(), box.get()};
  const Ref<Sampler> sampler = create<Sampler>("IndependentSampler");
  const Wavelengths w = wavelengths();
  Ray ray;
  ray.origin = {0.5f, 0.3f, 0.3f};
  ray.direction = {1, 0, 0};
  double sum = 0, squares = 0;
  constexpr int n = 40000;
  for (int i = 0; i < n; ++i) {
    NumberStream stream(*sampler, SampleKey(7, 0, 0, std::uint32_t(i)));
    const double t = double(transmittance(medium, ray, infinity, w, stream)[0]);
    sum += t / n;
    squares += t * t / n;
  }
  EXPECT_NEAR(sum, std::exp(-1.75), 4 * std::sqrt((squares - sum * sum) / n));
  ray.origin = {1.5f, 0.3f, 0.3f};
  NumberStream stream(*sampler, SampleKey(7, 0, 0, 1));
  EXPECT_EQ(transmittance(medium, ray, infinity, w, stream)[0], 1.0f);
  EXPECT_FALSE(sample_free_flight(medium, ray, infinity, Spectrum(1.0f), w, stream).scattered);
}

}  // namespace
}  // namespace etendue::test
