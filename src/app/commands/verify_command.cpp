// etendue verify FILE: tests whether renderers agree on a scene.

#include <fmt/format.h>
#include <unistd.h>

#include "app/common_options.h"
#include "app/interruption.h"
#include "app/scene_options.h"
#include "app/text.h"
#include "check/verify/report.h"
#include "check/verify/report_pictures.h"
#include "check/verify/text.h"
#include "etendue/language/language.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "files/whole_file.h"
#include "render/checkpoint.h"

namespace etendue {

namespace {

struct VerifyOptions : SceneOptions {
  std::string renderers, samples, time, seed, size, report;  ///< as written; empty: the description's value
  int passes = 16, lengths = 8, tile = 0, threads = 0;
  double significance = 0.01, inject = 1;
  bool force = false, json = false, quiet = false;

  void add_to(Command& command);
  Ref<Job> load() const;
  std::string command_line() const;
};

void VerifyOptions::add_to(Command& command) {
  SceneOptions::add_to(command);
  command.option("--renderers A,B,…", renderers,
                 "Renderers to compare, separated by commas: classes, or expressions such as 'PathTracer{next_event: false}'. "
                 "Default: the file's renderer and all others that find all light of the scene");
  command.flag("--force", force, "Compare the named renderers even if they miss light that the scene has");
  command.option("--samples N", samples, "Samples per pixel of each renderer, in all passes together");
  command.option("--passes K", passes, "Independent passes of each renderer").show_default().range(8, 10000);
  command.option("--time TIME", time,
                 "Render as many passes of --samples / --passes samples as fit into this time, at least 8, with each renderer");
  command.option("--lengths L", lengths, "Compare path lengths from 1 to L separately, and all longer ones together")
      .show_default()
      .range(0, 63);
  command.option("--tile PX", tile, "Side of the tiles compared [pixels]; 0: 32, less in small pictures").range(0, 65536);
  command
      .option("--significance P", significance,
              "Significance level: probability of reporting any disagreement where there is none")
      .show_default()
      .range(1e-12, 0.5);
  command.option("--report FILE", report, "Write a report with maps of the differences, one HTML file");
  command.flag("--json", json, "Print everything as JSON");
  command.option("--seed N", seed, "Seed of the random numbers");
  command.option("--size WxH", size, "Size of the picture in pixels");
  add_threads_option(command, threads);
  command.flag("--quiet", quiet, "Print nothing but errors; the exit status is the result");
  command
      .option("--inject FACTOR", inject,
              "Self test: multiply the first renderer's result by this factor, which must be detected")
      .heading("Self test")
      .range(0.0, 1e6);
}

Ref<Job> VerifyOptions::load() const {
  Ref<Job> job = SceneOptions::load();
  const auto change = [&](const char* path, const std::string& expression) {
    if (!expression.empty()) set_path(*job, path, expression);
  };
  change("renderer.samples", samples);
  change("seed", seed);
  if (!size.empty()) {
    int n[2];
    parse_integers(size, 'x', 2, n, "--size", "WxH, such as 640x480");
    change("image.width", std::to_string(n[0]));
    change("image.height", std::to_string(n[1]));
  }
  return job;
}

std::string VerifyOptions::command_line() const {
  std::string text = "etendue verify" + SceneOptions::command_line();
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) text += fmt::format(" {} {}", option, shell_quoted(value));
  };
  const VerifyOptions defaults;
  const auto add_number = [&](const char* option, double value, double by_default) {
    if (value != by_default) add(option, fmt::format("{}", value));
  };
  add("--renderers", renderers);
  if (force) text += " --force";
  add("--samples", samples);
  add_number("--passes", passes, defaults.passes);
  add("--time", time);
  add_number("--lengths", lengths, defaults.lengths);
  add_number("--tile", tile, defaults.tile);
  add_number("--significance", significance, defaults.significance);
  add("--seed", seed);
  add("--size", size);
  add_number("--inject", inject, defaults.inject);
  return text;
}

verify::Collected collect(Render& render, const verify::Choice& choice, const VerifyOptions& options) {
  verify::CollectOptions collecting;
  collecting.passes = options.passes;
  collecting.samples = std::max(1, render.job().renderer->samples / options.passes);
  collecting.inject = options.inject;
  collecting.leave_out_refusing = options.renderers.empty();
  if (!options.time.empty()) collecting.seconds = parse_duration(options.time, "--time");
  const bool show = !options.quiet && isatty(STDERR_FILENO);
  const Interruption interruption(render);
  collecting.go_on = [&](size_t renderer, size_t passes) {
    if (show) {
      fmt::print(stderr, "\r\x1b[K[{}/{}] {}: {} passes", renderer + 1, choice.candidates.size(),
                 choice.candidates[renderer].name, passes);
      std::fflush(stderr);
    }
    return !Interruption::asked();
  };
  verify::Collected collected = verify::collect(
      render, choice.candidates, options.tile > 0 ? options.tile : verify::default_tile(*render.job().image), collecting);
  if (show) fmt::print(stderr, "\r\x1b[K");
  return collected;
}

int verify_file(const VerifyOptions& options) {
  const Ref<Job> job = options.load();
  if (!options.report.empty()) {
    note_inputs_of(*job);
    OutputFiles files;
    files.add(options.report, {intern("--report"), 0, 0});
    files.raise();
  }
  verify::prepare_picture(*job, options.lengths + 1);
  Render render(job, {.threads = options.threads});

  verify::Choice choice = verify::choose_renderers(*job, options.renderers, options.force);
  verify::require_two(choice);
  if (const std::string name = verify::without_lengths(choice); !name.empty()) {
    render.edit(*render.job().image, "path_lengths", Value(Number{0}));
    if (!options.quiet)
      fmt::print(stderr, "note: path lengths are not tested apart, as {} does not report its light by path length\n", name);
  }
  const verify::Collected collected = collect(render, choice, options);
  if (!collected.complete) {
    fmt::print(stderr, "interrupted: no verdict\n");
    return exit_status::interrupted;
  }
  verify::leave_out_refused(choice, collected);
  const verify::Agreement agreement = verify::compare(collected.layout, collected.measured, options.significance);
  if (!options.report.empty()) {
    const Ref<ToneMap> tone_map = verify::display_tone_map(*job);
    const std::string html =
        verify::html_report({options.file, options.command_line(), tone_map.get()}, choice, collected, agreement);
    write_whole_file(options.report, html.data(), html.size());
  }
  if (options.json)
    fmt::print("{}", verify::results_json(choice, collected, agreement));
  else if (!options.quiet)
    fmt::print("{}", verify::results_text(choice, collected, agreement));
  return agreement.disagrees() ? exit_status::failed : exit_status::done;
}

}  // namespace

void add_verify_command(Command& program) {
  Command command = program.add_command("verify", "Test whether renderers agree on a scene, and show where they do not");
  auto options = std::make_shared<VerifyOptions>();
  options->add_to(command);
  command.footer(
      "\nExamples\n"
      "  etendue verify scenes/cornell_box.etd --size 64x64 --samples 256\n"
      "  etendue verify box.etd --renderers 'PathTracer,PathTracer{next_event: false}' --report box.html\n"
      "  etendue verify box.etd --time 1m --json\n"
      "\nWhole renders with independent random numbers are compared by tiles and path lengths. Exit status: 0 no disagreement, "
      "1 disagreement, 2 bad input. docs/verify.md describes the statistics.");
  command.runs([options] { return verify_file(*options); });
}

}  // namespace etendue
