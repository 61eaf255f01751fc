// GridVolume: a medium whose density is given on a grid.

#include <fmt/format.h>

#include "colored_volume.h"
#include "etendue/core/transform.h"
#include "etendue/describe/color.h"
#include "volume_grid.h"

namespace etendue {
namespace {

// With d(p) the value of the grid at p and c the coefficients at density 1, the coefficients at p are c d(p). The majorant of
// the extinction is c times the largest value of the grid, as interpolated values are means. An albedo given on a grid replaces
// the colour `albedo`. Values of three channels are RGB, converted to a spectrum at each point after interpolation: as a
// coefficient the spectrum nowhere exceeds twice the largest component, so the majorant is then twice as large.
class GridVolume final : public ColoredVolume {
 public:
  static void describe(Description<GridVolume>& d) {
    d.summary(
        "A medium whose density is given on a grid: all coefficients are multiplied by it. "
        "The grid fills the unit cube from (0, 0, 0) to (1, 1, 1) of its own coordinates; cells' values are those in "
        "their "
        "middles.");
    d.group("Density")
        .member<&GridVolume::file>(
            "file", "",
            std::string("the densities: ") + grid_files + "; with three channels they are RGB factors. None: the numbers below")
        .member<&GridVolume::grid_name>("grid_name", "", "which grid of a .nvdb; none: its first", when("file"))
        .member<&GridVolume::resolution>("resolution", "1", "how many densities there are along x, y and z", unless("file"))
        .member<&GridVolume::density>(
            "density", "1", "the densities, x running fastest, z slowest; three numbers each: RGB factors", unless("file"))
        .group("Place")
        .member<&GridVolume::placement>("placement", "",
                                        "from the unit cube of the grid to the coordinates of the object whose inside it fills")
        .member<&GridVolume::file_box>("file_box", "",
                                       "whether the grid fills, instead of the unit cube, the box that its file names; of a "
                                       ".nvdb, its active values and half a cell around them",
                                       when("file"))
        .member<&GridVolume::filter>("filter", "", "what is between the middles of cells", choices("nearest", "trilinear"))
        .member<&GridVolume::outside>(
            "outside", "",
            "what lies outside the cube; clamp: as at its border; repeat and mirror: the grid again; empty: nothing, "
            "which the cells at the border already fade to; cut: nothing, from the border on",
            choices("clamp", "repeat", "mirror", "empty", "cut"));
    describe_colors(d, " where the density is 1");
    d.group("Albedo of each cell")
        .member<&GridVolume::albedo_file>(
            "albedo_file", "",
            "a grid (.vol, .npy, or the first of a .nvdb), of the same place, that says instead how much of the extinction "
            "scatters: one channel, or RGB")
        .member<&GridVolume::albedo_as>("albedo_as", "",
                                        "what RGB albedos become; reflectance: the spectrum of a surface of that colour; "
                                        "coefficient: one made as those of densities are, cut at 1",
                                        choices("reflectance", "coefficient"), when("albedo_file"))
        .member<&GridVolume::color_space>("color_space", "", "primaries and white of RGB in grids", rgb_space_names());
  }

  void prepare() override {
    prepare_colors();
    space_ = &rgb_space(color_space);
    if (file.empty()) {
      grid_ = grid_of_list(*this, "density", resolution, density);
      cut_negatives(*this, "density", grid_);
    } else {
      grid_ = grid_of_file(*this, "file", file, grid_name);
      cut_negatives(*this, "file", grid_);
      if (file_box) require_box(*this, "file", grid_);
    }
    albedo_grid_ = {};
    if (!albedo_file.empty()) {
      albedo_grid_ = grid_of_file(*this, "albedo_file", albedo_file);
      cut_negatives(*this, "albedo_file", albedo_grid_);
    }
    largest_ = grid_.largest() * (grid_.channels == 3 ? 2 : 1);
    const Color sums[] = {extinction ? extinction : absorption, extinction ? flat_spectrum(0) : scattering};
    float most = 0;
    if (dissolved) {
      if (grid_.channels == 3) fail("dye", "needs densities of one channel: those of RGB have no single amount of dye");
      most += largest_ * dye_absorption;
    }
    for (const Color& color : sums) most += largest_ * range_of(*color, ColorUse::coefficient).most;
    if (!(most <= most_extinction)) fail(file.empty() ? "density" : "file", fmt::format(too_dense, most));
    if (!placement.valid()) fail("placement", "must be finite, and have an inverse");
  }

  VolumeCoefficients coefficients(const Point3& p, float time, const Wavelengths& w) const override {
    const Point3 unit = in_grid(p, time);
    const Spectrum d = density_at(unit, w);
    if (d.black()) return {};
    VolumeCoefficients c = colors(w);
    if (!albedo_grid_.values.empty()) {
      const Spectrum dyed = dye_coefficient(w), whole = c.extinction() - dyed;
      c.scattering = whole * albedo_at(unit, w);
      c.absorption = max(whole - c.scattering, 0) + dyed;
    }
    c.absorption *= d;
    c.scattering *= d;
    c.emission *= d;
    return c;
  }
  float dye_amount(const Point3& p, float time) const override {
    float v[3];
    grid_.look_up(in_grid(p, time), filter, outside, v);
    return v[0] * dye_absorption;
  }
  float most_dye() const override { return largest_ * dye_absorption; }
  bool homogeneous() const override { return false; }
  Spectrum majorant(const Wavelengths& w) const override { return colors(w).extinction() * (largest_ * 1.00001f); }

  FilePath file, albedo_file;
  std::string grid_name;
  std::vector<int> resolution{1, 1, 1};
  std::vector<float> density{1};
  AnimatedTransform placement;
  bool file_box = false;
  VoxelFilter filter = VoxelFilter::trilinear;
  Beyond outside = Beyond::clamp;
  std::string color_space = "srgb";
  enum class AlbedoUse { reflectance, coefficient } albedo_as = AlbedoUse::reflectance;

 private:
  Point3 in_grid(const Point3& p, float time) const {
    Point3 q = placement.animated() ? placement.written(time).back(p) : placement.still().back(p);
    if (file_box && !file.empty())
      for (int k = 0; k < 3; ++k) q[k] = (q[k] - grid_.low[k]) / (grid_.high[k] - grid_.low[k]);
    return q;
  }
  Spectrum density_at(const Point3& unit, const Wavelengths& w) const {
    float v[3];
    grid_.look_up(unit, filter, outside, v);
    if (grid_.channels == 1) return Spectrum(v[0]);
    return rgb_spectrum(*space_, v[0], v[1], v[2], ColorUse::coefficient, w);
  }
  Spectrum albedo_at(const Point3& unit, const Wavelengths& w) const {
    float v[3];
    // Outside the grid there is no density with `empty` and `cut`, so the albedo there does not matter.
    albedo_grid_.look_up(unit, filter, outside == Beyond::empty || outside == Beyond::cut ? Beyond::clamp : outside, v);
    if (albedo_grid_.channels == 1) return Spectrum(std::min(v[0], 1.0f));
    if (albedo_as == AlbedoUse::reflectance) return rgb_spectrum(*space_, v[0], v[1], v[2], ColorUse::reflectance, w);
    return map(rgb_spectrum(*space_, v[0], v[1], v[2], ColorUse::coefficient, w), [](float x) { return std::min(x, 1.0f); });
  }

  const RgbSpace* space_ = nullptr;
  VolumeGrid grid_, albedo_grid_;
  float largest_ = 1;  // upper bound of the factor d(p)
};

const Register<GridVolume> registered;

}  // namespace
}  // namespace etendue
