// LensCamera: focal lengths, sharpness and brightness of lenses against formulas of optics.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "components/cameras/lens_system.h"
#include "etendue/camera.h"
#include "support/component_test_support.h"
#include "support/process.h"
#include "support/render_support.h"

namespace etendue {
namespace {

using test::create;
using List = std::vector<double>;

/// An equiconvex thin lens of glass, n = 1.5, with radii of 100 mm; by the lensmaker's equation 1 / f = (n - 1) (2 / R).
List thin(double diameter) { return {100, 1e-6, 1.5, diameter, -100, 0, 1, diameter}; }

// f = 1 / ((n - 1) (1 / R1 - 1 / R2 + (n - 1) d / (n R1 R2))), back focus f (1 - (n - 1) d / (n R1)).
TEST(LensSystem, FocalLengthsAreTheLensmakers) {
  const struct {
    double r1, r2, thickness, index;
  } rows[] = {{100, -100, 1e-9, 1.5}, {50, -80, 12, 1.6}, {40, 60, 5, 1.7}, {-300, -45, 8, 1.52}};
  for (const auto& row : rows) {
    LensSystem lens;
    lens.set(lens_surfaces({row.r1, row.thickness, row.index, 20, row.r2, 0, 1, 20}, 1e-3));
    const double power =
        (row.index - 1) * (1 / row.r1 - 1 / row.r2 + (row.index - 1) * row.thickness / (row.index * row.r1 * row.r2));
    EXPECT_NEAR(lens.focal_length(), 1e-3 / power, 1e-9);
    EXPECT_NEAR(lens.back_focus(), 1e-3 / power * (1 - (row.index - 1) * row.thickness / (row.index * row.r1)), 1e-9);
  }
}

// Kolb et al. 1995, table 1: in a lens of 100 mm the last surface is 72.228 mm before the film; the default lens has half that
// size.
TEST(LensSystem, ADoubleGaussHasTheFocusOfItsTable) {
  const Ref<Component> camera = Registry::instance().create("LensCamera");
  const Value value = get(*camera, "surfaces");
  LensSystem lens;
  lens.set(lens_surfaces(value.as<Numbers>()->values, 1e-3));
  EXPECT_NEAR(lens.back_focus(), 36.114e-3, 0.05e-3);
  EXPECT_NEAR(lens.focal_length(), 50e-3, 0.5e-3);  // its nominal focal length
}

// Rays from one film point through the whole lens meet at the requested focus distance, as far from the axis as the lens
// magnifies: for a thin lens 1 / s + 1 / s' = 1 / f.
TEST(LensCamera, IsSharpWhereItSays) {
  const double f = 0.1;  // m
  for (const double distance : {0.5, 1.0, 20.0}) {
    const Ref<Camera> camera =
        create<Camera>("LensCamera", {{"surfaces", thin(2)}, {"focus_distance", distance}, {"film_diagonal", 0.002}});
    camera->set_film(300, 400);
    const double image = (distance - std::sqrt(distance * distance - 4 * f * distance)) / 2, object = distance - image;
    EXPECT_NEAR(1 / image + 1 / object, 1 / f, 1e-9);
    test::Random random(3);
    for (int i = 0; i < 100; ++i) {
      const Ray ray = camera->ray({300, 0}, random.pair(), 0);
      EXPECT_NEAR(double(ray.origin.z), image, 1e-5);
      const Point3 met = ray(float(distance - double(ray.origin.z)) / ray.direction.z);
      // The film's upper right corner, 0.6 mm and 0.8 mm from the axis; x runs to the left in the world.
      EXPECT_NEAR(double(met.x), -0.0006 * object / image, 2e-5 * distance) << distance;
      EXPECT_NEAR(double(met.y), 0.0008 * object / image, 2e-5 * distance) << distance;
    }
  }
}

// Under a uniform radiance of 1 the film's irradiance is pi sin^2 in the middle, with tan(theta) = lens radius / image
// distance, and for a small thin lens cos^4 of that away from the middle. In units of radiance, the middle is 1.
TEST(LensCamera, IsAsBrightAsItsPupilIsLarge) {
  for (const char* measures : {"irradiance", "radiance"}) {
    const auto picture = [&](const std::string& renderer, double diameter) {
      const List lens = thin(diameter);
      const Ref<Job> job = load_job_text(
          fmt::format(
              "Job {{ renderer: {}, camera: LensCamera {{ surfaces: [{}], focus_distance: 2, film_diagonal: 0.1, measures: "
              "{} }}, image: ImageBuffer {{ width: 3, height: 3, filter: BoxFilter {{}} }}, scene: BruteForceScene {{ "
              "objects: [ Sphere {{ radius: 5, emission: DiffuseEmission {{ radiance: 1, sides: back }}, shader: Lambertian {{ "
              "color: 0 }} }} ] }} }}",
              renderer, fmt::join(lens, ", "), measures),
          "lens.etd");
      return test::rendered(job)->picture();
    };
    const bool radiance = measures == std::string("radiance");
    const double image = (2 - std::sqrt(4 - 0.8)) / 2;
    for (const double diameter : {2.0, 8.0}) {
      const Image seen = picture("PathTracer { samples: 2048 }", diameter);
      const double squared = diameter * diameter * 0.25e-6, middle = radiance ? 1 : M_PI * squared / (squared + image * image);
      // The middle pixel is 0.0236 m wide: the mean of cos^4 in it, and in the pixel at the corner.
      const double side = 0.1 / std::sqrt(2) / 3;
      const auto mean = [&](double x, double y) {
        double sum = 0;
        for (int i = 0; i < 1600; ++i) {
          const double a = x + ((i % 40) + 0.5) / 40 - 0.5, b = y + (i / 40 + 0.5) / 40 - 0.5;
          sum += std::pow(1 + (a * a + b * b) * side * side / (image * image), -2);
        }
        return sum / 1600;
      };
      EXPECT_NEAR(seen.at(1, 1, 1), middle * mean(0, 0), 0.01 * middle) << measures << diameter;
      EXPECT_NEAR(seen.at(0, 0, 1), middle * mean(1, 1), 0.015 * middle) << measures << diameter;
      EXPECT_NEAR(seen.at(2, 1, 1), middle * mean(1, 0), 0.015 * middle) << measures << diameter;
    }
    const Image a = picture("PathTracer { samples: 1024 }", 10), b = picture("LightTracer { samples: 65536 }", 10);
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x) EXPECT_NEAR(a.at(x, y, 1), b.at(x, y, 1), 0.1 * a.at(1, 1, 1)) << measures;
  }
}

// Rays from the film and back to it, through a thick lens with a stop.
TEST(LensCamera, RaysLeadBack) {
  for (const double stop : {0.0, 0.002}) {
    const Ref<Camera> camera =
        create<Camera>("LensCamera", {{"from", List{1, 2, -3}}, {"to", List{0.5, 1, 4}}, {"aperture_diameter", stop}});
    constexpr float width = 300, height = 200;
    camera->set_film(300, 200);
    test::Random random(5);
    int passed = 0;
    for (int i = 0; i < 3000; ++i) {
      const Point2 u = random.pair(), film{u.x * width, u.y * height};
      Wavelengths w;
      CameraRay sent;
      if (!camera->sample_ray(film, random.pair(), 0, w, sent)) continue;
      ++passed;
      const auto back = camera->film_point(sent.ray);
      ASSERT_TRUE(back);
      EXPECT_NEAR(back->x, film.x, 0.01f);
      EXPECT_NEAR(back->y, film.y, 0.01f);
      // The pdfs and the importance of this ray give the weight with which it was sampled.
      const CameraPdf d = camera->pdf(sent.ray);
      const Vector3 axis = normalize(Vector3{-0.5f, -1, 7});
      const float cosine = dot(axis, sent.ray.direction);
      EXPECT_NEAR(sent.weight.average() * d.position * d.direction / camera->importance(sent.ray), cosine, 1e-3f);
    }
    EXPECT_GT(passed, 1200) << stop;  // most rays aimed at the pupil pass
  }
}

TEST(LensCamera, IsNotMirrored) {
  const Ref<Camera> camera = create<Camera>("LensCamera", {{"from", List{0, 0, 5}}, {"to", List{0, 0, 0}}});
  camera->set_film(100, 100);
  Point2 right, above;
  test::Random random(2);
  for (int i = 0; i < 100; ++i) {
    if (const auto s = camera->sample_lens({0.4f, 0, 0}, 0, random.pair())) right = s->film;
    if (const auto s = camera->sample_lens({0, 0.4f, 0}, 0, random.pair())) above = s->film;
  }
  EXPECT_GT(right.x, 55);
  EXPECT_NEAR(right.y, 50, 1);
  EXPECT_LT(above.y, 45);
  EXPECT_GT(above.y, 1);
}

TEST(LensCamera, ReadsTables) {
  const TemporaryFolder folder;
  const auto made = [&](const std::string& text) {
    const Ref<Camera> camera = ref_cast<Camera>(Registry::instance().create("LensCamera"));
    set(*camera, "file", Value(FilePath{folder.write("lens.dat", text), {}}));
    set(*camera, "focus_distance", Value(Number{2}));
    camera->prepare();
    return camera;
  };
  const Ref<Camera> camera = made("# a lens\n100 1 1.5 20 # front\r\n-100 5 1 20\n0\t3 0 +10\n");
  camera->set_film(10, 10);
  const auto reason = [&](const std::string& text) -> std::string {
    try {
      made(text);
    } catch (const Error& e) {
      return e.what();
    }
    return "nothing";
  };
  EXPECT_NE(reason("1 2 3").find("four numbers"), std::string::npos) << reason("1 2 3");
  EXPECT_NE(reason("100 1 1.5 20\n-100 x 1 20").find("line 2: a number"), std::string::npos);
  EXPECT_NE(reason("-100 1 1.5 20 100 0 1 20").find("does not gather light"), std::string::npos);
  EXPECT_NE(reason("100 -1 1.5 20 -100 0 1 20").find("thickness"), std::string::npos);
  EXPECT_NE(reason("100 1 0.5 20 -100 0 1 20").find("index"), std::string::npos);
  EXPECT_NE(reason("100 1 1.5 20 -100 0 1.5 20").find("air"), std::string::npos);
  EXPECT_THROW(create<Camera>("LensCamera", {{"focus_distance", 0.1}}), Error);                               // nearer than 4 f
  EXPECT_THROW(create<Camera>("LensCamera", {{"surfaces", thin(10)}, {"aperture_diameter", 0.005}}), Error);  // no stop
}

}  // namespace
}  // namespace etendue
