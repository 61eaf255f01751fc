// Heterogeneous media with known transmittance.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "etendue/volume_shader.h"
#include "support/render_support.h"

namespace etendue {
namespace {

/// A medium whose extinction grows along z of object space: s(z) = low + slope z [1/m]; isotropic.
class RampVolume final : public VolumeShader {
 public:
  static void describe(Description<RampVolume>& d) {
    d.summary("For tests: a medium whose extinction grows along z.")
        .member<&RampVolume::low>("low", "1/m", "extinction at z = 0", at_least(0))
        .member<&RampVolume::slope>("slope", "1", "its growth over a metre", at_least(0))
        .member<&RampVolume::top>("top", "m", "the largest z", at_least(0))
        .member<&RampVolume::albedo>("albedo", "1", "the part of the extinction that scatters", range(0, 1))
        .member<&RampVolume::glow>("glow", "W m^-3 sr^-1 nm^-1", "emission at each place over the extinction there",
                                   at_least(0));
  }
  VolumeCoefficients coefficients(const Point3& p, float, const Wavelengths&) const override {
    const float s = low + slope * std::clamp(p.z, 0.0f, top);
    return {Spectrum(s * (1 - albedo)), Spectrum(s * albedo), Spectrum(s * glow)};
  }
  bool homogeneous() const override { return false; }
  bool emits() const override { return glow > 0; }
  Spectrum majorant(const Wavelengths&) const override { return Spectrum(low + slope * top); }
  float phase(const Point3&, const Vector3&, const Vector3&) const override { return 1 / (4 * pi); }
  Vector3 sample_phase(const Point3&, const Vector3&, Point2 u, float& pdf) const override {
    pdf = 1 / (4 * pi);
    const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * std::cos(2 * pi * u.y), r * std::sin(2 * pi * u.y), z};
  }

  float low = 0, slope = 1, top = 1, albedo = 0, glow = 0;
};

void register_ramp() {
  static const Register<RampVolume> registered;
}  // only once a test runs: other tests go through all classes

/// A box of 4 m by 4 m by 2 m around the origin of world space, rotated and translated: its object-space z points along the
/// world's x, from -1 to 1, in units of 2 m.
std::string box(const std::string& volume) {
  return "Box { centre: [0, 0, 0.5], size: [2, 2, 1], shader: PassThrough {}, interior: RampVolume { " + volume +
         " }, transform: translate([-1, 0, 0] m) * rotate(90 deg, \"y\") * scale(2) }\n";
}

struct Outcome {
  double mean, error;
};
Outcome picture_mean(const std::string& renderer, int samples, const std::string& from, const std::string& to,
                     const std::string& objects) {
  const Ref<Job> job = load_job_text(
      fmt::format(
          "Job {{ renderer: {}, seed: 5, camera: OrthographicCamera {{ from: {}, to: {}, up: [0, 0, 1], width: 0.5 }}, "
          "image: ImageBuffer {{ width: 16, height: 16, filter: BoxFilter {{}} }}, scene: EmbreeScene {{ objects: [ {} ] }} }}",
          renderer, from, to, objects),
      "ramp.etd");
  job->renderer->samples = samples;
  const Image picture = test::rendered(job)->picture();
  double sum = 0, squares = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const double v = picture.at(x, y, 1);
      sum += v;
      squares += v * v;
    }
  const double mean = sum / 256;
  return {mean, std::sqrt(std::max(squares / 256 - mean * mean, 0.0) / 255)};
}

void expect(const Outcome& found, double known, const std::string& what) {
  EXPECT_NEAR(found.mean, known, 5 * found.error + 2e-4 * known) << what << ": standard error " << found.error;
  EXPECT_LT(found.error, 0.02 * known) << what << ": all is noise";
}

const char* const plate_behind =
    "Rectangle { corner: [-3, -0.4, -0.4], edge_u: [0, 0.8, 0], edge_v: [0, 0, 0.8], emission: DiffuseEmission { radiance: 1, "
    "sides: "
    "both } }";

// Along x the optical depth is the integral of the ramp over object-space z, in metres of the world: 2 m are z from 0 to 1, so
// it is 2 (low + slope / 2). T = exp(-2 (0.3 + 0.9 / 2)) = exp(-1.5); for half of it, from the middle of the box on the dense
// side, exp(-(0.3 + 0.9 * 0.75)).
TEST(UnevenMedia, LetThroughWhatTheIntegralSays) {
  register_ramp();
  const std::string medium = box("low: 0.3, slope: 0.9, top: 1");
  for (const char* renderer :
       {"PathTracer {}", "PathTracer { next_event: false }", "BidirectionalPathTracer {}", "LightTracer {}"}) {
    const int samples = std::string(renderer).starts_with("Light") ? 4096 : 256;
    expect(picture_mean(renderer, samples, "[3, 0, 0]", "[0, 0, 0]", medium + plate_behind), std::exp(-1.5), renderer);
    // From the middle, looking to the dense end and beyond: the plate there is seen through 0.5 <= z <= 1.
    const char* const ahead =
        " Rectangle { corner: [3, -0.4, -0.4], edge_u: [0, 0.8, 0], edge_v: [0, 0, 0.8], emission: DiffuseEmission { radiance: "
        "1, "
        "sides: both } }";
    expect(picture_mean(renderer, samples, "[0, 0, 0]", "[1, 0, 0]", medium + ahead), std::exp(-(0.3 + 0.9 * 0.75)), renderer);
  }
}

// Shadow rays are attenuated as camera rays are: a diffuse plate under a distant light on the other side.
TEST(UnevenMedia, DimsWhatIsLitThroughIt) {
  register_ramp();
  const std::string scene =
      box("low: 0.3, slope: 0.9, top: 1") +
      " Rectangle { corner: [-1.5, -40, -40], edge_u: [0, 80, 0], edge_v: [0, 0, 80], shader: Lambertian { color: 0.5 } }\n"
      " Distant { direction: [-1, 0, 0], emission: DiffuseEmission { radiance: 1 } }";
  // The camera is between the box and the plate, with no medium in between.
  const double known = 0.5 / M_PI * std::exp(-1.5);
  for (const char* renderer : {"PathTracer {}", "BidirectionalPathTracer {}"})
    expect(picture_mean(renderer, 1024, "[-1.2, 0, 0]", "[-1.5, 0, 0]", scene), known, renderer);
}

// A medium that scatters without absorption is invisible in uniform light.
TEST(UnevenMedia, WithoutAbsorptionVanishInAFurnace) {
  register_ramp();
  const std::string scene =
      box("low: 0.1, slope: 2, top: 1, albedo: 1") + " Environment { emission: DiffuseEmission { radiance: 1, sides: both } }";
  for (const char* renderer : {"PathTracer { max_depth: 1000 }", "BidirectionalPathTracer { max_depth: 1000 }"})
    expect(picture_mean(renderer, 256, "[3, 0, 0]", "[0, 0, 0]", scene), 1, renderer);
}

// Where emission is extinction times a constant J, radiance is J (1 - T).
TEST(UnevenMedia, ShineAsTheyAreDense) {
  register_ramp();
  const std::string scene = box("low: 0.3, slope: 0.9, top: 1, glow: 2");
  for (const char* renderer : {"PathTracer {}", "BidirectionalPathTracer {}"})
    expect(picture_mean(renderer, 1024, "[3, 0, 0]", "[0, 0, 0]", scene), 2 * (1 - std::exp(-1.5)), renderer);
}

// Multiple scattering: all algorithms that support such media agree.
TEST(UnevenMedia, ScatterTheSameForAllAlgorithms) {
  register_ramp();
  const std::string scene = box("low: 0.1, slope: 1.5, top: 1, albedo: 0.8") +
                            " Rectangle { corner: [-1, -1, 3], edge_u: [0, 2, 0], edge_v: [2, 0, 0], emission: DiffuseEmission "
                            "{ radiance: 5, sides: both } }";
  const Outcome path = picture_mean("PathTracer {}", 2048, "[3, 0, 0]", "[0, 0, 0]", scene);
  EXPECT_GT(path.mean, 0.01);
  for (const char* renderer : {"BidirectionalPathTracer {}", "LightTracer {}"}) {
    const Outcome other =
        picture_mean(renderer, std::string(renderer).starts_with("Light") ? 16384 : 2048, "[3, 0, 0]", "[0, 0, 0]", scene);
    EXPECT_NEAR(other.mean, path.mean, 5 * std::hypot(other.error, path.error)) << renderer;
    EXPECT_LT(other.error, 0.03 * path.mean) << renderer;
  }
}

TEST(UnevenMedia, AreRefusedWhereTheyCannotBeRendered) {
  register_ramp();
  const std::string inside = "BruteForceScene { objects: [ " + box("low: 1") + " ] }";
  try {
    picture_mean("PathTracer {}", 1, "[3, 0, 0]", "[0, 0, 0]", inside);
    ADD_FAILURE() << "was rendered";
  } catch (const std::exception& e) {
    EXPECT_NE(std::string(e.what()).find("a heterogeneous medium is not supported in a nested scene"), std::string::npos)
        << e.what();
  }
  // Renderers that do not support media report it.
  const Ref<Job> job = load_job_text(
      "Job { camera: OrthographicCamera {}, scene: EmbreeScene { objects: [ " + box("low: 1") + " ] } }", "ramp.etd");
  prepare_tree(*job);
  const SceneTraits traits = scene_traits(*job->scene, *job->camera);
  EXPECT_EQ(paths_in(traits) & heterogeneous_media, PathClasses(heterogeneous_media));
  for (const char* name : {"DirectRenderer", "DistributionRenderer", "WhittedRenderer"})
    EXPECT_FALSE(ref_cast<Renderer>(Registry::instance().create(name))->misses(traits).empty()) << name;
}

}  // namespace
}  // namespace etendue
