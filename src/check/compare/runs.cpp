#include "runs.h"

#include <fmt/format.h>
#include <time.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/hash.h"
#include "files/regular_file.h"
#include "files/whole_file.h"

namespace etendue::comparing {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::string_view magic = "etendue compare run 1\n";

std::uint64_t hash_of(std::span<const std::byte> bytes) {
  Hash hash;
  hash.add(bytes);
  return hash.value();
}

Pixels pixels_of(const Image& picture) {
  Pixels pixels;
  const size_t channels = picture.channels.size(), count = picture.values.size() / std::max<size_t>(channels, 1);
  pixels.reserve(3 * count);
  for (size_t i = 0; i < count; ++i)
    for (size_t c = 0; c < 3; ++c) pixels.push_back(float(picture.values[i * channels + c]));
  return pixels;
}

Json identity_json(const ComparisonIdentity& identity) {
  Json parts = Json::array();
  for (const auto& part : identity.parts) {
    Json files = Json::array();
    for (const Identity::File& file : part.identity.files)
      files.push_back({{"name", file.name}, {"size", file.size}, {"hash", file.hash}});
    parts.push_back(
        {{"scene", part.scene}, {"variant", part.variant}, {"description", part.identity.text}, {"files", std::move(files)}});
  }
  return {{"kind", "etendue comparison 1"},
          {"seed", identity.seed},
          {"samples", identity.budget.samples},
          {"seconds", identity.budget.seconds},
          {"parts", std::move(parts)}};
}

ComparisonIdentity parse_identity(const Json& json) {
  ComparisonIdentity identity;
  if (json.at("kind").get<std::string>() != "etendue comparison 1") throw Error("it is of another version");
  identity.seed = json.at("seed").get<std::uint64_t>();
  identity.budget = {json.at("samples").get<std::uint32_t>(), json.at("seconds").get<double>()};
  for (const Json& part : json.at("parts")) {
    ComparisonIdentity::Part p{part.at("scene").get<std::string>(), part.at("variant").get<std::string>(), {}};
    p.identity.text = part.at("description").get<std::string>();
    for (const Json& file : part.at("files"))
      p.identity.files.push_back(
          {file.at("name").get<std::string>(), file.at("size").get<std::uint64_t>(), file.at("hash").get<std::uint64_t>()});
    identity.parts.push_back(std::move(p));
  }
  return identity;
}

std::string budget_text(const Budget& budget) {
  return budget.samples > 0 ? fmt::format("{} samples", budget.samples) : fmt::format("{} s", budget.seconds);
}

/// The reason why runs of one comparison cannot be used by another; empty: they can.
std::string difference(const ComparisonIdentity& kept, const ComparisonIdentity& now) {
  if (kept.seed != now.seed) return fmt::format("they began with seed {}, not {}", kept.seed, now.seed);
  if (kept.budget.samples != now.budget.samples || kept.budget.seconds != now.budget.seconds)
    return fmt::format("each of them was to have {}, not {}", budget_text(kept.budget), budget_text(now.budget));
  for (size_t i = 0; i < std::max(kept.parts.size(), now.parts.size()); ++i) {
    if (i >= kept.parts.size()) return fmt::format("they have no '{}' on '{}'", now.parts[i].variant, now.parts[i].scene);
    const auto& had = kept.parts[i];
    if (i >= now.parts.size() || had.variant != now.parts[i].variant || had.scene != now.parts[i].scene)
      return fmt::format("they have '{}' on '{}' where now there is {}", had.variant, had.scene,
                         i < now.parts.size() ? fmt::format("'{}' on '{}'", now.parts[i].variant, now.parts[i].scene)
                                              : std::string("nothing"));
    if (const std::string text = etendue::difference(had.identity, "the kept runs", now.parts[i].identity, "this comparison");
        !text.empty())
      return fmt::format("'{}' on '{}': {}", had.variant, had.scene, text);
  }
  return {};
}

}  // namespace

double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

std::uint64_t seed_of(std::uint64_t base, const RunKey& key) {
  return base + ((std::uint64_t(key.scene) << 48) + (std::uint64_t(key.variant) << 32) + key.run + 1) * 0x9e3779b97f4a7c15ull;
}

std::optional<RunResult> render_run(Render& render, std::uint64_t seed, const Budget& budget,
                                    const std::function<bool()>& go_on) {
  const Ref<Renderer> renderer = render.job().renderer;
  const auto began = std::chrono::steady_clock::now();
  render.restart(seed);
  const std::uint32_t size = render.samples_per_step(), most = budget.samples > 0 ? budget.samples : 1u << 30;
  RunResult result;
  double whole_steps = 0;  // time of complete steps; a step cut short by a mark is rendered anew and counts once
  Mark now;
  for (std::uint32_t wanted = 1; now.samples < most; wanted = std::min(2 * wanted, most)) {
    render.edit(*renderer, "samples", Value(Number{double(wanted)}));
    while (now.samples < wanted && !(budget.seconds > 0 && now.seconds >= budget.seconds)) {
      if (!go_on()) return {};
      const double before = processor_seconds();
      if (render.step()) return {};
      now.seconds = whole_steps + processor_seconds() - before;
      now.samples = render.samples_done().back().end;
      if (now.samples % size == 0) whole_steps = now.seconds;
    }
    result.run.marks.push_back(now);
    result.pictures.push_back(pixels_of(render.film().develop()));
    if (budget.seconds > 0 && now.seconds >= budget.seconds) break;
  }
  result.run.bad_samples = render.film().bad_samples();
  result.run.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return result;
}

// ---- keeping them
// -------------------------------------------------------------------------------------------------------------

std::string run_file(const RunResult& result) {
  Json marks = Json::array(), hashes = Json::array();
  for (const Mark& mark : result.run.marks) marks.push_back({{"samples", mark.samples}, {"seconds", mark.seconds}});
  for (const Pixels& pixels : result.pictures) hashes.push_back(hash_of(std::as_bytes(std::span(pixels))));
  const Json json = {{"bad_samples", result.run.bad_samples},
                     {"wall_seconds", result.run.wall_seconds},
                     {"marks", marks},
                     {"numbers", result.pictures.front().size()},
                     {"hashes", hashes}};
  std::string bytes = std::string(magic) + json.dump() + "\n";
  for (const Pixels& pixels : result.pictures)
    bytes.append(reinterpret_cast<const char*>(pixels.data()), pixels.size() * sizeof(float));
  return bytes;
}

std::string run_file_name(const RunKey& key) {
  return fmt::format("scene{}-variant{}-run{}.run", key.scene + 1, key.variant + 1, key.run + 1);
}

RunStore::RunStore(std::string folder, const ComparisonIdentity& identity) : folder_(std::move(folder)) {
  const std::string manifest = folder_ + "/comparison.json";
  std::error_code error;
  if (fs::exists(manifest, error)) {
    std::string why;
    try {
      why = difference(parse_identity(Json::parse(read_regular_file(manifest))), identity);
    } catch (const std::exception& e) {
      why = std::string("'comparison.json' there cannot be read: ") + e.what();
    }
    if (!why.empty())
      throw Error(
          fmt::format("the runs kept in '{}' are of another comparison: {}\nremove that folder, or name another with --state",
                      folder_, why));
    return;
  }
  if (fs::exists(folder_, error) && !fs::is_empty(folder_, error))
    throw Error(fmt::format("'{}' is not empty and holds no comparison; name another folder with --state", folder_));
  fs::create_directories(folder_, error);
  if (error) throw Error(fmt::format("cannot make the folder '{}': {}", folder_, error.message()));
  write_whole_file(manifest, identity_json(identity).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::string RunStore::file(const RunKey& key) const { return folder_ + "/" + run_file_name(key); }

bool RunStore::has(const RunKey& key) const {
  std::error_code error;
  if (!runs_.contains(key) && !folder_.empty() && fs::exists(file(key), error)) find(key);
  return runs_.contains(key);
}

void RunStore::find(const RunKey& key) const {
  const std::string path = file(key);
  try {
    RegularFile from(path);
    std::string head(std::min<std::uint64_t>(from.size(), 1 << 20), '\0');
    from.read(head.data(), head.size());
    const size_t end = head.find('\n', magic.size());
    if (!head.starts_with(magic) || end == std::string::npos) throw Error("it is no run");
    const Json json = Json::parse(head.substr(magic.size(), end - magic.size()));
    Run run;
    run.bad_samples = json.at("bad_samples").get<std::uint64_t>();
    run.wall_seconds = json.at("wall_seconds").get<double>();
    for (const Json& mark : json.at("marks"))
      run.marks.push_back({mark.at("samples").get<std::uint32_t>(), mark.at("seconds").get<double>()});
    const auto hashes = json.at("hashes").get<std::vector<std::uint64_t>>();
    const auto numbers = json.at("numbers").get<std::uint64_t>();
    if (run.marks.empty() || hashes.size() != run.marks.size() || numbers > from.size() ||
        from.size() != end + 1 + hashes.size() * numbers * sizeof(float))
      throw Error("it is damaged");
    data_begins_[key] = end + 1;
    hashes_[key] = hashes;
    runs_[key] = std::move(run);
  } catch (const std::exception& e) {
    throw Error(fmt::format("cannot go on with '{}': {}; remove it to render that run again", path, e.what()));
  }
}

Pixels RunStore::picture(const RunKey& key, size_t mark) const {
  if (folder_.empty()) return pictures_.at(key).at(mark);
  const std::string path = file(key);
  const auto& hashes = hashes_.at(key);
  try {
    RegularFile from(path);
    const std::uint64_t begin = data_begins_.at(key), bytes = (from.size() - begin) / hashes.size();
    Pixels pixels(bytes / sizeof(float));
    from.seek(begin + mark * bytes);
    from.read(pixels.data(), bytes);
    if (hash_of(std::as_bytes(std::span(pixels))) != hashes[mark]) throw Error("it is damaged");
    return pixels;
  } catch (const Error& e) {
    throw Error(fmt::format("cannot go on with '{}': {}; remove it to render that run again", path, e.what()));
  }
}

void RunStore::keep(const RunKey& key, RunResult result) {
  if (folder_.empty()) {
    pictures_[key] = std::move(result.pictures);
    runs_[key] = std::move(result.run);
    return;
  }
  write_whole_file(file(key), run_file(result));
  find(key);
}

}  // namespace etendue::comparing
