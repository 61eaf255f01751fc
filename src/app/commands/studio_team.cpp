#include "studio_team.h"

#include <csignal>
#include <filesystem>
#include <set>

#include "app/commands.h"
#include "describe/guard.h"
#include "etendue/describe/component.h"
#include "etendue/describe/registry.h"
#include "etendue/language/language.h"
#include "studio/document/document.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

/// A job as the followers get to know it.
struct Announced {
  std::string file;                  ///< the document's name, whose folder paths are relative to
  std::string text;                  ///< the description
  std::vector<std::string> plugins;  ///< files of the plugins that its classes come from
  bool fresh = false;                ///< the files that it names are to be read again
};

std::vector<std::byte> packed(const Announced& what) {
  Writing to(LetterKind::render);
  to.add(what.file).add(what.text).add(what.fresh).add(std::uint64_t(what.plugins.size()));
  for (const std::string& plugin : what.plugins) to.add(plugin);
  return std::move(to.bytes());
}

Announced unpacked(std::vector<std::byte> bytes) {
  Reading from(0, std::move(bytes));
  Announced what;
  what.file = from.take_text();
  what.text = from.take_text();
  what.fresh = from.take<bool>();
  for (auto left = from.take<std::uint64_t>(); left > 0; --left) what.plugins.push_back(from.take_text());
  return what;
}

Announced announced(const Job& job, bool fresh) {
  Announced what;
  what.fresh = fresh;
  const fs::path file = fs::absolute(job.origin ? std::string(job.origin->location.file) : std::string("new.etd"));
  what.file = file.string();
  what.text = write_description(job, false, file.parent_path().string());
  std::set<std::string> plugins;
  for (const Ref<Component>& part : studio::components_of(job))
    if (const std::string& plugin = part->class_info().provider; !plugin.empty()) plugins.insert(fs::absolute(plugin).string());
  what.plugins.assign(plugins.begin(), plugins.end());
  return what;
}

/// Makes the document that of the leader's job.
void mirror(studio::Document& document, Announced what) {
  for (const std::string& plugin : what.plugins) Registry::instance().load_plugin(plugin);
  if (!what.fresh && document.valid() && document.file() == what.file) {
    static_cast<void>(document.apply(what.text, {.label = "follow", .merge = "follow"}));  // one undo step, however many
    return;
  }
  document.open({std::move(what.file), std::move(what.text), {}});
  if (document.draft()) throw Errors(document.draft()->errors);
}

}  // namespace

void lead_studio(ProcessTeam& team) {
  team.follow_edits([](const Job& job, bool fresh) { return packed(announced(job, fresh)); });
}

int follow_studio(ProcessTeam& team, int threads) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) std::signal(signal, SIG_IGN);
  handle_warnings([](const std::string&, Location) {});  // the leader has the same
  studio::Folders everywhere;
  everywhere.allow("/");
  studio::Document document({.threads = threads, .team = &team}, everywhere);
  while (std::optional<std::vector<std::byte>> render = team.next_render()) {
    try {
      mirror(document, unpacked(std::move(*render)));
      document.render()->run();
    } catch (const LostProcess&) {
      throw;
    } catch (...) {
      // Locations would be in the text that was sent, which nobody sees.
      std::vector<Error> errors;
      for (const Error& error : thrown_errors()) errors.emplace_back(error.what());
      team.failed(errors);
    }
  }
  handle_warnings({});
  return exit_status::done;
}

}  // namespace etendue
