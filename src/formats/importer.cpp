// The class Importer, the base of all importers, which has no members; and the choice of the importer for a file.

#include "etendue/importer.h"
#include "etendue/import_by.h"

#include <fmt/format.h>

#include <algorithm>

#include "files/file_kind.h"
#include "files/gzip.h"

namespace etendue {

void Importer::describe(Description<Importer>& d) { d.summary("Reads a file of another program into components."); }

static const Register<Importer> registered;

namespace {

std::vector<Ref<Importer>> all_importers() {
  std::vector<Ref<Importer>> all;
  const Registry& registry = Registry::instance();
  const ClassInfo& interface = *registry.find("Importer");
  for (const ClassInfo* c : registry.all())  // not `subclasses`: it loads the library of formats even if a plugin has importers
    if (!c->abstract() && c->is_a(interface)) all.push_back(ref_cast<Importer>(c->create()));
  return all;
}

}  // namespace

Ref<Importer> importer_of(const std::string& path) {
  const std::string ending = ending_of_contents(path);
  if (ending.empty() || ending == "etd") return nullptr;  // our own language needs no importer
  for (Ref<Importer>& importer : all_importers())
    if (std::ranges::count(importer->extensions(), ending)) return importer;
  return nullptr;
}

Ref<Component> import_by(const Importer& importer, Importing& importing) {
  const auto tell_contents = [&] {
    const std::string told = mistaken_contents(importing.path());
    if (!told.empty()) throw Error(fmt::format("'{}': {}", importing.path(), told), importing.at());
  };
  try {
    return importer.import(importing);
  } catch (const Errors&) {
    tell_contents();
    throw;
  } catch (const Error&) {
    tell_contents();
    throw;
  }
}

std::vector<std::string> imported_extensions() {
  std::vector<std::string> all;
  for (const Ref<Importer>& importer : all_importers())
    for (const std::string& ending : importer->extensions()) all.push_back(ending);
  std::ranges::sort(all);
  all.erase(std::ranges::unique(all).begin(), all.end());
  return all;
}

}  // namespace etendue
