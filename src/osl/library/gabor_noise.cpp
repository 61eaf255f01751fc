// Filtered solid Gabor noise.
//
// The noise is the sum of Gabor kernels w exp(-pi a^2 |x|^2) cos(2 pi omega.x + phi) (Lagae et al. 2009, eq. 1) at random
// points of a grid whose cells are as wide as a kernel's radius. To filter it over a pixel the solid kernel is cut by the
// surface's tangent plane (Lagae and Drettakis 2011, eq. 6), and the cut is convolved with a Gaussian, the pixel's shadow on
// that plane (eq. 10), which again gives a Gabor kernel. Constants, the generator and its seeds are those of the reference
// implementation.

#include <algorithm>

#include "lattice_hash.h"
#include "noise.h"
#include "numbers.h"

namespace etendue::osl {

namespace {

constexpr float pi = 3.14159265358979323846f, two_pi = 2 * pi;
constexpr float frequency = 2, truncation = 0.02f;

/// The linear congruential generator of Borosh and Niederreiter (1983), one stream per cell.
class Generator {
 public:
  Generator(const Triple& cell, std::uint32_t seed)
      : state_(std::max(hash_words(std::uint32_t(floor_to_int(cell.x)), std::uint32_t(floor_to_int(cell.y)),
                                   std::uint32_t(floor_to_int(cell.z)), seed),
                        1u)) {}
  /// In [0, 1].
  float next() { return float(state_ *= 3039177861u) / 4294967296.0f; }
  /// A number of Poisson's distribution (Knuth's method).
  int poisson(float mean) {
    const float limit = std::exp(-mean);
    int n = 0;
    for (float product = next(); product > limit; product *= next()) ++n;
    return n;
  }

 private:
  std::uint32_t state_;
};

/// A symmetric 2x2 matrix.
struct Symmetric {
  float xx = 0, xy = 0, yy = 0;
  float determinant() const { return xx * yy - xy * xy; }
  Symmetric inverse() const {
    const float d = 1 / determinant();
    return {yy * d, -xy * d, xx * d};
  }
  friend Symmetric operator+(const Symmetric& a, const Symmetric& b) { return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy}; }
  friend Symmetric operator*(float s, const Symmetric& a) { return {s * a.xx, s * a.xy, s * a.yy}; }
};

using Number = Dual<float>;
using Vector = Dual<Triple>;

Number exponential(const Number& x) { return chain(std::exp(x.value), std::exp(x.value), x); }
Number cosine(const Number& x) { return chain(std::cos(x.value), -std::sin(x.value), x); }

struct Parameters {
  GaborOptions options;
  bool filter;
  float a = 0;  ///< the Gaussian's width
  float radius = 0;
  float density = 0;  ///< impulses per volume
  Triple tangent, bitangent, normal;
  Symmetric pixel;  ///< covariance of the pixel's Gaussian in the tangent plane
  bool periodic = false;
  Triple period;
  // What convolution with the pixel makes of every kernel (eq. 10): the covariances of the kernel's spectrum, of the filter's
  // and of both.
  Symmetric together;  ///< inverse of the sum of kernel and filter
  float together_scale = 0;
  Symmetric rotation;  ///< takes the frequency of the kernel to the filtered one's
  float filtered_a = 0;

  explicit Parameters(const GaborOptions& o) : options(o), filter(o.filter) {
    const float octaves = std::exp2(std::clamp(o.bandwidth, 0.01f, 100.0f));
    constexpr float root_of_pi_over_log2 = 2.128934f;
    a = frequency * ((octaves - 1) / (octaves + 1)) * root_of_pi_over_log2;
    radius = std::sqrt(-std::log(truncation) / pi) / a;
    density = std::clamp(o.impulses, 1.0f, 32.0f) / (float(1.33333 * 3.14159265358979323846) * radius * radius * radius);
  }

  void set_filter(const Vector& p);
};

/// Filters over the parallelogram of p's derivatives; without, or with very small ones, there is nothing to filter.
void Parameters::set_filter(const Vector& p) {
  normal = cross(p.dx, p.dy);
  if (!(dot(normal, normal) >= 1e-6f)) {
    filter = false;
    return;
  }
  normal = normalized(normal);
  tangent = normalized(std::abs(normal.x) < 0.9f ? Triple(0, normal.z, -normal.y) : Triple(-normal.z, 0, normal.x));
  bitangent = cross(normal, tangent);
  // The product of the matrices with columns (dp/dx, dp/dy, 0) and (tangent, bitangent, normal) in this order, as the reference
  // implementation has it.
  const auto entry = [&](int i, const Triple& column) { return p.dx[i] * column.x + p.dy[i] * column.y; };
  const float m00 = entry(0, tangent), m01 = entry(0, bitangent), m10 = entry(1, tangent), m11 = entry(1, bitangent);
  constexpr float sigma = 0.5f;  // of the pixel's Gaussian [pixels]
  pixel = (sigma * sigma) * Symmetric{m00 * m00 + m10 * m10, m00 * m01 + m10 * m11, m01 * m01 + m11 * m11};
  if (!(pixel.determinant() >= 1e-18f)) {
    filter = false;
    return;
  }
  const Symmetric kernel = (a * a / two_pi) * Symmetric{1, 0, 1}, spectrum = (1 / (4 * pi * pi)) * pixel.inverse(),
                  sum = kernel + spectrum, product = (spectrum.inverse() + kernel.inverse()).inverse();
  together = sum.inverse();
  together_scale = 1 / (two_pi * std::sqrt(pixel.determinant())) / (two_pi * std::sqrt(sum.determinant()));
  rotation = (two_pi / (a * a)) * product;
  filtered_a = std::sqrt(two_pi * std::sqrt(product.determinant()));
}

/// A kernel's frequency vector and phase (2011, section 3.3).
void choose_wave(const Parameters& g, Generator& random, Triple& omega, float& phase) {
  if (g.options.anisotropic == 1) {
    omega = g.options.direction;
  } else if (g.options.anisotropic == 0) {
    const float angle = two_pi * random.next();
    const float t = random.next(), up = -(1 - t) + t, side = sqrt_or_zero(1 - up * up);
    omega = normalized(Triple(std::cos(angle) * side, std::sin(angle) * side, up));
  } else {
    const float size = length(g.options.direction), angle = two_pi * random.next();
    omega = size * Triple(std::cos(angle), std::sin(angle), 0);
  }
  phase = two_pi * random.next();
}

Number kernel(const Parameters& g, const Triple& omega, float phase, const Vector& x) {
  return exponential(Number(-pi * g.a * g.a) * dot(x, x)) * cosine(Number(two_pi) * dot(Vector(omega), x) + Number(phase));
}

Number filtered_kernel(const Parameters& g, const Triple& omega, float phase, const Vector& x) {
  // The slice: d is the distance of the kernel's centre from the plane.
  const Number d = -dot(Vector(g.normal), x);
  const Triple local(dot(omega, g.tangent), dot(omega, g.bitangent), dot(omega, g.normal));
  const Number slice = exponential(Number(-pi * g.a * g.a) * (d * d)), shift = Number(phase) - Number(two_pi * local.z) * d;
  // The filtered slice.
  const Symmetric& t = g.together;
  const float exponent = t.xx * local.x * local.x + 2 * t.xy * local.x * local.y + t.yy * local.y * local.y;
  const Number weight = Number(g.together_scale * std::exp(-0.5f * exponent)) * slice;
  const float u = g.rotation.xx * local.x + g.rotation.xy * local.y, v = g.rotation.xy * local.x + g.rotation.yy * local.y;
  const Number s = dot(Vector(g.tangent), x), r = dot(Vector(g.bitangent), x);
  return weight * exponential(Number(-pi * g.filtered_a * g.filtered_a) * (s * s + r * r)) *
         cosine(Number(two_pi) * (Number(u) * s + Number(v) * r) + shift);
}

/// The sum of the kernels in one cell; `to_cell` is the point relative to the cell's corner, in cells.
Number sum_of_cell(const Parameters& g, const Triple& cell, const Vector& to_cell, std::uint32_t seed) {
  const Triple seeded =
      g.periodic ? Triple(wrapped(cell.x, g.period.x), wrapped(cell.y, g.period.y), wrapped(cell.z, g.period.z)) : cell;
  Generator random(seeded, seed);
  const int impulses = random.poisson(g.density * g.radius * g.radius * g.radius);
  Number sum;
  for (int i = 0; i < impulses; ++i) {
    const float z = random.next(), y = random.next(), x = random.next();
    const Vector offset = Number(g.radius) * (to_cell - Vector(Triple(x, y, z)));
    Triple omega;
    float phase;
    choose_wave(g, random, omega, phase);
    if (!(dot(offset.value, offset.value) < g.radius * g.radius)) continue;
    Number k = g.filter ? filtered_kernel(g, omega, phase, offset) : kernel(g, omega, phase, offset);
    if (g.filter && !std::isfinite(k.value)) k = kernel(g, omega, phase, offset);
    sum = sum + k;
  }
  return sum;
}

Number sum_of_grid(const Parameters& g, const Vector& p, std::uint32_t seed) {
  const Vector at = Number(1 / g.radius) * p;
  const Triple corner(std::floor(at.value.x), std::floor(at.value.y), std::floor(at.value.z));
  Number sum;
  for (int k = -1; k <= 1; ++k)
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) {
        const Triple step = Triple(float(i), float(j), float(k));
        sum = sum + sum_of_cell(g, corner + step, at - Vector(corner) - Vector(step), seed);
      }
  return Number(1 / std::sqrt(g.density)) * sum;
}

}  // namespace

void gabor_noise(const Position<Number>& position, const GaborOptions& options, int count, Number* out) {
  Number x[3];
  for (int d = 0; d < std::min(position.dimensions, 3); ++d) x[d] = position.at[std::size_t(d)];
  const Vector p = make_triple(x[0], x[1], x[2]);
  for (int d = 0; d < 3; ++d)
    if (!std::isfinite(x[d].value)) return void(std::fill_n(out, count, Number()));
  Parameters g(options);
  g.periodic = position.periodic;
  for (int d = 0; d < std::min(position.dimensions, 3); ++d) g.period[d] = position.period[std::size_t(d)];
  if (g.filter) g.set_filter(p);
  // Three standard deviations of the noise fit into [-1, 1] when halved, by experience.
  const float variance = 1 / (4 * std::sqrt(2.0f) * g.a * g.a * g.a), scale = 0.5f / (3 * std::sqrt(variance));
  for (int c = 0; c < count; ++c) out[c] = Number(scale) * sum_of_grid(g, p, std::uint32_t(c));
}

}  // namespace etendue::osl
