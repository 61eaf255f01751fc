#pragma once
// Tessellation rates: the number of pieces into which each face and each edge of a cage is divided.

#include <tbb/parallel_for.h>

#include "limit_surface.h"

namespace etendue {

/// Positions, attributes and surface coordinates of a cage as arrays of doubles, for OpenSubdiv.
struct CageValues {
  explicit CageValues(const PolygonMesh&);
  LimitSurface surface(const LimitSurfaces& surfaces) const { return LimitSurface(surfaces, vertices, width, uvs); }

  int width = 3;  ///< numbers of a vertex: its position and its attributes
  std::vector<double> vertices, uvs;
};

/// Calls f(surface, face) for all faces, in parallel.
template <class F>
void for_each_face(size_t faces, const LimitSurfaces& surfaces, const CageValues& values, F&& f) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, faces), [&](const tbb::blocked_range<size_t>& some) {
    LimitSurface of_face = values.surface(surfaces);
    for (size_t i = some.begin(); i < some.end(); ++i) f(of_face, int(i));
  });
}

struct CageDivision {
  struct Face {
    /// Pieces across a face, equal in both directions: between very different rates, strips are joined by slanting triangles
    /// that would span many steps of the finer one.
    int inside = 1;
    bool exists = false;
  };

  std::vector<int> edges;  ///< number of pieces of each edge
  std::vector<Face> faces;
  size_t coarse = 0;         ///< number of edges and faces that would need more pieces than allowed
  size_t without_limit = 0;  ///< number of faces that do not exist
};

/// Throws Error when no face exists.
CageDivision divide_cage(const Far::TopologyLevel&, const LimitSurfaces&, const CageValues&, const Fineness&);

}  // namespace etendue
