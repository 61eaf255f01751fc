#pragma once
// LayeredScatter: the BSDF of two layers.

#include "layer_stack.h"

namespace etendue {

/// The lobes of light that enters between the layers through a face with the lobes `near`, opposite a face with the lobes
/// `far`; `scatters`: the medium between scatters. All non-specular scattering is one lobe per side: diffuse if any event on
/// the way may be diffuse, else glossy.
Lobes lobes_between(Lobes near, Lobes far, bool scatters);

/// One surface over another: reflection by the outer face, and light that was between the two. See layered_scatter.cpp.
class LayeredScatter final : public Scatter {
 public:
  /// `front` and `back`: the stacks as seen from the front and from behind. The first is bound for all of the path's
  /// wavelengths; if there are more, stack i is bound for wavelength i alone, because a dispersive layer refracts each
  /// wavelength into another direction.
  LayeredScatter(const SurfacePoint& p, const LayerStack* const* front, const LayerStack* const* back, int stacks, int walks,
                 std::uint64_t seed, Lobes lobes);

  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const override;

  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, ScatterContext context) const override;

  Spectrum world_albedo(const Vector3& out, Lobes lobes) const override;

 private:
  /// The lobes involved for light from `out`.
  struct Question {
    Lobes possible, between;  ///< lobes of light from between the layers: all, and the requested ones
    Lobes face;               ///< lobes to sample of the outer face

    Question(const LayerStack&, const Vector3& out, Lobes lobes);
  };

  const LayerStack* const* seen_from(const Vector3& out) const { return sides_[dot(normal_, out) > 0 ? 0 : 1]; }

  /// Each use has random numbers of its own: MIS weights must be independent of the values they multiply.
  enum class Use : std::uint8_t { estimate, walk, pdf };
  HashedRandom numbers(Use use, const Vector3& out, const Vector3& other, Transport transport) const;
  /// The approximate pdf [1/sr] of entering between the layers and leaving in direction `in`.
  float pdf_between(const LayerStack& stack, const Vector3& out, const Vector3& in, ScatterContext context) const;

  const LayerStack* sides_[2][spectrum_size];
  int stacks_, walks_;
  std::uint64_t seed_;
};

}  // namespace etendue
