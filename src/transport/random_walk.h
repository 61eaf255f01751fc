#pragma once
// Random walks: paths that grow from the camera or from a luminaire by being scattered.

#include <functional>
#include <vector>

#include "etendue/transport/sample_context.h"
#include "vertex.h"

namespace etendue {

/// A walk's beginning and its rules.
struct WalkStart {
  Ray ray;
  Spectrum throughput{1.0f};
  float direction_density = 0;  ///< [1/sr] of the ray's direction, seen from the first vertex
  Transport transport = Transport::radiance;
  int longest = 64;                       ///< vertices, the first included
  int roulette_depth = 5;                 ///< segments before Russian roulette may end the walk
  const SampleContext* sample = nullptr;  ///< asked whether the walk may be given up; null: it may not
  /// Called for light that media themselves send towards the camera: its length in segments, and what it brings.
  std::function<void(int length, const Spectrum&)>* emitted = nullptr;
  /// Called for luminaires whose surface passes light straight on, while they are the path's last vertex for a moment.
  std::function<void()>* crossed = nullptr;
};

/// Continues a path whose first vertex is given by scattering until it is absorbed, leaves the scene, or is long enough.
/// Boundaries that mean nothing and surfaces that light passes straight on are crossed, not made vertices. `media`
/// are those around the first vertex. Wavelengths lose their secondary ones at dispersive events. An escaped camera walk
/// ends with a vertex of kind `escape`.
void random_walk(const Scene&, const WalkStart&, MediumStack media, Wavelengths&, SampleStream&, Arena&,
                 std::vector<Vertex>& path);

}  // namespace etendue
