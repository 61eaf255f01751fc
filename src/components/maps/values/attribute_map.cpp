// AttributeMap: values stored with an object's surface, such as the colours of a mesh's vertices.

#include "components/maps/rgb_source.h"
#include "etendue/describe/color.h"
#include "etendue/mesh_facts.h"
#include "etendue/object_map.h"

namespace etendue {
namespace {

class AttributeMap final : public ObjectMap, public RgbSource {
 public:
  static void describe(Description<AttributeMap>& d) {
    d.summary("What an object's surface itself tells, such as the colours of a mesh's vertices.")
        .member<&AttributeMap::name>("name", "",
                                     "of the attribute: \"color\" (red, green and blue of a PLY file's vertices, or the colors "
                                     "of a TriangleMesh), or any other number of a PLY file's vertices by its name there; of "
                                     "NAME_0, NAME_1, ... together: NAME. What its faces have, likewise with face_ before it: "
                                     "\"face_color\"")
        .member<&AttributeMap::color_space>("color_space", "", "primaries and white of an attribute of three numbers",
                                            rgb_space_names())
        .member<&AttributeMap::otherwise>("otherwise", "1", "the map where the object has no such attribute");
  }

  void prepare() override {
    if (name.empty()) fail("name", "the name of an attribute is needed");
    if (!otherwise) fail("otherwise", "a map is needed");
    space_ = &rgb_space(color_space);
    number_ = attribute_number(name);
  }

  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    float values[4];
    const int count = look_up(p, values);
    if (count == 0) return otherwise->color(p, w, use);
    if (count == 1) values[1] = values[2] = values[0];
    if (count == 2) values[2] = 0;
    return rgb_spectrum(*space_, values[0], values[1], values[2], use, w);
  }
  float scalar(const SurfacePoint& p) const override {
    float values[4];
    const int count = look_up(p, values);
    if (count == 0) return otherwise->scalar(p);
    const int channels = std::min(count, 3);  // a fourth value, alpha, is ignored
    float sum = 0;
    for (int i = 0; i < channels; ++i) sum += values[i];
    return sum / float(channels);
  }

  std::string rgb_space_name() const override { return color_space; }
  void rgb(const SurfacePoint& p, float out[3]) const override {
    float values[4];
    const int count = look_up(p, values);
    for (int i = 0; i < 3; ++i) out[i] = count == 0 ? otherwise->scalar(p) : count == 1 ? values[0] : i < count ? values[i] : 0;
  }

  std::string name = "color", color_space = "srgb";
  Ref<ObjectMap> otherwise = etendue::constant(0);

 private:
  int look_up(const SurfacePoint& p, float values[4]) const {
    const MeshFacts* facts = p.object ? p.object->mesh_facts() : nullptr;
    const int count = facts ? facts->attribute(number_, p, values) : 0;
    for (int i = 0; i < count; ++i)
      if (!std::isfinite(values[i])) values[i] = 0;
    return count;
  }

  const RgbSpace* space_ = nullptr;
  int number_ = -1;
};

const Register<AttributeMap> registered;

}  // namespace
}  // namespace etendue
