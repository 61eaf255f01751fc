// MitsubaExporter: scenes in the XML of Mitsuba 3.

#include "writer.h"

namespace etendue {
namespace {

class MitsubaExporter final : public Exporter {
 public:
  static void describe(Description<MitsubaExporter>& d) {
    d.summary(
        "Writes scenes of Mitsuba 3 (.xml), with meshes as PLY files beside. What Mitsuba does not have is noted. Its spectral "
        "variants make the same pictures.",
        "Jakob et al., Mitsuba 3 documentation, scene XML file format");
  }

  std::vector<std::string> extensions() const override { return {"xml"}; }
  std::string write(const Job& job, Exporting& exporting) const override {
    return mitsuba_export::Writer(job, exporting).write();
  }
};

const Register<MitsubaExporter> registered;

}  // namespace
}  // namespace etendue
