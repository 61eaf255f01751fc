// pbrt's cameras: rays as its books define them.

#include <fmt/format.h>

#include "pbrt_support.h"

namespace etendue::pbrt_test {
namespace {

using V = DoubleVector3;

V times(double s, const V& v) { return {s * v.x, s * v.y, s * v.z}; }
V unit(const V& v) { return times(1 / std::sqrt(dot(v, v)), v); }

/// The axes of pbrt's camera placed by LookAt: right, up and forward.
struct Axes {
  V origin, right, up, forward;
  V world(const V& v) const {
    const V a = times(v.x, right), b = times(v.y, up), c = times(v.z, forward);
    return {a.x + b.x + c.x, a.y + b.y + c.y, a.z + b.z + c.z};
  }
};
/// "LookAt from to up", after a "Scale -1 1 1" if mirrored, which flips its right to the left.
Axes look_at(const V& from, const V& to, const V& up, bool mirrored) {
  Axes a;
  a.origin = from;
  a.forward = unit({to.x - from.x, to.y - from.y, to.z - from.z});
  a.right = unit(cross(unit(up), a.forward));
  a.up = cross(a.forward, a.right);
  if (mirrored) a.right = times(-1, a.right);
  return a;
}

const std::string look = "LookAt 1 2 3  2 4 2.5  0.1 0.2 1\n";

/// Compares a camera's rays with a function of (u, v) in [0, 1]^2 that returns origin and direction in pbrt's camera space.
template <class F>
void expect_rays(const std::string& camera, bool v3, const F& expected, const std::string& film = "",
                 const std::string& before = "") {
  const TemporaryFolder folder;
  folder.write("thin.dat", "# one lens, and a stop\n100 1e-6 1.5 20\n-100 1e-6 1 20\n0 0 0 20\n");
  for (const bool mirrored : {false, true}) {
    const Imported i =
        import_text(folder, before + (mirrored ? "Scale -1 1 1\n" : "") + look + camera + "\nFilm \"" + (v3 ? "image" : "rgb") +
                                "\" \"integer xresolution\" 60 \"integer yresolution\" 40 " + film +
                                "\nPixelFilter \"box\"\nWorldBegin\n"
                                "Shape \"sphere\"\n");
    ASSERT_TRUE(i.job) << i.told();
    EXPECT_EQ(i.told(), "");
    Camera& made = *i.job->camera;
    made.prepare();
    made.set_film(60, 40);
    const Axes axes = look_at({1, 2, 3}, {2, 4, 2.5}, {0.1, 0.2, 1}, mirrored);
    for (const auto& [u, v] : {std::pair(0.5, 0.5), {0.1, 0.3}, {0.3, 0.9}, {0.7, 0.2}, {0.95, 0.8}, {0.6, 0.45}}) {
      const Ray ray = made.ray({float(60 * u), float(40 * v)}, {0.5f, 0.5f}, 0);
      const auto [origin, direction] = expected(u, v);
      const V from = axes.world(origin), towards = unit(axes.world(direction));
      EXPECT_NEAR(double(ray.direction.x), towards.x, 2e-6) << camera << " " << u << " " << v << mirrored;
      EXPECT_NEAR(double(ray.direction.y), towards.y, 2e-6) << camera << " " << u << " " << v << mirrored;
      EXPECT_NEAR(double(ray.direction.z), towards.z, 2e-6) << camera << " " << u << " " << v << mirrored;
      EXPECT_NEAR(double(ray.origin.x), axes.origin.x + from.x, 2e-6) << camera;
      EXPECT_NEAR(double(ray.origin.y), axes.origin.y + from.y, 2e-6) << camera;
      EXPECT_NEAR(double(ray.origin.z), axes.origin.z + from.z, 2e-6) << camera;
    }
  }
}

// (u, v) are the angles of spherical coordinates whose pole is y: Pharr, Jakob & Humphreys, 5.3 and, for version 3, 6.3.
std::pair<V, V> sphere(double u, double v) {
  const double theta = M_PI * v, phi = 2 * M_PI * u;
  return {{}, {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)}};
}
// Clarberg's equal-area square, whose third axis is y: section 3.8.3.
std::pair<V, V> square(double u, double v) {
  const double a = 2 * u - 1, b = 2 * v - 1, distance = 1 - (std::abs(a) + std::abs(b)), r = 1 - std::abs(distance);
  const double phi = (r == 0 ? 1 : (std::abs(b) - std::abs(a)) / r + 1) * M_PI / 4, ring = r * std::sqrt(2 - r * r);
  return {{},
          {std::copysign(std::cos(phi), a) * ring, std::copysign(1 - r * r, distance), std::copysign(std::sin(phi), b) * ring}};
}

TEST(PbrtCamera, SphericalOnes) {
  expect_rays("Camera \"spherical\"", false, square);
  expect_rays("Camera \"spherical\" \"string mapping\" \"equalarea\"", false, square);
  expect_rays("Camera \"spherical\" \"string mapping\" \"equirectangular\"", false, sphere);
  expect_rays("Camera \"environment\"", true, sphere);
}

// The screen window is the visible part of a screen at the distance 1 / tan(fov / 2); v runs upwards.
TEST(PbrtCamera, WindowsBesideTheMiddle) {
  const double x0 = -0.75, x1 = 3.75, y0 = -2.5, y1 = 0.5;
  const auto at = [&](double u, double v) { return V{x0 + u * (x1 - x0), y1 + v * (y0 - y1), 0}; };
  const std::string window = "\"float screenwindow\" [ -0.75 3.75 -2.5 0.5 ]";
  expect_rays("Camera \"orthographic\" " + window, false, [&](double u, double v) { return std::pair(at(u, v), V{0, 0, 1}); });
  expect_rays("Camera \"perspective\" \"float fov\" 70 " + window, false, [&](double u, double v) {
    const V p = at(u, v);
    return std::pair(V{}, V{p.x, p.y, 1 / std::tan(35 * M_PI / 180)});
  });
}

// Film of 36 mm by 24 mm at the origin, a lens of 100 mm focused at 2 m, and a stop so small that it is a pinhole. The film's
// right half sees the scene to the left of the lens. Tested also in a world twice as large.
TEST(PbrtCamera, RealisticOnes) {
  const double image = (2 - std::sqrt(4 - 4 * 0.1 * 2)) / 2;  // 1 / s + 1 / s' = 1 / f, s + s' = 2
  for (const double scale : {1.0, 2.0})
    expect_rays(
        "Camera \"realistic\" \"string lensfile\" \"thin.dat\" \"float aperturediameter\" 0.0001 \"float focusdistance\" 2",
        false,
        [&](double u, double v) { return std::pair(V{0, 0, image * scale}, V{0.036 * (u - 0.5), -0.024 * (v - 0.5), image}); },
        "\"float diagonal\" 43.2666", fmt::format("Scale {0} {0} {0}\n", 1 / scale));
}

// The irradiance of the film in a uniform environment: pi sin^2 of the stop's angle, for a shutter of 1 s and ISO 100.
TEST(PbrtCamera, RealisticOnesMeasureIrradiance) {
  const TemporaryFolder folder;
  folder.write("thin.dat", "100 1e-6 1.5 40\n-100 1e-6 1 40\n0 0 0 40\n");
  const Imported i = import_text(
      folder,
      "Camera \"realistic\" \"string lensfile\" \"thin.dat\" \"float aperturediameter\" 20 \"float focusdistance\" 2\nFilm "
      "\"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1 \"float diagonal\" 0.1 \"float iso\" 200\nPixelFilter "
      "\"box\"\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [1 1 1]\n");
  EXPECT_EQ(i.told(), "");
  const double image = (2 - std::sqrt(4 - 4 * 0.1 * 2)) / 2;
  EXPECT_NEAR(seen(i, 4096).y, 2 * M_PI * 1e-4 / (1e-4 + image * image), 3e-4);
}

TEST(PbrtCamera, RealisticOnesNeedTheirLens) {
  const TemporaryFolder folder;
  folder.write("bad.dat", "100 1 1.5\n");
  const auto told = [&](const std::string& file) {
    return import_text(folder,
                       "Camera \"realistic\" \"string lensfile\" \"" + file + "\"\nFilm \"rgb\"\nWorldBegin\nShape \"sphere\"")
        .told();
  };
  EXPECT_NE(told("bad.dat").find("four numbers"), std::string::npos) << told("bad.dat");
  EXPECT_NE(told("none.dat").find("none.dat"), std::string::npos) << told("none.dat");
  EXPECT_NE(told("none.dat").find("pinhole"), std::string::npos) << told("none.dat");
}

}  // namespace
}  // namespace etendue::pbrt_test
