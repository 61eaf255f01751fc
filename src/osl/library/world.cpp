// Rows of the table: what depends on the renderer and the point that is shaded - rays, attributes, messages, displacement - and
// what is refused.

#include "choose.h"
#include "parts.h"
#include "services.h"

namespace etendue::osl {

namespace {

void ray_type(const Call& c) { c.give(int(c.services.ray_type(c.string(0)))); }
void backfacing(const Call& c) { c.give(int(c.services.backfacing())); }
void surface_area(const Call& c) { c.give(c.services.surface_area()); }

enum class Ray { camera, diffuse, glossy, shadow };
template <Ray ray>
void is_ray(const Call& c) {
  static const String* const names[] = {intern_string("camera"), intern_string("diffuse"), intern_string("glossy"),
                                        intern_string("shadow")};
  c.give(int(c.services.ray_type(names[int(ray)])));
}

/// int getattribute([string object,] string name, [int index,] output value)
template <bool object, bool index>
void get_attribute(const Call& c) {
  constexpr int name = object ? 1 : 0;
  const int value = c.count() - 1;
  c.give(int(c.services.attribute(object && !c.string(0)->view().empty() ? c.string(0) : nullptr, c.string(name),
                                  index ? c.at<int>(name + 1) : -1, c.type(value), c.derivatives(value), c.arguments[value])));
}

void set_message(const Call& c) {
  c.services.set_message(c.string(0), c.type(1), c.derivatives(1), c.arguments[1], c.types.place);
}

/// int getmessage([string source,] string name, output value)
void get_message(const Call& c) {
  const int value = c.count() - 1;
  c.give(int(c.services.get_message(value > 1 ? c.string(0) : nullptr, c.string(value - 1), c.type(value), c.derivatives(value),
                                    c.arguments[value], c.types.place)));
}

/// displace and bump by a vector, or along the normal by a number in a space.
template <bool bump>
void displace_by_vector(const Call& c) {
  c.services.displace(c.get<Dual<Triple>>(0), bump);
}
template <bool bump>
void displace_by_number(const Call& c) {
  const bool space = c.count() > 1;
  c.services.displace_along_normal(c.get<Dual<float>>(space ? 1 : 0), space ? c.string(0) : nullptr, bump);
}

void array_length(const Call& c) { c.give(c.type(0).array); }

constexpr Derivatives none = Derivatives::none, taken = Derivatives::taken;

constexpr const char* no_points = "point clouds are not supported: Étendue has no point cloud files";
constexpr Row rows[] = {
    {"int raytype(string name)", always<ray_type>, none, 0, nullptr, false},
    {"int backfacing()", always<backfacing>, none, 0, nullptr, false},
    {"float surfacearea()", always<surface_area>, none, 0, nullptr, false},
    {"int iscameraray()", always<is_ray<Ray::camera>>, none, 0, nullptr, false},
    {"int isdiffuseray()", always<is_ray<Ray::diffuse>>, none, 0, nullptr, false},
    {"int isglossyray()", always<is_ray<Ray::glossy>>, none, 0, nullptr, false},
    {"int isshadowray()", always<is_ray<Ray::shadow>>, none, 0, nullptr, false},
    {"int getattribute(string object, string name, int index, output ANY value)", always<get_attribute<true, true>>, none, 0,
     nullptr, false},
    {"int getattribute(string name, int index, output ANY value)", always<get_attribute<false, true>>, none, 0, nullptr, false},
    {"int getattribute(string object, string name, output ANY value)", always<get_attribute<true, false>>, none, 0, nullptr,
     false},
    {"int getattribute(string name, output ANY value)", always<get_attribute<false, false>>, none, 0, nullptr, false},
    {"void setmessage(string name, ANY value)", always<set_message>, none, 0, nullptr, false},
    {"int getmessage(string source, string name, output ANY value)", always<get_message>, none, 0, nullptr, false},
    {"int getmessage(string name, output ANY value)", always<get_message>, none, 0, nullptr, false},
    {"void displace(float amount)", always<displace_by_number<false>>, taken, 0, nullptr, false},
    {"void displace(string space, float amount)", always<displace_by_number<false>>, taken, 0, nullptr, false},
    {"void displace(vector offset)", always<displace_by_vector<false>>, taken, 0, nullptr, false},
    {"void bump(float amount)", always<displace_by_number<true>>, taken, 0, nullptr, false},
    {"void bump(string space, float amount)", always<displace_by_number<true>>, taken, 0, nullptr, false},
    {"void bump(vector offset)", always<displace_by_vector<true>>, taken, 0, nullptr, false},
    {"int arraylength(ANY array)", always<array_length>, none},
    // Part of the language.
    {"int isconnected(ANY parameter)", nullptr, none, 0, nullptr, false},
    {"int isconstant(ANY expression)", nullptr, none, 0, nullptr, false},
    {"void exit()", nullptr, none, 0, nullptr, false},
    // Refused.
    {"int trace(point origin, vector direction, ...)", nullptr, none, 0,
     "rays are traced by the renderer's algorithm, never by a shader: use a closure", false},
    {"int pointcloud_search(string file, point at, float radius, int most, output ...)", nullptr, none, 0, no_points, false},
    {"int pointcloud_get(string file, int indices[], int count, string attribute, output ...)", nullptr, none, 0, no_points,
     false},
    {"int pointcloud_write(string file, point at, ...)", nullptr, none, 0, no_points, false},
    {"float wireframe(...)", nullptr, none, 0, "the vertices of the polygon around a point are not known to shaders", false},
    {"float draw_string(string text, float s, float t, int wrap_s, int wrap_t, int jitter)", nullptr, none, 0,
     "there is no font for it here: use a texture with the text", false},
};

}  // namespace

std::span<const Row> world_rows() { return rows; }

}  // namespace etendue::osl
