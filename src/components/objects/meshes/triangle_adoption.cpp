// TriangleObject: stores the triangles and determines their properties (closed, open edges, bounds).

#include <algorithm>

#include "geometry/closed_surface.h"
#include "geometry/embree_device.h"
#include "geometry/geometry.h"
#include "triangle_object.h"

namespace etendue {
namespace {

Normal3 unit_or_zero(const Normal3& n) {
  const float l = length(Vector3(n));
  return l > 0 && l < infinity ? Normal3(Vector3(n) / l) : Normal3{};
}

/// Up to this number of triangles planes are precomputed: this takes 1 MB and saves a tenth of a path's time.
constexpr size_t remembered_planes = 1 << 16;

}  // namespace

void make_shareable(MeshData& mesh) {
  for (Normal3& n : mesh.normals) n = unit_or_zero(n);
  mesh.positions.push_back({});
}

void TriangleObject::adopt(MeshData mesh) {
  make_shareable(mesh);
  adopt(std::make_shared<const MeshData>(std::move(mesh)));
}

void TriangleObject::adopt(std::shared_ptr<const MeshData> mesh, MeshMotion motion) {
  data_ = std::move(mesh);
  motion_ = std::move(motion);
  changed_ = {};
  lazy_ = std::make_unique<Lazy>();
  vertices_ = data_->positions.size() - 1;
  mesh_ = {data_->positions, data_->triangles, data_->normals, data_->uvs};
  if (motion_.moves()) {
    mesh_.positions = motion_.positions;
    mesh_.normals = motion_.normals;
  }
  transform.set_inner_origin(data_->centre);
  if (!transform.animated() && !transform.still().identity()) bake(transform.still());
  static constexpr Point2 plain_uvs[3] = {{0, 0}, {1, 0}, {0, 1}};
  static constexpr std::array<std::uint32_t, 3> plain_corners = {0, 1, 2};
  const bool mapped = !mesh_.uvs.empty();
  uvs_ = mapped ? mesh_.uvs.data() : plain_uvs;
  uv_corners_ = mapped ? mesh_.triangles.data() : &plain_corners;
  uv_mask_ = mapped ? ~0u : 0;
  area_ = 0;
  stored_bounds_ = {};
  for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
    area_ += double(stored_area(std::uint32_t(i)));
    for (size_t key = 0; key < std::max<size_t>(motion_.times.size(), 1); ++key)
      for (const std::uint32_t c : mesh_.triangles[i]) stored_bounds_.add(mesh_.positions[key * vertices_ + c]);
  }
  planes_.clear();
  if (!motion_.moves() && !mesh_.triangles.empty() && mesh_.triangles.size() <= remembered_planes) {
    for (const auto& t : mesh_.triangles) {
      const Point3& p = mesh_.positions[t[0]];
      planes_.push_back(plane_of(p, mesh_.positions[t[1]] - p, mesh_.positions[t[2]] - p));
    }
  }
  bounds_ = transform.animated() ? swept(transform, stored_bounds_) : stored_bounds_;
  prepare_light();
  if (transform.animated() && mesh_.triangles.size() > few) accelerator();
}

/// Computes now the data that an emitter certainly needs; other data are computed at the first use.
void TriangleObject::prepare_light() {
  light_tree_ = {};
  if (!emission) return;
  cumulative_areas();
  if (!moves() && mesh_.triangles.size() > few) build_light_tree();
}

void TriangleObject::bake(const Transform& t) {
  // Shared data are copied, not changed; a motion's data are not shared.
  std::vector<Point3>& positions = motion_.moves() ? motion_.positions : changed_.positions;
  std::vector<Normal3>& normals = motion_.moves() ? motion_.normals : changed_.normals;
  if (!motion_.moves()) {
    positions.assign(mesh_.positions.begin(), mesh_.positions.end());
    if (!t.shifts_only()) normals.assign(mesh_.normals.begin(), mesh_.normals.end());
  }
  for (Point3& p : positions) p = Point3(t(DoublePoint3(p)));
  mesh_.positions = positions;
  if (!t.shifts_only()) {
    for (Normal3& n : normals) n = unit_or_zero(t(n));
    mesh_.normals = normals;
  }
  if (!t.flips()) return;
  // The order of corners is reversed, so that they remain counter-clockwise seen from the front.
  changed_.triangles.assign(mesh_.triangles.begin(), mesh_.triangles.end());
  for (auto& corner : changed_.triangles) std::swap(corner[1], corner[2]);
  mesh_.triangles = changed_.triangles;
}

bool TriangleObject::closed() const {
  if (!lazy_) return false;  // not prepared yet
  std::call_once(lazy_->closed_known, [this] {
    const float least = least_length(stored_bounds_);
    lazy_->closed = closed_surface(mesh_.triangles, [this, least](std::uint32_t i) {
      std::uint64_t h = 0;
      for (size_t k = i; k + 1 < mesh_.positions.size(); k += vertices_)  // positions at all keys
        h = place_hash(h, mesh_.positions[k], least);
      return h;
    });
  });
  return lazy_->closed;
}

MeshNotes TriangleObject::notes() const {
  MeshNotes notes;
  notes.without_uv = mesh_.uvs.empty();
  if (data_) {
    for (const auto* list : {&data_->attributes, &data_->face_attributes})
      for (const VertexAttribute& a : *list) notes.attributes.push_back(a.name);
    notes.materials = data_->materials;
  }
  return notes;
}

// Edges are identified by the positions of their ends, as in closed_surface. An edge that occurs once is a boundary. Other
// edges are not checked: a mesh with inconsistent orientation, which is not closed either, has each edge twice.
std::uint64_t TriangleObject::open_edges() const {
  if (closed()) return 0;
  std::uint64_t open = 0;
  const float least = least_length(stored_bounds_);
  const auto key = [this, least](std::uint32_t i) { return place_hash(0, mesh_.positions[i], least); };
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * mesh_.triangles.size());
  for (const auto& t : mesh_.triangles) {
    const std::uint64_t h[3] = {key(t[0]), key(t[1]), key(t[2])};
    for (int i = 0; i < 3; ++i) {
      const std::uint64_t a = h[i], b = h[(i + 1) % 3];
      edges.push_back(mix_bits(3 * std::min(a, b) + std::max(a, b)));
    }
  }
  std::sort(edges.begin(), edges.end());
  for (size_t i = 0; i < edges.size();) {
    size_t end = i + 1;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    open += end - i == 1;
    i = end;
  }
  return open;
}

}  // namespace etendue
