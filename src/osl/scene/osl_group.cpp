// Networks of shaders in a description: OslGroup, OslGroupEmission, OslGroupVolume and OslGroupMap, made of layers and
// connections, or of the text in which other programs write them.

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "etendue/describe/description.h"
#include "osl/language/compile.h"
#include "osl_emission.h"
#include "osl_map.h"
#include "osl_part.h"
#include "osl_surface.h"
#include "osl_volume.h"

namespace etendue::osl {

namespace {

constexpr const char* layers_text =
    "shaders of which others take outputs: maps of classes that plugins in the language (.osl) made. A layer has the name of "
    "its component, else that of the shader";
constexpr const char* connections_text =
    "which outputs are the values of which parameters, as in \"noise.out -> paint.color\"; a map that is an output may as well "
    "be written as the value of the member itself";
constexpr const char* text_text =
    "instead of layers and connections: the network in the language's own form, 'param TYPE NAME VALUE ; shader NAME LAYER ; "
    "connect LAYER.OUTPUT LAYER.PARAMETER ;'. A shader is NAME.osl in the folder `shaders`, or one that a plugin made a class "
    "of. "
    "The last layer gives the result";
constexpr const char* file_text = "instead: a file with this text; shaders are looked for in its folder first";
constexpr const char* shaders_text = "the folder with the shaders that the text names";

/// The members that these classes have besides the last layer.
struct GroupMembers {
  std::vector<Ref<ObjectMap>> layers;
  std::vector<std::string> connections;
  std::string text;
  FilePath file, shaders;

  /// Gathers the network; returns the last layer.
  /// `otherwise`: the shader of a group without layers.
  std::string gather(const Component& self, Network& network, const char* member, const Component* last,
                     const char* otherwise) const {
    std::error_code ignored;
    if (!shaders.empty() && !std::filesystem::is_directory(shaders.resolved(), ignored))
      self.fail("shaders", fmt::format("there is no folder '{}'", shaders.resolved()));
    if (text.empty() && file.empty() && !last && layers.empty() && connections.empty()) {
      const Compiled c = compile_text(otherwise, "default");
      if (c.failed()) throw Error(to_text(c.diagnostics));
      return network.add(c.shader);
    }
    if (!text.empty() || !file.empty()) return gather_text(self, network, member, last);
    for (const Ref<ObjectMap>& layer : layers) {
      const auto* part = dynamic_cast<const OslPart*>(layer.get());
      if (!part)
        self.fail("layers", fmt::format("a {} is no shader in the language; it can be the value of a member of one",
                                        layer ? layer->class_info().name : std::string("none")));
      network.add(*part);
    }
    const auto* part = dynamic_cast<const OslPart*>(last);
    if (!part)
      self.fail(member, last ? fmt::format("a {} is no shader in the language", last->class_info().name)
                             : std::string("the shader that gives the result is needed"));
    const std::string result = network.add(*part);
    for (const std::string& c : connections) network.connect(c, self.location_of("connections"));
    return result;
  }

 private:
  std::string gather_text(const Component& self, Network& network, const char* member, const Component* last) const {
    const char* own = text.empty() ? "file" : "text";
    if (!text.empty() && !file.empty()) self.fail("file", "is given besides `text`; only one way of saying it can count");
    if (!layers.empty() || !connections.empty() || last)
      self.fail(own, fmt::format("is given besides layers, connections or {}; only one way of saying it can count", member));
    std::string content = text, name;
    std::vector<std::string> folders;
    try {
      if (!file.empty()) {
        name = file.resolved();
        std::ifstream in(name, std::ios::binary);
        if (!in) throw Error(fmt::format("cannot open '{}'", name));
        std::ostringstream all;
        all << in.rdbuf();
        content = all.str();
        folders.push_back(std::filesystem::path(name).parent_path().string());
      }
      if (!shaders.empty()) folders.push_back(shaders.resolved());
      network.add_text(content, name, folders);
    } catch (const Error& e) {
      // Places in a text within the description are those of the text, which begins where the member does.
      if (!file.empty() && e.location.known()) throw;
      const std::string at = e.location.line > 0 ? fmt::format("line {}, column {}: ", e.location.line, e.location.column) : "";
      self.fail(own, at + e.what());
    }
    if (network.last().empty()) self.fail(own, "no layer is in it: 'shader NAME LAYER ;' adds one");
    return network.last();
  }
};

template <class T>
void describe_group(Description<T>& d) {
  d.group("Network")
      .template member<&T::layers>("layers", "", layers_text)
      .template member<&T::connections>("connections", "", connections_text)
      .group("As text")
      .template member<&T::text>("text", "", text_text)
      .template member<&T::file>("file", "", file_text)
      .template member<&T::shaders>("shaders", "", shaders_text);
}

class OslGroup final : public GroupSurface, public GroupMembers {
 public:
  using Parent = etendue::Shader;
  static void describe(Description<OslGroup>& d) {
    d.summary("A surface that is a network of shaders in the Open Shading Language.")
        .template member<&OslGroup::surface>(
            "surface", "",
            "the last layer, whose closures are the surface; of a group without any layer it is a grey diffuse one");
    describe_group(d);
  }
  void prepare() override {
    Network network;
    const std::string last = gather(*this, network, "surface", surface.get(), "surface grey() { Ci = 0.5 * diffuse(N); }");
    build_surface(*this, std::move(network), last);
  }
  Ref<etendue::Shader> surface;
};

class OslGroupEmission final : public GroupEmission, public GroupMembers {
 public:
  using Parent = EmissionShader;
  static void describe(Description<OslGroupEmission>& d) {
    d.summary("Light that is a network of shaders in the Open Shading Language.")
        .template member<&OslGroupEmission::emission>(
            "emission", "",
            "the last layer, whose closures are the light; of a group without any layer it is white, of radiance 1");
    describe_group(d);
  }
  void prepare() override {
    Network network;
    const std::string last = gather(*this, network, "emission", emission.get(), "surface white() { Ci = emission(); }");
    build_group(*this, std::move(network), last, {});
  }
  Ref<EmissionShader> emission;
};

class OslGroupVolume final : public GroupVolume, public GroupMembers {
 public:
  using Parent = VolumeShader;
  static void describe(Description<OslGroupVolume>& d) {
    d.summary("A participating medium that is a network of shaders in the Open Shading Language.")
        .template member<&OslGroupVolume::volume>(
            "volume", "", "the last layer, whose closures are the medium; of a group without any layer it is a grey mist")
        .template member<&OslGroupVolume::bound>(bound_name, "1/m", bound_text, at_least(0), soft(0, 1000));
    describe_group(d);
  }
  void prepare() override {
    Network network;
    const std::string last =
        gather(*this, network, "volume", volume.get(), "volume mist() { Ci = anisotropic_vdf(color(0.75), color(1), 0); }");
    build_volume(*this, std::move(network), last, bound);
  }
  Ref<VolumeShader> volume;
  float bound = 0;
};

class OslGroupMap final : public GroupMap, public GroupMembers {
 public:
  using Parent = ObjectMap;
  static void describe(Description<OslGroupMap>& d) {
    d.summary("A map that is an output of a network of shaders in the Open Shading Language, or its displacement.")
        .template member<&OslGroupMap::map>("map", "", "the last layer; a group without any layer is 0.5")
        .template member<&OslGroupMap::output>(
            "output", "", "the output that is the map's value; empty: that which the last layer chooses, or its first one");
    describe_group(d);
  }
  void prepare() override {
    Network network;
    const std::string last = gather(*this, network, "map", map.get(), "shader grey(output color value = 0.5) { }");
    const std::shared_ptr<const Shader> shader = network.shader_of(last);
    std::string wanted = output;
    if (wanted.empty()) {
      if (const auto* part = dynamic_cast<const OslPart*>(map.get()))
        wanted = part->map_output();
      else if (shader->kind != Shader::Kind::displacement)
        for (const Symbol* s : shader->parameters)
          if (wanted.empty() && s->role == Symbol::Role::output) wanted = s->name;
    }
    if (wanted.empty() && shader->kind != Shader::Kind::displacement)
      fail("output", fmt::format("the last layer, of the shader '{}', has no output", shader->name));
    const Symbol* symbol = wanted.empty() ? nullptr : shader->find_parameter(wanted);
    if (!wanted.empty() && (!symbol || symbol->role != Symbol::Role::output))
      fail("output", fmt::format("the shader '{}' has no output '{}'", shader->name, wanted));
    build_map(*this, std::move(network), last, wanted.empty() ? wanted : last + "." + wanted);
  }
  Ref<ObjectMap> map;
  std::string output;
};

const Register<OslGroup> registered_surface;
const Register<OslGroupEmission> registered_emission;
const Register<OslGroupVolume> registered_volume;
const Register<OslGroupMap> registered_map;

}  // namespace

}  // namespace etendue::osl
