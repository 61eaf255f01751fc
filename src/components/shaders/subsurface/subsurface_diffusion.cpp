// Subsurface exit points by a diffusion profile.
//
// Of light that enters at x, the body returns A R(|x' - x|) at x' [1/m^2], R being the profile of a half space (see
// diffusion_profile.h). Points x' are found by probe rays through a disc around x (King, Kulla, Conty & Fajardo 2013, "BSSRDF
// importance sampling"): a radius r from the profile and an angle give a point on the disc, and the probe ray through it,
// perpendicular to the disc, is followed as long as it lies within the profile's end. A probe ray along the axis a finds a
// point x' of normal n, at distance r_a from the axis, with the pdf
//     p_a(x') = p(r_a) / (2 pi r_a) |n . a|     [1/m^2],
// where p(r) 1/(2 pi r) = R(r), averaged over the path's wavelengths. One probe ray along each of three axes is traced, the
// normal and two tangents, and all points found are weighted by the balance heuristic: each contributes A R / sum_a p_a,
// whichever ray found it. One of the points is chosen in proportion to its contribution. On a plane the ray along the normal
// finds the only point, and its contribution is A at every r.

#include "components/shaders/fresnel.h"
#include "diffusion_profile.h"
#include "subsurface_exit.h"

namespace etendue {
namespace {

/// The profiles of the path's wavelengths, and the probability of sampling a radius from each.
struct Profiles {
  DiffusionProfile profile[spectrum_size];
  Spectrum share;

  explicit Profiles(const SubsurfaceBody& body) {
    float sum = 0, reflected = 0;
    for (int i = 0; i < spectrum_size; ++i) {
      if (i == 0 || body.eta[i] != body.eta[i - 1]) reflected = mean_fresnel_dielectric(1 / body.eta[i]);
      profile[i] = DiffusionProfile(DiffusionProfile::scale(body.returned[i], body.mean_free_path[i], reflected));
      const float part = body.single_wavelength && i > 0 ? 0 : body.returned[i];
      share.set(i, part);
      sum += part;
    }
    if (sum > 0) share /= sum;
  }
  int choose(float u) const {
    int k = 0;
    for (float rest = u - share[0]; rest >= 0 && k + 1 < spectrum_size; rest -= share[k]) ++k;
    while (k > 0 && !(share[k] > 0)) --k;  // by rounding: the probability of the last ones may be 0
    return k;
  }
  /// The greatest end of the profiles that can be chosen [m].
  float end() const {
    float furthest = 0;
    for (int i = 0; i < spectrum_size; ++i)
      if (share[i] > 0) furthest = std::max(furthest, profile[i].end());
    return furthest;
  }
  float pdf(float r) const {
    float sum = 0;
    for (int i = 0; i < spectrum_size; ++i)
      if (share[i] > 0) sum += share[i] * profile[i].by_area(r);
    return sum;
  }
};

}  // namespace

bool exit_by_diffusion(const SubsurfaceBody& body, const SurfacePoint& entry, const Scene& scene, NumberStream& random,
                       SurfacePoint& exit, Spectrum& weight) {
  constexpr int most = 64;  // points on one probe ray
  const Profiles profiles(body);
  const Frame frame(entry.normal);
  const Vector3 axes[3] = {Vector3(frame.n), frame.s, frame.t};

  const auto contribution = [&](const SurfacePoint& p) {
    const Vector3 offset = p.position - entry.position;
    const float whole = length_squared(offset);
    float pdf = 0;
    for (const Vector3& a : axes) {
      const float along = dot(offset, a);
      pdf += profiles.pdf(safe_sqrt(whole - along * along)) * std::abs(dot(p.normal, a));
    }
    if (!(pdf > 0)) return Spectrum();
    Spectrum r;
    const float distance = std::sqrt(whole);
    for (int i = 0; i < spectrum_size; ++i) r.set(i, body.returned[i] * profiles.profile[i].by_area(distance) / pdf);
    return r;
  };

  float choice = random.next(), sum = 0;
  SurfacePoint found;
  for (int k = 0; k < 3; ++k) {
    const Vector3 &axis = axes[k], &x = axes[(k + 1) % 3], &y = axes[(k + 2) % 3];
    const DiffusionProfile& profile = profiles.profile[profiles.choose(random.next())];
    const Point2 u = random.next_pair();
    const float r = profile.sample(u.x), half = safe_sqrt(square(profiles.end()) - r * r);
    float sine = 0, cosine = 0;
    sin_cos_turn(u.y, sine, cosine);
    Ray ray;
    ray.origin = entry.position + r * (cosine * x + sine * y) + half * axis;
    ray.direction = -axis;
    ray.maximum = 2 * half;
    ray.time = entry.time;
    ray.width = entry.footprint;
    float distance = 0;
    for (int i = 0; i < most && next_on_object(scene, entry.object, ray, found, distance); ++i) {
      const Spectrum part = contribution(found);
      const float size = part.average();
      if (!(size > 0 && size < infinity)) continue;
      sum += size;
      // Reservoir sampling: the last point replaces the one kept so far with probability size / sum; `choice` is rescaled for
      // reuse.
      const float keep = size / sum;
      if (choice < keep) {
        choice = choice / keep;
        exit = found;
        weight = part / size;
      } else {
        choice = (choice - keep) / (1 - keep);
      }
      choice = std::min(choice, one_minus_epsilon);
    }
  }
  weight *= sum;
  return sum > 0;
}

}  // namespace etendue
