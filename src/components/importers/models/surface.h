#pragma once
// How a surface looks in the words that model formats share, and the shader, emission and medium that look so.

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "etendue/importer.h"

namespace etendue {

/// An image on a surface.
struct SurfaceTexture {
  std::string file;  ///< to be opened (may lie in another: files/contained_file.h)
  std::string wrap = "repeat";
  std::string wrap_v;  ///< above and below; "": as at the sides
  bool nearest = false;
  std::string transfer;  ///< how its numbers are encoded; "": what it is used for says so
  // Surface coordinates, with v upwards, are scaled, then turned from u towards v, then shifted.
  std::array<double, 2> scale{1, 1}, shift{0, 0};
  double angle = 0;  ///< [rad]
};

/// A number, times a channel of a texture.
struct SurfaceNumber {
  double value = 0;
  std::optional<SurfaceTexture> texture;
  std::string channel;                   ///< of the texture: "R", "G", "B", "A"; "": the mean of its colours
  bool inverted = false;                 ///< 1 minus the texture
  double inverted_share = 1;             ///< of the texture that 1 is made less by
  double offset = 0;                     ///< what is added to the product of the number and the texture
  bool squared = false;                  ///< what counts is its square
  std::string attribute;                 ///< times what vertices have of this name
  SurfaceNumber(double v) : value(v) {}  // NOLINT: a number is one
};

/// A linear sRGB colour, times a texture, times the colours of vertices: red, green and blue on their own.
struct SurfaceColor {
  std::array<double, 3> value{};
  std::optional<SurfaceTexture> texture;
  bool by_vertex = false;
  std::array<double, 3> offset{};                                 ///< what is added to the product where there is a texture
  SurfaceColor(double all) : value{all, all, all} {}              // NOLINT: a number is a grey
  SurfaceColor(const std::array<double, 3>& rgb) : value(rgb) {}  // NOLINT
  bool black() const { return value[0] <= 0 && value[1] <= 0 && value[2] <= 0; }
};

struct SurfaceNormals {
  SurfaceTexture texture;
  double strength = 1;
  bool downwards = false;  ///< green grows against v
};

/// Metal and roughness as glTF has them, with its extensions; what other formats say is brought to this.
struct Surface {
  std::string name;
  SurfaceColor base_color = 1.0;
  SurfaceNumber metalness = 0, roughness = 1;
  double ior = 1.5;
  SurfaceNumber specular = 1;
  SurfaceColor specular_color = 1.0;
  SurfaceNumber anisotropy = 0;
  double anisotropy_rotation = 0;  ///< from u, counter-clockwise [turns]
  SurfaceNumber transmission = 0;
  SurfaceColor transmission_color = 1.0;
  bool thin = true;                ///< of what transmits: a sheet without an inside
  SurfaceNumber translucence = 0;  ///< fraction of the matt body that sends light to the other side
  SurfaceColor translucent_color = 1.0;
  std::array<double, 3> attenuation_color{1, 1, 1};
  double attenuation_distance = std::numeric_limits<double>::infinity();  ///< at which so much is left of white light [m]
  double abbe_number = 0;                                                 ///< 0: no dispersion
  SurfaceNumber coat = 0, coat_roughness = 0;
  SurfaceColor sheen_color = 0.0;                ///< the strongest of its numbers is also what it takes from below
  SurfaceNumber sheen_roughness = 0;             ///< exponent 1 / r of its fibres' distribution (Estevez & Kulla 2017)
  SurfaceNumber film = 0, film_thickness = 400;  ///< [nm]
  double film_ior = 1.3;
  SurfaceColor emission = 0.0;
  bool emits_backwards = false;
  bool unlit = false;  ///< it has its base colour whatever the light
  SurfaceNumber opacity = 1;
  std::optional<double> opacity_cutoff;  ///< below it there is nothing, above all
  std::optional<SurfaceNormals> normals;
  std::optional<SurfaceTexture> bumps;
  double bump_height = 0;  ///< between black and white [m]
};

struct MadeSurface {
  Ref<Component> shader, emission, interior;  ///< each may be none
};
MadeSurface make_surface(Importing&, const Surface&, Location at);

/// Importing::optional_file of an image; of one with <UDIM> in its name, which stands for several, that name with its folder.
std::optional<std::string> optional_image(Importing&, const std::string& named, Location at, const std::string& beside = {});
/// The names of an image's channels; of one in several files those of its first. Throws Error where it cannot be read.
const std::vector<std::string>& channels_of_image(Importing&, const std::string& file);
/// An image that can be read, or nothing and a note. `has_alpha` is told when asked for.
std::optional<SurfaceTexture> readable_texture(Importing&, const std::string& file, Location at, bool* has_alpha = nullptr);
/// Whether an image is blue all over, as one of normals is: many programs write that where one of heights belongs.
bool looks_like_normals(const std::string& file);

/// Red, green and blue of an image on the average, linear, encoded as colours are; nothing: it cannot be read.
std::optional<std::array<double, 3>> mean_of_image(const std::string& file);

/// A map of such a colour; none: it is the same everywhere.
Ref<Component> surface_color_map(Importing&, const SurfaceColor&, Location at);

// Ready to be set as members.
Value color_value(const std::array<double, 3>& rgb, Location at);

/// A name as the language allows it: letters, digits and '_'.
std::string plain_name(const std::string&);

}  // namespace etendue
