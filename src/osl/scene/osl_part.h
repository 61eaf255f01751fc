#pragma once
// OslPart: the base of objects of classes that are shaders. It builds the group of the shader and the values of the members,
// and runs it at points.

#include "osl_class.h"
#include "render_services.h"

namespace etendue::osl {

class OslPart : public DeclaredMembers {
 public:
  explicit OslPart(const ClassInfo& info) : info_(info), of_(*static_cast<const OslClass*>(info.declared.get())) {}

  const ClassInfo& info() const { return info_; }
  const OslClass& osl_class() const { return of_; }

 protected:
  /// Builds the group, which afterwards runs at points from all threads. `outputs`: what is read besides Ci; if there are any,
  /// nothing else is run. Throws Error at the member that is to blame.
  void build_group(const Component& self, std::vector<std::string> outputs);

  /// A run of the group at a point, on this thread. Its closures are valid until the next run on the thread.
  class Run {
   public:
    /// `w` may be null where no closure is asked for.
    Run(const OslPart&, const SurfacePoint&, const Wavelengths* w);
    const ClosureNode* Ci() const { return globals_.Ci; }
    const Globals& globals() const { return globals_; }
    const Globals& globals_before() const { return before_; }
    bool from_behind() const { return from_behind_; }
    /// The value of the first of the outputs.
    const std::byte* output() const { return execution_.value(part_.output_); }

   private:
    const OslPart& part_;
    bool from_behind_ = false;
    Globals globals_, before_;
    Execution& execution_;
  };

  /// Whether members have these values in all their components; false if there are none.
  bool all_set(const std::vector<std::pair<std::string, float>>&) const;

  const Memory& output() const { return output_; }
  const RgbSpace& space() const { return *space_; }

 private:
  const ClassInfo& info_;
  const OslClass& of_;
  const RgbSpace* space_ = &rgb_space("srgb");
  std::shared_ptr<const ShaderGroup> group_;
  Memory output_{};
};

}  // namespace etendue::osl
