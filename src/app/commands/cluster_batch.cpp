#include "cluster_batch.h"

#include <fmt/format.h>

#include "app/scene_options.h"

namespace etendue {

namespace {

/// Seconds before the end of a job's time at which its task is told to save its part.
constexpr int notice = 120;

std::string slurm_lines(const BatchRender& batch) {
  std::string lines;
  for (const std::string& option : batch.slurm_options) lines += "#SBATCH " + option + "\n";
  return lines;
}

}  // namespace

std::string part_file(const BatchRender& batch, const std::string& task) { return batch.name + "." + task + ".part"; }

std::string array_script(const BatchRender& batch) {
  std::string text = fmt::format(
      R"(#!/bin/sh
# Written by 'etendue cluster submit': each task of the array renders some of the passes into a part.
#SBATCH --job-name={}
#SBATCH --array=0-{}
#SBATCH --output={}.%a.log
#SBATCH --open-mode=append
#SBATCH --requeue
#SBATCH --signal=B:USR1@{}
)",
      batch.name, batch.parts - 1, batch.name, notice);
  text += slurm_lines(batch);
  text += fmt::format(
      R"(
begin=$(({0} * SLURM_ARRAY_TASK_ID / {1}))
end=$(({0} * (SLURM_ARRAY_TASK_ID + 1) / {1}))

# The time is almost up (USR1), or the job is preempted or cancelled (TERM): the render ends after its pass and saves its part.
# Slurm itself requeues what it preempts.
signalled=
time_is_up=
trap 'signalled=yes; time_is_up=yes; kill -TERM $render' USR1
trap 'signalled=yes; kill -TERM $render' TERM

{2} render{3} --progress none --threads "${{SLURM_CPUS_ON_NODE:-0}}" \
  --passes $begin:$end --continue {4} &
render=$!
wait $render
status=$?
while [ -n "$signalled" ] && [ $status -gt 128 ]; do
  signalled=
  wait $render # the shell's wait ends at a signal, before the render does
  status=$?
done
# {5}: interrupted, with its part saved; 143: before it had begun.
if [ -n "$time_is_up" ] && {{ [ $status = {5} ] || [ $status = 143 ]; }}; then
  exec scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID"
fi
exit $status
)",
      batch.passes, batch.parts, shell_quoted(batch.program), batch.render_options,
      shell_quoted(batch.name) + part_file({}, "$SLURM_ARRAY_TASK_ID"), exit_status::interrupted);
  return text;
}

std::string mpi_script(const BatchRender& batch) {
  std::string text = fmt::format(
      R"(#!/bin/sh
# Written by 'etendue cluster submit': a process on each node, which render the picture together.
#SBATCH --job-name={0}
#SBATCH --nodes={1}
#SBATCH --ntasks-per-node=1
#SBATCH --output={0}.log
#SBATCH --open-mode=append
#SBATCH --requeue
#SBATCH --signal=USR1@{2}
)",
      batch.name, batch.nodes, notice);
  text += slurm_lines(batch);
  // Since Slurm 22.05 srun does not take --cpus-per-task from the job.
  text += fmt::format(
      R"(
srun --mpi="${{ETENDUE_SRUN_MPI:-pmix}}" --cpus-per-task="${{SLURM_CPUS_PER_TASK:-${{SLURM_CPUS_ON_NODE:-1}}}}" \
  {0} render{1}{2} --progress none --continue {3}
status=$?
# {4}: the time is almost up (USR1), and the checkpoint is saved. Slurm itself requeues what it preempts.
if [ $status = {4} ]; then
  exec scontrol requeue "$SLURM_JOB_ID"
fi
exit $status
)",
      shell_quoted(batch.program), batch.render_options, batch.merge_options, shell_quoted(batch.name + ".checkpoint"),
      exit_status::interrupted);
  return text;
}

std::string merge_script(const BatchRender& batch) {
  std::string text = fmt::format(
      R"(#!/bin/sh
# Written by 'etendue cluster submit': merges the parts into the picture.
#SBATCH --job-name={0}.merge
#SBATCH --output={0}.merge.log
)",
      batch.name);
  text += slurm_lines(batch);
  text += "\nexec " + shell_quoted(batch.program) + " image merge";
  for (std::uint32_t i = 0; i < batch.parts; ++i) text += " \\\n  " + shell_quoted(part_file(batch, std::to_string(i)));
  return text + batch.merge_options + "\n";
}

}  // namespace etendue
