#pragma once
// Light path expressions: regular expressions over the events of light paths, such as C<RD>S+L for caustics (Heckbert 1990,
// "Adaptive radiosity textures for bidirectional ray tracing", whose notation LS+DE is read from the light; Gritz, Stein, Kulla
// & Conty 2010, "Open Shading Language", whose grammar is read from the camera, as here).
//
// The events of a path are its vertices, from the camera to the emitter: C, then R, T or V for each scattering, then L, B or O.
//
//     symbol    C R T V L B O, alone: an event of this type, however it scatters
//               D G S, alone: an event that scatters this way, of any type
//               .             any event
//               'name'        an event at an object with this name
//     event     <type scattering labels>, each a symbol, '.', a set or left out: <RD>, <.S'glass'>, <L.'key'>
//     set       [RT]  any of these;  [^DG]  any event but these
//     repeated  x* x+ x? x{n} x{n,} x{n,m}
//     sequence  x y, (x y);  choice x|y, which binds more strongly than a sequence, as in OSL
// Spaces between symbols mean nothing.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// The kinds of events.
enum class PathEvent : std::uint8_t {
  camera,
  diffuse_reflection,
  glossy_reflection,
  specular_reflection,
  diffuse_transmission,
  glossy_transmission,
  specular_transmission,
  volume,      ///< scattering in a medium
  light,       ///< a luminaire that has a place, or a directional light
  background,  ///< a luminaire all around the scene
  emission,    ///< of a medium
};
inline constexpr int path_event_count = 11;
using PathEvents = std::uint16_t;  ///< a set of them, as bits
constexpr PathEvents bit(PathEvent e) { return PathEvents(1u << unsigned(e)); }
inline constexpr PathEvents all_path_events = (1u << path_event_count) - 1;
inline constexpr PathEvents path_ends = bit(PathEvent::light) | bit(PathEvent::background) | bit(PathEvent::emission);
inline constexpr PathEvents path_scatterings = all_path_events & ~path_ends & ~bit(PathEvent::camera);

/// A set of labels, as bits: indices in a list of names.
using PathLabels = std::uint64_t;
inline constexpr size_t most_path_labels = 64;

/// The names that the expressions of a picture mention, without repetition.
struct PathLabelNames {
  std::vector<std::string> names;
  /// The index of a name, which is added if it is new. Throws Error if there are too many.
  int index(const std::string& name);
};

/// The syntax tree of one expression.
class PathExpression {
 public:
  /// Throws Error, whose text tells the place, if the text is no expression. The names of its labels are added to `names`.
  PathExpression(std::string text, PathLabelNames& names);

  const std::string& text() const { return text_; }

  /// A condition on one event: one of its alternatives is true, or, if negated, none.
  struct Test {
    struct Alternative {
      PathEvents events = all_path_events;
      /// For each: the event has one of these labels, or, if negated, none of them.
      struct Labels {
        PathLabels any = 0;
        bool negated = false;
      };
      std::vector<Labels> labels = {};
    };
    bool negated = false;
    std::vector<Alternative> any;

    bool matches(PathEvent, PathLabels) const;
  };
  struct Node {
    enum class Kind : std::uint8_t { event, sequence, choice, repeated } kind = Kind::sequence;
    int test = -1;                ///< of an event
    std::vector<int> parts = {};  ///< indices of nodes
    int least = 0, most = 0;      ///< of what is repeated; most = -1: any number
  };
  const std::vector<Test>& tests() const { return tests_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  int root() const { return root_; }

  /// A label and where it stands, for errors.
  struct Mention {
    std::string name;
    size_t at = 0;
  };
  const std::vector<Mention>& mentions() const { return mentions_; }
  /// "'C<RQ>L', character 4: …"
  static std::string place(std::string_view text, size_t at, const std::string& what);

 private:
  friend class PathExpressionParser;
  std::string text_;
  std::vector<Test> tests_;
  std::vector<Node> nodes_;
  std::vector<Mention> mentions_;
  int root_ = -1;
};

}  // namespace etendue
