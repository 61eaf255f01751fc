#pragma once
// Witness: a small process that outlives this one if it is killed, to tidy up and to tell.
//
// Open MPI ends all processes without a word when mpirun is killed: what they print would go to mpirun, which is not there any
// more. And nobody can catch SIGKILL.

#include <string>

namespace etendue {

class Witness {
 public:
  /// What is done when this process ends before the destructor is called.
  struct Task {
    std::string remove;  ///< this folder is removed; empty: none
    /// This text is written to this file if the process that started this one has ended, too; otherwise that one tells. Empty:
    /// nothing is written.
    std::string file, text;
  };
  /// A file that was left by an earlier one is removed. If no process can be started, nothing will be done.
  explicit Witness(const Task&);
  /// The task is not needed any more.
  ~Witness();
  /// The task is done now.
  void act();
  Witness(const Witness&) = delete;
  Witness& operator=(const Witness&) = delete;

 private:
  int pipe_ = -1;  ///< the witness reads the other end, which ends when this process does
  int process_ = -1;
};

}  // namespace etendue
