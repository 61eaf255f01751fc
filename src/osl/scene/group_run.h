#pragma once
// RunsGroup: the second base of parts whose values are what a group of shaders computes at a point.

#include "etendue/describe/bands.h"
#include "network.h"
#include "render_services.h"

namespace etendue::osl {

class RunsGroup : public NeedsWavelengths {
 public:
  void refuse_bands() const final;

 protected:
  /// Builds the group, which afterwards runs at points from all threads. `last`: the layer that gives the result. `outputs`:
  /// what is read; if there are any, nothing else is run. `besides`: an output that is read besides
  /// Ci, instead. Throws Error; `self` is to blame where nothing else is.
  void build_group(const Component& self, Network, const std::string& last, std::vector<std::string> outputs,
                   const std::string& besides = {});

  /// A run of the group at a point, on this thread. Its closures are valid until the next run on the thread.
  class Run {
   public:
    /// `w` may be null where no closure is asked for.
    Run(const RunsGroup&, const SurfacePoint&, const Wavelengths* w);
    const ClosureNode* Ci() const { return globals().Ci; }
    const Globals& globals() const { return execution_.globals(); }
    /// What P and N were before the run.
    const Triple& P_before() const { return P_before_; }
    const Triple& N_before() const { return N_before_; }
    bool from_behind() const { return from_behind_; }
    /// The value of the first of the outputs.
    const std::byte* output() const { return execution_.value(part_.output_); }

   private:
    const RunsGroup& part_;
    Execution& execution_;
    bool from_behind_;
    Triple P_before_, N_before_;
  };

  const Memory& output() const { return output_; }
  const RgbSpace& space() const { return *space_; }
  /// Of the class, for messages.
  const std::string& name() const { return name_; }
  const ClosureUses& uses() const { return network_.uses(); }
  const Network& network() const { return network_; }

 private:
  std::string name_;
  const RgbSpace* space_ = &rgb_space("srgb");
  Network network_;
  std::shared_ptr<const ShaderGroup> group_;
  NeededGlobals needed_;
  const char* scene_file_ = "";  ///< that describes the part
  Memory output_{};
};

}  // namespace etendue::osl
