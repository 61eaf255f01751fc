#pragma once
// The rows of the table of closures: what gathers each of them, by subject. For the files of this folder that define them.

#include <span>
#include <string_view>

#include "gathering.h"

namespace etendue::osl {

struct ClosureModel {
  const char* name;
  void (*gather)(Gathering&, const ClosureComponent&);  ///< null: the closure emits light
  Lobes lobes;
  float albedo_error = 0;  ///< as Shader::albedo_error, by its model
  bool reciprocal = true;
};

std::span<const ClosureModel> diffuse_closures();
std::span<const ClosureModel> facet_closures();
std::span<const ClosureModel> boundary_closures();
/// Bodies that light enters and leaves elsewhere, and fibres.
std::span<const ClosureModel> body_closures();

/// The number of a closure's arguments by position.
size_t positional(const ClosureComponent&);
/// The value of an optional argument, or `otherwise`.
float keyword(const ClosureComponent&, std::string_view name, float otherwise);
/// A diffuse surface of slopes.
void rough_diffuse(Gathering&, Triple normal, Triple albedo, float roughness);

}  // namespace etendue::osl
