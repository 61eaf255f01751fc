// Cameras: fields of view across each side of wide and tall pictures, focus, importance and the shutter against formulas.

#include <gtest/gtest.h>

#include "etendue/camera.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;
using List = std::vector<double>;

double degrees_between(const Vector3& a, const Vector3& b) {
  return std::atan2(double(length(cross(a, b))), double(dot(a, b))) * 180 / M_PI;
}

TEST(CameraNumbers, FieldOfViewAcrossEachSide) {
  const struct {
    const char* axis;
    int width, height;
    bool across_width;
  } rows[] = {{"width", 300, 200, true},   {"width", 200, 300, true},    {"height", 300, 200, false},
              {"height", 200, 300, false}, {"smaller", 300, 200, false}, {"smaller", 200, 300, true},
              {"larger", 300, 200, true},  {"larger", 200, 300, false}};
  for (const auto& r : rows) {
    const Ref<Camera> camera = create<Camera>(
        "PerspectiveCamera", {{"from", List{1, 2, 3}}, {"to", List{1, 2, 7}}, {"fov", 50.0}, {"fov_axis", r.axis}});
    camera->set_film(r.width, r.height);
    const float w = float(r.width), h = float(r.height);
    const Point2 a = r.across_width ? Point2{0, h / 2} : Point2{w / 2, 0},
                 b = r.across_width ? Point2{w, h / 2} : Point2{w / 2, h};
    const Point2 lens{0.3f, 0.8f};
    EXPECT_NEAR(degrees_between(camera->ray(a, lens, 0).direction, camera->ray(b, lens, 0).direction), 50, 1e-3)
        << r.axis << r.width;
    // Pixels are square: equal steps on the plane at distance 1.
    const auto at = [&](float x, float y) {
      const Vector3 d = camera->ray({x, y}, lens, 0).direction;
      return Vector3{d.x / d.z, d.y / d.z, 1};
    };
    EXPECT_NEAR(length(at(w / 2 + 10, h / 2) - at(w / 2, h / 2)), length(at(w / 2, h / 2 + 10) - at(w / 2, h / 2)), 1e-6f);
    EXPECT_GT(at(w / 2, h / 2).y, at(w / 2, h / 2 + 10).y);  // rows run downwards
  }
}

// All rays of a film point meet in the plane of focus, at the point that a pinhole camera would show.
TEST(CameraNumbers, LensesFocusWhereTheySay) {
  for (const double focus : {0.0, 2.5}) {
    const Ref<Camera> camera = create<Camera>(
        "PerspectiveCamera",
        {{"from", List{0, 0, 0}}, {"to", List{0, 0, 4}}, {"fov", 40.0}, {"lens_radius", 0.2}, {"focus_distance", focus}});
    camera->set_film(40, 30);
    const double plane = focus > 0 ? focus : 4, half = std::tan(20 * M_PI / 180);
    for (const Point2 film : {Point2{20, 15}, {3, 28}, {37.5f, 1.25f}}) {
      const double x = (double(film.x) - 20) / 15 * half * plane, y = (15 - double(film.y)) / 15 * half * plane;
      double spread = 0;
      for (const Point2 lens : {Point2{0.1f, 0.2f}, {0.9f, 0.5f}, {0.5f, 0.95f}, {0.7f, 0.01f}}) {
        const Ray r = camera->ray(film, lens, 0);
        EXPECT_NEAR(length(r.direction), 1, 1e-5f);
        EXPECT_LE(std::hypot(r.origin.x, r.origin.y), 0.2001f);
        const float t = float(plane - double(r.origin.z)) / r.direction.z;
        const Point3 p = r(t);
        EXPECT_NEAR(double(p.x), -x, 2e-5);  // seen along +z with +y up, +x is on the left
        EXPECT_NEAR(double(p.y), y, 2e-5);
        spread += double(std::hypot(r.origin.x, r.origin.y));
      }
      EXPECT_GT(spread, 0.1);
    }
  }
}

// The importance of parallel rays is one over the film's area: W_e integrates to 1 over lens and film.
TEST(CameraNumbers, ImportanceOfParallelRaysIsOverTheFilmsArea) {
  const Ref<Camera> camera =
      create<Camera>("OrthographicCamera", {{"from", List{0, 0, 0}}, {"to", List{0, 0, 1}}, {"width", 3.0}});
  camera->set_film(30, 20);
  const Ray r = camera->ray({12.25f, 3.5f}, {}, 0);
  EXPECT_NEAR(std::abs(r.origin.x), (15 - 12.25) * 0.1, 1e-6);
  EXPECT_NEAR(r.origin.y, (10 - 3.5) * 0.1, 1e-6);
  EXPECT_NEAR(camera->importance(r), 1 / (3.0f * 2), 1e-6f);
  EXPECT_NEAR(camera->pdf(r).position, 1 / (3.0f * 2), 1e-6f);
  const auto s = camera->sample_lens({0.4f, -0.3f, 5}, 0, {});
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->importance / s->pdf, 1 / 6.0f, 1e-6f);
  EXPECT_NEAR(s->distance, 5, 1e-6f);
}

TEST(CameraNumbers, ImportanceOfALensIntegratesToOne) {
  const Ref<Camera> camera = create<Camera>(
      "PerspectiveCamera", {{"from", List{0, 0, 0}}, {"to", List{0, 0, 2}}, {"fov", 70.0}, {"lens_radius", 0.25}});
  camera->set_film(40, 25);
  // Integrated over the film at one lens point: W_e cos dw = dA W_e cos^4 at distance 1; times the lens's area.
  for (const Point2 lens : {Point2{0.5f, 0.5f}, {0.8f, 0.3f}}) {
    double sum = 0;
    constexpr int steps = 50;
    for (int i = 0; i < steps; ++i)
      for (int k = 0; k < steps; ++k) {
        const Ray r = camera->ray({40 * (float(i) + 0.5f) / steps, 25 * (float(k) + 0.5f) / steps}, lens, 0);
        const double c = double(r.direction.z), half = std::tan(35 * M_PI / 180),
                     area = 4 * half * half * 40 / 25 / (steps * steps);
        sum += double(camera->importance(r)) * c * c * c * c * area * M_PI * 0.25 * 0.25;
        EXPECT_NEAR(double(camera->pdf(r).direction) * c * c * c * area * steps * steps, 1, 1e-3);
        EXPECT_NEAR(double(camera->pdf(r).position) * M_PI * 0.25 * 0.25, 1, 1e-4);
      }
    EXPECT_NEAR(sum, 1, 1e-3);
  }
}

// The shutter opens in 0.3 s, closes in 0.5 s, and is open for 2 s in all: its opening over time is a trapezoid.
TEST(CameraNumbers, ShutterOpensAndClosesLinearly) {
  const struct {
    double opening, closing;
  } rows[] = {{0.3, 0.5}, {0, 0.8}, {1.2, 0}, {1, 1}};
  for (const auto& r : rows) {
    const Ref<Camera> camera = create<Camera>(
        "PerspectiveCamera",
        {{"shutter_open", 1.0}, {"shutter_close", 3.0}, {"shutter_opening", r.opening}, {"shutter_closing", r.closing}});
    const auto open = [&](double t) {
      if (t < 1 || t > 3) return 0.0;
      return std::min({1.0, r.opening > 0 ? (t - 1) / r.opening : 1, r.closing > 0 ? (3 - t) / r.closing : 1});
    };
    for (double t = 0.95; t < 3.1; t += 0.0331) EXPECT_NEAR(double(camera->shutter_efficiency(float(t))), open(t), 1e-5) << t;
    const double area = 2 - (r.opening + r.closing) / 2;
    for (const float u : {0.01f, 0.05f, 0.2f, 0.5f, 0.8f, 0.9f, 0.97f, 0.999f}) {
      const double t = double(camera->shutter_time(u));
      double before = 0;
      constexpr int steps = 20000;
      for (int i = 0; i < steps; ++i) before += open(1 + (t - 1) * (i + 0.5) / steps) * (t - 1) / steps;
      EXPECT_NEAR(before / area, double(u), 1e-4) << r.opening << " " << r.closing;
    }
  }
}

}  // namespace
}  // namespace etendue
