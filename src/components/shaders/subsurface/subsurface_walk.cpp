// Subsurface exit points by a random walk through the body (Chiang, Kutz & Burley 2016; Kulla & Conty 2017, "Revisiting
// physically based shading at Imageworks").
//
// Below the boundary light starts with equal radiance in all directions, i.e. with the pdf cos / pi [1/sr] about the inward
// normal, as AlbedoInversion assumes. It travels an exponentially distributed distance, is scattered by the Henyey-Greenstein
// phase function, and so on. At the boundary it is reflected, by Fresnel's equations, or leaves.
//
// The coefficients differ between the path's wavelengths. Distances are sampled for one of them, chosen in proportion to the
// throughputs W, and all use the pdf of the mixture (as in transport/medium.h): with w_k = W_k / sum W,
//     scattered at t:      W_j *= s_s,j T_j(t) / sum_k w_k s_t,k T_k(t),       T = exp(-s_t t) [s_t in 1/m],
//     boundary at t:       W_j *= T_j(t) / sum_k w_k T_k(t).
// The boundary reflects with a probability that is the mean of F with the same shares: W_j *= F_j / sum_k w_k F_k, or (1 - F_j)
// / (1 - sum). So sum W changes by absorption and Russian roulette only, and roulette keeps its expected value: without
// absorption, all light that enters leaves.

#include "components/shaders/fresnel.h"
#include "etendue/core/warp.h"
#include "subsurface_exit.h"

namespace etendue {
namespace {

/// Random numbers for the walk, in any number, from a seed (splitmix64, Steele, Lea & Flood 2014).
class WalkRandom {
 public:
  explicit WalkRandom(NumberStream& random) {
    const std::uint64_t high = std::bit_cast<std::uint32_t>(random.next()), low = std::bit_cast<std::uint32_t>(random.next());
    state_ = mix_bits((high << 32 | low) + 0x9e3779b97f4a7c15ull);
  }
  float next() { return pair().x; }
  Point2 pair() {
    const std::uint64_t bits = mix_bits(state_ += 0x9e3779b97f4a7c15ull);
    return {to_unit_float(std::uint32_t(bits)), to_unit_float(std::uint32_t(bits >> 32))};
  }

 private:
  std::uint64_t state_;
};

Spectrum shares(const Spectrum& throughput) { return throughput / (throughput.average() * spectrum_size); }

float mean(const Spectrum& share, const Spectrum& values) { return (share * values).average() * spectrum_size; }

/// Samples the Henyey-Greenstein phase function (Henyey & Greenstein 1941) around a direction. The cosine is found by
/// inversion: c = (1 + g^2 - ((1 - g^2) / (1 + g x))^2) / (2 g), x = 2 u - 1.
Vector3 scattered(const Vector3& direction, float g, Point2 u) {
  const float x = 2 * u.x - 1;
  const float c = std::abs(g) < 1e-3f ? x + 1.5f * g * (1 - x * x)  // to first order in g
                                      : clamp((1 + g * g - square((1 - g * g) / (1 + g * x))) / (2 * g), -1, 1);
  const float r = safe_sqrt(1 - c * c);
  float sine = 0, cosine = 0;
  sin_cos_turn(u.y, sine, cosine);
  return Frame(Normal3(direction)).to_world({r * cosine, r * sine, c});
}

/// Whether a ray's origin is still inside: a ray from inside always hits the surface from behind. By rounding, a walk slips
/// through a crack of a mesh once in a long while.
bool inside(const Scene& scene, const SceneObject* object, Ray ray) {
  SurfacePoint point;
  float distance = 0;
  ray.maximum = infinity;
  return next_on_object(scene, object, ray, point, distance) && dot(point.normal, ray.direction) > 0;
}

}  // namespace

bool exit_by_random_walk(const SubsurfaceBody& body, const SurfacePoint& entry, const Scene& scene, NumberStream& random,
                         SurfacePoint& exit, Spectrum& weight) {
  constexpr int most_scatterings = 1 << 16, checked_every = 256;
  Spectrum extinction, scattering;
  for (int i = 0; i < spectrum_size; ++i) {
    const float w = body.single_albedo[i];
    extinction.set(i, 1 / (body.mean_free_path[i] * (1 - w * body.anisotropy)));
    scattering.set(i, w * extinction[i]);
  }
  const bool grey = extinction.minimum() == extinction.maximum();

  Spectrum throughput(1.0f);
  if (body.single_wavelength) {
    throughput = Spectrum();
    throughput.set(0, 1);
  }
  const Vector3 start = warp::cosine_hemisphere(random.next_pair());
  WalkRandom numbers(random);
  Ray ray = entry.leave(Frame(-entry.normal).to_world(start));
  ray.width = entry.footprint;
  for (int n = 0; n < most_scatterings;) {
    const Spectrum share = shares(throughput);
    const Point2 u = numbers.pair();
    int k = 0;
    if (!grey) {
      for (float rest = u.x - share[0]; rest >= 0 && k + 1 < spectrum_size; rest -= share[k]) ++k;
      while (k > 0 && !(share[k] > 0)) --k;
    }
    const float reach = -std::log1p(-u.y) / extinction[k];
    ray.maximum = reach;
    float distance = 0;
    if (Ray onward = ray; next_on_object(scene, entry.object, onward, exit, distance)) {
      if (!grey) {
        const Spectrum t = exp(-extinction * distance);
        throughput *= t / std::max(mean(share, t), 1e-30f);
      }
      Spectrum reflected;
      const float cosine = std::abs(dot(exit.normal, ray.direction));
      for (int i = 0; i < spectrum_size; ++i) reflected.set(i, fresnel_dielectric(cosine, 1 / body.eta[i]));
      const Spectrum now = shares(throughput);
      const float probability = mean(now, reflected);
      if (numbers.next() >= probability) {
        weight = throughput * (Spectrum(1.0f) - reflected) / (1 - probability);
        return weight.finite();
      }
      throughput *= reflected / probability;
      if (!(throughput.maximum() > 0)) return false;
      const Vector3 mirrored = ray.direction - 2 * dot(exit.normal, ray.direction) * Vector3(exit.normal);
      exit.leave(normalize(mirrored), ray);
      ++n;
      continue;
    }
    if (grey) {
      throughput *= body.single_albedo;
    } else {
      const Spectrum t = exp(-extinction * reach);
      throughput *= scattering * t / std::max(mean(share, extinction * t), 1e-30f);
    }
    ray.origin = ray(reach);
    ray.direction = scattered(ray.direction, body.anisotropy, numbers.pair());

    // Russian roulette by the throughput.
    const float left = throughput.maximum();
    if (left < 0.25f) {
      const float survival = 4 * left;
      if (!(numbers.next() < survival)) return false;
      throughput /= survival;
    }
    if (++n % checked_every == 0 && !inside(scene, entry.object, ray)) return false;
  }
  // Reached only in a vast body that hardly absorbs: light that wanders that long leaves where it entered, so that none is
  // lost.
  exit = entry;
  weight = throughput;
  return true;
}

}  // namespace etendue
