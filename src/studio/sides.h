#pragma once
// Side renders: renders of the same description with another renderer or other members, which follow the document's edits and
// take turns with its own render. They compare two algorithms on one scene, at equal time.

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

/// The error of a render over time, for an error curve. Used by one thread at a time.
class Course {
 public:
  struct Point {
    double seconds = 0, error = 0;
    std::uint32_t samples = 0;
  };
  /// A time or a number of samples below that of the last point means that the render was restarted: clears the curve.
  void add(const Point&);
  nlohmann::ordered_json json() const;

 private:
  std::vector<Point> points_;
  double spacing_ = 0;  // [s] least spacing of points
};

/// The difference of a side render from the document.
struct Difference {
  std::string renderer;  ///< class of its renderer, which keeps members of the same name; empty: the document's
  std::map<std::string, std::string> set;  ///< member paths as for `--set`, with expressions
};

/// A side render. It has its own copy of the scene, since prepared components belong to one render (docs/drive-a-render.md).
class Side {
 public:
  Side(int number, Difference, const RenderSettings&, const Folders&, Turns&);

  /// Updates to the document's present state, with the session's `overrides`. On errors, these are stored and the render stops.
  void follow(const Document& leader, const std::map<std::string, std::string>& overrides);
  /// Reads all files that it names again.
  void reload();

  const int number;
  const Difference difference;
  std::shared_ptr<Render> render() const { return document_.render(); }
  /// Its title: the renderer's class and the other differences. This function and those below may be called from any thread.
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

/// All side renders. Modified only by the thread that answers requests.
class Sides {
 public:
  static constexpr size_t most = 4;
  Sides(const RenderSettings& settings, const Folders& folders, Turns& turns)
      : settings_(settings), folders_(folders), turns_(turns) {}

  /// Starts a side render. Throws Error if there are too many, memory is insufficient, or it cannot be rendered.
  std::shared_ptr<Side> add(Difference, const Document& leader, const std::map<std::string, std::string>& overrides);
  void remove(int number);
  void clear();
  void follow(const Document& leader, const std::map<std::string, std::string>& overrides);
  /// May be called from any thread. `find` throws Error if there is no such render.
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
