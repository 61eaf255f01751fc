#pragma once
// Layers of a picture by light path expressions (paths/path_expression.h), for every way in which paths are made.
//
// A part of a path is described by the state of an automaton that has read its events (paths/path_automaton.h): from the camera
// on by a forward state, from the emitter on by a backward state. Where an algorithm has a whole path, the two give the set of
// expressions that it matches.
//
// A surface may scatter the same pair of directions both diffusely and glossily, f = f_D + f_G. Such an event is D with the
// weight f_D / f and G with the weight f_G / f, for each wavelength: an algorithm that evaluates f (next event estimation,
// connections, merging) has sampled no lobe, and one that samples a lobe divides by the pdf of all. So the state of a path is a
// distribution: a list of states, each with the part of the light that belongs to it. The parts add up to 1, so the layers of
// expressions that divide all paths add up to the picture. With one kind of smooth lobe at each vertex there is one state, and
// nothing is evaluated.

#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "etendue/core/spectrum.h"
#include "etendue/film/image_buffer.h"
#include "etendue/paths/path_automaton.h"
#include "etendue/scene.h"
#include "etendue/shader.h"

namespace etendue {

struct PathVertex;

/// The expressions of a picture, for a scene: which labels its objects have.
class PathLayers {
 public:
  /// For a prepared scene. Throws Error at the image if a label names nothing in the scene.
  PathLayers(const Scene&, const ImageBuffer&);

  /// The number of expressions.
  size_t count() const { return count_; }
  const PathAutomaton& automaton() const { return automaton_; }
  /// The class of labels of an object together with a part of it: its shader, emission or interior; either may be null.
  int class_of(const SceneObject*, const Component* part) const;
  /// The event with which a path begins at a luminaire; null: emitted by a medium.
  static PathEvent end_at(const SceneObject* luminaire);

 private:
  PathLabels labels_of(const Component*) const;

  size_t count_ = 0;
  PathAutomaton automaton_;
  std::unordered_map<const Component*, PathLabels> labels_;
  std::vector<PathLabels> classes_;
};

/// The state of a part of a path: a state of an automaton or, if below `mixed`, an index of a distribution of states that is
/// stored in the PathStates of the thread. Also the set of expressions that a whole path matches.
struct PathState {
  static constexpr std::uint32_t mixed = 1u << 24, unknown = ~0u;
  std::uint32_t value = unknown;  ///< by default unknown: the algorithm does not tell
  bool known() const { return value != unknown; }
};
/// Of a path that has left the camera.
inline constexpr PathState path_after_camera{PathAutomaton::after_camera};

/// Follows the paths of one thread. As long as it exists it is the one of its thread; if there are several, the newest is.
class PathStates {
 public:
  /// Without expressions it does nothing, and `current` stays what it was. The layers must outlive it.
  explicit PathStates(const PathLayers*);
  ~PathStates();
  PathStates(const PathStates&) = delete;
  PathStates& operator=(const PathStates&) = delete;

  /// That of this thread; null: no expressions are wanted.
  static PathStates* current() { return current_; }
  /// Forgets all distributions, and with them the states that refer to them.
  void clear();

  /// The forward state after a vertex that scatters light from `in`, by the lobe if it is specular.
  PathState scattered(PathState before, const PathVertex&, const Vector3& in, Lobe = diffuse_reflection);
  /// The same for scattering in a medium, whatever the directions.
  PathState scattered_in(PathState before, const SceneObject* medium);
  /// The backward state before such a vertex of a light subpath, which scatters light towards `on`.
  PathState scattered_before(PathState after, const PathVertex&, const Vector3& on, Lobe = diffuse_reflection);
  /// The backward state of the first vertex of a light subpath.
  PathState begun(const SceneObject* luminaire) const;
  /// The expressions that a path matches which ends at a luminaire (null: in a medium that emits; `medium` is its object).
  PathState ended(PathState, const SceneObject* luminaire, const SceneObject* medium = nullptr);
  /// For a part of a path that goes on with one of its wavelengths, of this index, alone: the weights of that for all.
  PathState alone(PathState, int lane);
  /// The expressions that a path of two parts matches.
  PathState joined(PathState first, PathState rest);

  /// A state, or set of expressions, and the part of the light that belongs to it.
  struct Part {
    std::uint32_t value = 0;
    Spectrum weight{1.0f};
  };
  /// Calls `visit(value, light)` for each part of some light.
  template <class Visit>
  void each(PathState state, const Spectrum& light, const Visit& visit) const {
    if (state.value < PathState::mixed) return visit(state.value, light);
    const Range range = ranges_[state.value - PathState::mixed];
    for (size_t i = range.begin; i < range.end; ++i) visit(parts_[i].value, light * parts_[i].weight);
  }

 private:
  struct Range {
    std::uint32_t begin = 0, end = 0;
  };
  struct Event {
    PathEvent event;
    Spectrum weight;
  };
  struct Events {
    Event all[2];
    int count = 0, label_class = 0;
  };
  Events events_at(const PathVertex&, const Vector3& in, Lobe, Transport) const;
  /// The distribution with the states next(state, i) for each state and i < count, with these weights.
  template <class Next, class Weight>
  PathState made(PathState, size_t count, const Next&, const Weight&);
  std::span<const Part> parts_of(PathState, Part& single) const;
  PathState stored(std::vector<Part>&);

  const PathLayers* layers_;
  PathStates* const before_;
  std::vector<Part> parts_, scratch_;
  std::vector<Range> ranges_;

  static thread_local constinit PathStates* current_;
};

}  // namespace etendue
