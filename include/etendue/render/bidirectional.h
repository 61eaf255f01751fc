#pragma once
// The estimator of all bidirectional algorithms: bidirectional path tracing (Veach 1997, chapter 10), light tracing, and vertex
// connection and merging (Georgiev et al. 2012). They differ in the strategies that they combine:
//
//     BidirectionalPathTracer      emitter hits, next event estimation, connections, lens
//     VertexConnectionMerging      the same and merging
//     LightTracer                  lens alone
//
// With C_{s,t} the contribution of the strategy that takes s vertices from a luminaire and t from the lens, and w its multiple
// importance sampling weight (transport/bidirectional_weight.h), one sample is
//     sum_{s,t} w_{s,t} C_{s,t}  +  sum_t sum_p w_{p,t} alpha_p f(z_{t-1}, w_p) alpha_t / (n pi r^2),
// the second sum being over the photons p within r of z_{t-1}, of n light subpaths.

#include "etendue/render/learned_guide.h"
#include "etendue/render/photon_process.h"
#include "etendue/transport/bidirectional_subpaths.h"

namespace etendue {

/// The strategies that an algorithm combines. Merging is one of them when the estimator is given photons. Weights do not depend
/// on the choice: a strategy that is left out leaves its share out, unless `weighted` is false.
struct BidirectionalStrategies {
  bool emitter_hits = true;  ///< s = 0
  bool next_event = true;    ///< s = 1
  bool connections = true;   ///< s > 1, t > 1
  bool lens = true;          ///< t = 1
  /// Whether light subpaths are connected at all. If not, photons are all scattered light at the first vertex that is not
  /// specular, and the camera subpath is used only up to it: progressive photon mapping.
  bool connecting() const { return next_event || connections || lens; }
  /// Whether a camera subpath is traced.
  bool from_camera() const { return emitter_hits || next_event || connections; }
};

struct BidirectionalSettings {
  int max_depth = 64;  ///< longest path, in segments
  int roulette_depth = 5;
  Heuristic heuristic = Heuristic::power;
  bool weighted = true;  ///< false: every w is 1, and each strategy shows all light that it finds
  BidirectionalStrategies strategies = {};
  int light_vertices = -1, camera_vertices = -1;  ///< the only s, the only t; -1: all

  bool uses(int s, int t) const {
    return (light_vertices < 0 || s == light_vertices) && (camera_vertices < 0 || t == camera_vertices);
  }
};

/// Fluorescence of surfaces is followed, unless there are photons: these have no level (transport/fluorescence.h). Dyes in
/// media are found by strategies without weights alone, since the vertices where they emit have no pdfs.
///
/// One sample of the radiance along a camera ray [W m^-2 sr^-1 nm^-1], with splats in the sample's PathSink. `photons`: merging
/// is a strategy too; null: it is not. `guide`: the camera subpath samples directions from it, and trains it; null: there is
/// none.
Spectrum bidirectional_radiance(const RenderContext&, const LightSampler&, const Ray&, SampleContext&,
                                const BidirectionalSettings&, const PhotonProcess::Photons* photons = nullptr,
                                const LearnedGuide* guide = nullptr);

}  // namespace etendue
