#include "group_run.h"

#include <fmt/format.h>

#include "core/current_step.h"

namespace etendue::osl {

void RunsGroup::build_group(const Component& self, Network network, const std::string& last, std::vector<std::string> outputs,
                            const std::string& besides) {
  name_ = self.class_info().name;
  if (const Location at = self.location_of(); at.known()) scene_file_ = at.file;
  network_ = std::move(network);
  GroupOptions options;
  options.outputs_only = !outputs.empty();
  if (!besides.empty()) outputs.push_back(besides);
  options.outputs = outputs;
  try {
    group_ = network_.build(name_, last, options);
  } catch (const Error& e) {
    if (e.location.known()) throw;
    self.fail("", e.what());
  }
  needed_ = {};
  for (int i = 0; i < group_->layer_count(); ++i) needed_.add(group_->shader(i));
  if (outputs.empty()) return;
  const auto found = group_->find_output(outputs.front());
  if (!found) self.fail("", fmt::format("there is no output '{}'", outputs.front()));
  output_ = *found;
}

void RunsGroup::refuse_bands() const {
  if (network_.needs_wavelengths()) throw Error(name_ + ": its shader computes with wavelength()");
}

namespace {

/// The memory of the closures of a thread's runs. A map that a shader asks for may run shaders itself, in the middle of the run
/// that asks: only a run that is in no other frees what the runs before it left.
class RunMemory {
 public:
  RunMemory() {
    if (depth++ == 0) memory.reset();
  }
  ~RunMemory() { --depth; }
  RunMemory(const RunMemory&) = delete;
  RunMemory& operator=(const RunMemory&) = delete;

  static thread_local PointMemory memory;

 private:
  static thread_local int depth;
};
thread_local PointMemory RunMemory::memory;
thread_local int RunMemory::depth = 0;

}  // namespace

RunsGroup::Run::Run(const RunsGroup& part, const SurfacePoint& p, const Wavelengths* w)
    : part_(part),
      execution_((part.group_ ? *part.group_ : throw Error(part.name_ + " is used before it is prepared")).execution()),
      from_behind_(set_globals(p, part.needed_, execution_.globals())),
      P_before_(globals().P.value),
      N_before_(globals().N.value) {
  const RunMemory memory;
  RenderServices services(p, w, memory.memory, part.name_, part.scene_file_, part.network_.maps());
  // What a run that was given up leaves is of no use, and its item is dropped.
  if (!execution_.run(services, abort_of_current_step())) execution_.globals().Ci = nullptr;
}

}  // namespace etendue::osl
