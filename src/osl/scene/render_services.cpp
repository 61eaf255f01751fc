#include "render_services.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <mutex>
#include <shared_mutex>
#include <sstream>
#include <unordered_map>

#include "components/maps/footprint.h"
#include "etendue/mesh_facts.h"
#include "osl/closures/closure_models.h"
#include "osl/textures/texture_files.h"
#include "parameter_values.h"

namespace etendue::osl {

namespace {

Triple triple(const Vector3& v) { return {v.x, v.y, v.z}; }
Triple triple(const Normal3& v) { return {v.x, v.y, v.z}; }

/// A shader may print or warn at each point of a picture: only so many texts of a process are printed.
bool may_speak() {
  static std::atomic<int> left = 200;
  const int before = left.fetch_sub(1);
  if (before == 0) etendue::warn("shaders print more than is shown: the rest is left out");
  return before > 0;
}

/// Something that is looked up by a string's address and made once.
template <class T>
class Cache {
 public:
  template <class F>
  T get(const String* key, const F& make) {
    {
      const std::shared_lock lock(mutex_);
      if (const auto found = made_.find(key); found != made_.end()) return found->second;
    }
    const T made = make();
    const std::unique_lock lock(mutex_);
    return made_.try_emplace(key, made).first->second;
  }

 private:
  std::shared_mutex mutex_;
  std::unordered_map<const String*, T> made_;
};

/// The image files of all shaders of the process; never destroyed: used until the program ends.
TextureFiles& texture_files() {
  static auto* files = new TextureFiles;
  return *files;
}

Color spectrum_named(const std::string& text) {
  std::istringstream words(text);
  std::string kind, name, part;
  words >> kind;
  std::getline(words >> std::ws, name);
  if (kind == "metal") {
    const bool imaginary = name.ends_with(" k");
    if (imaginary || name.ends_with(" n")) name.resize(name.size() - 2);
    const Color index = metal_index(name);
    return imaginary ? index->imaginary() : index;
  }
  if (kind == "glass") return glass_index(name);
  if (kind == "illuminant") return illuminant_spectrum(name);
  return file_spectrum({text, {}});
}

const RgbSpace& shading_space() {
  static const RgbSpace& space = rgb_space("srgb");
  return space;
}

}  // namespace

void NeededGlobals::add(const osl::Shader& shader) {
  const auto names = [&](Global g) { return shader.globals[std::size_t(g)] != nullptr; };
  const bool moves = calls(shader, "void displace") || calls(shader, "void bump");
  position |= names(Global::P) || moves;
  coordinates |= names(Global::u) || names(Global::v);
  tangents |= names(Global::dPdu) || names(Global::dPdv);
  area |= calls(shader, "float surfacearea");
}

bool set_globals(SurfacePoint p, NeededGlobals needed, Globals& g) {
  g = Globals();
  if (needed.tangents || (needed.coordinates && p.footprint > 0)) with_tangents(p);
  Vector3 i = p.ray_direction;
  if (i == Vector3{}) i = -Vector3(p.normal);
  const bool from_behind = dot(i, p.normal) > 0;
  const float side = from_behind ? -1.0f : 1.0f;
  if (needed.position) {
    const DoublePoint3 world = world_position(p);
    g.P = Dual<Triple>(Triple(float(world.x), float(world.y), float(world.z)));
    if (p.footprint > 0) {
      const Footprint f = footprint_of(p);
      g.P.dx = triple(f.longer);
      g.P.dy = triple(f.shorter);
    }
  }
  if (needed.coordinates) {
    g.u = Dual<float>(p.uv.x);
    g.v = Dual<float>(p.uv.y);
    if (p.footprint > 0) {
      const UvFootprint uv = uv_footprint(p);
      g.u.dx = uv.longer.x, g.u.dy = uv.shorter.x;
      g.v.dx = uv.longer.y, g.v.dy = uv.shorter.y;
    }
  }
  g.I = Dual<Triple>(triple(i));
  g.N = Dual<Triple>(side * triple(p.shading_normal));
  g.Ng = Dual<Triple>(side * triple(p.normal));
  g.dPdu = Dual<Triple>(triple(p.dpdu));
  g.dPdv = Dual<Triple>(triple(p.dpdv));
  g.time = Dual<float>(p.time);
  g.backfacing = from_behind;
  g.flipped_handedness = false;
  if (needed.area && p.object && p.object->extent() == Extent::bounded) g.surface_area = p.object->area(p.time);
  return from_behind;
}

bool RenderServices::to_common(const String* space, Matrix& out) {
  const std::string_view name = space->view();
  if (name == "world") {
    out = Matrix::identity();
    return true;
  }
  if (name != "object" && name != "shader") return false;
  // From object space to rendering space, whose origin lies at rendering_origin in world space.
  Transform scratch;
  const Transform& t = placement(point_, scratch);
  const DoublePoint3 origin = point_.object ? point_.object->rendering_origin() : DoublePoint3{};
  const double shift[3] = {origin.x, origin.y, origin.z};
  out = Matrix::identity();
  for (size_t r = 0; r < 3; ++r)
    for (size_t k = 0; k < 4; ++k) out.m[k][r] = float(t.exact()[4 * r + k] + (k == 3 ? shift[r] : 0));
  // The translation follows from the point itself, as object space may have an origin of its own.
  const DoublePoint3 world = world_position(point_);
  const double at[3] = {world.x, world.y, world.z};
  for (size_t r = 0; r < 3; ++r) {
    double turned = 0;
    const double o[3] = {double(point_.object_position.x), double(point_.object_position.y), double(point_.object_position.z)};
    for (size_t k = 0; k < 3; ++k) turned += t.exact()[4 * r + k] * o[k];
    out.m[3][r] = float(at[r] - turned);
  }
  return true;
}

// By the inverse that the transform has, which takes less time than to invert the matrix of to_common. The translation follows
// from the point, as there.
bool RenderServices::from_common(const String* space, Matrix& out) {
  const std::string_view name = space->view();
  if (name != "object" && name != "shader") return Services::from_common(space, out);
  Transform scratch;
  const Transform& t = placement(point_, scratch);
  const DoublePoint3 world = world_position(point_);
  const Vector3 axes[3] = {t.back(Vector3{1, 0, 0}), t.back(Vector3{0, 1, 0}), t.back(Vector3{0, 0, 1})};
  const double at[3] = {world.x, world.y, world.z};
  double turned[3] = {};
  out = Matrix::identity();
  for (size_t k = 0; k < 3; ++k) {
    const float row[3] = {axes[k].x, axes[k].y, axes[k].z};
    for (size_t r = 0; r < 3; ++r) {
      out.m[k][r] = row[r];
      turned[r] += double(row[r]) * at[k];
    }
  }
  const Point3& o = point_.object_position;
  const float own[3] = {o.x, o.y, o.z};
  for (size_t r = 0; r < 3; ++r) out.m[3][r] = float(double(own[r]) - turned[r]);
  return true;
}

bool RenderServices::attribute(const String* object, const String* name, int index, const Type& type, bool derivatives,
                               void* out) {
  if (object && !object->view().empty()) return false;
  if (const ObjectMap* map = maps_.find(name)) {
    const auto give_dual = [&](const auto& v) {
      std::memcpy(out, &v, derivatives ? sizeof v : sizeof v.value);
      return true;
    };
    if (type.is_float()) return give_dual(number_of(*map, point_, derivatives));
    return type.is_triple() && give_dual(color_of(*map, point_, derivatives));
  }
  const auto give = [&](const auto& v) {
    std::memcpy(out, &v, sizeof v);
    if (derivatives) std::memset(static_cast<std::byte*>(out) + type.size(), 0, 2 * type.size());
    return true;
  };
  if (type.is_string()) {
    if (name->view() != "object:name" && name->view() != "geom:name") return false;
    return give(intern_string(point_.object && point_.object->origin ? point_.object->origin->name : std::string()));
  }
  const int wanted = type.is_array() ? type.array : type.is_triple() ? 3 : 1;
  const bool numbers_of_mesh =
      type.is_float() || type.is_triple() || (type.base == Base::float_ && (wanted == 2 || wanted == 4));
  if (index >= 0 || !numbers_of_mesh || type.closure) return false;
  const MeshFacts* facts = point_.object ? point_.object->mesh_facts() : nullptr;
  if (facts) {
    static auto* numbers = new Cache<int>;
    const int number = numbers->get(name, [&] {
      const std::string_view text = name->view();
      if (text == "displayColor") return attribute_number("color");  // as USD calls it
      return attribute_number(std::string(text.starts_with("geom:") ? text.substr(5) : text));
    });
    float values[4] = {};
    const int count = facts->attribute(number, point_, values);
    if (count == 1 && wanted == 1) return give(values[0]);
    if (count >= 3 && wanted == 3) return give(Triple(values[0], values[1], values[2]));
    if (count >= wanted && wanted == 2) return give(std::array{values[0], values[1]});
    if (count >= wanted && wanted == 4) return give(std::array{values[0], values[1], values[2], values[3]});
  }
  // The names that other programs give to the first surface coordinates.
  static constexpr std::array<std::string_view, 6> first = {"st", "uv", "UV0", "UVMap", "map1", "texcoord"};
  if (wanted != 2 || std::ranges::find(first, name->view()) == first.end()) return false;
  give(std::array{point_.uv.x, point_.uv.y});
  if (derivatives && point_.footprint > 0) {
    const UvFootprint f = uv_footprint(point_);
    const std::array by{f.longer.x, f.longer.y, f.shorter.x, f.shorter.y};
    std::memcpy(static_cast<std::byte*>(out) + type.size(), by.data(), sizeof by);
  }
  return true;
}

std::string_view RenderServices::texture(const String* file, const Dual<float>& s, const Dual<float>& t,
                                         const TextureOptions& options, TextureLookup& lookup) {
  return texture_files().texture({file, options.shader_file, scene_file_}, s, t, options, lookup);
}

std::string_view RenderServices::environment(const String* file, const Dual<Triple>& direction, const TextureOptions& options,
                                             TextureLookup& lookup) {
  return texture_files().environment({file, options.shader_file, scene_file_}, direction, options, lookup);
}

bool RenderServices::texture_info(const String* file, const float* at, const String* name, const Type& type, void* out,
                                  const char* shader_file) {
  return texture_files().texture_info({file, shader_file, scene_file_}, at, name, type, out);
}

void RenderServices::print(std::string_view text) {
  if (may_speak()) fmt::print(stderr, "{}", text);
}
void RenderServices::warn(std::string_view text, Location at) {
  if (may_speak()) etendue::warn(fmt::format("{}: {}", class_name_, text), at);
}
void RenderServices::error(std::string_view text, Location at) {
  if (may_speak()) etendue::warn(fmt::format("{}: error in the shader: {}", class_name_, text), at);
}

bool RenderServices::transform_color(const String* from, const String* to, const Triple& c, Triple& out) {
  try {
    out = converted(c, rgb_space(from->text()), rgb_space(to->text()));
    return true;
  } catch (const Error&) {
    return false;
  }
}

const Wavelengths& RenderServices::wavelengths() const { return wavelengths_ ? *wavelengths_ : Services::wavelengths(); }

bool RenderServices::named_spectrum(const String* words, Spectrum& out) {
  static auto* cache = new Cache<Color>;
  const Color c = cache->get(words, [&]() -> Color {
    try {
      return spectrum_named(words->text());
    } catch (const Error& e) {
      etendue::warn(fmt::format("{}: spectrum(\"{}\"): {}", class_name_, words->view(), e.what()));
      return nullptr;
    }
  });
  if (!c) return false;
  out = c->evaluate(wavelengths(), ColorUse::coefficient);
  return true;
}

Spectrum RenderServices::color_spectrum(const Triple& c, bool light) {
  return rgb_spectrum(shading_space(), c.x, c.y, c.z, light ? ColorUse::radiance : ColorUse::reflectance, wavelengths());
}

}  // namespace etendue::osl
