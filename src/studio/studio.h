#pragma once
// Studio: the studio without its network part: one document, its render, and all connected browsers. docs/studio-protocol.md
// describes the messages; src/studio/server connects browsers.

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
  bool viewing = false;              ///< shows pictures only (Studio::show_pictures)
  std::vector<std::string> plugins;  ///< named at program start
  /// Called about once a second, to take up what has changed elsewhere; returns whether anything has.
  std::function<bool(class Studio&)> refresh;
  /// Warnings about a prepared job, with their kinds; and advice about light that its renderer misses.
  std::function<std::vector<std::pair<std::string, Error>>(const Job&)> warnings;
  std::function<std::vector<std::string>(const Job&)> advice;
};

/// A picture that a page watches.
struct Watch {
  enum class What : std::uint8_t { none, linear, toned } what = What::none;
  int render = 0;        ///< 0: the document's own; otherwise a side render
  std::string layer;     ///< empty: the picture itself
  std::string tone_map;  ///< as text; empty: the job's
  bool operator==(const Watch&) const = default;
  auto operator<=>(const Watch&) const = default;
};

/// A connected page. `send` and `frame_ready` are called from any thread and do not block.
class Browser {
 public:
  virtual ~Browser() = default;
  virtual void send(std::shared_ptr<const std::string> words) = 0;
  /// There is a new frame of a watched picture (Studio::frames).
  virtual void frame_ready() = 0;
  /// Called when one of its requests is answered.
  virtual void answered() {}
  int number = 0;
};

struct Call;

class Studio {
 public:
  explicit Studio(StudioSettings);
  ~Studio();
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  /// Opens a file; empty: an empty description in the working directory. Throws if the file itself cannot be read. The
  /// remaining work, which may take long for a large scene, is done before the first request is answered; browsers may connect
  /// meanwhile and are informed.
  void begin(const std::string& file);
  /// Whether this work is still going on.
  bool beginning() const { return beginning_; }
  /// Instead of `begin`: shows pictures only.
  void show_pictures(std::vector<std::pair<std::string, std::shared_ptr<const Image>>>);

  void join(const std::shared_ptr<Browser>&);
  void leave(const Browser&);
  /// Queues a request; the answer goes to the browser's `send`. Never throws, whatever the text is.
  void request(const std::shared_ptr<Browser>&, std::string text);
  /// The newest frame of each picture that a browser watches, by the browser's slots; null if there is none.
  std::map<int, std::shared_ptr<const Frame>> frames(const Browser&) const;

  /// Ends all threads. Unsaved edits, unless a page discarded them, are written to a file next to the description; returns its
  /// path, else "". Throws Error if it cannot be written.
  std::string end();
  /// Called once after a page requested the end of the program.
  std::function<void()> on_shutdown;
  /// Whether it requested a restart after the end, with the plugins' current versions.
  std::atomic<bool> begin_again{false};
  /// The manual page of a class; empty if there is none.
  static std::string manual_page(const std::string& class_name);
  const StudioSettings& settings() const { return settings_; }

  // ---- for requests (src/studio/requests), in the answering thread ------------------------------------------------------

  Document& document() { return document_; }
  Runner& runner() { return runner_; }
  Folders& folders() { return settings_.folders; }
  void broadcast(const Json& event);
  void notice(const std::string& text, const char* kind);
  /// After an edit: sends the changes of text and tree to all browsers, and updates the render.
  void tell_edit(const Applied&, const Call*);
  /// After another document was opened: sends everything to all browsers.
  void tell_all();
  void tell_document();
  Json document_json() const;
  Json text_json() const;
  Json progress_json();
  std::shared_ptr<Render> valid_render();
  /// The document's own render for 0, or the side render with this number. Throws Error if there is none.
  std::shared_ptr<Render> render_of(int number);
  Runner& runner_of(int number);
  Sides& sides() { return sides_; }
  /// Updates the side renders to the document; not while a camera moves.
  void follow_sides();
  void tell_sides();
  Json sides_json();
  /// The error of a render over time.
  Json course_json(int render);
  void set_watch(const Browser&, int slot, const Watch&);
  /// Stores a picture for comparison; null removes it.
  void pin(const std::string& name, std::shared_ptr<const Image>);
  /// Throws Error if there is none.
  std::shared_ptr<const Image> pinned(const std::string& name) const;
  Json pictures_json() const;
  /// Counts restarts of the film.
  std::atomic<std::uint32_t> generation{1};
  std::atomic<bool> coarse{false};        ///< low resolution is requested
  std::atomic<bool> coarse_shown{false};  ///< low resolution is rendered
  /// The time at which a moving camera's picture switches to full resolution.
  std::optional<std::chrono::steady_clock::time_point> fine_at;
  std::map<std::string, std::string> overrides;  ///< of this session, in addition to those for low resolution
  void apply_overrides();
  size_t fireflies_kept = 0;
  int movement = 0;  ///< number of the current camera movement, whose steps form one undo step
  Queue& queue() { return queue_; }
  Tasks& tasks() { return checks_; }
  /// Ends the program after the current request is answered.
  void shutdown(bool discard);
  void wake_viewer();

 private:
  struct Task {
    std::shared_ptr<Browser> from;  // null: a task of the studio itself
    std::string text;
    std::function<void()> own = {};
  };
  /// The request that is being answered, for the scope of this object. If it takes long, browsers are informed by a separate
  /// thread, since all others may be waiting for a lock that the request holds.
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
  /// The state of a render at one moment.
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
  std::map<int, std::map<int, Watch>> watches_;  // of browsers, by slot
  Frames frames_;
  int next_browser_ = 1;
  Working* working_ = nullptr;  // guarded by browsers_guard_
  struct Shape {
    std::uint32_t generation = 0;
    int width = 0, height = 0;
    std::vector<std::string> layers;
  };
  std::map<int, Shape> shapes_;  // of the last displayed pictures, by render
  std::map<int, Course> courses_;
  std::uint64_t frame_number_ = 0;
  std::map<std::string, std::shared_ptr<const Image>> pins_;
  std::atomic<std::int64_t> queue_told_{0};
  size_t text_units_ = 0;  // length of the text that browsers have

  std::mutex tasks_guard_;
  std::condition_variable tasks_changed_;
  std::deque<Task> tasks_;
  std::mutex viewer_guard_;
  std::condition_variable viewer_changed_;
  bool viewer_woken_ = false;
  std::atomic<bool> beginning_{false};
  std::atomic<bool> ending_{false};
  std::atomic<bool> discarded_{false};  ///< a page discarded unsaved edits
  /// A page has requested the end: the answer to this request is the last one. Used only by the answering thread.
  bool goodbye_ = false;
  Queue queue_;
  Tasks checks_;
  std::thread answerer_, viewer_;
};

// ---- JSON of components and errors (json_tree.cpp) -------------------------------------------------------------------------

Json component_json(const Document&, const Component&);
Json tree_json(const Document&);
Json names_json(const Document&);
Json error_json(const Error&, const Document*);
Json errors_json(const std::vector<Error>&, const Document*);
/// JSON as it is sent.
std::shared_ptr<const std::string> written(const Json&);
/// Parses a tone map, in which no files are allowed. Throws Error or Errors if the text is not a tone map.
Ref<ToneMap> tone_map_of(const std::string&);
/// The data about the program in the reply to "hello": classes, units, functions, names.
Json vocabulary_json();

}  // namespace etendue::studio
