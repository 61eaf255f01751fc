// Hostile input: the program terminates in bounded time and memory and reports what is wrong.

#include <bit>
#include <cstring>
#include <ctime>
#include <fstream>

#include "etendue/render/job.h"
#include "etendue/transport/boundaries.h"
#include "images/numpy_array.h"
#include "support/geometry_support.h"
#include "support/render_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

// ---- arrays ---------------------------------------------------------------------------------------------------------------

std::string numpy(const std::string& shape, size_t numbers, const std::string& type = "<f4") {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  header.resize(118, ' ');
  std::string bytes = std::string("\x93NUMPY\x01\x00", 8) + char(118) + char(0) + header;
  for (size_t i = 0; i < numbers; ++i) {
    const float f = float(i) - 3.5f;
    bytes.append(reinterpret_cast<const char*>(&f), 4);
  }
  return bytes;
}

std::string refusal(const std::string& bytes) {
  try {
    parse_numpy_header(bytes);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(Robustness, ArraysThatClaimMoreThanTheyHoldAreRefusedBeforeMemoryIsAskedFor) {
  EXPECT_EQ(refusal(numpy("2, 2, 2", 8)), "");
  EXPECT_EQ(refusal(numpy("2, 2, 3", 8)), "it ends too early");
  EXPECT_EQ(refusal(numpy("2, 2, 2", 9)), "it is longer than its shape says");
  EXPECT_EQ(refusal(numpy("2, 0, 2", 0)), "its shape is empty");
  const std::string large = "its shape is too large: at most 2^30 numbers are read";
  EXPECT_EQ(refusal(numpy("1024, 1024, 1025", 8)), large);
  EXPECT_EQ(refusal(numpy("1048576, 1048576, 1048576", 8)), large);  // 2^60
  EXPECT_EQ(refusal(numpy("4294967296, 4294967296", 0)), large);     // 2^64: 0 of 64 bits
  EXPECT_EQ(refusal(numpy("9223372036854775809, 2, 1", 2)), large);  // 2^64 + 2: 2 of 64 bits
  EXPECT_EQ(refusal(numpy("2, 2, 2, 2, 2, 2, 2, 2, 2, 2", 8)), "it ends too early");
}

TEST(Robustness, GridsFromFilesHaveTheirShapeAndSayWhatIsWrongWithIt) {
  const std::string path = testing::TempDir() + "grid.npy";
  const auto made = [&](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    return parse_component("SignedDistanceGrid {\n file: \"" + path + "\" }", "grid");
  };
  const auto error = [&](const std::string& bytes) {
    const Ref<Component> grid = made(bytes);
    try {
      prepare_tree(*grid);
    } catch (const Error& e) {
      return std::to_string(e.location.line) + " " + e.what();
    }
    return std::string();
  };
  EXPECT_EQ(error(numpy("2, 2, 2", 8)), "");  // z = 0 lies half way between -3.5 + 4 and -3.5 + 3, about
  EXPECT_NE(error(numpy("2, 2, 1", 4)).find("with at least 2 numbers along each"), std::string::npos);
  EXPECT_NE(error(numpy("2, 4", 8)).find("with at least 2 numbers along each"), std::string::npos);
  const std::string far = error(numpy("1048576, 1048576, 1048576", 8));
  EXPECT_EQ(far.substr(0, 2), "2 ") << far;
  EXPECT_NE(far.find("grid.npy': its shape is too large"), std::string::npos) << far;
}

// ---- formulas ---------------------------------------------------------------------------------------------------------------

// Bounds of a product do not take into account that its factors are equal, until intervals are as short as the waves; and the
// formula is 0 only on a small ball: a ray would need a million steps.
TEST(Robustness, FormulasThatTellNothingAreGivenUpWithAWarning) {
  const Ref<SceneObject> wild = ref_cast<SceneObject>(parse_component(
      "\nImplicitSurface {\n formula: \"min(x*x + y*y + z*z - 0.04, sin(1e6*x*y + z) * sin(1e6*x*y + z) + 1e-6)\","
      " tolerance: 1e-12 }",
      "wild"));
  testing::internal::CaptureStderr();
  prepare_tree(*wild);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find(":3:"), std::string::npos) << said;
  EXPECT_NE(said.find("take more than 16384 steps"), std::string::npos) << said;
  Random random(1);
  const std::clock_t begin = std::clock();  // of the processor: other programs may run
  for (int i = 0; i < 20; ++i) {
    Hit hit;
    const Vector3 d = random.direction();
    const bool met = wild->intersect(ray(Point3{} - 3 * d, d), hit);
    EXPECT_TRUE(!met || (hit.distance > 0 && hit.distance < 6));
  }
  EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 5);  // 20 times 16384 steps
}

// ---- boundaries -----------------------------------------------------------------------------------------------------------

/// A closed object that every ray hits at once, wherever it begins.
class TestTrap final : public SceneObject {
 public:
  static void describe(Description<TestTrap>& d) { d.summary("Holds rays in place."); }
  Bounds3 bounds() const override { return {{-1, -1, -1}, {1, 1, 1}}; }
  bool intersect(const Ray& r, Hit& hit) const override {
    hit = {};
    hit.distance = 1e-6f * r.maximum < 1e-6f ? 1e-6f * r.maximum : 1e-6f;
    hit.object = this;
    return true;
  }
  void surface_point(const Ray& r, const Hit&, SurfacePoint& p) const override {
    p = {};
    p.position = p.object_position = r.origin;
    p.normal = p.shading_normal = p.object_normal = Normal3(-r.direction);
    p.object = this;
    p.time = r.time;
  }
  void tangents(SurfacePoint& p) const override {
    const Frame frame(p.normal);
    p.dpdu = frame.s;
    p.dpdv = frame.t;
  }
  float area(float) const override { return 24; }
  SurfaceSample sample_area(Point2, float) const override { return {}; }
  bool closed() const override { return true; }
};

/// Registered only where requested, so that tests that draw random objects do not get one.
void register_trap() { static const Register<TestTrap> registered; }

TEST(Robustness, PathsThatAreHeldInPlaceEnd) {
  register_trap();
  for (const char* renderer :
       {"PathTracer", "BidirectionalPathTracer", "LightTracer", "DistributionRenderer", "WhittedRenderer", "DirectRenderer"}) {
    SCOPED_TRACE(renderer);
    const Ref<Job> job = load_job_text(
        test::job_text(std::string(renderer) + " { samples: 2 }", "PerspectiveCamera { from: [0, 0, 0.5] m, to: [0, 0, 0] m }",
                       2, "Point { position: [0, 0.5, 0.5] m, emission: DiffuseEmission { radiance: 1 } }"),
        "test.etd");
    const Ref<TestTrap> trap = make<TestTrap>();
    trap->shader = ref_cast<Shader>(Registry::instance().create("PassThrough"));
    job->scene->objects.push_back(trap);
    const test::Measured m = test::measure(job);
    EXPECT_EQ(m.bad, 0u);
    EXPECT_EQ(m.mean.y, 0);
  }
}

// A solid intersects its operands for one crossing after the other, and estimates its area by rays through it: both must
// terminate.
TEST(Robustness, SolidsOfWhatHoldsRaysInPlaceComeToAnEnd) {
  register_trap();
  const Ref<SceneObject> solid =
      ref_cast<SceneObject>(parse_component("Union { operands: [ TestTrap {}, Sphere { centre: [3, 0, 0] m } ] }", "test"));
  const std::clock_t begin = std::clock();  // of the processor: other programs may run
  prepare_tree(*solid);
  HitList list;
  solid->all_hits(ray({0, 0, -5}, {0, 0, 1}), list);
  EXPECT_LE(list.size, HitList::capacity);
  EXPECT_GE(solid->area(0), 0);
  EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 180);
}

// Fewer consecutive null surfaces than the limit do not reduce the light.
TEST(Robustness, ManySheetsInARowLetAllLightThrough) {
  std::string objects =
      "Rectangle { corner: [-9, -9, -1] m, edge_u: [18, 0, 0] m, edge_v: [0, 18, 0] m, emission: "
      "DiffuseEmission { radiance: 1 } }\n";
  for (int i = 0; i < 400; ++i)
    objects += "Rectangle { corner: [-9, -9, " + std::to_string(0.01 * i) +
               "] m, edge_u: [18, 0, 0] m, edge_v: [0, 18, 0] m, shader: PassThrough {} }\n";
  for (const char* renderer : {"PathTracer", "WhittedRenderer", "DirectRenderer"}) {
    const auto bright = [&](const std::string& list) {
      return test::measure(test::job_text(std::string(renderer) + " { samples: 4 }",
                                          "PerspectiveCamera { from: [0, 0, 5] m, to: [0, 0, 0] m, up: [0, 1, 0] }", 2, list))
          .mean.y;
    };
    const double alone = bright(objects.substr(0, objects.find('\n')));
    EXPECT_GT(alone, 0);
    EXPECT_NEAR(bright(objects), alone, 1e-5 * alone) << renderer;
  }
}

// ---- keys -------------------------------------------------------------------------------------------------------------------

TEST(Robustness, TurnsThatGoTheShorterWayAreWarnedOf) {
  const auto said = [](const std::string& keys) {
    testing::internal::CaptureStderr();
    parse_component("Sphere {\n transform: keyframes(" + keys + ") }", "ball");
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(said("0, rotate(0, \"z\"), 1, rotate(180, \"z\"), 2, rotate(360 deg, \"z\")"), "");
  EXPECT_EQ(said("0, rotate(-90, \"z\"), 1, rotate(170, \"x\")"), "");
  EXPECT_EQ(said("0, translate(0, 0, 0), 1, rotate(270, \"z\")"), "");  // a translation does not determine a previous rotation
  EXPECT_NE(said("0, rotate(0, \"z\"), 1, translate(1, 0, 0) * rotate(270 deg, [0, 0, 2])").find("2:"), std::string::npos);
  EXPECT_NE(said("0, rotate(0, \"z\"), 1, rotate(360, \"z\")").find("the shorter way, 0 degrees"), std::string::npos);
  EXPECT_NE(said("0, rotate(100, \"y\"), 1, rotate(100, [0, -1, 0])").find("rotation of -200"), std::string::npos);
}

}  // namespace
}  // namespace etendue
