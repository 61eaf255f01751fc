// etendue render FILE: renders descriptions to their images.

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/fireflies.h"
#include "app/interruption.h"
#include "app/program_team.h"
#include "app/progress_display.h"
#include "app/python_plugins.h"
#include "app/render_options.h"
#include "app/tev.h"
#include "app/text.h"
#include "check/replay/replay.h"
#include "check/warnings/advice.h"
#include "check/warnings/scene_warnings.h"
#include "core/number_text.h"
#include "etendue/describe/registry.h"
#include "etendue/language/language.h"
#include "files/input_files.h"
#include "files/whole_file.h"
#include "render/checkpoint.h"
#include "render/denoising.h"
#include "render/team/message_library.h"
#include "render_series.h"
#include "render_team.h"

namespace etendue {

namespace {

int replay(const Ref<Job>& job, const RenderOptions& options) {
  int pixel[2];
  parse_integers(options.pixel, ',', 2, pixel, "--pixel", "X,Y");
  if (!options.replay.empty()) {
    note_inputs_of(*job);
    OutputFiles files;
    files.add(options.replay, {intern("--replay"), 0, 0});
    files.raise();
  }
  const Render render(job, options.settings());
  const PixelReplay paths = options.sample ? replay_sample(render, pixel[0], pixel[1], *options.sample)
                                           : replay_pixel(render, pixel[0], pixel[1], size_t(options.paths));
  const std::string command = options.picture_command();
  if (!options.replay.empty()) {
    const std::string json = replay_json(*job, paths, options.file, command);
    write_whole_file(options.replay, json.data(), json.size());
  }
  if (!options.quiet) fmt::print("{}", replay_text(paths, command));
  return exit_status::done;
}

std::string_view kind_text(BadSample::Kind kind) {
  switch (kind) {
    case BadSample::Kind::not_a_number: return "not a number";
    case BadSample::Kind::infinite: return "infinite";
    case BadSample::Kind::negative: return "negative";
  }
  return "";
}

void report_bad_samples(const Render& render, const RenderOptions& options) {
  const Film& film = render.film();
  if (film.bad_samples() == 0) return;
  const std::string refusal = replay_refusal(render);
  fmt::print(stderr, "{} of {} samples were negative or not finite; they count as black. {}:\n", grouped(film.bad_samples()),
             grouped(film.samples()),
             refusal.empty() ? "To see the path of one" : fmt::format("No path can be shown ({})", refusal));
  constexpr size_t most = 5;
  const auto& first = film.first_bad_samples();
  for (size_t i = 0; i < std::min(first.size(), most); ++i) {
    const BadSample& bad = first[i];
    const std::string which = refusal.empty() ? replay_command(options.picture_command(), bad.x, bad.y, bad.sample) + "   "
                                              : fmt::format("pixel {},{}", bad.x, bad.y);
    fmt::print(stderr, "  {} # {}\n", which, kind_text(bad.kind));
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

/// With --passes: the passes that were rendered, and their part of the whole render.
std::string passes_text(const Render& render) {
  const std::optional<IndexRange>& passes = render.settings().steps;
  if (!passes) return "";
  const std::uint32_t step = render.samples_per_step();
  std::vector<std::string> made;
  std::uint32_t count = 0;
  for (const IndexRange& done : render.samples_done()) {
    const std::uint32_t begin = std::max(done.begin / step, passes->begin),
                        end = std::min((done.end + step - 1) / step, passes->end);
    if (begin >= end) continue;
    made.push_back(fmt::format("{}:{}", begin, end));
    count += end - begin;
  }
  const std::string asked =
      count < passes->end - passes->begin ? fmt::format(" ({}:{} were requested)", passes->begin, passes->end) : "";
  return fmt::format("passes {}{} of 0:{}, {} sample{} per pixel each\n",
                     made.empty() ? "none" : fmt::format("{}", fmt::join(made, ", ")), asked,
                     (std::uint32_t(render.job().renderer->samples) + step - 1) / step, step, step == 1 ? "" : "s");
}

/// The files that were written.
struct Written {
  std::vector<std::string> pictures, denoised;
  std::vector<Error> errors;  ///< of files that could not be written
  std::string choice;         ///< of a renderer that chooses an algorithm, in a sentence; empty: none did
};

/// What each process of a team has done, for who wants to know where its time goes.
nlohmann::ordered_json efforts_json(const ProcessTeam& team) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const std::vector<Effort> efforts = team.efforts();
  for (size_t rank = 0; rank < efforts.size(); ++rank)
    list.push_back({{"name", team.name_of(int(rank))},
                    {"sent_bytes", efforts[rank].bytes},
                    {"sent_messages", efforts[rank].messages},
                    {"calls", efforts[rank].calls},
                    {"item_seconds", efforts[rank].items},
                    {"message_seconds", efforts[rank].post},
                    {"processor_seconds", efforts[rank].all}});
  return list;
}

void report_result(const Progress& progress, Ended ended, const Written& written, ProgressDisplay::Kind kind,
                   const Render& render, const RenderOptions& options) {
  const std::string& checkpoint = render.settings().checkpoint_file;
  if (kind == ProgressDisplay::Kind::json) {
    nlohmann::ordered_json json = {{"event", "done"},
                                   {"outputs", written.pictures},
                                   {"seconds", progress.seconds},
                                   {"samples", progress.samples},
                                   {"samples_per_second", progress.samples_per_second},
                                   {"bad_samples", render.film().bad_samples()},
                                   {"ended", name(ended)}};
    if (!written.denoised.empty()) json["denoised"] = written.denoised;  // all denoised images are biased
    if (!checkpoint.empty()) json["checkpoint"] = checkpoint;
    if (!written.choice.empty()) json["choice"] = written.choice;
    if (render.settings().steps || options.team) json["samples_per_pass"] = render.samples_per_step();
    if (const auto* team = dynamic_cast<const ProcessTeam*>(options.team)) json["processes"] = efforts_json(*team);
    fmt::print("{}\n", json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else if (!options.quiet) {
    for (const std::string& path : written.pictures) fmt::print("{}\n", path);
    for (const std::string& path : written.denoised) fmt::print("{}\n", path);
    fmt::print("{} sample{} per pixel in {}, {:.2f} Msamples/s{}\n{}", progress.samples, progress.samples == 1 ? "" : "s",
               duration_text(progress.seconds), progress.samples_per_second * 1e-6, reason_text(ended), passes_text(render));
    if (!written.choice.empty()) fmt::print("{} chose {}\n", render.job().renderer->class_info().name, written.choice);
    const bool early = ended == Ended::interrupted || ended == Ended::aborted;
    if (early && render.samples_done().empty())
      fmt::print("no pass was finished, so nothing was written\n");
    else if (early && !checkpoint.empty())
      fmt::print("to resume: {}\n", options.resume_command());
  }
  std::fflush(stdout);
}

/// Checks all files that will be written, before hours are spent on the render.
void require_outputs(const Job& job, const std::vector<Ref<Output>>& outputs, const RenderOptions& options, Series& series) {
  note_inputs_of(job);
  OutputFiles files;
  add_outputs(outputs, options.stem(), files);
  const std::string checkpoint_option = !options.continue_file.empty() ? "--continue"
                                        : options.checkpoint.empty()   ? "--resume"
                                                                       : "--checkpoint";
  if (const std::string& checkpoint = options.checkpoint_file(); !checkpoint.empty())
    files.add(checkpoint, {intern(checkpoint_option), 0, 0}, options.resumed_file());
  files.raise();
  series.claim(outputs, options);
}

int render(const RenderOptions& options, Series& series) {
  const std::optional<TevAddress> tev = options.tev.empty() ? std::nullopt : std::optional(parse_tev_address(options.tev));
  TeamRender with_others(options);
  const InputsRead inputs;
  const Ref<Job> job = options.load();
  if (!options.pixel.empty()) return replay(job, options);

  // With --passes the render is incomplete, so the description's outputs are not written.
  RenderSettings settings = options.settings();
  std::vector<Ref<Output>> outputs;
  if (!settings.steps || !options.outputs.empty()) outputs = chosen_outputs(job->outputs, options.outputs);
  number_outputs(outputs, options);
  if (!options.frame)
    for (const std::string& file : options.outputs)
      if (file.find('#') != std::string::npos)
        warn(fmt::format("'{}': '#' stands for the number of a frame only with --frames or --frame", file),
             {intern("--output"), 0, 0});
  if (options.denoise && outputs.empty())
    throw Error("there is no picture to denoise: with --passes, only pictures that -o names are written",
                {intern("--denoise"), 0, 0});
  if (options.denoise) outputs = with_denoising(outputs);
  require_outputs(*job, outputs, options, series);
  require_denoisers(outputs);
  // This comes after the check of the outputs, because images read by are_whole count as input files.
  if (options.skip_existing && are_whole(outputs, *job, options)) return exit_status::done;
  const ProgressDisplay::Kind kind = ProgressDisplay::kind_for(options.progress, options.quiet);
  ProgressDisplay display(kind, options.open_ended());
  settings.on_progress = [&](const Progress& progress) { display.show(progress); };
  // The outputs that will be written are prepared; a checkpoint stores those of the description, whatever -o says.
  std::vector<Ref<Output>> described = std::exchange(job->outputs, outputs);
  Render render(job, settings);
  job->outputs = std::move(described);
  with_others.send_scene(inputs, options);
  with_others.leave_word(options, outputs);
  show_warnings(scene_warnings(*job));
  warn_of_wide_filter(*job, outputs);
  advise(*job);
  if (options.fireflies > 0) render.film().keep_largest(size_t(options.fireflies));

  Ended ended;
  Written written;
  Image picture;
  {
    const Interruption interruption(render);
    if (const std::string resumed = options.resumed_file(); !resumed.empty()) render.load(resumed);
    std::optional<TevDisplay> shown;
    if (tev) shown.emplace(render, *tev, options.stem());
    ended = render.run();
    display.clear();
    picture = render.picture();
    if (const auto choice = picture.metadata.find("choice"); choice != picture.metadata.end()) written.choice = choice->second;
    const bool early = ended == Ended::interrupted || ended == Ended::aborted;
    if (!early || (!options.in_series && !render.samples_done().empty())) {
      written.pictures = write_each(outputs, *job, picture, options.stem(), written.errors);
      written.denoised = write_denoised(*job, outputs, picture, options.stem(), settings.threads, written.errors);
    }
    if (shown) shown->finish(ended != Ended::aborted);  // after the files are written, as a slow viewer may block
  }

  if (const std::string failure = render.checkpoint_failure(); !failure.empty()) written.errors.emplace_back(failure);
  if (!written.pictures.empty()) show_warnings(picture_warnings(*job, outputs, picture));
  report_bad_samples(render, options);
  report_result(display.last(), ended, written, kind, render, options);
  if (options.fireflies > 0 && ended != Ended::aborted)
    report_fireflies(render, options.picture_command(), kind == ProgressDisplay::Kind::json ? stderr : stdout);
  for (const Error& error : written.errors) fmt::print(stderr, "{}\n", show(error));
  if (!written.errors.empty()) return exit_status::failed;
  return ended == Ended::interrupted || ended == Ended::aborted ? exit_status::interrupted : exit_status::done;
}

/// The processes that render together with this one.
ProcessTeam* join_others(const RenderOptions& options) {
  // Plugins in Python start the program again (python_plugins.h), which is only possible before it is connected.
  if (processes_started() > 1)
    for (const std::string& plugin : options.plugins)
      if (plugin.ends_with(".py") && std::filesystem::exists(plugin)) Registry::instance().load_plugin(plugin);
  ProcessTeam* const team = join_team();
  if (team) refuse_restarts();
  return team;
}

}  // namespace

void add_render_command(Command& program) {
  Command command = program.add_command("render", "Render files to the pictures they name");
  auto options = std::make_shared<RenderOptions>();
  options->add_to(command);
  command.footer(
      "\nExamples\n"
      "  etendue render scenes/cornell_box.etd                    as the file says\n"
      "  etendue render box.etd -o box.png -o box.exr             to these files instead\n"
      "  etendue render box.etd -D samples=16 --size 160x120      with a param replaced, small\n"
      "  etendue render box.etd --set renderer.max_depth=2        direct light only\n"
      "  etendue render box.etd --time 5m                         five minutes' worth of samples\n"
      "  etendue render box.etd --denoise                         and box.denoised.png beside box.png\n"
      "  etendue render box.etd --pixel 17,40 --sample 3          the path of one sample, vertex by vertex\n"
      "  etendue render box.etd --pixel 17,40                     the brightest paths of a pixel\n"
      "  etendue render box.etd --fireflies 10                    and where the brightest samples are\n"
      "  etendue render box.etd --continue box.checkpoint         start, or resume after any interruption\n"
      "  etendue render a.etd b.etd                               one after the other, each to its own pictures\n"
      "  etendue render film.etd --frames 0:120 -o film.####.png  120 pictures of 5 seconds\n"
      "  etendue render film.etd --frames 0:120 --skip-existing   those that are not there yet\n"
      "  etendue render box.etd --passes 0:8 --checkpoint a.part  a part, for 'etendue image merge'\n"
      "\nThe first Ctrl-C ends the render after the current pass and writes what there is, a second one leaves this pass out.\n"
      "The picture depends on the file and the seed alone, never on the number of threads.");
  command.runs([options] {
    ProcessTeam* const team = join_others(*options);
    options->team = team;
    if (team && !team->leads()) return follow_renders(*options, *team);
    return render_series(*options, [](const RenderOptions& one, Series& series) { return render(one, series); });
  });
}

}  // namespace etendue
