#pragma once
// Converts Mitsuba plugins to components.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "components/volumes/volume_grid.h"
#include "element.h"
#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "values.h"

namespace etendue::mitsuba {

/// How a shape's texture coordinates here relate to Mitsuba's, where v follows the rows of images, from the top.
enum class Uv : std::uint8_t {
  as_is,     ///< v is Mitsuba's
  from_top,  ///< v is 1 - Mitsuba's, as image rows are numbered here: OBJ files, whose v Mitsuba flips, and spheres
};

/// The quantity that a texture is read as.
enum class Read : std::uint8_t {
  color,
  mean,       ///< a number: the mean of a colour's three values, as in version 0
  luminance,  ///< a number
};

class Converter {
 public:
  explicit Converter(Importing& importing) : importing_(importing) {}

  Ref<Job> job(const Element& scene);

 private:
  /// Marks a plugin as being read during its lifetime; throws Error if a plugin contains itself.
  class Reading {
   public:
    explicit Reading(const Element&);
    ~Reading() { element_.being_read = false; }
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;

   private:
    const Element& element_;
  };

  // sensors, films, integrators
  void place(Component& camera, const Element& sensor);
  Ref<Component> camera(const Element& sensor);
  std::string axis_of(const Element& e);
  static double focal_length(const Element& e);
  bool front_by_world(const Element& shape);
  void set_view(Component& camera, const Element& sensor);
  void set_clip(Component& camera, const Element& sensor);
  void set_shutter(Component& camera, const Element& sensor);
  Ref<Component> image(const Element* film);
  Ref<Component> filter(const Element& film);
  void add_outputs(Component& job, const Element* film);
  Ref<Component> renderer(const Element& scene, const Element* integrator, const Element* sampler);
  Ref<Component> around(const Element& outer, const std::vector<const Element*>& inner);
  Ref<Component> features(const Element& integrator);
  /// Records the channels of an 'aov' as layers of the image.
  void note_channels(const Element& aov);
  /// Mitsuba's defaults for a scene without a sensor or an emitter.
  Ref<Component> default_camera(const Element& scene, const std::vector<Ref<SceneObject>>& world);
  Ref<SceneObject> default_sky(const Element& scene);
  Ref<Component> light_transport(const Element& integrator);
  void set_depths(Component& renderer, const Element& integrator);
  /// Records where an integrator states that the camera does not see emitters.
  void note_hidden_emitters(const Element& integrator) {
    if (integrator.boolean("hide_emitters", false)) hides_emitters_ = integrator.location_of("hide_emitters");
  }
  /// Makes those of the objects that emit invisible to the camera.
  void hide_emitters(const std::vector<Ref<SceneObject>>&);

  // shapes
  Ref<SceneObject> shape(const Element&);
  Ref<Component> geometry(const Element&, Uv&);
  Ref<Component> sphere(const Element&);
  Ref<Component> rectangle(const Element&);
  Ref<Component> cylinder(const Element&);
  Ref<Component> cube(const Element&);
  Ref<Component> mesh(const Element&, Uv&);
  Ref<Component> curves(const Element&);
  Ref<Component> instance(const Element&);
  Ref<Component> group(const Element&);
  /// `shader`: used if the shape has no bsdf.
  void set_surface(Component& object, const Element& shape, Uv, const Element* bsdf, const Ref<Component>& shader = nullptr);
  /// Gives a mesh from a file Mitsuba's fronts: its triangles are written out where they differ from those of the file.
  /// `flipped`: Mitsuba's front is the back of the object; returns the same of the result. `holds_medium`: a mesh that is
  /// inside out is turned round.
  bool settle_fronts(Component& object, const Element& shape, bool flipped, bool holds_medium);
  /// An OBJ file of version 0.x whose faces have several materials, as a group; null: it is one mesh.
  Ref<Component> parts_of_obj(const Element&);
  Ref<Component> turned_round(const Ref<Component>& shader, Location at);
  bool textured(const Element&);
  bool tilts(const Element&);  ///< whether its bsdfs include a bump map or a normal map

  // surfaces
  struct Surface {
    Ref<Component> shader;
    bool both_sides = false;  ///< the back is not black
  };
  Surface surface(const Element& bsdf, Uv);
  Surface make_surface(const Element& bsdf, Uv, const std::string& name);
  Surface inner_surface(const Element& bsdf, Uv, size_t number = 0);
  Surface matte(const Element&, Uv, const std::string& name);
  Surface dielectric(const Element&, Uv, const std::string& name);
  Surface conductor(const Element&, Uv, const std::string& name);
  Surface plastic(const Element&, Uv, const std::string& name);
  Surface coating(const Element&, Uv, const std::string& name);
  Surface mixture(const Element&, Uv, const std::string& name);
  Surface mask(const Element&, Uv, const std::string& name);
  Surface filter_of_polarization(const Element&, Uv, const std::string& name);
  Surface tilted(const Element&, Uv, const std::string& name);
  Surface classic(const Element&, Uv, const std::string& name);
  Surface principled(const Element&, Uv, const std::string& name);
  void tell_of_energy(const Element&, const Component& shader);
  Surface fibre(const Element&, const std::string& name);
  void set_roughness(Component& shader, const Element&, Uv, double otherwise);
  double index(const Element&, const char* name, const char* otherwise);
  Color spectrum_of(const Element&, const std::string& name, double otherwise);
  /// A coefficient per distance or an albedo of a medium, upsampled as Mitsuba's spectral variants do.
  Color medium_color(const Element&, const std::string& name, double otherwise);

  // textures and colours
  /// The value for a member that accepts a colour or a map.
  Value color(const Element&, const std::string& name, double otherwise, Uv, Read = Read::color);
  Value scalar(const Element&, const std::string& name, double otherwise, Uv);
  Value texture(const Element&, Uv, Read = Read::color);
  Value bitmap(const Element&, Uv, Read);
  Value checkerboard(const Element&, Uv, Read);
  Value attribute_map(const Element&);
  Value light(const Element&, const std::string& name, Uv);
  Value light_of(const Element& spectrum, Uv);
  Color scaled_light(const ColorValue&, bool old) const;
  /// A map whose coordinates are transformed by `to_uv` and the shape's convention; `from_top`: the map's v counts downwards.
  Value placed(const Ref<Component>& map, const Element& texture, Uv, bool counts_from_top);
  Transform to_uv(const Element& texture);

  // light
  Ref<SceneObject> emitter(const Element&);
  Ref<Component> area_emission(const Element&, Uv);
  Ref<Component> spot(const Element&);
  Ref<Component> projector(const Element&);
  Ref<Component> directional(const Element&);
  Ref<Component> environment(const Element&);
  Ref<Component> sky(const Element&);
  /// Stores which sun and which sky of a version 0.x scene belong together.
  void pair_sun_and_sky(const Element& scene);
  void aim_sun(Component& emission, const Element&, const AnimatedTransform& stands);
  void set_sun_diameter(Component& emission, const Element&);
  Ref<Component> lone_sun(const Element&);
  Ref<Component> beam(const Element&);
  Ref<Component> diffuse_emission(const Element&, const char* light_name);

  // media
  /// The medium inside an object, whose transform must be set: grids are placed in object space. `glow`: the object's
  /// volumelight.
  Ref<Component> medium(const Element&, const Component& object, const Element* glow = nullptr);
  Ref<Component> homogeneous(const Element&);
  Ref<Component> heterogeneous(const Element&, const Component& object, const Element* glow);
  bool same_place(const Element& grid, const Element& other);
  Ref<Component> box_of(const Element& medium, const Element* volume, const Component& object);
  void place_box(Component& box, const Element& medium, const Element* grid, const Component& object);
  void set_albedo(Component& medium, const Element&, const Element* volume, const Component& object);
  /// From the unit cube to the box of a heterogeneous medium with constant extinction.
  static Transform box_of_constant(const Element& medium);
  Ref<Component> even_everywhere(const Element& medium, const Color& extinction);
  static Transform to_world_of(const Component& object);
  void shine(Component& medium, const Element& glow, const Component& object);
  void set_grid(Component& grid, const Element& volume, const Component& object);
  /// The placement of a grid in world space.
  struct GridPlace {
    Transform cells;       ///< from the unit cube; if `by_file` is true and `apart` false, from the file's box
    Transform box;         ///< from the same space to the box that bounds a medium of this grid
    bool by_file = false;  ///< the box is stated in the file
    bool apart = false;    ///< the cells do not exactly fill the box
  };
  GridPlace place_of_grid(const Element& volume);
  VolumeGrid read_grid(const Element& volume);
  /// The value outside a grid, for the member `outside` of GridMap.
  static std::string beyond_grid(const Element& volume);
  /// From the unit cube to the box that bounds a medium; nothing: the medium has no grid.
  std::optional<Transform> grid_box(const Element& medium);
  void set_phase(Component& volume, const Element& medium);
  Ref<Component> phase_function(const Element&);
  Ref<Component> blended_phases(const Element&);
  /// The object to be added to the world for the medium around the sensor; null: nothing (surroundings.cpp). `seen`: Mitsuba's
  /// integrator handles media.
  Ref<SceneObject> settle_media(const Element* sensor, bool seen, const std::vector<Ref<SceneObject>>& world);

  // helpers
  Ref<Component> make(const char* class_name, const Element& e, const std::string& name) {
    return importing_.make(class_name, e.at, name);
  }
  Ref<Component> make(const char* class_name, const Element& e) { return make(class_name, e, e.id); }
  void set_transform(Component&, const TransformValue&, Location);
  /// A file that a plugin names.
  FilePath file(const Element&, const std::string& name = "filename");
  [[noreturn]] void fail_unknown(const Element&, const std::vector<std::string>& known) const;
  /// Warns that the plugin is unknown or unsupported and that `what` replaces it; its other properties are not reported.
  void stand_in(const Element&, const std::vector<std::string>& known, const std::string& what);
  /// Warns of properties of the plugins read that were never queried.
  void note_unread(const Element& scene);
  void inexact(const Element& e, const std::string& what) { importing_.inexact(what, e.at); }

  /// The media that a shape states for its two sides.
  struct MediumSides {
    Ref<SceneObject> object;
    const Element *interior, *exterior;  ///< null: none
    bool in_group;                       ///< the shape is part of a shapegroup
    Location at;
  };

  Importing& importing_;
  std::vector<MediumSides> sides_;
  Location hides_emitters_;  // unknown location: emitters are visible
  int groups_read_ = 0;      ///< current nesting depth of groups
  std::map<std::pair<const Element*, Uv>, Surface> surfaces_;
  std::map<const Element*, Ref<Component>> media_, groups_;
  std::map<const Element*, bool> textured_, tilts_;
  std::map<const Element*, GridPlace> places_;
  const Element *sun_of_sky_ = nullptr, *sky_with_sun_ = nullptr;  ///< a sun and a sky that belong together
  std::map<const Component*, Ref<Component>> turned_;              // shaders with front and back exchanged, by their originals
  Value::List layers_;                                             ///< of the image
};

}  // namespace etendue::mitsuba
