// etendue check FILE: everything but rendering.

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "app/scene_options.h"
#include "check/warnings/advice.h"
#include "check/warnings/scene_warnings.h"
#include "core/number_text.h"
#include "etendue/mesh_facts.h"
#include "etendue/render/follows_polarization.h"

namespace etendue {

namespace {

/// A count of things: `stored` counts each scene once, `placed` once for each of its instances. (Doubles, as `placed` may be
/// very large.)
struct Amount {
  double stored = 0, placed = 0;
};

struct Contents {
  Amount objects, triangles, scenes;
};

/// Counts the contents of each scene once as stored, and once per instance as placed.
class Counter {
 public:
  Contents count(const Scene& scene) {
    const auto [place, fresh] = known_.try_emplace(&scene);
    Contents& here = place->second;  // the reference stays valid when other scenes are added to the map
    if (!fresh) return {{0, here.objects.placed}, {0, here.triangles.placed}, {0, here.scenes.placed}};
    here.scenes = {1, 1};
    const auto add = [](Amount& to, const Amount& more) {
      to.stored += more.stored;
      to.placed += more.placed;
    };
    for (const Ref<SceneObject>& object : scene.objects) {
      if (const Scene* inner = scene_within(*object)) {
        const Contents more = count(*inner);
        add(here.objects, more.objects);
        add(here.triangles, more.triangles);
        add(here.scenes, more.scenes);
        continue;
      }
      add(here.objects, {1, 1});
      const auto view = still_triangles(*object);
      const double triangles = view ? double(view->triangles.size()) : 0;
      add(here.triangles, {triangles, triangles});
    }
    return here;
  }

 private:
  std::unordered_map<const Scene*, Contents> known_;
};

std::string amount_text(const Amount& amount) {
  constexpr double most = 1e15;
  std::string stored = grouped(std::uint64_t(amount.stored));
  if (amount.placed == amount.stored) return stored;
  return stored + ", " + (amount.placed < most ? grouped(std::uint64_t(amount.placed)) : fmt::format("{:.1e}", amount.placed)) +
         " in all places where nested scenes stand";
}

/// Reports the light that the job's renderer misses, and the renderers that find all light of the scene.
void report_light(const Job& job, const SceneTraits& traits) {
  std::fflush(stdout);  // so that warnings on standard error appear in the right place on a terminal
  show_warnings(scene_warnings(job));
  if (job.scene->luminaires().empty() && traits.emissive_media.empty()) return;
  advise(job);
  std::vector<std::string> renderers = renderers_that_find_all(traits);
  if (!polarizing_plates(*job.scene).empty())
    std::erase_if(renderers, [](const std::string& name) { return !std::ranges::count(polarization_followers(), name); });
  if (renderers.empty())
    fmt::print("No known renderer finds all light of this scene.\n");
  else
    fmt::print("renderers that find all light of this scene: {}\n", fmt::join(renderers, ", "));
}

int check(const SceneOptions& options) {
  const Ref<Job> job = options.load();
  prepare_tree(*job);

  const Contents contents = Counter().count(*job->scene);
  const PixelArea& area = job->image->area();
  std::string size = fmt::format("{} x {} pixels", job->image->width, job->image->height);
  if (area.width() != job->image->width || area.height() != job->image->height)
    size += fmt::format(", of these x {} to {}, y {} to {}", area.x0, area.x1, area.y0, area.y1);

  fmt::print("objects     {}\n", amount_text(contents.objects));
  if (contents.scenes.stored > 1) fmt::print("scenes      {}\n", amount_text(contents.scenes));
  fmt::print("triangles   {}\n", amount_text(contents.triangles));
  const SceneTraits traits = scene_traits(*job->scene, *job->camera);
  fmt::print("luminaires  {}\n", luminaires_text(*job->scene, traits));
  fmt::print("image       {}\n", size);
  fmt::print("samples     {} per pixel\n", job->renderer->samples);
  fmt::print("renderer    {}, {}\n", job->renderer->class_info().name, job->renderer->bias().empty() ? "unbiased" : "biased");
  // A renderer's general limits say little about this scene: misses() reports those that matter here. But a renderer of a
  // plugin may define limits() alone, so its limits are printed if its misses() reports nothing.
  const std::string limits = job->renderer->limits();
  if (!limits.empty() && !job->renderer->class_info().provider.empty() && job->renderer->misses(traits).empty())
    fmt::print("left out    {}\n", limits);
  report_light(*job, traits);
  fmt::print("{} is good\n", options.file);
  return exit_status::done;
}

}  // namespace

void add_check_command(Command& program) {
  Command command = program.add_command("check", "Read and prepare a file without rendering it; show everything wrong with it");
  auto options = std::make_shared<SceneOptions>();
  options->add_to(command);
  command.footer("\nExample\n  etendue check scenes/cornell_box.etd");
  command.runs([options] { return check(*options); });
}

}  // namespace etendue
