#pragma once
// Light groups: the light of an image, stored separately for groups of luminaires. Light is additive: the image with the light
// of each group brighter, darker or in another colour is the sum of the groups, each times a factor. So a scene can be relit
// without rendering it again.
//
// The luminaire of a contribution is known where paths hit, sample, or start at one. There `report_light` is called, or
// `splat_light` for a contribution to another film point. The contributions are added to those of the current sample on the
// same thread (LightParts), so that paths need not carry them. Without groups the cost is the test that path lengths need
// anyway.
//
// Layers by light path expressions (path_layers.h) are stored the same way: `report_light` and `splat_light` are also given the
// expressions that the path matches.
//
// The polarization of light, for the layer "stokes", is collected in the same way (add_stokes).

#include <cstdint>
#include <span>
#include <vector>

#include "etendue/film/splat_label.h"
#include "etendue/transport/path_layers.h"
#include "etendue/transport/sample_context.h"

namespace etendue {

/// The group of each luminaire of a scene: the first group of the image that has the name of the object in the file, or of its
/// emission; the last group ("rest") if none has.
class LightGroups {
 public:
  /// For a prepared scene. Throws Error at the image if a name belongs to no luminaire.
  LightGroups(const Scene&, const ImageBuffer&);

  /// The light path expressions of the image.
  const PathLayers& paths() const { return *paths_; }
  /// Whether the Stokes vectors of light are wanted.
  bool stokes() const { return stokes_; }
  /// Whether any of these is wanted.
  bool any() const { return count_ > 0 || paths_->count() > 0 || stokes_; }
  /// The number of groups; 0: the image has none.
  int count() const { return count_; }
  /// The group of a luminaire; null: light without a luminaire, such as that of a medium.
  int of(const SceneObject* luminaire) const {
    if (!luminaire || luminaire->luminaire_index() < 0) return count_ - 1;
    return group_[size_t(luminaire->luminaire_index())];
  }

 private:
  int count_ = 0;
  bool stokes_ = false;
  std::vector<std::uint8_t> group_;  ///< of each luminaire
  std::shared_ptr<const PathLayers> paths_;
};

/// The light of a sample in the parts that a film stores: by path length, by group, by light path expression, and the rest of
/// its Stokes vector. As long as it
/// exists it collects the arguments of `report_light` on its thread; if there are several, the newest does.
class LightParts {
 public:
  /// The groups must outlive it.
  LightParts(const ImageBuffer&, const LightGroups&);
  ~LightParts();
  LightParts(const LightParts&) = delete;
  LightParts& operator=(const LightParts&) = delete;

  void clear();
  /// For PathSink::lengths. Empty if only the whole light is stored.
  std::span<Spectrum> lengths();
  /// For ImageTile::contribute.
  std::span<const Spectrum> all() const;
  /// Throws Error if expressions are wanted, and the light that was reported with its path is not the whole value of the
  /// sample: a renderer that reports only a part would make layers that are too dark.
  void require_all(const Spectrum& value, const Wavelengths&) const;

  /// Light with what a film must know of it.
  struct Labelled {
    SplatLabel label;
    Spectrum light;
  };
  /// Keeps each part of the light by itself, for algorithms that make splats of it.
  void keep_labelled() { keeps_labelled_ = true; }
  std::span<const Labelled> labelled() const { return labelled_; }

  /// These functions call the object that collects on this thread, if any:
  static void add(int length, const SceneObject* luminaire, const Spectrum&, PathState matches);
  static void add(const Labelled&);
  static void weigh(const Spectrum&);  ///< multiplies all light
  /// S1, S2 and S3 of light of which S0 is given to report_light, relative to the camera's reference direction.
  static void add_stokes(const Spectrum& s1, const Spectrum& s2, const Spectrum& s3);
  /// Calls `visit(label, light)` for each part of the light that has a label of its own.
  template <class Visit>
  static void each_label(int length, const SceneObject* luminaire, const Spectrum& light, PathState matches,
                         const Visit& visit) {
    if (!collecting_) return visit(SplatLabel{length}, light);
    const int group = collecting_->groups_.count() > 0 ? collecting_->groups_.of(luminaire) : -1;
    if (collecting_->groups_.paths().count() == 0 || !matches.known()) return visit(SplatLabel{length, group}, light);
    collecting_->states_.each(matches, light,
                              [&](std::uint32_t set, const Spectrum& part) { visit(SplatLabel{length, group, set}, part); });
  }
  /// The number for Splat::length.
  static int packed(const SplatLabel& label) { return label.packed(collecting_ ? size_t(collecting_->groups_.count()) : 0); }

 private:
  void take(const SplatLabel&, const Spectrum&);

  const LightGroups& groups_;
  const size_t lengths_;  ///< the number of lengths that the film stores
  size_t first_group_, first_expression_;
  std::vector<Spectrum> parts_;
  Spectrum told_;  ///< light whose path is known
  bool keeps_labelled_ = false;
  std::vector<Labelled> labelled_;
  PathStates states_;
  LightParts* const before_;  ///< the object that collected on this thread before

  static thread_local constinit LightParts* collecting_;
};

/// Adds light that is a part of the sample's own radiance, from a path of `length` segments that starts at a luminaire (null:
/// at none, such as light of a medium), and matches these expressions. Replaces PathSink::light where the luminaire is known.
[[gnu::always_inline]] inline void report_light(PathSink& sink, int length, const Spectrum& light, const SceneObject* luminaire,
                                                PathState matches = {}) {
  if (sink.lengths.empty()) [[likely]]
    return;
  sink.light(length, light);
  LightParts::add(length, luminaire, light, matches);
}

/// The same for light that is splatted to another film point.
inline void splat_light(SampleContext& sample, Point2 film, const Spectrum& light, const Wavelengths& wavelengths, int length,
                        const SceneObject* luminaire, PathState matches = {}) {
  if (sample.sink.splats)
    LightParts::each_label(length, luminaire, light, matches, [&](const SplatLabel& label, const Spectrum& part) {
      sample.sink.splat(film, part, wavelengths, LightParts::packed(label));
    });
}

}  // namespace etendue
