// etendue cluster submit FILE: renders a file on the machines of a cluster that Slurm administers.

#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>

#include "app/render_options.h"
#include "cluster_batch.h"
#include "describe/guard.h"
#include "etendue/language/language.h"
#include "files/input_files.h"
#include "files/whole_file.h"
#include "render/checkpoint.h"
#include "render/parallel_schedule.h"

namespace etendue {

namespace {

struct SubmitOptions : RenderOptions {
  int parts = 0, nodes = 0;
  std::vector<std::string> slurm;
  std::string program;
  bool dry_run = false, wait = false;
};

/// The number of passes. Throws Error for renders that cannot be divided into parts.
std::uint32_t passes_of(Job& job) {
  if (!job.renderer || !job.image) throw Error("the file describes no renderer or no image");
  if (job.renderer->steps_depend())
    job.renderer->fail({}, "learns from one pass to the next, so its passes cannot be rendered by several machines");
  if (job.time_limit > 0 || job.error_limit > 0)
    throw Error("a limit of time or error would end each part by itself: give the number of samples, and set the limits to 0");
  prepare_tree(*job.image);
  const std::uint32_t usual = samples_per_step(job.image->area());
  const std::uint32_t step = std::max(job.renderer->samples_per_step(usual), 1u);
  return (std::uint32_t(job.renderer->samples) + step - 1) / step;
}

BatchRender batch_of(const SubmitOptions& options, std::uint32_t passes) {
  BatchRender batch;
  batch.name = options.stem();
  if (batch.name.find_first_of(" \t\n%\\\"'") != std::string::npos)
    throw Error(fmt::format(
        "'{}': Slurm takes no blanks, quotes or percent signs in the names of jobs and logs; rename the file", batch.name));
  batch.program = options.program.empty() ? std::filesystem::read_symlink("/proc/self/exe").string() : options.program;
  batch.passes = passes;
  batch.parts = std::min(std::uint32_t(options.parts), passes);
  batch.render_options = options.picture_command().substr(std::string_view("etendue render").size());
  for (const std::string& output : options.outputs) batch.merge_options += " -o " + shell_quoted(output);
  batch.slurm_options = options.slurm;
  batch.nodes = options.nodes;
  return batch;
}

/// Runs a command and returns the first line that it prints. Throws Error if it fails; `what` names it.
std::string first_line_of(const std::string& command, const std::string& what) {
  std::fflush(nullptr);
  FILE* const pipe = popen(command.c_str(), "r");
  if (!pipe) throw Error(fmt::format("cannot run {}", what));
  std::string printed;
  std::array<char, 4096> bytes;
  while (const size_t n = std::fread(bytes.data(), 1, bytes.size(), pipe)) printed.append(bytes.data(), n);
  const int status = pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw Error(
        fmt::format("there is no command {}: is this a machine of the cluster? --dry-run writes the batch files alone", what));
  if (status != 0) throw Error(fmt::format("{} failed", what));
  return printed.substr(0, printed.find('\n'));
}

/// The number of the job that `sbatch --parsable` submits: "17" or "17;cluster".
std::string submitted(const std::string& options, const std::string& script) {
  const std::string line = first_line_of("sbatch --parsable" + options + " " + shell_quoted(script), "sbatch");
  return line.substr(0, line.find(';'));
}

/// A job whose processes render the picture together.
int submit_together(const SubmitOptions& options, Job& job) {
  const BatchRender batch = batch_of(options, 1);
  note_inputs_of(job);
  const std::string script = batch.name + ".render.sbatch", checkpoint = batch.name + ".checkpoint";
  OutputFiles files;
  files.add(script, {});
  files.add(checkpoint, {});
  add_outputs(chosen_outputs(job.outputs, options.outputs), options.stem(), files);
  files.raise();
  write_whole_file(script, mpi_script(batch));
  fmt::print("{}\n", script);
  if (std::filesystem::exists(checkpoint)) fmt::print("{} is there already, and will be continued\n", checkpoint);
  if (options.dry_run) return exit_status::done;
  std::fflush(stdout);
  fmt::print("job {}: the picture\n", submitted(options.wait ? " --wait" : "", script));
  return exit_status::done;
}

int submit(const SubmitOptions& options) {
  if ((options.parts > 0) == (options.nodes > 0))
    throw Error("give either --parts N, for a job array, or --nodes N, for one job that renders by MPI");
  const Ref<Job> job = options.load();
  if (options.nodes > 0) return submit_together(options, *job);
  const BatchRender batch = batch_of(options, passes_of(*job));
  note_inputs_of(*job);
  const std::string array = batch.name + ".render.sbatch", merge = batch.name + ".merge.sbatch";
  OutputFiles files;
  for (const std::string& script : {array, merge}) files.add(script, {});
  for (std::uint32_t i = 0; i < batch.parts; ++i) files.add(part_file(batch, std::to_string(i)), {});
  add_outputs(chosen_outputs(job->outputs, options.outputs), options.stem(), files);
  files.raise();
  write_whole_file(array, array_script(batch));
  write_whole_file(merge, merge_script(batch));
  fmt::print("{}\n{}\n{} pass{} in {} part{}\n", array, merge, batch.passes, batch.passes == 1 ? "" : "es", batch.parts,
             batch.parts == 1 ? "" : "s");
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < batch.parts; ++i) kept += std::filesystem::exists(part_file(batch, std::to_string(i)));
  if (kept > 0) fmt::print("{} of the parts are there already, and will be continued\n", kept);
  if (options.dry_run) return exit_status::done;
  const std::string id = submitted("", array);
  fmt::print("job {}: the parts\n", id);
  std::fflush(stdout);
  const std::string after =
      fmt::format("{} --dependency=afterok:{} --kill-on-invalid-dep=yes", options.wait ? " --wait" : "", id);
  fmt::print("job {}: the picture, when all parts are done\n", submitted(after, merge));
  return exit_status::done;
}

}  // namespace

void add_cluster_command(Command& program) {
  Command cluster = program.add_command("cluster", "Render on the machines of a cluster");
  cluster.require_command();
  Command command =
      cluster.add_command("submit", "Write batch files for Slurm, by which many machines render a picture, and submit them");
  auto options = std::make_shared<SubmitOptions>();
  options->SceneOptions::add_to(command);
  options->add_picture_options(command);
  command.option("--parts N", options->parts, "Into how many parts, tasks of a job array, the passes are divided")
      .range(1, 100000);
  command
      .option("--nodes N", options->nodes,
              "Instead of --parts: render by MPI, with one job that has a process on each of N nodes")
      .range(1, 100000)
      .excludes({"--parts"});
  command.option("--slurm OPTION", options->slurm, "An option for all jobs, as sbatch takes it; may be repeated");
  command.option("--program PATH", options->program, "The program on the machines that render [where this one is]");
  command.flag("--dry-run", options->dry_run, "Write the batch files, submit nothing");
  command.flag("--wait", options->wait, "Wait until the picture is written");
  command.footer(
      "\nExamples\n"
      "  etendue cluster submit box.etd --parts 16 -o box.exr\n"
      "  etendue cluster submit box.etd --parts 16 --slurm=--partition=fast --slurm=--time=1:00:00 --slurm=--cpus-per-task=32\n"
      "  etendue cluster submit box.etd --nodes 8 -o box.exr        with any algorithm, also until --time or --error\n"
      "  etendue cluster submit box.etd --parts 16 --dry-run        and edit box.render.sbatch before 'sbatch "
      "box.render.sbatch'\n"
      "\nSubmit in a folder that all machines share. Parts that are lost or preempted are continued.");
  command.runs([options] { return submit(*options); });
}

}  // namespace etendue
