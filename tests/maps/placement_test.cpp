// The transform from object space at a point of a nested scene, and the widths of map filters that follow from it, for shapes
// of all kinds.

#include "components/maps/footprint.h"
#include "etendue/language/language.h"
#include "etendue/scene.h"
#include "geometry/geometry.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

class PlacedShape : public ::testing::TestWithParam<const char*> {};

// The shape is moved by `inside` within its scene and with this scene by `outside`, both similarities. Points whose tangents
// are those of a point before the placement must lead back to the product of both.
TEST_P(PlacedShape, PlacementGoesThroughNestedScenes) {
  const Ref<SceneObject> shape = ref_cast<SceneObject>(parse_component(GetParam()));
  const Transform inside =
      Transform::translate({1, 2, 3}) * Transform::rotate(0.6, {0, 1, 1}) * Transform::scale({0.5, 0.5, 0.5});
  const Transform outside =
      Transform::translate({-2, 1, 0.5}) * Transform::rotate(1.1, {1, -1, 2}) * Transform::scale({3, 3, 3});
  set(*shape, "transform", Value(inside));
  prepare_tree(*shape);
  const Transform wanted = outside * inside;
  test::Random random(1);
  for (int i = 0; i < 100; ++i) {
    SurfacePoint p = shape->sample_area(random.pair(), 0).point;
    ASSERT_EQ(p.object, shape.get());
    shape->tangents(p);
    carry_out(outside, p);
    p.footprint = 0.03f;
    p.footprint_cosine = 0.8f;
    Transform scratch;
    const Transform::Matrix& got = placement(p, scratch).matrix();
    for (size_t k = 0; k < 12; ++k)
      EXPECT_NEAR(got[k], wanted.matrix()[k], 2e-3f) << k << " at uv " << p.uv.x << ", " << p.uv.y;
    EXPECT_NEAR(solid_point(p, MapSpace::object, 1).width, p.footprint / std::sqrt(p.footprint_cosine) / 1.5f,
                2e-3f * p.footprint);
  }
}

// The points that rays find in an instance which enlarges its scene: object space is smaller by the same factor.
TEST_P(PlacedShape, FootprintsInInstancesAreThoseOfObjectSpace) {
  constexpr float scale = 4;
  const Ref<Scene> scene =
      ref_cast<Scene>(parse_component(std::string("BvhScene { objects: [Instance { transform: translate(1, 2, 3) * scale(4), "
                                                  "scene: BvhScene { objects: [") +
                                      GetParam() + "] } }] }"));
  prepare_tree(*scene);
  test::Random random(2);
  int hits = 0;
  for (int i = 0; i < 1000; ++i) {
    Ray ray;
    const Vector3 d = random.direction();
    const Frame frame{Normal3(d)};
    const Point2 at = random.pair();
    ray.origin = Point3{1, 2, 3} - 20 * d + 4 * (2 * at.x - 1) * frame.s + 4 * (2 * at.y - 1) * frame.t;
    ray.direction = d;
    ray.spread = 1e-3f;
    Hit hit;
    if (!scene->nearest(ray, hit)) continue;
    ++hits;
    SurfacePoint p;
    scene->locate(ray, hit, p);
    if (p.footprint_cosine < 0.1f) continue;  // the footprint's length is limited
    const float width = p.footprint / std::sqrt(p.footprint_cosine);
    EXPECT_NEAR(solid_point(p, MapSpace::object, 1).width, width / scale, 1e-3f * width)
        << "at uv " << p.uv.x << ", " << p.uv.y;
    const Footprint seen = footprint_of(p), own = object_footprint(p);
    EXPECT_NEAR(length(own.longer), length(seen.longer) / scale, 1e-3f * length(seen.longer));
    EXPECT_NEAR(length(own.shorter), length(seen.shorter) / scale, 1e-3f * length(seen.shorter));
  }
  EXPECT_GT(hits, 20);
}

INSTANTIATE_TEST_SUITE_P(
    Maps, PlacedShape,
    ::testing::Values("Sphere {}", "Disc {}", "Rectangle {}",
                      "TriangleMesh { positions: [[-1, -1, 0], [1, -1, 0], [0, 1, 1]] m, triangles: [0, 1, 2] }",
                      "TriangleMesh { positions: [[-1, -1, 0], [1, -1, 0], [0, 1, 1]] m, triangles: [0, 1, 2], uvs: [[0, 0], "
                      "[0, 0], [0, 0]] }",
                      "Torus {}", "Cone {}", "Cylinder {}", "Hyperboloid {}", "Paraboloid {}", "Tube {}", "Box {}",
                      "Annulus {}", "Annulus { coordinates: \"around\" }", "Ellipsoid { radii: [1, 0.5, 0.8] m }",
                      "Curve { radius: [0.2] m }", "Curve { radius: [0.2] m, form: \"ribbon\" }",
                      "Quadric { squares: [1, 2, 3], high: [1, 1, 0.3] m }", "Metaballs {}", "BezierPatches {}",
                      "Difference { operands: [Sphere {}, Torus { radius: 1 m, transform: translate(0, 0, 0.5) }] }",
                      "Intersection { operands: [Box {}, Union { operands: [Quadric { high: [1, 1, 0.3] m }, Cylinder { "
                      "radius: 0.3 m }] }] }"),
    [](const auto& each) {
      const std::string text = each.param;
      return text.substr(0, text.find(' ')) + "_" + std::to_string(each.index);
    });

}  // namespace
}  // namespace etendue
