#pragma once
// LayerStack: light transport between two surfaces, one over the other, with a medium between.

#include "etendue/shader.h"
#include "etendue/volume_shader.h"

namespace etendue {

/// Random numbers hashed from given values, in place of a sampler: the same values always give the same numbers.
class HashedRandom {
 public:
  explicit HashedRandom(std::uint64_t seed = 0) : state_(seed) {}

  void add(float a, float b) {
    state_ =
        mix_bits((state_ + step) ^ (std::uint64_t(std::bit_cast<std::uint32_t>(a)) << 32 | std::bit_cast<std::uint32_t>(b)));
  }
  void add(const Vector3& v, float last) {
    add(v.x, v.y);
    add(v.z, last);
  }
  std::uint64_t bits() { return mix_bits(state_ += step); }
  float next() { return to_unit_float(std::uint32_t(bits() >> 32)); }
  Point2 next_pair() {
    const std::uint64_t b = bits();
    return {to_unit_float(std::uint32_t(b >> 32)), to_unit_float(std::uint32_t(b))};
  }

 private:
  static constexpr std::uint64_t step = 0x9e3779b97f4a7c15ull;

  std::uint64_t state_;
};

/// The result of a walk that entered between the layers.
struct LayerWalk {
  Vector3 direction;
  Spectrum weight;
  float probability = 1;  ///< of all discrete choices, if every event was specular
  float eta = 1;
  bool smooth = false;    ///< at least one event was not specular
  bool straight = false;  ///< null scattering at both layers
  bool dispersive = false;
};

/// Both surfaces as bound at one point. Paths between them have a depth but no lateral position: the layer is infinitely wide,
/// and light leaves at the point where it entered (Guo, Hasan & Zhao 2018, "Position-free Monte Carlo simulation for arbitrary
/// layered BSDFs"). The estimators are derived in layer_stack.cpp.
class LayerStack {
 public:
  /// Coefficients are optical thicknesses of the whole layer, along the normal.
  struct Medium {
    const VolumeShader* shader = nullptr;  ///< null: no medium between
    Spectrum absorption, scattering;
    float mean_cosine = 0;  ///< of the scattering angle
    Point3 position;        ///< of the surface point
    Spectrum extinction() const { return absorption + scattering; }
    bool scatters() const { return !scattering.black(); }
  };

  struct Face {
    const Scatter* scatter;
    bool reciprocal;
  };

  /// The geometric normal points to the side of the top; path lengths between the layers are computed with the shading normal.
  LayerStack(const Face& top, const Face& bottom, const Normal3& normal, const Normal3& shading_normal, const Medium& medium)
      : faces_{top, bottom}, normal_(normal), shading_normal_(shading_normal), medium_(medium) {}

  /// 0: the side of the top, 1: that of the bottom.
  int side(const Vector3& v) const { return dot(normal_, v) > 0 ? 0 : 1; }
  const Scatter& face(int side) const { return *faces_[side].scatter; }
  const Medium& medium() const { return medium_; }
  /// The transmittance of the medium along a direction, over the fraction `part` of the layer's thickness.
  Spectrum transmittance(const Vector3& direction, float part) const;

  /// An unbiased estimate of f |cos| [1/sr] of light that entered through the face on the side of `out`, had at least one
  /// non-specular event, and left in direction `in`.
  Spectrum estimate(const Vector3& out, const Vector3& in, Transport, HashedRandom&) const;

  /// The approximate pdf [1/sr] with which walks that have entered on the side of `out` leave in direction `in`. Never 0.
  float pdf(const Vector3& out, const Vector3& in, Transport, HashedRandom&) const;

  /// Continues a sample of the face on the side of `out` that entered between the layers, until it leaves. False: it is
  /// absorbed.
  bool walk(const Vector3& out, const ScatterSample& entering, Transport, HashedRandom&, LayerWalk&) const;

  /// Estimated fractions of light from `out` that enters between the layers and leaves on either side: by specular events
  /// alone, and otherwise.
  struct Albedo {
    Spectrum specular[2], smooth[2];  ///< [0] reflected, [1] transmitted
  };
  Albedo albedo(const Vector3& out) const;

 private:
  struct Edge;
  struct Edges;
  /// Fractions of the diffuse light between the layers that hits a face.
  struct Diffuse {
    Spectrum back, leave;              ///< reflected back, and transmitted outside
    Spectrum back_clear, leave_clear;  ///< the same with the medium's absorption over a round trip, and over one crossing
    Spectrum absorbed;                 ///< transmittance by absorption in the medium, for one crossing
    bool known = false;
  };

  float slant(const Vector3& v) const { return 1 / std::max(std::abs(dot(shading_normal_, v)), 1e-6f); }
  float adjoint_factor(Transport, const Vector3& a, const Vector3& b) const;
  Lobes reversible(int side) const;
  const Diffuse& diffuse(int side) const;
  void trace_back(const Vector3& in, Transport, HashedRandom&, Edges&) const;
  bool fly(const Vector3& w, float& z, Spectrum& carried, HashedRandom&) const;

  Face faces_[2];
  Normal3 normal_, shading_normal_;
  Medium medium_;
  mutable Diffuse diffuse_[2];  ///< computed at first use: a stack belongs to one sample, and so to one thread
};

}  // namespace etendue
