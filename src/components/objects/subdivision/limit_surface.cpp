// Limit surfaces by OpenSubdiv. Each face of the cage is a separate surface over (s, t): bicubic (or quartic box-spline)
// patches where the cage is regular, and around irregular vertices and creases a hierarchy of smaller patches, with
// `smooth_depth` or `sharp_depth` levels (Nießner et al. 2012, "Feature-adaptive GPU rendering of Catmull-Clark subdivision
// surfaces"), and with Gregory patches at the last level, which interpolate the limit's points and tangents at their corners.

#include "limit_surface.h"

#include <opensubdiv/far/topologyDescriptor.h>

#include "etendue/core/error.h"

namespace etendue {
namespace {

namespace Sdc = OpenSubdiv::Sdc;

// The depths exceed OpenSubdiv's defaults of 2 and 6, because between their corners Gregory patches only approximate the limit;
// patches are cached for each type of vertex, so depth costs little.
constexpr int smooth_depth = 5, sharp_depth = 8;

const Bfr::Surface<double>::PointDescriptor uv_layout{2};

Sdc::SchemeType scheme_type(SubdivisionRules::Scheme s) {
  return s == SubdivisionRules::Scheme::loop
             ? Sdc::SCHEME_LOOP
             : (s == SubdivisionRules::Scheme::bilinear ? Sdc::SCHEME_BILINEAR : Sdc::SCHEME_CATMARK);
}

}  // namespace

std::unique_ptr<Far::TopologyRefiner> cage_topology(const PolygonMesh& cage, const SubdivisionRules& rules) {
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(Sdc::Options::VtxBoundaryInterpolation(rules.boundary));
  options.SetFVarLinearInterpolation(Sdc::Options::FVarLinearInterpolation(rules.uv_boundary));
  static_assert(int(SubdivisionRules::Boundary::edges) == Sdc::Options::VTX_BOUNDARY_EDGE_ONLY &&
                int(SubdivisionRules::UvBoundary::linear) == Sdc::Options::FVAR_LINEAR_ALL);
  // OpenSubdiv's indices are signed.
  const auto indices = [](const std::vector<std::uint32_t>& v) { return reinterpret_cast<const int*>(v.data()); };
  Far::TopologyDescriptor d;
  d.numVertices = int(cage.positions.size());
  d.numFaces = int(cage.face_sizes.size());
  d.numVertsPerFace = indices(cage.face_sizes);
  d.vertIndicesPerFace = indices(cage.corners);
  d.numCreases = int(rules.creases.size());
  d.creaseVertexIndexPairs = reinterpret_cast<const int*>(rules.creases.data());
  d.creaseWeights = rules.crease_sharpness.data();
  d.numCorners = int(rules.corners.size());
  d.cornerVertexIndices = indices(rules.corners);
  d.cornerWeights = rules.corner_sharpness.data();
  Far::TopologyDescriptor::FVarChannel uvs;
  if (!cage.uv_corners.empty()) {
    uvs.numValues = int(cage.uvs.size());
    uvs.valueIndices = indices(cage.uv_corners);
    d.numFVarChannels = 1;
    d.fvarChannels = &uvs;
  }
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  std::unique_ptr<Far::TopologyRefiner> made(Factory::Create(d, Factory::Options(scheme_type(rules.scheme), options)));
  if (!made) throw Error("its faces do not make a surface");
  return made;
}

LimitSurfaces::LimitSurfaces(const Far::TopologyRefiner& topology)
    : Bfr::RefinerSurfaceFactory<PatchCache>(topology,
                                             Options().SetApproxLevelSmooth(smooth_depth).SetApproxLevelSharp(sharp_depth)) {}

bool LimitSurface::load(int face) {
  if (!(uvs_->empty() ? factory_->InitVertexSurface(face, &surface_)
                      : factory_->InitSurfaces(face, &surface_, &uv_surface_, nullptr, 1)))
    return false;
  points_.resize(size_t(surface_.GetNumPatchPoints()) * size_t(layout_.size));
  surface_.PreparePatchPoints(vertices_->data(), layout_, points_.data(), layout_);
  if (!uvs_->empty()) {
    uv_points_.resize(size_t(uv_surface_.GetNumPatchPoints()) * 2);
    uv_surface_.PreparePatchPoints(uvs_->data(), uv_layout, uv_points_.data(), uv_layout);
  }
  return true;
}

LimitPoint LimitSurface::at(const double* st, float* attributes) {
  LimitPoint p;
  double cross_product[3];
  derivatives(st);
  p.position = {float(values_[0]), float(values_[1]), float(values_[2])};
  if (attributes)
    for (int i = 3; i < layout_.size; ++i) attributes[i - 3] = float(values_[size_t(i)]);
  if (!across(cross_product)) {  // a derivative vanishes at some corners: the normal of a nearby point is used
    double inside[2];
    inwards(st, inside);
    derivatives(inside);
    if (!across(cross_product)) cross_product[0] = cross_product[1] = cross_product[2] = 0;
  }
  p.normal = {float(cross_product[0]), float(cross_product[1]), float(cross_product[2])};
  if (!uvs_->empty()) {
    double uv[2];
    uv_surface_.Evaluate(st, uv_points_.data(), uv_layout, uv);
    p.uv = {float(uv[0]), float(uv[1])};
  }
  return p;
}

std::array<double, 3> LimitSurface::position(const double* st) {
  surface_.Evaluate(st, points_.data(), layout_, values_.data());
  return {values_[0], values_[1], values_[2]};
}

std::array<double, 5> LimitSurface::sizes(const double* st) {
  const size_t w = size_t(layout_.size);
  double *const first = values_.data(), *const second = seconds_.data();
  surface_.Evaluate(st, points_.data(), layout_, first, first + w, first + 2 * w, second, second + w, second + 2 * w);
  const auto size = [](const double* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); };
  return {size(first + w), size(first + 2 * w), size(second), size(second + w), size(second + 2 * w)};
}

void LimitSurface::derivatives(const double* st) {
  const size_t w = size_t(layout_.size);
  surface_.Evaluate(st, points_.data(), layout_, values_.data(), values_.data() + w, values_.data() + 2 * w);
}

bool LimitSurface::across(double* n) const {
  const double *const s = values_.data() + layout_.size, *const t = s + layout_.size;
  n[0] = s[1] * t[2] - s[2] * t[1];
  n[1] = s[2] * t[0] - s[0] * t[2];
  n[2] = s[0] * t[1] - s[1] * t[0];
  const double ss = s[0] * s[0] + s[1] * s[1] + s[2] * s[2], tt = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
  const double nn = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  if (!(nn > 1e-12 * ss * tt)) return false;
  for (int k = 0; k < 3; ++k) n[k] /= std::sqrt(nn);
  return true;
}

void LimitSurface::inwards(const double* st, double* inside) const {
  constexpr double step = 1e-2;
  const Bfr::Parameterization p = parameters();
  double local[2] = {st[0], st[1]};
  const int part = p.HasSubFaces() ? p.ConvertCoordToNormalizedSubFace(st, local) : 0;
  const double centre = p.GetType() == Bfr::Parameterization::TRI ? 1 / 3.0 : 0.5;
  for (double& x : local) x += step * (centre - x);
  inside[0] = local[0];
  inside[1] = local[1];
  if (p.HasSubFaces()) p.ConvertNormalizedSubFaceToCoord(part, local, inside);
}

}  // namespace etendue
