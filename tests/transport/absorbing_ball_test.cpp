// Light that crosses absorbing media and panes, with closed forms of all that happens, by every renderer that can find it. All
// renderers share the code of shadow rays and of media tracking, so they would agree even if it were wrong: here they are
// compared with independent numbers.
//
// A spherical room of radius 1, whose wall emits radiance 1 and reflects half, has a ball of radius b in its middle. By
// symmetry the radiance B of the wall is the same everywhere and in all directions. Of the light that leaves the wall at the
// angle theta, a fraction T returns to the wall if it hits the ball (sin theta < b); all other light returns. So
//     B = 1 + k B / 2,   k = 1 - integral over sin theta < b of 2 (1 - T) sin theta cos theta dtheta,
// per wavelength. T is exp(-a times the chord) for a ball that only absorbs; (1 - o)^2 for a shell with holes; for glass it is
// R + (1 - R)^2 t / (1 - R t), with R Fresnel's reflectance and t the transmittance of the chord inside.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "etendue/describe/color.h"
#include "support/component_test_support.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

struct Way {
  const char* renderer;
  int samples;
};

struct Mean {
  double value = 0, error = 0;
};

/// The mean Y over renders with different seeds, and its standard error.
Mean rendered(const std::string& renderer, int samples, const std::string& camera, const std::string& objects, int size = 8) {
  const std::string head = renderer.substr(0, renderer.find('{')), members = renderer.substr(renderer.find('{') + 1);
  Render render(load_job_text(
      job_text(fmt::format("{} {{ samples: {}, {}", head, samples, members), camera, size, objects, "EmbreeScene"),
      "ball.etd"));
  constexpr int renders = 16;
  double sum = 0, squares = 0;
  for (int i = 0; i < renders; ++i) {
    render_again(render, std::uint64_t(i + 1));
    const Image image = render.film().develop();
    EXPECT_EQ(render.film().bad_samples(), 0u);
    double mean = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) mean += image.at(x, y, 1) / (double(image.width) * image.height);
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / renders;
  return {mean, std::sqrt(std::max(0.0, squares / renders - mean * mean) / (renders - 1))};
}

void expect_mean(const std::string& what, const Mean& m, double expected) {
  EXPECT_NEAR(m.value, expected, 4.5 * m.error + 3e-4 * expected) << what << ", standard error " << m.error;
  EXPECT_LT(m.error, (what.starts_with("LightTracer") ? 0.04 : 0.006) * expected) << what;
}

/// Y of a spectrum, given as a function of the wavelength [nm].
double luminance(const std::function<double(double)>& f) {
  double sum = 0;
  for (int l = 360; l <= 830; ++l) sum += f(l) * observer(float(l)).y;
  return sum / observer_y_integral();
}

/// B of the room with a ball of radius b that returns the fraction T(sine of the angle at the ball's surface).
double brightness(double b, const std::function<double(double)>& T) {
  constexpr int steps = 1000;
  double lost = 0;
  for (int i = 0; i < steps; ++i) {
    const double s = std::sqrt((i + 0.5) / steps);  // uniform in s^2, since d(s^2) = 2 sin cos dtheta
    lost += (1 - T(s)) / steps * b * b;
  }
  return 1 / (1 - 0.5 * (1 - lost));
}

const std::string wall =
    "Sphere { radius: 1, shader: Lambertian { color: 0.5 }, emission: DiffuseEmission { radiance: 1, sides: back } }\n";
/// Cameras between ball and wall, and in the middle of the ball.
const std::string outside = "PerspectiveCamera { from: [0.7, 0.1, 0], to: [1, 0.2, 0.1], fov: 50 }",
                  within = "PerspectiveCamera { from: [0, 0, 0], to: [1, 0.2, 0.1], fov: 50 }";

const std::vector<Way> all_ways = {{"PathTracer { max_depth: 1000 }", 24},
                                   {"PathTracer { max_depth: 1000, next_event: false }", 24},
                                   {"BidirectionalPathTracer { max_depth: 1000 }", 20}};

constexpr double b = 0.6;
const std::string slope = "spectrum([360, 830], [0.4, 2.4])";
double absorption(double l) { return 0.4 + 2 * (l - 360) / 470; }

TEST(AbsorbingBall, ThatOnlyAbsorbs) {
  const std::string objects =
      wall + fmt::format("Sphere {{ radius: {}, shader: PassThrough {{}}, interior: HomogeneousVolume {{ absorption: {} }} }}",
                         b, slope);
  const auto B = [](double l) {
    return brightness(b, [&](double s) { return std::exp(-absorption(l) * 2 * b * std::sqrt(1 - s * s)); });
  };
  const double seen = luminance(B), from_within = luminance([&](double l) { return B(l) * std::exp(-absorption(l) * b); });
  for (const Way& way : all_ways) {
    expect_mean(way.renderer, rendered(way.renderer, way.samples, outside, objects), seen);
    expect_mean(std::string(way.renderer) + " within", rendered(way.renderer, way.samples, within, objects), from_within);
  }
  expect_mean("LightTracer", rendered("LightTracer { max_depth: 1000 }", 64, outside, objects), seen);
  expect_mean("balance", rendered("BidirectionalPathTracer { max_depth: 1000, heuristic: balance }", 20, outside, objects),
              seen);
}

// A shell with a black fraction: the remaining light passes by null scattering, twice.
TEST(AbsorbingBall, ShellWithHoles) {
  const std::string objects =
      wall +
      fmt::format("Sphere {{ radius: {}, shader: MaskShader {{ shader: Lambertian {{ color: 1e-6 }}, opacity: 0.35 }} }}", b);
  const double B = brightness(b, [](double) { return 0.65 * 0.65; });
  for (const Way& way : all_ways) {
    expect_mean(way.renderer, rendered(way.renderer, way.samples, outside, objects), B);
    expect_mean(std::string(way.renderer) + " within", rendered(way.renderer, way.samples, within, objects), 0.65 * B);
  }
}

// Panes that transmit color^(1 / cos) of the light and do not reflect (their index is 1).
TEST(AbsorbingBall, ShellOfColouredPanes) {
  const std::string objects = wall + fmt::format("Sphere {{ radius: {}, shader: ThinDielectric {{ ior: 1, color: 0.7 }} }}", b);
  const double B = brightness(b, [](double s) { return std::pow(0.7, 2 / std::sqrt(1 - s * s)); });
  for (const Way& way : all_ways) expect_mean(way.renderer, rendered(way.renderer, way.samples, outside, objects), B);
}

// Fog whose scattering depends on the wavelength, without absorption, changes nothing.
TEST(AbsorbingBall, FogThatOnlyScatters) {
  const std::string objects = wall + fmt::format(
                                         "Sphere {{ radius: {}, shader: PassThrough {{}}, interior: HomogeneousVolume {{ "
                                         "scattering: spectrum([360, 830], [0.5, 3]), anisotropy: -0.6 }} }}",
                                         b);
  for (const Way& way : all_ways) {
    expect_mean(way.renderer, rendered(way.renderer, way.samples, outside, objects), 2);
    expect_mean(std::string(way.renderer) + " within", rendered(way.renderer, way.samples, within, objects), 2);
  }
}

// Glass that absorbs, and disperses.
TEST(AbsorbingBall, OfGlass) {
  const std::string objects =
      wall + fmt::format(
                 "Sphere {{ radius: {}, shader: Dielectric {{ ior: spectrum([360, 830], [1.9, 1.4]) }}, interior: "
                 "HomogeneousVolume {{ absorption: {} }} }}",
                 b, slope);
  const double expected = luminance([](double l) {
    const double n = 1.9 - 0.5 * (l - 360) / 470;
    return brightness(b, [&](double s) {
      const double c = std::sqrt(1 - s * s), i = std::sqrt(1 - s * s / (n * n));
      const double rs = (c - n * i) / (c + n * i), rp = (n * c - i) / (n * c + i), R = (rs * rs + rp * rp) / 2;
      const double t = std::exp(-absorption(l) * 2 * b * i);
      return R + (1 - R) * (1 - R) * t / (1 - R * t);
    });
  });
  for (const Way& way : {Way{"PathTracer { max_depth: 1000 }", 48},
                         {"BidirectionalPathTracer { max_depth: 1000 }", 48},
                         {"LightTracer { max_depth: 1000 }", 64}})
    expect_mean(way.renderer, rendered(way.renderer, way.samples, outside, objects), expected);
}

// A paper ball with holes, filled with an absorber. A fraction o of its surface is paper, which reflects r and transmits t
// diffusely; 1 - o is null scattering. With m the fraction of the light from its inner side that arrives at the inner side
// again, J the radiance of each side (outside its mean by projected area) and F = b^2 the fraction of the wall's view that is
// ball:
//   J_in = o r m J_in + (o t + 1 - o) B,   J_out = o r B + (o t + 1 - o) m J_in,   B = 1 + ((1 - F) B + F J_out) / 2.
TEST(AbsorbingBall, OfPaper) {
  const double o = 0.8, r = 0.35, t = 0.5;
  const std::string objects = wall + fmt::format(
                                         "Sphere {{ radius: {}, shader: MaskShader {{ opacity: {}, shader: DiffuseTransmitter "
                                         "{{ reflectance: {}, transmittance: {} }} }}, "
                                         "interior: HomogeneousVolume {{ absorption: {} }} }}",
                                         b, o, r, t, slope);
  const auto solve = [&](double l) {
    double m = 0;
    constexpr int steps = 1000;
    for (int i = 0; i < steps; ++i) m += std::exp(-absorption(l) * 2 * b * std::sqrt((i + 0.5) / steps)) / steps;
    const double through = o * t + 1 - o, inner = through / (1 - o * r * m), outer = o * r + through * m * inner,
                 F = b * b;  // over B
    const double B = 1 / (1 - 0.5 * (1 - F + F * outer));
    return std::pair(B, inner * B);
  };
  const double seen = luminance([&](double l) { return solve(l).first; }),
               from_within = luminance([&](double l) { return solve(l).second * std::exp(-absorption(l) * b); });
  for (const Way& way : all_ways) {
    expect_mean(way.renderer, rendered(way.renderer, way.samples, outside, objects), seen);
    expect_mean(std::string(way.renderer) + " within", rendered(way.renderer, way.samples, within, objects), from_within);
  }
}

// The ball itself emits, and absorbs what it emits inwards: seen through its middle from a black room, 1 + exp(-2 a b). The
// lens is much nearer to it than 2 b: if the medium of the inside were put outside, it would absorb another amount.
TEST(AbsorbingBall, ThatShines) {
  const std::string objects = fmt::format(
      "Sphere {{ radius: {}, shader: PassThrough {{}}, emission: DiffuseEmission {{ radiance: 1, sides: "
      "both }}, interior: HomogeneousVolume {{ absorption: {} }} }}",
      b, slope);
  const std::string camera = "OrthographicCamera { from: [0, 0, 0.7], to: [0, 0, 0], up: [0, 1, 0], width: 0.2 }";
  const double expected = luminance([](double l) { return 1 + std::exp(-absorption(l) * 2 * b * (1 - 0.0033333 / (b * b))); });
  for (const Way& way : {Way{"PathTracer {}", 16}, {"BidirectionalPathTracer {}", 16}, {"LightTracer {}", 2000}}) {
    const Mean m = rendered(way.renderer, way.samples, camera, objects);
    EXPECT_NEAR(m.value, expected, 4.5 * m.error + 3e-3 * expected) << way.renderer << " " << m.error;
    EXPECT_LT(m.error, 0.012 * expected);
  }
}

// A lamp in an absorbing ball over a floor: E is the integral of exp(-a s) over the lamp's solid angle, with s the distance
// within the ball. The lamp is a point, or a sphere of radius 0.25, in the middle of a ball of radius 0.8 at the height 2.
TEST(AbsorbingBall, WithALampInside) {
  const std::string floor =
      "Rectangle { corner: [-5, -5, 0], edge_u: [10, 0, 0], edge_v: [0, 10, 0], shader: Lambertian { color: 1 } }\n";
  const std::string ball = fmt::format(
      "Sphere {{ centre: [0, 0, 2], radius: 0.8, shader: PassThrough {{}}, interior: HomogeneousVolume {{ "
      "absorption: {} }} }}\n",
      slope);
  const std::string camera = "OrthographicCamera { from: [0, 0, 0.9], to: [0, 0, 0], up: [0, 1, 0], width: 0.02 }";
  const std::string wide = "OrthographicCamera { from: [0, 0, 0.9], to: [0, 0, 0], up: [0, 1, 0], width: 2 }";
  // The mean over the square of width w of cos^3 / d^2 exp(-0.8 a).
  const auto point_light = [](double w) {
    double sum = 0;
    constexpr int steps = 100;
    for (int i = 0; i < steps; ++i)
      for (int k = 0; k < steps; ++k) {
        const double x = w * ((i + 0.5) / steps - 0.5), y = w * ((k + 0.5) / steps - 0.5), d2 = x * x + y * y + 4;
        sum += 2 / (d2 * std::sqrt(d2)) / (steps * steps);
      }
    return sum / M_PI * luminance([](double l) { return std::exp(-0.8 * absorption(l)); });
  };
  const std::string point = "Point { position: [0, 0, 2], emission: DiffuseEmission { radiance: 1 } }";
  expect_mean("path, point", rendered("PathTracer { max_depth: 2 }", 4, camera, floor + ball + point), point_light(0.02));
  expect_mean("bidirectional, point", rendered("BidirectionalPathTracer { max_depth: 2 }", 4, camera, floor + ball + point),
              point_light(0.02));
  expect_mean("light, point", rendered("LightTracer { max_depth: 2 }", 2000, wide, floor + ball + point), point_light(2));

  const double expected = luminance([](double l) {
    double sum = 0;
    constexpr int steps = 2000;
    const double s2_end = 0.25 * 0.25 / 4;
    for (int i = 0; i < steps; ++i) {
      const double s2 = s2_end * (i + 0.5) / steps, near2 = 4 * s2;  // squared distance of the ray from the middle
      const double way = std::sqrt(0.64 - near2) - std::sqrt(0.0625 - near2);
      sum += std::exp(-absorption(l) * way) * s2_end / steps;  // cos dw = pi d(sin^2)
    }
    return sum;
  });
  const std::string lamp = "Sphere { centre: [0, 0, 2], radius: 0.25, emission: DiffuseEmission { radiance: 1 } }";
  for (const Way& way : {Way{"PathTracer { max_depth: 2 }", 64},
                         {"BidirectionalPathTracer { max_depth: 2 }", 64},
                         {"PathTracer { max_depth: 2, heuristic: balance }", 64}})
    expect_mean(way.renderer, rendered(way.renderer, way.samples, camera, floor + ball + lamp), expected);
  // The lamp itself, seen through the medium before it.
  const std::string disc =
      "Rectangle { corner: [-0.3, -0.3, 2], edge_u: [0.6, 0, 0], edge_v: [0, 0.6, 0], emission: DiffuseEmission { "
      "radiance: 1, sides: both } }";
  const std::string upwards = "OrthographicCamera { from: [0, 0, 0.5], to: [0, 0, 2], up: [0, 1, 0], width: 0.1 }";
  for (const Way& way : {Way{"PathTracer {}", 4}, {"BidirectionalPathTracer {}", 4}, {"LightTracer {}", 2000}}) {
    const Mean m = rendered(way.renderer, way.samples, upwards, ball + disc);
    const double seen = luminance([](double l) { return std::exp(-absorption(l) * 0.799); });
    EXPECT_NEAR(m.value, seen, 4.5 * m.error + 2e-3 * seen) << way.renderer;
    EXPECT_LT(m.error, 0.012 * seen);
  }
}

// The transmittances of two panes before a lamp multiply, at an oblique angle, for all renderers that trace shadow rays.
TEST(AbsorbingBall, TwoPanesBeforeALamp) {
  const std::string floor =
      "Rectangle { corner: [-5, -5, 0], edge_u: [10, 0, 0], edge_v: [0, 10, 0], shader: Lambertian { color: 1 } }\n";
  const auto pane = [](double z, double color) {
    return fmt::format(
        "Rectangle {{ corner: [-9, -9, {}], edge_u: [18, 0, 0], edge_v: [0, 18, 0], shader: ThinDielectric {{ ior: 1, color: "
        "{} }} }}\n",
        z, color);
  };
  const std::string scene =
      floor + pane(1, 0.8) + pane(1.5, 0.6) + "Point { position: [0, 0, 2], emission: DiffuseEmission { radiance: 1 } }";
  const std::string camera = "OrthographicCamera { from: [1.5, 0, 0.5], to: [1.5, 0, 0], up: [0, 1, 0], width: 0.01 }";
  const double d2 = 4 + 2.25, cosine = 2 / std::sqrt(d2), expected = cosine / d2 / M_PI * std::pow(0.48, 1 / cosine);
  for (const char* renderer :
       {"PathTracer { max_depth: 2 }", "BidirectionalPathTracer { max_depth: 2 }", "WhittedRenderer { max_depth: 2 }",
        "DirectRenderer { }", "DistributionRenderer { max_depth: 2 }"})
    expect_mean(renderer, rendered(renderer, 4, camera, scene, 4), expected);
}

}  // namespace
}  // namespace etendue::test
