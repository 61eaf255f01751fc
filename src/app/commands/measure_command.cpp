// etendue measure FILE: what a meter reads.

#include <fmt/format.h>
#include <unistd.h>

#include "app/common_options.h"
#include "app/scene_options.h"
#include "app/text.h"
#include "check/measure/measure.h"
#include "check/warnings/advice.h"
#include "etendue/language/language.h"

namespace etendue {
namespace {

struct MeasureOptions : SceneOptions {
  std::string seed;
  double samples = measure::Options().samples;
  int renders = measure::Options().renders, bands = measure::Options().bands, threads = 0;
  bool json = false;
};

int measure_file(const MeasureOptions& options) {
  const Ref<Job> job = options.load();
  if (!options.seed.empty()) set_path(*job, "seed", options.seed);
  measure::Options how{
      .samples = options.samples, .renders = options.renders, .bands = options.bands, .threads = options.threads};
  const bool show = isatty(STDERR_FILENO);
  how.go_on = [&](int done) {
    if (show)
      fmt::print(stderr, "\r\x1b[K{} of {} renders{}", done, options.renders, done == options.renders ? "\r\x1b[K" : "");
    return true;
  };
  const measure::Measurement m = measure::measure(job, how);
  // The numbers say the renderer's bias, but not what it cannot find.
  for (const Advice& advice : job->renderer->misses(scene_traits(*job->scene, *job->camera)))
    warn(advice_text(job->renderer->class_info().name, advice));
  fmt::print("{}", options.json ? measure::measurement_json(m) : measure::measurement_text(m));
  return exit_status::done;
}

}  // namespace

void add_measure_command(Command& program) {
  Command command = program.add_command("measure", "Print what a meter reads: lux or cd/m2 and W/m2 per band, with errors");
  auto options = std::make_shared<MeasureOptions>();
  options->add_to(command);
  command.option("--samples N", options->samples, "Samples in all renders together").show_default().range(1.0, 1e13);
  command.option("--renders K", options->renders, "Independent renders, whose spread gives the standard errors")
      .show_default()
      .range(2, 10000);
  command.option("--bands N", options->bands, "Bands from 360 to 830 nm, unless the file's image is a SpectralFilm")
      .show_default()
      .range(1, 4096);
  command.flag("--json", options->json, "Print JSON");
  command.option("--seed N", options->seed, "Seed of the random numbers");
  add_threads_option(command, options->threads);
  command.footer(
      "\nExamples\n"
      "  etendue measure desk.etd --set 'camera=IrradianceMeter { from: [0, 0.75, 0] m }'\n"
      "  etendue measure desk.etd --samples 1e7 --json\n"
      "\nThe camera chooses the quantity: IrradianceMeter, RadianceMeter, or any other camera for the mean radiance of its "
      "picture. docs/spectral-film.md tells more.");
  command.runs([options] { return measure_file(*options); });
}

}  // namespace etendue
