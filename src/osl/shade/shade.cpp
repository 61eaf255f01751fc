#include "shade.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>

#include "arguments.h"
#include "description.h"
#include "etendue/core/error.h"
#include "files/whole_file.h"
#include "grid_services.h"
#include "images/image_library.h"
#include "osl/language/compile.h"
#include "osl/running/shader_group.h"

namespace etendue::osl {
namespace {

constexpr int done = 0, bad_input = 2;  // exit status

/// Finds and compiles shaders by name. Errors are printed once.
class Shaders {
 public:
  explicit Shaders(const ShadeArguments& a) : folders_(a.folders) {
    options_.include_folders = a.folders;
    options_.definitions = a.definitions;
  }

  std::shared_ptr<const Shader> load(const std::string& name) {
    const auto [entry, is_new] = loaded_.try_emplace(name);
    if (is_new)
      if (const std::string path = path_of(name); !path.empty()) entry->second = compile(compile_file(path, options_));
    return entry->second;
  }
  void add(const std::string& name, const std::string& text) { loaded_[name] = compile(compile_text(text, name, options_)); }

 private:
  std::string path_of(const std::string& name) const {
    std::vector<std::string> tried{name, name + ".osl"};
    for (const std::string& folder : folders_) tried.push_back(folder + "/" + name + ".osl");
    for (const std::string& path : tried)
      if (std::filesystem::is_regular_file(path)) return path;
    return "";
  }
  std::shared_ptr<const Shader> compile(const Compiled& compiled) const {
    if (!compiled.diagnostics.empty()) {
      std::fflush(stdout);
      std::fputs(to_text(compiled.diagnostics).c_str(), stderr);
    }
    return compiled.shader;
  }

  std::vector<std::string> folders_;
  CompileOptions options_;
  std::map<std::string, std::shared_ptr<const Shader>> loaded_;
};

// ---- images
// ----------------------------------------------------------------------------------------------------------------------

/// The values of one output at all points.
struct Picture {
  ShadeArguments::Output output;
  Memory memory;
  int channels;
  std::vector<float> values;
};

int channels_of(const Type& type) {
  if (type.is_closure() || type.is_structure() || type.base == Base::string) return 0;
  return type.elements() * (type.base == Base::int_ ? 1 : type.floats());
}

void take(Picture& picture, const Execution& execution) {
  const std::byte* value = execution.value(picture.memory);
  for (int i = 0; i < picture.channels; ++i)
    picture.values.push_back(picture.memory.type.base == Base::int_ ? float(reinterpret_cast<const int*>(value)[i])
                                                                    : reinterpret_cast<const float*>(value)[i]);
}

/// Numbers from 0 to 1 as integers up to `most`.
template <class T>
std::vector<T> integers(const std::vector<float>& values, float most) {
  std::vector<T> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float x = std::isnan(values[i]) ? 0 : std::clamp(values[i], 0.0f, 1.0f);
    result[i] = T(x * most + 0.5f);
  }
  return result;
}

void write(const Picture& picture, const ShadeArguments& a) {
  const std::string& type = a.data_type;
  const NumberType number = type == "uint8"    ? NumberType::uint8
                            : type == "uint16" ? NumberType::uint16
                            : type == "half"   ? NumberType::half
                                               : NumberType::single;
  std::vector<ImageHeader::Channel> channels;
  static constexpr const char* names[] = {"R", "G", "B"};
  for (int i = 0; i < picture.channels; ++i)
    channels.push_back(
        {picture.channels == 1 ? "Y" : (picture.channels == 3 ? names[i] : fmt::format("channel{}", i)), number});
  const ImageHeader header(a.width, a.height, channels);
  const std::vector<std::uint8_t> bytes =
      number == NumberType::uint8 ? integers<std::uint8_t>(picture.values, 255) : std::vector<std::uint8_t>();
  const std::vector<std::uint16_t> words =
      number == NumberType::uint16 ? integers<std::uint16_t>(picture.values, 65535) : std::vector<std::uint16_t>();
  PixelValues pixels = std::span<const float>(picture.values);
  if (!bytes.empty()) pixels = std::span<const std::uint8_t>(bytes);
  if (!words.empty()) pixels = std::span<const std::uint16_t>(words);
  const std::string extension = std::filesystem::path(picture.output.file).extension().string();
  const std::vector<unsigned char> file = image_library().encode(extension, header, pixels);
  write_whole_file(picture.output.file, file.data(), file.size());
}

void print_values(const std::vector<Picture>& pictures, int x, int y) {
  fmt::print("Pixel ({}, {}):\n", x, y);
  for (const Picture& picture : pictures) {
    fmt::print("  {} :", picture.output.variable);
    for (std::size_t i = picture.values.size() - std::size_t(picture.channels); i < picture.values.size(); ++i)
      fmt::print(" {:g}", picture.values[i]);
    fmt::print("\n");
  }
}

// ---- the run
// -----------------------------------------------------------------------------------------------------------------------

GroupOptions group_options(const ShadeArguments& a, Shaders& shaders) {
  GroupOptions options;
  options.load = [&](const std::string& name, Location) { return shaders.load(name); };
  for (const auto& output : a.outputs) options.outputs.push_back(output.variable);
  options.userdata_is_connected = a.userdata_is_connected;
  for (const auto& [name, value] : a.options) {
    if (name == "lazyglobals") options.lazy_globals = value != "0";
    if (name == "lazyerror") options.lazy_errors = value != "0";
    if (name == "lazytrace") options.lazy_trace = value != "0";
  }
  return options;
}

bool report(const std::vector<GroupProblem>& problems) {
  std::fflush(stdout);
  for (const GroupProblem& problem : problems) {
    fmt::print(stderr, "{}: {}\n", problem.warning ? "WARNING" : "ERROR", problem.text);
    if (problem.at.line > 0)
      fmt::print(stderr, "        place: {}:{}:{}\n", problem.at.file, problem.at.line, problem.at.column);
  }
  return std::none_of(problems.begin(), problems.end(), [](const GroupProblem& p) { return !p.warning; });
}

std::vector<Picture> find_outputs(const ShadeArguments& a, const ShaderGroup& group) {
  std::vector<Picture> pictures;
  for (const auto& output : a.outputs) {
    const std::optional<Memory> memory = group.find_output(output.variable);
    if (!memory) {
      fmt::print("Output {} not found, skipping.\n", output.variable);
      continue;
    }
    const int channels = channels_of(memory->type);
    if (channels == 0) {
      fmt::print("Output {} is not a basic type, skipping.\n", output.variable);
      continue;
    }
    fmt::print("Output {} to {}\n", output.variable, output.file);
    pictures.push_back({output, *memory, channels, {}});
    pictures.back().values.reserve(std::size_t(a.width) * std::size_t(a.height) * std::size_t(channels));
  }
  return pictures;
}

/// The layers whose outputs are asked for one by one.
std::vector<int> entry_layers(const ShadeArguments& a, const ShaderGroup& group) {
  std::vector<int> layers;
  for (const std::string& output : a.entry_outputs) {
    const std::size_t before = layers.size();
    for (int i = 0; i < group.layer_count(); ++i)
      if (group.layer_name(i)->view() == std::string_view(output).substr(0, output.find('.'))) layers.push_back(i);
    if (layers.size() == before) throw Error(fmt::format("--entryoutput: there is no layer of the output '{}'", output));
  }
  return layers;
}

int run(ShadeArguments& a) {
  Shaders shaders(a);
  if (!a.check.empty()) return shaders.load(a.check) ? done : bad_input;
  if (!a.describe.empty()) {
    const auto shader = shaders.load(a.describe);
    if (shader) print_description(*shader);
    return shader ? done : bad_input;
  }
  if (!a.expression.empty()) {
    shaders.add("expr", fmt::format("shader expr(output color result = 0) {{ {}; }}\n", a.expression));
    a.group.layers.push_back({"expr", "expr_0", {}, {}});
  }
  if (a.execute) set_execution_mode(*a.execute);
  for (const std::string& message : a.messages) fmt::print("{}", message);
  std::vector<GroupProblem> problems;
  const std::shared_ptr<const ShaderGroup> group = ShaderGroup::build(a.group, group_options(a, shaders), problems);
  if (!report(problems) || !group) return bad_input;
  if (a.verbose) print_group(a.group, *group);
  if (a.query) print_layers(*group);
  std::vector<Picture> pictures = find_outputs(a, *group);
  const std::vector<int> entries = entry_layers(a, *group);
  GridServices services(a);
  Execution& execution = group->execution();
  for (int pass = 0; pass < a.repetitions; ++pass) {
    for (Picture& picture : pictures) picture.values.clear();
    for (int y = 0; y < a.height; ++y)
      for (int x = 0; x < a.width; ++x) {
        Globals globals = grid_point(a, x, y);
        services.begin(globals, y * a.width + x);
        if (entries.empty())
          execution.run(globals, services);
        else
          execution.run(globals, services, entries);
        for (Picture& picture : pictures) take(picture, execution);
        if (a.print) print_values(pictures, x, y);
      }
  }
  if (!a.print)
    for (const Picture& picture : pictures)
      if (picture.output.file != "null") write(picture, a);
  return done;
}

}  // namespace

int shade(std::span<const std::string> words) {
  try {
    if (words.empty() || words[0] == "--help" || words[0] == "-h") {
      fmt::print("{}", shade_help());
      return done;
    }
    ShadeArguments arguments = parse_shade_arguments(words);
    for (const std::string& warning : arguments.warnings) fmt::print(stderr, "WARNING: {}\n", warning);
    return run(arguments);
  } catch (const Error& error) {
    std::fflush(stdout);
    if (error.location.line > 0)
      fmt::print(stderr, "{}:{}:{}: ", error.location.file, error.location.line, error.location.column);
    fmt::print(stderr, "error: {}\n", error.what());
    return bad_input;
  }
}

}  // namespace etendue::osl

extern "C" int etendue_osl_shade(int count, const char* const* words) {
  const std::vector<std::string> list(words, words + count);
  return etendue::osl::shade(list);
}
