#include "noise.h"

namespace etendue {
namespace {

// One lane for each corner of a lattice cube: bits 0, 1 and 2 of the lane's index are the corner's offsets along x, y and z.
using Floats = float __attribute__((vector_size(32)));
using Bits = std::uint32_t __attribute__((vector_size(32)));
constexpr Bits corner_x{0, 1, 0, 1, 0, 1, 0, 1}, corner_y{0, 0, 1, 1, 0, 0, 1, 1}, corner_z{0, 0, 0, 0, 1, 1, 1, 1};
constexpr Floats far_x{0, 1, 0, 1, 0, 1, 0, 1}, far_y{0, 0, 1, 1, 0, 0, 1, 1}, far_z{0, 0, 0, 0, 1, 1, 1, 1};

/// Mixes lattice coordinates: a sum of products with odd numbers, then two rounds of multiplication and shift.
template <class T>
T mixed(T x, T y, T z, std::uint32_t seed) {
  T h = x * 0x8da6b343u + y * 0xd8163841u + z * 0xcb1ab31fu + seed * 0x9e3779b9u;
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  h ^= h >> 16;
  return h;
}

/// 6 t^5 - 15 t^4 + 10 t^3: first and second derivatives vanish at 0 and 1.
float fade(float t) { return t * t * t * (t * (6 * t - 15) + 10); }

}  // namespace

std::uint32_t lattice_hash(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed) {
  return mixed(std::uint32_t(x), std::uint32_t(y), std::uint32_t(z), seed);
}

// The gradients are the directions to the twelve edges of a cube, four of them twice, so that four bits choose one; their mean
// is 0. In place of Perlin's table of 256 permuted numbers the lattice point is hashed, so that the noise is not periodic.
float perlin_noise(const Vector3& p, std::uint32_t seed) {
  constexpr float most = 1e9f;
  if (!(std::abs(p.x) < most && std::abs(p.y) < most && std::abs(p.z) < most)) return 0;
  const float fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  const float x = p.x - fx, y = p.y - fy, z = p.z - fz;
  const Bits h = mixed(std::uint32_t(std::int32_t(fx)) + corner_x, std::uint32_t(std::int32_t(fy)) + corner_y,
                       std::uint32_t(std::int32_t(fz)) + corner_z, seed) >>
                 28;
  const Floats dx = x - far_x, dy = y - far_y, dz = z - far_z;
  const Floats a = h < 8 ? dx : dy, b = h < 4 ? dy : ((h & 13) == 12 ? dx : dz);
  const Floats gradient = ((h & 1) != 0 ? -a : a) + ((h & 2) != 0 ? -b : b);
  const float u = fade(x), v = fade(y), w = fade(z);
  const Floats weight = (1 - u + (2 * u - 1) * far_x) * (1 - v + (2 * v - 1) * far_y) * (1 - w + (2 * w - 1) * far_z);
  const Floats all = weight * gradient;
  return ((all[0] + all[1]) + (all[2] + all[3])) + ((all[4] + all[5]) + (all[6] + all[7]));
}

template <class Value>
float Octaves::sum(const Vector3& p, float width, float mean, Value value) const {
  float result = 0, amplitude = 1, total = 0, frequency = 1;
  for (int i = 0; i < count; ++i) {
    const float remains = noise_remains(frequency * width);
    result += amplitude *
              (remains > 0 ? mean + remains * (value(perlin_noise(frequency * p, seed + std::uint32_t(i))) - mean) : mean);
    total += amplitude;
    amplitude *= gain;
    frequency *= lacunarity;
  }
  return clamp(result / total, -1, 1);
}

float Octaves::fbm(const Vector3& p, float width) const {
  return sum(p, width, 0, [](float noise) { return noise; });
}

float Octaves::turbulence(const Vector3& p, float width) const {
  return sum(p, absolute_is_finer * width, mean_absolute, [](float noise) { return std::abs(noise); });
}

}  // namespace etendue
