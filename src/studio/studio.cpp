// Studio: answers requests one after the other.

#include "studio.h"

#include <fmt/format.h>

#include <filesystem>

#include "describe/guard.h"
#include "files/input_files.h"
#include "request.h"

namespace etendue::studio {

namespace {

/// The files of shaders that were read since this was made: texts in the Open Shading Language, what they include, and
/// networks.
class ShaderFiles {
 public:
  static constexpr auto pause = std::chrono::milliseconds(250);  ///< between two looks at them

  /// Whether any of them has another content than at the last call, as far as its size and time tell.
  bool changed() {
    bool any = false;
    for (const std::string& path : read_.paths()) {
      if (!path.ends_with(".osl") && !path.ends_with(".oslgroup") && !path.ends_with(".h")) continue;
      std::error_code ignored;
      const State now{std::filesystem::last_write_time(path, ignored), std::filesystem::file_size(path, ignored)};
      const auto [known, is_new] = states_.try_emplace(path, now);
      any |= !is_new && known->second != now;
      known->second = now;
    }
    return any;
  }

 private:
  using State = std::pair<std::filesystem::file_time_type, std::uintmax_t>;
  const InputsRead read_;
  std::map<std::string, State> states_;
};

}  // namespace

namespace {

RenderSettings without_team(RenderSettings settings) {
  settings.team = nullptr;
  return settings;
}

}  // namespace

// If there is a team, it computes the document's render; side renders and the queue are computed by this process alone.
Studio::Studio(StudioSettings settings)
    : settings_(std::move(settings)),
      document_(settings_.render, settings_.folders),
      runner_(turns_),
      sides_(settings_.render, settings_.folders, turns_),
      queue_(without_team(settings_.render), [this] { tell_queue(); }),
      checks_([this](const Json& event) { broadcast(event); }) {
  settings_.render.team = nullptr;  // sides_ refers to these
  answerer_ = std::thread([this] { answer(); });
  viewer_ = std::thread([this] { look(); });
}

Studio::~Studio() {
  if (ending_) return;
  try {
    static_cast<void>(end());
  } catch (const std::exception&) {  // there is no one to report the error to
  }
}

std::string Studio::end() {
  ending_ = true;
  {
    const std::lock_guard lock(tasks_guard_);
    tasks_.clear();
  }
  tasks_changed_.notify_all();
  wake_viewer();
  answerer_.join();
  viewer_.join();
  sides_.clear();
  runner_.set(nullptr);
  const bool nothing = settings_.read_only || discarded_ || !document_.begun() || !document_.changed();
  return nothing ? std::string() : document_.save_aside();
}

void Studio::begin(const std::string& file) {
  if (file.empty()) {
    document_.create(std::filesystem::current_path().string());
    text_units_ = document_.places().size();
    runner_.set(document_.render());
    return;
  }
  Document::Source source = Document::read(std::filesystem::absolute(file).string());
  beginning_ = true;
  const std::lock_guard lock(tasks_guard_);
  tasks_.push_front({nullptr, {}, [this, source = std::move(source)]() mutable { open_first(std::move(source)); }});
  tasks_changed_.notify_one();
}

void Studio::open_first(Document::Source source) {
  {
    Working working(*this, "open", source.file);
    const std::string folder = std::filesystem::path(source.file).parent_path().string();
    try {
      document_.open(std::move(source));
    } catch (...) {  // probably no memory; errors in the text are stored as a draft
      for (const Error& error : thrown_errors()) notice(error.what(), "error");
      document_.create(folder);
    }
    text_units_ = document_.places().size();
    runner_.set(document_.render());
    runner_.start();
  }
  beginning_ = false;
}

// ---- requests ---------------------------------------------------------------------------------------------------------------

void Studio::request(const std::shared_ptr<Browser>& from, std::string text) {
  {
    const std::lock_guard lock(tasks_guard_);
    tasks_.push_back({from, std::move(text), {}});
  }
  tasks_changed_.notify_one();
}

void Studio::answer() {
  pthread_setname_np(pthread_self(), "answerer");
  ShaderFiles shaders;
  // A shader that was saved, by any editor, is compiled and rendered at once. Its faults are those of the line that names it.
  const auto follow_shaders = [&] {
    if (!shaders.changed() || !document_.begun()) return;
    const std::string text = document_.draft() ? document_.draft()->text : document_.text();
    try {
      tell_edit(document_.apply(text, {}), nullptr);
      for (const auto& side : sides_.all()) side->reload();
    } catch (...) {
      document_.set_draft(text, thrown_errors());
      tell_document();
    }
  };
  std::unique_lock lock(tasks_guard_);
  while (!ending_) {
    const auto ready = [&] { return ending_ || !tasks_.empty(); };
    if (fine_at) {
      // The camera rests: switches to full resolution.
      if (!tasks_changed_.wait_until(lock, *fine_at, ready)) {
        lock.unlock();
        fine_at.reset();
        coarse = false;
        try {
          apply_overrides();
        } catch (const std::exception& error) {
          notice(error.what(), "error");
        }
        lock.lock();
        continue;
      }
    } else if (!tasks_changed_.wait_for(lock, ShaderFiles::pause, ready)) {
      lock.unlock();
      follow_shaders();
      lock.lock();
      continue;
    }
    if (ending_) return;
    const Task task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    if (task.from) {
      answer(task);
      task.from->answered();
    } else {
      task.own();
    }
    lock.lock();
  }
}

void Studio::answer(const Task& task) {
  const bool ended_before = goodbye_;
  Json reply = {{"id", nullptr}, {"ok", false}};
  try {
    Json request;
    try {
      request = Json::parse(task.text);
    } catch (const nlohmann::json::exception& error) {
      throw RequestError("bad_request", fmt::format("invalid JSON: {}", std::string(error.what()).substr(0, largest_echo)));
    }
    if (!request.is_object()) throw RequestError("bad_request", "a request is a JSON object");
    const auto id = request.find("id");
    if (id != request.end() &&
        (id->is_number() || (id->is_string() && id->get_ref<const std::string&>().size() <= largest_echo)))
      reply["id"] = *id;
    if (goodbye_) throw RequestError("ending", "the program is about to end");
    const Call call{*this, *task.from, request, reply["id"]};
    const Request& found = request_named(call.text("do"));
    if (settings_.read_only && !found.read_only)
      throw RequestError("read_only", "this studio only shows (--read-only): nothing can be changed");
    const std::string name = found.name;
    Working working(*this, name, name == "open" ? call.text_or("file", "") : std::string());
    Json result = found.answer(call);
    reply["ok"] = true;
    for (auto& [key, value] : result.items()) reply[key] = std::move(value);
  } catch (const RequestError& error) {
    reply["errors"] = Json::array({{{"message", error.what()}, {"code", error.code}}});
  } catch (...) {
    reply["errors"] = errors_json(thrown_errors(), &document_);
  }
  try {
    task.from->send(written(reply));
  } catch (const std::exception&) {  // no memory for the reply: the page will ask again
  }
  if (!goodbye_ || ended_before) return;
  broadcast({{"event", "goodbye"}});
  if (on_shutdown) on_shutdown();
}

void Studio::shutdown(bool discard) {
  discarded_ = discard;
  goodbye_ = true;
}

std::shared_ptr<Render> Studio::valid_render() {
  std::shared_ptr<Render> render = document_.render();
  if (!render) throw RequestError("no_document", "there is nothing that can be rendered: the text has errors");
  return render;
}

std::shared_ptr<Render> Studio::render_of(int number) {
  if (number == 0) return valid_render();
  return sides_.find(number)->render();
}

Runner& Studio::runner_of(int number) { return number == 0 ? runner_ : sides_.find(number)->runner(); }

void Studio::follow_sides() {
  if (coarse || !document_.valid() || sides_.all().empty()) return;
  sides_.follow(document_, overrides);
}

void Studio::apply_overrides() {
  std::map<std::string, std::string> all = overrides;
  if (coarse && document_.valid()) {
    const ImageBuffer& image = *document_.job().image;
    constexpr int part = 4;
    // Steps of small pictures take as many paths as those of large ones; during a movement fewer are enough.
    constexpr double most_paths = 1 << 15;
    const double pixels = std::max(double(image.width) * image.height / (part * part), 1.0);
    all["renderer.samples"] = std::to_string(int(std::clamp(most_paths / pixels, 1.0, 4.0)));
    if (!document_.overrides().contains("image.width")) {  // otherwise it is at low resolution already
      all["image.width"] = std::to_string(std::max(image.width / part, 1));
      all["image.height"] = std::to_string(std::max(image.height / part, 1));
      all["image.crop"] = "[]";
    } else {
      for (const char* member : {"image.width", "image.height", "image.crop"}) all[member] = document_.overrides().at(member);
    }
  }
  static_cast<void>(document_.set_overrides(all));
  coarse_shown = coarse.load();
  ++generation;
  runner_.follow(document_.render());
  runner_.hurry();
  follow_sides();
  wake_viewer();
}

}  // namespace etendue::studio
