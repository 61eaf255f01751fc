// Spectral films: the bands hold the light that the colour is made of, by every renderer, in any order of steps.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "color/tables.h"
#include "etendue/describe/color.h"
#include "film/film_members.h"
#include "film/image_bands.h"
#include "support/render_support.h"

namespace etendue {
namespace {

/// Objects of all kinds, so that every renderer has something to show, and light that varies with the wavelength.
std::string room(const std::string& renderer, const std::string& image) {
  return "Job { renderer: " + renderer + "\n image: " + image + R"(
        camera: PerspectiveCamera { from: [0.1, 0.2, -3.5] m, to: [0, 0, 0] m, fov: 50 deg }
        scene: BruteForceScene { objects: [
          Rectangle { corner: [-2, -1, -2] m, edge_u: [0, 0, 4] m, edge_v: [4, 0, 0] m,
                      shader: Lambertian { color: rgb(0.7, 0.4, 0.1) } }
          Sphere { centre: [-0.7, -0.4, 0] m, radius: 0.6 m, shader: Dielectric { ior: glass("N-SF11") } }
          Sphere { centre: [0.8, -0.4, 0.2] m, radius: 0.6 m,
                   shader: PhongShader { color: rgb(0.1, 0.3, 0.5), specular: 0.5, exponent: 40 } }
          Rectangle { corner: [-0.5, 1.5, -0.5] m, edge_u: [1, 0, 0] m, edge_v: [0, 0, 1] m, shader: Lambertian { color: 0.5 }
                      emission: DiffuseEmission { radiance: blackbody(3000 K) * 1e-10, sides: both } }
          Point { transform: translate(0, 1 m, -2 m), emission: DiffuseEmission { radiance: illuminant("D65") } }
        ] } })";
}

Image picture(const std::string& text, RenderSettings settings = {}) {
  const auto render = test::rendered(load_job_text(text, "test.etd"), std::move(settings));
  EXPECT_EQ(render->film().bad_samples(), 0u);
  return render->picture();
}

/// A response curve of the CIE observer as a table in the language.
std::string curve(size_t component) {
  std::string wavelengths, values;
  for (int i = 0; i < tables::size; ++i) {
    wavelengths += fmt::format("{}{}", i ? ", " : "", 360 + i);
    values += fmt::format("{}{}", i ? ", " : "", tables::observer[i][component]);
  }
  return "spectrum([" + wavelengths + "], [" + values + "])";
}

double integral(size_t component) {
  double sum = 0;
  for (int i = 0; i < tables::size; ++i) sum += (i == 0 || i + 1 == tables::size ? 0.5 : 1) * tables::observer[i][component];
  return sum;
}

std::vector<std::string> all_renderers() {
  std::vector<std::string> names;
  const ClassInfo* interface = Registry::instance().find("Renderer");
  for (const ClassInfo* c : Registry::instance().subclasses(*interface))
    if (c != interface && c->provider.empty()) names.push_back(c->name);
  return names;
}

double mean(const Image& image, size_t channel) {
  double sum = 0;
  for (size_t i = channel; i < image.values.size(); i += image.channels.size()) sum += image.values[i];
  return sum / (double(image.width) * double(image.height));
}

class SpectralRenderers : public testing::TestWithParam<std::string> {};

// The response curves of the observer make the colour: for each pixel, by every renderer, to the rounding of floats.
TEST_P(SpectralRenderers, MeasureTheColourThroughTheObserversCurves) {
  if (GetParam() == "AmbientOcclusionRenderer" || GetParam() == "FeatureRenderer") GTEST_SKIP();
  const std::string film = "SpectralFilm { width: 12, height: 9, response_names: [\"x\", \"y\", \"z\"], responses: [" +
                           curve(0) + ", " + curve(1) + ", " + curve(2) + "] }";
  const Image image = picture(room(GetParam() + " { samples: 8 }", film));
  ASSERT_EQ(image.channels.size(), 6u);
  EXPECT_EQ(image.channels[4], "response.y");
  double most = 0;
  for (const double v : image.values) most = std::max(most, v);
  ASSERT_GT(most, 0);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (size_t c = 0; c < 3; ++c) {
        const double band = image.at(x, y, 3 + c) * integral(c) / observer_y_integral();
        EXPECT_NEAR(band, image.at(x, y, c), 1e-5 * std::abs(image.at(x, y, c)) + 1e-7 * most) << x << "," << y << " " << c;
      }
}

// The mean radiance in the bands times their widths is all light; with the observer in the middle of narrow bands it is the
// colour of the whole picture. Renderers that show no light make their colours of a few wavelengths: they have no spectrum, and
// are refused.
TEST_P(SpectralRenderers, FindAllLightInNarrowBands) {
  if (GetParam() == "AmbientOcclusionRenderer" || GetParam() == "FeatureRenderer") {
    EXPECT_THROW(picture(room(GetParam() + " {}", "SpectralFilm {}")), Error);
    GTEST_SKIP();
  }
  const auto render = test::rendered(
      load_job_text(room(GetParam() + " { samples: 512 }", "SpectralFilm { width: 12, height: 9, bands: 1880 }"), "test.etd"));
  EXPECT_EQ(render->film().bad_samples(), 0u);
  const Image image = render->picture();
  const std::vector<ImageBand> bands = bands_of(image);
  ASSERT_EQ(bands.size(), 1880u);
  // Where light subpaths of a step are shared by all camera paths, all these carry the same wavelengths: n in the whole render.
  // The observer is taken in the middle of a band in place of at each of them, which is wrong by a number of the mean 0. Over
  // seeds, the relative error of Z has a standard deviation of 2.2e-3 / sqrt(n) with these bands; X and Y have less. Five of
  // them are allowed. The curves as responses, above, are right to rounding: no light is missing.
  double tolerance = 1e-4;
  if (GetParam() == "PhotonMapper" || GetParam() == "ManyLights" || GetParam() == "InstantRadiosity") {
    const size_t wavelengths = size_t(spectrum_size) * ((512 + render->samples_per_step() - 1) / render->samples_per_step());
    tolerance = 5 * 2.2e-3 / std::sqrt(double(wavelengths));
    size_t lit = 0;
    for (const ImageBand& band : bands) lit += mean(image, band.channel) > 0;
    EXPECT_LE(lit, wavelengths);
    EXPECT_GT(lit, std::min<size_t>(wavelengths, bands.size()) / 2);
  }
  Xyz of_bands, of_colour;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      of_colour += Xyz{image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
      for (const ImageBand& band : bands)
        of_bands += 0.25 * image.at(x, y, band.channel) / observer_y_integral() * observer(float(band.wavelength));
    }
  EXPECT_NEAR(of_bands.x / of_colour.x, 1, tolerance);
  EXPECT_NEAR(of_bands.y / of_colour.y, 1, tolerance);
  EXPECT_NEAR(of_bands.z / of_colour.z, 1, tolerance);
}

INSTANTIATE_TEST_SUITE_P(All, SpectralRenderers, testing::ValuesIn(all_renderers()), [](const auto& i) { return i.param; });

std::string lamp(const std::string& radiance, const std::string& film, const std::string& renderer = "PathTracer") {
  return "Job { renderer: " + renderer + " { samples: 1024 }\n image: SpectralFilm { width: 4, height: 4, " + film + R"( }
        camera: PerspectiveCamera { from: [0, 0, -3] m, to: [0, 0, 0] m, fov: 20 deg }
        scene: BruteForceScene { objects: [ Sphere { radius: 1 m, emission: DiffuseEmission { radiance: )" +
         radiance + " } } ] } }";
}

// All light of a line from 546 to 548 nm is in the band from 540 to 550 nm, and nearly all that makes Y.
TEST(SpectralFilm, PutsALineIntoItsBand) {
  for (const std::string renderer : {"PathTracer", "LightTracer", "BidirectionalPathTracer"}) {
    const Image image = picture(lamp("spectrum([546, 547, 548], [0, 3, 0])", "bands: 47", renderer));
    ASSERT_GT(mean(image, 1), 0) << renderer;
    for (const ImageBand& band : bands_of(image))
      if (band.wavelength == 545)
        EXPECT_NEAR(mean(image, band.channel) * 10 * observer(547).y / observer_y_integral() / mean(image, 1), 1, 2e-3)
            << renderer;
      else
        EXPECT_EQ(mean(image, band.channel), 0) << renderer << " " << band.wavelength;
  }
}

// A flat spectrum of 2 is 2 in every band, however wide.
TEST(SpectralFilm, HoldsMeanRadianceInBandsOfAnyWidth) {
  const Image image = picture(lamp("2", "edges: [400, 401.5, 430, 700, 830] nm"));
  const std::vector<ImageBand> bands = bands_of(image);
  ASSERT_EQ(bands.size(), 4u);
  EXPECT_EQ(image.channels[3], "S0.400,75nm");
  EXPECT_EQ(band_edges_of(image), (std::vector<double>{400, 401.5, 430, 700, 830}));
  for (const ImageBand& band : bands) EXPECT_NEAR(mean(image, band.channel), 2, band.wavelength < 401 ? 0.2 : 0.02);
}

std::string spectral(const std::string& more = "") {
  return "SpectralFilm { width: 60, height: 41, bands: 8, path_lengths: 2" + more + " }";
}

// Steps on one film, and on two films of which one is added to the other, have the same bytes; the picture keeps its bytes
// without bands.
TEST(SpectralFilm, SumsDoNotDependOnTheirOrder) {
  for (const std::string renderer : {"PathTracer", "BidirectionalPathTracer"}) {
    const std::string text = room(renderer + " { samples: 400 }", spectral());
    const auto job = [&] { return load_job_text(text, "test.etd"); };
    const auto whole = test::rendered(job());
    const std::uint32_t steps = (400 + whole->samples_per_step() - 1) / whole->samples_per_step();
    ASSERT_GT(steps, 1u);
    Render early(job(), {.steps = IndexRange{0, 1}}), late(job(), {.steps = IndexRange{1, steps}});
    early.run();
    late.run();
    ASSERT_GT(late.film().samples(), 0u);
    const std::vector<std::byte> state = early.film().save_state();
    late.film().add_state(state);
    EXPECT_TRUE(late.film().save_state() == whole->film().save_state()) << renderer;

    const Image with = whole->picture(),
                without =
                    picture(room(renderer + " { samples: 400 }", "ImageBuffer { width: 60, height: 41, path_lengths: 2 }"));
    ASSERT_EQ(with.channels.size(), without.channels.size() + 8);
    for (size_t p = 0; p < size_t(with.width) * size_t(with.height); ++p)
      for (size_t c = 0; c < without.channels.size(); ++c)
        ASSERT_EQ(with.values[p * with.channels.size() + c], without.values[p * without.channels.size() + c]);
  }
}

// The pixels of a crop are those of the whole picture.
TEST(SpectralFilm, CropsAreParts) {
  const Image whole = picture(room("PathTracer { samples: 4 }", spectral())),
              part = picture(room("PathTracer { samples: 4 }", spectral(", crop: [3, 2, 12, 9]")));
  ASSERT_EQ(whole.channels, part.channels);
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x)
      for (size_t c = 0; c < part.channels.size(); ++c) ASSERT_EQ(part.at(x, y, c), whole.at(x + 3, y + 2, c));
}

// What another process packed is the same tile.
TEST(SpectralFilm, TilesTravelAsBytes) {
  const Ref<Job> job = load_job_text(room("PathTracer {}", spectral()), "test.etd");
  prepare_tree(*job);
  const Wavelengths wavelengths({450, 530, 600, 650, 700, 710, 720, 730}, {.01f, .01f, .01f, .01f, .01f, .01f, .01f, .01f});
  for (const bool camera : {false, true}) {
    Film direct(*job->image), unpacked(*job->image);
    ImageTile tile, other;
    tile.begin(*job->image, {0, 0, 60, 41});
    const std::array<Spectrum, 2> lengths = {Spectrum(0.5f), Spectrum(1.5f)};
    for (int i = 0; i < 20; ++i) {
      tile.count_path();
      if (camera) tile.contribute({float(i) + 0.5f, 5}, i, 5, 0, Spectrum(2.0f), wavelengths, 1, lengths);
      tile.splat({float(19 - i) + 0.3f, 7}, i, 5, 0, Spectrum(float(i)), wavelengths, 2);
    }
    std::vector<std::byte> bytes;
    tile.pack(bytes);
    std::span<const std::byte> rest(bytes);
    unpacked.unpack(rest, other);
    direct.merge(tile);
    unpacked.merge(other);
    direct.end_step();
    unpacked.end_step();
    EXPECT_TRUE(direct.save_state() == unpacked.save_state());
    const Image image = direct.develop();
    EXPECT_GT(image.at(10, 7, image.channels.size() - 1) + image.at(10, 7, image.channels.size() - 3), 0);
  }
}

// States of other bands are not added.
TEST(SpectralFilm, StatesOfOtherBandsAreRefused) {
  const auto rendered = [](const std::string& film) {
    return test::rendered(load_job_text(room("PathTracer { samples: 1 }", film), "test.etd"));
  };
  const auto a = rendered("SpectralFilm { width: 4, height: 4, bands: 8 }");
  for (const char* other :
       {"SpectralFilm { width: 4, height: 4, bands: 7 }", "SpectralFilm { width: 4, height: 4, bands: 8, low: 400 nm }",
        "ImageBuffer { width: 4, height: 4 }"})
    EXPECT_THROW(rendered(other)->film().add_state(a->film().save_state()), Error) << other;
}

TEST(SpectralFilm, SaysWhatIsWrong) {
  const auto complaint = [](const std::string& film) -> std::string {
    try {
      const Ref<Job> job = load_job_text(lamp("1", film), "test.etd");
      prepare_tree(*job);
    } catch (const Errors& e) {
      return e.errors.at(0).what();
    } catch (const Error& e) {
      return e.what();
    }
    return {};
  };
  const std::pair<const char*, const char*> cases[] = {{"edges: [400] nm", "two edges"},
                                                       {"edges: [400, 400] nm", "must increase"},
                                                       {"edges: [300, 500] nm", "outside of 360 to 830"},
                                                       {"low: 500 nm, high: 500 nm", "must exceed low"},
                                                       {"responses: [spectrum([400, 500], [1, -1])]", "negative"},
                                                       {"responses: [spectrum([400, 500], [0, 0])]", "no sensitivity"},
                                                       {"responses: [1], response_names: [\"a\", \"b\"]", "2 names for 1"},
                                                       {"responses: [1, 1], response_names: [\"a\", \"a\"]", "named twice"},
                                                       {"responses: [1], response_names: [\"a.b\"]", "cannot name a channel"},
                                                       {"responses: [1], edges: [400, 500] nm", "not both"},
                                                       {"bands: 0", "bands"}};
  for (const auto& [film, reason] : cases)
    EXPECT_NE(complaint(film).find(reason), std::string::npos) << film << ": " << complaint(film);
}

TEST(SpectralFilm, NamesOfBandsAreThoseOfTheLayout) {
  const auto wavelength = [](const char* name) {
    const std::optional<ImageBand> band = band_of_name(name);
    return band ? band->wavelength : -1;
  };
  EXPECT_EQ(wavelength("S0.405,5nm"), 405.5);
  EXPECT_EQ(wavelength("T.0,55um"), 550);
  EXPECT_EQ(wavelength("S0.5,5E-7m"), 550);
  EXPECT_NEAR(wavelength("S0.500THz"), 599.584916, 1e-6);
  for (const char* name : {"S1.405nm", "S0.405", "S0.nm", "light.a.X", "S0.405qm", "R", "S0.0nm"})
    EXPECT_EQ(wavelength(name), -1) << name;
}

}  // namespace
}  // namespace etendue
