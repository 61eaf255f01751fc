#pragma once
// A description of surfaces common to all model formats, and its conversion to a shader, an emission and a medium.

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "etendue/importer.h"

namespace etendue {

/// An image on a surface.
struct SurfaceTexture {
  std::string file;  ///< path to open; may lie inside another file (files/contained_file.h)
  std::string wrap = "repeat";
  std::string wrap_v;  ///< wrap mode along v; "": the same as `wrap`
  bool nearest = false;
  std::string transfer;  ///< encoding of the values; "": determined by the use of the texture
  // Texture coordinates, with v upwards, are scaled, then rotated from u towards v, then shifted.
  std::array<double, 2> scale{1, 1}, shift{0, 0};
  double angle = 0;  ///< [rad]
};

/// A number, times a channel of a texture.
struct SurfaceNumber {
  double value = 0;
  std::optional<SurfaceTexture> texture;
  std::string channel;                   ///< "R", "G", "B" or "A"; "": the mean of the colour channels
  bool inverted = false;                 ///< use 1 - inverted_share * texture
  double inverted_share = 1;             ///< see `inverted`
  double offset = 0;                     ///< added to the product of value and texture
  bool squared = false;                  ///< the value used is the square of the number
  std::string attribute;                 ///< name of a vertex attribute, a further factor
  SurfaceNumber(double v) : value(v) {}  // NOLINT: implicit conversion
};

/// A linear sRGB colour, times a texture, times the vertex colours, for each component.
struct SurfaceColor {
  std::array<double, 3> value{};
  std::optional<SurfaceTexture> texture;
  bool by_vertex = false;
  std::array<double, 3> offset{};                                 ///< added to the product if there is a texture
  SurfaceColor(double all) : value{all, all, all} {}              // NOLINT: a number is a grey
  SurfaceColor(const std::array<double, 3>& rgb) : value(rgb) {}  // NOLINT
  bool black() const { return value[0] <= 0 && value[1] <= 0 && value[2] <= 0; }
};

struct SurfaceNormals {
  SurfaceTexture texture;
  double strength = 1;
  bool downwards = false;  ///< the green channel increases against v
};

/// The metallic-roughness model of glTF with its extensions; materials of other formats are converted to it.
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
  bool thin = true;                ///< a transmitting surface is a thin sheet without an interior
  SurfaceNumber translucence = 0;  ///< fraction of the diffuse lobe that is transmitted
  SurfaceColor translucent_color = 1.0;
  std::array<double, 3> attenuation_color{1, 1, 1};
  double attenuation_distance = std::numeric_limits<double>::infinity();  ///< for attenuation_color to remain [m]
  double abbe_number = 0;                                                 ///< 0: no dispersion
  SurfaceNumber coat = 0, coat_roughness = 0;
  SurfaceColor sheen_color = 0.0;                ///< its largest component also scales down the base below
  SurfaceNumber sheen_roughness = 0;             ///< exponent 1 / r of its fibres' distribution (Estevez & Kulla 2017)
  SurfaceNumber film = 0, film_thickness = 400;  ///< [nm]
  double film_ior = 1.3;
  SurfaceColor emission = 0.0;
  bool emits_backwards = false;
  bool unlit = false;  ///< shows its base colour independent of the lighting
  SurfaceNumber opacity = 1;
  std::optional<double> opacity_cutoff;  ///< alpha threshold: below it fully transparent, else opaque
  std::optional<SurfaceNormals> normals;
  std::optional<SurfaceTexture> bumps;
  double bump_height = 0;  ///< height difference between black and white [m]
};

struct MadeSurface {
  Ref<Component> shader, emission, interior;  ///< each may be null
};
MadeSurface make_surface(Importing&, const Surface&, Location at);

/// Importing::optional_file for an image. A name with <UDIM> stands for several tiles; returned is that name with its folder.
std::optional<std::string> optional_image(Importing&, const std::string& named, Location at, const std::string& beside = {});
/// The names of an image's channels; for UDIM tiles those of the first tile. Throws Error if the image cannot be read.
const std::vector<std::string>& channels_of_image(Importing&, const std::string& file);
/// The texture of an image, or nothing and a warning if the image is unreadable. Sets `has_alpha` unless it is null.
std::optional<SurfaceTexture> readable_texture(Importing&, const std::string& file, Location at, bool* has_alpha = nullptr);
/// Whether an image is bluish everywhere, like a normal map: many programs write a normal map where a height map belongs.
bool looks_like_normals(const std::string& file);

/// The mean colour of an image as linear RGB; decoded as a colour image. Nothing: the image cannot be read.
std::optional<std::array<double, 3>> mean_of_image(const std::string& file);

/// A map of the colour; null: the colour is constant.
Ref<Component> surface_color_map(Importing&, const SurfaceColor&, Location at);

// A value that can be set as a member.
Value color_value(const std::array<double, 3>& rgb, Location at);

/// The name as the scene language allows it: letters, digits and '_'.
std::string plain_name(const std::string&);

}  // namespace etendue
