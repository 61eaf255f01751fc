#pragma once
// Batch files for Slurm: an array of jobs that renders the passes of a picture, one more job that merges their parts; or one
// job whose processes render the picture together.

#include <cstdint>
#include <string>
#include <vector>

namespace etendue {

/// A render that is divided among the tasks of a job array, or among the nodes of a job.
struct BatchRender {
  std::string name;            ///< of jobs, batch files, logs and parts
  std::string program;         ///< its path on the machines that render
  std::string render_options;  ///< what follows `etendue render`, quoted for a shell, with a blank before each
  std::string merge_options;   ///< likewise what follows the parts of `etendue image merge`: -o with the pictures
  std::uint32_t passes = 1, parts = 1;
  int nodes = 0;                           ///< of a job that renders by MPI; 0: a job array
  std::vector<std::string> slurm_options;  ///< as sbatch takes them: "--partition=fast"
};

/// The file to which a task of the array saves its part; `task` is a number, or the shell's name of one.
std::string part_file(const BatchRender&, const std::string& task);
/// The batch file of the array. A task that is preempted, or whose time is up, saves its part and goes on when Slurm starts it
/// again.
std::string array_script(const BatchRender&);
/// The batch file of a job with a process on each of its nodes, which srun starts. When its time is up, or it is preempted, it
/// saves a checkpoint and goes on when Slurm starts it again.
std::string mpi_script(const BatchRender&);
/// The batch file of the job that merges the parts.
std::string merge_script(const BatchRender&);

}  // namespace etendue
