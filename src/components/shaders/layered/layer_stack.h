#pragma once
// Two surfaces, one over the other, with a medium between: what light does between them.

#include "etendue/shader.h"
#include "etendue/volume_shader.h"

namespace etendue {

/// Random numbers that are a function of what they are made from: a hash takes the place of a sampler, so that the same
/// question always gets the same answer.
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

/// What became of a walk that entered between the layers.
struct LayerWalk {
  Vector3 direction;
  Spectrum weight;
  float probability = 1;  ///< of the choices made, as long as all were between single directions
  float eta = 1;
  bool smooth = false;    ///< scattered other than by mirrors and smooth boundaries
  bool straight = false;  ///< went through both layers as if nothing were there
  bool dispersive = false;
};

/// Both surfaces as bound at one point. Light between them has no position, only a depth: the layer is as wide as one likes
/// and light leaves where it came in (Guo, Hasan & Zhao 2018, "Position-free Monte Carlo simulation for arbitrary layered
/// BSDFs"). The estimators are derived in layer_stack.cpp.
class LayerStack {
 public:
  /// Depths are optical, for light that crosses the layer at a right angle.
  struct Medium {
    const VolumeShader* shader = nullptr;  ///< null: nothing is between
    Spectrum absorption, scattering;
    float mean_cosine = 0;  ///< of the angle by which light is scattered
    Point3 position;        ///< that of the surface point
    Spectrum extinction() const { return absorption + scattering; }
    bool scatters() const { return !scattering.black(); }
  };

  struct Face {
    const Scatter* scatter;
    bool reciprocal;
  };

  /// The geometric normal points to the side of the top; distances between the layers go by the shading normal.
  LayerStack(const Face& top, const Face& bottom, const Normal3& normal, const Normal3& shading_normal, const Medium& medium)
      : faces_{top, bottom}, normal_(normal), shading_normal_(shading_normal), medium_(medium) {}

  /// 0: the side of the top, 1: that of the bottom.
  int side(const Vector3& v) const { return dot(normal_, v) > 0 ? 0 : 1; }
  const Scatter& face(int side) const { return *faces_[side].scatter; }
  const Medium& medium() const { return medium_; }
  /// What is left of light that goes a part of the way from one layer to the other.
  Spectrum transmittance(const Vector3& direction, float part) const;

  /// An unbiased estimate of f |cos| [1/sr] of the light that went in through the face on the side of `out`, was scattered at
  /// least once by something that is not specular, and came out in direction `in`.
  Spectrum estimate(const Vector3& out, const Vector3& in, Transport, HashedRandom&) const;

  /// About the density [1/sr] with which walks of such light that begin with `entering` of the lobes in the face come out in
  /// direction `in`. Never 0.
  float pdf(const Vector3& out, const Vector3& in, Transport, HashedRandom&) const;

  /// Goes on from a sample of the face on the side of `out` that went in, until it comes out; false: it does not.
  bool walk(const Vector3& out, const ScatterSample& entering, Transport, HashedRandom&, LayerWalk&) const;

  /// Estimates of the fraction of light that goes in from `out` and comes out on both sides: by way of specular events alone
  /// and otherwise.
  struct Albedo {
    Spectrum specular[2], smooth[2];  ///< [0] reflected, [1] transmitted
  };
  Albedo albedo(const Vector3& out) const;

 private:
  struct Edge;
  struct Edges;
  /// What a face does with diffuse light between the layers, as fractions.
  struct Diffuse {
    Spectrum back, leave;              ///< sent back, and let out
    Spectrum back_clear, leave_clear;  ///< after the medium's absorption there and back, and there
    Spectrum absorbed;                 ///< what the medium leaves of light that crosses it once
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
  mutable Diffuse diffuse_[2];  ///< found when first asked for: a stack belongs to one sample, and so to one thread
};

}  // namespace etendue
