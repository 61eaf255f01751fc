// Shapes as luminaires: the light that arrives on a sphere around one equals the power that its emission reports. It is
// estimated in two ways: by light that starts on the luminaire, and by rays from the sphere towards it.

#include "etendue/core/spectrum.h"
#include "etendue/language/language.h"
#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

struct Luminaire {
  const char* name;
  const char* text;
  bool convex_or_flat;  ///< none of its light hits it again
};
void PrintTo(const Luminaire& l, std::ostream* out) { *out << l.name; }

const Luminaire luminaires[] = {
    {"Polygon",
     "Polygon { points: [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0, 0], [0, 0, 0], [0, 0.5, 0], [-0.5, 0.5, 0]] m, "
     "holes: [[-0.4, -0.4, 0], [-0.4, -0.2, 0], [-0.2, -0.2, 0], [-0.2, -0.4, 0]] m, transform: rotate(50, \"x\")",
     true},
    {"Cylinder", "Cylinder { radius: 0.4 m, height: 0.9 m, transform: rotate(40, \"y\")", true},
    {"Torus", "Torus { radius: 0.6 m, tube_radius: 0.25 m, transform: rotate(30, \"x\")", false},
    {"BezierPatches", "BezierPatches { transform: scale(1.2, 0.7, 0.5)", false},
    {"Csg",
     "Difference { operands: [Box {}, Sphere { centre: [0.5, -0.5, 0.5] m, radius: 0.45 m }], transform: rotate(20, \"z\")",
     false},
    {"Metaballs", "Metaballs { transform: scale(0.6)", false},
    {"DisplacedMesh",
     "DisplacedMesh { displacement: NoiseMap { size: 0.3 m }, scale: 0.2 m, levels: 3, surface: SubdivisionSurface { levels: "
     "2, "
     "positions: [[-0.5, -0.5, -0.5], [0.5, -0.5, -0.5], [0.5, 0.5, -0.5], [-0.5, 0.5, -0.5], [-0.5, -0.5, 0.5], "
     "[0.5, -0.5, 0.5], [0.5, 0.5, 0.5], [-0.5, 0.5, 0.5]] m, "
     "indices: [0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7] }",
     false},
};

class LuminairePower : public ::testing::TestWithParam<Luminaire> {};

TEST_P(LuminairePower, ArrivesOnASphereAroundIt) {
  const Ref<SceneObject> object =
      ref_cast<SceneObject>(parse_component(std::string(GetParam().text) + ", emission: DiffuseEmission { radiance: 1 } }"));
  const Ref<Scene> around = ref_cast<Scene>(Registry::instance().create("BvhScene"));
  around->objects = {object};
  prepare_tree(*around);
  const EmissionShader& emission = *object->emission;
  std::array<float, spectrum_size> lambda, pdf;
  for (int i = 0; i < spectrum_size; ++i) lambda[size_t(i)] = 450 + 40 * float(i), pdf[size_t(i)] = 1;
  const Wavelengths wavelengths(lambda, pdf);
  const double power = double(emission.power(*object, wavelengths)[0]);
  ASSERT_GT(power, 0);

  // The light that leaves it, and the part of that light that hits the luminaire again.
  Random random(7);
  Mean sent, returned;
  for (int i = 0; i < 150000; ++i) {
    const SurfaceSample s = object->sample_area(random.pair(), 0);
    ASSERT_GT(s.pdf, 0);
    const DirectionSample d = emission.sample(s.point, random.pair());
    if (!(d.pdf > 0)) {  // the cosine was rounded to zero
      sent.add(0), returned.add(0);
      continue;
    }
    const double flux = double(emission.radiance(s.point, d.direction, wavelengths)[0]) *
                        std::abs(double(dot(s.point.normal, d.direction))) / (double(s.pdf) * double(d.pdf));
    sent.add(flux);
    returned.add(around->any(s.point.leave(d.direction)) ? flux : 0);
  }
  const double area_error = double(object->area_error(0));
  EXPECT_NEAR(sent.value() / power, 1, 0.005 + area_error) << "power " << power << ", standard error " << sent.error() / power;
  if (GetParam().convex_or_flat) {
    EXPECT_LT(returned.value(), 1e-4 * power);
  }

  // The light that arrives, by lines through the sphere, uniformly distributed: their measure is that of all directions, 4 pi,
  // times the sphere's cross section.
  const Point3 centre = object->bounds().centre();
  const float radius = 0.51f * length(object->bounds().diagonal());
  Mean received;
  for (int i = 0; i < 400000; ++i) {
    // A line through the sphere, uniform in the measure of lines: a direction, and a point on the disc perpendicular to it.
    const Vector3 direction = random.direction();
    const Frame frame{Normal3(direction)};
    const float r = radius * std::sqrt(random.number()), phi = 2 * pi * random.number();
    const Point3 on_disc = centre + r * (std::cos(phi) * frame.s + std::sin(phi) * frame.t);
    const Ray line = ray(on_disc - radius * direction, direction);
    Hit hit;
    double radiance = 0;
    if (around->nearest(line, hit)) {
      SurfacePoint p;
      around->locate(line, hit, p);
      radiance = double(emission.radiance(p, -direction, wavelengths)[0]);
    }
    received.add(4 * M_PI * M_PI * double(radius) * double(radius) * radiance);
  }
  const double expected = sent.value() - returned.value();
  EXPECT_NEAR(received.value() / expected, 1,
              0.0025 + area_error + 4 * std::hypot(received.error(), sent.error(), returned.error()) / expected)
      << "expected " << expected << ", standard error " << received.error() / expected;
  RecordProperty("sent_over_power", std::to_string(sent.value() / power));
  RecordProperty("received_over_sent", std::to_string(received.value() / expected));
  std::printf("  %s: sent/power %.5f +- %.5f, received/escaped %.5f +- %.5f, area error %.4f\n", GetParam().name,
              sent.value() / power, sent.error() / power, received.value() / expected, received.error() / expected, area_error);
}

INSTANTIATE_TEST_SUITE_P(Shapes, LuminairePower, ::testing::ValuesIn(luminaires),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace etendue
