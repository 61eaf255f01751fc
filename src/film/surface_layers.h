#pragma once
// SurfaceLayers: the layers of a picture that show the surfaces which camera rays meet first, and not light: what is asked for,
// and how a SurfaceFilm stores it.
//
// Such a layer depends on the camera, the scene, the sampler and the picture alone, so it is the same with every renderer.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Numbers of a surface that are averaged over the samples of a pixel, each three numbers at most.
enum class SurfaceNumber : std::uint8_t {
  albedo,            ///< linear sRGB, under white light
  normal,            ///< unit, in world space: the shading normal on the side of the camera
  geometric_normal,  ///< unit, in world space, on the side of the camera
  position,          ///< in world space [m]
  depth,             ///< distance from the camera along the ray [m]
  uv,                ///< surface coordinates
  roughness,         ///< from 0 (a mirror) to 1
  motion_previous,   ///< [pixels] from where the point is seen to where it was seen
  motion_next,       ///< [pixels] from where the point is seen to where it will be seen
  count
};
inline constexpr size_t surface_numbers = size_t(SurfaceNumber::count);

/// Whether the mean is taken over all samples, those that meet nothing counting as zero, or over those that meet a surface.
constexpr bool over_all_samples(SurfaceNumber number) { return number <= SurfaceNumber::geometric_normal; }

/// The kinds of Cryptomatte, by what names an object.
enum class MatteKind : std::uint8_t { object, material, asset, group, count };
inline constexpr size_t matte_kinds = size_t(MatteKind::count);
inline constexpr std::array<const char*, matte_kinds> matte_layers = {"crypto_object", "crypto_material", "crypto_asset",
                                                                      "crypto_group"};

class SurfaceLayers {
 public:
  /// Takes an entry of ImageBuffer::layers, such as "depth", "motion = 0.04" or "crypto_object = 12". False: it names no layer
  /// of surfaces. Throws Error, without a location, if what follows the name is wrong.
  bool take(const std::string& entry);
  /// The names of all such layers, and their forms with a number ("motion = …").
  static std::vector<std::string> offered();
  /// The name in an entry: "motion" of "motion = 0.04".
  static std::string name_of(const std::string& entry);

  bool any() const { return coverage || identifiers() || triples() > 0 || mattes(); }
  /// Index of a number among those that are stored; -1: it is not wanted.
  int place(SurfaceNumber number) const { return places_[size_t(number)]; }
  int triples() const { return triples_; }
  /// Whether any of the numbers of objects, materials and primitives is wanted.
  bool identifiers() const { return object || material || primitive; }
  /// Whether any kind of Cryptomatte is wanted.
  bool mattes() const { return ranks != std::array<int, matte_kinds>{}; }
  bool motion() const { return place(SurfaceNumber::motion_next) >= 0; }

  std::vector<std::string> names;  ///< in the order of the description
  bool coverage = false;           ///< the share of the samples that meet a surface
  bool object = false, material = false, primitive = false;
  std::array<int, matte_kinds> ranks{};  ///< the coverages that are kept of each pixel; 0: the kind is not wanted
  /// How long before and after a sample's time the motion is followed [s]; 0: to the ends of the shutter.
  float motion_time = 0;
  static constexpr int usual_ranks = 6, most_ranks = 200;

  /// Whether the sums for one are sums for the other. How many ranks are written does not matter.
  bool collects_as(const SurfaceLayers&) const;
  /// A hash of what is stored and where.
  std::uint64_t hash() const;

 private:
  void want(SurfaceNumber);
  std::array<int, surface_numbers> places_ = {-1, -1, -1, -1, -1, -1, -1, -1, -1};
  int triples_ = 0;
};

/// The channels of a layer, without those of mattes.
struct SurfaceChannel {
  enum class Source : std::uint8_t { number, coverage, object, material, primitive } source = Source::number;
  std::string name;
  SurfaceNumber number = SurfaceNumber::albedo;
  int component = 0;
};
std::vector<SurfaceChannel> channels_of(const SurfaceLayers&);

}  // namespace etendue
