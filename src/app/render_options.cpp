// The options of `etendue render`, and how they change a Job.

#include "render_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "common_options.h"
#include "describe/guard.h"
#include "etendue/denoised_output.h"
#include "etendue/language/language.h"
#include "files/input_files.h"
#include "language/set_path.h"
#include "render/checkpoint.h"
#include "render/denoising.h"
#include "render/file_hash.h"
#include "text.h"

namespace etendue {

void RenderOptions::add_to(Command& command) {
  command.argument("FILE", files, "The render descriptions (.etd, or .json), one after the other").required();
  SceneOptions::add_overrides_to(command);
  command
      .option("--frames A:B[:STEP]", frames,
              "Render frames A to B - 1, with 'frame' and 'time' set in the file; #### in the names of output files is "
              "replaced by the frame number")
      .excludes({"--frame"});
  command.flag("--skip-existing", skip_existing,
               "Skip renders whose pictures exist already, complete and of the same file and options");
  add_picture_options(command);
  command.option("--time TIME", time,
                 "Stop after this time, such as 90s, 5m or 1h30m; without --samples, no number of samples stops it earlier");
  command.option("--error E", error,
                 "Stop when the mean relative standard error of pixels is below this; without --samples, no number of samples "
                 "stops it earlier");
  command.flag("--denoise", denoise,
               "Write a second, denoised picture beside each, NAME.denoised.ENDING, by Open Image Denoise (pip install "
               "pyoidn) unless the file chooses another denoiser");
  add_threads_option(command, threads, ". The picture does not depend on it");
  command.flag("--send-scene", send_scene,
               "Started by mpirun or srun: processes that do not see the file and all it names, or see others, get them from "
               "the first process, in a temporary folder");
  command.flag("--quiet", quiet, "Print nothing but errors and warnings");
  command
      .option("--progress KIND", progress,
              "auto: a bar on a terminal, else a line now and then; bar; json: a JSON object per line on standard output; none")
      .one_of({"auto", "bar", "json", "none"});
  add_checkpoint_options(command);
  command.option("--pixel X,Y", pixel, "Render nothing: compute this pixel's samples and print the brightest paths")
      .excludes({"--denoise", "--output", "--skip-existing", "--checkpoint", "--resume", "--continue", "--every", "--passes"});
  command.option("--sample N", sample, "With --pixel: compute and print this sample alone, from 0").needs("--pixel");
  command.option("--paths N", paths, "With --pixel: how many paths to print [5]")
      .range(1, 1 << 20)
      .needs("--pixel")
      .excludes({"--sample"});
  command.option("--replay FILE", replay, "With --pixel: write the paths to this file, too, as JSON").needs("--pixel");
  command.option("--fireflies N", fireflies, "List the N brightest samples, with the commands to replay them")
      .range(1, 1 << 20)
      .excludes({"--pixel"});
  command.option("--tev HOST[:PORT]", tev, "Show the picture in the viewer tev while it is rendered; default PORT: 14158")
      .excludes({"--pixel"});
}

void RenderOptions::add_picture_options(Command& command) {
  command.option("-o,--output FILE", outputs,
                 "Write to this file instead of those the file names; its ending chooses the format; may be repeated");
  command.option("--renderer R", renderer,
                 "Render by another algorithm: a class, or an expression such as 'PathTracer { max_depth: 8 }'. It inherits "
                 "samples, sampler, light sampler and longest path from the description's, unless it sets its own");
  command.option("--samples N", samples, "Samples per pixel");
  command.option("--seed N", seed, "Seed of the random numbers");
  command.option("--size WxH", size, "Size of the picture in pixels");
  command.option("--crop X0,Y0,X1,Y1", crop, "Render these pixels only; X1 and Y1 are excluded");
}

void RenderOptions::add_checkpoint_options(Command& command) {
  command.option("--checkpoint FILE", checkpoint, "Write checkpoints to this file, from which the render can be resumed");
  command.option("--resume FILE", resume,
                 "Resume from this checkpoint; the result is bit-identical to an uninterrupted render. New checkpoints replace "
                 "it, unless --checkpoint names another file");
  command.option("--continue FILE", continue_file, "--resume this file if it exists, else start with it as --checkpoint")
      .excludes({"--resume", "--checkpoint"});
  command.option("--every TIME", every, "How often the checkpoint is written, at the end of a pass [60s]; 0s: after each");
  command.option("--passes A:B", passes,
                 "Render passes A to B - 1 only, into the checkpoint; 'image merge' combines such parts. Pictures of the part "
                 "are written only if -o names them");
}

std::optional<IndexRange> RenderOptions::parse_passes() const {
  if (passes.empty()) return {};
  const Location at{intern("--passes"), 0, 0};
  int n[2];
  parse_integers(passes, ':', 2, n, "--passes", "A:B, such as 0:16");
  if (n[0] < 0 || n[1] <= n[0]) throw Error(fmt::format("'{}' is not a range of passes: A:B is A to B - 1", passes), at);
  if (checkpoint_file().empty()) throw Error("--passes stores its result in a checkpoint: give --checkpoint as well", at);
  return IndexRange{std::uint32_t(n[0]), std::uint32_t(n[1])};
}

std::string RenderOptions::resumed_file() const {
  std::error_code ignored;
  if (!continue_file.empty()) return std::filesystem::exists(continue_file, ignored) ? continue_file : std::string();
  return resume;
}

const std::string& RenderOptions::checkpoint_file() const {
  return !continue_file.empty() ? continue_file : (checkpoint.empty() ? resume : checkpoint);
}

std::vector<RenderOptions::Override> RenderOptions::overrides() const {
  std::vector<Override> list;
  // A number of samples that is never reached: the limit of time or error ends the render first.
  if (open_ended()) list.push_back({"--time", "renderer.samples", "1000000"});
  if (!samples.empty()) list.push_back({"--samples", "renderer.samples", samples});
  if (!time.empty()) list.push_back({"--time", "time_limit", fmt::format("{} s", parse_duration(time, "--time"))});
  if (!error.empty()) {
    double percent = 0;
    const auto [end, problem] = std::from_chars(error.data(), error.data() + error.size(), percent);
    if (problem == std::errc() && std::string_view(end, error.data() + error.size()) == "%")
      throw Error(fmt::format("'{}' is written {}", error, percent / 100), {intern("--error"), 0, 0});
    list.push_back({"--error", "error_limit", error});
  }
  if (!seed.empty()) list.push_back({"--seed", "seed", seed});
  if (!size.empty()) {
    int n[2];
    parse_integers(size, 'x', 2, n, "--size", "WxH, such as 640x480");
    list.push_back({"--size", "image.width", std::to_string(n[0])});
    list.push_back({"--size", "image.height", std::to_string(n[1])});
  }
  if (!crop.empty()) {
    int n[4];
    parse_integers(crop, ',', 4, n, "--crop", "X0,Y0,X1,Y1");
    list.push_back({"--crop", "image.crop", fmt::format("[{}, {}, {}, {}]", n[0], n[1], n[2], n[3])});
  }
  return list;
}

void RenderOptions::scale_crop(const Job& job, std::vector<Override>& list) const {
  if (size.empty() || !crop.empty() || !job.image || job.image->crop.empty()) return;
  int n[2];
  parse_integers(size, 'x', 2, n, "--size", "WxH, such as 640x480");
  const std::vector<int>& c = job.image->crop;
  const int of[2] = {job.image->width, job.image->height};
  int scaled[4];
  for (size_t i = 0; i < 4; ++i) {
    const double edge = double(c[i]) * n[i % 2] / of[i % 2];
    scaled[i] = int(i < 2 ? std::floor(edge) : std::ceil(edge));
  }
  const auto crop_of = [](const int* r) { return fmt::format("[{}, {}, {}, {}]", r[0], r[1], r[2], r[3]); };
  warn(fmt::format("the crop of the description, {} of {} x {} pixels, becomes {} of {} x {}", crop_of(c.data()), of[0], of[1],
                   crop_of(scaled), n[0], n[1]),
       {intern("--size"), 0, 0});
  // The old crop may lie outside the new image, and the new crop outside the old image; so the crop is emptied before the size
  // changes.
  list.insert(list.begin(), {"--size", "image.crop", "[]"});
  list.push_back({"--size", "image.crop", crop_of(scaled)});
}

Ref<Job> RenderOptions::load_overridden() const {
  // Errors in the command line are thrown before the scene is loaded, which may take long.
  std::vector<Override> list = overrides();
  settings();
  std::vector<SetOption> said = set_options();
  for (const Override& override : list) said.push_back({override.option, override.path});
  require_kept(said);
  Ref<Job> job = SceneOptions::load();
  scale_crop(*job, list);
  std::vector<Error> errors;
  for (const Override& override : list) {
    try {
      language::set_path_from(*job, override.path, override.expression, {intern(override.option), 0, 0});
    } catch (const Errors& several) {
      errors.insert(errors.end(), several.errors.begin(), several.errors.end());
    } catch (const Error& error_) {
      errors.push_back(error_);
    }
  }
  if (!error.empty() && errors.empty() && !(job->error_limit > 0))
    errors.emplace_back(fmt::format("an error of {} is no limit: give one that a picture can reach, such as 0.01", error),
                        Location{intern("--error"), 0, 0});
  if (!errors.empty()) throw Errors(std::move(errors));
  return job;
}

Ref<Job> RenderOptions::load() const {
  // A checkpoint that is none is told before the scene is loaded; it is no input of the picture, so its reading is not noted.
  if (const std::string from = resumed_file(); !from.empty()) read_checkpoint_header(from);
  const InputsRead inputs;
  Ref<Job> job = load_overridden();
  job->metadata["file"] = file;
  job->metadata["file_hash"] = hash_of(*job, inputs.paths());
  job->metadata["command_line"] = picture_command();
  return job;
}

RenderSettings RenderOptions::settings() const {
  RenderSettings settings;
  settings.threads = threads;
  settings.team = team;
  settings.steps = parse_passes();
  settings.checkpoint_file = checkpoint_file();
  if (every.empty()) return settings;
  if (settings.checkpoint_file.empty())
    throw Error("there is no checkpoint to be written: give --checkpoint as well", {intern("--every"), 0, 0});
  settings.checkpoint_interval = every == "0" || every == "0s" ? 0 : parse_duration(every, "--every");
  return settings;
}

std::string RenderOptions::picture_command() const {
  std::string text = "etendue render" + SceneOptions::command_line();
  const std::pair<const char*, const std::string*> rest[] = {{"--samples", &samples}, {"--time", &time}, {"--error", &error},
                                                             {"--seed", &seed},       {"--size", &size}, {"--crop", &crop}};
  for (const auto& [name, value] : rest)
    if (!value->empty()) text += fmt::format(" {} {}", name, shell_quoted(*value));
  if (denoise) text += " --denoise";
  return text;
}

std::string RenderOptions::resume_command() const {
  std::string text = picture_command();
  for (const std::string& output : outputs) text += " -o " + shell_quoted(output);
  if (!passes.empty()) text += " --passes " + passes;
  return text + " --resume " + shell_quoted(checkpoint_file());
}

std::string RenderOptions::stem() const { return stem_of(file) + (frame ? fmt::format(".{:04}", *frame) : std::string()); }

std::string RenderOptions::hash_of(const Job& job, std::set<std::string> read) const {
  // A file of another format may be read by a separate process, which InputsRead does not see.
  read.insert(std::filesystem::absolute(file).string());
  std::vector<std::string> texts;
  for (const std::string& define : defines) texts.push_back("-D" + define);
  if (!renderer.empty()) texts.push_back("--renderer" + renderer);
  for (const std::string& set : sets) texts.push_back("--set" + set);
  if (frame) texts.push_back(fmt::format("--frame{} of {}", *frame, frames_per_second()));
  for (const Override& override : overrides()) texts.push_back(override.path + "=" + override.expression);
  return file_hash(job, std::move(read), texts);
}

namespace {

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

/// The output for a file name, chosen by its extension.
Ref<Output> output_for(const std::string& file) {
  const std::string ending = lower(std::filesystem::path(file).extension().string());
  std::vector<std::string> known;
  for (const ClassInfo* info : Registry::instance().subclasses(*Registry::instance().find("Output"))) {
    const Ref<Output> output = ref_cast<Output>(create(*info));
    if (dynamic_cast<const DenoisedOutput*>(output.get()))
      continue;  // it writes by another output and has that output's extension
    if (output->extension() == ending) return output;
    known.push_back(output->extension());
  }
  throw Error(fmt::format("'{}': no format has the ending '{}'{}; known are {}", file, ending, suggestion(ending, known),
                          fmt::join(known, " ")),
              {intern("--output"), 0, 0});
}

/// The class of the output that a DenoisedOutput writes by; null for other outputs.
const ClassInfo* format_of(const Output& output) {
  const auto* denoised = dynamic_cast<const DenoisedOutput*>(&output);
  return denoised && denoised->output ? &denoised->output->class_info() : nullptr;
}

}  // namespace

std::vector<Ref<Output>> chosen_outputs(const std::vector<Ref<Output>>& described, const std::vector<std::string>& files) {
  std::vector<Ref<Output>> outputs;
  for (const std::string& file : files) {
    Ref<Output> output = output_for(file);
    for (const Ref<Output>& had : described)
      if (had && (&had->class_info() == &output->class_info() || format_of(*had) == &output->class_info())) {
        output = ref_cast<Output>(copy(*had));
        break;
      }
    set(*output, "file", Value(FilePath{file, ""}));
    // The copy's origin still gives the location of the described output's `file`.
    if (!output->origin) output->origin = std::make_unique<Component::Origin>();
    std::erase_if(output->origin->members, [](const auto& member) { return member.first == "file"; });
    output->origin->members.emplace_back("file", Location{intern("--output"), 0, 0});
    outputs.push_back(output);
  }
  if (!outputs.empty()) return outputs;
  return described.empty() ? std::vector{output_for(".default.png")} : described;
}

std::vector<std::string> write_each(const std::vector<Ref<Output>>& outputs, const Job& job, const Image& picture,
                                    const std::string& stem, std::vector<Error>& errors) {
  std::vector<std::string> written;
  for (const Ref<Output>& output : outputs) {
    try {
      written.push_back(write_output(job, *output, picture, stem));
    } catch (const Error& error) {
      errors.push_back(error);
    }
  }
  return written;
}

void add_outputs(const std::vector<Ref<Output>>& outputs, const std::string& stem, OutputFiles& files) {
  for (const Ref<Output>& output : outputs) {
    if (!output) continue;  // an error is thrown when the job is prepared
    const Location at = output->location_of("file");
    files.add(output->path(stem), at.known() ? at : Location{intern("--output"), 0, 0});
  }
  for (const std::string& path : denoised_paths(outputs, stem)) files.add(path, {intern("--denoise"), 0, 0});
}

}  // namespace etendue
