#pragma once
// Light groups: the light of a picture, kept apart by the luminaires that it comes from. Light adds up, so that the picture
// with each group made brighter, darker or of another colour is the sum of the groups, each multiplied: a scene is lit anew
// without rendering it again.
//
// Which luminaire a part of the light comes from is known where paths meet, sample, or begin at one: there `report_light` is
// called, and `splat_light` for what is brought elsewhere on the film. What is collected is of the sample at hand on the same
// thread (LightParts), so that nothing has to carry it along paths. It costs the test that path lengths cost already when
// nobody wants groups.

#include <cstdint>
#include <span>
#include <vector>

#include "etendue/film/splat_label.h"
#include "etendue/transport/sample_context.h"

namespace etendue {

/// Which group each luminaire of a scene is in: the first of those that the image asks for which has the name of the object
/// as the user wrote it, or of its emission; the last ("rest") if none has.
class LightGroups {
 public:
  /// Throws an Error at the image when a name is of no luminaire. Of a scene that is prepared.
  LightGroups(const Scene&, const ImageBuffer&);

  /// 0: the image wants none.
  int count() const { return count_; }
  /// null: light of no luminaire, such as that of a medium.
  int of(const SceneObject* luminaire) const {
    if (!luminaire || luminaire->luminaire_index < 0) return count_ - 1;
    return group_[size_t(luminaire->luminaire_index)];
  }

 private:
  int count_ = 0;
  std::vector<std::uint8_t> group_;  ///< of each luminaire
};

/// The light of a sample in the parts that a film keeps: by path length and by group. As long as it lives it collects what
/// `report_light` is told on its thread; of several the one made last.
class LightParts {
 public:
  /// The groups must outlive it.
  LightParts(const ImageBuffer&, const LightGroups&);
  ~LightParts();
  LightParts(const LightParts&) = delete;
  LightParts& operator=(const LightParts&) = delete;

  void clear();
  /// For PathSink::lengths. Empty when neither lengths nor groups are wanted.
  std::span<Spectrum> lengths();
  /// For ImageTile::contribute.
  std::span<const Spectrum> all() const;

  /// Of the one that collects on this thread, if any:
  static void add(const SceneObject* luminaire, const Spectrum&);
  static void weigh(const Spectrum&);  ///< multiplies what groups have
  static SplatLabel label(int length, const SceneObject* luminaire);

 private:
  const LightGroups& groups_;
  const size_t lengths_;  ///< those the film keeps
  size_t first_group_;
  std::vector<Spectrum> parts_;
  LightParts* const before_;  ///< that collected on this thread
};

/// Light, a part of the sample's own value, that came by a path of so many segments from a luminaire (null: from none, such as
/// that of a medium). In place of PathSink::light, where that is known.
[[gnu::always_inline]] inline void report_light(PathSink& sink, int length, const Spectrum& light,
                                                const SceneObject* luminaire) {
  if (sink.lengths.empty()) [[likely]]
    return;
  sink.light(length, light);
  LightParts::add(luminaire, light);
}

/// The same of light that is brought to another place of the film.
inline void splat_light(SampleContext& sample, Point2 film, const Spectrum& light, const Wavelengths& w, int length,
                        const SceneObject* luminaire) {
  if (sample.sink.splats) sample.sink.splat(film, light, w, LightParts::label(length, luminaire).packed());
}

}  // namespace etendue
