#pragma once
// Gathering: the parts of a mixture, gathered from the tree of a closure.

#include <array>
#include <memory>

#include "boundary.h"
#include "closure_models.h"
#include "components/shaders/tangent_frame.h"
#include "lobes.h"
#include "mixture.h"
#include "slots.h"

namespace etendue::osl {

class Gathering {
 public:
  /// Of all components of a closure.
  Gathering(const ClosureNode*, const ClosurePlace&);
  /// Of none: for what is said below of a component.
  explicit Gathering(const ClosurePlace& place) : place_(place) {}

  /// The mixture of the parts; null if there are none.
  const Scatter* scatter() const;

  // For the closures' models, with the weight of the component that is gathered.

  const SurfacePoint& point() const { return place_.point; }
  Arena& arena() const { return place_.arena; }
  const Wavelengths& wavelengths() const { return place_.wavelengths; }
  /// The point with a closure's normal as shading normal, on the side of the geometric normal, and with its tangent unless that
  /// is zero. A zero normal is the point's own.
  const SurfacePoint& at(const Triple& normal, const Triple& tangent = {}) const;
  /// Whether a closure's normal points to the back of the surface.
  bool points_back(const Triple& normal) const;
  /// See ClosurePlace.
  bool exits() const { return place_.exits; }
  bool refracts() const { return place_.refracts; }
  /// The index of the medium around the object, as the path knows it.
  Spectrum index_outside() const;
  /// A colour, times the weight, as a reflectance: at most 1, with a warning if it is cut.
  Spectrum reflectance(const Triple& color) const;
  /// A colour as a spectrum, without the weight.
  Spectrum color(const Triple& color, ColorUse) const;

  /// Adds a shader of the house, bound with the values of its slots, as one part of which some lobes count.
  void add(const etendue::Shader&, const SlotValues&, const SurfacePoint&, Lobes, Spectrum weight = Spectrum(1.0f));
  void add(const Scatter*, Lobes, Spectrum weight = Spectrum(1.0f));
  /// Light that enters a body which it leaves by sample_exit.
  void add_entry(const Scatter*, Spectrum weight);
  /// Facets, or a mirror if they are smooth.
  template <class Fresnel>
  void add_facets(const SurfacePoint&, const MicrofacetDistribution&, const Fresnel&, const Spectrum& tint = Spectrum(1.0f));
  /// What the component adds more than once may sum to as much as that.
  void adds_up() { component_bound_ *= 2; }
  void add_layers(const ClosureNode* top, const ClosureNode* base);

  /// One side of a boundary, which the other may join.
  struct Half {
    Boundary boundary;
    SlotValues values;
    int part;
    const Cover* covers;
    Spectrum bound;
  };
  /// The side that a boundary completes, if there was one; null otherwise.
  const Half* other_half(const Boundary&) const;
  void note_half(const Boundary&, const SlotValues&);
  void join(const Half&, const etendue::Shader&, const SlotValues&, const SurfacePoint&);
  /// Warns, once for each text.
  void warn(const std::string&) const;

 private:
  /// Adds the components of a closure, times the current weight. Returns what they reflect together at most.
  Spectrum add_closure(const ClosureNode*);
  Spectrum add_component(const ClosureComponent&);
  /// The current weight as a spectrum, at most 1.
  Spectrum weight_bound() const;
  /// The direction to the viewer.
  Vector3 seen_from() const {
    const Vector3& ray = place_.point.ray_direction;
    return ray == Vector3{} ? Vector3(place_.point.normal) : -ray;
  }
  void push(const Scatter*, Lobes, const Spectrum& weight);

  static constexpr int most_halves = 4;
  const ClosurePlace& place_;
  union {  // made one by one: that of all would take as long as the rest of a simple shader
    MixturePart parts_[Mixture::most_parts];
  };
  union {
    Half halves_[most_halves];
  };
  int count_ = 0, half_count_ = 0, layers_ = 0;
  const Cover* covers_ = nullptr;
  Spectrum bound_;  ///< what all parts reflect together at most
  Spectrum component_bound_;
  Triple weight_{1};
  Spectrum spectral_weight_ = Spectrum(1.0f);
};

template <class Fresnel>
void Gathering::add_facets(const SurfacePoint& p, const MicrofacetDistribution& d, const Fresnel& fresnel,
                           const Spectrum& tint) {
  if (tint.black()) return;
  if (d.smooth()) return add(arena().make<MirrorReflection<Fresnel>>(p, fresnel, tint), specular_reflection);
  const Frame frame = d.isotropic() ? Frame(p.shading_normal) : tangent_frame(p);
  add(arena().make<FacetReflection<Fresnel>>(p, frame, d, fresnel, tint, true), glossy_reflection);
}

}  // namespace etendue::osl
