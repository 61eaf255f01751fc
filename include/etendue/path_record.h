#pragma once
// PathRecord: what a path did, for people. Filled only when a sample is replayed.

#include <string>
#include <vector>

#include "etendue/ray.h"
#include "etendue/spectrum.h"

namespace etendue {

struct PathRecord {
  struct Vertex {
    std::string kind;    ///< "camera", "surface", "escaped", …
    std::string object;  ///< its name or class
    Point3 position;
    Normal3 normal;
    std::string lobe;     ///< what was sampled there; empty: the path ended
    float density = 0;    ///< [1/sr] of the sampled direction (a probability for specular lobes)
    Spectrum throughput;  ///< of the path up to here, before scattering
    Spectrum emitted;     ///< weighted contribution of light emitted here towards the path
    Spectrum direct;      ///< weighted contribution of light sampled from here
    std::string note;     ///< roulette, dispersion, media…
  };
  std::vector<Vertex> vertices;
  Wavelengths wavelengths;
  Spectrum result;
};

}  // namespace etendue
