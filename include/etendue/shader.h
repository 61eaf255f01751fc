#pragma once
// Shader (a material) and Scatter (a BSDF at a point). A shader reads its maps once for a point and wavelengths and
// returns a Scatter, which answers all questions about scattering there.

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
  specular_reflection = 16,  ///< a mirror: all in one direction
  specular_transmission = 32,
  null_scattering = 64,  ///< straight on, as if nothing were there
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
/// Those that have a density and can be evaluated for a given pair of directions.
inline constexpr Lobes smooth_lobes = diffuse_lobes | glossy_lobes;

/// What the path carries from `in` to `out`: radiance when it was begun at the camera, importance when at a light.
/// The two differ where light is refracted and where shading normals are used (Veach 1997, chapter 5).
enum class Transport : std::uint8_t { radiance, importance };
/// What the same path carries when it is walked the other way.
inline Transport adjoint(Transport t) { return t == Transport::radiance ? Transport::importance : Transport::radiance; }

/// A direction chosen by a Scatter. All vectors point away from the surface and have unit length.
struct ScatterSample {
  Vector3 direction;
  Spectrum weight;  ///< f |cos| / density for smooth lobes; the lobe's fraction over its probability for specular ones
  float pdf = 0;    ///< [1/sr] for smooth lobes (all asked lobes together); for specular ones a probability
  Lobe lobe = diffuse_reflection;
  float eta = 1;  ///< the hero's index where the direction leads over that where the path came from; 1 for reflection. The
                  ///< weight has the squared index of each wavelength already: this is for roulette and bookkeeping alone
  bool dispersive = false;  ///< the direction holds for the hero wavelength only: drop the others
  bool specular() const { return (lobe & specular_lobes) != 0; }
  bool transmitted() const { return (lobe & transmission_lobes) != 0; }
};

/// What scattering does with light from one direction to another.
struct ScatterValue {
  Spectrum value;  ///< f |cos| [1/sr]: of the radiance that arrives, per solid angle, what leaves
  float pdf = 0;   ///< [1/sr] with which `sample` gives the direction
};

/// Scattering at a point. `out` is the direction the path came from, `in` the one it goes on to, both pointing away
/// from the surface. Public calls do the side tests, lobe masks and corrections for shading normals and refraction
/// (scatter_answers.h derives them); parts override the protected local versions, where z is along the shading normal on the
/// front side.
class Scatter {
 public:
  /// f |cos| [1/sr], the cosine being that with the normal the model has, which is why it is part of the value. Specular
  /// lobes give zero.
  Spectrum evaluate(const Vector3& out, const Vector3& in, Transport transport = Transport::radiance,
                    Lobes which = all_lobes) const {
    return world_evaluate(out, in, transport, Lobes(which & lobes_));
  }
  /// Solid-angle density [1/sr] with which `sample` gives `in`, specular lobes aside. The reverse density is the same
  /// call with the directions exchanged.
  float pdf(const Vector3& out, const Vector3& in, Transport transport = Transport::radiance, Lobes which = all_lobes) const {
    return world_pdf(out, in, transport, Lobes(which & lobes_));
  }
  /// Both of the above in one call.
  ScatterValue value_and_pdf(const Vector3& out, const Vector3& in, Transport transport = Transport::radiance,
                             Lobes which = all_lobes) const {
    return world_value_and_pdf(out, in, transport, Lobes(which & lobes_));
  }
  /// Chooses a direction among the asked lobes: `choice` picks the lobe, `u` the direction. Empty when the sample is
  /// absorbed (its contribution is zero, and counts).
  std::optional<ScatterSample> sample(const Vector3& out, float choice, Point2 u, Transport transport = Transport::radiance,
                                      Lobes which = all_lobes) const {
    which &= lobes_;
    return which == no_lobes ? std::nullopt : world_sample(out, choice, u, transport, which);
  }
  /// The fraction of light that arrives evenly from all sides which the asked lobes send towards `out`, as power (without what
  /// refraction does to radiance). Russian roulette, choices between lobes and the albedo that pictures and denoisers show rest
  /// on it. How exact it is: Shader::albedo_error.
  Spectrum albedo(const Vector3& out, Lobes which = all_lobes) const {
    which &= lobes_;
    return which == no_lobes ? Spectrum() : world_albedo(out, which);
  }

  /// The lobes present at this point.
  Lobes lobes() const { return lobes_; }
  bool has(Lobes any) const { return (lobes_ & any) != 0; }
  /// Whether `sample` looks at its `choice`; parts that never do may say so, which saves drawing a number.
  bool has_choice() const { return has_choice_ || normals_ == Normals::folded; }
  /// Specular lobes that send every wavelength of the path its own way, wherever light comes from: asked for one of them alone,
  /// `sample` answers for the hero. Where only some of a lobe's directions are dispersive, as a grating's, none is named.
  Lobes dispersed() const { return dispersed_; }
  /// |cos| of the angle between a direction and the shading normal.
  float cosine(const Vector3& v) const { return std::abs(dot(frame_.n, v)); }
  const Frame& frame() const { return frame_; }

 protected:
  Scatter(const SurfacePoint& p, Lobes lobes) : Scatter(p, Frame(p.shading_normal), lobes) {}
  /// With a tangent frame of its own (anisotropic models); frame.n must be on the side of the point's normal.
  Scatter(const SurfacePoint& p, const Frame& frame, Lobes lobes)
      : frame_(frame), normal_(p.normal), lobes_(Lobes(lobes & let_through(p))), normals_(normals_of(p, frame)) {}
  ~Scatter() = default;

  struct LocalSample {
    Vector3 in;
    Spectrum value;  ///< f |cos| for smooth lobes, over all asked lobes; for specular ones the lobe's fraction
    float pdf = 0;   ///< [1/sr], over all asked lobes; for specular ones the probability of the choice
    Lobe lobe = diffuse_reflection;
    float eta = 1;  ///< the hero's, as in ScatterSample
    bool dispersive = false;
  };
  // f [1/sr] without cosine, in the convention of importance: no squared-index factor. `which` holds the asked lobes that
  // are present, of both sides and specular ones too, so that the probabilities of choosing among them are the same here
  // as in local_sample; the signs of z tell reflection from transmission (they agree with the geometric sides).
  virtual Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes which) const = 0;
  virtual float local_pdf(const Vector3& out, const Vector3& in, Lobes which) const = 0;
  virtual ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes which) const {
    return {local_evaluate(out, in, which), local_pdf(out, in, which)};
  }
  /// False: absorbed. The density of a smooth sample counts every asked lobe that could have given the direction.
  virtual bool local_sample(const Vector3& out, float choice, Point2 u, Lobes which, LocalSample&) const = 0;
  virtual Spectrum local_albedo(const Vector3& out, Lobes which) const = 0;
  /// Of smooth lobes: index on the side of `in` over index on the side of `out`, per wavelength; 1 when light is not refracted.
  virtual Spectrum relative_index(const Vector3&, const Vector3&) const { return Spectrum(1.0f); }

  /// Whether a viewer at a local direction sees all light reflected by a smooth boundary, which has no smooth lobes. Only asked
  /// of models that set has_total_internal_reflection_.
  virtual bool total_internal_reflection(const Vector3&) const { return false; }

  // Answers to the public calls, for the asked lobes that are present. Here by the local functions; see scatter_model.h and
  // ScatterCombination for who else answers.
  virtual Spectrum world_evaluate(const Vector3& out, const Vector3& in, Transport, Lobes which) const;
  virtual float world_pdf(const Vector3& out, const Vector3& in, Transport, Lobes which) const;
  virtual ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, Transport, Lobes which) const;
  virtual std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, Transport, Lobes which) const;
  virtual Spectrum world_albedo(const Vector3& out, Lobes which) const;

  Frame frame_;
  Normal3 normal_;
  Lobes lobes_;
  /// Whether the shading normal is the surface's, and if not, what is done about it.
  enum class Normals : std::uint8_t { same, folded, clipped } normals_;
  bool has_choice_ = true;
  bool has_total_internal_reflection_ = false;
  Lobes dispersed_ = no_lobes;
  /// False of a model whose f depends on which direction is `out`. Then local_evaluate has where light leaves to as `out`, for
  /// importance too; local_sample and local_density still have where the path came from.
  bool reciprocal_ = true;

 private:
  template <class Model>
  friend class ScatterAnswers;
  /// What an object of which one side absorbs leaves of its shader's lobes: what goes straight on meets no matter.
  static Lobes let_through(const SurfacePoint& p) {
    return p.object && p.object->sides != Sides::both ? Lobes(reflection_lobes | null_scattering) : all_lobes;
  }
  static Normals normals_of(const SurfacePoint& p, const Frame& frame) {
    if (frame.n == p.normal) return Normals::same;
    return p.object && p.object->shading_normals == ShadingNormals::clipped ? Normals::clipped : Normals::folded;
  }
};

/// A Scatter made of others, each of which may have a shading normal of its own: it answers the public calls itself, in
/// world directions, by asking the others' public calls, which do their own corrections.
class ScatterCombination : public Scatter {
 public:
  // Values are those of `Scatter::evaluate`, cosine and corrections included.
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

/// Where light that was let into a body leaves it again.
struct SubsurfaceExit {
  SurfacePoint point;                ///< on the surface of the body
  Spectrum weight;                   ///< over the density by which the point was chosen
  const Scatter* scatter = nullptr;  ///< scatters what comes from inside out of the body: called with `out` = point.normal
};

class Shader : public Component {
 public:
  using Interface = Shader;
  using Parent = Component;
  static void describe(Description<Shader>&);

  /// The scattering at a point, in the arena. Null: nothing is scattered, all is absorbed. It lives until the arena is taken
  /// back: at the end of the sample, and on a CameraWalk when it goes to the next vertex.
  virtual const Scatter* bind(const SurfacePoint&, const Wavelengths&, Arena&) const = 0;
  /// All lobes `bind` may ever return: what renderers and advice plan by.
  virtual Lobes possible_lobes() const = 0;
  /// The refractive index of what lies behind the surface; 1 when the shader does not refract.
  virtual Spectrum interior_index(const Wavelengths&) const { return Spectrum(1.0f); }
  /// Whether a path through the surface enters or leaves the object's inside (so that media and indices nest).
  virtual bool transmits() const { return (possible_lobes() & transmission_lobes) != 0; }
  /// Whether nothing is absorbed: as much light leaves as arrives, whatever the direction.
  virtual bool lossless() const { return false; }
  /// Whether f(out, in) = f(in, out), with the squared indices across refraction. Models that are not say why; their Scatter
  /// makes importance the adjoint of radiance all the same.
  virtual bool reciprocal() const { return true; }
  /// A bound of the relative error of the Scatter's `albedo`: 0 where it is exact, but for rounding; more where a table is
  /// looked up, or where it is a guess. The bound holds up to 85 degrees from the normal, for every set of lobes.
  virtual float albedo_error() const { return 0; }
  /// Whether `evaluate` of the Scatter is an unbiased estimate, which depends on the bits of its arguments, and `density`
  /// that of something near what `sample` does: weights that compare densities stay right, and nothing else is asked of it.
  virtual bool stochastic() const { return false; }
  /// Whether light that goes into the body by `specular_transmission`, `glossy_transmission` or `diffuse_transmission` leaves
  /// it elsewhere: renderers then ask `sample_exit` instead of following it inside.
  virtual bool has_subsurface_exit() const { return false; }
  /// Where light that enters at a point leaves. The stream gives as many numbers as are needed.
  virtual std::optional<SubsurfaceExit> sample_exit(const SurfacePoint&, const Scene&, const Wavelengths&, NumberStream&,
                                                    Arena&) const {
    return std::nullopt;
  }
};

}  // namespace etendue
