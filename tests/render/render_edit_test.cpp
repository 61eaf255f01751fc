// Edits of a render: after each edit the image is, byte for byte, that of a new render of the edited job; a refused edit
// changes nothing.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <random>
#include <set>
#include <thread>

#include "check/conform/draw.h"
#include "etendue/language/language.h"
#include "etendue/render/render.h"
#include "support/checkpoint_test_support.h"
#include "support/language_test_support.h"

namespace etendue {
namespace {

using checkpoint_test::complaint;
using checkpoint_test::has;

/// A job with all kinds of components: nested and instanced scenes, a solid, emissive and displaced meshes, maps, a medium.
const std::string world = R"(Job {
  renderer: PathTracer { samples: 2, max_depth: 5 }
  camera: PerspectiveCamera { from: [0, 0.5, 5] m, to: [0, 0, 0] m, fov: 50 deg }
  image: ImageBuffer { width: 8, height: 6 }
  scene: EmbreeScene { objects: [
    Rectangle { corner: [-3, -1, -3], edge_u: [0, 0, 6], edge_v: [6, 0, 0],
      shader: Lambertian { color: CheckerMap { first: rgb(0.2, 0.4, 0.7), second: 0.8 } } }
    Sphere { centre: [-1, 0, 0], radius: 0.6, shader: Conductor { roughness: 0.3 } }
    Sphere { centre: [0.3, -0.2, 1], radius: 0.5, shader: Dielectric { ior: 1.5 }, interior: HomogeneousVolume { absorption: 0.4 } }
    Box { centre: [1, -0.5, -0.5], size: [1, 1, 1], transform: rotate(20 deg, "y"), shader: Plastic { color: rgb(0.7, 0.2, 0.1) } }
    TriangleMesh { positions: [[-0.5, 2, -0.5], [0.5, 2, -0.5], [0.5, 2, 0.5], [-0.5, 2, 0.5]], triangles: [[0, 1, 2], [0, 2, 3]],
      emission: DiffuseEmission { radiance: 6, sides: both } }
    DisplacedMesh { surface: Polygon { points: [[-2, -0.9, 1], [-1, -0.9, 1], [-1, -0.9, 2], [-2, -0.9, 2]] }, levels: 2,
      displacement: CheckerMap { first: 0, second: 0.2 }, shader: Lambertian { color: 0.6 } }
    Difference { operands: [ Sphere { centre: [2, 0.5, 0], radius: 0.5 }, Sphere { centre: [2, 0.7, 0.4], radius: 0.4,
      shader: Lambertian { color: rgb(0.9, 0.8, 0.1) } } ] }
    BvhScene { transform: translate([-2, 1, -1]), objects: [
      Disc { radius: 0.4, shader: Lambertian { color: 0.5 } }
      Sphere { centre: [0.6, 0.4, 0], radius: 0.15, emission: DiffuseEmission { radiance: 4 } } ] }
    Instance { transform: translate([1.5, 1.5, -1]), scene: EmbreeScene { objects: [ Cylinder { radius: 0.2, shader: Lambertian {} } ] } }
    Environment { emission: DiffuseEmission { radiance: 0.2, sides: both } }
  ] }
  tone_map: AgXToneMap {}
})";

std::string unknown_class(const std::string& text) {
  return complaint([&] { load_job_text(text, "world.etd"); });
}

std::vector<std::byte> finished(const Render& render) { return render.film().save_state(); }

/// The film of a new render of the same description.
std::vector<std::byte> of_a_new_render(const Job& job) {
  Render fresh(load_job_text(write_description(job), "again.etd"), {.threads = 1});
  fresh.run();
  return finished(fresh);
}

/// All components of a job, in the order of a breadth-first search.
std::vector<const Component*> parts_of(const Job& job) {
  std::vector<const Component*> parts{&job};
  std::set<const Component*> seen{&job};
  const std::function<void(const Value&)> visit = [&](const Value& value) {
    if (const auto* c = value.as<Ref<Component>>()) {
      if (*c && seen.insert(c->get()).second) parts.push_back(c->get());
    } else if (const auto* list = value.as<Value::List>()) {
      for (const Value& item : *list) visit(item);
    }
  };
  for (size_t i = 0; i < parts.size(); ++i)
    for (const Member& m : parts[i]->class_info().members)
      if (m.kind == Kind::component) visit(get(*parts[i], m.name));
  return parts;
}

TEST(RenderEdit, each_kind_of_member_leads_to_the_picture_of_a_new_render) {
  ASSERT_EQ(unknown_class(world), "");
  const Ref<Job> job = load_job_text(world, "world.etd");
  Render render(job, {.threads = 2});
  render.run();
  EXPECT_EQ(finished(render), of_a_new_render(*job));
  const auto objects = [&](size_t i) -> const SceneObject& { return *job->scene->objects[i]; };
  const auto part = [](const std::string& text) { return Value(parse_component(text, "part")); };
  const auto edit = [&](const Component& component, const std::string& member, const Value& value) {
    SCOPED_TRACE(component.class_info().name + "." + member);
    const std::vector<std::byte> before = finished(render);
    render.edit(component, member, value);
    EXPECT_EQ(render.run(), Ended::samples);
    EXPECT_EQ(finished(render), of_a_new_render(*job));
    return finished(render) != before;
  };
  const auto numbers = [](std::vector<double> v) { return Value(Numbers{std::move(v), 1, Dimension::none}); };
  EXPECT_TRUE(edit(*objects(3).shader, "color", part("CheckerMap {}")));                      // a map for a colour
  EXPECT_TRUE(edit(objects(1), "shader", part("Lambertian { color: rgb(0.1, 0.9, 0.2) }")));  // a shader
  EXPECT_TRUE(edit(objects(1), "radius", Value(Number{0.9, Dimension::length})));             // a shape
  EXPECT_TRUE(edit(objects(1), "transform", Value(AnimatedTransform(Transform::translate({0.2f, 0, 0})))));
  EXPECT_TRUE(edit(objects(7), "transform", Value(AnimatedTransform(Transform::translate({-1.5f, 1, 0})))));  // a scene's
  EXPECT_TRUE(edit(*objects(4).emission, "radiance", Value(Number{9})));
  EXPECT_TRUE(edit(objects(2), "interior", part("HomogeneousVolume { absorption: 2 }")));
  EXPECT_TRUE(edit(objects(5), "displacement", part("ConstantMap { value: 0.5 }")));
  EXPECT_TRUE(edit(*job->camera, "from", numbers({0.5, 1, 4})));  // nearby: the scene is not prepared again
  EXPECT_TRUE(edit(*job->camera, "from", numbers({500, 1, 4})));  // far: the origin of render space moves
  EXPECT_TRUE(edit(*job->camera, "from", numbers({0, 0.5, 5})));
  EXPECT_TRUE(edit(*job, "renderer", part("DirectRenderer { samples: 3 }")));
  EXPECT_TRUE(edit(*job->renderer, "samples", Value(Number{5})));
  EXPECT_TRUE(edit(*job->renderer, "samples", Value(Number{1})));
  EXPECT_TRUE(edit(*job, "seed", Value(Number{7})));
  EXPECT_TRUE(edit(*job->image, "width", Value(Number{5})));
  EXPECT_TRUE(edit(*job, "scene", part("BruteForceScene { objects: [ Sphere { emission: DiffuseEmission {} } ] }")));
}

TEST(RenderEdit, a_mesh_file_that_changed_is_read_again) {
  const language_test::Folder folder;
  const auto ply = [&](const std::string& name, const char* corner) {
    return folder.write(name,
                        std::string("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                                    "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n") +
                            corner + "\n0 1 0\n3 0 1 2\n");
  };
  const Ref<Job> job = load_job_text(
      "Job { renderer: PathTracer { samples: 4 }, image: ImageBuffer { width: 8, height: 8 }, camera: PerspectiveCamera { "
      "from: [0, 0, 4], "
      "to: [0, 0, 0] }, scene: EmbreeScene { objects: [ TriangleMesh { file: \"" +
          ply("a.ply", "1 0 0") + "\", emission: DiffuseEmission { sides: both } } ] } }",
      "mesh.etd");
  Render render(job);
  render.run();
  const std::vector<std::byte> before = finished(render);
  render.edit(*job->scene->objects[0], "file", Value(FilePath{ply("b.ply", "2 0 0"), ""}));
  render.run();
  EXPECT_NE(finished(render), before);
  EXPECT_EQ(finished(render), of_a_new_render(*job));
  render.edit(*job->scene->objects[0], "file", Value(FilePath{folder.path() + "/a.ply", ""}));
  render.run();
  EXPECT_EQ(finished(render), before);
  const std::string reason =
      complaint([&] { render.edit(*job->scene->objects[0], "file", Value(FilePath{folder.path() + "/c.ply", ""})); });
  EXPECT_TRUE(has(reason, "c.ply")) << reason;
  render.restart();
  render.run();
  EXPECT_EQ(finished(render), before);
}

TEST(RenderEdit, what_is_refused_leaves_all_as_it_was) {
  const Ref<Job> job = load_job_text(world, "world.etd");
  job->renderer->samples = 1 << 15;  // two steps and more
  Render render(job);
  ASSERT_FALSE(render.step());
  const std::vector<std::byte> before = finished(render);
  const std::string description = write_description(*job);
  const auto refused = [&](const Component& c, const std::string& member, const Value& value) {
    const std::string reason = complaint([&] { render.edit(c, member, value); });
    EXPECT_EQ(write_description(*job), description) << member;
    EXPECT_EQ(finished(render), before) << member;
    return reason;
  };
  const Component& ball = *job->scene->objects[1];
  EXPECT_TRUE(has(refused(ball, "radius", Value(Number{-1, Dimension::length})), "radius"));
  EXPECT_TRUE(has(refused(ball, "colour", Value(Number{1})), "no member 'colour'"));
  EXPECT_TRUE(has(refused(ball, "radius", Value(std::string("big"))), "radius"));
  EXPECT_TRUE(has(refused(*job, "camera", Value(Ref<Component>())), "needs a camera"));
  EXPECT_TRUE(has(refused(*job, "scene", Value(Ref<Component>())), "needs a scene"));
  EXPECT_TRUE(has(refused(*job->camera, "to", Value(Numbers{{0, 0.5, 5}, 1, Dimension::none})), "another point than from"));
  EXPECT_TRUE(has(refused(*job->scene->objects[4], "triangles", Value(Numbers{{0, 1, 9}, 1, Dimension::none})), "vertex 9"));
  EXPECT_TRUE(has(refused(*job->scene->objects[8], "scene", Value(Ref<Component>(job->scene))), "cannot contain itself"));
  EXPECT_TRUE(has(refused(*make<Job>(), "seed", Value(Number{1})), "no part of the job"));
  // If one of several edits is refused, none is made.
  const Edit both[] = {{Ref<const Component>(&ball), "radius", Value(Number{0.1, Dimension::length})},
                       {Ref<const Component>(job->camera.get()), "fov", Value(Number{-1})}};
  EXPECT_NE(complaint([&] { render.edit(both); }), "");
  EXPECT_EQ(write_description(*job), description);
  // The render continues to the same image.
  render.run();
  EXPECT_EQ(finished(render), of_a_new_render(*job));
}

TEST(RenderEdit, more_samples_go_on_and_fewer_begin_anew) {
  const Ref<Job> job = load_job_text(world, "world.etd");
  const auto step = int(Render(job).samples_per_step());
  job->renderer->samples = step + 5;
  Render render(job);
  render.run();
  render.edit(*job->renderer, "samples", Value(Number{double(2 * step + 3)}));
  EXPECT_EQ(render.progress().samples, std::uint32_t(step + 5));
  render.run();
  EXPECT_EQ(finished(render), of_a_new_render(*job));
  render.edit(*job->renderer, "samples", Value(Number{9}));
  EXPECT_EQ(render.progress().samples, 0u);
  render.run();
  EXPECT_EQ(finished(render), of_a_new_render(*job));
}

TEST(RenderEdit, the_look_changes_while_a_step_is_at_hand_and_loses_nothing) {
  const Ref<Job> job = load_job_text(world, "world.etd");
  job->renderer->samples = 1 << 20;
  std::atomic<bool> begun{false};
  Render render(job, {.on_progress = [&](const Progress&) { begun = true; }, .progress_interval = 0});
  std::thread runs([&] { render.run(); });
  while (!begun) std::this_thread::yield();
  const std::uint64_t had = render.film().samples();
  const Image picture = render.picture(), before = render.display(picture);
  render.edit(*job->tone_map, "stops", Value(Number{-3}));
  EXPECT_NE(render.display(picture).values, before.values);
  render.edit(*job, "tone_map", Value(parse_component("ExposureToneMap {}", "part")));
  EXPECT_NE(complaint([&] { render.edit(*job->tone_map, "stops", Value(Number{1e9})); }), "");
  EXPECT_GE(render.film().samples(), had);
  render.abort();
  runs.join();
}

TEST(RenderEdit, samples_are_replayed_while_it_renders) {
  const Ref<Job> job = load_job_text(world, "world.etd");
  PathRecord at_rest, meanwhile;
  const Point2 place = Render(job).replay(3, 2, 1, at_rest);
  job->renderer->samples = 1 << 17;
  std::atomic<bool> begun{false};
  Render render(job, {.on_progress = [&](const Progress&) { begun = true; }, .progress_interval = 0});
  std::thread runs([&] { render.run(); });
  while (!begun) std::this_thread::yield();
  for (int n = 0; n < 3; ++n) {
    meanwhile = {};
    EXPECT_EQ(render.replay(3, 2, 1, meanwhile), place);
    EXPECT_EQ(meanwhile.vertices.size(), at_rest.vertices.size());
    for (int i = 0; i < spectrum_size; ++i) EXPECT_EQ(meanwhile.result[i], at_rest.result[i]);
  }
  render.abort();
  runs.join();
}

/// One thread renders, one displays, one edits at random.
TEST(RenderEdit, random_edits_of_every_part_while_it_renders) {
  const char* asked = std::getenv("ETENDUE_RANDOM_EDITS");
  const int edits = asked ? std::atoi(asked) : 250;
  std::mt19937_64 random(20);
  const conform::Fixtures fixtures;
  int made = 0, refused = 0;
  for (int n = 0; n < edits;) {
    const Ref<Job> job = load_job_text(world, "world.etd");
    Render render(job, {.threads = 1});
    std::atomic<bool> over{false}, fails{false};
    std::thread runs([&] {
      while (!over) fails = !complaint([&] { render.run(); }).empty();
    });
    std::thread looks([&] {
      while (!over) {
        const Image shown = render.display(render.picture());
        EXPECT_GT(shown.width, 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    // After many edits in turn a scene is mostly dark, so the job is loaded again now and then.
    for (int k = 0; k < 25 && n < edits; ++k, ++n) {
      const std::vector<const Component*> parts = parts_of(*job);
      const Component& part = *parts[random() % parts.size()];
      const std::vector<Member>& members = part.class_info().members;
      if (members.empty()) continue;
      const Member& member = members[random() % members.size()];
      // Limits of time do not depend on the description alone; large images take long.
      static const std::set<std::string> left_out{"time_limit", "error_limit", "samples", "width",
                                                  "height",     "levels",      "outputs"};
      if (left_out.contains(member.name)) continue;
      const Value value = conform::draw_value(part.class_info(), member, fixtures, random);
      if (value.none()) continue;
      SCOPED_TRACE(std::to_string(n) + ": " + part.class_info().name + "." + member.name);
      const std::string before = write_description(*job);
      const std::string reason = complaint([&] { render.edit(part, member.name, value); });
      (reason.empty() ? made : refused) += 1;
      if (!reason.empty()) EXPECT_EQ(write_description(*job), before) << reason;
      const std::string description = write_description(*job);
      fails = false;
      while (!fails && render.progress().samples < std::uint32_t(job->renderer->samples)) std::this_thread::yield();
      // Some errors are found only while rendering; a new render then throws as well.
      if (fails)
        EXPECT_NE(complaint([&] { of_a_new_render(*job); }), "") << description;
      else
        EXPECT_EQ(finished(render), of_a_new_render(*job)) << reason << "\n" << description;
      if (HasFailure()) break;
    }
    over = true;
    runs.join();
    looks.join();
    if (HasFailure()) break;
  }
  EXPECT_GT(made, edits / 4);
  EXPECT_GT(refused, edits / 100);
}

}  // namespace
}  // namespace etendue
