#pragma once
// GroupBuilder: makes a ShaderGroup of its description.

#include "layer_builder.h"
#include "shader_group.h"

namespace etendue::osl {

/// A parameter of a layer, or a part of it: "C", "C[1]", "s.x".
struct ParameterPart {
  const Symbol* symbol = nullptr;
  std::uint32_t offset = 0;  ///< [bytes] in the value
  Type type;
};

/// Finds a part by its name. Returns false and sets `reason` if there is none. `whole` is the type of the symbol's value.
bool find_part(const Shader&, const std::string& path, const std::function<Type(const Symbol&)>& whole, ParameterPart& out,
               std::string& reason);

/// The bytes of a stated value for a parameter of type `type`, whose unsized length is set. Returns false and sets `reason`.
bool parse_value(const ParameterText&, Type& type, std::vector<std::byte>& bytes, std::string& reason);

class GroupBuilder {
 public:
  GroupBuilder(const GroupDescription&, const GroupOptions&, std::vector<GroupProblem>&);
  std::shared_ptr<const ShaderGroup> build();

 private:
  struct Given {
    ParameterPart part;
    std::vector<std::byte> bytes;
  };
  struct Link {
    int from_layer = 0;
    ParameterPart from, to;
  };
  struct LayerPlan {
    const LayerText* text = nullptr;
    std::vector<SymbolPlan> symbols;
    std::vector<Given> given;
    std::vector<bool> interpolated;
    std::vector<Link> links;
  };

  void error(std::string text, Location at) { problems_.push_back({false, std::move(text), at}); }
  void load_layers();
  void set_parameters(int layer);
  void set_unsized(int layer);
  void connect(const ConnectionText&);
  bool check_connection(const ConnectionText&, const ParameterPart& from, const ParameterPart& to);
  void mark_outputs();
  void find_needed_derivatives();
  void find_lazy_layers();
  void place_symbols(int layer);
  void place_parameter(int layer, const Symbol&);
  void build_layer(int layer);
  const Node* start_of(int layer, LayerBuilder&, const Symbol&);
  int layer_named(const std::string&) const;
  std::uint32_t flag_base(int layer) const;
  bool whole(const ParameterPart&, int layer) const;

  const GroupDescription& description_;
  const GroupOptions& options_;
  std::vector<GroupProblem>& problems_;
  std::shared_ptr<ShaderGroup> group_;
  std::vector<LayerPlan> plans_;
  std::vector<std::pair<int, const Symbol*>> wanted_;  // outputs for the renderer
};

}  // namespace etendue::osl
