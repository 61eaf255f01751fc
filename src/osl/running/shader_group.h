#pragma once
// ShaderGroup: a network of shaders, ready to be run at points; and Execution, a run of it.
//
// A layer runs when it is needed: when a connected parameter of a later layer is first read. The last layer always runs, and
// before it those layers that do something by themselves: whose outputs the renderer wants, or which write globals.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compilation.h"
#include "globals.h"
#include "nodes.h"
#include "osl/language/group_description.h"
#include "osl/language/tree.h"

namespace etendue::osl {

/// How a group is built.
struct GroupOptions {
  /// The compiled shader of a name; null if there is none.
  std::function<std::shared_ptr<const Shader>(const std::string& name, Location)> load;
  /// Outputs that the renderer will read: "layer.output", or "output" of the last layer that has it.
  std::vector<std::string> outputs;
  bool outputs_only = false;           ///< runs nothing but what these outputs need
  bool output_derivatives = false;     ///< the renderer reads their derivatives, too
  bool lazy_globals = true;            ///< a layer that only assigns Ci runs if it is needed; false: always
  bool lazy_errors = true;             ///< likewise, one that calls error()
  bool lazy_trace = true;              ///< likewise, one that calls trace()
  bool userdata_is_connected = false;  ///< isconnected() of a parameter that may come from the geometry is 1
};

struct GroupProblem {
  bool warning = false;
  std::string text;
  Location at;
};

class Execution;

class ShaderGroup {
 public:
  ~ShaderGroup();
  /// Builds a group, or returns null if there are errors among the problems.
  static std::shared_ptr<const ShaderGroup> build(const GroupDescription&, const GroupOptions&,
                                                  std::vector<GroupProblem>& problems);

  /// The calling thread's own memory for runs of this group. It exists as long as the group.
  Execution& execution() const;

  const String* name() const { return name_; }
  int layer_count() const { return int(layers_.size()); }
  const String* layer_name(int i) const { return layers_[std::size_t(i)].name; }
  const String* shader_name(int i) const { return layers_[std::size_t(i)].shader_name; }
  const Shader& shader(int i) const { return *layers_[std::size_t(i)].shader; }

  /// Makes the code of the group now, if there is none (see Execute). Throws Error if that is not possible.
  void compile() const { compilation_.finish(); }
  /// Whether runs that begin now are of compiled code.
  bool compiled() const { return compilation_.code() != nullptr; }

  /// Where a run leaves an output: "layer.output", or "output" of the last layer that has one; "Ci" and other globals, too.
  std::optional<Memory> find_output(std::string_view) const;
  /// Where a parameter's value lies in the frame, whatever its role.
  std::optional<Memory> find_parameter(int layer, std::string_view name) const;

 private:
  friend class GroupBuilder;
  friend class Execution;

  struct Layer {
    const String *name = nullptr, *shader_name = nullptr;
    std::shared_ptr<const Shader> shader;
    std::vector<const Node*> defaults;
    const Node* body = nullptr;
    bool lazy = true;
    std::vector<std::pair<const Symbol*, Memory>> parameters;
  };

  ShaderGroup();

  const String* name_;
  std::vector<Layer> layers_;
  std::vector<int> entries_;  ///< layers that are run, in this order
  std::uint32_t flags_ = 0;   ///< offset of the flags: which layers ran, which parameters were fetched
  std::uint32_t flag_count_ = 0;
  MemoryLayout layout_;
  NodeStore nodes_;

  friend class FetchParameter;
  void run_layer(RunState&, int) const;

  std::unique_ptr<GroupCode> make_code() const;
  mutable Compilation compilation_{[this] { return make_code(); }};

  struct Executions;
  std::unique_ptr<Executions> executions_;
};

/// The memory in which a group runs. One thread uses it at a time; runs of it follow one another.
class Execution {
 public:
  /// The group must exist as long as this.
  explicit Execution(const ShaderGroup&);

  /// Shades one point: `globals` is what the renderer knows, and afterwards what the shaders made of it. Closures and other
  /// memory come from services.allocate. Returns false if `abort` was set meanwhile; the results are then undefined. Throws
  /// Error at the place of a loop that seems to be endless (RunState::most_steps).
  bool run(Globals& globals, Services& services, const std::atomic<bool>* abort = nullptr);
  /// The same, of what globals() holds, which a renderer fills without copies.
  bool run(Services& services, const std::atomic<bool>* abort = nullptr);
  Globals& globals() { return *state_.globals; }
  const Globals& globals() const { return *state_.globals; }
  /// Runs some layers alone, by their numbers, in this order. All needed layers run as well, each once.
  bool run(Globals& globals, Services& services, std::span<const int> layers, const std::atomic<bool>* abort = nullptr);

  /// The value of an output of the last run; derivatives lie Memory::stride behind it.
  const std::byte* value(const Memory& m) const { return state_.memory + m.offset; }
  /// Changes a parameter's value for the following runs, if it is no constant.
  std::byte* value(const Memory& m) { return state_.memory + m.offset; }
  const ShaderGroup& group() const { return *group_; }

 private:
  bool run_layers(Services&, std::span<const int> layers, const std::atomic<bool>* abort);

  struct Free {
    void operator()(std::byte* p) const { ::operator delete[](p, std::align_val_t(MemoryLayout::alignment)); }
  };
  /// A group that runs so often on one thread is worth to be compiled.
  static constexpr int often = 256;

  const ShaderGroup* group_;
  int runs_ = 0;  ///< up to `often`
  std::unique_ptr<std::byte[], Free> memory_;
  RunState state_;
};

}  // namespace etendue::osl
