#pragma once
// One pbrt file on its way into components: the graphics state, and what was named.

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/importers/measured_media.h"
#include "etendue/emission_shader.h"
#include "etendue/importer.h"
#include "etendue/object_map.h"
#include "etendue/render/job.h"
#include "etendue/scene.h"
#include "etendue/scene_object.h"
#include "etendue/shader.h"
#include "etendue/volume_shader.h"
#include "parameters.h"

namespace etendue::pbrt {

/// What AreaLightSource says of the shapes that follow.
struct AreaLight {
  Parameters parameters;
  std::string type;
  /// Made when a shape first needs it: for shapes whose front is pbrt's, for those that are turned over, with `power`.
  std::array<Ref<Component>, 2> made;
};

/// What AttributeBegin keeps and AttributeEnd gives back.
struct State {
  std::array<Transform, 2> ctm;  ///< to the world, at the two times of TransformTimes
  unsigned active = 3;           ///< which of the two a transform changes
  bool reversed = false;
  size_t material = 0;               ///< of Reader::materials
  std::string named_material;        ///< looked up at the end, when not empty
  std::shared_ptr<AreaLight> light;  ///< null: shapes do not emit
  std::string inside, outside;       ///< names of media; empty: none
  const RgbSpace* space = nullptr;
  /// Of v4's Attribute directive, in the order of `attribute_targets`.
  std::array<std::shared_ptr<const std::vector<Parameter>>, 5> defaults;
};
inline constexpr std::array<std::string_view, 5> attribute_targets = {"shape", "light", "material", "medium", "texture"};

/// A material as it was written; its shader is made when something first needs it, as in v4 it may name textures and
/// materials that come later.
struct Material {
  std::string type, name;
  Parameters parameters;
  std::array<Ref<Component>, 2> shaders;  ///< for shapes whose front is pbrt's, and for those of which it is the back
  bool making = false;
};

/// An object that waits for its shader until everything was read.
struct Waiting {
  Ref<Component> object;
  size_t material;
  std::string named_material;
  Value alpha;  ///< opacity: a map or a number; none: opaque
  bool turned;  ///< its front is the back of pbrt's
  bool no_uvs;  ///< it is a mesh without surface coordinates, of which pbrt has others than are here
  Location at;
};

/// The media on the two sides of an object's surface.
struct MediumSides {
  Ref<Component> object;
  std::string inside, outside;  ///< names; empty: none
  bool in_group;                ///< it stands in an object that is instanced
  Location at;
};

/// What version 3 warns of and goes on without, where version 4 stops: a note or an Error, which Directives decides.
class LeftOut : public Error {
 public:
  LeftOut(const std::string& what, Location at, std::string instead = "it is left out")
      : Error(what, at), instead_(std::move(instead)) {}
  const std::string& instead() const { return instead_; }

 private:
  std::string instead_;
};

enum class Use : unsigned char { reflectance, light, coefficient };

/// What is before WorldBegin: each directive as it was written last.
struct Setting {
  std::string type;
  Parameters parameters;
  bool given = false;
};

class Reader {
 public:
  /// `version` is 3 or 4.
  Reader(Importing& i, int v) : importing(i), version(v) {}

  Importing& importing;
  const int version;
  State state;
  Setting camera, film, filter, sampler, integrator;
  AnimatedTransform camera_to_world;
  std::string around_camera;  ///< the name of a medium; empty: none
  Location around_camera_at;
  std::array<double, 2> times{0, 1};  ///< of TransformTimes [s]
  std::optional<int> seed;
  double exposure = 1;  ///< what the sensor multiplies radiances by, put into all lights
  std::vector<Material> materials{1};
  std::map<std::string, size_t, std::less<>> named_materials;
  std::map<std::string, Ref<Component>, std::less<>> float_textures, spectrum_textures, media;
  /// What textures and mixtures are made of nests no deeper: it is built, and taken down, from one to the next.
  static constexpr int most_nested = 100;
  std::map<const Component*, int> texture_depths;       ///< 1: it names no other
  int named_depth = 0;                                  ///< of the deepest texture that was looked up for the one being made
  int mixing = 0;                                       ///< materials being made, each for the one before
  bool turned = false;                                  ///< whether they are for a shape whose front is the back of pbrt's
  std::map<std::string, Transform, std::less<>> grids;  ///< of media in space: from their coordinates to the world
  std::map<std::string, Transform, std::less<>> boxes;  ///< of those that lie in a known box: from the unit cube to the world

  AnimatedTransform to_world() const { return to_world(Transform()); }
  /// Of what stands at `inner` in the present coordinates.
  AnimatedTransform to_world(const Transform& inner) const;
  /// Where a light stands: pbrt's do not move, which is told.
  Transform of_light(const Transform& inner, Location at);
  Ref<Component> make(const char* class_name, Location at, const std::string& name = {}) const {
    return importing.make(class_name, at, name);
  }

  /// What version 3 warns of, and what it does then; of version 4 an Error.
  void tolerate(const std::string& what, const std::string& instead, Location at) {
    if (version != 3) throw Error(what, at);
    importing.inexact(what + ": " + instead + ", as by version 3 of pbrt", at);
  }

  // world.cpp
  void shape(const std::string& type, Parameters&&);
  void begin_object(const std::string& name, Location at);
  void end_object(Location at);
  void instance(const std::string& name, Location at);
  bool in_object() const { return into_ != &objects_; }
  void add(const Ref<Component>& object);
  /// Lights stand in the world, also where an object is defined.
  void add_light(const Ref<Component>& object);
  /// All that was read, with its shaders.
  Ref<Job> finish();

 private:
  Ref<Component> shader_for(const Waiting&);
  /// The present material with what a shape says of it, too.
  size_t material_for(const Parameters& shape);
  void add_shape(const std::string& type, Parameters&&);
  void finish_materials();
  /// surroundings.cpp: what has to be added for the medium around the camera; null: nothing.
  Ref<SceneObject> settle_media();
  Ref<Scene> scene_of(const std::vector<Ref<SceneObject>>&, Location at, const std::string& name);

  std::vector<Ref<SceneObject>> objects_;
  std::vector<Ref<SceneObject>>* into_ = &objects_;
  std::vector<Ref<SceneObject>> object_parts_;
  std::string object_name_;
  Location object_at_;
  std::map<std::string, Ref<Scene>, std::less<>> instanced_;
  std::vector<Waiting> waiting_;
  std::vector<MediumSides> sides_;
  std::map<std::pair<Component*, std::string>, Ref<Component>> masked_;
  std::map<std::string, size_t> changed_materials_;  // by what shapes say of those that they have
};

/// Reads all directives of a file and of those it includes. Throws Errors with all that is wrong.
void read_directives(Reader&, std::string_view text);

// spectra.cpp
/// The spectrum of a parameter. Of light it is what pbrt multiplies by "scale": v4 makes all but "rgb" give a luminance of 1.
Color spectrum_of(Reader&, const Parameters&, const Parameter&, Use);
/// A complex index of refraction of the parameters `eta` and `k` (or of v4's "reflectance"); none: copper.
Color metal_of(Reader&, const Parameters&, const std::string& prefix = {});
/// A real index of refraction by the first of the names that is given.
Value index_of(Reader&, const Parameters&, std::initializer_list<std::string_view> names, double otherwise);
/// The named spectra of pbrt that are no metals: glasses and illuminants. Null: there is none of this name.
Color named_spectrum(const std::string& name);

// textures.cpp
void make_texture(Reader&, const std::string& name, const std::string& kind, const std::string& type, Parameters&&);
/// A number or a map of numbers.
Value number_map(Reader&, const Parameters&, std::initializer_list<std::string_view> names, double otherwise);
/// A spectrum, or a map of spectra.
Value color_map(Reader&, const Parameters&, std::initializer_list<std::string_view> names, double otherwise, Use);
/// A formula over maps.
Ref<Component> formula(Reader&, Location at, const std::string& text, const std::vector<std::pair<std::string, Value>>& maps);
void set_map(Component&, std::string_view member, Value, Location at);
/// The image file of a parameter, as a member expects it; none and a note: it is missing.
std::optional<FilePath> image_file(Reader&, const Parameters&, std::string_view name);

// image_textures.cpp
/// The texture "imagemap", as it lies on the unit square.
Ref<Component> image_texture(Reader&, const Parameters&, bool spectrum);
/// Whether an image has other colours than greys; one that cannot be read is told elsewhere.
bool colored(const FilePath&);

// materials.cpp, materials_v4.cpp, materials_v3.cpp
Ref<Component> shader_of(Reader&, size_t material, Location used_at);
/// v3's textures may have other ones of their names later.
void make_with_present_textures(Reader&, size_t material);
/// Whether it matters which side of a shape that follows is its front.
bool front_matters(const Reader&);
/// Whether a material is another one when its front is its back.
bool has_front(const Reader&, const Material&);
/// A dielectric's index against the other side.
void set_index(const Reader&, Component& dielectric, const Value& eta, Location at);
Ref<Component> shader_named(Reader&, const std::string& name, Location used_at);
/// Null: it is none of v4's, or none of v3's materials.
Ref<Component> make_v4_shader(Reader&, const Material&);
Ref<Component> make_v3_shader(Reader&, const Material&);
/// Which parameters say how rough a surface is along u and along v, the first that is given, and what it is where none is.
struct Roughness {
  std::vector<std::string> u, v;
  double otherwise;
  bool glass = false;  ///< v3's is smooth at 0
};
/// Sets the roughness of a microfacet shader by GGX's alpha from pbrt's parameters.
void set_roughness(Reader&, Component& shader, const Parameters&, const Roughness&);
/// What stands for a colour where a number is needed; it is told when the colour is no grey.
double brightness_of(Reader&, const SpectralFunction&, const std::string& what, Location at);
double v3_alpha(double roughness);
std::vector<std::string> material_names();

// shapes.cpp, meshes.cpp, revolved.cpp
struct Shape {
  Ref<Component> object;
  Transform inner;      ///< from the object's coordinates to the shape's
  bool turned = false;  ///< its front is the back of pbrt's
  size_t pieces = 1;    ///< how many lights pbrt makes of it
};
/// No object: it could not be made, which was noted.
Shape make_shape(Reader&, const std::string& type, Parameters&);
Shape make_mesh(Reader&, const std::string& type, Parameters&);
Shape make_revolved(Reader&, const std::string& type, const Parameters&);

// lights.cpp, environment.cpp
void make_light(Reader&, const std::string& type, Parameters&&);
void make_environment(Reader&, const Parameters&);
/// The light of a parameter, and what it is multiplied by: "scale", and what the sensor makes of it.
struct Light {
  Color color;
  double scale;
};
Light light_of(Reader&, const Parameters&, const char* name, Use);
Ref<Component> area_emission(Reader&, AreaLight&, bool turned, size_t pieces);
/// The pixel that pbrt makes of a radiance of 1 at all wavelengths, which is 1 here: the integral of the observer's y over
/// wavelengths [nm]. pbrt divides the spectra of its lights by it, but not the light of media.
inline constexpr double pixel_of_one = 106.856917;
/// What pbrt calls a power or an illuminance of 1, where a luminance of 1 is a pixel of 1 [lm, lx].
inline constexpr double luminous_unit = 683.002 * pixel_of_one;
void set_emission(Component& object, const Ref<Component>& emission, Location at);

// media.cpp
void make_medium(Reader&, const std::string& name, Parameters&&);
/// The one that a parameter names; null: it names none, or (told) one that is not known.
const MeasuredMedium* measured_medium(Reader&, const Parameters&, const char* parameter);
/// The medium of a name for an object that stands in the world so; null: it was left out.
Ref<Component> medium_for(Reader&, const std::string& name, const AnimatedTransform& object, Location at);

// integrators.cpp
struct Integrator {
  Ref<Component> renderer;
  int samples;
};
/// `samples`: those that the sampler says, for each pixel.
Integrator make_integrator(Reader&, int samples);
/// Whether pbrt's integrator finds its way through media; with others there are none.
bool knows_media(const Reader&);

// job.cpp, camera.cpp, view.cpp
void set_renderer(Reader&, Component& job);
void set_camera(Reader&, Component& job);
void set_film(Reader&, Component& job);
/// Of the whole picture, in pixels.
struct FilmSize {
  int width, height;
};
FilmSize film_size(const Reader&);
/// What the sensor multiplies light by.
double imaging_ratio(Reader&);

}  // namespace etendue::pbrt
