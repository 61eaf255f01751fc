// Requests that control renders: the document's own, and those beside it.

#include <fmt/format.h>

#include "requests.h"

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

Json renders(const Call& call) {
  Studio& studio = call.studio;
  Json reply = Json::object();
  if (call.has("remove")) studio.sides().remove(int(call.integer("remove", 0, 2'000'000'000)));
  if (call.has("add")) {
    static_cast<void>(studio.valid_render());
    const Json& wanted = call.request["add"];
    if (!wanted.is_object()) throw RequestError("bad_request", "'add' must be an object");
    const Call part{studio, call.browser, wanted, call.id};
    Difference difference;
    difference.renderer = part.text_or("renderer", "");
    if (part.has("set")) {
      constexpr size_t most = 100;
      const Json& set = wanted["set"];
      if (!set.is_object() || set.size() > most) throw RequestError("bad_request", "'set' must be an object of texts");
      for (const auto& [path, expression] : set.items()) {
        if (!expression.is_string()) throw RequestError("bad_request", "'set' must be an object of texts");
        difference.set[path] = expression.get<std::string>();
      }
    }
    reply["render"] = studio.sides().add(std::move(difference), studio.document(), studio.overrides)->number;
  }
  if (call.has("remove") || call.has("add")) {
    studio.tell_sides();
    studio.wake_viewer();
  }
  const Json now = studio.sides_json();
  reply["renders"] = now["renders"];
  return reply;
}

Json course(const Call& call) {
  const int number = call.render_number();
  static_cast<void>(call.studio.runner_of(number));  // throws Error if there is none
  return {{"points", call.studio.course_json(number)}};
}

const RegisterRequests registered{
    {"start", false, start},           {"pause", false, pause},           {"stop", false, stop},
    {"restart", false, restart},       {"goals", false, goals},           {"crop", false, crop},
    {"save_state", false, save_state}, {"load_state", false, load_state}, {"renders", false, renders},
    {"course", true, course},
};

}  // namespace

}  // namespace etendue::studio
