// The class Exporter, the base of all exporters, and the choice of the exporter for a file.

#include "etendue/exporter.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace etendue {

void Exporter::describe(Description<Exporter>& d) { d.summary("Writes components as a file of another program."); }

static const Register<Exporter> registered;

namespace {

std::vector<Ref<Exporter>> all_exporters() {
  std::vector<Ref<Exporter>> all;
  const Registry& registry = Registry::instance();
  const ClassInfo& interface = *registry.find("Exporter");
  for (const ClassInfo* c : registry.all())  // not `subclasses`: it loads the library of formats even if a plugin has exporters
    if (!c->abstract() && c->is_a(interface)) all.push_back(ref_cast<Exporter>(c->create()));
  return all;
}

}  // namespace

Ref<Exporter> exporter_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  if (ending.size() < 2) return nullptr;
  ending.erase(0, 1);
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  for (Ref<Exporter>& exporter : all_exporters())
    if (std::ranges::count(exporter->extensions(), ending)) return exporter;
  return nullptr;
}

std::vector<std::string> exported_extensions() {
  std::vector<std::string> all;
  for (const Ref<Exporter>& exporter : all_exporters())
    for (const std::string& ending : exporter->extensions()) all.push_back(ending);
  std::ranges::sort(all);
  return all;
}

}  // namespace etendue
