// Requests about the render: control, limits, pictures.

#include <fmt/format.h>

#include <filesystem>

#include "etendue/output.h"
#include "requests.h"
#include "studio/pixels/relight.h"

namespace etendue::studio {

namespace {

Json start(const Call& call) {
  static_cast<void>(call.render());
  call.studio.runner_of(call.render_number()).start();
  return {};
}
Json pause(const Call& call) {
  call.studio.runner_of(call.render_number()).pause();
  return {};
}
Json stop(const Call& call) {
  call.studio.runner_of(call.render_number()).stop();
  return {};
}

Json restart(const Call& call) {
  static_cast<void>(call.render());
  if (const int number = call.render_number(); number != 0) {
    if (call.has("seed")) throw RequestError("bad_request", "the seed is that of all renders: restart the document's own");
    call.studio.sides().find(number)->restart();
    call.studio.wake_viewer();
    return {};
  }
  if (call.has("seed")) call.studio.overrides["seed"] = std::to_string(call.integer("seed", 0, std::int64_t(1) << 53));
  call.studio.apply_overrides();
  if (call.studio.fireflies_kept > 0) call.studio.valid_render()->film().keep_largest(call.studio.fireflies_kept);
  call.studio.valid_render()->restart();
  ++call.studio.generation;
  call.studio.runner().start();
  call.studio.wake_viewer();
  return {};
}

Json goals(const Call& call) {
  auto wanted = call.studio.overrides;
  const auto take = [&](const char* key, const char* path, const char* unit) {
    if (!call.request.contains(key)) return;
    wanted.erase(path);
    if (call.has(key)) wanted[path] = fmt::format("{}{}", call.number(key), unit);
  };
  take("samples", "renderer.samples", "");
  take("time", "time_limit", " s");
  take("error", "error_limit", "");
  const auto before = std::exchange(call.studio.overrides, wanted);
  try {
    call.studio.apply_overrides();
  } catch (...) {
    call.studio.overrides = before;
    throw;
  }
  return {};
}

Json crop(const Call& call) {
  auto& overrides = call.studio.overrides;
  const auto before = overrides;
  overrides.erase("image.crop");
  if (call.has("area")) {
    const Json& area = call.request["area"];
    const bool good = area.is_array() && area.size() == 4 &&
                      std::all_of(area.begin(), area.end(), [](const Json& x) { return x.is_number(); });
    if (!good) throw RequestError("bad_request", "'area' must be [x0, y0, x1, y1]");
    overrides["image.crop"] = fmt::format("[{}, {}, {}, {}]", area[0].get<double>(), area[1].get<double>(),
                                          area[2].get<double>(), area[3].get<double>());
  }
  try {
    call.studio.apply_overrides();
  } catch (...) {
    overrides = before;
    throw;
  }
  return {};
}

/// The most pictures that one browser watches at once: the render, those beside it, and light groups.
constexpr int most_slots = 24;

Json watch(const Call& call) {
  Watch watch;
  const std::string what = call.text_or("what", "linear");
  if (what == "linear")
    watch.what = Watch::What::linear;
  else if (what == "toned")
    watch.what = Watch::What::toned;
  else if (what != "none")
    throw RequestError("bad_request", "'what' must be linear, toned or none");
  watch.render = call.render_number();
  if (watch.what != Watch::What::none) static_cast<void>(call.studio.runner_of(watch.render));  // throws Error if there is none
  watch.layer = call.text_or("layer", "");
  watch.tone_map = call.text_or("tone_map", "");
  if (!watch.tone_map.empty()) static_cast<void>(tone_map_of(watch.tone_map));  // throws Error if it is not a tone map
  call.studio.set_watch(call.browser, int(call.integer_or("slot", 0, 0, most_slots - 1)), watch);
  return {};
}

/// The picture to save, with weighted light groups if requested.
Image picture_to_save(const Call& call, const Render& render) {
  const Image picture = render.picture();
  if (!call.has("lights")) return picture;
  const Json& wanted = call.request["lights"];
  std::map<std::string, std::array<double, 3>> factors;
  const auto bad = [] { return RequestError("bad_request", "'lights' must be {\"NAME\": [r, g, b], …}, factors from 0 on"); };
  if (!wanted.is_object()) throw bad();
  for (const auto& [name, rgb] : wanted.items()) {
    if (!rgb.is_array() || rgb.size() != 3) throw bad();
    for (size_t i = 0; i < 3; ++i) {
      if (!rgb[i].is_number() || !(rgb[i].get<double>() >= 0)) throw bad();
      factors[name][i] = rgb[i].get<double>();
    }
  }
  return relit(picture, factors);
}

Json save_picture(const Call& call) {
  const auto render = call.render();
  const std::string path = allowed_path(call, call.text("file"));
  const std::string ending = std::filesystem::path(path).extension().string();
  std::vector<std::string> known;
  for (const ClassInfo* info : Registry::instance().subclasses(*Registry::instance().find("Output"))) {
    if (info->abstract()) continue;
    const Ref<Output> output = ref_cast<Output>(info->create());
    if (output->extension() != ending) {
      known.push_back(output->extension());
      continue;
    }
    require_free(call, path);
    set(*output, "file", Value(FilePath{path, ""}));
    prepare_tree(*output);
    return {{"file", write_output(render->job(), *output, picture_to_save(call, *render), "picture")}};
  }
  throw Error(fmt::format("'{}': no format has the ending '{}'; known are {}", path, ending, fmt::join(known, " ")));
}

Json save_state(const Call& call) {
  const std::string path = allowed_path(call, call.text("file"));
  require_free(call, path);
  call.render()->save(path);
  return {{"file", path}};
}

Json load_state(const Call& call) {
  call.studio.valid_render()->load(allowed_path(call, call.text("file")));
  ++call.studio.generation;
  call.studio.wake_viewer();
  return {};
}

Json pin(const Call& call) {
  auto picture = std::make_shared<const Image>(call.render()->picture());
  call.studio.pin(call.text_or("name", "pinned"), std::move(picture));
  return {};
}

Json unpin(const Call& call) {
  call.studio.pin(call.text_or("name", "pinned"), nullptr);
  return {};
}

}  // namespace

std::span<const Request> render_requests() {
  static constexpr Request all[] = {
      {"start", false, start},
      {"pause", false, pause},
      {"stop", false, stop},
      {"restart", false, restart},
      {"goals", false, goals},
      {"crop", false, crop},
      {"watch", true, watch},
      {"save_picture", false, save_picture},
      {"save_state", false, save_state},
      {"load_state", false, load_state},
      {"pin", false, pin},
      {"unpin", false, unpin},
  };
  return all;
}

}  // namespace etendue::studio
