// Writes participating media.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "components/exporters/asked_members.h"
#include "writer.h"

namespace etendue::mitsuba_export {

void Writer::medium(Node of, const Component& v, const char* name, const Transform& placed) {
  if (class_of(v) == "GridVolume") return grid_medium(of, v, name, placed);
  if (class_of(v) == "MapVolume" && map_medium(of, v, name, placed)) return;
  if (class_of(v) != "HomogeneousVolume") {
    exporting.inexact(fmt::format("a medium like {} is left out", class_of(v)), &v);
    return;
  }
  Node n = plugin(of, "medium", "homogeneous");
  n.append_attribute("name") = name;
  if (const Color extinction = color_of(v, "extinction")) {
    // Mitsuba refuses components above 1.
    const auto rgb = written_rgb(extinction);
    const double largest = rgb ? std::max(1.0, *std::ranges::max_element(*rgb)) : 1;
    if (largest > 1) number(n, "scale", largest);
    spectrum(n, "sigma_t", largest > 1 ? scaled_spectrum(1 / largest, extinction) : extinction, ColorUse::coefficient);
    spectrum(n, "albedo", color_of(v, "albedo"), ColorUse::reflectance);
  } else {
    const Color a = color_of(v, "absorption"), s = color_of(v, "scattering");
    std::string total, albedo;
    bool scatters = false;
    for (int nm = 360; nm <= 830; nm += 5) {
      const double absorbed = double(a->at(float(nm), ColorUse::coefficient)),
                   scattered = double(s->at(float(nm), ColorUse::coefficient));
      const double sum = absorbed + scattered;
      scatters = scatters || scattered > 0;
      total += fmt::format("{}{}:{:.7g}", nm > 360 ? ", " : "", nm, sum);
      albedo += fmt::format("{}{}:{:.7g}", nm > 360 ? ", " : "", nm, sum > 0 ? scattered / sum : 0);
    }
    value(n, "spectrum", "sigma_t", total);
    value(n, "spectrum", "albedo", scatters ? albedo : "0");  // Mitsuba refuses a table of zeros
  }
  phase_of(n, v);
}

void Writer::phase_of(Node n, const Component& v) {
  if (const Ref<Component> phase = part_of(v, "phase")) {
    phase_function(n, *phase);
  } else {
    henyey_greenstein(n, number_of(v, "anisotropy"));
  }
}

void Writer::henyey_greenstein(Node parent, double g) {
  Node phase = plugin(parent, "phase", g == 0 ? "isotropic" : "hg");
  if (g != 0) number(phase, "g", g);
}

void Writer::phase_function(Node parent, const Component& p) {
  const std::string& kind = class_of(p);
  if (kind == "RayleighPhase") {
    if (number_of(p, "depolarization") > 0) exporting.inexact("particles that depolarize are round in Mitsuba", &p);
    plugin(parent, "phase", "rayleigh");
  } else if (kind == "BlendPhase") {
    Node blend = plugin(parent, "phase", "blendphase");
    number(blend, "weight", number_of(p, "amount"));
    for (const char* part : {"first", "second"}) phase_function(blend, *part_of(p, part));
  } else if (kind == "TabulatedPhase" && numbers_of(p, "cosines").empty()) {
    Node table = plugin(parent, "phase", "tabphase");
    std::string values;
    for (const double value : numbers_of(p, "values")) values += fmt::format("{}{}", values.empty() ? "" : ", ", value);
    text(table, "values", values);
  } else {
    if (kind != "HenyeyGreensteinPhase")
      exporting.inexact(fmt::format("{} becomes one lobe of the same mean cosine", kind), &p);
    henyey_greenstein(parent, mean_cosine_of(p));
  }
}

namespace {

/// A grid in Mitsuba's volume format: floats, x fastest.
std::string vol_of(const VolumeGrid& grid) {
  std::string bytes = "VOL\3";
  const auto put = [&](auto number) {
    char raw[sizeof number];
    std::memcpy(raw, &number, sizeof number);
    bytes.append(raw, sizeof number);
  };
  put(std::int32_t(1));
  for (const int n : grid.size) put(std::int32_t(n));
  put(std::int32_t(grid.channels));
  for (const Point3& corner : {grid.low, grid.high})
    for (int k = 0; k < 3; ++k) put(corner[k]);
  bytes.append(reinterpret_cast<const char*>(grid.values.data()), grid.values.size() * sizeof(float));
  return bytes;
}

/// The value of a coefficient that is constant over wavelengths; negative: it is not.
double same_everywhere(const Color& c) {
  const double first = double(c->at(550, ColorUse::coefficient));
  for (float nm = 360; nm <= 830; nm += 10)
    if (std::abs(double(c->at(nm, ColorUse::coefficient)) - first) > 1e-5 * std::abs(first)) return -1;
  return first;
}

/// The densities of a GridVolume or a GridMap; `written`: the name of the member with inline values.
VolumeGrid densities_of(const Component& v, const char* written = "density") {
  if (const std::string file = word_of(v, "file"); !file.empty()) return read_volume_grid(file, word_of(v, "grid_name"));
  VolumeGrid grid;
  const std::vector<double> size = numbers_of(v, "resolution"), values = numbers_of(v, written);
  for (size_t k = 0; k < 3; ++k) grid.size[k] = int(size[k]);
  grid.values.assign(values.begin(), values.end());
  const size_t cells = size_t(grid.size[0]) * size_t(grid.size[1]) * size_t(grid.size[2]);
  if (values.size() != cells && values.size() != 3 * cells) throw Error("the numbers of this grid do not fill it");
  grid.channels = values.size() == cells ? 1 : 3;
  return grid;
}

bool along_axes(const Transform& t) {
  const auto& m = t.exact();
  for (size_t row = 0; row < 3; ++row) {
    const double x = std::abs(m[4 * row]), y = std::abs(m[4 * row + 1]), z = std::abs(m[4 * row + 2]);
    if (x + y + z > std::max({x, y, z}) * (1 + 1e-5)) return false;
  }
  return true;
}

/// The grid, if a map is a grid times a number; null: it is not.
Ref<Component> grid_of_product(const Component& map, double& factor) {
  factor = 1;
  if (class_of(map) != "MultiplyMap" || part_of(map, "third")) return nullptr;
  const Ref<Component> grid = part_of(map, "first"), other = part_of(map, "second");
  const Color c = other ? constant_of(*other) : nullptr;
  if (!grid || class_of(*grid) != "GridMap" || !c) return nullptr;
  factor = same_everywhere(c);
  return factor < 0 ? nullptr : grid;
}

}  // namespace

void Writer::grid(Node medium, const char* name, const VolumeGrid& grid, bool by_file, const Component& v,
                  const Transform& placed) {
  Node n = plugin(medium, "volume", "gridvolume");
  n.append_attribute("name") = name;
  text(n, "filename", exporting.write_beside("grid", "vol", vol_of(grid)));
  if (by_file) truth(n, "use_grid_bbox", true);
  if (word_of(v, "filter") == "nearest") text(n, "filter_type", "nearest");
  if (const std::string outside = word_of(v, "outside"); outside == "repeat" || outside == "mirror")
    text(n, "wrap_mode", outside);
  transform(n, "to_world", placed * still(transform_of(v, "placement"), v));
}

// In Mitsuba a medium ends with the world-space axis-aligned bounding box of its densities.
void Writer::grid_medium(Node of, const Component& v, const char* name, const Transform& placed) {
  const Color given = color_of(v, "extinction"), a = color_of(v, "absorption"), s = color_of(v, "scattering");
  const double scattered = given ? 0 : same_everywhere(s), absorbed = given ? 0 : same_everywhere(a),
               whole = given ? same_everywhere(given) : scattered + absorbed;
  const auto leave_out = [&](const char* why) {
    exporting.inexact(fmt::format("a medium on a grid is left out {}", why), &v);
    for (const Member& m : v.class_info().members) AskedMembers::note(v, m.name);  // one warning is enough
  };
  if (whole < 0 || scattered < 0 || absorbed < 0) return leave_out("whose extinction differs from wavelength to wavelength");
  VolumeGrid densities, albedos;
  const std::string albedo = word_of(v, "albedo_file");
  try {
    densities = densities_of(v);
    if (!albedo.empty()) albedos = read_volume_grid(albedo);
  } catch (const Error&) {
    return leave_out("whose numbers cannot be read");
  }
  if (densities.channels != 1) return leave_out("whose densities are coloured");
  const bool by_file = truth_of(v, "file_box") && !word_of(v, "file").empty();
  Node n = plugin(of, "medium", "heterogeneous");
  n.append_attribute("name") = name;
  grid(n, "sigma_t", densities, by_file, v, placed);
  number(n, "scale", whole);
  if (!albedo.empty()) {
    albedos.low = densities.low;
    albedos.high = densities.high;
    grid(n, "albedo", albedos, by_file, v, placed);
  } else if (given) {
    spectrum(n, "albedo", color_of(v, "albedo"), ColorUse::reflectance);
  } else {
    number(n, "albedo", whole > 0 ? scattered / whole : 0);
  }
  phase_of(n, v);
  if (word_of(v, "outside") != "cut")
    exporting.inexact("a medium on a grid ends with the grid's box in Mitsuba", &v, "outside");
  if (!along_axes(placed * still(transform_of(v, "placement"), v)))
    exporting.inexact("a grid that is turned fills a box along the world's axes in Mitsuba, with what is at its border", &v);
}

// Writes a MapVolume of the form that the importer makes from a Mitsuba medium whose grid is rotated, or whose albedo has
// another placement.
bool Writer::map_medium(Node of, const Component& v, const char* name, const Transform& outer) {
  const Ref<Component> extinction = part_of(v, "extinction"), density = part_of(v, "density"), albedo = part_of(v, "albedo");
  double scale = 1;
  const Ref<Component> map = extinction ? grid_of_product(*extinction, scale) : nullptr;
  if (!map || !density || !albedo) return false;
  const bool limited = truth_of(v, "limited");
  const Color even = constant_of(*albedo), everywhere = constant_of(*density);
  const bool boxed = !limited && class_of(*density) == "GridMap" && word_of(*density, "outside") == "cut" &&
                     word_of(*density, "file").empty() && numbers_of(*density, "values") == std::vector<double>{1};
  if ((!even && class_of(*albedo) != "GridMap") || (!boxed && !(everywhere && same_everywhere(everywhere) == 1))) return false;
  VolumeGrid densities, albedos;
  try {
    densities = densities_of(*map, "values");
    if (!even) albedos = densities_of(*albedo, "values");
  } catch (const Error&) {
    return false;
  }
  if (densities.channels != 1) return false;
  const Transform placed = outer * still(transform_of(v, "placement"), v);
  const auto by_file = [](const Component& grid) { return truth_of(grid, "file_box") && !word_of(grid, "file").empty(); };
  Node n = plugin(of, "medium", "heterogeneous");
  n.append_attribute("name") = name;
  grid(n, "sigma_t", densities, by_file(*map), *map, placed);
  number(n, "scale", scale);
  if (even)
    spectrum(n, "albedo", even, ColorUse::reflectance);
  else
    grid(n, "albedo", albedos, by_file(*albedo), *albedo, placed);
  phase_of(n, v);
  Bounds3 ends{{0, 0, 0}, {1, 1, 1}}, there = ends;
  if (by_file(*map)) ends = there = {densities.low, densities.high};
  there = (placed * still(transform_of(*map, "placement"), *map))(there);
  if (boxed || limited) {
    const Transform box = boxed ? placed * still(transform_of(*density, "placement"), *density) : placed;
    const std::vector<double> low = numbers_of(v, "low"), high = numbers_of(v, "high");
    const Bounds3 own = boxed ? Bounds3{{0, 0, 0}, {1, 1, 1}}
                              : Bounds3{{float(low[0]), float(low[1]), float(low[2])},  //
                                        {float(high[0]), float(high[1]), float(high[2])}};
    ends = along_axes(box) ? box(own) : Bounds3{};
  }
  const float far = 1e-4f * length(there.diagonal());
  if ((!boxed && !limited && word_of(*map, "outside") != "cut") || ends.empty() ||
      ((boxed || limited) && (length(ends.low - there.low) > far || length(ends.high - there.high) > far)))
    exporting.inexact("a medium on a grid ends with the box around its densities in Mitsuba", &v);
  return true;
}

}  // namespace etendue::mitsuba_export
