#pragma once
// Evaluates the limit surface of a cage, face by face, by OpenSubdiv.

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/far/topologyRefiner.h>

#include <array>
#include <memory>
#include <mutex>
#include <shared_mutex>

#include "subdivision.h"

namespace etendue {

namespace Bfr = OpenSubdiv::Bfr;
namespace Far = OpenSubdiv::Far;

/// The cage's topology: edges, faces and creases. Throws Error.
std::unique_ptr<Far::TopologyRefiner> cage_topology(const PolygonMesh&, const SubdivisionRules&);

using PatchCache = Bfr::SurfaceFactoryCacheThreaded<std::shared_mutex, std::shared_lock<std::shared_mutex>,
                                                    std::unique_lock<std::shared_mutex>>;
/// Creates the limit surfaces of faces; thread-safe.
class LimitSurfaces : public Bfr::RefinerSurfaceFactory<PatchCache> {
 public:
  explicit LimitSurfaces(const Far::TopologyRefiner&);
};

/// A point of the limit surface, evaluated from one face.
struct LimitPoint {
  Point3 position;
  Normal3 normal;  // zero if there is none
  Point2 uv;
};

/// The limit surface of one face at a time. Positions and attributes are interpolated alike.
class LimitSurface {
 public:
  LimitSurface(const LimitSurfaces& factory, const std::vector<double>& vertices, int width, const std::vector<double>& uvs)
      : factory_(&factory),
        vertices_(&vertices),
        uvs_(&uvs),
        layout_(width),
        values_(size_t(3 * width)),
        seconds_(size_t(3 * width)) {}

  /// Loads a face; returns false if it has no limit surface.
  bool load(int face);

  Bfr::Parameterization parameters() const { return surface_.GetParameterization(); }

  /// The point at (s, t). If `attributes` is not null, it receives the vertex attributes.
  LimitPoint at(const double* st, float* attributes = nullptr);

  std::array<double, 3> position(const double* st);

  /// Lengths of the derivatives by s, t, ss, st and tt.
  std::array<double, 5> sizes(const double* st);

 private:
  using Surface = Bfr::Surface<double>;
  using Layout = Surface::PointDescriptor;

  void derivatives(const double* st);
  /// The unit normal from the derivatives; returns false if they are degenerate.
  bool across(double* n) const;
  void inwards(const double* st, double* inside) const;

  const LimitSurfaces* factory_;
  const std::vector<double>*vertices_, *uvs_;
  Layout layout_;
  Surface surface_, uv_surface_;
  std::vector<double> points_, uv_points_, values_, seconds_;
};

}  // namespace etendue
