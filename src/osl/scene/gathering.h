#pragma once
// Gathering: the parts of a mixture, gathered from the tree of a closure.

#include <array>
#include <memory>

#include "closure_models.h"
#include "lobes.h"
#include "mixture.h"
#include "slots.h"

namespace etendue::osl {

class Gathering {
 public:
  explicit Gathering(const ClosurePlace& place) : place_(place) {}

  /// Gathers all components of a closure, times the current weight.
  void add_closure(const ClosureNode*);
  /// The mixture of the parts; null if there are none.
  const Scatter* scatter() const;

  // For the closures' models, with the weight of the component that is gathered.

  const SurfacePoint& point() const { return place_.point; }
  Arena& arena() const { return place_.arena; }
  const Wavelengths& wavelengths() const { return place_.wavelengths; }
  /// The point with a closure's normal as shading normal, on the side of the geometric normal, and with its tangent unless that
  /// is zero. A zero normal is the point's own.
  SurfacePoint at(const Triple& normal, const Triple& tangent = {}) const;
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
  void add_facets(const SurfacePoint&, const MicrofacetDistribution&, const SchlickFresnel&);
  /// Facets below a film.
  void add_film_facets(const SurfacePoint&, const MicrofacetDistribution&, const FilmFresnel&);
  void add_layers(const ClosureNode* top, const ClosureNode* base);
  /// Warns, once for each text.
  void warn(const std::string&) const;

 private:
  void add_component(const ClosureComponent&);
  void push(const Scatter*, Lobes, const Spectrum& weight);

  const ClosurePlace& place_;
  union {  // made one by one: that of all would take as long as the rest of a simple shader
    MixturePart parts_[Mixture::most_parts];
  };
  int count_ = 0;
  const Cover* covers_ = nullptr;
  Triple weight_{1};
  Spectrum spectral_weight_ = Spectrum(1.0f);
};

}  // namespace etendue::osl
