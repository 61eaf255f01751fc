#pragma once
// PathRecord: what a path did, for people and programs. Filled only when a sample is replayed.

#include <string>
#include <vector>

#include "etendue/core/ray.h"
#include "etendue/core/spectrum.h"

namespace etendue {

struct PathRecord {
  struct Vertex {
    std::string kind;       ///< "camera", "surface", "escaped", …
    std::string object;     ///< its name or class
    DoublePoint3 position;  ///< while it is filled as the renderer counts, then in the coordinates of the world
    Normal3 normal;
    std::string lobe;     ///< what was sampled there; empty: the path ended
    float pdf = 0;        ///< [1/sr] of the sampled direction (a probability for specular lobes)
    Spectrum throughput;  ///< of the path up to here, before scattering
    Spectrum emitted;     ///< weighted contribution of light emitted here towards the path
    Spectrum direct;      ///< weighted contribution of light sampled from here
    std::string note;     ///< roulette, dispersion, media…
  };
  /// Light one strategy brought, as it counts in the picture.
  struct Contribution {
    std::string strategy;  ///< "luminaire met", "luminaire sampled", or how many vertices come from each end
    int length = 0;        ///< segments from the lens to the luminaire
    float weight = 1;      ///< of multiple importance sampling
    Spectrum value;        ///< weighted
    Point2 film;           ///< where it falls
    bool splat = false;    ///< falls there by itself, not as part of the sample's own value
  };
  /// Of endless paths this many vertices are kept, and as many contributions: all first ones, and the last.
  static constexpr size_t most = 10000;
  void add(Vertex v) {
    add_to(vertices, std::move(v), [](Vertex& last) { last.note = "vertices before this one are left out"; });
  }
  void contribute(Contribution c) {
    add_to(contributions, std::move(c), [](Contribution& last) { last.strategy += ", others before it left out"; });
  }
  /// To be called when all is filled, with the point of the world that the renderer counts from.
  void count_from_world(const DoublePoint3& centre) {
    for (auto* list : {&vertices, &light_vertices})
      for (Vertex& v : *list) v.position = v.position + (centre - DoublePoint3{});
  }

  std::vector<Vertex> vertices;        ///< from the camera
  std::vector<Vertex> light_vertices;  ///< from a luminaire, when the renderer begins paths there
  std::vector<Contribution> contributions;
  Wavelengths wavelengths;
  Spectrum result;

 private:
  template <class T, class Mark>
  static void add_to(std::vector<T>& list, T item, const Mark& mark) {
    if (list.size() < most) {
      list.push_back(std::move(item));
    } else {
      list.back() = std::move(item);
      mark(list.back());
    }
  }
};

}  // namespace etendue
