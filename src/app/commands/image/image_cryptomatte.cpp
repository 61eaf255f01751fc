// etendue image cryptomatte: lists the mattes of a file, and extracts the matte of some of them.

#include "image_cryptomatte.h"

#include <fmt/format.h>

#include "app/commands.h"
#include "etendue/film/image_tools.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "images/cryptomatte.h"

namespace etendue {
namespace {

struct MatteOptions {
  std::string file, kind, output;
  std::vector<std::string> select;
};

/// The identifiers of a name, with the kind it belongs to. A name of several kinds needs --kind.
struct Selected {
  const Cryptomatte* kind;
  std::uint32_t identifier;
};

Selected selected(const std::vector<Cryptomatte>& kinds, const std::string& name) {
  std::vector<Selected> found;
  for (const Cryptomatte& kind : kinds)
    if (const auto at = kind.manifest.find(name); at != kind.manifest.end()) found.push_back({&kind, at->second});
  const Location where{intern("--select"), 0, 0};
  if (found.empty()) throw Error(fmt::format("there is no matte of '{}'; without --select the names are listed", name), where);
  // An object that is an asset of its own is the same matte in both.
  for (const Selected& s : found)
    if (coverage_of(*s.kind, s.identifier) != coverage_of(*found[0].kind, found[0].identifier))
      throw Error(fmt::format("'{}' is a name of {} and of {}: choose by --kind", name, found[0].kind->name, s.kind->name),
                  where);
  return found[0];
}

int show(const MatteOptions& options) {
  note_input(options.file);
  const Image image = read_image(options.file);
  std::vector<Cryptomatte> kinds = cryptomattes_of(image);
  if (kinds.empty()) throw Error(fmt::format("'{}' has no mattes: no metadata 'cryptomatte/…/name'", options.file));
  if (!options.kind.empty()) {
    std::erase_if(kinds, [&](const Cryptomatte& k) { return k.name != options.kind; });
    if (kinds.empty())
      throw Error(fmt::format("'{}' has no mattes '{}'", options.file, options.kind), {intern("--kind"), 0, 0});
  }
  if (options.select.empty()) {
    for (const Cryptomatte& kind : kinds) {
      fmt::print("{}\n", kind.name);
      for (const auto& [name, identifier] : kind.manifest) {
        double sum = 0;
        for (const float coverage : coverage_of(kind, identifier)) sum += double(coverage);
        fmt::print("  {:08x}  {:>12.2f} pixels  {}\n", identifier, sum, name);
      }
    }
    return exit_status::done;
  }
  if (options.output.empty()) throw Error("needs a file to write", {intern("--output"), 0, 0});
  OutputFiles files;
  files.add(options.output, {intern("--output"), 0, 0});
  files.raise();
  Image matte(image.width, image.height, {"R", "G", "B"});
  matte.metadata = {{"color_space", "srgb"}, {"transfer", "linear"}};
  for (const std::string& name : options.select) {
    const Selected s = selected(kinds, name);
    const std::vector<float> coverage = coverage_of(*s.kind, s.identifier);
    for (size_t i = 0; i < coverage.size(); ++i)
      for (size_t c = 0; c < 3; ++c) matte.values[3 * i + c] = std::min(matte.values[3 * i + c] + double(coverage[i]), 1.0);
  }
  write_any(matte, options.output);
  return exit_status::done;
}

}  // namespace

void add_image_cryptomatte(Command& image) {
  Command command = image.add_command("cryptomatte", "List the mattes of a Cryptomatte file, or extract one");
  auto options = std::make_shared<MatteOptions>();
  command.argument("FILE", options->file, "An EXR file with mattes, of any program").required();
  command.option("--select NAME", options->select, "Write the matte of this name; may be repeated");
  command.option("--kind NAME", options->kind, "Only mattes of this kind, such as crypto_material");
  command.option("-o,--output FILE", options->output, "The picture of the coverage, linear; its ending chooses the format")
      .needs("--select");
  command.footer(
      "\nExamples\n"
      "  etendue image cryptomatte mattes.exr\n"
      "  etendue image cryptomatte mattes.exr --select lamp --select table -o matte.png");
  command.runs([options] { return show(*options); });
}

}  // namespace etendue
