#include "group_run.h"

#include <fmt/format.h>

#include "render/current_step.h"

namespace etendue::osl {

void RunsGroup::build_group(const Component& self, Network network, const std::string& last, std::vector<std::string> outputs,
                            const std::string& besides) {
  name_ = self.class_info().name;
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
  if (outputs.empty()) return;
  const auto found = group_->find_output(outputs.front());
  if (!found) self.fail("", fmt::format("there is no output '{}'", outputs.front()));
  output_ = *found;
}

void RunsGroup::refuse_bands() const {
  if (network_.needs_wavelengths()) throw Error(name_ + ": its shader computes with wavelength()");
}

RunsGroup::Run::Run(const RunsGroup& part, const SurfacePoint& p, const Wavelengths* w)
    : part_(part),
      globals_(globals_of(p, from_behind_)),
      before_(globals_),
      execution_((part.group_ ? *part.group_ : throw Error(part.name_ + " is used before it is prepared")).execution()) {
  thread_local PointMemory memory;
  memory.reset();
  RenderServices services(p, w, memory, part.name_, part.network_.maps());
  // What a run that was given up leaves is of no use, and its item is dropped.
  if (!execution_.run(globals_, services, abort_of_current_step())) globals_.Ci = nullptr;
}

}  // namespace etendue::osl
