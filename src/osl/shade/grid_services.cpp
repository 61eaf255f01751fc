#include "grid_services.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace etendue::osl {
namespace {

/// A rotation about z, then a translation, for rows.
Matrix placed(float angle, const Triple& offset) {
  Matrix m = Matrix::identity();
  const float c = std::cos(angle), s = std::sin(angle);
  m.m[0][0] = c, m.m[0][1] = s, m.m[1][0] = -s, m.m[1][1] = c;
  for (int i = 0; i < 3; ++i) m.m[3][i] = offset[i];
  return m;
}

constexpr float field_of_view = 90, near_plane = 0.1f, far_plane = 1000;  // of the camera, which looks along z

/// From camera space to the picture's, whose depth goes from 0 at the near plane to 1 at the far one.
Matrix camera_to_screen() {
  Matrix m;
  const float depth = far_plane - near_plane;
  m.m[0][0] = m.m[1][1] = 1 / std::tan(field_of_view / 2 * std::numbers::pi_v<float> / 180);
  m.m[2][2] = far_plane / depth, m.m[2][3] = 1, m.m[3][2] = -far_plane * near_plane / depth;
  return m;
}

Matrix scaled(float x, float y, float offset_x, float offset_y) {
  Matrix m = Matrix::identity();
  m.m[0][0] = x, m.m[1][1] = y, m.m[3][0] = offset_x, m.m[3][1] = offset_y;
  return m;
}

/// One number of a value with `floats` components, all equal, and its derivatives.
void give(float value, float dx, float dy, bool derivatives, void* out) {
  auto* to = static_cast<float*>(out);
  to[0] = value;
  if (derivatives) to[1] = dx, to[2] = dy;
}

}  // namespace

Globals grid_point(const ShadeArguments& a, int x, int y) {
  Globals g;
  const auto place = [&](int i, int n, float scale, float offset) {
    const float t = a.centers ? (float(i) + 0.5f) / float(n) : (n == 1 ? 0.5f : float(i) / float(n - 1));
    return scale * t + offset;
  };
  const auto step = [&](int n, float scale) { return scale / float(a.centers ? n : std::max(1, n - 1)); };
  const float u = place(x, a.width, a.u_scale, a.u_offset), v = place(y, a.height, a.v_scale, a.v_offset);
  g.u = {u, step(a.width, a.u_scale), 0};
  g.v = {v, 0, step(a.height, a.v_scale)};
  if (a.vary_u) g.u.dx = 1 - u, g.u.dy = u;
  if (a.vary_v) g.v.dx = 1 - v, g.v.dy = v;
  g.P.value = {u, v, 1};
  if (a.vary_point) {
    g.P.dx = {1 - u, 1 - v, u * 0.5f};
    g.P.dy = {1 - v, 1 - u, v * 0.5f};
  } else {
    g.P.dx = {a.u_scale / float(std::max(1, a.width - 1)), 0, 0};
    g.P.dy = {0, a.v_scale / float(std::max(1, a.height - 1)), 0};
  }
  g.dPdu.value = {1, 0, 0};
  g.dPdv.value = {0, 1, 0};
  g.N.value = g.Ng.value = {0, 0, 1};
  g.surface_area = 1;
  return g;
}

GridServices::GridServices(const ShadeArguments& arguments)
    : arguments_(arguments), color_system_(ColorSystem::named(arguments.color_space.c_str())) {
  if (!color_system_) throw Error(fmt::format("there is no colour space '{}'", arguments.color_space));
  for (const auto& [name, value] : arguments.options)
    if (name == "error_repeats") repeats_errors_ = value != "0";
}

GridServices::~GridServices() {
  for (const auto& [name, file] : files_)
    if (file) std::fclose(file);
}

void GridServices::begin(const Globals& point, int index) {
  point_ = point;
  index_ = index;
  memory_.reset();
}

void* GridServices::allocate(std::size_t size, std::size_t alignment) { return memory_.allocate(size, alignment); }

bool GridServices::to_common(const String* space, Matrix& out) {
  const std::string_view name = space->view();
  const float width = float(arguments_.width), height = float(arguments_.height);
  Matrix to_space = Matrix::identity();
  if (name == "common" || name == "world" || name == "camera") return out = Matrix::identity(), true;
  if (name == "shader") return out = placed(std::numbers::pi_v<float> / 4, {1, 0, 0}), true;
  if (name == "object") return out = placed(std::numbers::pi_v<float> / 2, {0, 1, 0}), true;
  if (name == "myspace") return out = Matrix::identity(), out.m[0][0] = out.m[2][2] = 1, out.m[1][1] = 2, true;
  if (name == "screen")
    to_space = camera_to_screen();
  else if (name == "NDC")
    to_space = camera_to_screen() * scaled(0.5f, 0.5f, 0.5f, 0.5f);
  else if (name == "raster")
    to_space = camera_to_screen() * scaled(0.5f * width, 0.5f * height, 0.5f * width, 0.5f * height);
  else
    return false;
  return invert(to_space, out);
}

bool GridServices::ray_type(const String* name) const { return name->text() == arguments_.ray_type; }

// ---- attributes
// ------------------------------------------------------------------------------------------------------------------

bool GridServices::camera_attribute(std::string_view name, int index, const Type& type, void* out) const {
  const float width = float(arguments_.width), height = float(arguments_.height);
  const auto whole = [&](std::initializer_list<int> values) {
    if (type.base != Base::int_ || (index >= 0 ? type.is_array() : type.elements() != int(values.size()))) return false;
    auto* to = static_cast<int*>(out);
    if (index >= int(values.size())) return false;
    if (index >= 0) return *to = values.begin()[index], true;
    std::copy(values.begin(), values.end(), to);
    return true;
  };
  const auto real = [&](std::initializer_list<float> values) {
    if (type.base != Base::float_ || (index >= 0 ? type.is_array() : type.elements() != int(values.size()))) return false;
    auto* to = static_cast<float*>(out);
    if (index >= int(values.size())) return false;
    if (index >= 0) return *to = values.begin()[index], true;
    std::copy(values.begin(), values.end(), to);
    return true;
  };
  if (name == "camera:resolution") return whole({int(width), int(height)});
  if (name == "camera:pixelaspect") return real({1});
  if (name == "camera:screen_window") return real({-1, -1, 1, 1});
  if (name == "camera:fov") return real({field_of_view});
  if (name == "camera:clip") return real({near_plane, far_plane});
  if (name == "camera:clip_near") return real({near_plane});
  if (name == "camera:clip_far") return real({far_plane});
  if (name == "camera:shutter") return real({0, 1});
  if (name == "camera:shutter_open") return real({0});
  if (name == "camera:shutter_close") return real({1});
  if (name == "camera:projection" && type.is_string())
    return *static_cast<const String**>(out) = intern_string("perspective"), true;
  return false;
}

/// Data that a geometry would interpolate: s, t, face_idx; and red, green, blue, each on a part of the grid only.
bool GridServices::geometry_data(std::string_view name, const Type& type, bool derivatives, void* out) const {
  const Globals& g = point_;
  if (name == "face_idx" && type.is_int()) return *static_cast<int*>(out) = int(4 * g.u.value), true;
  if (!type.is_float()) return false;
  if (name == "s") return give(g.u.value, g.u.dx, g.u.dy, derivatives, out), true;
  if (name == "t") return give(g.v.value, g.v.dx, g.v.dy, derivatives, out), true;
  if (name == "red" && g.P.value.x > 0.5f) return give(g.u.value, g.u.dx, g.u.dy, derivatives, out), true;
  if (name == "green" && g.P.value.x < 0.5f) return give(g.v.value, g.v.dx, g.v.dy, derivatives, out), true;
  if (name == "blue" && int(g.P.value.y * 12) % 2 == 0) return give(1 - g.u.value, -g.u.dx, -g.u.dy, derivatives, out), true;
  return false;
}

bool GridServices::attribute(const String* object, const String* name, int index, const Type& type, bool derivatives,
                             void* out) {
  if (object && !object->view().empty()) return false;
  const std::string_view text = name->view();
  if (text == "shading:index" && type.is_int() && index < 0) return *static_cast<int*>(out) = index_, true;
  if (text == "options" && type.is_string()) return *static_cast<const String**>(out) = empty_string(), true;
  const bool found = camera_attribute(text, index, type, out);
  if (found && derivatives) std::memset(static_cast<std::byte*>(out) + type.size(), 0, 2 * type.size());
  return found || (index < 0 && geometry_data(text, type, derivatives, out));
}

// ---- texts
// -----------------------------------------------------------------------------------------------------------------------

void GridServices::print(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stdout); }

void GridServices::print_to(const String* file, std::string_view text) {
  const auto [entry, opened] = files_.try_emplace(file, nullptr);
  if (opened) {
    entry->second = std::fopen(file->text().c_str(), "ab");
    if (!entry->second) error(fmt::format("fprintf cannot write to '{}'", file->text()), {});
  }
  if (entry->second) std::fwrite(text.data(), 1, text.size(), entry->second);
}

/// Errors go to the standard error stream, in order with what is printed. Each is reported once.
void GridServices::report(const char* kind, std::string_view text, Location at) {
  const std::string line = fmt::format("{}: {}\n", kind, text);
  if (!repeats_errors_ && !reported_.insert(line).second) return;
  std::fflush(stdout);
  std::fwrite(line.data(), 1, line.size(), stderr);
  if (at.line > 0) fmt::print(stderr, "        place: {}:{}:{}\n", at.file, at.line, at.column);
  std::fflush(stderr);
}
void GridServices::warn(std::string_view text, Location at) { report("WARNING", text, at); }
void GridServices::error(std::string_view text, Location at) {
  report("ERROR", text, at);
  failed_ = true;
}

}  // namespace etendue::osl
