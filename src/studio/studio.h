#pragma once
// The studio without its network: one document, its render, and all browsers that look at it. docs/studio-protocol.md is what
// it speaks; src/studio/server brings it to browsers.

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>

#include "studio/document/document.h"
#include "studio/document/folders.h"
#include "studio/pixels/frame.h"
#include "studio/pixels/runner.h"
#include "studio/queue.h"
#include "studio/sides.h"
#include "studio/tasks.h"

namespace etendue::studio {

struct StudioSettings {
  RenderSettings render;
  Folders folders;
  bool read_only = false;
  bool viewing = false;              ///< it only shows pictures (Studio::show_pictures)
  std::vector<std::string> plugins;  ///< that were named when it was started
  /// What a user should know about a prepared job that is no error, with its kind; and which light its renderer misses.
  std::function<std::vector<std::pair<std::string, Error>>(const Job&)> warnings;
  std::function<std::vector<std::string>(const Job&)> advice;
};

/// What a page wants to see.
struct Watch {
  enum class What : std::uint8_t { none, linear, toned } what = What::none;
  int render = 0;        ///< 0: the document's own; else one beside it
  std::string layer;     ///< empty: the picture itself
  std::string tone_map;  ///< as text; empty: the job's
  bool operator==(const Watch&) const = default;
  auto operator<=>(const Watch&) const = default;
};

/// A page, as the studio sees it. `send` and `frame_ready` are called from any thread and do not wait.
class Browser {
 public:
  virtual ~Browser() = default;
  virtual void send(std::shared_ptr<const std::string> words) = 0;
  /// There is another frame of what it watches (Studio::frame).
  virtual void frame_ready() = 0;
  /// One of its requests is answered.
  virtual void answered() {}
  int number = 0;
};

/// An error that a page may have to act on.
class RequestError : public Error {
 public:
  RequestError(std::string c, const std::string& message) : Error(message), code(std::move(c)) {}
  std::string code;
};

struct Call;

class Studio {
 public:
  explicit Studio(StudioSettings);
  ~Studio();
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  /// What it begins with; empty: an empty description in the working folder. Throws when the file itself cannot be read. The
  /// rest, which takes long for a large scene, is done before the first request is answered; browsers may come meanwhile, and
  /// are told.
  void begin(const std::string& file);
  /// Whether that is still to be done.
  bool beginning() const { return beginning_; }
  /// Instead of that: pictures alone.
  void show_pictures(std::vector<std::pair<std::string, std::shared_ptr<const Image>>>);

  void join(const std::shared_ptr<Browser>&);
  void leave(const Browser&);
  /// A request; the answer goes to the browser's `send`. Never throws, whatever the text is.
  void request(const std::shared_ptr<Browser>&, std::string text);
  /// A browser watches several pictures, by slots of its own: the newest frame in each; null when there is none.
  std::map<int, std::shared_ptr<const Frame>> frames(const Browser&) const;

  /// Ends all threads. What was edited and not saved, unless a page gave it up, is written beside the description; the path of
  /// that file, else empty. Throws Error when it cannot be written.
  std::string end();
  /// Called once when a page asked for the end.
  std::function<void()> on_shutdown;
  /// Whether it asked for a new beginning after that, with plugins as they are now.
  std::atomic<bool> begin_again{false};
  /// The manual page of a class; empty when there is none.
  static std::string manual_page(const std::string& class_name);
  const StudioSettings& settings() const { return settings_; }

  // ---- for requests (requests_*.cpp), in the thread that answers them
  // --------------------------------------------------------

  Document& document() { return document_; }
  Runner& runner() { return runner_; }
  Folders& folders() { return settings_.folders; }
  void broadcast(const Json& event);
  void notice(const std::string& text, const char* kind);
  /// After an edit: tells all browsers what became of text and tree, and has the render go on.
  void tell_edit(const Applied&, const Call*);
  /// After another document came.
  void tell_all();
  void tell_document();
  Json document_json() const;
  Json text_json() const;
  Json progress_json();
  std::shared_ptr<Render> valid_render();
  /// The document's own render, or the one beside it that a number names. Throws Error when there is none.
  std::shared_ptr<Render> render_of(int number);
  Runner& runner_of(int number);
  Sides& sides() { return sides_; }
  /// Those beside the document's follow what became of it; not while a camera moves.
  void follow_sides();
  void tell_sides();
  Json sides_json();
  /// How the error of a render went down.
  Json course_json(int render);
  void set_watch(const Browser&, int slot, const Watch&);
  /// Keeps a picture for comparing; null: no longer.
  void pin(const std::string& name, std::shared_ptr<const Image>);
  /// Throws Error when there is none.
  std::shared_ptr<const Image> pinned(const std::string& name) const;
  Json pictures_json() const;
  /// Counts films begun anew.
  std::atomic<std::uint32_t> generation{1};
  std::atomic<bool> coarse{false};        ///< wanted
  std::atomic<bool> coarse_shown{false};  ///< what the render makes
  /// A moving camera's picture is made fine when this time has come.
  std::optional<std::chrono::steady_clock::time_point> fine_at;
  std::map<std::string, std::string> overrides;  ///< of the session, beside a coarse picture
  void apply_overrides();
  size_t fireflies_kept = 0;
  int movement = 0;  ///< counts movements of cameras: all steps of one are one step of undo
  Queue& queue() { return queue_; }
  Tasks& tasks() { return checks_; }
  /// Ends the program once the request at hand is answered.
  void shutdown(bool discard);
  void wake_viewer();

 private:
  struct Task {
    std::shared_ptr<Browser> from;  // null: the studio's own
    std::string text;
    std::function<void()> own = {};
  };
  /// The request that is being answered. Browsers are told of it when it takes long, by a thread of its own: every other one may be
  /// waiting for a lock that the request holds. The end of its scope is the end of the work.
  class Working {
   public:
    Working(Studio&, std::string what, std::string file);
    ~Working();
    Working(const Working&) = delete;
    Working& operator=(const Working&) = delete;
    Json json() const;
    const std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();
    bool told = false;  // guarded by browsers_guard_

   private:
    void tell_when_long(const std::stop_token&);
    Studio& studio_;
    const std::string what_, file_;
    std::jthread teller_;
  };
  void send_all(const std::shared_ptr<const std::string>& words);
  void open_first(Document::Source);
  /// A render as it is at a moment.
  struct Shown {
    int number = 0;  // 0: the document's own
    std::shared_ptr<Render> render;
    RenderSnapshot snapshot;
    Runner::Status status;
    std::uint32_t generation = 0;
    bool coarse = false;
  };
  void tell_queue();
  void note_shape(const Shown&, const Image& picture);
  void answer();
  void answer(const Task&);
  void look();
  void look_once();
  using Frames = std::map<Watch, std::shared_ptr<const Frame>>;
  void show(const Shown&, const std::set<Watch>& wanted, const Frames& before, Frames& made);
  Shown shown();
  Shown shown(Side&);
  Json progress_json(const Shown&);
  Json side_json(const Side&, const Shown&);
  std::shared_ptr<const Frame> make_frame(const Watch&, const Render&, const Image&, FrameInfo, const Frame* before);

  StudioSettings settings_;
  Document document_;
  Turns turns_;
  Runner runner_;
  Sides sides_;

  mutable std::mutex browsers_guard_;
  std::map<int, std::weak_ptr<Browser>> browsers_;
  std::map<int, std::map<int, Watch>> watches_;  // of browsers, by slots
  Frames frames_;
  int next_browser_ = 1;
  Working* working_ = nullptr;  // guarded as browsers are
  struct Shape {
    std::uint32_t generation = 0;
    int width = 0, height = 0;
    std::vector<std::string> layers;
  };
  std::map<int, Shape> shapes_;  // of the pictures that were looked at last, by render
  std::map<int, Course> courses_;
  std::uint64_t frame_number_ = 0;
  std::map<std::string, std::shared_ptr<const Image>> pins_;
  std::atomic<std::int64_t> queue_told_{0};
  size_t text_units_ = 0;  // of the text that browsers have

  std::mutex tasks_guard_;
  std::condition_variable tasks_changed_;
  std::deque<Task> tasks_;
  std::mutex viewer_guard_;
  std::condition_variable viewer_changed_;
  bool viewer_woken_ = false;
  std::atomic<bool> beginning_{false};
  std::atomic<bool> ending_{false};
  std::atomic<bool> discarded_{false};  ///< a page gave up what is not saved
  /// A page asked for the end: its own answer is the last. Of the thread that answers.
  bool goodbye_ = false;
  Queue queue_;
  Tasks checks_;
  std::thread answerer_, viewer_;
};

/// A request that is being answered.
struct Call {
  Studio& studio;
  Browser& browser;
  const Json& request;
  Json id;

  bool has(const char* key) const { return request.contains(key) && !request[key].is_null(); }
  // Each throws RequestError when the argument is missing or of another type.
  std::string text(const char* key) const;
  std::string text_or(const char* key, const std::string& otherwise) const;
  bool flag(const char* key) const;
  std::int64_t integer(const char* key, std::int64_t low, std::int64_t high) const;
  std::int64_t integer_or(const char* key, std::int64_t otherwise, std::int64_t low, std::int64_t high) const;
  double number(const char* key) const;
  double number_or(const char* key, double otherwise) const;
  std::optional<size_t> index(const char* key = "index") const;
  /// The render that 'render' names; without it the document's own.
  int render_number() const;
  std::shared_ptr<Render> render() const { return studio.render_of(render_number()); }
  Ref<Component> component(const char* key = "component") const;
};

struct Request {
  const char* name;
  bool read_only;  ///< allowed when nothing may be changed
  Json (*answer)(const Call&);
};
std::span<const Request> edit_requests();
std::span<const Request> structure_requests();
std::span<const Request> text_requests();
std::span<const Request> render_requests();
std::span<const Request> side_requests();
std::span<const Request> camera_requests();
std::span<const Request> look_requests();
std::span<const Request> file_requests();
std::span<const Request> view_requests();
std::span<const Request> picture_requests();
std::span<const Request> task_requests();

// ---- JSON of what there is (json_*.cpp)
// ---------------------------------------------------------------------------------------

Json component_json(const Document&, const Component&);
Json tree_json(const Document&);
Json names_json(const Document&);
Json error_json(const Error&, const Document*);
Json errors_json(const std::vector<Error>&, const Document*);
/// As it is sent.
std::shared_ptr<const std::string> written(const Json&);
/// Of the exception at hand.
std::vector<Error> errors_at_hand();
/// A tone map written as text that names no file. Throws Error or Errors when it is none.
Ref<ToneMap> tone_map_of(const std::string&);
/// What a page learns of the program when it says hello: classes, units, functions, names.
Json vocabulary_json();

}  // namespace etendue::studio
