#include "group_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "group_nodes.h"
#include "operations.h"
#include "references.h"

namespace etendue::osl {
namespace {

/// Whether part of a shader calls a function of the library whose signature begins so.
class Calls {
 public:
  explicit Calls(std::string_view signature) : signature_(signature) {}

  bool in(const Shader& shader) const {
    if (shader.body && in(*shader.body)) return true;
    return std::any_of(shader.functions.begin(), shader.functions.end(),
                       [&](const auto& f) { return f->body && in(*f->body); });
  }

 private:
  bool in(const Statement& s) const {
    if ((s.expression && in(*s.expression)) || (s.step && in(*s.step)) || (s.body && in(*s.body)) ||
        (s.otherwise && in(*s.otherwise)))
      return true;
    if (s.kind == Statement::Kind::declaration && s.symbol->initial && in(*s.symbol->initial)) return true;
    return std::any_of(s.statements.begin(), s.statements.end(), [&](const auto& inner) { return inner && in(*inner); });
  }
  bool in(const Expression& e) const {
    if (e.row && std::string_view(e.row->signature).starts_with(signature_)) return true;
    return std::any_of(e.operands.begin(), e.operands.end(), [&](const auto& operand) { return operand && in(*operand); });
  }
  std::string_view signature_;
};

/// Whether values of one type are assigned to another by a connection.
bool connectable(const Type& from, const Type& to) {
  if (from.closure != to.closure) return false;
  if (from.is_structure() || to.is_structure()) {
    if (!from.is_structure() || !to.is_structure() || from.array != to.array) return false;
    const auto &a = from.structure->fields, &b = to.structure->fields;
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Field& x, const Field& y) { return connectable(x.type, y.type) && x.offset == y.offset; });
  }
  if (from.is_array() != to.is_array()) return false;
  if (from.is_array() && from.array != to.array && to.array != Type::unsized) return false;
  if (from.base == to.base || (from.triple_based() && to.triple_based())) return true;
  return !from.is_array() && ((from.is_float() && to.is_triple()) || (from.is_int() && (to.is_float() || to.is_triple())) ||
                              (from.is_float() && to.is_int()));
}

}  // namespace

GroupBuilder::GroupBuilder(const GroupDescription& description, const GroupOptions& options,
                           std::vector<GroupProblem>& problems)
    : description_(description), options_(options), problems_(problems), group_(new ShaderGroup) {
  group_->name_ = intern_string(description.name);
}

std::shared_ptr<const ShaderGroup> GroupBuilder::build() {
  const auto failed = [&] {
    return std::any_of(problems_.begin(), problems_.end(), [](const GroupProblem& p) { return !p.warning; });
  };
  load_layers();
  for (int i = 0; i < int(plans_.size()); ++i) set_parameters(i);
  for (const ConnectionText& connection : description_.connections) connect(connection);
  if (group_->layers_.empty() && !failed()) error("a shader group without layers", {});
  if (failed()) return nullptr;
  for (int i = 0; i < int(plans_.size()); ++i) set_unsized(i);
  mark_outputs();
  find_needed_derivatives();
  find_lazy_layers();
  if (failed()) return nullptr;
  int layer = -1;  // which is built: errors without a place get its shader's
  try {
    std::uint32_t flags = std::uint32_t(plans_.size());
    for (const LayerPlan& plan : plans_) flags += std::uint32_t(plan.symbols.size());
    group_->flags_ = group_->layout_.bytes(flags, 1, MemoryLayout::Use::shared);
    group_->flag_count_ = flags;
    for (int i = 0; i < int(plans_.size()); ++i) place_symbols(i);
    for (layer = 0; layer < int(plans_.size()); ++layer) build_layer(layer);
  } catch (const Error& e) {
    const bool placed = e.location.known() || layer < 0;
    error(e.what(), placed ? e.location : group_->layers_[std::size_t(layer)].shader->place);
    return nullptr;
  }
  return group_;
}

// ---- the description
// -------------------------------------------------------------------------------------------------------------

void GroupBuilder::load_layers() {
  for (const LayerText& text : description_.layers) {
    std::shared_ptr<const Shader> shader = options_.load(text.shader, text.at);
    if (!shader) {
      error(fmt::format("Could not find shader \"{}\"", text.shader), text.at);
      continue;
    }
    ShaderGroup::Layer layer;
    layer.name = intern_string(text.name);
    layer.shader_name = intern_string(shader->name);
    layer.shader = shader;
    LayerPlan plan;
    plan.text = &text;
    for (const auto& symbol : shader->symbols) {
      SymbolPlan s;
      s.type = symbol->type;
      if (s.type.array == Type::unsized && symbol->initial && symbol->initial->type.array > 0)
        s.type.array = symbol->initial->type.array;
      plan.symbols.push_back(std::move(s));
    }
    plan.interpolated.resize(plan.symbols.size());
    for (const Symbol* parameter : shader->parameters) {
      const Metadatum* locked = parameter->find("lockgeom");
      const Metadatum* interpolated = parameter->find("interpolated");
      plan.interpolated[std::size_t(parameter->index)] =
          (locked && locked->value.type.is_int() && locked->value.at<int>() == 0) ||
          (interpolated && interpolated->value.type.is_int() && interpolated->value.at<int>() != 0);
    }
    group_->layers_.push_back(std::move(layer));
    plans_.push_back(std::move(plan));
  }
}

void GroupBuilder::set_parameters(int layer) {
  const auto l = std::size_t(layer);
  LayerPlan& plan = plans_[l];
  for (const ParameterText& parameter : plan.text->parameters) {
    Given given;
    std::string reason;
    const auto type_of = [&](const Symbol& s) { return plan.symbols[std::size_t(s.index)].type; };
    if (!find_part(*group_->layers_[l].shader, parameter.name, type_of, given.part, reason)) {
      problems_.push_back({true, fmt::format("attempting to set nonexistent parameter: {}", parameter.name), parameter.at});
      continue;
    }
    Type type =
        given.part.symbol->type.array == Type::unsized && given.part.offset == 0 ? given.part.symbol->type : given.part.type;
    if (!parse_value(parameter, type, given.bytes, reason)) {
      problems_.push_back({true, reason, parameter.at});
      continue;
    }
    given.part.type = type;
    const auto index = std::size_t(given.part.symbol->index);
    if (given.part.symbol->type.array == Type::unsized) plan.symbols[index].type.array = type.array;
    if (parameter.interpolated) plan.interpolated[index] = true;
    plan.given.push_back(std::move(given));
  }
}

int GroupBuilder::layer_named(const std::string& name) const {
  for (int i = 0; i < int(group_->layers_.size()); ++i)
    if (group_->layers_[std::size_t(i)].name->text() == name) return i;
  return -1;
}

void GroupBuilder::connect(const ConnectionText& text) {
  const int from = layer_named(text.from_layer), to = layer_named(text.to_layer);
  if (from < 0 || to < 0) {
    error(fmt::format("ConnectShaders: {} layer \"{}\" not found", from < 0 ? "source" : "destination",
                      from < 0 ? text.from_layer : text.to_layer),
          text.at);
    return;
  }
  if (from >= to) {
    error(fmt::format("ConnectShaders: layer \"{}\" has to be declared before \"{}\"", text.from_layer, text.to_layer),
          text.at);
    return;
  }
  Link link;
  link.from_layer = from;
  std::string reason;
  const auto types = [&](int layer) {
    return [this, layer](const Symbol& s) { return plans_[std::size_t(layer)].symbols[std::size_t(s.index)].type; };
  };
  const Shader &source = *group_->layers_[std::size_t(from)].shader, &destination = *group_->layers_[std::size_t(to)].shader;
  if (!find_part(source, text.from, types(from), link.from, reason) ||
      !find_part(destination, text.to, types(to), link.to, reason)) {
    error(fmt::format("ConnectShaders: {}", reason), text.at);
    return;
  }
  if (!check_connection(text, link.from, link.to)) return;
  SymbolPlan& target = plans_[std::size_t(to)].symbols[std::size_t(link.to.symbol->index)];
  if (link.to.symbol->type.array == Type::unsized && link.to.offset == 0)
    link.to.type.array = target.type.array = link.from.type.array;
  auto& links = plans_[std::size_t(to)].links;
  std::erase_if(links, [&](const Link& old) {
    return old.to.symbol == link.to.symbol && old.to.offset == link.to.offset && old.to.type == link.to.type;
  });
  links.push_back(link);
}

bool GroupBuilder::check_connection(const ConnectionText& text, const ParameterPart& from, const ParameterPart& to) {
  const Metadatum* allowed = to.symbol->find("allowconnect");
  if (allowed && allowed->value.type.is_int() && allowed->value.at<int>() == 0) {
    error(fmt::format("ConnectShaders: cannot connect to {}.{} because it has metadata allowconnect=0", text.to_layer, text.to),
          text.at);
    return false;
  }
  if (from.symbol->role != Symbol::Role::output) {
    error(fmt::format("ConnectShaders: {}.{} is not an output of its shader", text.from_layer, text.from), text.at);
    return false;
  }
  if (!connectable(from.type, to.type)) {
    error(fmt::format("ConnectShaders: cannot connect a {} ({}) to a {} ({})", from.type.name(), text.from, to.type.name(),
                      text.to),
          text.at);
    return false;
  }
  return true;
}

/// A parameter `T x[]` that nothing has given a length.
void GroupBuilder::set_unsized(int layer) {
  const auto& l = group_->layers_[std::size_t(layer)];
  for (const Symbol* parameter : l.shader->parameters) {
    SymbolPlan& plan = plans_[std::size_t(layer)].symbols[std::size_t(parameter->index)];
    if (plan.type.array == Type::unsized) plan.type.array = 1;
  }
}

// ---- what has to be computed
// -----------------------------------------------------------------------------------------------------

void GroupBuilder::mark_outputs() {
  for (const std::string& wanted : options_.outputs) {
    const size_t dot = wanted.find('.');
    const std::string layer = dot == std::string::npos ? "" : wanted.substr(0, dot);
    const std::string name = dot == std::string::npos ? wanted : wanted.substr(dot + 1);
    for (int i = int(plans_.size()) - 1; i >= 0; --i) {
      if (!layer.empty() && group_->layers_[std::size_t(i)].name->text() != layer) continue;
      const Symbol* symbol = group_->layers_[std::size_t(i)].shader->find_parameter(name);
      if (!symbol) continue;
      wanted_.emplace_back(i, symbol);
      plans_[std::size_t(i)].symbols[std::size_t(symbol->index)].connected |= 2;
      break;
    }
  }
}

bool GroupBuilder::whole(const ParameterPart& part, int layer) const {
  return part.offset == 0 &&
         part.type.size() == plans_[std::size_t(layer)].symbols[std::size_t(part.symbol->index)].type.size();
}

void GroupBuilder::find_needed_derivatives() {
  std::vector<std::vector<const Symbol*>> wanted(plans_.size());
  if (options_.output_derivatives)
    for (const auto& [layer, symbol] : wanted_) wanted[std::size_t(layer)].push_back(symbol);
  for (std::size_t l = plans_.size(); l-- > 0;) {
    const Shader& shader = *group_->layers_[l].shader;
    // Later layers, and the renderer, may take derivatives of a global that is assigned here.
    for (const Symbol* global : shader.globals)
      if (global && global->written && global->global != Global::Ci) wanted[l].push_back(global);
    const std::vector<bool> needed = find_derivatives(shader, wanted[l]);
    for (std::size_t i = 0; i < needed.size(); ++i)
      plans_[l].symbols[i].derivatives = needed[i] && carries_derivatives(plans_[l].symbols[i].type);
    for (const Link& link : plans_[l].links)
      if (plans_[l].symbols[std::size_t(link.to.symbol->index)].derivatives)
        wanted[std::size_t(link.from_layer)].push_back(link.from.symbol);
  }
}

void GroupBuilder::find_lazy_layers() {
  for (std::size_t l = 0; l < plans_.size(); ++l) {
    ShaderGroup::Layer& layer = group_->layers_[l];
    for (const Symbol* global : layer.shader->globals)
      if (global && global->written && (global->global != Global::Ci || !options_.lazy_globals)) layer.lazy = false;
    if (!options_.lazy_errors && Calls("void error(").in(*layer.shader)) layer.lazy = false;
    if (!options_.lazy_trace && Calls("int trace(").in(*layer.shader)) layer.lazy = false;
    if (std::any_of(wanted_.begin(), wanted_.end(), [&](const auto& w) { return w.first == int(l); })) layer.lazy = false;
  }
  group_->layers_.back().lazy = false;
  for (const std::string& name : description_.entries) {
    const int i = layer_named(name);
    if (i < 0)
      error(fmt::format("the entry layer \"{}\" is no layer of the group", name), {});
    else
      group_->entries_.push_back(i);
  }
  if (options_.outputs_only) {
    group_->entries_.clear();
    for (const auto& [layer, symbol] : wanted_) group_->entries_.push_back(layer);
    return;
  }
  if (description_.entries.empty())
    for (int i = 0; i < int(plans_.size()); ++i)
      if (!group_->layers_[std::size_t(i)].lazy) group_->entries_.push_back(i);
}

// ---- memory
// ----------------------------------------------------------------------------------------------------------------------

void GroupBuilder::place_symbols(int layer) {
  LayerPlan& plan = plans_[std::size_t(layer)];
  const Shader& shader = *group_->layers_[std::size_t(layer)].shader;
  for (const Symbol* global : shader.globals) {
    if (!global) continue;
    SymbolPlan& s = plan.symbols[std::size_t(global->index)];
    const int offset = global_offset(name_of(global->global));
    s.memory = {s.type, std::uint32_t(offset), carries_derivatives(s.type) ? std::uint32_t(s.type.size()) : 0};
    s.placed = true;
  }
  for (const Symbol* parameter : shader.parameters) place_parameter(layer, *parameter);
}

void GroupBuilder::place_parameter(int layer, const Symbol& parameter) {
  const auto index = std::size_t(parameter.index);
  LayerPlan& plan = plans_[std::size_t(layer)];
  SymbolPlan& s = plan.symbols[index];
  bool linked = false;
  for (const Link& link : plan.links) {
    if (link.to.symbol != &parameter) continue;
    linked = true;
    if (whole(link.to, layer))
      s.connected |= 1;
    else
      s.connected_parts.emplace_back(link.to.offset, 1);
  }
  for (const LayerPlan& later : plans_)
    for (const Link& link : later.links) {
      if (link.from.symbol != &parameter || link.from_layer != layer) continue;
      if (whole(link.from, layer))
        s.connected |= 2;
      else
        s.connected_parts.emplace_back(link.from.offset, 2);
    }
  if (plan.interpolated[index] && options_.userdata_is_connected) s.connected |= 1;
  const bool given = std::any_of(plan.given.begin(), plan.given.end(),
                                 [&](const Given& g) { return g.part.symbol == &parameter && whole(g.part, layer); });
  const bool fixed = given || !parameter.initial || parameter.initial->kind == Expression::Kind::constant;
  const bool input = parameter.role == Symbol::Role::parameter && !parameter.written;
  s.constant = fixed && input && !linked && !plan.interpolated[index];
  // The derivatives of a constant are zero, for which no memory is needed.
  s.memory = group_->layout_.allocate(s.type, s.derivatives && !s.constant,
                                      s.constant ? MemoryLayout::Use::constant : MemoryLayout::Use::shared);
  s.placed = true;
  group_->layers_[std::size_t(layer)].parameters.emplace_back(&parameter, s.memory);
  if (parameter.initial && parameter.initial->kind == Expression::Kind::constant) {
    const auto& bytes = parameter.initial->constant.bytes;
    std::memcpy(group_->layout_.at(s.memory).data(), bytes.data(), std::min(bytes.size(), s.type.size()));
  }
  for (const Given& g : plan.given)
    if (g.part.symbol == &parameter)
      std::memcpy(group_->layout_.at(s.memory).data() + g.part.offset, g.bytes.data(),
                  std::min(g.bytes.size(), s.type.size() - g.part.offset));
  if (!linked) return;
  std::vector<FetchParameter::Transfer> transfers;
  for (const Link& link : plan.links) {
    if (link.to.symbol != &parameter) continue;
    const Memory& source = plans_[std::size_t(link.from_layer)].symbols[std::size_t(link.from.symbol->index)].memory;
    const Value from{
        {link.from.type, source.offset + link.from.offset, carries_derivatives(link.from.type) ? source.stride : 0}, nullptr};
    const Memory to{link.to.type, s.memory.offset + link.to.offset, carries_derivatives(link.to.type) ? s.memory.stride : 0};
    const bool numbers = !from.type().is_array() && !from.type().is_structure();
    transfers.push_back(
        {link.from_layer, numbers ? conversion_node(group_->nodes_, from, to) : copy_node(group_->nodes_, from, to)});
  }
  const std::uint32_t flag = group_->flags_ + std::uint32_t(plans_.size()) + flag_base(layer) + std::uint32_t(parameter.index);
  s.fetch = group_->nodes_.make<FetchParameter>(flag, std::move(transfers));
}

std::uint32_t GroupBuilder::flag_base(int layer) const {
  std::uint32_t base = 0;
  for (int i = 0; i < layer; ++i) base += std::uint32_t(plans_[std::size_t(i)].symbols.size());
  return base;
}

// ---- nodes
// -----------------------------------------------------------------------------------------------------------------------

/// What gives a parameter its value when the layer begins; null if it is in the frame's image already, or fetched when it is
/// read.
const Node* GroupBuilder::start_of(int layer, LayerBuilder& builder, const Symbol& parameter) {
  const auto index = std::size_t(parameter.index);
  const LayerPlan& plan = plans_[std::size_t(layer)];
  const SymbolPlan& s = plan.symbols[index];
  if (s.constant) return nullptr;
  NodeStore& nodes = group_->nodes_;
  MemoryLayout& layout = group_->layout_;
  const bool linked_wholly = (s.connected & 1) != 0 && s.fetch;
  const Node* start = nullptr;
  if (!linked_wholly) {
    const bool given = std::any_of(plan.given.begin(), plan.given.end(),
                                   [&](const Given& g) { return g.part.symbol == &parameter && whole(g.part, layer); });
    if (given || !parameter.initial || parameter.initial->kind == Expression::Kind::constant) {
      // The image holds the value; what the shader or a connection made of it is undone.
      const auto bytes = layout.at(s.memory);
      const std::vector<std::byte> copy(bytes.begin(), bytes.end());
      start = copy_node(nodes, {layout.constant(s.type, copy), nullptr}, s.memory);
    } else {
      start = builder.default_value(parameter);
      for (const Given& g : plan.given)
        if (g.part.symbol == &parameter)
          start = both(nodes, start,
                       copy_node(nodes, {layout.constant(g.part.type, g.bytes), nullptr},
                                 {g.part.type, s.memory.offset + g.part.offset, s.memory.stride}));
    }
  }
  if (plan.interpolated[index] && !linked_wholly)
    start = both(nodes, start, nodes.make<InterpolatedParameter>(intern_string(parameter.name), s.memory));
  // An output that is connected from above is brought at once: the shader may assign it before it reads it.
  if (s.fetch && parameter.role == Symbol::Role::output) start = both(nodes, start, s.fetch);
  return start;
}

void GroupBuilder::build_layer(int i) {
  ShaderGroup::Layer& layer = group_->layers_[std::size_t(i)];
  group_->layout_.keep_apart();
  LayerBuilder builder(*layer.shader, plans_[std::size_t(i)].symbols, group_->layout_, group_->nodes_);
  for (const Symbol* parameter : layer.shader->parameters)
    if (const Node* start = start_of(i, builder, *parameter)) layer.defaults.push_back(start);
  layer.body = builder.body();
}

std::shared_ptr<const ShaderGroup> ShaderGroup::build(const GroupDescription& description, const GroupOptions& options,
                                                      std::vector<GroupProblem>& problems) {
  return GroupBuilder(description, options, problems).build();
}

}  // namespace etendue::osl
