// One of each class of object that rays can hit, in scenes/verify/every_object.etd: all acceleration structures find the same
// hits.

#include <set>

#include "etendue/language/language.h"
#include "etendue/render/job.h"
#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

Ref<Job> every_object() { return load_job(ETENDUE_SOURCE_DIR "/scenes/verify/every_object.etd"); }

void classes_in(const SceneObject& object, std::set<std::string>& found) {
  found.insert(object.class_info().name);
  if (const Scene* inner = scene_within(object))
    for (const auto& each : inner->objects) classes_in(*each, found);
}

// A new class has to be added to the scene.
TEST(EveryObject, IsInTheScene) {
  std::set<std::string> found;
  classes_in(*every_object()->scene, found);
  // Objects that no ray hits, and objects that hold those of other files.
  const std::set<std::string> never_met{"Point", "Distant", "Environment", "Import", "Surroundings"};
  const ClassInfo& objects = *Registry::instance().find("SceneObject");
  for (const ClassInfo* c : Registry::instance().subclasses(objects))
    if (c->provider.empty() && c->name.rfind("Test", 0) != 0 && !never_met.contains(c->name)) {
      EXPECT_TRUE(found.contains(c->name)) << c->name;
    }
}

Ref<Scene> searched_by(const char* structure) {
  const Ref<Job> job = every_object();
  Ref<Scene> made = ref_cast<Scene>(Registry::instance().create(structure));
  made->objects = job->scene->objects;
  prepare_tree(*made);
  return made;
}

/// The outermost object in which a hit lies, by its class and its index in the scene's list: the same for equal scenes.
std::string name_of(const Scene& scene, const Hit& hit) {
  const SceneObject* outermost = hit.depth ? hit.scenes[hit.depth - 1] : hit.object;
  for (size_t i = 0; i < scene.objects.size(); ++i)
    if (scene.objects[i].get() == outermost) return outermost->class_info().name + " " + std::to_string(i);
  return outermost->class_info().name + " of no place";
}

TEST(EveryObject, IsFoundAlikeByAllStructures) {
  const char* const structures[] = {"BvhScene", "EmbreeScene", "OctreeScene", "GridScene", "BruteForceScene"};
  std::vector<Ref<Scene>> scenes;
  for (const char* structure : structures) scenes.push_back(searched_by(structure));
  constexpr int rays = 100000;
  constexpr size_t count = std::size(structures);
  int hits = 0, other_distance[count] = {}, other_object[count] = {}, other_occlusion[count] = {};
  std::set<std::string> met;
  Random random(1);
  for (int i = 0; i < rays; ++i) {
    // From the camera, from all around and from among the objects, towards the objects.
    const Point3 target{random.between(-2.7f, 2.7f), random.between(-1.7f, 1.5f), random.between(0, 0.6f)};
    Point3 from{0, -6, 3.4f};
    if (i % 3 == 1) from = target + 9.0f * random.direction();
    if (i % 3 == 2) from = {random.between(-2.7f, 2.7f), random.between(-1.7f, 1.5f), random.between(0, 0.6f)};
    const Ray r = ray(from, normalize(target - from));
    Hit expected;
    const bool hit = scenes[0]->nearest(r, expected);
    hits += hit;
    if (hit) met.insert(name_of(*scenes[0], expected));
    // BruteForceScene tests every object for every ray, which takes long: only for a tenth of the rays.
    for (size_t k = 0; k < (i % 10 == 0 ? count : count - 1); ++k) {
      Hit found;
      const bool hit2 = k ? scenes[k]->nearest(r, found) : hit;
      if (k == 0) found = expected;
      other_occlusion[k] += scenes[k]->any(r) != hit2;
      if (k == 0) continue;
      if (hit != hit2) {
        ++other_distance[k];
      } else if (hit) {
        const bool far =
            std::abs(found.distance - expected.distance) > 1e-5f * expected.distance + 1e-6f;  // coordinates are rounded, too
        const bool other = name_of(*scenes[k], found) != name_of(*scenes[0], expected);
        other_distance[k] += far;
        other_object[k] += other;
        if (far && other_distance[k] < 6)
          std::printf("  %s: ray %d at %.7g on %s, not at %.7g on %s\n", structures[k], i, double(found.distance),
                      name_of(*scenes[k], found).c_str(), double(expected.distance), name_of(*scenes[0], expected).c_str());
      }
    }
  }
  EXPECT_GT(hits, rays / 2);
  EXPECT_EQ(met.size(), scenes[0]->objects.size()) << "all of them";
  // At an edge, rounding decides which of two surfaces is hit, or whether one is hit.
  for (size_t k = 0; k < count; ++k) {
    EXPECT_LE(other_distance[k], 5) << structures[k];
    EXPECT_LE(other_object[k], 5) << structures[k];
    EXPECT_LE(other_occlusion[k], 5) << structures[k];
    RecordProperty(std::string(structures[k]) + "_other_distance", other_distance[k]);
  }
}

}  // namespace
}  // namespace etendue
