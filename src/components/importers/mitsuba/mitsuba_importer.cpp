// MitsubaImporter: scenes in the XML of Mitsuba 0.4 to 3.

#include "converter.h"
#include "scene_reader.h"

namespace etendue {
namespace {

class MitsubaImporter final : public Importer {
 public:
  static void describe(Description<MitsubaImporter>& d) {
    d.summary(
        "Reads scenes of Mitsuba 0.4 to 3 (.xml). What has no counterpart here is noted at its place, as are properties that "
        "nothing reads.",
        "Jakob et al., Mitsuba 3 documentation, scene XML file format; Jakob 2014, Mitsuba documentation, version 0.5");
  }

  std::vector<std::string> extensions() const override { return {"xml"}; }

  Ref<Component> import(Importing& importing) const override {
    mitsuba::SceneReader reader(importing);
    const mitsuba::Element& scene = reader.read();
    return Ref<Component>(mitsuba::Converter(importing).job(scene));
  }
};

const Register<MitsubaImporter> registered;

}  // namespace
}  // namespace etendue
