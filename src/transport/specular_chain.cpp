#include "etendue/transport/specular_chain.h"

#include "etendue/transport/boundaries.h"

namespace etendue {

void ChainTracer::begin(const PathVertex& receiver, const Vector3& direction) {
  MediumStack scratch;
  const MediumStack* media = tracks_ ? media_towards(receiver, direction, scratch) : nullptr;
  begin(leaving_ray(receiver, direction), media ? *media : MediumStack{});
  from = receiver.point.position;
}

void ChainTracer::begin(const Ray& start, const MediumStack& media) {
  ray = start;
  ray.maximum = infinity;
  ray.of_camera = false;
  from = start.origin;
  if (tracks_) media_ = media;
  const Frame across{Normal3(ray.direction)};
  position_change[0] = position_change[1] = {};
  direction_change[0] = across.s;
  direction_change[1] = across.t;
  weight = Spectrum(1.0f);
  share = 1;
  vertices = 0;
}

void ChainTracer::cross() {
  if (tracks_) cross_boundary(media_, *point_.object, point_.normal, ray.direction);
  ray.maximum -= hit_.distance;
  ray.origin = point_.exit(ray.direction);
  ray.width = point_.footprint;
}

/// Passes a surface that scatters null alone; false for any other with null scattering.
bool ChainTracer::pass_null() {
  if (scatter_->lobes() != null_scattering) return false;
  const auto straight = scatter_->sample(-ray.direction, 0, {}, {Transport::radiance, null_scattering});
  if (!straight) return false;
  weight *= straight->weight;
  cross();
  return true;
}

bool ChainTracer::meet() {
  for (int crossings = 0; crossings <= most_crossings; ++crossings) {
    hit_ = {};
    scatter_ = nullptr;
    const bool found = scene_.nearest(ray, hit_);
    if (attenuates && tracks_)
      if (const Medium medium = medium_in(media_))
        weight *= transmittance(medium, ray, found ? hit_.distance : ray.maximum, wavelengths, numbers_);
    if (!found) return false;
    scene_.locate(ray, hit_, point_);
    if (tracks_) {
      resolve_coincident(scene_, ray, hit_, point_, media_);
      if (hidden_by_priority(media_, *point_.object)) {
        cross();
        continue;
      }
      point_.media = &media_;
    }
    scatter_ = scattering_at(point_, -ray.direction, wavelengths, arena_);
    if (!scatter_) return false;
    if (!scatter_->has(null_scattering)) return true;
    if (!pass_null()) return false;
  }
  return false;
}

Lobes ChainTracer::lobes_here() const {
  if (!scatter_) return no_lobes;
  const Lobes lobes = scatter_->lobes() & (specular_reflection | specular_transmission);
  if (lobes != (specular_reflection | specular_transmission)) return lobes;
  return scatter_->albedo(-ray.direction, specular_transmission).black() ? Lobes(specular_reflection) : lobes;
}

bool ChainTracer::scatter_by(Lobe lobe) {
  if (!scatter_ || !scatter_->has(lobe) || vertices == ChainLobes::longest) return false;
  const Vector3 out = -ray.direction;
  const auto s = scatter_->sample(out, 0, {}, {Transport::radiance, lobe});
  if (!s || s->pdf < 0.9999f || enters_subsurface(point_, *s)) return false;
  const Frame& frame = scatter_->frame();
  if (lobe == specular_reflection && frame.n != point_.normal && scatter_->has(specular_transmission) &&
      !scatter_->sample(out, 0, {}, {Transport::radiance, specular_transmission}))
    return false;  // total reflection, which the facet of the opposite tilt may not show
  if (!differentiate(lobe, s->direction, s->eta)) return false;

  weight *= s->weight;
  share *= s->weight[0] * s->eta * s->eta;
  if (s->dispersive) weight *= wavelengths.drop_secondary();
  if (weight.black()) return false;
  objects[size_t(vertices++)] = point_.object;
  left_ = point_;
  left_.media = nullptr;
  from = point_.position;
  if (tracks_ && s->transmitted()) cross_boundary(media_, *point_.object, point_.normal, s->direction);
  ray.origin = point_.exit(s->direction);
  ray.direction = s->direction;
  ray.maximum = infinity;
  ray.width = point_.footprint;
  return true;
}

bool ChainTracer::follow(const ChainLobes& lobes) {
  for (int i = 0; i < lobes.count; ++i)
    if (!meet() || !scatter_by(lobes.at[size_t(i)])) return false;
  return true;
}

bool ChainTracer::reaches(const SurfacePoint& luminaire, const ChainTarget& target) {
  const float time = ray.time;
  if (target.infinite)
    left_.leave(target.direction, ray);
  else
    left_.towards(luminaire, ray);
  ray.time = time;
  const Point3 end = target.infinite ? Point3{} : ray(ray.maximum);
  // Those surfaces that `meet` passes do not occlude; it returns false at the end, with no surface found, and at others.
  for (int crossings = 0; crossings <= most_crossings; ++crossings) {
    hit_ = {};
    const bool found = scene_.nearest(ray, hit_);
    if (attenuates && tracks_)
      if (const Medium medium = medium_in(media_))
        weight *= transmittance(medium, ray, found ? hit_.distance : ray.maximum, wavelengths, numbers_);
    if (!found) return !weight.black();
    scene_.locate(ray, hit_, point_);
    if (tracks_) resolve_coincident(scene_, ray, hit_, point_, media_);
    if (tracks_ && hidden_by_priority(media_, *point_.object)) {
      cross();
    } else {
      if (!point_.object->shader || !(point_.object->shader->possible_lobes() & null_scattering)) return false;
      point_.media = tracks_ ? &media_ : nullptr;
      scatter_ = scattering_at(point_, -ray.direction, wavelengths, arena_);
      if (!scatter_ || !pass_null()) return false;
    }
    if (target.infinite) continue;
    // The ray is aimed again, as in shadow_transmittance.
    const Vector3 rest = end - ray.origin;
    if (!(dot(rest, ray.direction) > 0)) return true;
    ray.maximum = length(rest);
    ray.direction = rest / ray.maximum;
  }
  return false;
}

// ---- derivatives --------------------------------------------------------------------------------------------------------

/// Checks that the lobe's direction is that of the shading normal, and moves both changes over the segment and the vertex.
/// False: it is not, or the normal has no derivative.
bool ChainTracer::differentiate(Lobe lobe, const Vector3& to, float eta) {
  const Vector3 D = ray.direction;
  const Vector3 normal(scatter_->frame().n);
  const float side = dot(normal, D) < 0 ? 1.0f : -1.0f;
  const Vector3 N = side * normal;
  const float c = -dot(D, N);
  float along = 2 * c, behind = 0;  // of N in D'
  if (lobe == specular_reflection) {
    eta = 1;
  } else {
    const float squared = 1 - (1 - c * c) / (eta * eta);
    if (!(squared > 0)) return false;
    behind = std::sqrt(squared);
    along = c / eta - behind;
  }
  const Vector3 expected = (1 / eta) * D + along * N;
  if (!(length_squared(expected - to) < 1e-7f)) return false;
  if (derivatives == Derivatives::none) return true;

  const Frame tangent(point_.normal);
  Vector3 bend[2];
  if (!normal_derivatives(tangent, bend)) return false;
  const float t = distance(from, point_.position), incline = dot(point_.normal, D);
  if (incline == 0 || !(c > 0)) return false;
  for (int i = 0; i < 2; ++i) {
    const Vector3 dD = direction_change[i];
    Vector3 dP = position_change[i] + t * dD;
    dP = dP - (dot(point_.normal, dP) / incline) * D;
    const Vector3 dN = side * (dot(tangent.s, dP) * bend[0] + dot(tangent.t, dP) * bend[1]);
    const float dc = -dot(dD, N) - dot(D, dN);
    const float d_along = lobe == specular_reflection ? 2 * dc : dc / eta - c * dc / (eta * eta * behind);
    position_change[i] = dP;
    direction_change[i] = (1 / eta) * dD + d_along * N + along * dN;
  }
  return true;
}

/// The derivatives of the model's normal along two tangents [1/m].
bool ChainTracer::normal_derivatives(const Frame& tangent, Vector3 change[2]) const {
  // So long that rounding is small beside the change of the normal, and short beside the shape where that is possible.
  float step = 1e-3f * distance(from, point_.position);
  if (hit_.depth == 0)
    if (const auto triangles = still_triangles(*hit_.object)) return normal_on_triangle(*triangles, tangent, step, change);
  for (int attempt = 0; attempt < 3; ++attempt, step /= 6)
    if (normal_differences(tangent, step, change)) return true;
  return false;
}

/// On a triangle, by its barycentric coordinates.
bool ChainTracer::normal_on_triangle(const TriangleView& view, const Frame& tangent, float step, Vector3 change[2]) const {
  const auto& corners = view.triangles[hit_.primitive];
  const Point3 p0 = view.positions[corners[0]];
  const Vector3 edge[2] = {view.positions[corners[1]] - p0, view.positions[corners[2]] - p0};
  const bool perturbed = scatter_->frame().n != point_.shading_normal;
  Vector3 by[2];  // derivatives by the coordinates
  for (int i = 0; i < 2; ++i) {
    // An interpolated normal is nearly a linear function of them; one of a bump map has detail.
    const float most = perturbed ? std::min(0.004f, step / length(edge[i])) : 0.004f;
    float at[2];
    Vector3 normal[2];
    for (int way = 0; way < 2; ++way) {
      Hit beside = hit_;
      (i == 0 ? beside.u : beside.v) += way == 0 ? most : -most;
      SurfacePoint there;
      scene_.locate_alone(ray, beside, there);  // it moves points outside into the triangle
      at[way] = i == 0 ? there.u : there.v;
      normal[way] = Vector3(model_normal(there));
    }
    if (!(at[0] - at[1] > 0.1f * most)) return false;
    by[i] = (normal[0] - normal[1]) / (at[0] - at[1]);
  }
  const float aa = dot(edge[0], edge[0]), ab = dot(edge[0], edge[1]), bb = dot(edge[1], edge[1]),
              determinant = aa * bb - ab * ab;
  if (!(determinant > 0)) return false;
  for (int axis = 0; axis < 2; ++axis) {
    const Vector3 along = axis == 0 ? tangent.s : tangent.t;
    const float a = dot(edge[0], along), b = dot(edge[1], along);
    change[axis] = ((bb * a - ab * b) * by[0] + (aa * b - ab * a) * by[1]) / determinant;
  }
  return true;
}

/// By differences between normals at two points on both sides, or at one of them if the other is not on the primitive.
bool ChainTracer::normal_differences(const Frame& tangent, float step, Vector3 change[2]) const {
  const Vector3 here(scatter_->frame().n);
  for (int axis = 0; axis < 2; ++axis) {
    const Vector3 along = axis == 0 ? tangent.s : tangent.t;
    std::optional<Vector3> d[2];
    for (int way = 0; way < 2; ++way) {
      if (way == 1 && d[0] && derivatives == Derivatives::approximate) continue;
      std::optional<SurfacePoint> there = on_same_primitive((way == 0 ? step : -step) * along, step);
      if (!there) continue;
      const float moved = dot(there->position - point_.position, along);
      if (moved != 0) d[way] = (Vector3(model_normal(*there)) - here) / moved;
    }
    if (!d[0] && !d[1]) return false;
    if (!d[0] || !d[1]) {
      change[axis] = d[0] ? *d[0] : *d[1];
      continue;
    }
    constexpr float rounding = 4e-6f;  // of the two normals
    if (length(*d[0] - *d[1]) > 0.2f * (length(*d[0]) + length(*d[1])) + rounding / step) return false;
    change[axis] = 0.5f * (*d[0] + *d[1]);
  }
  return true;
}

/// The point of the primitive that lies beside the last hit, by a step in the tangent plane.
std::optional<SurfacePoint> ChainTracer::on_same_primitive(const Vector3& off, float reach) const {
  Ray probe;
  const Vector3 outwards = std::copysign(reach, -dot(point_.normal, ray.direction)) * Vector3(point_.normal);
  probe.direction = -1 / reach * outwards;
  probe.origin = point_.position + off + outwards;
  probe.maximum = 2 * reach;
  probe.time = ray.time;
  Hit beside;
  if (hit_.depth == 0) {
    if (!hit_.object->intersect(probe, beside) || beside.primitive != hit_.primitive) return {};
    // An object of objects, a solid of solids, may have found another part.
    if (beside.object != hit_.object || beside.depth != 0) return {};
  } else {
    HitList hits;
    scene_.all(probe, hits);
    for (int i = 0; i < hits.size; ++i) {
      const Hit& h = hits.hits[i];
      bool same = h.object == hit_.object && h.primitive == hit_.primitive && h.depth == hit_.depth;
      for (int k = 0; same && k < h.depth; ++k) same = h.scenes[k] == hit_.scenes[k];
      if (same && std::abs(h.distance - reach) < std::abs(beside.distance - reach)) beside = h;
    }
    if (!beside) return {};
  }
  SurfacePoint there;
  scene_.locate_alone(probe, beside, there);
  if (!(dot(there.normal, point_.normal) > 0)) return {};
  return there;
}

/// The normal by which the surface scatters at a point: its shading normal unless the shader perturbs it.
Normal3 ChainTracer::model_normal(SurfacePoint& p) const {
  if (scatter_->frame().n == point_.shading_normal) return p.shading_normal;
  const ArenaScope memory(arena_);
  p.media = point_.media;
  const Scatter* const s = scattering_at(p, -ray.direction, wavelengths, arena_);
  return s ? s->frame().n : p.shading_normal;
}

// ---- roots --------------------------------------------------------------------------------------------------------------

bool ChainSolution::same(const ChainSolution& other) const {
  if ((determinant > 0) != (other.determinant > 0) || !(lobes == other.lobes)) return false;
  const Vector3 difference = other.direction - direction;
  if (length_squared(difference) > 1e-4f) return false;
  // The change of r that the difference makes: roots are found to about 1e-5.
  const Frame across{Normal3(direction)};
  const auto u = double(dot(across.s, difference)), v = double(dot(across.t, difference));
  return std::hypot(jacobian[0][0] * u + jacobian[0][1] * v, jacobian[1][0] * u + jacobian[1][1] * v) < 2e-4;
}

double chain_residual(const ChainTracer& chain, const ChainTarget& target, ChainSolution& solution, double r[2]) {
  Vector3 d = target.direction;
  solution.distance = 1;
  if (!target.infinite) {
    d = target.position - chain.from;
    solution.distance = length(d);
    if (!(solution.distance > 0)) return infinity;
    d = d / solution.distance;
  }
  const Frame across{Normal3(d)};
  const Vector3 off = chain.ray.direction - d;
  const Vector3 axes[2] = {across.s, across.t};
  for (int i = 0; i < 2; ++i) {
    r[i] = double(dot(axes[i], off));
    for (int k = 0; k < 2; ++k) {
      const Vector3 change = target.infinite ? chain.direction_change[k]
                                             : chain.direction_change[k] + chain.position_change[k] / solution.distance;
      solution.jacobian[i][k] = double(dot(axes[i], change));
    }
  }
  const auto& J = solution.jacobian;
  solution.determinant = J[0][0] * J[1][1] - J[0][1] * J[1][0];
  return double(length(off));
}

std::optional<ChainSolution> solve_chain(const Scene& scene, const PathVertex& receiver, const Wavelengths& wavelengths,
                                         NumberStream& numbers, Arena& arena, const Vector3& guess, const ChainLobes& lobes,
                                         const ChainTarget& target, ChainTracer::Derivatives derivatives) {
  constexpr int most_steps = 10, most_failures = 2;
  constexpr double farthest = 1;                    // |r| from which a search begins: from farther, few come to a root
  constexpr double enough = 1e-5, rounding = 3e-5;  // |r| at which the search ends, and that of a root that has no better one
  struct Trial {
    ChainSolution at;
    double r[2] = {}, off = 0;
  };
  const auto trial = [&](const Vector3& direction, ChainTracer::Derivatives which, Trial& t) {
    const ArenaScope memory(arena);
    ChainTracer chain(scene, wavelengths, numbers, arena);
    chain.derivatives = which;
    chain.begin(receiver, direction);
    if (!chain.follow(lobes)) return false;
    t.at.direction = direction;
    t.at.lobes = lobes;
    t.off = chain_residual(chain, target, t.at, t.r);
    return std::isfinite(t.off) && std::isfinite(t.at.determinant) && t.at.determinant != 0;
  };
  Trial here, there;
  if (!trial(guess, ChainTracer::Derivatives::approximate, here) || here.off > farthest) return {};
  double longest = 0.3;  // of a step [rad]
  int failures = 0;
  for (int i = 0; i < most_steps && here.off > enough; ++i) {
    const auto& J = here.at.jacobian;
    const double u = (J[0][1] * here.r[1] - J[1][1] * here.r[0]) / here.at.determinant,
                 v = (J[1][0] * here.r[0] - J[0][0] * here.r[1]) / here.at.determinant;
    const double length = std::hypot(u, v), part = length > longest ? longest / length : 1;
    const Frame across{Normal3(here.at.direction)};
    const Vector3 next = normalize(here.at.direction + float(part * u) * across.s + float(part * v) * across.t);
    if (trial(next, ChainTracer::Derivatives::approximate, there) && there.off < here.off) {
      here = there;
      longest = std::min(0.3, 2 * std::min(longest, length));
      continue;
    }
    if (here.off < rounding) break;
    if (++failures > most_failures) return {};
    longest = part * length / 4;
  }
  if (here.off > rounding) return {};
  if (derivatives == ChainTracer::Derivatives::exact && !trial(here.at.direction, derivatives, here)) return {};
  return here.at;
}

}  // namespace etendue
