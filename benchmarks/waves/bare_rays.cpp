#include "bare_rays.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include "etendue/mesh_facts.h"

namespace etendue::waves {

void BareTriangles::add(const std::vector<Point3>& points, const std::vector<std::array<std::uint32_t, 3>>& corners) {
  RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* p = static_cast<float*>(
      rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), points.size()));
  for (size_t i = 0; i < points.size(); ++i)
    for (int k = 0; k < 3; ++k) p[3 * i + size_t(k)] = points[i][k];
  auto* c = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), corners.size()));
  for (size_t i = 0; i < corners.size(); ++i)
    for (size_t k = 0; k < 3; ++k) c[3 * i + k] = corners[i][k];
  rtcCommitGeometry(mesh);
  rtcAttachGeometry(scene_, mesh);
  rtcReleaseGeometry(mesh);
  triangles += corners.size();
}

/// Triangulates an object that is no mesh, at a grid of its sample_area parameters; separate faces are not connected.
bool BareTriangles::add_grid(const SceneObject& object) {
  constexpr std::uint32_t side = 64;
  std::vector<Point3> points;
  std::vector<std::uint32_t> part;
  for (std::uint32_t y = 0; y <= side; ++y)
    for (std::uint32_t x = 0; x <= side; ++x) {
      const auto at = [](std::uint32_t i) { return std::min(float(i) / side, one_minus_epsilon); };
      const SurfaceSample s = object.sample_area({at(x), at(y)}, 0);
      if (!(s.pdf > 0)) return false;
      points.push_back(s.point.position);
      part.push_back(s.point.primitive);
    }
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t a = y * (side + 1) + x, b = a + 1, c = a + side + 1, d = c + 1;
      if (part[a] != part[b]) continue;
      corners.push_back({a, b, d});
      corners.push_back({a, d, c});
    }
  add(points, corners);
  return true;
}

BareTriangles::BareTriangles(const Scene& scene) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  for (const Ref<SceneObject>& object : scene.objects) {
    if (object->infinite()) continue;
    if (const std::optional<TriangleView> view = still_triangles(*object)) {
      std::vector<Point3> points;
      std::vector<std::array<std::uint32_t, 3>> corners;
      for (size_t i = 0; i < view->triangles.size(); ++i) {
        const std::uint32_t first = std::uint32_t(points.size());
        for (size_t k = 0; k < 3; ++k) points.push_back(view->positions[view->triangles[i][k]]);
        corners.push_back({first, first + 1, first + 2});
      }
      add(points, corners);
    } else if (!add_grid(*object)) {
      ++objects_left_out;
    }
  }
  rtcCommitScene(scene_);
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error("Embree does not build the scene");
}

BareTriangles::~BareTriangles() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

namespace {

void set(RTCRay& to, const Ray& ray) {
  to.org_x = ray.origin.x;
  to.org_y = ray.origin.y;
  to.org_z = ray.origin.z;
  to.dir_x = ray.direction.x;
  to.dir_y = ray.direction.y;
  to.dir_z = ray.direction.z;
  to.tnear = 0;
  to.tfar = ray.maximum;
  to.time = 0;
  to.mask = ~0u;
  to.id = 0;
  to.flags = 0;
}

}  // namespace

template <int width, class Query, class Intersect, class Occluded>
size_t BareTriangles::ask_packets(const std::vector<RecordedRay>& rays, bool coherent, Intersect intersect,
                                  Occluded occluded) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  size_t met = 0;
  for (size_t i = 0; i < rays.size();) {
    const bool shadow = rays[i].shadow;
    alignas(64) Query q;
    alignas(64) int valid[width]{};
    int n = 0;
    for (; n < width && i < rays.size() && rays[i].shadow == shadow; ++n, ++i) {
      const Ray& r = rays[i].ray;
      valid[n] = -1;
      q.ray.org_x[n] = r.origin.x, q.ray.org_y[n] = r.origin.y, q.ray.org_z[n] = r.origin.z;
      q.ray.dir_x[n] = r.direction.x, q.ray.dir_y[n] = r.direction.y, q.ray.dir_z[n] = r.direction.z;
      q.ray.tnear[n] = 0, q.ray.tfar[n] = r.maximum, q.ray.time[n] = 0, q.ray.mask[n] = ~0u, q.ray.id[n] = 0,
      q.ray.flags[n] = 0;
      q.hit.geomID[n] = RTC_INVALID_GEOMETRY_ID;
    }
    if (shadow)
      occluded(valid, scene_, &context, &q.ray);
    else
      intersect(valid, scene_, &context, &q);
    for (int k = 0; k < n; ++k) met += shadow ? q.ray.tfar[k] < 0 : q.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
  }
  return met;
}

size_t BareTriangles::ask(const std::vector<RecordedRay>& rays, Manner manner, bool coherent) const {
  if (manner == Manner::eight) return ask_packets<8, RTCRayHit8>(rays, coherent, rtcIntersect8, rtcOccluded8);
  if (manner == Manner::sixteen) return ask_packets<16, RTCRayHit16>(rays, coherent, rtcIntersect16, rtcOccluded16);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  const size_t most = manner == Manner::stream ? 256 : 1;
  std::vector<RTCRayHit> q(most);
  size_t met = 0;
  for (size_t i = 0; i < rays.size();) {
    const bool shadow = rays[i].shadow;
    unsigned n = 0;
    for (; n < most && i < rays.size() && rays[i].shadow == shadow; ++n, ++i) {
      set(q[n].ray, rays[i].ray);
      q[n].hit.geomID = RTC_INVALID_GEOMETRY_ID;
    }
    if (most == 1 && shadow)
      rtcOccluded1(scene_, &context, &q[0].ray);
    else if (most == 1)
      rtcIntersect1(scene_, &context, q.data());
    else if (shadow)
      rtcOccluded1M(scene_, &context, &q[0].ray, n, sizeof(RTCRayHit));
    else
      rtcIntersect1M(scene_, &context, q.data(), n, sizeof(RTCRayHit));
    for (unsigned k = 0; k < n; ++k) met += shadow ? q[k].ray.tfar < 0 : q[k].hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
  return met;
}

}  // namespace etendue::waves
