#pragma once
// Light groups: the light of an image, stored separately for groups of luminaires. Light is additive: the image with the light
// of each group brighter, darker or in another colour is the sum of the groups, each times a factor. So a scene can be relit
// without rendering it again.
//
// The luminaire of a contribution is known where paths hit, sample, or start at one. There `report_light` is called, or
// `splat_light` for a contribution to another film point. The contributions are added to those of the current sample on the
// same thread (LightParts), so that paths need not carry them. Without groups the cost is the test that path lengths need
// anyway.

#include <cstdint>
#include <span>
#include <vector>

#include "etendue/film/splat_label.h"
#include "etendue/transport/sample_context.h"

namespace etendue {

/// The group of each luminaire of a scene: the first group of the image that has the name of the object in the file, or of its
/// emission; the last group ("rest") if none has.
class LightGroups {
 public:
  /// For a prepared scene. Throws Error at the image if a name belongs to no luminaire.
  LightGroups(const Scene&, const ImageBuffer&);

  /// The number of groups; 0: the image has none.
  int count() const { return count_; }
  /// The group of a luminaire; null: light without a luminaire, such as that of a medium.
  int of(const SceneObject* luminaire) const {
    if (!luminaire || luminaire->luminaire_index() < 0) return count_ - 1;
    return group_[size_t(luminaire->luminaire_index())];
  }

 private:
  int count_ = 0;
  std::vector<std::uint8_t> group_;  ///< of each luminaire
};

/// The light of a sample in the parts that a film stores: by path length and by group. As long as it exists it collects the
/// arguments of `report_light` on its thread; if there are several, the newest does.
class LightParts {
 public:
  /// The groups must outlive it.
  LightParts(const ImageBuffer&, const LightGroups&);
  ~LightParts();
  LightParts(const LightParts&) = delete;
  LightParts& operator=(const LightParts&) = delete;

  void clear();
  /// For PathSink::lengths. Empty if neither lengths nor groups are stored.
  std::span<Spectrum> lengths();
  /// For ImageTile::contribute.
  std::span<const Spectrum> all() const;

  /// These functions call the object that collects on this thread, if any:
  static void add(const SceneObject* luminaire, const Spectrum&);
  static void weigh(const Spectrum&);  ///< multiplies the light of all groups
  static SplatLabel label(int length, const SceneObject* luminaire);

 private:
  const LightGroups& groups_;
  const size_t lengths_;  ///< the number of lengths that the film stores
  size_t first_group_;
  std::vector<Spectrum> parts_;
  LightParts* const before_;  ///< the object that collected on this thread before
};

/// Adds light that is a part of the sample's own radiance, from a path of `length` segments that starts at a luminaire (null:
/// at none, such as light of a medium). Replaces PathSink::light where the luminaire is known.
[[gnu::always_inline]] inline void report_light(PathSink& sink, int length, const Spectrum& light,
                                                const SceneObject* luminaire) {
  if (sink.lengths.empty()) [[likely]]
    return;
  sink.light(length, light);
  LightParts::add(luminaire, light);
}

/// The same for light that is splatted to another film point.
inline void splat_light(SampleContext& sample, Point2 film, const Spectrum& light, const Wavelengths& wavelengths, int length,
                        const SceneObject* luminaire) {
  if (sample.sink.splats) sample.sink.splat(film, light, wavelengths, LightParts::label(length, luminaire).packed());
}

}  // namespace etendue
