// Media behind thin panes and other sheets, against closed forms, by every renderer that supports media; and the index behind a
// boundary that does not refract. Each value is held to 0.5 % and to 4.5 standard errors (7e-6), with fixed seeds.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/render_support.h"

namespace etendue::test {
namespace {

const std::string sky = "Environment { emission: EnvironmentEmission { radiance: 1 } }\n";

void expect(const std::string& renderer, const std::string& camera, const std::string& objects, double expected,
            const std::string& what) {
  const Measured m = measure(job_text(renderer, camera, 4, objects, "EmbreeScene"));
  EXPECT_EQ(m.bad, 0u);
  EXPECT_NEAR(m.mean.y, expected, 0.005 * expected) << what << " by " << renderer << ", standard error " << m.error;
  EXPECT_NEAR(m.mean.y, expected, 4.5 * m.error + 2e-4 * expected) << what << " by " << renderer;
}

struct Pane {
  double reflected, transmitted;
};

/// A clear pane, by Stokes' sums for each polarization: R' = 2 R / (1 + R), T' = (1 - R) / (1 + R), with Fresnel's R.
Pane pane(double cosine, double n) {
  const double inside = std::sqrt(1 - (1 - cosine * cosine) / (n * n));
  const double s = (cosine - n * inside) / (cosine + n * inside), p = (n * cosine - inside) / (n * cosine + inside);
  Pane sum{0, 0};
  for (const double r : {s * s, p * p}) {
    sum.reflected += r / (1 + r);
    sum.transmitted += 0.5 * (1 - r) / (1 + r);
  }
  return sum;
}

/// Two panes with a medium between them of transmittance a per passage, under uniform light of radiance 1 from both sides:
/// R' + T'^2 a (1 + R' a + (R' a)^2 + ...). Within a sphere all passages are alike as well.
double between_panes(double cosine, double n, double a) {
  const Pane one = pane(cosine, n);
  return one.reflected + one.transmitted * one.transmitted * a / (1 - one.reflected * a);
}

const std::vector<std::string> tracers = {"PathTracer { samples: 4096, max_depth: 200 }",
                                          "BidirectionalPathTracer { samples: 2048, max_depth: 64 }"};

/// A ray along -z at a distance from the axis.
std::string ray_at(double y) {
  return fmt::format("OrthographicCamera {{ from: [0, {0}, 5], to: [0, {0}, 0], up: [0, 1, 0], width: 1e-4 }}", y);
}

TEST(ThinMedia, AnAbsorbingBallBehindAThinPane) {
  for (const double y : {0.0, 0.6, 0.9}) {
    const double cosine = std::sqrt(1 - y * y);
    const double expected = between_panes(cosine, 1.333, std::exp(-2 * cosine));
    for (const std::string& r : tracers)
      expect(r, ray_at(y),
             "Sphere { shader: ThinDielectric { ior: 1.333 }, interior: HomogeneousVolume { absorption: 1 } }\n" + sky,
             expected, fmt::format("{} off the axis", y));
  }
}

// A slab at normal and at oblique incidence.
TEST(ThinMedia, AnAbsorbingSlabOnAndOffTheNormal) {
  const std::string slab =
      "Box { size: [400, 400, 0.5], shader: ThinDielectric { ior: 1.5 }, interior: HomogeneousVolume { absorption: 1.2 } }\n";
  for (const double degrees : {0.0, 45.0, 70.0}) {
    const double angle = degrees * 3.141592653589793 / 180, cosine = std::cos(angle);
    const std::string camera =
        fmt::format("OrthographicCamera {{ from: [{}, 0, {}], to: [0, 0, 0], up: [0, 1, 0], width: 1e-3 }}",
                    20 * std::sin(angle), 20 * cosine);
    for (const std::string& r : tracers)
      expect(r, camera, slab + sky, between_panes(cosine, 1.5, std::exp(-0.6 / cosine)), fmt::format("{} degrees", degrees));
  }
}

// Sunlight through a slab of coloured panes that do not reflect, on a diffuse plate: by shadow rays, by light subpaths
// connected to the lens, and by connections. A pane transmits 0.8^(1/cos), the medium exp(-0.6 / cos).
TEST(ThinMedia, SunThroughColouredPanes) {
  const double sine = 0.6, cosine = 0.8;
  const std::string objects = fmt::format(
      "Box {{ centre: [0, 0, 1], size: [7, 7, 0.5], shader: ThinDielectric {{ ior: 1, color: 0.8 }}, interior: "
      "HomogeneousVolume {{ absorption: 1.2 }} }}\n"
      "Rectangle {{ corner: [-2, -2, 0], edge_u: [4, 0, 0], edge_v: [0, 4, 0], shader: Lambertian {{ color: 0.5 }} }}\n"
      "Distant {{ direction: [{}, 0, {}], emission: DiffuseEmission {{ radiance: 3.14159265 }} }}\n",
      sine, -cosine);
  const double expected = 0.5 * cosine * std::pow(0.8, 2 / cosine) * std::exp(-0.6 / cosine);
  const std::string camera = "OrthographicCamera { from: [0, 0, 0.5], to: [0, 0, 0], up: [0, 1, 0], width: 3.9 }";
  for (const char* r :
       {"PathTracer { samples: 16 }", "BidirectionalPathTracer { samples: 64 }", "LightTracer { samples: 65536 }"})
    expect(r, camera, objects, expected, "sun");
}

// Without absorption all incoming light leaves again, whatever happens inside.
TEST(ThinMedia, AFurnaceStaysOneWithFogBehindSheets) {
  for (const char* shader : {"ThinDielectric { ior: 1.5 }", "DiffuseTransmitter { reflectance: 0.4, transmittance: 0.6 }",
                             "MixShader { first: ThinDielectric { ior: 1.5 }, second: Lambertian { color: 1 } }"})
    for (const char* r :
         {"PathTracer { samples: 1024, max_depth: 100000 }", "BidirectionalPathTracer { samples: 16384, max_depth: 400 }"})
      expect(r, "PerspectiveCamera { from: [0, 0, 4], to: [0, 0, 0], fov: 25 deg }",
             fmt::format("Sphere {{ shader: {}, interior: HomogeneousVolume {{ scattering: 2 }} }}\n", shader) + sky, 1,
             shader);
}

// Paper around soot that absorbs all light: only the paper's reflection is seen.
TEST(ThinMedia, PaperBoundsTheMediumItsObjectNames) {
  const std::string camera = "PerspectiveCamera { from: [0, 0, 4], to: [0, 0, 0], fov: 5 deg }";
  const std::string ball = "Sphere { shader: DiffuseTransmitter { reflectance: 0.3, transmittance: 0.7 }";
  for (const std::string& r : tracers)
    expect(r, camera, ball + ", interior: HomogeneousVolume { absorption: 1000 } }\n" + sky, 0.3, "soot");
}

// Paper around an absorber. Paper transmits light diffusely; a fraction m of the light from its inner side arrives at the inner
// side again, so R + T^2 m (1 + R m + (R m)^2 + ...) is seen from outside. In a ball of radius 1 all chords are 2 cos:
// m = integral of exp(-2 a cos) 2 cos dcos = 2 (1 - (1 + 2 a) exp(-2 a)) / (2 a)^2. Between two sheets at the distance d it is
// twice the exponential integral E3(a d), and light that crosses is transmitted diffusely to the other side as well.
TEST(ThinMedia, PaperAroundAnAbsorber) {
  const double R = 0.3, T = 0.6;
  const std::string paper = "shader: DiffuseTransmitter { reflectance: 0.3, transmittance: 0.6 }";
  const std::string camera = "PerspectiveCamera { from: [0, 0, 4], to: [0, 0, 0], fov: 5 deg }";
  for (const double a : {0.2, 1.0, 3.0}) {
    const double x = 2 * a, m = 2 * (1 - (1 + x) * std::exp(-x)) / (x * x);
    for (const std::string& r : tracers)
      expect(r, camera, fmt::format("Sphere {{ {}, interior: HomogeneousVolume {{ absorption: {} }} }}\n", paper, a) + sky,
             R + T * T * m / (1 - R * m), fmt::format("ball of {}", a));
  }
  const double depth = 0.6;
  double m = 0;  // 2 E3(depth), by cosines
  constexpr int steps = 100000;
  for (int i = 0; i < steps; ++i) {
    const double c = (i + 0.5) / steps;
    m += 2 * c * std::exp(-depth / c) / steps;
  }
  for (const std::string& r : tracers)
    expect(r, camera,
           fmt::format("Box {{ size: [400, 400, 0.5], {}, interior: HomogeneousVolume {{ absorption: 1.2 }} }}\n", paper) + sky,
           R + T * T * m / (1 - R * m), "slab");
}

// A thin pane without an interior bounds no medium: the fog around it continues inside. A solid glass ball would exclude it.
TEST(ThinMedia, AThinBubbleIsFullOfWhatIsAround) {
  const std::string camera = "PerspectiveCamera { from: [0, 0, 1.9], to: [0, 0, 0], fov: 1 deg }";
  const std::string fog = "Sphere { radius: 2, shader: PassThrough {}, interior: HomogeneousVolume { absorption: 0.5 } }\n";
  for (const std::string& r : tracers)
    expect(r, camera, fog + "Sphere { shader: ThinDielectric { ior: 1, color: 0.9 } }\n" + sky, 0.81 * std::exp(-0.5 * 3.9),
           "bubble");
}

TEST(ThinMedia, TheCameraMayStandBehindThePane) {
  for (const std::string& r : tracers)
    expect(r, "PerspectiveCamera { from: [0, 0, 0], to: [0, 0, 1], fov: 5 deg }",
           "Sphere { shader: ThinDielectric { ior: 1, color: 0.9 }, interior: HomogeneousVolume { absorption: 0.5 } }\n" + sky,
           0.9 * std::exp(-0.5), "inside");
}

// A boundary that does not refract has the same index on both sides. Glass in a cloud in glass is glass throughout: of a lamp
// in the middle (1 - R) / n^2 is seen, R = 0.04.
TEST(ThinMedia, WhatRefractsNothingHasTheIndexOfWhatIsAround) {
  for (const char* cloud : {"shader: PassThrough {}", "shader: MaskShader { shader: Lambertian {}, opacity: 0 }",
                            "shader: ThinDielectric { ior: 1.5 }, interior: HomogeneousVolume {}"})
    for (const std::string r : {"PathTracer { samples: 256 }", "BidirectionalPathTracer { samples: 256 }",
                                "DistributionRenderer { samples: 64 }", "WhittedRenderer { samples: 64 }"})
      expect(r, ray_at(0),
             fmt::format("Sphere {{ radius: 1, shader: Dielectric {{ ior: 1.5 }} }}\n"
                         "Sphere {{ radius: 0.6, {} }}\n"
                         "Sphere {{ radius: 0.3, shader: Dielectric {{ ior: 1.5 }} }}\n"
                         "Sphere {{ radius: 0.1, emission: DiffuseEmission {{ radiance: 1 }} }}\n",
                         cloud),
             0.96 / 2.25, cloud);
}

// A pane that coincides with the surface of a medium: light passes both.
TEST(ThinMedia, APaneOnTheFaceOfAMedium) {
  const std::string objects =
      "Box { size: [2, 2, 2], shader: PassThrough {}, interior: HomogeneousVolume { absorption: 0.5 } }\n"
      "Rectangle { corner: [-1, -1, 1], edge_u: [2, 0, 0], edge_v: [0, 2, 0], shader: ThinDielectric { ior: 1, color: 0.8 } "
      "}\n";
  for (const std::string& r : tracers) expect(r, ray_at(0.3), objects + sky, 0.8 * std::exp(-1.0), "pane");
}

}  // namespace
}  // namespace etendue::test
