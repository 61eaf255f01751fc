#pragma once
// The state while a pbrt file is read: graphics state, named objects, and the components made so far.

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

/// The emission that AreaLightSource states for the shapes that follow.
struct AreaLight {
  Parameters parameters;
  std::string type;
  /// Created when first needed: [0] for shapes with pbrt's front, [1] for reversed ones. With "power" each shape gets its own.
  std::array<Ref<Component>, 2> made;
};

/// The state that AttributeBegin saves and AttributeEnd restores.
struct State {
  std::array<Transform, 2> ctm;  ///< to world space, at the two times of TransformTimes
  unsigned active = 3;           ///< bit mask of the times that a transform changes
  bool reversed = false;
  size_t material = 0;               ///< index into Reader::materials
  std::string named_material;        ///< resolved at the end if not empty
  std::shared_ptr<AreaLight> light;  ///< null: shapes do not emit
  std::string inside, outside;       ///< names of media; empty: none
  const RgbSpace* space = nullptr;
  /// Parameters from v4's Attribute directive, in the order of `attribute_targets`.
  std::array<std::shared_ptr<const std::vector<Parameter>>, 5> defaults;
};
inline constexpr std::array<std::string_view, 5> attribute_targets = {"shape", "light", "material", "medium", "texture"};

/// A material as written. Its shader is created when first needed, because in v4 it may refer to textures and materials that
/// are defined later.
struct Material {
  std::string type, name;
  Parameters parameters;
  std::array<Ref<Component>, 2> shaders;  ///< [0] for shapes with pbrt's front, [1] for reversed ones
  bool making = false;
};

/// An object whose shader is set after the whole file is read.
struct Waiting {
  Ref<Component> object;
  size_t material;
  std::string named_material;
  Value alpha;  ///< opacity: a map or a number; none: opaque
  bool turned;  ///< its front is pbrt's back
  bool no_uvs;  ///< a mesh without texture coordinates, for which pbrt's defaults differ from ours
  Location at;
};

/// The media on the two sides of an object's surface.
struct MediumSides {
  Ref<Component> object;
  std::string inside, outside;  ///< names; empty: none
  bool in_group;                ///< part of an object that is instanced
  Location at;
};

/// An error that version 3 only warns of before it continues, where version 4 stops; Directives turns it into a warning or an
/// Error.
class LeftOut : public Error {
 public:
  LeftOut(const std::string& what, Location at, std::string instead = "it is left out")
      : Error(what, at), instead_(std::move(instead)) {}
  const std::string& instead() const { return instead_; }

 private:
  std::string instead_;
};

enum class Use : unsigned char { reflectance, light, coefficient };

/// A directive before WorldBegin; the last one of its kind counts.
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
  std::string around_camera;  ///< name of a medium; empty: none
  Location around_camera_at;
  std::array<double, 2> times{0, 1};  ///< of TransformTimes [s]
  std::optional<int> seed;
  double exposure = 1;  ///< the sensor's imaging ratio, which multiplies all lights
  std::vector<Material> materials{1};
  std::map<std::string, size_t, std::less<>> named_materials;
  std::map<std::string, Ref<Component>, std::less<>> float_textures, spectrum_textures, media;
  /// Limit for the nesting of textures and mixtures, which are created and destroyed recursively.
  static constexpr int most_nested = 100;
  std::map<const Component*, int> texture_depths;       ///< 1: refers to no other texture
  int named_depth = 0;                                  ///< depth of the deepest texture looked up for the texture being made
  int mixing = 0;                                       ///< number of nested materials being made
  bool turned = false;                                  ///< whether these are for a shape whose front is pbrt's back
  std::map<std::string, Transform, std::less<>> grids;  ///< of heterogeneous media: from their space to world space
  std::map<std::string, Transform, std::less<>> boxes;  ///< of media with a known box: from the unit cube to world space

  AnimatedTransform to_world() const { return to_world(Transform()); }
  /// The current transform applied after `inner`.
  AnimatedTransform to_world(const Transform& inner) const;
  /// The transform of a light: pbrt's lights do not move; warns if it is animated.
  Transform of_light(const Transform& inner, Location at);
  Ref<Component> make(const char* class_name, Location at, const std::string& name = {}) const {
    return importing.make(class_name, at, name);
  }

  /// In version 3 warns of `what` and its consequence `instead`; in version 4 throws Error.
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
  /// Lights are added to the world, even inside an object definition.
  void add_light(const Ref<Component>& object);
  /// Everything that was read, with shaders assigned.
  Ref<Job> finish();

 private:
  Ref<Component> shader_for(const Waiting&);
  /// The current material with the parameters that a shape overrides.
  size_t material_for(const Parameters& shape);
  void add_shape(const std::string& type, Parameters&&);
  void finish_materials();
  /// The object to be added for the medium around the camera; null: nothing (surroundings.cpp).
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
  std::map<std::string, size_t> changed_materials_;  // by the parameters that shapes override
};

/// Reads all directives of a file and the files it includes. Throws Errors with all mistakes.
void read_directives(Reader&, std::string_view text);

// spectra.cpp
/// The spectrum of a parameter. For light, the spectrum that pbrt multiplies by "scale": v4 normalizes all but "rgb" to a
/// luminance of 1.
Color spectrum_of(Reader&, const Parameters&, const Parameter&, Use);
/// The complex index of refraction from `eta` and `k` (or v4's "reflectance"); copper if none is given.
Color metal_of(Reader&, const Parameters&, const std::string& prefix = {});
/// The real index of refraction from the first of the names that is given.
Value index_of(Reader&, const Parameters&, std::initializer_list<std::string_view> names, double otherwise);
/// pbrt's named spectra other than metals: glasses and illuminants. Null: there is none of this name.
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
/// The image file of a parameter, as a member expects it; nothing, with a warning, if it is missing.
std::optional<FilePath> image_file(Reader&, const Parameters&, std::string_view name);

// noise_textures.cpp
/// The textures "fbm", "windy", "wrinkled" and "marble".
Ref<Component> noise_texture(Reader&, const std::string& type, const Parameters&);

// image_textures.cpp
/// The texture "imagemap", on the unit square of (u, v).
Ref<Component> image_texture(Reader&, const Parameters&, bool spectrum);
/// Whether an image contains colours other than greys; unreadable images are reported elsewhere.
bool colored(const FilePath&);

// materials.cpp, materials_v4.cpp, materials_v3.cpp
Ref<Component> shader_of(Reader&, size_t material, Location used_at);
/// Creates the shader now because in v3 textures of these names may be redefined later.
void make_with_present_textures(Reader&, size_t material);
/// Whether the orientation of the shapes that follow makes a difference.
bool front_matters(const Reader&);
/// Whether a material differs between front and back.
bool has_front(const Reader&, const Material&);
/// Sets a dielectric's index relative to the other side.
void set_index(const Reader&, Component& dielectric, const Value& eta, Location at);
Ref<Component> shader_named(Reader&, const std::string& name, Location used_at);
/// Null: v4, or v3, has no such material.
Ref<Component> make_v4_shader(Reader&, const Material&);
Ref<Component> make_v3_shader(Reader&, const Material&);
/// Names of the parameters for the roughness along u and v, of which the first given counts, and the default.
struct Roughness {
  std::vector<std::string> u, v;
  double otherwise;
  bool glass = false;  ///< v3's material is smooth at roughness 0
};
/// Sets the roughness of a microfacet shader, GGX's alpha, from pbrt's parameters.
void set_roughness(Reader&, Component& shader, const Parameters&, const Roughness&);
/// The luminance that replaces a colour where a number is needed; warns if the colour is not grey.
double brightness_of(Reader&, const SpectralFunction&, const std::string& what, Location at);
double v3_alpha(double roughness);
std::vector<std::string> material_names();

// shapes.cpp, meshes.cpp, revolved.cpp
struct Shape {
  Ref<Component> object;
  Transform inner;      ///< from object space to that of the shape
  bool turned = false;  ///< its front is pbrt's back
  size_t pieces = 1;    ///< the number of lights that pbrt makes of it
};
/// No object: it could not be made, and a warning was added.
Shape make_shape(Reader&, const std::string& type, Parameters&);
Shape make_mesh(Reader&, const std::string& type, Parameters&);
Shape make_revolved(Reader&, const std::string& type, const Parameters&);

// lights.cpp, environment.cpp
void make_light(Reader&, const std::string& type, Parameters&&);
void make_environment(Reader&, const Parameters&);
/// The light of a parameter, and its factor: "scale" times the sensor's imaging ratio.
struct Light {
  Color color;
  double scale;
};
Light light_of(Reader&, const Parameters&, const char* name, Use);
Ref<Component> area_emission(Reader&, AreaLight&, bool turned, size_t pieces);
/// The pixel value that pbrt computes for a radiance of 1 at all wavelengths (here it is 1): the integral of the observer's y
/// over wavelengths [nm]. pbrt divides the spectra of its lights by it, but not the emission of media.
inline constexpr double pixel_of_one = 106.856917;
/// pbrt's unit of power or illuminance, for which a luminance of 1 is a pixel value of 1 [lm, lx].
inline constexpr double luminous_unit = 683.002 * pixel_of_one;
void set_emission(Component& object, const Ref<Component>& emission, Location at);

// media.cpp
void make_medium(Reader&, const std::string& name, Parameters&&);
/// The measured medium that a parameter names; null: none is given, or an unknown one, with a warning.
const MeasuredMedium* measured_medium(Reader&, const Parameters&, const char* parameter);
/// The medium of this name for an object with this transform; null: it was left out.
Ref<Component> medium_for(Reader&, const std::string& name, const AnimatedTransform& object, Location at);

// integrators.cpp
struct Integrator {
  Ref<Component> renderer;
  int samples;
};
/// `samples`: the sampler's samples per pixel.
Integrator make_integrator(Reader&, int samples);
/// Whether pbrt's integrator handles participating media; others ignore them.
bool knows_media(const Reader&);

// job.cpp, camera.cpp, view.cpp
void set_renderer(Reader&, Component& job);
void set_camera(Reader&, Component& job);
void set_film(Reader&, Component& job);
/// Resolution of the full image [pixels].
struct FilmSize {
  int width, height;
};
FilmSize film_size(const Reader&);
/// The sensor's imaging ratio, by which it multiplies radiance.
double imaging_ratio(Reader&);

}  // namespace etendue::pbrt
