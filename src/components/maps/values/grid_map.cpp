// Numbers and colours on a grid through space.

#include "components/maps/footprint.h"
#include "components/maps/rgb_source.h"
#include "components/volumes/bounded_map.h"
#include "components/volumes/volume_grid.h"
#include "etendue/core/transform.h"
#include "etendue/describe/bands.h"
#include "etendue/object_map.h"

namespace etendue {
namespace {

// Interpolation between cells is linear in their numbers, also for RGB: the spectrum is made from the interpolated RGB. As a
// coefficient a spectrum nowhere exceeds twice its largest component (Jakob & Hanika 2019), and interpolated RGB is a mean of
// the cells' RGB, so twice the largest number of all cells is an upper bound.
class GridMap final : public ObjectMap, public RgbSource, public BoundedMap {
 public:
  static void describe(Description<GridMap>& d) {
    d.summary(
        "Numbers or colours given on a grid through space: densities and temperatures of a MapVolume, textures of surfaces cut "
        "out of a block. The grid fills the unit cube from (0, 0, 0) to (1, 1, 1) of its own coordinates; cells' values are "
        "those in their middles.");
    d.group("Values")
        .member<&GridMap::file>(
            "file", "",
            std::string("the values: ") + grid_files + "; with three channels they are RGB. None: the numbers below")
        .member<&GridMap::grid_name>("grid_name", "", "which grid of a .nvdb; none: its first", when("file"))
        .member<&GridMap::resolution>("resolution", "1", "how many cells there are along x, y and z", unless("file"))
        .member<&GridMap::values>("values", "1",
                                  "their values, x running fastest, z slowest: a number for each, or red, green and blue",
                                  unless("file"))
        .member<&GridMap::color_space>("color_space", "", "primaries and white of RGB", rgb_space_names())
        .group("Place")
        .member<&GridMap::placement>("placement", "", "from the unit cube of the grid to the object's coordinates")
        .member<&GridMap::file_box>("file_box", "",
                                    "whether the grid fills, instead of the unit cube, the box that its file names; of a "
                                    ".nvdb, its active values and half a cell around them",
                                    when("file"))
        .member<&GridMap::filter>("filter", "", "what is between the middles of cells", choices("nearest", "trilinear"))
        .member<&GridMap::outside>("outside", "",
                                   "what lies outside the cube; clamp: as at its border; repeat and mirror: the grid again; "
                                   "empty: 0, which the cells at the border already fade to; cut: 0, from the border on",
                                   choices("clamp", "repeat", "mirror", "empty", "cut"));
  }

  void prepare() override {
    space_ = &rgb_space(color_space);
    grid_ = file.empty() ? grid_of_list(*this, "values", resolution, values) : grid_of_file(*this, "file", file, grid_name);
    if (file_box && !file.empty()) require_box(*this, "file", grid_);
    if (!placement.valid()) fail("placement", "must be finite, and have an inverse");
    largest_ = grid_.largest();
  }

  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    float v[3];
    look_up(p, v);
    for (float& x : v) x = std::max(x, 0.0f);
    if (grid_.channels == 3) return rgb_spectrum(*space_, v[0], v[1], v[2], use, w);
    return used_number(use == ColorUse::reflectance ? std::min(v[0], 1.0f) : v[0], use, w);
  }
  float scalar(const SurfacePoint& p) const override {
    float v[3];
    look_up(p, v);
    return grid_.channels == 3 ? (v[0] + v[1] + v[2]) / 3 : v[0];
  }
  float largest() const override { return largest_; }
  float bound() const override { return grid_.channels == 3 ? 2 * largest_ : largest_; }
  bool has_rgb() const override { return grid_.channels == 3; }
  std::string rgb_space_name() const override { return color_space; }
  void rgb(const SurfacePoint& p, float out[3]) const override { look_up(p, out); }

  FilePath file;
  std::string grid_name;
  std::vector<int> resolution{1, 1, 1};
  std::vector<float> values{1};
  std::string color_space = "srgb";
  AnimatedTransform placement;
  bool file_box = false;
  VoxelFilter filter = VoxelFilter::trilinear;
  Beyond outside = Beyond::clamp;

 private:
  void look_up(const SurfacePoint& p, float out[3]) const {
    std::fill_n(out, 3, 0.0f);
    Transform scratch;
    if (placement.animated()) scratch = placement.written(p.time);
    const Transform& placed = placement.animated() ? scratch : placement.still();
    over_footprint(p, [&](const Point3& at, float weight) {
      float v[3];
      Point3 q = placed.back(at);
      if (file_box && !file.empty())
        for (int k = 0; k < 3; ++k) q[k] = (q[k] - grid_.low[k]) / (grid_.high[k] - grid_.low[k]);
      grid_.look_up(q, filter, outside, v);
      for (int i = 0; i < grid_.channels; ++i) out[i] += weight * v[i];
    });
  }

  const RgbSpace* space_ = nullptr;
  VolumeGrid grid_;
  float largest_ = 1;
};

const Register<GridMap> registered;

}  // namespace
}  // namespace etendue
