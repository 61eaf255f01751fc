// Paths that would continue for hours take no more memory than short ones, and end at once when the render is aborted.

#include <gtest/gtest.h>

#include <chrono>
#include <future>

#include "support/process.h"
#include "support/render_support.h"

namespace etendue {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// The resident memory of this process [bytes].
double resident() {
  std::ifstream file("/proc/self/statm");
  double all = 0, resident = 0;
  file >> all >> resident;
  return resident * double(sysconf(_SC_PAGESIZE));
}

const char* const white_box =
    "Sphere { radius: 10 m, shader: Lambertian { color: 1 } }\n"
    "Environment { emission: DiffuseEmission { radiance: 1 } }";

/// Fog that scatters light without end and without loss.
const char* const white_fog =
    "Sphere { radius: 1e6 m, shader: PassThrough {}, interior: HomogeneousVolume { absorption: 0, scattering: 5 } }\n"
    "Environment { emission: DiffuseEmission { radiance: 1 } }";

/// Two hundred half-transparent sheets between white walls.
std::string sheets(const std::string& walls) {
  std::string text = walls + "\n";
  for (int i = 0; i < 200; ++i)
    text += "Rectangle { corner: [-5, -5, " + std::to_string(-2 + 0.02 * i) +
            "] m, edge_u: [10, 0, 0] m, edge_v: [0, 10, 0] m, shader: MaskShader { shader: Lambertian { color: 1 }, opacity: "
            "0.5 } }\n";
  return text;
}

/// Glass within glass within mirrors: each ray splits in two, up to the longest path.
const char* const glass =
    "Sphere { radius: 10 m, shader: PerfectSpecular { color: 1 } }\n"
    "Sphere { radius: 1 m, shader: Dielectric { ior: 1.5 } }\n"
    "Sphere { centre: [2, 0, 0] m, radius: 1 m, shader: Dielectric { ior: 1.5 } }\n"
    "Point { transform: translate(0, 5 m, 0), emission: DiffuseEmission { radiance: 1 } }";

struct Endless {
  const char* name;
  std::string renderer, objects;
};

std::vector<Endless> endless() {
  return {
      {"white walls", "PathTracer { samples: 1, max_depth: 1000000000 }", white_box},
      {"white walls, no luminaires sampled", "PathTracer { samples: 1, max_depth: 1000000000, next_event: false }", white_box},
      {"fog", "PathTracer { samples: 1, max_depth: 1000000000 }", white_fog},
      {"sheets", "PathTracer { samples: 1, max_depth: 1000000000 }", sheets(white_box)},
      {"subsurface", "PathTracer { samples: 1000000, max_depth: 1000000000 }",
       "Sphere { radius: 10 m, shader: Lambertian { color: 1 } }\n"
       "Sphere { radius: 1 m, shader: Subsurface { color: 0.9, mean_free_path: 0.1 m } }\n"
       "Environment { emission: DiffuseEmission { radiance: 1 } }"},
      {"walks from both ends", "BidirectionalPathTracer { samples: 1, max_depth: 20000 }",
       "Sphere { radius: 10 m, shader: Lambertian { color: 1 } }\n"
       "Sphere { radius: 1 m, centre: [5, 0, 0] m, emission: DiffuseEmission { radiance: 1 }, shader: Lambertian { color: 1 } "
       "}"},
      {"walks from both ends through sheets", "BidirectionalPathTracer { samples: 1, max_depth: 20000 }",
       sheets("Sphere { radius: 10 m, shader: Lambertian { color: 1 } }\n"
              "Sphere { radius: 1 m, centre: [7, 0, 0] m, emission: DiffuseEmission { radiance: 1 } }\n")},
      {"walks from luminaires", "LightTracer { samples: 1000000, max_depth: 20000 }",
       "Sphere { radius: 10 m, shader: Lambertian { color: 1 } }\n"
       "Sphere { radius: 1 m, centre: [5, 0, 0] m, emission: DiffuseEmission { radiance: 1 }, shader: Lambertian { color: 1 } "
       "}"},
      {"a tree of glass", "WhittedRenderer { samples: 1, max_depth: 64 }", glass},
      {"a tree of rays",
       "DistributionRenderer { samples: 1, split_depth: 16, max_depth: 1000000000, diffuse_samples: 65536, light_samples: "
       "65536 }",
       white_box},
      {"a tree of rays through sheets",
       "DistributionRenderer { samples: 1, split_depth: 16, max_depth: 1000000000, diffuse_samples: 65536 }",
       sheets(white_box)},
      {"many shadow rays", "DirectRenderer { samples: 1000, light_samples: 65536, shader_samples: 65536 }", sheets(white_box)},
      {"many rays", "AmbientOcclusionRenderer { samples: 1000000, rays: 65536 }", sheets(white_box)},
  };
}

TEST(BoundedPaths, take_no_more_memory_and_end_when_aborted) {
  for (const Endless& e : endless()) {
    const Ref<Job> job = load_job_text(
        test::job_text(e.renderer, "PerspectiveCamera { from: [0, 0, 5] m, to: [0, 0, 0] m }", 8, e.objects), e.name);
    Render render(job, {.threads = 2});
    std::future<Ended> ended = std::async(std::launch::async, [&] { return render.run(); });
    ASSERT_EQ(ended.wait_for(std::chrono::milliseconds(400)), std::future_status::timeout) << e.name << " ended by itself";
    const double before = resident();
    ASSERT_EQ(ended.wait_for(std::chrono::milliseconds(600)), std::future_status::timeout) << e.name << " ended by itself";
    const double grown = resident() - before;
    const double asked = now();
    render.abort();
    // On a machine with other work the threads may have to wait for their turn; without the abort a path takes hours.
    ASSERT_EQ(ended.wait_for(std::chrono::seconds(30)), std::future_status::ready) << e.name;
    EXPECT_LT(now() - asked, 2) << e.name;
    EXPECT_EQ(ended.get(), Ended::aborted) << e.name;
    // Stored subpaths reach their full length once; nothing else grows. It was 0.3 GB in a second.
    EXPECT_LT(grown, 60e6) << e.name;
  }
}

TEST(BoundedPaths, a_second_interruption_ends_the_program) {
  TemporaryFolder folder;
  const std::string scene =
      folder.write("box.etd", test::job_text("PathTracer { samples: 1, max_depth: 1000000000 }",
                                             "PerspectiveCamera { from: [0, 0, 5] m, to: [0, 0, 0] m }", 8, white_box));
  Process process(ETENDUE_BINARY_DIR "/etendue", {"render", scene, "-o", "a.npy"}, folder);
  std::this_thread::sleep_for(std::chrono::milliseconds(800));
  process.send(SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const double asked = now();
  process.send(SIGINT);
  std::future<int> status = std::async(std::launch::async, [&] { return process.wait(); });
  if (status.wait_for(std::chrono::seconds(20)) == std::future_status::timeout) process.send(SIGKILL);
  EXPECT_EQ(status.get(), 130);
  EXPECT_LT(now() - asked, 2);
  EXPECT_NE(process.err().find("writing what there is, without this pass"), std::string::npos) << process.err();
  EXPECT_FALSE(std::filesystem::exists(folder / "a.npy"));
}

TEST(BoundedPaths, what_is_asked_before_a_render_begins_is_not_lost_and_not_kept) {
  Render render(load_job_text(
      test::job_text("PathTracer { samples: 1 }", "PerspectiveCamera { from: [0, 0, 5] m, to: [0, 0, 0] m }", 8, white_box),
      "box"));
  render.abort();
  EXPECT_EQ(render.run(), Ended::aborted);
  EXPECT_EQ(render.run(), Ended::samples);
}

TEST(BoundedPaths, depths_that_need_more_memory_are_refused_with_their_place) {
  for (const char* name : {"BidirectionalPathTracer", "LightTracer"}) {
    try {
      load_job_text(test::job_text(std::string(name) + " {\n max_depth: 1000000000 }",
                                   "PerspectiveCamera { from: [0, 0, 5] m, to: [0, 0, 0] m }", 8, white_box),
                    "box.etd");
      ADD_FAILURE() << name;
    } catch (const Errors& errors) {
      ASSERT_EQ(errors.errors.size(), 1u);
      EXPECT_EQ(errors.errors[0].location.line, 3) << name;
      EXPECT_NE(std::string(errors.errors[0].what()).find("max_depth"), std::string::npos) << errors.errors[0].what();
    }
  }
}

// Null scattering is no recursion: a thousand sheets one behind the other, on each of many segments.
TEST(BoundedPaths, a_thousand_sheets_are_no_deep_recursion) {
  std::string objects = "Environment { emission: DiffuseEmission { radiance: 1 } }\n";
  for (int i = 0; i < 900; ++i)
    objects += "Rectangle { corner: [-5, -5, " + std::to_string(-0.01 * i) +
               "] m, edge_u: [10, 0, 0] m, edge_v: [0, 10, 0] m, shader: PassThrough {} }\n";
  for (const char* renderer : {"WhittedRenderer", "DistributionRenderer { split_depth: 16 }", "DirectRenderer", "PathTracer"}) {
    const std::string text = std::string(renderer) + (std::string(renderer).find('{') == std::string::npos ? " {}" : "");
    const Ref<Job> job = load_job_text(
        test::job_text(text, "PerspectiveCamera { from: [0, 0, 5] m, to: [0, 0, 0] m, fov: 5 deg }", 2, objects, "BvhScene"),
        "sheets");
    job->renderer->samples = 1;
    EXPECT_NEAR(test::rendered(job, {.threads = 1})->film().develop().at(1, 1, 1), 1, 0.05) << renderer;
  }
}

TEST(BoundedPaths, records_of_endless_paths_keep_their_beginning) {
  const Render render(load_job_text(test::job_text("PathTracer { samples: 1, max_depth: 200000 }",
                                                   "PerspectiveCamera { from: [0, 0, 5] m, to: [0, 0, 0] m }", 8, white_box),
                                    "box"));
  PathRecord record;
  render.replay(3, 3, 0, record);
  EXPECT_EQ(record.vertices.size(), PathRecord::most);
  EXPECT_EQ(record.vertices.front().kind, "camera");
  EXPECT_LE(record.contributions.size(), PathRecord::most);
}

TEST(Arena, goes_back_to_a_mark) {
  Arena arena;
  struct Block {
    std::byte bytes[40000];
  };
  int* const first = arena.make<int>(7);
  const Arena::Mark mark = arena.mark();
  Block* const one = arena.make<Block>();
  Block* const two = arena.make<Block>();  // in another block of memory
  EXPECT_NE(one, two);
  for (int i = 0; i < 5; ++i) {
    arena.rewind(mark);
    EXPECT_EQ(arena.make<Block>(), one);
    EXPECT_EQ(arena.make<Block>(), two);
  }
  EXPECT_EQ(*first, 7);
  {
    const ArenaScope scope(arena);
    EXPECT_NE(arena.make<Block>(), two);
  }
  arena.reset();
  EXPECT_EQ(arena.make<int>(1), first);
}

}  // namespace
}  // namespace etendue
