// Cameras: film points and rays in both directions, importance and pdfs, lens samples, handedness.

#include "etendue/camera.h"

#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;

constexpr int width = 320, height = 200;
const std::vector<double> from{1, 2, -3}, to{0.5, 1, 4}, up{0.1, 1, 0};

struct Case {
  std::string name;
  Ref<Camera> camera;
  bool lens;
};

std::vector<Case> cameras() {
  std::vector<Case> list{
      {"pinhole", create<Camera>("PerspectiveCamera", {{"from", from}, {"to", to}, {"up", up}, {"fov", 50.0}}), false},
      {"thin lens",
       create<Camera>("PerspectiveCamera", {{"from", from}, {"to", to}, {"up", up}, {"fov", 60.0}, {"lens_radius", 0.2}}),
       true},
      {"near focus",
       create<Camera>("PerspectiveCamera",
                      {{"from", from}, {"to", to}, {"up", up}, {"lens_radius", 0.3}, {"focus_distance", 0.9}}),
       true},
      {"orthographic", create<Camera>("OrthographicCamera", {{"from", from}, {"to", to}, {"up", up}, {"width", 3.0}}), false},
      {"shifted",
       create<Camera>("PerspectiveCamera", {{"from", from},
                                            {"to", to},
                                            {"up", up},
                                            {"lens_radius", 0.1},
                                            {"focal_length", 0.05},
                                            {"principal_point", std::vector<double>{0.15, -0.4}}}),
       true},
      {"clipped",
       create<Camera>("PerspectiveCamera",
                      {{"from", from}, {"to", to}, {"up", up}, {"fov", 50.0}, {"near_clip", 0.7}, {"far_clip", 60.0}}),
       false}};
  for (const Case& c : list) c.camera->set_film(width, height);
  return list;
}

Point2 random_film(test::Random& random) {
  const Point2 u = random.pair();
  return {u.x * width, u.y * height};
}

TEST(Camera, FilmPointOfARayIsWhereItCameFrom) {
  test::Random random(1);
  for (const Case& c : cameras())
    for (int i = 0; i < 500; ++i) {
      const Point2 film = random_film(random);
      const Ray ray = c.camera->ray(film, random.pair(), 0);
      EXPECT_NEAR(length(ray.direction), 1, 1e-6f);
      const auto back = c.camera->film_point(ray);
      ASSERT_TRUE(back) << c.name;
      EXPECT_NEAR(back->x, film.x, 1e-3f) << c.name;
      EXPECT_NEAR(back->y, film.y, 1e-3f) << c.name;
    }
}

// Directions divided by their component along the axis, from `perspective` of Mitsuba 3.9.1 with a film of 300 x 200 (its
// default is a focal length of 50 mm over the diagonal of 36 x 24 mm; its offsets have the opposite sign; its first axis points
// to the left).
TEST(PerspectiveCamera, FocalLengthDiagonalAndPrincipalPointAreThoseOfMitsuba) {
  struct Row {
    std::vector<test::Setting> settings;
    Point2 film;
    double right, down;
  };
  const std::vector<double> offset{-0.2, -0.1};
  const Row rows[] = {{{{"focal_length", 0.05}}, {0, 0}, -0.36, -0.24},
                      {{{"focal_length", 0.05}}, {0.7f, 0.4f}, 0.144, -0.048},
                      {{{"focal_length", 0.05}, {"principal_point", offset}}, {0.5f, 0.5f}, 0.144, 0.048},
                      {{{"focal_length", 0.05}, {"principal_point", offset}}, {0.7f, 0.4f}, 0.288, 0},
                      {{{"focal_length", 0.035}}, {0, 0}, -0.514286, -0.342857},
                      {{{"fov", 40.0}}, {0, 0}, -0.302842, -0.201894}};
  for (const Row& row : rows) {
    std::vector<test::Setting> settings = row.settings;
    settings.insert(settings.end(), {{"fov_axis", "diagonal"}, {"to", std::vector<double>{0, 0, 1}}});
    const Ref<Camera> camera = create<Camera>("PerspectiveCamera", settings);
    camera->set_film(300, 200);
    const Ray ray = camera->ray({row.film.x * 300, row.film.y * 200}, {0.5f, 0.5f}, 0);
    const Vector3 right = cross(Vector3{0, 0, 1}, Vector3{0, 1, 0});  // cross(viewing direction, up)
    EXPECT_NEAR(double(dot(ray.direction, right) / ray.direction.z), row.right, 2e-5);
    EXPECT_NEAR(double(-ray.direction.y / ray.direction.z), row.down, 2e-5);
  }
}

TEST(Camera, SaysWhetherItsRaysLookAtTheLensPoint) {
  for (const Case& c : cameras()) {
    EXPECT_EQ(c.camera->has_lens(), c.lens) << c.name;
    const Ray a = c.camera->ray({20, 30}, {0.1f, 0.2f}, 0), b = c.camera->ray({20, 30}, {0.9f, 0.6f}, 0);
    EXPECT_EQ(a.origin == b.origin && a.direction == b.direction, !c.lens) << c.name;
  }
}

TEST(Camera, RaysThatMissAreEmpty) {
  for (const Case& c : cameras()) {
    Ray ray = c.camera->ray({width / 2.0f, height / 2.0f}, {0.5f, 0.5f}, 0);
    const Vector3 forward = ray.direction;
    ray.direction = -forward;
    EXPECT_FALSE(c.camera->film_point(ray)) << c.name;
    EXPECT_EQ(c.camera->importance(ray), 0) << c.name;
    EXPECT_EQ(c.camera->pdf(ray).direction, 0) << c.name;
    ray.direction = normalize(forward + Vector3{0, 3, 0});
    EXPECT_FALSE(c.camera->film_point(ray)) << c.name;
    EXPECT_FALSE(c.camera->sample_lens(ray.origin - 2 * forward, 0, {0.5f, 0.5f})) << c.name;
    if (c.lens) {  // beside the lens
      ray.direction = forward;
      ray.origin = ray.origin + Vector3{0, 0.5f, 0};
      EXPECT_FALSE(c.camera->film_point(ray)) << c.name;
    }
  }
}

// W_e cos = p_position p_direction: camera rays have the weight 1.
TEST(Camera, ImportanceMatchesDensities) {
  test::Random random(2);
  for (const Case& c : cameras()) {
    const Vector3 axis = normalize(Vector3{-0.5f, -1, 7});
    for (int i = 0; i < 200; ++i) {
      const Ray ray = c.camera->ray(random_film(random), random.pair(), 0);
      const CameraPdf d = c.camera->pdf(ray);
      EXPECT_NEAR(c.camera->importance(ray) * dot(axis, ray.direction), d.position * d.direction,
                  1e-4f * d.position * d.direction)
          << c.name;
    }
  }
}

// The pdf of directions integrates to 1 over the sphere at each lens point, and therefore the importance to 1 over everything.
TEST(Camera, DensityIntegratesToOne) {
  for (const Case& c : cameras()) {
    if (c.name == "orthographic") continue;
    const Vector3 axis = normalize(Vector3{-0.5f, -1, 7});
    test::Random random(3);
    double direction_sum = 0, importance_sum = 0;
    constexpr int count = 100000;
    for (int i = 0; i < count; ++i) {
      Ray ray = c.camera->ray({width / 2.0f, height / 2.0f}, random.pair(), 0);  // any point of the lens
      const float lens_pdf = c.camera->pdf(ray).position;
      // Uniform in a cone of half angle 60 degrees, which contains the whole film.
      const float z = 1 - 0.5f * random(), phi = 2 * pi * random(), r = safe_sqrt(1 - z * z);
      ray.direction = Frame(Normal3(axis)).to_world({r * std::cos(phi), r * std::sin(phi), z});
      direction_sum += double(c.camera->pdf(ray).direction) * M_PI / count;
      importance_sum += double(c.camera->importance(ray) * dot(axis, ray.direction) / lens_pdf) * M_PI / count;
    }
    EXPECT_NEAR(direction_sum, 1, 0.03) << c.name;  // about six standard errors
    EXPECT_NEAR(importance_sum, 1, 0.03) << c.name;
  }
}

TEST(OrthographicCamera, ImportanceIsOneOverTheFilm) {
  const Ref<Camera> camera = cameras()[3].camera;
  const double area = 3.0 * 3.0 * height / width;
  EXPECT_NEAR(camera->importance(camera->ray({10, 20}, {}, 0)), 1 / area, 1e-6);
}

// Rays follow the reported pdf: counts over a grid of directions.
TEST(PerspectiveCamera, RaysFollowDensity) {
  for (const Case& c : cameras()) {
    if (c.name == "orthographic") continue;
    const Frame frame(Normal3(normalize(Vector3{-0.5f, -1, 7})));
    constexpr int grid = 20, count = 50000;
    // Cells in the plane at distance 1: the solid angle of a cell is cos^3 times its area.
    std::vector<double> expected(grid * grid), counts(grid * grid);
    const Point2 lens{0.3f, 0.8f};
    const Ray central = c.camera->ray({width / 2.0f, height / 2.0f}, lens, 0);
    for (size_t cell = 0; cell < grid * grid; ++cell) {
      constexpr int sub = 40;
      for (int i = 0; i < sub * sub; ++i) {
        const double x = -2 + 4.0 * (double(cell % grid) + (i % sub + 0.5) / sub) / grid,
                     y = -2 + 4.0 * (double(cell / grid) + (i / sub + 0.5) / sub) / grid;
        const double cosine = 1 / std::sqrt(1 + x * x + y * y);
        Ray ray = central;
        ray.direction = frame.to_world(normalize(Vector3{float(x), float(y), 1}));
        expected[cell] += count * double(c.camera->pdf(ray).direction) * std::pow(cosine, 3) * 16.0 / (grid * grid * sub * sub);
      }
    }
    test::Random random(12);
    for (int i = 0; i < count; ++i) {
      const Vector3 d = frame.to_local(c.camera->ray(random_film(random), lens, 0).direction);
      ++counts[size_t((d.y / d.z + 2) / 4 * grid) * grid + size_t((d.x / d.z + 2) / 4 * grid)];
    }
    // Cells that the film's edge cuts are left out: their quadrature is only good to a few per cent.
    std::vector<double> whole_expected, whole_counts;
    for (size_t i = 0; i < expected.size(); ++i) {
      bool inside = expected[i] > 0;
      for (const int step : {-1, 1, -grid, grid, -grid - 1, -grid + 1, grid - 1, grid + 1})
        inside = inside && expected[size_t(int(i) + step)] > 0;
      if (!inside) continue;
      whole_expected.push_back(expected[i]);
      whole_counts.push_back(counts[i]);
    }
    ASSERT_GT(whole_expected.size(), 9u) << c.name;
    EXPECT_GT(test::chi_square(whole_counts, whole_expected), test::each_of(3)) << c.name;
  }
}

TEST(Camera, LensSamplesAgreeWithRays) {
  test::Random random(4);
  for (const Case& c : cameras())
    for (int i = 0; i < 300; ++i) {
      const Ray ray = c.camera->ray(random_film(random), random.pair(), 0);
      const Point3 seen = ray(1 + 5 * random());
      const auto s = c.camera->sample_lens(seen, 0, random.pair());
      if (!s) {
        EXPECT_TRUE(c.lens) << c.name;  // seen from another point of the lens it may lie off the film
        continue;
      }
      EXPECT_NEAR(s->distance, distance(seen, s->lens), 1e-4f) << c.name;
      EXPECT_LT(length(normalize(s->lens - seen) - s->direction), 1e-5f) << c.name;
      Ray back = ray;
      back.origin = s->lens;
      back.direction = -s->direction;
      const auto film = c.camera->film_point(back);
      ASSERT_TRUE(film) << c.name;
      EXPECT_NEAR(film->x, s->film.x, 2e-2f) << c.name;
      EXPECT_NEAR(film->y, s->film.y, 2e-2f) << c.name;
      EXPECT_NEAR(c.camera->importance(back), s->importance, 1e-3f * s->importance) << c.name;
      if (c.name == "orthographic") {
        EXPECT_EQ(s->pdf, 1);
        continue;
      }
      // A pdf by lens area becomes one by solid angle with the factor distance^2 / cos.
      const float cosine = dot(normalize(Vector3{-0.5f, -1, 7}), back.direction);
      EXPECT_NEAR(s->pdf, c.camera->pdf(back).position * square(s->distance) / cosine, 1e-3f * s->pdf) << c.name;
    }
}

// A small bright disc facing the camera has the same brightness through its lens samples (importance / pdf) as through the
// camera rays that hit it.
TEST(Camera, BothDirectionsMeasureTheSame) {
  for (const Case& c : cameras()) {
    const Ray axis = c.camera->ray({width / 2.0f, height / 2.0f}, {0.5f, 0.5f}, 0);
    const Frame frame(Normal3(-axis.direction));
    const Point3 centre = axis(4);
    constexpr float radius = 0.25f;
    test::Random random(6);
    double by_rays = 0, by_lens = 0;
    constexpr int count = 200000;
    for (int i = 0; i < count; ++i) {
      const Ray ray = c.camera->ray(random_film(random), random.pair(), 0);
      const float t = dot(frame.n, centre - ray.origin) / dot(frame.n, ray.direction);
      by_rays += (t > 0 && distance(ray(t), centre) < radius) / double(count);

      const float r = radius * std::sqrt(random()), phi = 2 * pi * random();
      const Point3 point = centre + frame.to_world({r * std::cos(phi), r * std::sin(phi), 0});
      const auto s = c.camera->sample_lens(point, 0, random.pair());
      if (s) by_lens += double(pi * radius * radius * dot(frame.n, s->direction) * s->importance / s->pdf) / count;
    }
    EXPECT_GT(by_rays, 0.005);
    EXPECT_NEAR(by_lens, by_rays, 5 * std::sqrt(by_rays / count)) << c.name;
  }
}

TEST(Camera, PictureIsNotMirrored) {
  for (const char* name : {"PerspectiveCamera", "OrthographicCamera", "SphericalCamera"}) {
    const Ref<Camera> camera =
        create<Camera>(name, {{"from", std::vector<double>{0, 0, 5}}, {"to", std::vector<double>{0, 0, 0}}});
    camera->set_film(100, 100);
    // Looking along -z with +y up, +x is to the right.
    const auto right = camera->sample_lens({0.4f, 0, 0}, 0, {0.5f, 0.5f}),
               above = camera->sample_lens({0, 0.4f, 0}, 0, {0.5f, 0.5f});
    ASSERT_TRUE(right && above);
    EXPECT_GT(right->film.x, 51) << name;
    EXPECT_NEAR(right->film.y, 50, 1e-3f);
    EXPECT_LT(above->film.y, 49) << name;
    EXPECT_NEAR(above->film.x, 50, 1e-3f);
  }
}

TEST(PerspectiveCamera, FieldOfViewAndFocus) {
  const struct {
    const char* axis;
    bool across_width;
  } expected[] = {{"smaller", false}, {"larger", true}, {"width", true}, {"height", false}};
  for (const auto& e : expected) {
    const Ref<Camera> camera = create<Camera>("PerspectiveCamera", {{"fov", 50.0}, {"fov_axis", e.axis}});
    camera->set_film(width, height);
    const Ray edge = camera->ray(e.across_width ? Point2{0, height / 2.0f} : Point2{width / 2.0f, 0}, {}, 0);
    EXPECT_NEAR(degrees(std::acos(edge.direction.z)), 25, 1e-3f) << e.axis;
  }
  // All rays of a film point meet at the point in focus.
  const Ref<Camera> lens = cameras()[1].camera;
  const float focus = length(Vector3{-0.5f, -1, 7});
  const Vector3 axis = normalize(Vector3{-0.5f, -1, 7});
  const Point3 camera_at{1, 2, -3};
  test::Random random(9);
  const Ray first = lens->ray({40, 150}, random.pair(), 0);
  const auto at_focus = [&](const Ray& r) { return r((focus - dot(axis, r.origin - camera_at)) / dot(axis, r.direction)); };
  for (int i = 0; i < 20; ++i) EXPECT_LT(distance(at_focus(first), at_focus(lens->ray({40, 150}, random.pair(), 0))), 1e-4f);
}

TEST(PerspectiveCamera, ConeCoversAPixel) {
  const Ref<Camera> camera = cameras()[0].camera;
  const Ray a = camera->ray({160, 100}, {}, 0), b = camera->ray({161, 100}, {}, 0);
  EXPECT_EQ(a.width, 0);
  EXPECT_NEAR(a.spread, length(a.direction - b.direction), 0.01f * a.spread);
}

TEST(Camera, MovesWithTime) {
  for (const char* name : {"PerspectiveCamera", "OrthographicCamera", "SphericalCamera"}) {
    const Ref<Camera> camera = ref_cast<Camera>(Registry::instance().create(name));
    std::vector<AnimatedTransform::Key> keys{{0, Transform()}, {1, Transform::translate({2, 0, 0})}};
    set(*camera, "transform", Value(AnimatedTransform(keys)));
    set(*camera, "shutter_close", Value(Number{1}));
    camera->prepare();
    camera->set_film(10, 10);
    const Ray ray = camera->ray({5, 5}, {0.5f, 0.5f}, 0.5f);
    EXPECT_NEAR(ray.origin.x, 1, 1e-5f) << name;
    EXPECT_EQ(ray.time, 0.5f);
    EXPECT_TRUE(camera->film_point(ray)) << name;
  }
}

TEST(Camera, RefusesWhatMakesNoPicture) {
  EXPECT_THROW(create<Camera>("PerspectiveCamera", {{"from", to}, {"to", to}}), Error);
  EXPECT_THROW(create<Camera>("PerspectiveCamera", {{"up", std::vector<double>{0, 0, 2}}}), Error);
  EXPECT_THROW(create<Camera>("OrthographicCamera", {{"width", 0.0}}), Error);
  EXPECT_THROW(create<Camera>("PerspectiveCamera", {{"fov", 200.0}}), Error);
  EXPECT_THROW(create<Camera>("PerspectiveCamera", {{"shutter_open", 1.0}}), Error);
  const Ref<Camera> stretched = ref_cast<Camera>(Registry::instance().create("PerspectiveCamera"));
  set(*stretched, "transform", Value(Transform::scale({1, 2, 1})));
  EXPECT_THROW(stretched->prepare(), Error);
}

}  // namespace
}  // namespace etendue
