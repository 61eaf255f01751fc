#include "conformance.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <set>

#include "check/conform/fixtures/fixtures.h"
#include "describe/guard.h"
#include "describe/words.h"
#include "draw.h"

namespace etendue::conform {
namespace {

// Initialized before any constructor runs, so that nodes can register in any order.
constinit CheckNode* first_check = nullptr;

/// A check with the interface it applies to; null: every component.
struct InterfaceCheck {
  const ClassInfo* interface;
  void (*check)(Trial&);
};

int depth(const ClassInfo* info) { return info ? 1 + depth(info->parent) : 0; }

/// All registered checks: those of more general classes first, then by name, then in the order of registration.
std::vector<InterfaceCheck> interface_checks() {
  std::vector<InterfaceCheck> checks;
  for (const CheckNode* node = first_check; node; node = node->next) {
    const bool of_all = node->interface == typeid(Component);
    const ClassInfo* info = of_all ? nullptr : Registry::instance().find(std::type_index(node->interface));
    if (of_all || info) checks.insert(checks.begin(), {info, node->check});
  }
  std::ranges::stable_sort(checks, [](const InterfaceCheck& a, const InterfaceCheck& b) {
    return std::pair(depth(a.interface), a.interface ? a.interface->name : "") <
           std::pair(depth(b.interface), b.interface ? b.interface->name : "");
  });
  return checks;
}

std::vector<const ClassInfo*> chosen(const std::vector<std::string>& names) {
  const Registry& registry = Registry::instance();
  std::vector<const ClassInfo*> classes;
  for (const std::string& name : names)
    if (!registry.find(name)) throw Error("there is no class '" + name + "'" + meant_class(name));
  for (const ClassInfo* info : registry.all()) {
    bool asked = names.empty();
    for (const std::string& name : names) asked = asked || info->is_a(*registry.find(name));
    if (asked && !info->abstract()) classes.push_back(info);
  }
  return classes;
}

std::uint64_t seed_of(std::uint64_t seed, const std::string& name, int part) {
  std::uint64_t h = mix_bits(seed + 0x9e3779b97f4a7c15ull * std::uint64_t(part + 1));
  for (const char c : name) h = mix_bits(h ^ std::uint64_t(static_cast<unsigned char>(c)));
  return h;
}

void run(Trial& trial, void (*check)(Trial&), const std::string& what) {
  std::optional<std::string> thrown;
  try {
    check(trial);
  } catch (...) {  // a component may throw anything
    thrown = thrown_text();
  }
  trial.expect(!thrown, "nothing is thrown by the checks of a " + what, [&] { return *thrown; });
}

/// Tests one component of a class: the one with defaults (part 0) or a random one.
std::vector<Outcome> try_part(const ClassInfo& info, int part, const Options& options, const Fixtures& fixtures) {
  const std::uint64_t seed = seed_of(options.seed, info.name, part);
  std::mt19937_64 random(seed);
  const Drawn drawn = part == 0 ? default_part(info, fixtures, random) : draw_part(info, fixtures, random);
  if (!drawn.part)
    return {{info.name, part == 0 ? "with defaults" : "with random members", drawn.text,
             "no part could be made: " + drawn.refused, Result::not_tried}};
  Trial trial(*drawn.part, drawn.text, part == 0, fixtures, options.effort, random());
  for (const InterfaceCheck& row : interface_checks())
    if (!row.interface || info.is_a(*row.interface)) run(trial, row.check, row.interface ? row.interface->name : "component");
  return trial.outcomes();
}

}  // namespace

Outcome& Trial::outcome(const std::string& check) {
  const auto [place, added] = places_.try_emplace(check, outcomes_.size());
  if (added) outcomes_.push_back({class_name_, check, text_, {}, Result::passed});
  return outcomes_[place->second];
}

bool Trial::expect(bool holds, const std::string& check, const std::function<std::string()>& detail) {
  Outcome& o = outcome(check);
  if (!holds && o.result != Result::failed) {
    o.result = Result::failed;
    o.detail = detail ? detail() : "";
  }
  return holds;
}

void Trial::not_tried(const std::string& check, const std::string& why) {
  Outcome& o = outcome(check);
  if (o.result == Result::failed) return;
  o.result = Result::not_tried;
  o.detail = why;
}

std::string Trial::folder() const {
  std::string pattern = fixtures_->folder() + "/trial-XXXXXX";
  if (folder_.empty()) {
    if (!mkdtemp(pattern.data())) throw Error("cannot make a temporary folder '" + pattern + "'");
    folder_ = pattern;
  }
  return folder_;
}

void enlist(CheckNode& node) noexcept {
  node.next = first_check;
  first_check = &node;
}

void delist(CheckNode& node) noexcept {
  for (CheckNode** link = &first_check; *link; link = &(*link)->next)
    if (*link == &node) {
      *link = node.next;
      return;
    }
}

std::vector<std::string> checked_interfaces() {
  std::set<std::string> names;
  for (const InterfaceCheck& row : interface_checks())
    if (row.interface) names.insert(row.interface->name);
  return {names.begin(), names.end()};
}

std::vector<Outcome> conform(const Options& options) {
  const std::vector<const ClassInfo*> classes = chosen(options.classes);
  const size_t parts = size_t(options.drawn) + 1;
  std::vector<std::vector<Outcome>> outcomes(classes.size() * parts);
  Fixtures fixtures;
  std::mutex mutex;
  int done = 0;
  std::optional<tbb::global_control> limit;
  if (options.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, size_t(options.threads));
  tbb::parallel_for(
      size_t(0), outcomes.size(),
      [&](size_t i) {
        if (options.go_on && !options.go_on()) return;
        const ClassInfo& info = *classes[i / parts];
        outcomes[i] = try_part(info, int(i % parts), options, fixtures);
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(info.name, done, int(outcomes.size()));
      },
      tbb::simple_partitioner());

  std::vector<Outcome> all;
  for (const std::vector<Outcome>& some : outcomes)
    for (const Outcome& o : some) {
      if (o.result == Result::failed && o.part.find(fixtures.folder()) != std::string::npos) fixtures.keep();
      all.push_back(o);
    }
  return all;
}

}  // namespace etendue::conform
