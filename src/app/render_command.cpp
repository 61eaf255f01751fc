// etendue render FILE: from a description to pictures.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/interruption.h"
#include "app/progress_display.h"
#include "app/render_options.h"
#include "app/replay.h"
#include "app/text.h"
#include "etendue/language.h"

namespace etendue {

namespace {

int replay(Job& job, const RenderOptions& options) {
  int pixel[2];
  parse_integers(options.pixel, ',', 2, pixel, "--pixel", "X,Y");
  PathRecord record;
  const Point2 film = job.replay(pixel[0], pixel[1], *options.sample, record);
  fmt::print("pixel {},{} sample {}\n{}", pixel[0], pixel[1], *options.sample, path_text(record, film));
  return exit_status::done;
}

/// Writes each output by itself: when one fails, the others are still written. Returns what was written.
std::vector<std::string> write_all(Job& job, const std::string& stem, std::vector<Error>& errors) {
  std::vector<std::string> written;
  const std::vector<Ref<Output>> outputs = job.outputs;
  for (const Ref<Output>& output : outputs) {
    job.outputs = {output};
    try {
      for (const std::string& path : job.write_outputs(stem)) written.push_back(path);
    } catch (const Error& error) {
      errors.push_back(error);
    }
  }
  job.outputs = outputs;
  return written;
}

std::string_view kind_text(BadSample::Kind kind) {
  switch (kind) {
    case BadSample::Kind::not_a_number: return "not a number";
    case BadSample::Kind::infinite: return "infinite";
    case BadSample::Kind::negative: return "negative";
  }
  return "";
}

void report_bad_samples(const ImageBuffer& image, const RenderOptions& options) {
  if (image.bad_samples() == 0) return;
  fmt::print(stderr, "{} of {} samples were not finite and non-negative; they count as black. To see the path of one:\n",
             grouped(image.bad_samples()), grouped(image.samples()));
  constexpr size_t most = 5;
  const auto& first = image.first_bad_samples();
  for (size_t i = 0; i < std::min(first.size(), most); ++i) {
    const BadSample& bad = first[i];
    fmt::print(stderr, "  {} --pixel {},{} --sample {}    # {}\n", options.picture_command(), bad.x, bad.y, bad.sample,
               kind_text(bad.kind));
  }
}

std::string reason_text(Ended ended) {
  switch (ended) {
    case Ended::samples: return "";
    case Ended::time: return ", stopped by the time limit";
    case Ended::error: return ", stopped by the error limit";
    case Ended::interrupted: return ", interrupted";
    case Ended::aborted: return ", aborted";
  }
  return "";
}

void report_result(const Progress& progress, Ended ended, const std::vector<std::string>& written, ProgressDisplay::Kind kind,
                   const Job& job, bool quiet) {
  if (kind == ProgressDisplay::Kind::json) {
    const nlohmann::ordered_json json = {{"event", "done"},
                                         {"outputs", written},
                                         {"seconds", progress.seconds},
                                         {"samples", progress.samples},
                                         {"samples_per_second", progress.samples_per_second},
                                         {"bad_samples", job.image->bad_samples()},
                                         {"ended", name(ended)}};
    fmt::print("{}\n", json.dump());
  } else if (!quiet) {
    for (const std::string& path : written) fmt::print("{}\n", path);
    fmt::print("{} samples per pixel in {}, {:.2f} Msamples/s{}\n", progress.samples, duration_text(progress.seconds),
               progress.samples_per_second * 1e-6, reason_text(ended));
  }
  std::fflush(stdout);
}

int render(const RenderOptions& options) {
  const Ref<Job> job = options.load();
  if (options.sample) return replay(*job, options);

  prepare_tree(*job);
  check_output_folders(*job);

  const ProgressDisplay::Kind kind = ProgressDisplay::kind_for(options.progress, options.quiet);
  ProgressDisplay display(kind, options.open_ended());
  Ended ended;
  std::vector<Error> errors;
  std::vector<std::string> written;
  {
    const Interruption interruption(*job);
    job->on_progress = [&](const Progress& progress) {
      display.show(progress);
      interruption.remind();
    };
    ended = job->render();
    display.clear();
    if (ended != Ended::aborted) written = write_all(*job, stem_of(options.file), errors);
  }

  report_bad_samples(*job->image, options);
  report_result(display.last(), ended, written, kind, *job, options.quiet);
  for (const Error& error : errors) fmt::print(stderr, "{}\n", show(error));
  if (!errors.empty()) return exit_status::failed;
  return ended == Ended::interrupted || ended == Ended::aborted ? exit_status::interrupted : exit_status::done;
}

}  // namespace

void add_render_command(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("render", "Render a file to the pictures it names");
  auto options = std::make_shared<RenderOptions>();
  options->add_to(*command);
  command->footer(
      "\nExamples\n"
      "  etendue render scenes/cornell_box.etd                    as the file says\n"
      "  etendue render box.etd -o box.png -o box.exr             to these files instead\n"
      "  etendue render box.etd -D samples=16 --size 160x120      with a param replaced, small\n"
      "  etendue render box.etd --set renderer.max_depth=2        direct light only\n"
      "  etendue render box.etd --time 5m                         five minutes' worth of samples\n"
      "  etendue render box.etd --pixel 17,40 --sample 3          the path of one sample, vertex by vertex\n"
      "\nThe first Ctrl-C ends the render after the current pass and writes what there is, a second one aborts it.\n"
      "The picture depends on the file and the seed alone, never on the number of threads.");
  command->callback([options, &run] { run = [options] { return render(*options); }; });
}

}  // namespace etendue
