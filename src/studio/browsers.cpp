// The browsers connected to a studio, and the events sent to them.

#include "studio.h"

namespace etendue::studio {

/// Serializes JSON for sending. Texts from files may contain invalid UTF-8, which is replaced.
std::shared_ptr<const std::string> written(const Json& json) {
  return std::make_shared<const std::string>(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void Studio::join(const std::shared_ptr<Browser>& browser) {
  const std::lock_guard lock(browsers_guard_);
  browser->number = next_browser_++;
  browsers_.emplace(browser->number, browser);
  if (!working_) return;
  working_->told = true;
  browser->send(written(working_->json()));
}

void Studio::leave(const Browser& browser) {
  const std::lock_guard lock(browsers_guard_);
  browsers_.erase(browser.number);
  watches_.erase(browser.number);
}

void Studio::broadcast(const Json& event) {
  const auto words = written(event);
  const std::lock_guard lock(browsers_guard_);
  send_all(words);
}

/// Requires that `browsers_guard_` is held.
void Studio::send_all(const std::shared_ptr<const std::string>& words) {
  for (const auto& [number, weak] : browsers_)
    if (const auto browser = weak.lock()) browser->send(words);
}

Studio::Working::Working(Studio& studio, std::string what, std::string file)
    : studio_(studio), what_(std::move(what)), file_(std::move(file)) {
  {
    const std::lock_guard lock(studio_.browsers_guard_);
    studio_.working_ = this;
  }
  teller_ = std::jthread([this](const std::stop_token& over) { tell_when_long(over); });
}

Studio::Working::~Working() {
  teller_.request_stop();
  teller_.join();
  const std::lock_guard lock(studio_.browsers_guard_);
  studio_.working_ = nullptr;
  if (!told) return;
  try {
    studio_.send_all(written({{"event", "working"}, {"what", nullptr}}));
  } catch (const std::exception&) {  // no memory for the event: the answer ends the work, too
  }
}

Json Studio::Working::json() const {
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  return {{"event", "working"}, {"what", what_}, {"file", file_.empty() ? Json() : Json(file_)}, {"seconds", seconds}};
}

void Studio::Working::tell_when_long(const std::stop_token& over) {
  constexpr auto patience = std::chrono::milliseconds(300);
  {
    std::mutex guard;
    std::unique_lock lock(guard);
    std::condition_variable_any never;
    if (never.wait_for(lock, over, patience, [&] { return over.stop_requested(); })) return;
  }
  const std::lock_guard lock(studio_.browsers_guard_);
  if (told) return;
  told = true;
  try {
    studio_.send_all(written(json()));
  } catch (const std::exception&) {  // no memory for the event: the answer comes anyway
  }
}

void Studio::notice(const std::string& text, const char* kind) {
  broadcast({{"event", "notice"}, {"text", text}, {"kind", kind}});
}

/// Sends the state of the queue, at most a few times per second during a render, since it changes with every sample.
void Studio::tell_queue() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
  const auto before = queue_told_.load();
  constexpr auto interval = std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::milliseconds(200));
  const Json json = queue_.json();
  bool rendering = false;
  for (const Json& entry : json["entries"]) rendering |= entry["state"] == "rendering" && entry["fraction"] > 0.0;
  if (rendering && now - before < interval.count()) return;
  queue_told_ = now;
  broadcast(json);
}

void Studio::set_watch(const Browser& browser, int slot, const Watch& watch) {
  {
    const std::lock_guard lock(browsers_guard_);
    watches_[browser.number][slot] = watch;
  }
  wake_viewer();
}

std::map<int, std::shared_ptr<const Frame>> Studio::frames(const Browser& browser) const {
  std::map<int, std::shared_ptr<const Frame>> all;
  const std::lock_guard lock(browsers_guard_);
  const auto watches = watches_.find(browser.number);
  if (watches == watches_.end()) return all;
  for (const auto& [slot, watch] : watches->second)
    if (const auto found = frames_.find(watch); found != frames_.end()) all.emplace(slot, found->second);
  return all;
}

}  // namespace etendue::studio
