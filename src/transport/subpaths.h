#pragma once
// The two walks of bidirectional algorithms, and how likely a luminaire's point is to begin one.

#include <functional>

#include "etendue/camera.h"
#include "etendue/transport/sample_context.h"
#include "luminaire_sampling.h"
#include "vertex.h"

namespace etendue {

/// How long walks are.
struct WalkLimits {
  int longest = 64;                       ///< vertices, the first included
  int roulette_depth = 5;                 ///< segments before Russian roulette may end a walk
  const SampleContext* sample = nullptr;  ///< asked whether a walk may be given up; null: it may not
};

/// The longest paths of algorithms that keep a walk as a whole, in segments. A vertex takes about a kilobyte with what lies
/// around it and how it scatters, so a walk as long as this takes 100 MB for each thread.
inline constexpr int longest_kept_walk = 100000;

/// A camera whose rays are all parallel gives directions by places.
bool has_parallel_rays(const Camera&, int film_width);

/// Density of a camera ray's direction [1/sr]; of a camera with parallel rays that of its place [1/m^2].
float camera_direction_density(const Camera&, bool parallel, const Ray&);

/// The walk that begins with a camera ray. `emitted(length, light)` is called for light that media themselves send,
/// `crossed()` for luminaires that are crossed, while they are the path's last vertex.
void walk_from_camera(const RenderContext&, const Ray&, bool parallel, const WalkLimits&, Wavelengths&, SampleStream&, Arena&,
                      std::vector<Vertex>& path, std::function<void(int, const Spectrum&)>* emitted,
                      std::function<void()>* crossed);

/// A walk that begins at a luminaire, chosen by power. False: no light leaves there, and the path is empty.
bool walk_from_luminaire(const Scene&, const LightSampler&, float time, const WalkLimits&, Wavelengths&, SampleStream&, Arena&,
                         std::vector<Vertex>& path, EmittedLight&);

/// The density of a luminaire's point as the beginning of such a walk; `direction` is unit, from x1 to it. [1/m^2]; of a
/// luminaire at infinity [1/sr].
float begun_density(const LightSampler&, const Vertex& x1, const Vertex& luminaire, const Vector3& direction);

/// Its density when a luminaire is sampled as seen from x1, in the same measure.
float sampled_density(const LightSampler&, const Vertex& x1, const Vertex& luminaire, const Vector3& direction);

}  // namespace etendue
