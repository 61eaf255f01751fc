// Members with zero, tiny, huge, infinite and undefined numbers, for every class of objects: the result is an error that gives
// its location, or an object all of whose results are numbers. The classes come from the registry, so that new classes are
// tested without being named here.

#include "check/conform/draw.h"
#include "etendue/language/language.h"
#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

/// Every query of the object terminates, and a result is finite where it is valid.
void expect_sane(const SceneObject& object, const std::string& what) {
  SCOPED_TRACE(what);
  const Bounds3 box = object.bounds();
  if (!object.unbounded() && !box.empty()) {
    EXPECT_TRUE(is_finite(box.low) && is_finite(box.high)) << "bounds";
  }
  if (object.infinite() || object.delta()) return;
  const float area = object.area(0);
  if (!object.unbounded()) {
    EXPECT_TRUE(area >= 0 && area < infinity) << "area " << area;
  }
  Random random(1);
  const Point3 centre = box.empty() || object.unbounded() ? Point3{} : box.centre();
  const float size = box.empty() || object.unbounded() ? 1 : std::max(1e-6f, length(box.diagonal()));
  for (int i = 0; i < 20; ++i) {
    const Vector3 d = random.direction();
    const Point3 target = centre + 0.4f * size * random.number() * random.direction();
    const Ray r = ray(target - (i % 3 ? 2 : 0.1f) * size * d, d);
    Hit hit;
    if (object.intersect(r, hit)) {
      EXPECT_TRUE(hit.distance > 0 && hit.distance < infinity) << "distance " << hit.distance;
      if (object.class_info().name.find("Scene") == std::string::npos && object.class_info().name != "Instance") {
        SurfacePoint p;
        object.surface_point(r, hit, p);
        EXPECT_TRUE(is_finite(p.position)) << "position";
        EXPECT_NEAR(length(Vector3(p.normal)), 1, 1e-3f) << "normal";
        EXPECT_NEAR(length(Vector3(p.shading_normal)), 1, 1e-3f) << "shading normal";
        EXPECT_TRUE(p.error >= 0 && p.error < infinity) << "error " << p.error;
        EXPECT_TRUE(std::isfinite(p.uv.x) && std::isfinite(p.uv.y)) << "uv";
        object.tangents(p);
        EXPECT_TRUE(is_finite(p.dpdu) && is_finite(p.dpdv)) << "tangents";
      }
    }
    if (object.unbounded()) continue;
    const SurfaceSample s = object.sample_area(random.pair(), 0);
    EXPECT_TRUE(s.pdf >= 0) << "density " << s.pdf;
    if (s.pdf > 0) {
      EXPECT_TRUE(is_finite(s.point.position)) << "sampled position";
    }
    const SurfaceSample v = object.sample_visible(r.origin, random.pair(), 0);
    EXPECT_TRUE(v.pdf >= 0) << "visible density " << v.pdf;
    if (v.pdf > 0) {
      EXPECT_TRUE(is_finite(v.point.position) && is_finite(v.direction)) << "visible position";
    }
    if (::testing::Test::HasFailure()) return;
  }
}

std::vector<Value> numbers_like(const Member& m, const Value& usual) {
  constexpr double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Value> out;
  if (m.kind == Kind::transform) {
    const auto matrix = [](float a, float b, float c, float t) {
      return Transform(Transform::Matrix{a, 0, 0, t, 0, b, 0, 0, 0, 0, c, 0});
    };
    const float n = float(nan), i = float(inf);
    for (const Transform& t : {matrix(0, 0, 0, 0), matrix(1, 1, 0, 0), matrix(n, 1, 1, 0), matrix(1, 1, 1, n),
                               matrix(i, 1, 1, 0), matrix(1, 1, 1, i), matrix(1e-6f, 1, 1, 0), matrix(1e6f, 1e6f, 1e6f, 0),
                               matrix(1e-12f, 1e-12f, 1e-12f, 0), matrix(1e12f, 1e12f, 1e12f, 0)})
      out.emplace_back(t);
    return out;
  }
  const bool whole = m.kind == Kind::integer;
  if (!whole && m.kind != Kind::number && m.kind != Kind::vector2 && m.kind != Kind::vector3 && m.kind != Kind::point3 &&
      m.kind != Kind::normal3)
    return out;
  const int width = m.kind == Kind::vector2 ? 2 : m.kind == Kind::number || whole ? 1 : 3;
  if (!m.list && width == 1) {
    for (const double x : {0.0, -1.0, nan, inf, -inf, 1e-30, 1e-6, 1e6, 1e30}) out.emplace_back(Number{x});
    return out;
  }
  std::vector<double> list(size_t(width), 0.0);
  if (const auto* n = usual.as<Numbers>(); n && !n->values.empty()) list = n->values;
  const auto add = [&](const std::vector<double>& values) {
    out.emplace_back(Numbers{values, m.list ? width : 1, Dimension::none});
  };
  if (m.list) {
    add({});
    add(std::vector<double>(list.begin(), list.begin() + width));
  }
  for (const double x : {0.0, nan, inf, 1e-30, 1e-6, 1e6, 1e30}) {
    add(std::vector<double>(list.size(), x));  // all numbers equal
    std::vector<double> one = list;            // and only the last one
    one.back() = x;
    add(one);
  }
  if (whole)
    for (const double x : {-1.0, 1e9}) {
      std::vector<double> one = list;
      one.back() = x;
      add(one);
    }
  return out;
}

/// Tests each class whose name begins with a letter in a range.
void try_classes(char from, char to) {
  const conform::Fixtures fixtures;
  const ClassInfo& objects = *Registry::instance().find("SceneObject");
  int errors = 0, accepted = 0;
  for (const ClassInfo* c : Registry::instance().subclasses(objects)) {
    if (!c->provider.empty() || c->name.rfind("Test", 0) == 0 || c->name[0] < from || c->name[0] > to) continue;
    std::mt19937_64 random(1);
    for (const Member& m : c->members) {
      if (m.name == "priority") continue;
      const conform::Drawn usual = conform::default_part(*c, fixtures, random);
      ASSERT_TRUE(usual.part) << c->name << ": " << usual.refused;
      // Smaller settings, because the test would take long otherwise.
      if (m.name == "edge_length" && c->find("levels")) set(*usual.part, "levels", Value(Number{2}));
      if (c->name == "SignedDistanceGrid" && m.name != "resolution" && m.name != "distances")
        set(*usual.part, "resolution", Value(Numbers{{9, 9, 9}, 1, Dimension::none}));
      int case_number = 0;
      for (const Value& v : numbers_like(m, get(*usual.part, m.name))) {
        const std::string what = c->name + "." + m.name + ", case " + std::to_string(case_number++);
        const Ref<SceneObject> object = ref_cast<SceneObject>(copy(*usual.part));
        try {
          set(*object, m.name, v);
          const Ref<Scene> around = ref_cast<Scene>(Registry::instance().create("BruteForceScene"));
          around->objects = {object};
          prepare_tree(*around);
          ++accepted;
        } catch (const Error& e) {
          ++errors;
          EXPECT_NE(std::string(e.what()).find(c->name), std::string::npos) << what << ": " << e.what();
          continue;
        }
        expect_sane(*object, what);
      }
    }
  }
  EXPECT_GT(errors, 100);
  EXPECT_GT(accepted, 100);
}

TEST(DegenerateObjects, FromAToHGiveAnErrorOrNumbers) { try_classes('A', 'H'); }
TEST(DegenerateObjects, FromIToRGiveAnErrorOrNumbers) { try_classes('I', 'R'); }
TEST(DegenerateObjects, FromSToZGiveAnErrorOrNumbers) { try_classes('S', 'Z'); }

// ---- lists that say nothing together ------------------------------------------------------------------------------------

/// The error that an object of this text gives, with its line; or "" if there is none and the object passes expect_sane().
std::string error_of(const std::string& text) {
  Ref<SceneObject> object;
  try {
    object = ref_cast<SceneObject>(parse_component(text, "object"));
    prepare_tree(*object);
  } catch (const Error& e) {
    EXPECT_TRUE(e.location.known()) << text << ": " << e.what();
    return std::to_string(e.location.line) + " " + e.what();
  } catch (const Errors& list) {
    EXPECT_TRUE(list.errors.front().location.known()) << text;
    return std::to_string(list.errors.front().location.line) + " " + list.errors.front().what();
  }
  expect_sane(*object, text);
  return {};
}

TEST(DegenerateObjects, WithoutAreaAreRefusedWhereTheyStand) {
  const std::string line = "[0, 0, 0], [1, 0, 0], [2, 0, 0]", spot = "[1, 1, 1], [1, 1, 1], [1, 1, 1]";
  for (const std::string& points : {line, spot})
    for (const std::string& text : std::vector<std::string>{
             "TriangleMesh {\n positions: [" + points + "] m,\n triangles: [0, 1, 2] }",
             "Polygon {\n points: [" + points + "] m }",
             "TriangleMesh {\n positions: [[0, 0, 0], [1, 0, 0], [0, 1, 0]] m,\n triangles: [0, 0, 1, 1, 1, 1] }",
             "SubdivisionSurface {\n positions: [" + points + "] m,\n face_sizes: [3], indices: [0, 1, 2], levels: 1 }"}) {
      const std::string error = error_of(text);
      EXPECT_EQ(error.substr(0, 2), "2 ") << text << ": " << error;
    }
  EXPECT_NE(error_of("Triangle {\n a: [0, 0, 0] m, b: [1, 1, 1] m, c: [2, 2, 2] m }"), "");
  EXPECT_NE(error_of("Rectangle {\n edge_u: [1, 1, 0] m,\n edge_v: [2, 2, 0] m }"), "");
  EXPECT_NE(error_of("Curve {\n points: [" + spot + "] m }"), "");
  EXPECT_NE(error_of("Curve {\n points: [" + spot + "] m, form: ribbon }"), "");
  EXPECT_NE(error_of("Sphere {\n transform: matrix(1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0) }"), "");
  EXPECT_NE(error_of("Metaballs {\n strengths: [-1] }"), "");
  EXPECT_NE(error_of("ImplicitSurface {\n formula: \"1 / 0\" }"), "");
}

TEST(DegenerateObjects, PartsThatMeanNothingAreLeftOut) {
  EXPECT_EQ(error_of("Metaballs { centres: [[0, 0, 0], [0, 0, 0], [0, 0, 0]] m }"), "");  // all in one place
  EXPECT_EQ(error_of("Curve { points: [[0, 0, 0], [0, 0, 0], [0, 0, 1], [0, 0, 1]] m }"), "");
  EXPECT_EQ(error_of("Curve { points: [[0, 0, 0], [0, 0, 1], [5, 5, 5], [5, 5, 5]] m, counts: [2, 2] }"), "");
  EXPECT_EQ(
      error_of("TriangleMesh { positions: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [3, 0, 0]] m, triangles: [0, 1, 2, 0, 1, 3] }"),
      "");
  EXPECT_EQ(error_of("Polygon { points: [[0, 0, 0], [1, 0, 0], [1, 0, 0], [1, 1, 0], [0.5, 0.5, 0]] m }"), "");
}

// Of two triangles that open and close, each is flat at one key; two more are flat at both keys and are left out. Half way, all
// vertices have moved half of their way.
TEST(DegenerateObjects, TrianglesFlatAtOneKeyAreThereAtOthers) {
  const auto mesh = ref_cast<SceneObject>(parse_component(R"(TriangleMesh {
    positions: [[0, 0, 0], [1, 0, 0], [0.5, 0, 0],  [2, 0, 0], [3, 0, 0], [2, 1, 0],  [5, 0, 0], [6, 0, 0], [7, 0, 0]] m,
    triangles: [[0, 1, 2], [3, 4, 5], [6, 7, 8], [8, 7, 6]], times: [0, 1],
    motion_positions: [[0, 0, 0], [1, 0, 0], [0, 1, 0],  [2, 0, 0], [3, 0, 0], [2.5, 0, 0],  [5, 0, 0], [6, 0, 0], [7, 0, 0]] m
    })",
                                                          "mesh"));
  testing::internal::CaptureStderr();
  prepare_tree(*mesh);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("left out 2 triangles without area"), std::string::npos);
  const auto hits = [&](float x, float time) {
    Hit hit;
    return mesh->intersect(ray({x, 0.1f, 1}, {0, 0, -1}, time), hit);
  };
  EXPECT_FALSE(hits(0.3f, 0));
  EXPECT_TRUE(hits(0.3f, 0.5f));
  EXPECT_TRUE(hits(0.3f, 1));
  EXPECT_TRUE(hits(2.3f, 0));
  EXPECT_TRUE(hits(2.3f, 0.5f));
  EXPECT_FALSE(hits(2.3f, 1));
  for (const float time : {0.0f, 0.25f, 1.0f}) {
    EXPECT_NEAR(mesh->area(time), 0.5f, 1e-6f);
    Random random(1);
    Mean area;
    for (int i = 0; i < 4000; ++i) {
      const SurfaceSample s = mesh->sample_area(random.pair(), time);
      ASSERT_TRUE(s.pdf >= 0 && s.pdf < infinity);
      ASSERT_TRUE(s.pdf == 0 || (is_finite(s.point.position) && is_finite(Vector3(s.point.normal))));
      area.add(s.pdf > 0 ? 1 / double(s.pdf) : 0);
    }
    EXPECT_NEAR(area.value(), 0.5, 5 * area.error() + 1e-6);
  }
}

}  // namespace
}  // namespace etendue
