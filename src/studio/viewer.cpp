// Looking at the render while it goes on: progress, and frames of the film for whoever watches.

#include <fmt/format.h>

#include <set>

#include "language/loader.h"
#include "studio.h"

namespace etendue::studio {

namespace {

using Clock = std::chrono::steady_clock;

/// How much of the program's work looking may be: what is rendered should hardly notice.
constexpr double share = 0.03, share_when_fresh = 0.12;
constexpr auto fresh = std::chrono::seconds(2);
constexpr auto shortest = std::chrono::milliseconds(50), longest = std::chrono::milliseconds(4000);

double processor_time(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

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

Ref<ToneMap> tone_map_of(const std::string& text) {
  constexpr size_t most = 10000;
  if (text.size() > most) throw Error("this tone map is too long");
  LoadOptions strict;
  strict.allow_files = false;
  language::Loader loader(strict);
  loader.add_text(text, "tone map", {});
  const Ref<ToneMap> tone_map = ref_cast<ToneMap>(loader.result(false));
  if (!tone_map) throw Error("this is no tone map");
  prepare_tree(*tone_map);
  return tone_map;
}

void Studio::pin(const std::string& name, std::shared_ptr<const Image> picture) {
  constexpr size_t most = 8;
  const std::lock_guard lock(browsers_guard_);
  if (!picture) {
    pins_.erase(name);
  } else if (pins_.size() >= most && !pins_.contains(name)) {
    throw Error("eight pictures are pinned already: take one off first");
  } else {
    pins_[name] = std::move(picture);
  }
}

void Studio::wake_viewer() {
  {
    const std::lock_guard lock(viewer_guard_);
    viewer_woken_ = true;
  }
  viewer_changed_.notify_all();
}

Json Studio::progress_json() {
  const std::shared_ptr<Render> render = document_.render();
  return render ? progress_json(render->snapshot(), true) : progress_json({}, false);
}

Json Studio::progress_json(const RenderSnapshot& now, bool valid) {
  const Runner::Status status = runner_.status();
  Json json = {{"event", "progress"},
               {"state", name(status.state)},
               {"ended", status.ended ? Json(reason(*status.ended)) : Json()},
               {"generation", generation.load()},
               {"coarse", coarse_shown.load()}};
  if (valid) {
    const Progress& p = now.progress;
    json["samples"] = p.samples;
    json["samples_wanted"] = p.samples_wanted;
    json["fraction"] = p.fraction;
    json["seconds"] = p.seconds;
    json["seconds_left"] = p.seconds_left >= 0 && std::isfinite(p.seconds_left) ? Json(p.seconds_left) : Json();
    json["samples_per_second"] = p.samples_per_second;
    json["error"] = finite(now.film.relative_error());
    json["bad_samples"] = now.film.bad_samples();
    const std::lock_guard lock(browsers_guard_);
    if (shape_.generation != generation) note_shape(now.picture());
    json["width"] = shape_.width;
    json["height"] = shape_.height;
    json["layers"] = shape_.layers;
  }
  json["errors"] = errors_json(status.errors, nullptr);
  return json;
}

void Studio::note_shape(const Image& picture) {
  shape_ = {generation, picture.width, picture.height, {}};
  for (size_t i = 3; i < picture.channels.size(); ++i) {
    const std::string layer = picture.channels[i].substr(0, picture.channels[i].find('.'));
    if (std::find(shape_.layers.begin(), shape_.layers.end(), layer) == shape_.layers.end()) shape_.layers.push_back(layer);
  }
}

// A look follows another when the rest of the program has worked so much longer that looking is a small part of it: by
// processor time, which does not count what other programs do. What somebody did is shown at once.
void Studio::look() {
  pthread_setname_np(pthread_self(), "viewer");
  std::uint64_t seen_changes = 0, seen_generation = 0;
  Clock::time_point looked{}, begun{};
  double looked_at = 0, cost = 0;  // of the whole program, and of the last look [s of a processor]
  auto pause = shortest;
  while (!ending_) {
    bool woken = false;
    {
      std::unique_lock lock(viewer_guard_);
      viewer_changed_.wait_for(lock, pause, [&] { return ending_ || viewer_woken_; });
      woken = std::exchange(viewer_woken_, false);
    }
    if (ending_) return;
    const Runner::Status status = runner_.status();
    const bool rendering = status.state == Runner::State::rendering;
    const bool changed = woken || status.changes != seen_changes || generation.load() != seen_generation;
    pause = rendering || changed ? shortest : longest / 4;
    if (!changed && !rendering) continue;
    const bool soon = coarse && Clock::now() - looked >= shortest;
    // What was begun anew is looked at more often: of it most is to be seen.
    const double part = Clock::now() - begun < fresh ? share_when_fresh : share;
    const bool due = part * (processor_time(CLOCK_PROCESS_CPUTIME_ID) - looked_at) >= cost;
    if (!changed && !soon && !due && Clock::now() - looked < longest) continue;
    {
      const std::lock_guard lock(browsers_guard_);
      if (browsers_.empty()) {
        frames_.clear();
        continue;
      }
    }
    if (seen_generation != generation.load()) begun = Clock::now();
    seen_changes = status.changes;
    seen_generation = generation.load();
    const double before = processor_time(CLOCK_THREAD_CPUTIME_ID);
    try {
      look_once();
    } catch (const std::exception& error) {
      notice(error.what(), "error");
    }
    cost = processor_time(CLOCK_THREAD_CPUTIME_ID) - before;
    looked_at = processor_time(CLOCK_PROCESS_CPUTIME_ID);
    looked = Clock::now();
  }
}

std::shared_ptr<const Frame> Studio::make_frame(const Watch& watch, const Image& picture, const FrameInfo& info,
                                                const Frame* before) {
  const std::uint64_t number = ++frame_number_;
  Image pinned;
  const Image* image = &picture;
  if (watch.layer.starts_with("pin:")) {
    const std::lock_guard lock(browsers_guard_);
    const auto found = pins_.find(watch.layer.substr(4));
    if (found == pins_.end()) return nullptr;
    pinned = *found->second;
    image = &pinned;
  } else if (!watch.layer.empty()) {
    for (size_t i = 3; i < picture.channels.size(); ++i)
      if (picture.channels[i] == watch.layer || picture.channels[i].starts_with(watch.layer + ".")) {
        const bool xyz = picture.channels[i] == watch.layer + ".X";
        return Frame::make(Frame::Kind::linear, picture, i, xyz, info, number, before);
      }
    return nullptr;
  }
  if (watch.what == Watch::What::linear) return Frame::make(Frame::Kind::linear, *image, 0, true, info, number, before);
  const std::shared_ptr<Render> render = document_.render();
  Image shown;
  if (watch.tone_map.empty()) {
    shown = render->display(*image);
  } else {
    shown = tone_map_of(watch.tone_map)->apply(*image);
  }
  return Frame::make(Frame::Kind::toned, shown, 0, false, info, number, before);
}

/// One frame for each kind of watching, and how far it is.
void Studio::look_once() {
  const std::shared_ptr<Render> render = document_.render();
  if (!render) return broadcast(progress_json({}, false));
  const RenderSnapshot snapshot = render->snapshot();
  std::set<Watch> wanted;
  std::map<Watch, std::shared_ptr<const Frame>> before;
  {
    const std::lock_guard lock(browsers_guard_);
    for (const auto& [number, watch] : watches_)
      if (watch.what != Watch::What::none) wanted.insert(watch);
    before = frames_;
  }
  if (!wanted.empty()) show(snapshot, wanted, before);
  broadcast(progress_json(snapshot, true));
}

void Studio::show(const RenderSnapshot& snapshot, const std::set<Watch>& wanted,
                  const std::map<Watch, std::shared_ptr<const Frame>>& before) {
  const Runner::Status status = runner_.status();
  const Image picture = snapshot.picture();
  FrameInfo info;
  info.generation = generation;
  info.samples = snapshot.progress.samples;
  info.coarse = coarse_shown;
  info.finished = status.state == Runner::State::finished;
  const auto number_in = [&](const char* key, std::uint32_t otherwise) {
    const auto found = picture.metadata.find(key);
    return found == picture.metadata.end() ? otherwise : std::uint32_t(std::stoul(found->second));
  };
  info.x0 = number_in("crop_x", 0);
  info.y0 = number_in("crop_y", 0);
  info.full_width = number_in("full_width", std::uint32_t(picture.width));
  info.full_height = number_in("full_height", std::uint32_t(picture.height));
  std::map<Watch, std::shared_ptr<const Frame>> frames;
  for (const Watch& watch : wanted) {
    const auto had = before.find(watch);
    try {
      frames[watch] = make_frame(watch, picture, info, had == before.end() ? nullptr : had->second.get());
    } catch (const std::exception& error) {  // of a tone map; whoever watches keeps what is on the screen
      notice(error.what(), "error");
      if (had != before.end()) frames[watch] = had->second;
    }
  }
  const std::lock_guard lock(browsers_guard_);
  note_shape(picture);
  frames_ = std::move(frames);
  for (const auto& [number, weak] : browsers_)
    if (const auto browser = weak.lock()) browser->frame_ready();
}

}  // namespace etendue::studio
