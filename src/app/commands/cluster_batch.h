#pragma once
// Batch files for Slurm, by which an array of jobs renders the passes of a picture and one more job merges their parts.

#include <cstdint>
#include <string>
#include <vector>

namespace etendue {

/// A render that is divided among the tasks of a job array.
struct BatchRender {
  std::string name;            ///< of jobs, batch files, logs and parts
  std::string program;         ///< its path on the machines that render
  std::string render_options;  ///< what follows `etendue render`, quoted for a shell, with a blank before each
  std::string merge_options;   ///< likewise what follows the parts of `etendue image merge`
  std::uint32_t passes = 1, parts = 1;
  std::vector<std::string> slurm_options;  ///< as sbatch takes them: "--partition=fast"
};

/// The file to which a task of the array saves its part; `task` is a number, or the shell's name of one.
std::string part_file(const BatchRender&, const std::string& task);
/// The batch file of the array. A task that is preempted, or whose time is up, saves its part and goes on when Slurm starts it
/// again.
std::string array_script(const BatchRender&);
/// The batch file of the job that merges the parts.
std::string merge_script(const BatchRender&);

}  // namespace etendue
