#pragma once
// Network: the layers and connections of a group of shaders, gathered from objects of the description.
//
// An object of a class that is a shader is a layer. A map that is the value of one of its members is a layer above it: as such
// if it is an output of a shader, which then is connected to the parameter, with its derivatives; else by a small shader of
// ours that asks for the map's value. Layers run when a parameter that they are connected to is first read.

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "etendue/object_map.h"
#include "map_inputs.h"
#include "osl/closures/closure_models.h"
#include "osl/running/shader_group.h"

namespace etendue::osl {

class OslPart;

class Network {
 public:
  /// Adds the layer of an object after those that it needs, once. Returns the layer's name. Throws Error at the member that is
  /// to blame.
  std::string add(const OslPart&);
  /// Adds a layer of a shader with its defaults. Returns its name.
  std::string add(std::shared_ptr<const Shader>);
  /// Adds layers and connections in the text form (group_description.h). A shader is a class of a plugin, or a file
  /// NAME.osl in the folders. Throws Error with the place.
  void add_text(std::string_view text, const std::string& file, const std::vector<std::string>& folders);
  /// Adds "layer.output -> layer.parameter". Throws Error at `at`.
  void connect(const std::string& text, Location at);

  /// Builds the group, with the layer `last` as the last one. `options` names the outputs. Throws Error, of which only those
  /// that have no place of their own have to get one.
  std::shared_ptr<const ShaderGroup> build(const std::string& name, const std::string& last, GroupOptions options);

  /// What all layers together may do.
  const ClosureUses& uses() const { return uses_; }
  /// Whether light may go through the surface into the body.
  bool lets_in() const { return lets_in_; }
  /// Whether a layer names the direction from which it is seen.
  bool depends_on_view() const { return depends_on_view_; }
  /// Whether what the layers compute may be different at different points.
  bool varies() const { return varies_; }
  /// Whether a layer asks for the wavelengths themselves.
  bool needs_wavelengths() const { return needs_wavelengths_; }
  const MapInputs& maps() const { return maps_; }
  /// The shader of a layer; null if there is no such layer.
  std::shared_ptr<const Shader> shader_of(const std::string& layer) const;
  /// The last layer that was added; empty: there is none.
  std::string last() const { return description_.layers.empty() ? std::string() : description_.layers.back().name; }

 private:
  void add_layer(LayerText, std::shared_ptr<const Shader>);
  void add_map(const OslPart&, const std::string& member, const Symbol& parameter, const Ref<ObjectMap>& map, LayerText& layer,
               std::vector<ConnectionText>& connections);
  void sort(const std::string& last);
  std::string free_name(const std::string& wanted) const;

  GroupDescription description_;
  std::map<std::string, std::shared_ptr<const Shader>> shaders_;  // by layer
  std::map<const OslPart*, std::string> parts_;                   // their layers
  std::map<std::pair<const ObjectMap*, bool>, std::string> map_layers_;
  MapInputs maps_;
  ClosureUses uses_;
  bool depends_on_view_ = false, varies_ = false, lets_in_ = false, needs_wavelengths_ = false;
};

}  // namespace etendue::osl
