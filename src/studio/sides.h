#pragma once
// Renders beside the document's own: of the same description with another renderer or other members, which follow its edits
// and take turns with it. Two algorithms on one scene are seen side by side that way, at equal time.

#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "studio/document/document.h"
#include "studio/pixels/runner.h"

namespace etendue::studio {

/// How far a render was at which time: what an error curve is drawn of. For one thread at a time.
class Course {
 public:
  struct Point {
    double seconds = 0, error = 0;
    std::uint32_t samples = 0;
  };
  /// A time before the last one, or fewer samples: it was begun anew.
  void add(const Point&);
  nlohmann::ordered_json json() const;

 private:
  std::vector<Point> points_;
  double spacing_ = 0;  // [s] at least between two of them
};

/// What such a render differs in from the document.
struct Difference {
  std::string renderer;  ///< class of its renderer, which keeps members of the same name; empty: the document's
  std::map<std::string, std::string> set;  ///< members by paths as of `--set`, with expressions
};

/// One such render. It has a copy of the scene: what is prepared belongs to a render (docs/drive-a-render.md).
class Side {
 public:
  Side(int number, Difference, const RenderSettings&, const Folders&, Turns&);

  /// Becomes what the document is now, with `overrides` of the session. What does not go leaves errors, and it stands still.
  void follow(const Document& leader, const std::map<std::string, std::string>& overrides);
  /// Reads all files anew that it names.
  void reload();

  const int number;
  const Difference difference;
  std::shared_ptr<Render> render() const { return document_.render(); }
  /// What it is called: its renderer's class and what else is different. For any thread, as are those below.
  std::string title() const;
  std::vector<Error> errors() const;
  std::uint32_t generation() const { return generation_; }
  Runner& runner() { return runner_; }
  void restart();

 private:
  void became(std::vector<Error>);

  Document document_;
  Runner runner_;
  bool begun_ = false;
  std::atomic<std::uint32_t> generation_{1};
  mutable std::mutex guard_;
  std::string title_;
  std::vector<Error> errors_;
};

/// All of them. Changed by the thread that answers alone.
class Sides {
 public:
  static constexpr size_t most = 4;
  Sides(const RenderSettings& settings, const Folders& folders, Turns& turns)
      : settings_(settings), folders_(folders), turns_(turns) {}

  /// Begins another one. Throws Error when there are too many, memory would not suffice, or it cannot be rendered.
  std::shared_ptr<Side> add(Difference, const Document& leader, const std::map<std::string, std::string>& overrides);
  void remove(int number);
  void clear();
  void follow(const Document& leader, const std::map<std::string, std::string>& overrides);
  /// For any thread. `find` throws Error when there is no such render.
  std::vector<std::shared_ptr<Side>> all() const;
  std::shared_ptr<Side> find(int number) const;

 private:
  const RenderSettings& settings_;
  const Folders& folders_;
  Turns& turns_;
  mutable std::mutex guard_;
  std::vector<std::shared_ptr<Side>> sides_;
  int next_ = 1;
};

}  // namespace etendue::studio
