// The viewer thread: observes the render, and sends progress and frames to the browsers.

#include <fmt/format.h>

#include <charconv>
#include <set>

#include "language/loader.h"
#include "studio.h"

namespace etendue::studio {

namespace {

using Clock = std::chrono::steady_clock;

/// The fraction of the program's CPU time that may be spent on viewing, so that it hardly slows the render.
constexpr double share = 0.03, share_when_fresh = 0.12;
constexpr auto fresh = std::chrono::seconds(2);
constexpr auto shortest = std::chrono::milliseconds(50), resting = std::chrono::milliseconds(250),
               longest = std::chrono::milliseconds(4000), refreshing = std::chrono::milliseconds(1000);

double processor_time(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

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

void Studio::wake_viewer() {
  {
    const std::lock_guard lock(viewer_guard_);
    viewer_woken_ = true;
  }
  viewer_changed_.notify_all();
}

// Updates the view when the program's CPU time since the last update is so much longer that viewing stays a small fraction of
// it. CPU time does not depend on other programs. Changes by users are shown at once.
void Studio::look() {
  pthread_setname_np(pthread_self(), "viewer");
  std::uint64_t seen_changes = 0, seen_generations = 0;
  Clock::time_point looked{}, begun{}, refreshed = Clock::now();
  double looked_at = 0, cost = 0;  // CPU time of the whole program at the last update, and cost of the last update [s]
  auto pause = shortest;
  while (!ending_) {
    bool woken = false;
    {
      std::unique_lock lock(viewer_guard_);
      viewer_changed_.wait_for(lock, pause, [&] { return ending_ || viewer_woken_; });
      woken = std::exchange(viewer_woken_, false);
    }
    if (ending_) return;
    if (settings_.refresh && Clock::now() - refreshed >= refreshing) {
      woken |= settings_.refresh(*this);
      refreshed = Clock::now();
    }
    bool rendering = false;
    std::uint64_t changes = 0, generations = generation;
    const auto count = [&](const Runner::Status& status) {
      rendering |= status.state == Runner::State::rendering;
      changes += status.changes;
    };
    count(runner_.status());
    for (const auto& side : sides_.all()) {
      count(side->runner().status());
      generations += side->generation();
    }
    const bool changed = woken || changes != seen_changes || generations != seen_generations;
    pause = rendering || changed ? shortest : resting;
    if (!changed && !rendering) continue;
    const bool soon = coarse && Clock::now() - looked >= shortest;
    // After a restart updates are more frequent, since most is to be seen then.
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
    if (seen_generations != generations) begun = Clock::now();
    seen_changes = changes;
    seen_generations = generations;
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

namespace {

/// The position of a picture within the whole one, from its metadata.
FrameInfo place_of(const Image& picture, FrameInfo info) {
  const auto number_in = [&](const char* key, int otherwise) {
    const auto found = picture.metadata.find(key);
    int value = otherwise;
    if (found != picture.metadata.end())
      std::from_chars(found->second.data(), found->second.data() + found->second.size(), value);
    return std::uint32_t(std::max(value, 0));
  };
  info.x0 = number_in("crop_x", 0);
  info.y0 = number_in("crop_y", 0);
  info.full_width = std::max(number_in("full_width", picture.width), info.x0 + std::uint32_t(picture.width));
  info.full_height = std::max(number_in("full_height", picture.height), info.y0 + std::uint32_t(picture.height));
  return info;
}

/// Whether the X, Y, Z of a layer are a colour: those of a position or a normal are none.
bool holds_light(const std::string& layer) {
  return layer.starts_with("length_") || layer.starts_with("light.") || layer.starts_with("path.");
}

}  // namespace

std::shared_ptr<const Frame> Studio::make_frame(const Watch& watch, const Render& render, const Image& picture, FrameInfo info,
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
    if (pinned.width != picture.width || pinned.height != picture.height) info = place_of(pinned, info);
  } else if (!watch.layer.empty()) {
    for (size_t i = 3; i < picture.channels.size(); ++i)
      if (picture.channels[i] == watch.layer || picture.channels[i].starts_with(watch.layer + ".")) {
        const bool xyz = picture.channels[i] == watch.layer + ".X" && holds_light(watch.layer);
        return Frame::make(Frame::Kind::linear, picture, i, xyz, info, number, before);
      }
    return nullptr;
  }
  if (watch.what == Watch::What::linear) return Frame::make(Frame::Kind::linear, *image, 0, true, info, number, before);
  const Image shown = watch.tone_map.empty() ? render.display(*image) : tone_map_of(watch.tone_map)->apply(*image);
  return Frame::make(Frame::Kind::toned, shown, 0, false, info, number, before);
}

/// Makes one frame for each distinct Watch, and broadcasts the progress.
void Studio::look_once() {
  std::map<int, std::set<Watch>> wanted;  // by render
  Frames before, frames;
  {
    const std::lock_guard lock(browsers_guard_);
    for (const auto& [number, slots] : watches_)
      for (const auto& [slot, watch] : slots)
        if (watch.what != Watch::What::none) wanted[watch.render].insert(watch);
    before = frames_;
  }
  const Shown own = shown();
  if (own.render) show(own, wanted[0], before, frames);
  Json list = Json::array();
  for (const auto& side : sides_.all()) {
    const Shown now = shown(*side);
    if (now.render) show(now, wanted[side->number], before, frames);
    list.push_back(side_json(*side, now));
  }
  {
    const std::lock_guard lock(browsers_guard_);
    frames_ = std::move(frames);
    for (const auto& [number, weak] : browsers_)
      if (const auto browser = weak.lock()) browser->frame_ready();
  }
  broadcast(progress_json(own));
  if (!list.empty()) broadcast({{"event", "renders"}, {"renders", std::move(list)}});
}

void Studio::show(const Shown& now, const std::set<Watch>& wanted, const Frames& before, Frames& made) {
  if (wanted.empty()) return;
  const Image picture = now.snapshot.picture();
  FrameInfo info;
  info.generation = now.generation;
  info.samples = now.snapshot.progress.samples;
  info.coarse = now.coarse;
  info.finished = now.status.state == Runner::State::finished && !now.coarse;
  info = place_of(picture, info);
  for (const Watch& watch : wanted) {
    const auto had = before.find(watch);
    try {
      made[watch] = make_frame(watch, *now.render, picture, info, had == before.end() ? nullptr : had->second.get());
    } catch (const std::exception& error) {  // an error of a tone map; the browsers keep their last frame
      notice(error.what(), "error");
      if (had != before.end()) made[watch] = had->second;
    }
  }
  const std::lock_guard lock(browsers_guard_);
  note_shape(now, picture);
}

}  // namespace etendue::studio
