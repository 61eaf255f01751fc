#pragma once
// PathRecord: the vertices and contributions of one path in readable form, for users and programs. Filled only when a sample is
// replayed.

#include <string>
#include <vector>

#include "etendue/core/ray.h"
#include "etendue/core/spectrum.h"

namespace etendue {

struct PathRecord {
  struct Vertex {
    std::string kind;       ///< "camera", "surface", "escaped", …
    std::string object;     ///< the name of the object, or its class
    DoublePoint3 position;  ///< in rendering space while the path is traced, then in world space (to_world_space)
    Normal3 normal;
    std::string lobe;     ///< the lobe that was sampled; empty: the path ended
    float pdf = 0;        ///< [1/sr] of the sampled direction (a probability for specular lobes)
    Spectrum throughput;  ///< of the path up to here, before scattering
    Spectrum emitted;     ///< weighted contribution of the emitter hit at this vertex
    Spectrum direct;      ///< weighted contribution of next event estimation from this vertex
    std::string note;     ///< on roulette, dispersion, media…
  };
  /// The contribution of one strategy.
  struct Contribution {
    std::string strategy;  ///< "emitter hit", "next event estimation", or the numbers of vertices from the luminaire and from
                           ///< the camera
    int length = 0;        ///< segments from the lens to the luminaire
    float weight = 1;      ///< of multiple importance sampling
    Spectrum value;        ///< weighted
    Point2 film;           ///< the film point it is added to, for splats
    bool splat = false;    ///< added to that film point as a splat, and not part of the sample's own radiance
  };
  /// The maximum number of vertices and of contributions that are stored of a very long path: the first ones, and the last.
  static constexpr size_t most = 10000;
  void add(Vertex vertex) {
    add_to(vertices, std::move(vertex), [](Vertex& last) { last.note = "vertices before this one are left out"; });
  }
  void contribute(Contribution contribution) {
    add_to(contributions, std::move(contribution), [](Contribution& last) { last.strategy += ", others before it left out"; });
  }
  /// Converts positions from rendering space to world space. To be called once, when the record is complete.
  void to_world_space(const DoublePoint3& rendering_origin) {
    for (auto* list : {&vertices, &light_vertices})
      for (Vertex& v : *list) v.position = v.position + (rendering_origin - DoublePoint3{});
  }

  std::vector<Vertex> vertices;        ///< from the camera
  std::vector<Vertex> light_vertices;  ///< from a luminaire, if the renderer traces light subpaths
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
