#pragma once
// OperandShader: gives each surface of a CSG solid the shader of its operand.

#include "etendue/shader.h"

namespace etendue {

/// Looks up the operand of a Csg on whose surface a point lies and delegates to the operand's shader. It has no members in
/// descriptions; Csg::prepare registers the operands' shaders by stand_for.
class OperandShader final : public Shader {
 public:
  static void describe(Description<OperandShader>&);

  void prepare() override {
    shaders_.clear();
    solid_ = nullptr;
  }
  /// Registers the shader of an operand of `solid`; null stands for a black one. Returns false if shaders of another solid are
  /// already registered.
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
  std::vector<const Shader*> shaders_;  // without duplicates; contains null if an operand is black
};

}  // namespace etendue
