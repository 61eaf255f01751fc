#pragma once
// PerturbedNormalShader: base class of shaders that perturb the shading normal of another shader.

#include "etendue/shader.h"

namespace etendue {

/// Binds the shader below at the same point with another shading normal. Nothing else is needed: Scatter's public calls make
/// the corrections for shading normals, for radiance and importance, and a Scatter holds its own normal.
class PerturbedNormalShader : public Shader {
 public:
  const Scatter* bind(const SurfacePoint&, const Wavelengths&, Arena&) const override;
  Lobes possible_lobes() const override { return shader->possible_lobes(); }
  Spectrum interior_index(const Wavelengths& w) const override { return shader->interior_index(w); }
  bool transmits() const override { return shader->transmits(); }
  bool lossless() const override { return shader->lossless() && !shadowing; }
  // A subsurface exit has the normal of the surface at the exit point.
  /// f is reciprocal with the cosines of its own perturbed normal, but not with those of a combination that it is part of.
  bool reciprocal() const override { return false; }
  bool stochastic() const override { return shader->stochastic(); }
  /// The albedo does not include the loss by shadowing.
  float albedo_error() const override { return shadowing ? 0.5f : shader->albedo_error(); }
  bool has_subsurface_exit() const override { return shader->has_subsurface_exit(); }
  std::optional<SubsurfaceExit> sample_exit(const SurfacePoint& p, const Scene& scene, const Wavelengths& w,
                                            NumberStream& random, Arena& arena) const override {
    return shader->sample_exit(perturbed(p), scene, w, random, arena);
  }

  Ref<Shader> shader;
  bool shadowing = false, opposite_slopes = false;

 protected:
  template <class T>
  static void describe_slopes(Description<T>& d) {
    d.group("Slopes")
        .template member<&T::shadowing>(
            "shadowing", "",
            "whether light that comes at a slant is dimmed, the more the farther the normal is tilted, as slopes would dim it "
            "that shade one another: shadows on tilted normals then begin softly. It loses light (Conty Estevez, Lecocq & "
            "Stein 2019, A "
            "microfacet-based shadowing function to solve the bump terminator problem)")
        .template member<&T::opposite_slopes>(
            "opposite_slopes", "",
            "whether who looks at a slope from behind sees instead the one tilted the other way (Schuessler et al. 2017, "
            "Microfacet-based normal mapping for robust Monte Carlo path tracing); without, the slope is seen from there too");
  }
  /// A vector along the new normal, of any length; `p` has its tangents. If it is zero or not finite, the normal is unchanged.
  virtual Vector3 tilted(const SurfacePoint& p) const = 0;

 private:
  SurfacePoint perturbed(const SurfacePoint& point) const {
    SurfacePoint p = point;
    if (p.dpdu == Vector3{} && p.dpdv == Vector3{} && p.object) p.object->tangents(p);
    const Vector3 n = tilted(p);
    const float n2 = length_squared(n);
    if (!(n2 > 0 && n2 < infinity)) return p;
    p.shading_normal = above_surface(n / std::sqrt(n2), p);
    return p;
  }
  /// Keeps a shading normal on the front of the surface: one behind it is rotated to just above it. `n` is unit.
  static Normal3 above_surface(Vector3 n, const SurfacePoint& p) {
    constexpr float least = 0.02f;
    const float cosine = dot(n, p.normal);
    if (cosine < least) n += (least - cosine) * Vector3(p.normal);
    const float l2 = length_squared(n);
    return l2 > 1e-6f ? Normal3(n / std::sqrt(l2)) : p.shading_normal;
  }
};

}  // namespace etendue
