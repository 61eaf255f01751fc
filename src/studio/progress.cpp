// The progress of renders, as sent to pages.

#include "studio.h"

namespace etendue::studio {

namespace {

const char* name(Runner::State state) {
  switch (state) {
    case Runner::State::empty: return "empty";
    case Runner::State::rendering: return "rendering";
    case Runner::State::paused: return "paused";
    case Runner::State::finished: return "finished";
    case Runner::State::failed: return "stopped";
  }
  return "";
}

const char* reason(Ended ended) {
  switch (ended) {
    case Ended::samples: return "samples";
    case Ended::time: return "time";
    case Ended::error: return "error";
    case Ended::interrupted: return "paused";
    case Ended::aborted: return "stopped";
  }
  return "";
}

Json finite(double x) { return std::isfinite(x) && x > 0 ? Json(x) : Json(); }

}  // namespace

Studio::Shown Studio::shown() {
  Shown now;
  now.render = document_.render();
  if (now.render) now.snapshot = now.render->snapshot();
  now.status = runner_.status();
  now.generation = generation;
  now.coarse = coarse_shown;
  // The render is not finished: the full-resolution picture follows.
  if (now.coarse && now.status.state == Runner::State::finished) now.status = {Runner::State::rendering, {}, {}, {}};
  return now;
}

Studio::Shown Studio::shown(Side& side) {
  Shown now;
  now.number = side.number;
  now.generation = side.generation();
  now.render = side.render();
  if (now.render) now.snapshot = now.render->snapshot();
  now.status = side.runner().status();
  if (std::vector<Error> errors = side.errors(); !errors.empty()) {
    now.status.state = Runner::State::failed;
    now.status.errors = std::move(errors);
  }
  return now;
}

Json Studio::progress_json() { return progress_json(shown()); }

Json Studio::progress_json(const Shown& now) {
  Json json = {{"event", "progress"},
               {"state", name(now.status.state)},
               {"ended", now.status.ended ? Json(reason(*now.status.ended)) : Json()},
               {"generation", now.generation},
               {"coarse", now.coarse}};
  if (now.render) {
    const Progress& p = now.snapshot.progress;
    const double error = now.snapshot.film.relative_error();
    json["samples"] = p.samples;
    json["samples_wanted"] = p.samples_wanted;
    json["fraction"] = p.fraction;
    json["seconds"] = p.seconds;
    json["seconds_left"] = p.seconds_left >= 0 && std::isfinite(p.seconds_left) ? Json(p.seconds_left) : Json();
    json["samples_per_second"] = p.samples_per_second;
    json["error"] = finite(error);
    json["bad_samples"] = now.snapshot.film.bad_samples();
    const std::lock_guard lock(browsers_guard_);
    Shape& shape = shapes_[now.number];
    if (shape.generation != now.generation) note_shape(now, now.snapshot.picture());
    json["width"] = shape.width;
    json["height"] = shape.height;
    json["layers"] = shape.layers;
    if (std::isfinite(error) && error > 0 && !now.coarse) courses_[now.number].add({p.seconds, error, p.samples});
  }
  json["errors"] = errors_json(now.status.errors, nullptr);
  return json;
}

Json Studio::side_json(const Side& side, const Shown& now) {
  Json json = progress_json(now);
  json.erase("event");
  Json set = Json::object();
  for (const auto& [path, expression] : side.difference.set) set[path] = expression;
  json["render"] = side.number;
  json["title"] = side.title();
  json["renderer"] = side.difference.renderer.empty() ? Json() : Json(side.difference.renderer);
  json["set"] = std::move(set);
  return json;
}

Json Studio::sides_json() {
  Json list = Json::array();
  for (const auto& side : sides_.all()) list.push_back(side_json(*side, shown(*side)));
  return {{"event", "renders"}, {"renders", std::move(list)}};
}

void Studio::tell_sides() { broadcast(sides_json()); }

Json Studio::course_json(int render) {
  const std::lock_guard lock(browsers_guard_);
  const auto found = courses_.find(render);
  return found == courses_.end() ? Json::array() : found->second.json();
}

/// Requires that `browsers_guard_` is held.
void Studio::note_shape(const Shown& now, const Image& picture) {
  Shape& shape = shapes_[now.number];
  shape = {now.generation, picture.width, picture.height, {}};
  for (size_t i = 3; i < picture.channels.size(); ++i) {
    const std::string layer = picture.channels[i].substr(0, picture.channels[i].rfind('.'));
    if (std::find(shape.layers.begin(), shape.layers.end(), layer) == shape.layers.end()) shape.layers.push_back(layer);
  }
}

}  // namespace etendue::studio
