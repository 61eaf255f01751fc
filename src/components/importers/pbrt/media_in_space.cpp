// Heterogeneous media: grids and clouds.

#include <fmt/format.h>

#include <algorithm>

#include "components/volumes/nanovdb_file.h"
#include "media.h"

namespace etendue::pbrt {

namespace {

struct Grid {
  std::array<int, 3> cells;
  DoublePoint3 p0, p1;

  /// Reads the resolution and box of a grid.
  Grid(const Reader& reader, const Parameters& p)
      : cells{p.integer("nx", 1), p.integer("ny", 1), p.integer("nz", 1)},
        p0(p.point("p0", {0, 0, 0})),
        p1(p.point("p1", {1, 1, 1})) {
    // If p0 is the upper corner, v3 mirrors the grid, and v4 sorts the coordinates.
    for (double DoublePoint3::* axis : {&DoublePoint3::x, &DoublePoint3::y, &DoublePoint3::z})
      if (reader.version != 3 && p0.*axis > p1.*axis) std::swap(p0.*axis, p1.*axis);
    for (const int n : cells)
      if (n < 1) throw Error("a grid needs at least one cell along each axis", p.at);
  }
  double count() const { return double(cells[0]) * cells[1] * cells[2]; }
  Numbers resolution() const { return {{double(cells[0]), double(cells[1]), double(cells[2])}, 1, Dimension::none}; }
  /// From its unit cube to world space.
  Transform placed(const Reader& reader) const {
    return reader.state.ctm[0] * Transform::translate({p0.x, p0.y, p0.z}) *
           Transform::scale(DoubleVector3{p1.x - p0.x, p1.y - p0.y, p1.z - p0.z});
  }

  /// The numbers of a parameter, `width` for each cell; empty: it is not given.
  std::vector<double> take(Parameters& p, const char* name, size_t width = 1) const {
    std::vector<double> values = p.take_numbers(name, width);
    if (!values.empty() && double(values.size()) != count() * double(width))
      throw Error(fmt::format("a grid of {} x {} x {} cannot have {} values of '{}'", cells[0], cells[1], cells[2],
                              values.size() / width, name),
                  p.place(name));
    return values;
  }
  Ref<Component> map(const Reader& reader, std::vector<double> values, const Parameters& p, const char* name) const {
    const Location at = p.place(name);
    const Ref<Component> made = reader.make("GridMap", at);
    set_member(*made, "resolution", resolution(), at);
    const bool colored = double(values.size()) != count();
    set_member(*made, "values", Numbers{std::move(values), 1, Dimension::none}, at);
    if (colored && p.space) set_member(*made, "color_space", p.space->name, at);
    set_member(*made, "outside", "empty", at);
    return made;
  }
};

void scale(std::vector<double>& values, double by) {
  for (double& v : values) v *= by;
}

/// sigma_a or sigma_s, constant in space.
Color coefficient(Reader& reader, const Parameters& p, const char* name, const std::array<double, 3>& in_v3) {
  const Parameter* const given = p.find(name);
  return given                 ? spectrum_of(reader, p, *given, Use::coefficient)
         : reader.version == 3 ? rgb_color("srgb", in_v3[0], in_v3[1], in_v3[2])
                               : flat_spectrum(1);
}

/// Sets sigma_a and sigma_s of v4, multiplied by "scale".
void set_scaled_coefficients(Reader& reader, Component& medium, const Parameters& p) {
  const double scale = p.number("scale", 1);
  for (const auto& [member, parameter] : {std::pair("absorption", "sigma_a"), {"scattering", "sigma_s"}}) {
    const Color color = coefficient(reader, p, parameter, {1, 1, 1});
    set_member(medium, member, scale == 1 ? color : scaled_spectrum(scale, color), p.place(parameter));
  }
}

/// The offset subtracted from a grid's temperatures, and the factor applied then.
std::pair<double, double> temperatures_of(const Parameters& p) {
  return {p.number("temperatureoffset", p.number("temperaturecutoff", 0)), p.number("temperaturescale", 1)};
}

/// pbrt normalizes blackbody spectra to a maximum of 1. Unlike that of lights, this emission is not divided by its luminance.
Ref<Component> blackbody(const Reader& reader, const Ref<Component>& temperature, double brightness, Location at) {
  const Ref<Component> glow = reader.make("BlackbodyMap", at);
  set_member(*glow, "temperature", temperature, at);
  set_member(*glow, "factor", brightness * pixel_of_one, at);
  set_member(*glow, "normalized", true, at);
  return glow;
}

/// The source radiance of a grid medium, pbrt's Le, to which its radiance tends where it is optically thick: from temperatures,
/// or a spectrum times a grid. Null: it has neither.
Ref<Component> glow_of(Reader& reader, const Grid& grid, Parameters& p) {
  std::vector<double> temperatures = grid.take(p, "temperature"), factors;
  if (const Parameter* given = p.find("Lescale"); given && given->numbers.size() > 1) factors = grid.take(p, "Lescale");
  if (temperatures.empty() && factors.empty()) return nullptr;
  const Location at = p.place(temperatures.empty() ? "Lescale" : "temperature");
  const Parameter* const light = p.find("Le");
  Ref<Component> glow;
  const double brightness = factors.empty() ? light_scale(reader, p) : reader.exposure;
  if (!temperatures.empty()) {
    if (light) throw Error("a medium has either 'Le' or a grid of temperatures", light->at);
    const auto [offset, factor] = temperatures_of(p);
    for (double& t : temperatures) t = (t - offset) * factor;
    glow = blackbody(reader, grid.map(reader, std::move(temperatures), p, "temperature"), brightness, at);
  } else if (light) {
    glow = reader.make("ConstantMap", at);
    const Color color = spectrum_of(reader, p, *light, Use::light);
    set_member(*glow, "value", brightness == 1 ? color : scaled_spectrum(brightness, color), at);
  } else {
    return nullptr;
  }
  if (factors.empty()) return glow;
  const Ref<Component> product = reader.make("MultiplyMap", at);
  set_member(*product, "first", glow, at);
  set_member(*product, "second", grid.map(reader, std::move(factors), p, "Lescale"), at);
  return product;
}

}  // namespace

// Density on a regular grid between p0 and p1, in the directive's coordinates; empty outside.
void make_grid(Reader& reader, const std::string& name, Parameters& p) {
  const Location at = p.at;
  const Grid grid(reader, p);
  std::vector<double> density = grid.take(p, "density");
  if (density.empty()) throw Error("a grid needs a density for each of its cells", p.place("density"));
  scale(density, p.number("scale", 1));
  const Ref<Component> glow = glow_of(reader, grid, p);
  const Ref<Component> medium = reader.make(glow ? "MapVolume" : "GridVolume", at, name);
  if (glow) {
    set_member(*medium, "density", grid.map(reader, std::move(density), p, "density"), at);
    set_member(*medium, "glow", glow, at);
  } else {
    set_member(*medium, "resolution", grid.resolution(), at);
    set_member(*medium, "density", Numbers{std::move(density), 1, Dimension::none}, at);
    set_member(*medium, "outside", "empty", at);
  }
  const Color absorption = coefficient(reader, p, "sigma_a", {0.0011, 0.0024, 0.014});
  set_member(*medium, "absorption", absorption, at);
  set_member(*medium, "scattering", coefficient(reader, p, "sigma_s", {2.55, 3.21, 3.77}), at);
  set_member(*medium, "anisotropy", p.number("g", 0), at);
  if (!glow) set_emission_of_medium(reader, *medium, p, absorption);
  place_medium(reader, name, medium, grid.placed(reader), p.place("p1"));
  reader.boxes[name] = grid.placed(reader);
}

// Each cell has its own RGB coefficients and emission.
void make_rgb_grid(Reader& reader, const std::string& name, Parameters& p) {
  const Location at = p.at;
  const Grid grid(reader, p);
  std::vector<double> absorption = grid.take(p, "sigma_a", 3), scattering = grid.take(p, "sigma_s", 3),
                      light = grid.take(p, "Le", 3);
  if (absorption.empty() && scattering.empty()) throw Error("a grid of RGB needs 'sigma_a', 'sigma_s' or both", at);
  if (absorption.empty() && !light.empty()) throw Error("a grid with 'Le' needs 'sigma_a'", p.place("Le"));
  const Ref<Component> medium = reader.make("MapVolume", at, name);
  set_member(*medium, "density", p.number("scale", 1), p.place("scale"));
  // If only one of them is given, the other is 1 within the box.
  if (absorption.empty() || scattering.empty()) set_member(*medium, "limited", true, at);
  const auto coefficients = [&](const char* member, std::vector<double>& values, const char* parameter) {
    if (values.empty())
      set_member(*medium, member, 1, at);
    else
      set_member(*medium, member, grid.map(reader, std::move(values), p, parameter), p.place(parameter));
  };
  coefficients("absorption", absorption, "sigma_a");
  coefficients("scattering", scattering, "sigma_s");
  set_member(*medium, "anisotropy", p.number("g", 0), at);
  if (!light.empty()) {
    scale(light, light_scale(reader, p) * pixel_of_one);
    set_member(*medium, "glow", grid.map(reader, std::move(light), p, "Le"), p.place("Le"));
  }
  place_medium(reader, name, medium, grid.placed(reader), p.place("p1"));
  reader.boxes[name] = grid.placed(reader);
}

// Density from a file, placed as the file states, and emission from its temperatures, if present.
void make_nanovdb(Reader& reader, const std::string& name, const Parameters& p) {
  const Location at = p.place("filename");
  const std::string path = reader.importing.file(p.text("filename"), at, p.folder);
  std::vector<std::string> grids;
  try {
    grids = nanovdb_grids(path);
  } catch (const Error& e) {
    throw Error("'" + path + "': " + e.what(), at);
  }
  if (!std::ranges::count(grids, "density")) throw Error("'" + path + "' holds no grid 'density'", at);
  const auto read_grid = [&](Component& part, const char* grid) {
    set_member(part, "file", FilePath{path, {}}, at);
    set_member(part, "grid_name", grid, at);
    set_member(part, "file_box", true, at);
    set_member(part, "outside", "empty", at);
  };
  const bool hot = std::ranges::count(grids, "temperature") > 0 && light_scale(reader, p) > 0;
  const Ref<Component> medium = reader.make(hot ? "MapVolume" : "GridVolume", p.at, name);
  if (hot) {
    const Ref<Component> density = reader.make("GridMap", at), values = reader.make("GridMap", at);
    read_grid(*density, "density");
    read_grid(*values, "temperature");
    Ref<Component> temperature = values;
    if (const auto [offset, factor] = temperatures_of(p); offset != 0 || factor != 1) {
      temperature = reader.make("RemapMap", at);
      set_member(*temperature, "input", values, at);
      set_member(*temperature, "from", Numbers{{offset, offset + 1}, 1, Dimension::none}, at);
      set_member(*temperature, "to", Numbers{{0, factor}, 1, Dimension::none}, at);
      set_member(*temperature, "clamped", false, at);
    }
    set_member(*medium, "density", density, at);
    set_member(*medium, "glow", blackbody(reader, temperature, light_scale(reader, p), at), at);
  } else {
    p.ignore({"temperatureoffset", "temperaturecutoff", "temperaturescale"});
    read_grid(*medium, "density");
  }
  set_scaled_coefficients(reader, *medium, p);
  set_member(*medium, "anisotropy", p.number("g", 0), p.at);
  place_medium(reader, name, medium, reader.state.ctm[0], p.at);
}

void make_cloud(Reader& reader, const std::string& name, const Parameters& p) {
  const Location at = p.at;
  const Ref<Component> cloud = reader.make("CloudMap", at), medium = reader.make("MapVolume", at, name);
  set_member(*cloud, "up", Numbers{{0, 1, 0}, 1, Dimension::none}, at);
  set_member(*cloud, "amount", p.number("density", 1), p.place("density"));
  set_member(*cloud, "frequency", p.number("frequency", 5), p.place("frequency"));
  set_member(*cloud, "wispiness", p.number("wispiness", 1), p.place("wispiness"));
  set_member(*medium, "density", cloud, at);
  set_scaled_coefficients(reader, *medium, p);
  set_member(*medium, "anisotropy", p.number("g", 0), at);
  const Grid box_of(reader, p);
  const DoublePoint3 &low = box_of.p0, &high = box_of.p1;
  set_member(*medium, "limited", true, at);
  set_member(*medium, "low", Numbers{{low.x, low.y, low.z}, 1, Dimension::none}, p.place("p0"));
  set_member(*medium, "high", Numbers{{high.x, high.y, high.z}, 1, Dimension::none}, p.place("p1"));
  reader.importing.inexact("the cloud is another one of the same kind: its noise has other random numbers", at);
  place_medium(reader, name, medium, reader.state.ctm[0], at);
  const Transform box = reader.state.ctm[0] * Transform::translate({low.x, low.y, low.z}) *
                        Transform::scale(DoubleVector3{high.x - low.x, high.y - low.y, high.z - low.z});
  if (box.valid()) reader.boxes[name] = box;
}

}  // namespace etendue::pbrt
