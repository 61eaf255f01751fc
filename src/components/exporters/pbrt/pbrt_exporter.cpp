// PbrtExporter: exports a job as a scene of pbrt-v4.

#include "components/exporters/asked_members.h"
#include "writer.h"

namespace etendue {

namespace pbrt_export {

/// The interior of Surroundings becomes the medium around the camera and outside of all shapes.
void Writer::surroundings() {
  for (const Ref<SceneObject>& object : job.scene->objects) {
    if (!object->surrounds()) continue;
    const Ref<Component> shader = part_of(*object, "shader"), interior = part_of(*object, "interior");
    if (shader) exporting.inexact("the index of surroundings is left out", object.get());
    if (!interior) continue;
    around_ = medium_of(*interior);
    if (around_.empty()) continue;
    out_ += fmt::format("MediumInterface \"\" \"{}\"\n", around_);
    if (number_of(*object, "reach") > 0) exporting.inexact("surroundings go on for ever in pbrt", object.get());
  }
}

std::string Writer::write() {
  const AskedMembers asked;
  surroundings();
  view();
  out_ += "WorldBegin\n";
  out_ += transform_of(job.scene->transform, "ConcatTransform");
  objects(*job.scene, false);
  asked.tell(job, exporting);
  std::string head = "# Written by Etendue for pbrt-v4.\n";
  const std::vector<Error> notes = exporting.notes();
  if (!notes.empty()) head += "# Differences from it:\n";
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
