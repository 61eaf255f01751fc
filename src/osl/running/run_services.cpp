// What library functions ask for during a run.

#include <fmt/format.h>

#include "places.h"
#include "run_state.h"
#include "shader_group.h"

namespace etendue::osl {

// ---- what the point answers ----------------------------------------------------------------------------------------------

Triple RunServices::geometric_normal() const { return run_->globals->Ng.value; }
bool RunServices::backfacing() const { return run_->globals->backfacing; }
bool RunServices::flipped_handedness() const { return run_->globals->flipped_handedness; }
float RunServices::surface_area() const { return run_->globals->surface_area; }

void RunServices::displace(const Dual<Triple>& offset, bool bump) {
  Globals& g = *run_->globals;
  const Dual<Triple> moved = g.P + offset;
  // The normal of the moved surface, as calculatenormal(P) gives it. It keeps the side that it had.
  Triple normal = cross(moved.dx, moved.dy);
  const float size = length(normal);
  if (!bump) g.P = moved;
  if (size <= 0) return;
  normal = normal * (1 / size);
  g.N = dot(normal, g.N.value) < 0 ? -normal : normal;
}

void RunServices::displace_along_normal(const Dual<float>& amount, const String* space, bool bump) {
  const Globals& g = *run_->globals;
  const float size = length(g.N.value);
  Triple direction = size > 0 ? g.N.value * (1 / size) : Triple(0);
  if (space) {  // a unit of the space along N, in common units
    Matrix there, back;
    if (from_common(space, there) && to_common(space, back)) {
      const Triple in_space = transform_vector(there, direction);
      const float length_there = length(in_space);
      if (length_there > 0) direction = transform_vector(back, in_space * (1 / length_there));
    }
  }
  displace(amount * Dual<Triple>(direction), bump);
}

// ---- what the layers answer ------------------------------------------------------------------------------------------------

bool RunServices::attribute(const String* object, const String* name, int index, const Type& type, bool derivatives,
                            void* out) {
  if (object == nullptr && index < 0 && type.is_string()) {
    const std::string_view text = name->view();
    const String* answer = text == "shader:shadername"  ? run_->group->shader_name(run_->layer)
                           : text == "shader:layername" ? run_->group->layer_name(run_->layer)
                           : text == "shader:groupname" ? run_->group->name()
                                                        : nullptr;
    if (answer) return *static_cast<const String**>(out) = answer, true;
  }
  return run_->world->attribute(object, name, index, type, derivatives, out);
}

void RunServices::set_message(const String* name, const Type& type, bool derivatives, const void* value, Location at) {
  std::string fault;
  if (!run_->messages.set(name, type, derivatives, value, run_->layer, at, fault)) run_->world->error(fault, at);
}

bool RunServices::get_message(const String* source, const String* name, const Type& type, bool derivatives, void* out,
                              Location at) {
  if (source && !source->view().empty()) return run_->world->get_message(source, name, type, derivatives, out, at);
  std::string fault;
  if (run_->messages.get(name, type, derivatives, out, run_->layer, at, fault)) return true;
  if (!fault.empty()) run_->world->error(fault, at);
  return false;
}

void RunServices::warn(std::string_view text, Location at) {
  if (run_->speaks_itself)
    run_->world->warn(fmt::format("Shader warning [{}]: {}", run_->group->shader_name(run_->layer)->text(), text), at);
  else
    run_->world->warn(text, at);
}

void RunServices::error(std::string_view text, Location at) {
  if (run_->speaks_itself)
    run_->world->error(fmt::format("Shader error [{}]: {}", run_->group->shader_name(run_->layer)->text(), text), at);
  else
    run_->world->error(text, at);
}

void RunState::fault(std::string_view text, const Location& at) {
  world->error(fmt::format("{}: {} (group {}, layer {} {}, shader {})", text, place_text(at), group->name()->text(), layer,
                           group->layer_name(layer)->text(), group->shader_name(layer)->text()),
               at);
}

// ---- what the renderer answers
// -----------------------------------------------------------------------------------------------

bool RunServices::to_common(const String* space, Matrix& out) { return run_->world->to_common(space, out); }
bool RunServices::from_common(const String* space, Matrix& out) { return run_->world->from_common(space, out); }
bool RunServices::unknown_space_is_error() const { return run_->world->unknown_space_is_error(); }
float RunServices::seconds_per_time() const { return run_->world->seconds_per_time(); }
float RunServices::seconds_per_frame() const { return run_->world->seconds_per_frame(); }
float RunServices::metres_per_unit() const { return run_->world->metres_per_unit(); }
bool RunServices::ray_type(const String* name) const { return run_->world->ray_type(name); }
const char* RunServices::shader_file() const { return run_->group->shader(run_->layer).place.file; }
std::string_view RunServices::texture(const String* file, const Dual<float>& s, const Dual<float>& t,
                                      const TextureOptions& options, TextureLookup& lookup) {
  TextureOptions here = options;
  here.shader_file = shader_file();
  return run_->world->texture(file, s, t, here, lookup);
}
std::string_view RunServices::texture3d(const String* file, const Dual<Triple>& p, const TextureOptions& options,
                                        TextureLookup& lookup) {
  return run_->world->texture3d(file, p, options, lookup);
}
std::string_view RunServices::environment(const String* file, const Dual<Triple>& direction, const TextureOptions& options,
                                          TextureLookup& lookup) {
  TextureOptions here = options;
  here.shader_file = shader_file();
  return run_->world->environment(file, direction, here, lookup);
}
bool RunServices::texture_info(const String* file, const float* at, const String* name, const Type& type, void* out,
                               const char*) {
  return run_->world->texture_info(file, at, name, type, out, shader_file());
}
void RunServices::print(std::string_view text) { run_->world->print(text); }
void RunServices::print_to(const String* file, std::string_view text) { run_->world->print_to(file, text); }
const ColorSystem& RunServices::color_system() const { return run_->world->color_system(); }
bool RunServices::transform_color(const String* from, const String* to, const Triple& color, Triple& out) {
  return run_->world->transform_color(from, to, color, out);
}
const Wavelengths& RunServices::wavelengths() const { return run_->world->wavelengths(); }
bool RunServices::named_spectrum(const String* words, Spectrum& out) { return run_->world->named_spectrum(words, out); }
Spectrum RunServices::color_spectrum(const Triple& color, bool light) { return run_->world->color_spectrum(color, light); }
void* RunServices::allocate(std::size_t size, std::size_t alignment) {
  try {
    return run_->world->allocate(size, alignment);
  } catch (const Error& e) {  // the limit of a point's closures
    if (e.location.known()) throw;
    throw Error(e.what(), run_->group->shader(run_->layer).place);
  }
}

}  // namespace etendue::osl
