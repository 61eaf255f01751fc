#pragma once
// Shader is the interface of materials (Material in pbrt, BSDF in Mitsuba), Scatter that of a BSDF at one point (BSDF and BxDF
// in pbrt). Shader::bind reads the maps once, for a point and wavelengths, and returns a Scatter, which evaluates and samples
// the scattering there.
//
// A new material derives one class from Shader and one from Scatter (docs/write-a-shader.md):
//   - Shader must implement `bind` and `possible_lobes`. Optional: `interior_index` if it refracts, `transmits`, `lossless`,
//     `reciprocal`, `albedo_error`, `stochastic`, and for subsurface scattering `has_subsurface_exit` with `sample_exit`.
//   - Scatter must implement `local_evaluate`, `local_pdf`, `local_sample` and `local_albedo`. Optional: `local_value_and_pdf`
//     for speed, `relative_index` for rough refraction, `total_internal_reflection` for smooth refraction.
//   - A Scatter made of other Scatters derives from ScatterCombination; one that is evaluated very often from ScatterModel
//     (scatter_model.h).

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
/// the surface. The public functions apply the side tests, lobe masks and corrections for shading normals and refraction
/// (derived in scatter_answers.h). Subclasses override the protected local_* functions, in whose coordinates z is along the
/// shading normal on the front side.
class Scatter {
 public:
  /// f |cos| [1/sr]. The cosine is with the normal that the model uses (its shading normal), therefore it is part of the value.
  /// Zero for specular lobes.
  Spectrum evaluate(const Vector3& out, const Vector3& in, Transport transport = Transport::radiance,
                    Lobes which = all_lobes) const {
    return world_evaluate(out, in, transport, Lobes(which & lobes_));
  }
  /// The pdf [1/sr] of `sample` for `in`, without specular lobes. The pdf of the reverse direction is the same call with the
  /// directions exchanged.
  float pdf(const Vector3& out, const Vector3& in, Transport transport = Transport::radiance, Lobes which = all_lobes) const {
    return world_pdf(out, in, transport, Lobes(which & lobes_));
  }
  /// Both of the above in one call.
  ScatterValue value_and_pdf(const Vector3& out, const Vector3& in, Transport transport = Transport::radiance,
                             Lobes which = all_lobes) const {
    return world_value_and_pdf(out, in, transport, Lobes(which & lobes_));
  }
  /// Samples a direction from the requested lobes: `choice` selects the lobe, `u` the direction within it. Empty when the
  /// sample is absorbed: it must be counted as a sample with contribution zero.
  std::optional<ScatterSample> sample(const Vector3& out, float choice, Point2 u, Transport transport = Transport::radiance,
                                      Lobes which = all_lobes) const {
    which &= lobes_;
    return which == no_lobes ? std::nullopt : world_sample(out, choice, u, transport, which);
  }
  /// The directional albedo: the fraction of uniform incident light that the requested lobes scatter towards `out`, as power
  /// (without the factor 1 / eta^2 of refracted radiance). Used by Russian roulette, the choice between lobes, and the albedo
  /// images of denoisers. Its accuracy is Shader::albedo_error.
  Spectrum albedo(const Vector3& out, Lobes which = all_lobes) const {
    which &= lobes_;
    return which == no_lobes ? Spectrum() : world_albedo(out, which);
  }

  /// The lobes present at this point.
  Lobes lobes() const { return lobes_; }
  bool has(Lobes any) const { return (lobes_ & any) != 0; }
  /// Whether `sample` uses its argument `choice`. Subclasses that never do set has_choice_ to false, which saves a random
  /// number.
  bool has_choice() const { return has_choice_ || normals_ == Normals::folded; }
  /// The specular lobes that disperse for every `out`, each wavelength into its own direction. When one of these lobes alone is
  /// requested, `sample` returns the direction of the hero wavelength. A lobe that disperses in some of its directions only, as
  /// a grating's does, is not included.
  Lobes dispersed() const { return dispersed_; }
  /// |cos| of the angle between a direction and the shading normal.
  float cosine(const Vector3& v) const { return std::abs(dot(frame_.n, v)); }
  const Frame& frame() const { return frame_; }

 protected:
  Scatter(const SurfacePoint& p, Lobes lobes) : Scatter(p, Frame(p.shading_normal), lobes) {}
  /// With a given tangent frame (for anisotropic models); frame.n must be on the same side as the point's geometric normal.
  Scatter(const SurfacePoint& p, const Frame& frame, Lobes lobes)
      : frame_(frame), normal_(p.normal), lobes_(Lobes(lobes & let_through(p))), normals_(normals_of(p, frame)) {}
  ~Scatter() = default;

  struct LocalSample {
    Vector3 in;
    Spectrum value;  ///< f |cos| for smooth lobes, summed over all requested ones; for a specular lobe its reflectance or
                     ///< transmittance
    float pdf = 0;   ///< [1/sr] for smooth lobes, of all requested ones together; for a specular lobe its discrete probability
    Lobe lobe = diffuse_reflection;
    float eta = 1;  ///< at the hero wavelength, as in ScatterSample
    bool dispersive = false;
  };
  // f [1/sr] without the cosine, as for importance: without the factor 1 / eta^2 of refracted radiance. `which` holds all
  // requested lobes that are present, reflection and transmission, specular ones too, so that the probabilities of choosing
  // between lobes are the same here as in local_sample. Whether the pair of directions is reflection or transmission follows
  // from the signs of z, which agree with the geometric sides.
  virtual Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes which) const = 0;
  virtual float local_pdf(const Vector3& out, const Vector3& in, Lobes which) const = 0;
  virtual ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes which) const {
    return {local_evaluate(out, in, which), local_pdf(out, in, which)};
  }
  /// Returns false if the sample is absorbed. The pdf of a sample of a smooth lobe must include every requested lobe that could
  /// have generated the direction.
  virtual bool local_sample(const Vector3& out, float choice, Point2 u, Lobes which, LocalSample&) const = 0;
  virtual Spectrum local_albedo(const Vector3& out, Lobes which) const = 0;
  /// For smooth transmission lobes: the index on the side of `in` (second argument) over that on the side of `out` (first), per
  /// wavelength; 1 without refraction.
  virtual Spectrum relative_index(const Vector3&, const Vector3&) const { return Spectrum(1.0f); }

  /// Whether there is total internal reflection for a viewer in a local direction, at a specular boundary without smooth lobes.
  /// Only called for models that set has_total_internal_reflection_.
  virtual bool total_internal_reflection(const Vector3&) const { return false; }

  // Implement the public functions, for the requested lobes that are present. Here they call the local functions; ScatterModel
  // (scatter_model.h) and ScatterCombination override them.
  virtual Spectrum world_evaluate(const Vector3& out, const Vector3& in, Transport, Lobes which) const;
  virtual float world_pdf(const Vector3& out, const Vector3& in, Transport, Lobes which) const;
  virtual ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, Transport, Lobes which) const;
  virtual std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, Transport, Lobes which) const;
  virtual Spectrum world_albedo(const Vector3& out, Lobes which) const;

  Frame frame_;
  Normal3 normal_;
  Lobes lobes_;
  /// Whether the shading normal equals the geometric normal, and if not, which correction is applied (ShadingNormals).
  enum class Normals : std::uint8_t { same, folded, clipped } normals_;
  bool has_choice_ = true;
  bool has_total_internal_reflection_ = false;
  Lobes dispersed_ = no_lobes;
  /// False for a model whose f changes when `out` and `in` are exchanged. Then the argument `out` of local_evaluate is the
  /// direction that light leaves in, for importance too; local_sample and local_pdf still get the direction the path came from.
  bool reciprocal_ = true;

 private:
  template <class Model>
  friend class ScatterAnswers;
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

/// The base of a Scatter made of other Scatters, each of which may have its own shading normal. It implements the public
/// functions in world directions by calling the public functions of its parts, which apply their own corrections.
class ScatterCombination : public Scatter {
 public:
  // Values are those of `Scatter::evaluate`, including the cosine and the corrections.
  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, Transport, Lobes which) const override = 0;
  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, Transport,
                                            Lobes which) const override = 0;
  Spectrum world_albedo(const Vector3& out, Lobes which) const override = 0;

 protected:
  ScatterCombination(const SurfacePoint& p, Lobes lobes) : Scatter(p, lobes) {}
  ~ScatterCombination() = default;

 private:
  Spectrum world_evaluate(const Vector3& out, const Vector3& in, Transport transport, Lobes which) const final {
    return world_value_and_pdf(out, in, transport, which).value;
  }
  float world_pdf(const Vector3& out, const Vector3& in, Transport transport, Lobes which) const final {
    return world_value_and_pdf(out, in, transport, which).pdf;
  }
  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const final { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const final { return 0; }
  bool local_sample(const Vector3&, float, Point2, Lobes, LocalSample&) const final { return false; }
  Spectrum local_albedo(const Vector3&, Lobes) const final { return {}; }
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
  /// Its Scatter sets reciprocal_ to false, so that the scattering of importance is still the adjoint of that of radiance.
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
