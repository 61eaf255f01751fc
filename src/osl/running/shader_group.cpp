#include "shader_group.h"

#include <tbb/enumerable_thread_specific.h>

#include <cstring>

#include "group_nodes.h"

namespace etendue::osl {

struct ShaderGroup::Executions {
  tbb::enumerable_thread_specific<std::unique_ptr<Execution>> of_threads;
};

ShaderGroup::ShaderGroup() : name_(empty_string()), layout_(sizeof(Globals)), executions_(std::make_unique<Executions>()) {}
ShaderGroup::~ShaderGroup() = default;

Execution& ShaderGroup::execution() const {
  std::unique_ptr<Execution>& own = executions_->of_threads.local();
  if (!own) own = std::make_unique<Execution>(*this);
  return *own;
}

std::optional<Memory> ShaderGroup::find_parameter(int layer, std::string_view name) const {
  for (const auto& [symbol, memory] : layers_[std::size_t(layer)].parameters)
    if (symbol->name == name) return memory;
  return std::nullopt;
}

std::optional<Memory> ShaderGroup::find_output(std::string_view wanted) const {
  const std::size_t dot = wanted.find('.');
  const std::string_view layer = dot == std::string_view::npos ? "" : wanted.substr(0, dot);
  const std::string_view name = dot == std::string_view::npos ? wanted : wanted.substr(dot + 1);
  for (int i = layer_count() - 1; i >= 0; --i)
    if (layer.empty() || layer_name(i)->view() == layer)
      if (const auto memory = find_parameter(i, name)) return memory;
  if (const int offset = global_offset(name); offset >= 0 && layer.empty()) {
    const bool number = name == "u" || name == "v" || name == "time" || name == "dtime";
    const Type type = name == "Ci" ? Type::closure_color()
                      : number
                          ? Type(Base::float_)
                          : Type(name[0] == 'N' ? Base::normal : (name == "P" || name == "Ps" ? Base::point : Base::vector));
    return Memory{type, std::uint32_t(offset), type.is_closure() ? 0 : std::uint32_t(type.size())};
  }
  return std::nullopt;
}

void ShaderGroup::run_layer(RunState& run, int i) const {
  std::byte& ran = run.memory[flags_ + std::size_t(i)];
  if (ran != std::byte{0}) return;
  ran = std::byte{1};
  const int before = std::exchange(run.layer, i);
  if (const LayerCode* code = compilation_.code()) {
    code[i](&run, run.memory, &run.services);
    run.layer = before;
    return;
  }
  const Layer& layer = layers_[std::size_t(i)];
  try {
    for (const Node* node : layer.defaults) node->run(run);
    if (layer.body) layer.body->run(run);
  } catch (const ExitLayer&) {
  }
  run.layer = before;
}

std::unique_ptr<GroupCode> ShaderGroup::make_code() const {
  const Machine* const compiler = machine();
  if (!compiler) throw Error("there is no compiler of shaders here");
  CodeRequest request{name_->text(), layout_, layer_count(), {}};
  request.emit = [this](Code& code, int i) {
    const Layer& layer = layers_[std::size_t(i)];
    for (const Node* node : layer.defaults) node->emit(code);
    if (layer.body) layer.body->emit(code);
  };
  return compiler->compile(request);
}

Flow FetchParameter::run(RunState& run) const {
  std::byte& fetched = run.memory[flag_];
  if (fetched != std::byte{0}) return Flow::next;
  fetched = std::byte{1};
  for (const Transfer& transfer : transfers_) {
    run.group->run_layer(run, transfer.layer);
    transfer.copy->run(run);
  }
  return Flow::next;
}

// The values lie in the frame, of which no layer has copies of its own.
void FetchParameter::emit(Code& code) const {
  const Code::Label first = code.label(), done = code.label();
  code.branch(code.flag(flag_), done, first);
  code.begin(first);
  code.interpret(*this);
  code.jump(done);
  code.begin(done);
}

Flow InterpolatedParameter::run(RunState& run) const {
  run.services.attribute(nullptr, name_, -1, memory_.type, memory_.derivatives(), run.memory + memory_.offset);
  return Flow::next;
}

Execution::Execution(const ShaderGroup& group) : group_(&group) {
  const auto& image = group_->layout_.image();
  memory_.reset(static_cast<std::byte*>(
      ::operator new[](std::max<std::size_t>(image.size(), 1), std::align_val_t(MemoryLayout::alignment))));
  std::memcpy(memory_.get(), image.data(), image.size());
  state_.memory = memory_.get();
  state_.group = group_;
  state_.globals = reinterpret_cast<Globals*>(memory_.get());
}

bool Execution::run(Globals& globals, Services& services, const std::atomic<bool>* abort) {
  return run(globals, services, group_->entries_, abort);
}

bool Execution::run(Globals& globals, Services& services, std::span<const int> layers, const std::atomic<bool>* abort) {
  std::memcpy(state_.memory, static_cast<const void*>(&globals), sizeof(Globals));
  const bool complete = run_layers(services, layers, abort);
  std::memcpy(static_cast<void*>(&globals), state_.memory, sizeof(Globals));
  return complete;
}

bool Execution::run(Services& services, const std::atomic<bool>* abort) {
  return run_layers(services, group_->entries_, abort);
}

bool Execution::run_layers(Services& services, std::span<const int> layers, const std::atomic<bool>* abort) {
  if (runs_ < often) {
    const Execute mode = execution_mode();
    if (mode == Execute::compiler) group_->compile();
    if (++runs_ == often && mode == Execute::automatic) group_->compilation_.begin();
  }
  std::memset(state_.memory + group_->flags_, 0, group_->flag_count_);
  state_.world = &services;
  state_.abort = abort;
  state_.steps = 0;
  state_.messages.clear();
  state_.layer = 0;
  bool complete = true;
  try {
    for (const int layer : layers) group_->run_layer(state_, layer);
  } catch (const RunAborted&) {
    complete = false;
  }
  return complete;
}

}  // namespace etendue::osl
