#include "csg_operand_shader.h"

#include <algorithm>

#include "csg.h"
#include "etendue/transport/scattering.h"

namespace etendue {
namespace {

/// The CSG solid on which a point lies; null for other objects.
const Csg* solid_at(const SurfacePoint& p) { return dynamic_cast<const Csg*>(p.object); }

}  // namespace

void OperandShader::describe(Description<OperandShader>& d) {
  d.summary(
      "The shader of a union, intersection or difference that lets every operand keep its own: a surface looks like that of "
      "the operand it comes from, whose object coordinates maps are given. Black on any other object. A solid is one body, so "
      "the index of what lies inside is that of the first operand which light enters.");
}

bool OperandShader::stand_for(const SceneObject& solid, const Shader* shader) {
  if (solid_ && solid_ != &solid) return false;
  solid_ = &solid;
  if (std::find(shaders_.begin(), shaders_.end(), shader) == shaders_.end()) shaders_.push_back(shader);
  return true;
}

const Scatter* OperandShader::bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const {
  const Csg* const solid = solid_at(p);
  if (!solid) return nullptr;
  SurfacePoint* const there = arena.make<SurfacePoint>(p);  // in the arena, because a Scatter may keep a reference to it
  const Shader* const shader = solid->operand_at(p, *there).shader.get();
  return shader ? bound(*shader, *there, w, arena) : nullptr;
}

Lobes OperandShader::possible_lobes() const {
  Lobes lobes = no_lobes;
  for (const Shader* s : shaders_)
    if (s) lobes |= s->possible_lobes();
  return lobes;
}

Spectrum OperandShader::interior_index(const Wavelengths& w) const {
  for (const Shader* s : shaders_)
    if (s && s->transmits()) return s->interior_index(w);
  return Spectrum(1.0f);
}

bool OperandShader::transmits() const {
  return any([](const Shader& s) { return s.transmits(); });
}
bool OperandShader::lossless() const {
  return !shaders_.empty() && std::all_of(shaders_.begin(), shaders_.end(), [](const Shader* s) { return s && s->lossless(); });
}
bool OperandShader::reciprocal() const {
  return !any([](const Shader& s) { return !s.reciprocal(); });
}
bool OperandShader::stochastic() const {
  return any([](const Shader& s) { return s.stochastic(); });
}
float OperandShader::albedo_error() const {
  float largest = 0;
  for (const Shader* shader : shaders_)
    if (shader) largest = std::max(largest, shader->albedo_error());
  return largest;
}
bool OperandShader::has_subsurface_exit() const {
  return any([](const Shader& s) { return s.has_subsurface_exit(); });
}

std::optional<SubsurfaceExit> OperandShader::sample_exit(const SurfacePoint& p, const Scene& scene, const Wavelengths& w,
                                                         NumberStream& random, Arena& arena) const {
  const Csg* const solid = solid_at(p);
  if (!solid) return std::nullopt;
  SurfacePoint there = p;
  const Shader* const shader = solid->operand_at(p, there).shader.get();
  return shader && shader->has_subsurface_exit() ? shader->sample_exit(p, scene, w, random, arena) : std::nullopt;
}

namespace {
const Register<OperandShader> registered;
}

}  // namespace etendue
