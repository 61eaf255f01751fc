#pragma once
// How finely the faces of a cage and the edges between them are divided.

#include <tbb/parallel_for.h>

#include "limit_surface.h"

namespace etendue {

/// What a cage has at its vertices, as numbers of one kind.
struct CageValues {
  explicit CageValues(const PolygonMesh&);
  LimitSurface surface(const LimitSurfaces& surfaces) const { return LimitSurface(surfaces, vertices, width, uvs); }

  int width = 3;  ///< numbers of a vertex: its position and its attributes
  std::vector<double> vertices, uvs;
};

/// Calls f(surface, face) for all faces, in many threads.
template <class F>
void for_each_face(size_t faces, const LimitSurfaces& surfaces, const CageValues& values, F&& f) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, faces), [&](const tbb::blocked_range<size_t>& some) {
    LimitSurface of_face = values.surface(surfaces);
    for (size_t i = some.begin(); i < some.end(); ++i) f(of_face, int(i));
  });
}

struct CageDivision {
  struct Face {
    /// How many pieces across a face. As many both ways: the strips between very different numbers are sewn together by
    /// slanting triangles, which would span many steps of the finer one.
    int inside = 1;
    bool exists = false;
  };

  std::vector<int> edges;  ///< pieces of each
  std::vector<Face> faces;
  size_t coarse = 0;         ///< edges and faces that would need more pieces than they may have
  size_t without_limit = 0;  ///< faces that do not exist
};

/// Throws Error when no face exists.
CageDivision divide_cage(const Far::TopologyLevel&, const LimitSurfaces&, const CageValues&, const Fineness&);

}  // namespace etendue
