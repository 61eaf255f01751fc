#pragma once
// Shader is the interface of materials (Material in pbrt, BSDF in Mitsuba), Scatter that of a BSDF at one point (BSDF and BxDF
// in pbrt). Shader::bind reads the maps once, for a point and wavelengths, and returns a Scatter, which evaluates and samples
// the scattering there.
//
// A new material derives one class from Shader and one from ScatterModel (docs/write-a-shader.md):
//   - Shader must implement `bind` and `possible_lobes`. Optional: `interior_index` if it refracts, `transmits`, `lossless`,
//     `reciprocal`, `albedo_error`, `stochastic`, and for subsurface scattering `has_subsurface_exit` with `sample_exit`.
//   - ScatterModel (scatter_model.h) needs the model's functions in local directions, which it documents, and makes the
//     corrections for shading normals and refraction.
//   - A Scatter made of other Scatters derives from Scatter itself, and must implement `world_value_and_pdf`, `world_sample`
//     and `world_albedo`, in world directions.

#include <optional>

#include "etendue/core/arena.h"
#include "etendue/core/ray.h"
#include "etendue/core/spectrum.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/scene_object.h"

namespace etendue {

class NumberStream;
class Scene;

/// Kinds of scattering, as bits.
enum Lobe : std::uint8_t {
  diffuse_reflection = 1,
  diffuse_transmission = 2,
  glossy_reflection = 4,
  glossy_transmission = 8,
  specular_reflection = 16,  ///< a delta distribution: all light into one direction
  specular_transmission = 32,
  null_scattering = 64,  ///< a delta distribution along the unchanged direction: an index-matched boundary
};
using Lobes = std::uint8_t;
inline constexpr Lobes no_lobes = 0;
inline constexpr Lobes all_lobes = 127;
inline constexpr Lobes diffuse_lobes = diffuse_reflection | diffuse_transmission;
inline constexpr Lobes glossy_lobes = glossy_reflection | glossy_transmission;
inline constexpr Lobes specular_lobes = specular_reflection | specular_transmission | null_scattering;
inline constexpr Lobes reflection_lobes = diffuse_reflection | glossy_reflection | specular_reflection;
inline constexpr Lobes transmission_lobes =
    diffuse_transmission | glossy_transmission | specular_transmission | null_scattering;
/// The lobes that are not delta distributions: they have a pdf [1/sr] and can be evaluated for a given pair of directions.
inline constexpr Lobes smooth_lobes = diffuse_lobes | glossy_lobes;

/// The quantity whose scattering from `in` to `out` is computed: radiance on paths that start at the camera, importance on
/// paths that start at a light. The two differ at refraction and at shading normals (Veach 1997, chapter 5).
enum class Transport : std::uint8_t { radiance, importance };
/// The quantity of the same path traced in the opposite direction.
inline Transport adjoint(Transport t) { return t == Transport::radiance ? Transport::importance : Transport::radiance; }

/// Which part of a BSDF a function of Scatter computes, and for which quantity (BSDFContext in Mitsuba). By default all of it,
/// for radiance.
struct ScatterContext {
  Transport transport = Transport::radiance;
  Lobes lobes = all_lobes;  ///< the requested lobes; those that are not present contribute nothing
};

/// A direction sampled by a Scatter. All vectors point away from the surface and have unit length.
struct ScatterSample {
  Vector3 direction;
  Spectrum weight;  ///< f |cos| / pdf for smooth lobes; for specular lobes the reflectance or transmittance over the lobe's
                    ///< probability
  float pdf = 0;    ///< [1/sr] for smooth lobes (of all requested lobes together); for specular lobes a discrete probability
  Lobe lobe = diffuse_reflection;
  float eta = 1;  ///< index on the side of `direction` over that on the side of `out`, at the hero wavelength; 1 for
                  ///< reflection. The weight already includes the squared relative index of each wavelength: eta is for Russian
                  ///< roulette and bookkeeping only
  bool dispersive = false;  ///< the direction is that of the hero wavelength only: the secondary wavelengths must be dropped
  bool specular() const { return (lobe & specular_lobes) != 0; }
  bool transmitted() const { return (lobe & transmission_lobes) != 0; }
};

/// The value of the BSDF for a pair of directions, and the pdf of sampling one of them.
struct ScatterValue {
  Spectrum value;  ///< f |cos| [1/sr]: scattered radiance per incident radiance and solid angle
  float pdf = 0;   ///< of `sample` for the direction [1/sr]
};

/// A BSDF at a point. `out` is the direction the path came from, `in` the direction it continues in, both pointing away from
/// the surface. Values include the side tests and the corrections for shading normals and refraction (derived in
/// scatter_corrections.h).
class Scatter {
 public:
  /// f |cos| [1/sr]. The cosine is with the normal that the model uses (its shading normal), therefore it is part of the value.
  /// Zero for specular lobes.
  Spectrum evaluate(const Vector3& out, const Vector3& in, ScatterContext context = {}) const {
    return world_evaluate(out, in, present(context));
  }
  /// The pdf [1/sr] of `sample` for `in`, without specular lobes. The pdf of the reverse direction is the same call with the
  /// directions exchanged.
  float pdf(const Vector3& out, const Vector3& in, ScatterContext context = {}) const {
    return world_pdf(out, in, present(context));
  }
  /// Both of the above in one call.
  ScatterValue value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext context = {}) const {
    return world_value_and_pdf(out, in, present(context));
  }
  /// Samples a direction from the requested lobes: `choice` selects the lobe, `u` the direction within it. Empty when the
  /// sample is absorbed: it must be counted as a sample with contribution zero.
  std::optional<ScatterSample> sample(const Vector3& out, float choice, Point2 u, ScatterContext context = {}) const {
    context = present(context);
    return context.lobes == no_lobes ? std::nullopt : world_sample(out, choice, u, context);
  }
  /// The directional albedo: the fraction of uniform incident light that the requested lobes scatter towards `out`, as power
  /// (without the factor 1 / eta^2 of refracted radiance). Used by Russian roulette, the choice between lobes, and the albedo
  /// images of denoisers. Its accuracy is Shader::albedo_error.
  Spectrum albedo(const Vector3& out, Lobes lobes = all_lobes) const {
    lobes &= lobes_;
    return lobes == no_lobes ? Spectrum() : world_albedo(out, lobes);
  }

  /// The lobes present at this point.
  Lobes lobes() const { return lobes_; }
  bool has(Lobes any) const { return (lobes_ & any) != 0; }
  /// Whether `sample` uses its argument `choice`.
  bool has_choice() const { return has_choice_ || normals_ == Normals::folded; }
  /// The specular lobes that disperse for every `out`, each wavelength into its own direction. When one of these lobes alone is
  /// requested, `sample` returns the direction of the hero wavelength. A lobe that disperses in some of its directions only, as
  /// a grating's does, is not included.
  Lobes dispersed_lobes() const { return dispersed_lobes_; }
  /// |cos| of the angle between a direction and the shading normal.
  float cosine(const Vector3& v) const { return std::abs(dot(frame_.n, v)); }
  const Frame& frame() const { return frame_; }

 protected:
  Scatter(const SurfacePoint& p, Lobes lobes) : Scatter(p, Frame(p.shading_normal), lobes) {}
  /// With a given tangent frame (for anisotropic models); frame.n must be on the same side as the point's geometric normal.
  Scatter(const SurfacePoint& p, const Frame& frame, Lobes lobes)
      : frame_(frame), normal_(p.normal), lobes_(Lobes(lobes & let_through(p))), normals_(normals_of(p, frame)) {}
  ~Scatter() = default;

  // Implement the public functions. The lobes given are the requested ones that are present; world_sample and world_albedo are
  // called only if there are any.
  virtual Spectrum world_evaluate(const Vector3& out, const Vector3& in, ScatterContext context) const {
    return world_value_and_pdf(out, in, context).value;
  }
  virtual float world_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const {
    return world_value_and_pdf(out, in, context).pdf;
  }
  virtual ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext) const = 0;
  virtual std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, ScatterContext) const = 0;
  virtual Spectrum world_albedo(const Vector3& out, Lobes) const = 0;

  Frame frame_;
  Normal3 normal_;
  Lobes lobes_;
  /// Whether the shading normal equals the geometric normal, and if not, which correction is applied (ShadingNormals).
  enum class Normals : std::uint8_t { same, folded, clipped } normals_;
  /// Whether world_sample uses `choice` at this point; false saves a random number.
  bool has_choice_ = true;
  /// See dispersed_lobes.
  Lobes dispersed_lobes_ = no_lobes;

 private:
  template <class Model>
  friend class ScatterCorrections;
  ScatterContext present(ScatterContext context) const { return {context.transport, Lobes(context.lobes & lobes_)}; }
  /// The lobes that remain on an object of which one side only scatters (SceneObject::sides). Light transmitted to the other
  /// side is absorbed; null scattering stays, as it is not scattering by matter.
  static Lobes let_through(const SurfacePoint& p) {
    return p.object && p.object->sides != Sides::both ? Lobes(reflection_lobes | null_scattering) : all_lobes;
  }
  static Normals normals_of(const SurfacePoint& p, const Frame& frame) {
    if (frame.n == p.normal) return Normals::same;
    return p.object && p.object->shading_normals == ShadingNormals::clipped ? Normals::clipped : Normals::folded;
  }
};

/// The exit point of subsurface scattering: where light that entered an object leaves it again.
struct SubsurfaceExit {
  SurfacePoint point;                ///< on the surface of the object
  Spectrum weight;                   ///< throughput from the entry point to the exit point, over the pdf of the exit point
  const Scatter* scatter = nullptr;  ///< the BSDF for light from inside at the exit point; called with `out` = point.normal
};

/// A material. All functions are const and called from many threads.
class Shader : public Component {
 public:
  using Interface = Shader;
  using Parent = Component;
  static void describe(Description<Shader>&);

  /// The BSDF at a point, allocated in the arena. Null: all light is absorbed. It is valid until the arena is rewound: at the
  /// end of the sample, and in a CameraWalk at the step to the next vertex.
  virtual const Scatter* bind(const SurfacePoint&, const Wavelengths&, Arena&) const = 0;
  /// The union of the lobes of all Scatters that `bind` may return. Renderers and the advice to users (src/app/advice.h) rely
  /// on it.
  virtual Lobes possible_lobes() const = 0;
  /// The refractive index behind the surface (inside the object); 1 when the shader does not refract.
  virtual Spectrum interior_index(const Wavelengths&) const { return Spectrum(1.0f); }
  /// Whether a path through the surface enters or leaves the object's interior, so that media and refractive indices nest.
  virtual bool transmits() const { return (possible_lobes() & transmission_lobes) != 0; }
  /// Whether nothing is absorbed: the albedo is 1 for every direction.
  virtual bool lossless() const { return false; }
  /// Whether f(out, in) = f(in, out), across refraction with the squared indices. A model that is not reciprocal documents why.
  /// Its ScatterModel declares it too (ScatterModel::reciprocal), so that the scattering of importance is still the adjoint of
  /// that of radiance.
  virtual bool reciprocal() const { return true; }
  /// An upper bound of the relative error of Scatter::albedo: 0 if it is exact except for rounding; more if it comes from a
  /// table or an approximation. The bound holds up to 85 degrees from the normal, for every set of lobes.
  virtual float albedo_error() const { return 0; }
  /// Whether Scatter::evaluate is an unbiased estimate whose random numbers are a hash of its arguments (as in pbrt's
  /// LayeredBxDF). Scatter::pdf is then the pdf of a distribution similar to that of `sample`: it is used in weights of
  /// multiple importance sampling only, which stay correct.
  virtual bool stochastic() const { return false; }
  /// Whether light that enters the object by `specular_transmission`, `glossy_transmission` or `diffuse_transmission` leaves it
  /// at another point. Renderers then call `sample_exit` instead of tracing the path inside.
  virtual bool has_subsurface_exit() const { return false; }
  /// Samples the exit point of light that enters at a point. Takes as many primary samples from the stream as it needs. Empty:
  /// absorbed.
  virtual std::optional<SubsurfaceExit> sample_exit(const SurfacePoint&, const Scene&, const Wavelengths&, NumberStream&,
                                                    Arena&) const {
    return std::nullopt;
  }
};

}  // namespace etendue
