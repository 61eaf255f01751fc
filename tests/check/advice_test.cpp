// Advice: the light in a scene that a renderer cannot find, and the renderers that can.

#include "check/warnings/advice.h"

#include <gtest/gtest.h>

#include "support/replay_test_support.h"

namespace etendue::replay_test {
namespace {

TEST(AdviceText, names_what_can) {
  EXPECT_EQ(advice_text("A", {delta_light, "x", {"B"}}), "A cannot find x; B can");
  EXPECT_EQ(advice_text("A", {delta_light, "x", {"B", "C", "D"}}), "A cannot find x; B, C and D can");
  EXPECT_EQ(advice_text("A", {delta_light, "x", {"A", "B"}}), "A cannot find x; with its members' defaults it can");
  EXPECT_EQ(advice_text("A", {delta_light, "x", {}}), "A cannot find x; no known renderer can");
}

// Each path class has a name, a description and a bit of its own; a scene with every trait has paths of all classes.
TEST(AdviceText, every_kind_of_light_has_its_words) {
  SceneTraits all;
  for (std::vector<std::string>* list :
       {&all.specular, &all.refracting, &all.smooth, &all.diffuse, &all.glossy, &all.points, &all.distant, &all.areas,
        &all.environments, &all.media, &all.emissive_media, &all.heterogeneous_media, &all.subsurface_exits,
        &all.null_scattering, &all.fluorescent, &all.dyed_media, &all.seen_areas, &all.seen_environments})
    list->push_back("'it'");
  EXPECT_EQ(paths_in(all), all_paths);
  EXPECT_EQ(paths_in({}), no_paths);
  PathClasses bits = no_paths;
  for (const PathClassInfo& c : path_classes()) {
    EXPECT_EQ(bits & c.bit, 0u) << c.name;
    bits |= c.bit;
    EXPECT_FALSE(std::string(c.name).empty() || std::string(c.what).empty());
  }
  EXPECT_EQ(bits, all_paths);
}

TEST(AdviceText, a_path_tracer_loses_caustics_of_a_point_light_through_glass) {
  const Ref<Job> job = prepared(point_scene("PathTracer {}", {floor_disc, "lamp", "ball"}));
  const std::vector<std::string> lines = advice_lines(*job);
  ASSERT_EQ(lines.size(), 2u);  // caustics, and caustics seen in mirrors
  EXPECT_TRUE(lines[0].starts_with("PathTracer cannot find ")) << lines[0];
  for (const char* part : {"caustics", "'lamp'", "'ball'"}) EXPECT_TRUE(has(lines[0], part)) << lines[0];
  EXPECT_TRUE(has(lines[0], "; Automatic, BidirectionalPathTracer") && lines[0].ends_with(" can")) << lines[0];
  EXPECT_FALSE(has(lines[0], " Renderer ")) << "an interface is no renderer: " << lines[0];
  const SceneTraits traits = scene_traits(*job->scene, *job->camera);
  for (const std::string& name : renderers_that_find_all(traits)) {
    EXPECT_NE(name, "PathTracer");
    EXPECT_NE(name, "Renderer") << "an interface is no renderer";
  }
  EXPECT_EQ(luminaires_text(*job->scene, traits), "1: 1 point light");
}

TEST(AdviceText, without_next_event_a_path_tracer_loses_lights_without_extent) {
  const Ref<Job> job = prepared(point_scene("PathTracer { next_event: false }", {floor_disc, "lamp", "ball"}));
  const std::vector<std::string> lines = advice_lines(*job);
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(has(lines[0], "'lamp'") && has(lines[0], "with its members' defaults it can")) << lines[0];
}

TEST(AdviceText, a_path_tracer_finds_the_light_of_other_scenes) {
  const std::string only_lamp = R"(Point { position: [1, 3, 0] m, emission: DiffuseEmission { radiance: 20 } })";
  for (const std::vector<std::string>& parts :
       {std::vector<std::string>{floor_disc, glass_ball, round_lamp}, std::vector<std::string>{floor_disc, only_lamp},
        std::vector<std::string>{glass_ball, "Environment { emission: DiffuseEmission {} }"},
        std::vector<std::string>{floor_disc}}) {
    const Ref<Job> job = prepared(test::job_text("PathTracer {}", camera, 4, objects(parts)));
    for (const std::string& line : advice_lines(*job)) ADD_FAILURE() << line;
    const std::vector<std::string> all = renderers_that_find_all(scene_traits(*job->scene, *job->camera));
    EXPECT_TRUE(std::find(all.begin(), all.end(), "PathTracer") != all.end());
  }
}

TEST(AdviceText, whitted_ray_tracing_loses_the_light_of_lamps_with_an_area) {
  const Ref<Job> job = prepared(test::job_text("WhittedRenderer {}", camera, 4, objects({floor_disc, round_lamp})));
  const std::vector<std::string> lines = advice_lines(*job);
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(lines[0].starts_with("WhittedRenderer cannot find light of the Sphere of line ")) << lines[0];
  EXPECT_TRUE(has(lines[0], "PathTracer")) << lines[0];
  const std::vector<std::string> all = renderers_that_find_all(scene_traits(*job->scene, *job->camera));
  EXPECT_TRUE(std::find(all.begin(), all.end(), "PathTracer") != all.end());
  EXPECT_TRUE(std::find(all.begin(), all.end(), "WhittedRenderer") == all.end());
}

TEST(AdviceText, luminaires_are_counted_by_kind) {
  const Ref<Job> job = prepared(test::job_text(
      "PathTracer {}", camera, 4,
      objects({floor_disc, round_lamp, round_lamp, "Environment { emission: DiffuseEmission {} }",
               std::string("BruteForceScene { objects: [ ") + round_lamp + " ] }", "Point { emission: DiffuseEmission {} }"})));
  EXPECT_EQ(luminaires_text(*job->scene, scene_traits(*job->scene, *job->camera)),
            "5: 1 point light, 3 area lights, 1 environment; 1 in nested scenes");
}

}  // namespace
}  // namespace etendue::replay_test
