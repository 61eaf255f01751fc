// Requests about whole pictures: which ones a page gets, saving, pinning.

#include <fmt/format.h>

#include <filesystem>

#include "etendue/output.h"
#include "film/relight.h"
#include "requests.h"

namespace etendue::studio {

namespace {

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

Json pin(const Call& call) {
  auto picture = std::make_shared<const Image>(call.render()->picture());
  call.studio.pin(call.text_or("name", "pinned"), std::move(picture));
  return {};
}

Json unpin(const Call& call) {
  call.studio.pin(call.text_or("name", "pinned"), nullptr);
  return {};
}

Json pictures(const Call& call) { return {{"pictures", call.studio.pictures_json()}}; }

const RegisterRequests registered{
    {"watch", true, watch},  {"save_picture", false, save_picture}, {"pin", false, pin},
    {"unpin", false, unpin}, {"pictures", true, pictures},
};

}  // namespace

}  // namespace etendue::studio
