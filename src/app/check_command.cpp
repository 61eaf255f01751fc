// etendue check FILE: everything but rendering.

#include <fmt/format.h>

#include <unordered_set>

#include "app/advice.h"
#include "app/scene_options.h"
#include "app/text.h"

namespace etendue {

namespace {

struct Contents {
  std::uint64_t objects = 0, triangles = 0, scenes = 0;
  std::unordered_set<const Scene*> seen;  // one that stands in many places counts once
};

void count(const Scene& scene, Contents& contents) {
  ++contents.scenes;
  for (const Ref<SceneObject>& object : scene.objects) {
    if (!object) continue;
    if (const Scene* nested = scene_within(*object)) {
      if (contents.seen.insert(nested).second) count(*nested, contents);
      continue;
    }
    ++contents.objects;
    if (const auto view = object->triangles()) contents.triangles += view->triangles.size();
  }
}

/// What of the scene's light the job's renderer misses, and which renderers find all of it.
void report_light(const Job& job, const SceneTraits& traits) {
  if (job.scene->luminaires().empty() && traits.nested_luminaires.empty() && traits.emissive_media.empty()) {
    fmt::print("Nothing emits light: the picture will be black.\n");
    return;
  }
  std::fflush(stdout);  // warnings stand where they belong when both go to a terminal
  advise(job);
  const std::vector<std::string> renderers = renderers_that_find_all(traits);
  if (renderers.empty())
    fmt::print("No known renderer finds all light of this scene.\n");
  else
    fmt::print("renderers that find all light of this scene: {}\n", fmt::join(renderers, ", "));
}

int check(const SceneOptions& options) {
  const Ref<Job> job = options.load();
  prepare_tree(*job);

  Contents contents;
  count(*job->scene, contents);
  const PixelArea& area = job->image->area();
  std::string size = fmt::format("{} x {} pixels", job->image->width, job->image->height);
  if (area.width() != job->image->width || area.height() != job->image->height)
    size += fmt::format(", of these x {} to {}, y {} to {}", area.x0, area.x1, area.y0, area.y1);

  fmt::print("objects     {}\n", grouped(contents.objects));
  if (contents.scenes > 1) fmt::print("scenes      {}\n", grouped(contents.scenes));
  fmt::print("triangles   {}\n", grouped(contents.triangles));
  const SceneTraits traits = scene_traits(*job->scene, *job->camera);
  fmt::print("luminaires  {}\n", luminaires_text(traits));
  fmt::print("image       {}\n", size);
  fmt::print("samples     {} per pixel\n", job->renderer->samples);
  fmt::print("renderer    {}, {}\n", job->renderer->class_info().name, job->renderer->unbiased() ? "unbiased" : "consistent");
  if (const std::string limits = job->renderer->limits(); !limits.empty()) fmt::print("left out    {}\n", limits);
  report_light(*job, traits);
  fmt::print("{} is good\n", options.file);
  return exit_status::done;
}

}  // namespace

void add_check_command(CLI::App& program, Run& run) {
  CLI::App* command =
      program.add_subcommand("check", "Read and prepare a file without rendering it; show everything wrong with it");
  auto options = std::make_shared<SceneOptions>();
  options->add_to(*command);
  command->footer("\nExample\n  etendue check scenes/cornell_box.etd");
  command->callback([options, &run] { run = [options] { return check(*options); }; });
}

}  // namespace etendue
