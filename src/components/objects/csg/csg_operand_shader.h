#pragma once
// OperandShader: lets every operand of a solid keep its own material.

#include "etendue/shader.h"

namespace etendue {

/// Looks up which operand of a Csg a point lies on and asks that operand's shader. It has no members; the solid that carries it
/// tells it, each time it is prepared, what it stands for.
class OperandShader final : public Shader {
 public:
  static void describe(Description<OperandShader>&);

  void prepare() override {
    shaders_.clear();
    solid_ = nullptr;
  }
  /// Counts a shader of a solid among those asked; null: a black one. False: it stands for those of another solid already.
  bool stand_for(const SceneObject& solid, const Shader* shader);

  const Scatter* bind(const SurfacePoint&, const Wavelengths&, Arena&) const override;
  Lobes possible_lobes() const override;
  Spectrum interior_index(const Wavelengths&) const override;
  bool transmits() const override;
  bool lossless() const override;
  bool reciprocal() const override;
  bool stochastic() const override;
  float albedo_error() const override;
  bool has_subsurface_exit() const override;
  std::optional<SubsurfaceExit> sample_exit(const SurfacePoint&, const Scene&, const Wavelengths&, NumberStream&,
                                            Arena&) const override;

 private:
  template <class F>
  bool any(const F& is) const {
    return std::any_of(shaders_.begin(), shaders_.end(), [&](const Shader* s) { return s && is(*s); });
  }

  const SceneObject* solid_ = nullptr;
  std::vector<const Shader*> shaders_;  // each once; null among them: there is a black one
};

}  // namespace etendue
