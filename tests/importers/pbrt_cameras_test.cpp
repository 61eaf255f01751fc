// pbrt's cameras: rays as its books define them.

#include "pbrt_support.h"

namespace etendue::pbrt_test {
namespace {

using V = DoubleVector3;

V times(double s, const V& v) { return {s * v.x, s * v.y, s * v.z}; }
V unit(const V& v) { return times(1 / std::sqrt(dot(v, v)), v); }

/// pbrt's camera, which LookAt places: to the right, up and forward.
struct Axes {
  V origin, right, up, forward;
  V world(const V& v) const {
    const V a = times(v.x, right), b = times(v.y, up), c = times(v.z, forward);
    return {a.x + b.x + c.x, a.y + b.y + c.y, a.z + b.z + c.z};
  }
};
/// "LookAt from to up", after a "Scale -1 1 1" if mirrored, which turns its right to the left.
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

/// Rays of a camera against those of a function of (u, v), from 0 to 1, in pbrt's camera coordinates: origin and direction.
template <class F>
void expect_rays(const std::string& camera, bool v3, const F& expected) {
  for (const bool mirrored : {false, true}) {
    const Imported i = import_text((mirrored ? "Scale -1 1 1\n" : "") + look + camera + "\nFilm \"" + (v3 ? "image" : "rgb") +
                                   "\" \"integer xresolution\" 60 \"integer yresolution\" 40\nPixelFilter \"box\"\nWorldBegin\n"
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

// (u, v) are angles of spherical coordinates whose pole is y: Pharr, Jakob & Humphreys, 5.3 and, of version 3, 6.3.
std::pair<V, V> sphere(double u, double v) {
  const double theta = M_PI * v, phi = 2 * M_PI * u;
  return {{}, {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)}};
}
// Clarberg's square, whose third axis is y: section 3.8.3.
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

// The screen window is what is seen of a screen at the distance 1 / tan(fov / 2), upwards.
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

}  // namespace
}  // namespace etendue::pbrt_test
