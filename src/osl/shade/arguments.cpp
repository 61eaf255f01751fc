#include "arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>

#include "files/regular_file.h"

namespace etendue::osl {
namespace {

class ArgumentReader {
 public:
  explicit ArgumentReader(std::span<const std::string> words) : words_(words) {}

  ShadeArguments read() {
    a_.group.name = "unnamed_group_1";
    while (at_ < words_.size()) {
      const std::string& word = words_[at_++];
      if (word.size() > 1 && word[0] == '-')
        option(word);
      else
        shader(word, "");
    }
    return std::move(a_);
  }

 private:
  const std::string& next() {
    if (at_ == words_.size()) throw Error(fmt::format("'{}' needs more values", words_[option_]));
    return words_[at_++];
  }
  float number() {
    const std::string& word = next();
    char* end = nullptr;
    const float value = std::strtof(word.c_str(), &end);
    if (*end || word.empty()) throw Error(fmt::format("'{}' needs a number, not '{}'", words_[option_], word));
    return value;
  }
  int whole(int most) {
    const std::string& word = next();
    char* end = nullptr;
    const long value = std::strtol(word.c_str(), &end, 10);
    if (*end || word.empty() || value < 1 || value > most)
      throw Error(fmt::format("'{}' needs a whole number from 1 to {}, not '{}'", words_[option_], most, word));
    return int(value);
  }

  /// For options of the reference that change no result here; nothing is accepted in silence.
  void no_effect(const std::string& option) { a_.warnings.push_back(fmt::format("the option '{}' has no effect", option)); }

  void data_type() {
    const std::string& type = next();
    if (type != "uint8" && type != "uint16" && type != "half" && type != "float")
      throw Error(fmt::format("'{}' needs uint8, uint16, half or float, not '{}'", words_[option_], type));
    a_.data_type = type;
  }

  void shader(const std::string& name, std::string layer) {
    if (layer.empty()) layer = std::exchange(layer_, "");
    const std::string bare = std::filesystem::path(name).stem().string();
    if (layer.empty()) layer = fmt::format("{}_{}", bare, a_.group.layers.size());
    a_.group.layers.push_back({name, layer, std::move(pending_), {}});
    pending_.clear();
  }

  void parameter(const std::string& option) {
    ParameterText p;
    for (std::size_t begin = option.find(':'); begin < option.size();) {
      const std::size_t end = std::min(option.find(':', begin + 1), option.size());
      const std::string hint = option.substr(begin + 1, end - begin - 1);
      if (hint.starts_with("type=")) p.type = hint.substr(5);
      if (hint == "lockgeom=0" || hint == "interpolated=1")
        p.interpolated = true;
      else if (!hint.starts_with("type=") && hint != "lockgeom=1" && hint != "interpolated=0")
        no_effect(hint);
      begin = end;
    }
    p.name = next();
    p.words = {next()};
    p.at = {intern("-" + option), 0, 0};
    pending_.push_back(std::move(p));
  }

  void group(const std::string& text) {
    const bool file = std::filesystem::is_regular_file(text);
    std::string content = file ? read_regular_file(text, 1 << 24) : text;
    GroupDescription parsed = parse_group(content, file ? text : "--group");
    if (a_.verbose) a_.messages.push_back(fmt::format("Processing group specification:\n---\n{}\n---\n", content));
    for (LayerText& layer : parsed.layers) a_.group.layers.push_back(std::move(layer));
    for (ConnectionText& connection : parsed.connections) a_.group.connections.push_back(std::move(connection));
  }

  void options(const std::string& text) {
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      const std::string item = text.substr(begin, end - begin);
      const std::size_t equal = item.find('=');
      const std::string_view name = std::string_view(item).substr(0, equal);
      if (!item.empty() && name != "lazyglobals" && name != "lazyerror" && name != "lazytrace" && name != "error_repeats")
        no_effect(item);
      a_.options.emplace_back(item.substr(0, equal), equal == std::string::npos ? "1" : item.substr(equal + 1));
      begin = end + 1;
    }
  }

  void connection() {
    ConnectionText c;
    c.from_layer = next(), c.from = next(), c.to_layer = next(), c.to = next();
    c.at = {"--connect", 0, 0};
    a_.messages.push_back(fmt::format("Connect {}.{} to {}.{}\n", c.from_layer, c.from, c.to_layer, c.to));
    a_.group.connections.push_back(std::move(c));
  }

  void definition(const std::string& text) {
    const std::size_t equal = text.find('=');
    a_.definitions.emplace_back(text.substr(0, equal), equal == std::string::npos ? "1" : text.substr(equal + 1));
  }

  void option(const std::string& word) {
    option_ = at_ - 1;
    const std::string name = word.substr(word.starts_with("--") ? 2 : 1);
    if (name == "param" || name.starts_with("param:")) return parameter(name);
    if (name.size() > 1 && name[0] == 'I') return a_.folders.push_back(name.substr(1));
    if (name.size() > 1 && name[0] == 'D') return definition(name.substr(1));
    if (name.size() == 2 && name[0] == 'O') return no_effect(word);
    const std::map<std::string, std::function<void()>> table = {
        {"g", [&] { a_.width = whole(1 << 15), a_.height = whole(1 << 15); }},
        {"res", [&] { a_.width = whole(1 << 15), a_.height = whole(1 << 15); }},
        {"o",
         [&] {
           const std::string variable = next();
           a_.outputs.push_back({variable, next()});
         }},
        {"od", [&] { data_type(); }},
        {"d", [&] { data_type(); }},
        {"t", [&] { next(), no_effect(word); }},
        {"layer", [&] { layer_ = next(); }},
        {"shader",
         [&] {
           const std::string shader_name = next();
           shader(shader_name, next());
         }},
        {"connect", [&] { connection(); }},
        {"group", [&] { group(next()); }},
        {"groupname", [&] { a_.group.name = next(); }},
        {"groupspec", [&] { group(next()); }},
        {"entry", [&] { a_.group.entries.push_back(next()); }},
        {"entryoutput", [&] { a_.entry_outputs.push_back(next()); }},
        {"options", [&] { options(next()); }},
        {"texoptions", [&] { next(), no_effect(word); }},
        {"center", [&] { a_.centers = true; }},
        {"vary_pdxdy", [&] { a_.vary_point = true; }},
        {"vary_udxdy", [&] { a_.vary_u = true; }},
        {"vary_vdxdy", [&] { a_.vary_v = true; }},
        {"scaleuv", [&] { a_.u_scale = number(), a_.v_scale = number(); }},
        {"offsetuv", [&] { a_.u_offset = number(), a_.v_offset = number(); }},
        {"scalest", [&] { a_.u_scale = number(), a_.v_scale = number(); }},
        {"offsetst", [&] { a_.u_offset = number(), a_.v_offset = number(); }},
        {"iters", [&] { a_.repetitions = whole(1 << 20); }},
        {"raytype", [&] { a_.ray_type = next(); }},
        {"colorspace", [&] { a_.color_space = next(); }},
        {"interpreter", [&] { a_.execute = Execute::interpreter; }},
        {"compiler", [&] { a_.execute = Execute::compiler; }},
        {"print", [&] { a_.print = true; }},
        {"p", [&] { a_.print = true; }},
        {"v", [&] { a_.verbose = true; }},
        {"oslquery", [&] { a_.query = true; }},
        {"userdata_isconnected", [&] { a_.userdata_is_connected = true; }},
        {"expr", [&] { a_.expression = next(); }},
        {"check", [&] { a_.check = next(); }},
        {"describe", [&] { a_.describe = next(); }},
        {"I", [&] { a_.folders.push_back(next()); }},
        {"path", [&] { a_.folders.push_back(next()); }},
        {"shaderpath", [&] { a_.folders.push_back(next()); }},
        {"D", [&] { definition(next()); }},
        {"llvm_opt", [&] { next(), no_effect(word); }}};
    // What concerns the reference's compilation, checks and statistics alone.
    static constexpr std::array without_effect = {"raytype_opt", "inbuffer",     "groupoutputs", "debug",
                                                  "debug2",      "debugnan",     "debuguninit",  "runstats",
                                                  "stats",       "profile",      "batched",      "no-output-placement",
                                                  "shadeimage",  "noshadeimage", "debug_nan",    "debug_uninit"};
    if (std::ranges::find(without_effect, name) != without_effect.end()) return no_effect(word);
    const auto row = table.find(name);
    if (row == table.end()) {
      std::vector<std::string> known;
      for (const auto& [each, _] : table) known.push_back("--" + each);
      throw Error(fmt::format("there is no option '{}'{}", word, suggestion(word, known)));
    }
    row->second();
  }

  std::span<const std::string> words_;
  std::size_t at_ = 0, option_ = 0;
  ShadeArguments a_;
  std::vector<ParameterText> pending_;
  std::string layer_;
};

}  // namespace

ShadeArguments parse_shade_arguments(std::span<const std::string> words) { return ArgumentReader(words).read(); }

const char* shade_help() {
  return R"(Runs shaders of the Open Shading Language at a grid of points, for tests, baking and measurements.

  etendue shade [options] SHADER...        SHADER: marble.osl, or marble
  etendue shade --check FILE               only compiles
  etendue shade --describe FILE            prints the shader's parameters

The network
  --param NAME VALUE           a parameter of the next shader; --param:type=color NAME 0,0,0 states its type,
                               --param:lockgeom=0 lets data of the geometry replace it
  --layer NAME                 the name of the next shader's layer
  --shader SHADER NAME         a shader with its layer's name
  --connect LAYER OUTPUT LAYER PARAMETER
  --group TEXT or FILE         a network as text: 'param ...; shader ...; connect a.x b.y'
  --entry LAYER                runs this layer, not the last; may be repeated
  --expr "result = ..."        a shader of this one statement
  -I FOLDER, -D NAME=TEXT      where shaders and what they include are searched; a macro

The points
  -g WIDTH HEIGHT              the grid (1 1): u and v from 0 to 1
  --center                     u and v at the centres of pixels
  --scaleuv U V, --offsetuv U V
  --raytype NAME               what raytype() answers (camera)

The results
  -o OUTPUT FILE               writes an output parameter as an image
  -od TYPE                     its numbers: uint8, uint16, half or float
  --print                      prints the outputs instead

How it runs (the numbers are the same)
  --interpreter                never as machine code
  --compiler                   as machine code from the first point on; an error if that is not possible

Options of the reference's testshade that concern its compiler, checks and statistics are accepted with a warning.
)";
}

}  // namespace etendue::osl
