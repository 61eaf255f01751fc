#pragma once
// PhotonProcess: the common base of algorithms whose camera paths use photons. Each step has photons of its own that all its
// paths share. Therefore all paths of a step have the same wavelengths and the same time.

#include "etendue/render/photon_beams.h"
#include "etendue/render/renderer.h"
#include "etendue/render/shown_in_space.h"

namespace etendue {

class PhotonProcess : public RenderProcess, public ShownInSpace {
 public:
  using RenderProcess::RenderProcess;

  // Shared by all paths of a step once it has photons; without photons each path has its own.
  Wavelengths wavelengths(SampleKey key, float u) const override {
    return shares_ ? wavelengths_ : RenderProcess::wavelengths(key, u);
  }
  float time(float u) const override { return shares_ ? time_ : RenderProcess::time(u); }

 protected:
  /// Samples the wavelengths and the time that the paths of a step share.
  void share(const Step&);

  struct Request {
    std::uint64_t walks = 0;  ///< light subpaths; 0: one for each pixel
    std::uint64_t most = 0;   ///< photons; if more are expected, each is stored with a probability below 1
    SubpathLimits limits = {};
    PhotonKinds kinds = PhotonKinds::all;
    const ProjectionMap* targets = nullptr;  ///< see PhotonWalks
    int fewest_vertices = 1, fewest_in_media = 1;
    bool in_homogeneous_media = true;
    double radius = 0;                    ///< of the first step [m]
    double shrinking = 1;                 ///< a: see photons.h
    const Heuristic* weighted = nullptr;  ///< weights photons against connections; null: no weights
  };

 public:
  /// The photons of a step, which bidirectional_radiance merges with.
  struct Photons {
    PhotonMap map;
    double walks = 0;                             ///< n, times the probability of a photon to be stored
    float surface_radius = 0, medium_radius = 0;  ///< [m]
    Merging merging;                              ///< n pi r^2 and n 4/3 pi r^3
    float radius(const PathVertex& vertex) const { return vertex.in_medium() ? medium_radius : surface_radius; }
    /// Calls `visit(photon, n pi r^2 or n 4/3 pi r^3)` for the photons within the radius of a vertex that are not occluded from
    /// it.
    template <class Visit>
    void near(const Scene& scene, const PathVertex& vertex, const Visit& visit) const {
      const auto merged = float(vertex.in_medium() ? merging.medium : merging.surface);
      map.within(vertex.point.position, radius(vertex), [&](const Photon& photon) {
        if (photon.in_medium == vertex.in_medium() && !photon_occluded(scene, vertex, photon, radius(vertex)))
          visit(photon, merged);
      });
    }
    /// Calls `visit(photon, t, n pi r^2)` for the photons in media within the radius of the ray's first `reach` [m] that are
    /// not occluded from it; t is the distance along the ray.
    template <class Visit>
    void along(const Scene& scene, const Ray& ray, float reach, const Visit& visit) const {
      map.tree().along(ray.origin, ray.direction, reach, surface_radius, [&](std::uint32_t i, float t) {
        const Photon& photon = map[i];
        if (photon.in_medium && !photon_occluded(scene, ray(t), {}, ray.time, photon.position, {}, surface_radius))
          visit(photon, t, float(merging.surface));
      });
    }
  };
  struct Beams {
    BeamMap map;
    double walks = 0;  ///< n, times the probability of a beam to be stored
    float radius = 0;  ///< r [m]
    /// Calls `visit(beam, s, t, n times the width)` for the beams in a medium that pass the ray's first `reach` [m] and are not
    /// occluded from it: see BeamMap::along.
    template <class Visit>
    void along(const Scene& scene, const Medium& medium, const Ray& ray, float reach, NumberStream& numbers,
               const Visit& visit) const {
      map.along(ray, reach, numbers, [&](const PhotonBeam& beam, float s, float t, float width) {
        if (beam.volume == medium.volume &&
            !photon_occluded(scene, ray(t), {}, ray.time, beam.origin + s * beam.direction, {}, radius))
          visit(beam, s, t, float(walks * double(width)));
      });
    }
  };

 protected:
  /// Traces the photons of a step, after `share`. Requests of one step with different kinds use different random numbers.
  Photons make_photons(Schedule&, const Step&, const Request&) const;
  /// A subset of the photons of several maps for display, in proportion to the sizes of the maps.
  ShownPhotons some_of(std::initializer_list<const Photons*>, size_t most) const;
  /// Traces the beams of a step, by light subpaths of their own, through homogeneous media.
  Beams make_beams(Schedule&, const Step&, const Request&) const;

 private:
  PhotonWalks walks(const Schedule&, const Step&, const Request&) const;

  bool shares_ = false;
  Wavelengths wavelengths_;
  float time_ = 0;
};

/// Describes the numbers (`std::int64_t`) of light subpaths and of photons.
template <auto walks, auto most, class R>
Description<R>& describe_photons(Description<R>& d) {
  return d
      .template member<walks>("photon_walks", "1", "walks from luminaires in each step; 0: one for each pixel", range(0, 4e9),
                              soft(0, 1e7))
      .template member<most>("most_photons", "1",
                             "about so many photons are kept in each step, which takes up to 200 bytes for each while the map "
                             "is built; where there would be more, each is kept with a chance",
                             range(1, 4e9), soft(1e5, 1e8), logarithmic);
}

/// Describes the radius of the first step and its shrinking exponent (`float`s).
template <auto radius, auto shrinking, class R>
Description<R>& describe_shrinking_radius(Description<R>& d) {
  return d
      .template member<radius>(
          "radius", "1",
          "of the first step, within which photons count, in widths of a pixel where it is first seen (the "
          "median over the picture)",
          more_than(0), soft(0.5, 30), logarithmic)
      .template member<shrinking>(
          "alpha", "1",
          "how slowly the radius shrinks: pi r^2 falls as the number of the step to the power alpha - 1, "
          "so that more of it leaves more blur and less noise",
          range(0.01, 1));
}

}  // namespace etendue
