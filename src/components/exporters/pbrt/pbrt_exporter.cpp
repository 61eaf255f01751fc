// PbrtExporter: a job as a scene of pbrt-v4.

#include "writer.h"

namespace etendue {

namespace pbrt_export {

std::string Writer::write() {
  view();
  out_ += "WorldBegin\n";
  out_ += transform_of(job.scene->transform, "ConcatTransform");
  objects(*job.scene, false);
  std::string head = "# Written by Etendue for pbrt-v4.\n";
  const std::vector<Error> notes = exporting.notes();
  if (!notes.empty()) head += "# What is not as there:\n";
  for (const Error& note : notes) {
    std::string words = note.what();
    for (char& c : words)
      if (c == '\n' || c == '\r') c = ' ';
    head += "#   " + words + "\n";
  }
  return head + out_;
}

}  // namespace pbrt_export

namespace {

class PbrtExporter final : public Exporter {
 public:
  static void describe(Description<PbrtExporter>& d) {
    d.summary("Writes scenes of pbrt-v4, whose files end in .pbrt, with meshes and images beside them.");
  }
  std::vector<std::string> extensions() const override { return {"pbrt"}; }
  std::string write(const Job& job, Exporting& exporting) const override { return pbrt_export::Writer(job, exporting).write(); }
};

const Register<PbrtExporter> registered;

}  // namespace

}  // namespace etendue
