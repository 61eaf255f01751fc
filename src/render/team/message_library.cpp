#include "message_library.h"

#include <fmt/format.h>

#include <atomic>
#include <charconv>
#include <cstdlib>
#include <string_view>

#include "etendue/core/error.h"
#include "files/own_library.h"

namespace etendue {
namespace {

constexpr const char* file_name = "libetendue_mpi.so";

constinit std::atomic<MakeMessages> announced = nullptr;

std::string_view variable(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

int number(const char* name) {
  const std::string_view text = variable(name);
  int value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

void announce_messages(MakeMessages make, const char* version) {
  if (std::string_view(version) == ETENDUE_VERSION) announced = make;
}

int processes_started() {
  if (variable("ETENDUE_MPI") == "off") return 1;
  // Open MPI's mpirun; MPICH's mpiexec and srun --mpi=pmi2; srun --mpi=pmix.
  int count = std::max(number("OMPI_COMM_WORLD_SIZE"), number("PMI_SIZE"));
  if (!variable("PMIX_RANK").empty() || !variable("PMI_RANK").empty() || !variable("PMI_FD").empty())
    count = std::max(count, number("SLURM_STEP_NUM_TASKS"));
  return std::max(count, 1);
}

std::unique_ptr<Messages> load_messages() {
  const std::string remedy = "start one process, or set ETENDUE_MPI=off so that each renders by itself";
  if (!announced) {
    if (own_library_path(file_name).empty())
      throw Error(
          fmt::format("this is one of {} processes, but the program was built without MPI ({} is missing; "
                      "libopenmpi-dev or libmpich-dev was not there): {}",
                      processes_started(), file_name, remedy));
    // Shared, as Open MPI's own modules look for its symbols there.
    open_own_library(file_name, fmt::format("MPI ({})", remedy), LibraryNames::shared);
  }
  if (!announced) throw Error(fmt::format("'{}' is not of this version of Étendue", file_name));
  return announced.load()();
}

}  // namespace etendue
