// Heterogeneous media, whose coefficients are stored on grids.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "components/volumes/volume_grid.h"
#include "converter.h"
#include "etendue/describe/color.h"

namespace etendue::mitsuba {

Ref<Component> Converter::heterogeneous(const Element& e, const Component& body, const Element* glow) {
  const char* const name = e.has("sigma_t") ? "sigma_t" : "density";  // "density" is the name in 0.5
  const Element *const volume = e.nested(name), *albedo = e.nested("albedo");
  if (albedo && albedo->tag != "volume") albedo = nullptr;
  std::optional<Reading> of_volume, of_albedo;
  if (volume) of_volume.emplace(*volume);
  if (albedo && albedo != volume) of_albedo.emplace(*albedo);
  const bool even = !volume || volume->type == "constvolume", albedos = albedo && albedo->type == "gridvolume";
  if (!even && volume->type != "gridvolume") {
    inexact(*volume, fmt::format("volume '{}' is not known here: the medium is left out", volume->type));
    volume->dismiss();
    e.dismiss();
    return nullptr;
  }
  const std::optional<GridPlace> place = even ? std::nullopt : std::optional(place_of_grid(*volume));
  const bool apart = place && place->apart;
  const double scale = e.number("scale", 1);
  const Color all_of_it = even ? scaled_spectrum(scale, medium_color(e, name, 1)) : flat_spectrum(float(scale));
  const bool of_maps = glow || apart || (albedos && (even || !same_place(*albedo, *volume)));
  const bool boxed = !even || !e.old;  // before version 2 a constant volume had no bounds
  const Location at = e.location_of(name);
  if (!boxed && !of_maps) return even_everywhere(e, all_of_it);
  // If the cells do not fill the box, the box bounds the medium, and the maps are placed in its space.
  const Ref<Component> frame = apart ? make("Box", e, "") : nullptr;
  if (frame) set_member(*frame, "transform", place->box, at);
  const Component& object = frame ? *frame : body;
  Ref<Component> medium = make(of_maps ? "MapVolume" : "GridVolume", e);
  if (of_maps) {
    // Emission must end with the box too, so the box becomes the density map; a box that is stated in the file is known to the
    // grid alone.
    if (apart) {
      set_member(*medium, "limited", true, at);
      set_member(*medium, "placement", to_world_of(body).inverse() * place->box, at);
    } else if (boxed && (even || !place->by_file)) {
      set_member(*medium, "density", box_of(e, volume, object), at);
    }
    Ref<Component> extinction;
    if (!even) {
      const Ref<Component> grid = make("GridMap", *volume);
      set_grid(*grid, *volume, object);
      set_member(*grid, "outside", apart ? beyond_grid(*volume) : "cut", at);
      extinction = make("MultiplyMap", e, "");
      set_member(*extinction, "first", grid, at);
      set_member(*extinction, "second", all_of_it, e.location_of("scale"));
    }
    set(*medium, "extinction", even ? Value(all_of_it, at) : Value(extinction, at));
  } else {
    set_member(*medium, "extinction", all_of_it, e.location_of("scale"));
    if (even)
      place_box(*medium, e, nullptr, object);
    else
      set_grid(*medium, *volume, object);
    set_member(*medium, "outside", "cut", at);  // the medium ends with the box, whatever the grid's wrap mode
  }
  if (!even) beyond_grid(*volume);
  set_albedo(*medium, e, albedo, object);
  set_phase(*medium, e);
  if (glow) shine(*medium, *glow, object);
  for (const Element* grid : {volume, albedo})
    if (grid) grid->ignore({"raw", "accel", "send_data"});
  return medium;
}

/// The medium for a heterogeneous medium of version 0.x with constant volumes: it fills its shape.
Ref<Component> Converter::even_everywhere(const Element& e, const Color& extinction) {
  Ref<Component> medium = make("HomogeneousVolume", e);
  set_member(*medium, "extinction", extinction, e.at);
  set_member(*medium, "albedo", medium_color(e, "albedo", 0.75), e.at);
  set_phase(*medium, e);
  return medium;
}

/// A map that is 1 in the box of a heterogeneous medium and 0 outside. `volume`: the nested volume 'sigma_t', or null.
Ref<Component> Converter::box_of(const Element& e, const Element* volume, const Component& object) {
  Ref<Component> box = make("GridMap", e, "");
  place_box(*box, e, volume && volume->type == "gridvolume" ? volume : nullptr, object);
  set_member(*box, "outside", "cut", e.at);
  return box;
}

void Converter::place_box(Component& box, const Element& e, const Element* grid, const Component& object) {
  const Transform to_world = grid ? place_of_grid(*grid).box : box_of_constant(e);
  const Transform placement = to_world_of(object).inverse() * to_world;
  if (!placement.identity()) set_member(box, "placement", placement, e.at);
}

/// Whether two grids have the same placement and filter.
bool Converter::same_place(const Element& a, const Element& b) {
  // The boxes stated in two files may differ.
  if (a.boolean("use_grid_bbox", false) && file(a).resolved() != file(b).resolved()) return false;
  return a.transform().transform.still().exact() == b.transform().transform.still().exact() &&
         a.boolean("use_grid_bbox", false) == b.boolean("use_grid_bbox", false) &&
         a.string("filter_type", "trilinear") == b.string("filter_type", "trilinear");
}

/// `volume`: the volume of the albedo; null: the albedo is a property of the medium itself.
void Converter::set_albedo(Component& medium, const Element& e, const Element* volume, const Component& object) {
  if (!volume || volume->type != "gridvolume") {
    set_member(medium, "albedo", medium_color(e, "albedo", 0.75), e.location_of("albedo"));
  } else if (medium.class_info().name == "MapVolume") {
    const Ref<Component> grid = make("GridMap", *volume);
    set_grid(*grid, *volume, object);
    set_member(*grid, "outside", beyond_grid(*volume), volume->at);
    const Ref<Component> read = make("ReadAsMap", *volume, "");  // Mitsuba does not treat colours in grids as surface colours
    set_member(*read, "map", grid, volume->at);
    set_member(*read, "as", "coefficient", volume->at);
    set_member(medium, "albedo", read, volume->at);
  } else {
    set_member(medium, "albedo", 1, volume->at);
    set_member(medium, "albedo_file", file(*volume), volume->location_of("filename"));
    set_member(medium, "albedo_as", "coefficient", volume->at);
    volume->ignore({"wrap_mode"});
  }
}

// In Mitsuba a heterogeneous medium ends with the axis-aligned world-space bounding box of its 'sigma_t', even if that is
// constant.
Transform Converter::box_of_constant(const Element& medium) {
  const Element* const volume = medium.nested("sigma_t");
  const Bounds3 box = (volume ? volume->transform().transform.still() : Transform())(Bounds3{Point3{0, 0, 0}, Point3{1, 1, 1}});
  const Vector3 size = box.high - box.low;
  return Transform::translate({box.low.x, box.low.y, box.low.z}) * Transform::scale({size.x, size.y, size.z});
}

Transform Converter::to_world_of(const Component& object) {
  const Value transform = get(object, "transform");
  const auto* placed = transform.as<AnimatedTransform>();
  const auto* still = transform.as<Transform>();
  return placed ? placed->still() : (still ? *still : Transform());
}

/// Sets the file of a grid and its placement.
void Converter::set_grid(Component& grid, const Element& volume, const Component& object) {
  const GridPlace place = place_of_grid(volume);
  set_member(grid, "file", file(volume), volume.location_of("filename"));
  const Transform placement = to_world_of(object).inverse() * place.cells;
  if (!placement.identity()) set_member(grid, "placement", placement, volume.location_of("to_world"));
  if (place.by_file && !place.apart) set_member(grid, "file_box", true, volume.at);
  set_member(grid, "filter", volume.string("filter_type", "trilinear"), volume.location_of("filter_type"));
}

namespace {

Transform from_unit_cube(const DoublePoint3& low, const DoublePoint3& high) {
  return Transform::translate({low.x, low.y, low.z}) * Transform::scale({high.x - low.x, high.y - low.y, high.z - low.z});
}

DoublePoint3 exact(const Point3& p) { return {double(p.x), double(p.y), double(p.z)}; }

/// Whether the transform maps coordinate axes to coordinate axes.
bool along_axes(const Transform& t) {
  const Transform::DoubleMatrix& m = t.exact();
  for (size_t row = 0; row < 3; ++row) {
    double largest = 0, sum = 0;
    for (size_t i = 0; i < 3; ++i) {
      largest = std::max(largest, std::abs(m[4 * row + i]));
      sum += std::abs(m[4 * row + i]);
    }
    if (sum > largest * (1 + 1e-5)) return false;
  }
  return true;
}

}  // namespace

std::string Converter::beyond_grid(const Element& volume) {
  if (volume.old) return "cut";
  const std::string wrap = volume.string("wrap_mode", "clamp");
  if (wrap != "clamp" && wrap != "repeat" && wrap != "mirror")
    throw Error(fmt::format("there is no wrap mode '{}'{}", wrap, suggestion(wrap, {"clamp", "repeat", "mirror"})),
                volume.location_of("wrap_mode"));
  return wrap;
}

VolumeGrid Converter::read_grid(const Element& volume) {
  const std::string path = file(volume).resolved();
  try {
    return read_volume_grid(path);
  } catch (const Error& e) {
    throw Error("'" + path + "': " + e.what(), volume.location_of("filename"));
  }
}

// Version 0.x stores grid values at the corners of cells, of which there is one less than values along each axis, and the
// medium is empty outside the box that the file states, or the box from 'min' to 'max'. Version 3 stores them at the centres of
// cells, which fill the unit cube unless the file's box is requested; the medium ends with the world-space axis-aligned
// bounding box of the grid, and up to there 'wrap_mode' continues the grid.
Converter::GridPlace Converter::place_of_grid(const Element& volume) {
  if (const auto known = places_.find(&volume); known != places_.end()) return known->second;
  GridPlace place;
  const Transform to_world = volume.transform().transform.still();
  place.cells = place.box = to_world;
  place.by_file = volume.boolean("use_grid_bbox", volume.old);
  if (volume.old) {
    const VolumeGrid grid = read_grid(volume);
    DoublePoint3 low = exact(grid.low), high = exact(grid.high);
    if (volume.has("min") && volume.has("max")) {
      const DoubleVector3 from = volume.vector("min", {}), to = volume.vector("max", {});
      low = {from.x, from.y, from.z};
      high = {to.x, to.y, to.z};
    }
    DoublePoint3 first = low, last = high;  // the box whose cells have the values at their centres
    const auto widen = [&](int values, double& from, double& to) {
      if (!(to > from)) throw Error("the box of this grid has no volume", volume.location_of("filename"));
      if (values < 2) inexact(volume, "a grid of one value along an axis is empty in Mitsuba 0.x: here it fills its box");
      const double half = values < 2 ? 0 : (to - from) / (2 * double(values - 1));
      from -= half;
      to += half;
    };
    widen(grid.size[0], first.x, last.x);
    widen(grid.size[1], first.y, last.y);
    widen(grid.size[2], first.z, last.z);
    place.box = to_world * from_unit_cube(low, high);
    place.cells = to_world * from_unit_cube(first, last);
    place.apart = true;
  } else if (!along_axes(to_world)) {
    if (place.by_file) {
      const VolumeGrid grid = read_grid(volume);
      place.cells = to_world * from_unit_cube(exact(grid.low), exact(grid.high));
    }
    const Bounds3 around = place.cells(Bounds3{Point3{0, 0, 0}, Point3{1, 1, 1}});
    place.box = from_unit_cube(exact(around.low), exact(around.high));
    place.apart = true;
  }
  places_.emplace(&volume, place);
  return place;
}

std::optional<Transform> Converter::grid_box(const Element& medium) {
  const Element* const volume = medium.nested(medium.has("sigma_t") ? "sigma_t" : "density");
  if (medium.type != "heterogeneous" || !volume || volume->type != "gridvolume") return std::nullopt;
  const GridPlace place = place_of_grid(*volume);
  if (place.apart || !place.by_file) return place.box;
  const VolumeGrid grid = read_grid(*volume);
  return place.box * from_unit_cube(exact(grid.low), exact(grid.high));
}

}  // namespace etendue::mitsuba
