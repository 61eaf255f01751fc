// Far from the origin, and at any scale, a picture is the same as at the origin: rendering uses a space relative to a point
// near the camera (docs/decisions/020-rendering-space.md). Closed objects are dark inside, with every renderer.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "etendue/language/language.h"
#include "geometry/rendering_space.h"
#include "support/geometry_support.h"
#include "support/render_support.h"

namespace etendue {
namespace {

const char* const structures[] = {"EmbreeScene", "BvhScene", "OctreeScene", "GridScene", "BruteForceScene"};

/// A place in the world, and the scale of the objects there.
struct Where {
  double x, y, z, scale = 1;
  std::string at(double dx, double dy, double dz) const {
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x + scale * dx, y + scale * dy, z + scale * dz);
  }
  std::string placed() const { return fmt::format("translate({}) * scale({:.17g})", at(0, 0, 0), scale); }
  std::string size(double of) const { return fmt::format("{:.17g}", scale * of); }
};

/// A place at this distance in a direction along no axis.
Where away(double distance, double scale = 1) { return {0.3713 * distance, 0.5571 * distance, -0.7428 * distance, scale}; }

std::string job_at(const Where& w, const std::string& renderer, const std::string& structure, const std::string& objects,
                   int size = 16) {
  return fmt::format(
      "Job {{ renderer: {}\n camera: PerspectiveCamera {{ from: {} m, to: {} m, up: [0, 0, 1], fov: 70 deg }}\n"
      " image: ImageBuffer {{ width: {}, height: {}, filter: BoxFilter {{}} }}\n scene: {} {{ objects: [ {} ] }} }}",
      renderer, w.at(0.31, -1.2, 0.23), w.at(0, 0.7, -0.11), size, size, structure, objects);
}

Image render(const std::string& text) { return test::rendered(load_job_text(text, "far_away.etd"))->picture(); }

double brightest(const Image& image) {
  double most = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) most = std::max(most, double(image.at(x, y, 1)));
  return most;
}

/// The sum of absolute differences of two pictures, relative to the light of the second.
double difference(const Image& a, const Image& b) {
  double off = 0, all = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      off += std::abs(double(a.at(x, y, 1)) - double(b.at(x, y, 1)));
      all += double(b.at(x, y, 1));
    }
  return off / all;
}

// ---- closed rooms ---------------------------------------------------------------------------------------------------------

const std::string matte = "shader: Lambertian { color: 0.5 }";

/// Closed bodies around the camera, placed by their own members or by a transform.
std::vector<std::pair<std::string, std::string>> rooms(const Where& w) {
  std::string corners;
  for (int z = -2; z <= 2; z += 4)
    for (const auto& [x, y] : {std::pair{-2, -2}, {2, -2}, {2, 2}, {-2, 2}})
      corners += (corners.empty() ? "" : ", ") + w.at(x, y, z);
  const std::string cube =
      "[[-2, -2, -2], [2, -2, -2], [2, 2, -2], [-2, 2, -2], [-2, -2, 2], [2, -2, 2], [2, 2, 2], [-2, 2, 2]] m";
  const std::string triangles =
      "triangles: [[0, 3, 2], [0, 2, 1], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, "
      "6], "
      "[3, 0, 4], [3, 4, 7]]";
  const std::string s = w.size(4);
  return {{"box", fmt::format("Box {{ centre: {} m, size: [{}, {}, {}] m, {} }}", w.at(0, 0, 0), s, s, s, matte)},
          {"turned box",
           fmt::format("Box {{ size: [4, 4, 4] m, transform: {} * rotate(33 deg, [1, 2, 3]), {} }}", w.placed(), matte)},
          {"sphere", fmt::format("Sphere {{ centre: {} m, radius: {} m, {} }}", w.at(0, 0, 0), w.size(3), matte)},
          {"mesh", fmt::format("TriangleMesh {{ positions: [{}] m, {}, {} }}", corners, triangles, matte)},
          {"placed mesh",
           fmt::format("TriangleMesh {{ positions: {}, {}, transform: {}, {} }}", cube, triangles, w.placed(), matte)},
          {"cage",
           fmt::format("SubdivisionSurface {{ levels: 3, positions: [{}] m, indices: [0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, "
                       "2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7], {} }}",
                       corners, matte)},
          {"solid", fmt::format("Difference {{ operands: [ Box {{ centre: {} m, size: [{}, {}, {}] m }}, Box {{ centre: {} m, "
                                "size: [{}, {}, {}] m }} ], {} }}",
                                w.at(0, 0, 0), w.size(5), w.size(5), w.size(5), w.at(0, 0, 0), s, s, s, matte)}};
}

const std::string sky = "Environment { emission: DiffuseEmission { radiance: 1 } }";

void expect_dark(const Where& w, const std::string& renderer, const std::string& structure, const std::string& name,
                 const std::string& room) {
  const double leaked = brightest(render(job_at(w, renderer, structure, room + "\n" + sky)));
  EXPECT_EQ(leaked, 0) << name << " in " << structure << " at " << w.x << ", scale " << w.scale << ": " << renderer;
}

std::string with_samples(const std::string& name, long samples) {
  return fmt::format("{} {{ samples: {}, max_depth: 8 }}", name, samples);
}

long samples_asked(long usual) {
  const char* asked = std::getenv("LEAK_RAYS");
  return asked ? std::max(1L, std::atol(asked) / (16 * 16 * 8)) : usual;
}

TEST(FarAway, ClosedRoomsAreDark) {
  for (const Where& w :
       {away(0), away(100), away(1000), away(1e7), away(0, 1e-6), away(1e3, 1e-6), away(0, 1e7), away(1e7, 1e5)})
    for (const auto& [name, room] : rooms(w))
      for (const char* renderer : {"PathTracer", "BidirectionalPathTracer"})
        expect_dark(w, with_samples(renderer, samples_asked(8)), "BvhScene", name, room);
}

TEST(FarAway, ClosedRoomsAreDarkInAllStructures) {
  for (const Where& w : {away(100), away(1e7)})
    for (const auto& [name, room] : rooms(w))
      for (const std::string structure : structures) {
        // In BruteForceScene one of a million connections slips through an edge of a curved mesh, near the origin too.
        if (structure == "BruteForceScene" && name == "cage") continue;
        expect_dark(w, with_samples("BidirectionalPathTracer", samples_asked(4)), structure, name, room);
      }
}

TEST(FarAway, ClosedRoomsAreDarkForAllRenderers) {
  const Where w = away(1e7);
  const std::string room = rooms(w).front().second;
  const std::string n = std::to_string(samples_asked(64));
  for (const std::string& renderer :
       {"PathTracer { samples: " + n + " }", "BidirectionalPathTracer { samples: " + n + " }",
        "LightTracer { samples: " + n + " }", "DirectRenderer { samples: " + n + " }", "WhittedRenderer { samples: " + n + " }",
        "DistributionRenderer { samples: " + std::to_string(samples_asked(2)) + " }"})
    expect_dark(w, renderer, "EmbreeScene", "box", room);
}

// ---- pictures ---------------------------------------------------------------------------------------------------------------

/// A room with a lamp, a glass ball, a textured floor and a mesh, all placed by their own members.
std::string furnished(const Where& w) {
  const std::string s = w.size(4);
  return fmt::format(
      "Box {{ centre: {} m, size: [{}, {}, {}] m, shader: Lambertian {{ color: 0.6 }} }}\n"
      "Sphere {{ centre: {} m, radius: {} m, emission: DiffuseEmission {{ radiance: 10 }} }}\n"
      "Sphere {{ centre: {} m, radius: {} m, shader: Dielectric {{}} }}\n"
      "Ellipsoid {{ centre: {} m, radii: [{}, {}, {}] m, shader: Lambertian {{ color: 0.3 }} }}\n"
      "Cylinder {{ transform: {}, radius: 0.3, height: 0.7, shader: Conductor {{}} }}\n"
      "Rectangle {{ corner: {} m, edge_u: [{}, 0, 0] m, edge_v: [0, {}, 0] m, shader: Lambertian {{ color: CheckerMap {{ "
      "repeat: "
      "[4, 4, 4] }} }} }}\n",
      w.at(0, 0, 0), s, s, s, w.at(0.4, 0.5, 1.4), w.size(0.3), w.at(-0.7, 1, -0.6), w.size(0.5), w.at(0.9, 1.2, -1),
      w.size(0.5), w.size(0.4), w.size(0.3), w.placed() + " * translate(0.2, 0.4, -1.8)", w.at(-1.9, -1.9, -1.9), w.size(3.8),
      w.size(3.8));
}

const Where all_places[] = {away(1e2),     away(1e3),     away(1e4),    away(1e5),    away(1e6),       away(1e7),
                            away(0, 1e-6), away(0, 1e-3), away(0, 1e3), away(0, 1e7), away(1e3, 1e-6), away(1e7, 1e3)};

TEST(FarAway, PicturesAreThoseAtTheOrigin) {
  const std::string renderer = "PathTracer { samples: 32, max_depth: 6 }";
  const Image here = render(job_at(away(0), renderer, "EmbreeScene", furnished(away(0))));
  for (const Where& w : all_places)
    EXPECT_LT(difference(render(job_at(w, renderer, "EmbreeScene", furnished(w))), here), 0.02) << w.x << ", scale " << w.scale;
}

TEST(FarAway, PicturesAreThoseAtTheOriginForAllRenderers) {
  for (const char* renderer :
       {"BidirectionalPathTracer { samples: 16, max_depth: 5 }", "LightTracer { samples: 64, max_depth: 5 }",
        "DirectRenderer { samples: 16 }", "WhittedRenderer { samples: 4 }", "DistributionRenderer { samples: 2 }",
        "AmbientOcclusionRenderer { samples: 16, distance: SIZE }", "FeatureRenderer { samples: 4, feature: position }"}) {
    const auto picture = [&](const Where& w) {
      std::string text = job_at(w, renderer, "BvhScene", furnished(w));
      if (const size_t at = text.find("SIZE"); at != std::string::npos) text.replace(at, 4, w.size(1));
      return render(text);
    };
    const Image here = picture(away(0));
    for (const Where& w : {away(1e7), away(1e3, 1e-6), away(0, 1e6)})
      EXPECT_LT(difference(picture(w), here), 0.02) << w.x << " " << w.scale << renderer;
  }
}

// ---- scenes in scenes -------------------------------------------------------------------------------------------------------

// Objects modelled far from their own origin and moved back, once and twice, and through two scenes.
TEST(FarAway, NestedScenesBringBackWhatIsFarFromTheirOwnOrigin) {
  const std::string renderer = "PathTracer { samples: 32, max_depth: 6 }";
  const std::string lamp = "Sphere { centre: [0.4, 0.5, 1.4] m, radius: 0.3 m, emission: DiffuseEmission { radiance: 10 } }\n";
  const auto ball = [&](const Where& w, double x) {
    return fmt::format(
        "Box {{ centre: {} m, size: [0.5, 0.5, 0.5] m, {} }}, Sphere {{ centre: {} m, radius: 0.3 m, {} }}, TriangleMesh {{ "
        "positions: "
        "[{}, {}, {}] m, triangles: [[0, 1, 2]], {} }}",
        w.at(x, 1, 0), matte, w.at(x, 0.8, 0.5), matte, w.at(x, 1, 0.4), w.at(x + 0.5, 1, 0.4), w.at(x, 1, 0.9), matte);
  };
  const Where far = away(1e7), home = away(0);
  const std::string back = fmt::format("translate({})", Where{-far.x, -far.y, -far.z}.at(0, 0, 0));
  const auto picture = [&](const std::string& objects) {
    return render(job_at(home, renderer, "EmbreeScene", lamp + objects + ",\nBox { size: [4, 4, 4] m, " + matte + " }"));
  };
  const Image once = picture(ball(home, -0.5)), twice = picture(ball(home, -0.5) + ", " + ball(home, 0.5));
  const std::string inner = "EmbreeScene { objects: [ " + ball(far, -0.5) + " ] }";
  EXPECT_LT(difference(picture("Instance { scene: " + inner + ", transform: " + back + " }"), once), 0.02);
  EXPECT_LT(difference(picture("BvhScene { objects: [ Instance { scene: " + inner +
                               ", transform: translate(0, 5, 0) } ], transform: " + back + " * translate(0, -5, 0) }"),
                       once),
            0.02);
  const std::string shared = "inner = " + inner + "\n";
  const std::string both = "Instance { scene: inner, transform: " + back + " }, Instance { scene: inner, transform: " + back +
                           " * translate(1, 0, 0) }";
  EXPECT_LT(difference(render(shared + job_at(home, renderer, "EmbreeScene",
                                              lamp + both + ",\nBox { size: [4, 4, 4] m, " + matte + " }")),
                       twice),
            0.02);
}

// An object in two scenes is relative to the same point in both.
TEST(FarAway, ScenesShareObjects) {
  const auto picture = [](double distance) {
    const Where w = away(distance);
    const std::string shared = fmt::format("ball = Sphere {{ centre: {} m, radius: 0.4 m, {} }}\n", w.at(-0.6, 0.8, 0), matte);
    return render(
        shared +
        job_at(w, "PathTracer { samples: 32, max_depth: 4 }", "BvhScene",
               "ball, Instance { transform: translate(1.2, 0, 0), scene: EmbreeScene { objects: [ ball ] } },\n" + sky));
  };
  EXPECT_LT(difference(picture(1e4), picture(0)), 0.02);
}

// ---- what speaks of the world -----------------------------------------------------------------------------------------------

TEST(FarAway, MapsSeeTheWorldsCoordinates) {
  const auto picture = [](const Where& w) {
    const std::string wall = fmt::format(
        "Rectangle {{ corner: {} m, edge_u: [4, 0, 0] m, edge_v: [0, 0, 4] m, emission: DiffuseEmission {{ radiance: "
        "PositionMap {{ low: "
        "{} m, high: {} m, space: world }} }} }}",
        w.at(-2, 1.5, -2), w.at(-2, 1, -2), w.at(2, 2, 2));
    return render(job_at(w, "PathTracer { samples: 16 }", "BvhScene", wall));
  };
  const Image here = picture(away(0));
  EXPECT_GT(brightest(here), 0.1);
  for (const double distance : {1e3, 1e7}) EXPECT_LT(difference(picture(away(distance)), here), 0.01) << distance;
}

TEST(FarAway, ReplayTellsTheWorldsCoordinates) {
  const Where w = away(1e7);
  const Render render(
      load_job_text(job_at(w, "PathTracer { samples: 1 }", "BvhScene", rooms(w).front().second), "far_away.etd"));
  PathRecord record;
  render.replay(8, 8, 0, record);
  ASSERT_GT(record.vertices.size(), 1u);
  for (const PathRecord::Vertex& v : record.vertices) {
    EXPECT_LT(std::abs(v.position.x - w.x), 2.001) << v.kind;
    EXPECT_LT(std::abs(v.position.z - w.z), 2.001) << v.kind;
  }
}

// ---- descriptions -----------------------------------------------------------------------------------------------------------

TEST(FarAway, DescriptionsKeepTheirDoubles) {
  const std::string text =
      "Job { camera: PerspectiveCamera { from: [10000000.123, 0.1, -0.3] m, to: [1e7, 5, 0.7] m }\n"
      "scene: BvhScene { objects: [ Sphere { centre: [12345678.901234, 0.1, 1] m, transform: translate(20000000.3, 0.2, 0.1) "
      "}\n"
      "TriangleMesh { positions: [[1e7, 0, 0], [10000000.001, 0, 0], [1e7, 0.001, 0]] m, triangles: [[0, 1, 2]] }\n"
      "Box { transform: keyframes(0 s, translate(10000000.7, 0, 0), 1 s, translate(10000001.9, 0, 0)) } ] } }";
  const Ref<Job> job = load_job_text(text, "far_away.etd");
  prepare_tree(*job);  // must not change the numbers as written
  const std::string written = write_description(*job, false, "");
  for (const char* number : {"10000000.123", "12345678.901234", "20000000.3", "10000000.001", "10000000.7", "10000001.9"})
    EXPECT_NE(written.find(number), std::string::npos) << number << " in\n" << written;
  const Ref<Job> again = load_job_text(written, "far_away.etd");
  EXPECT_EQ(write_description(*again, false, ""), written);
}

/// A pyramid of a millimetre as a mesh file.
std::string pyramid_file(const std::string& name, const std::string& type, const Where& w) {
  const std::string path = testing::TempDir() + name;
  const bool obj = name.ends_with("obj");
  std::ofstream file(path);
  if (!obj)
    file << "ply\nformat ascii 1.0\nelement vertex 4\nproperty " << type << " x\nproperty " << type << " y\nproperty " << type
         << " z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& [x, y, z] : {std::tuple{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
    file << fmt::format("{}{:.17g} {:.17g} {:.17g}\n", obj ? "v " : "", w.x + 1e-3 * x, w.y + 1e-3 * y, w.z + 1e-3 * z);
  for (const auto& [a, b, c] : {std::tuple{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
    file << (obj ? fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1) : fmt::format("3 {} {} {}\n", a, b, c));
  return path;
}

TEST(FarAway, FilesOfMeshesKeepTheirDoubles) {
  const auto picture = [](const Where& w, const std::string& file) {
    Where near = w;
    near.scale = 1e-3;
    return render(job_at(near, "PathTracer { samples: 16 }", "EmbreeScene",
                         "TriangleMesh { file: \"" + file + "\", " + matte + " },\n" + sky));
  };
  const Image here = picture(away(0), pyramid_file("here.ply", "float", away(0)));
  EXPECT_LT(difference(picture(away(1e7), pyramid_file("far.ply", "double", away(1e7))), here), 0.01);
  EXPECT_LT(difference(picture(away(1e7), pyramid_file("far.obj", "", away(1e7))), here), 0.01);
}

// Floats in a file cannot represent the pyramid there, and a warning must say so.
TEST(FarAway, SpoiltMeshesAreTold) {
  const Where w{1000, 0, 0};
  const std::string file = pyramid_file("spoilt.ply", "float", w);
  const Ref<Job> job = load_job_text(
      job_at(w, "PathTracer { samples: 1 }", "EmbreeScene", "TriangleMesh { file: \"" + file + "\" }"), "far_away.etd");
  testing::internal::CaptureStderr();
  prepare_tree(*job);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("far_away.etd:4:"), std::string::npos) << said;
  EXPECT_NE(said.find("their shape is spoilt"), std::string::npos) << said;
}

// Two jobs render the same objects one after the other, each from its own place.
TEST(FarAway, JobsShareObjects) {
  const Where a = away(1e6), b = away(1e6 + 3);
  const std::string renderer = "PathTracer { samples: 16, max_depth: 4 }";
  const Ref<Job> first = load_job_text(job_at(a, renderer, "BvhScene", furnished(a)), "far_away.etd");
  const Ref<Job> second = load_job_text(job_at(b, renderer, "BvhScene", furnished(b)), "far_away.etd");
  const Image before = test::rendered(first)->picture();
  second->scene->objects = first->scene->objects;
  test::rendered(second);
  prepare_tree(*first);
  EXPECT_EQ(difference(test::rendered(first)->picture(), before), 0);
}

}  // namespace
}  // namespace etendue
