#pragma once
// The scattering of two layers.

#include "layer_stack.h"

namespace etendue {

/// The lobes of light that was between the layers, having gone in through a face with the first lobes, with the others on
/// the far side. What is not specular is one lobe a side: diffuse when anything on the way may be, else glossy.
Lobes lobes_between(Lobes near, Lobes far, bool scatters);

/// One surface over another: what the outer face reflects, and what was between. See layered_scatter.cpp.
class LayeredScatter final : public ScatterCombination {
 public:
  /// `front`, and `back` where the surface is seen from behind: stacks of the path's wavelengths and, when there is more than
  /// one, of each but the hero alone. A layer that disperses light sends each wavelength another way.
  LayeredScatter(const SurfacePoint& p, const LayerStack* const* front, const LayerStack* const* back, int stacks, int walks,
                 std::uint64_t seed, Lobes lobes);

  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, Transport transport, Lobes which) const override;

  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, Transport transport,
                                            Lobes which) const override;

  Spectrum world_albedo(const Vector3& out, Lobes which) const override;

 private:
  /// What is asked of light that comes from `out`.
  struct Question {
    Lobes possible, between;  ///< lobes of light from between the layers: those there are, and those asked for
    Lobes face;               ///< lobes to choose from in the face that light meets first

    Question(const LayerStack&, const Vector3& out, Lobes which);
  };

  const LayerStack* const* seen_from(const Vector3& out) const { return sides_[dot(normal_, out) > 0 ? 0 : 1]; }

  /// Each use has numbers of its own: weights must not depend on what they weigh.
  enum class Use : std::uint8_t { estimate, walk, pdf };
  HashedRandom numbers(Use use, const Vector3& out, const Vector3& other, Transport transport) const;
  /// Of what goes in, with about the probability that it does, and comes out in direction `in`.
  float pdf_between(const LayerStack& stack, Lobes asked, const Vector3& out, const Vector3& in, Transport transport) const;

  const LayerStack* sides_[2][spectrum_size];
  int stacks_, walks_;
  std::uint64_t seed_;
};

}  // namespace etendue
