// Sensors and films.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "converter.h"

namespace etendue::mitsuba {

namespace {

const std::vector<std::string> known_sensors = {"perspective",     "thinlens",     "orthographic",     "radiancemeter",
                                                "irradiancemeter", "fluencemeter", "telecentric",      "spherical",
                                                "distant",         "batch",        "perspective_rdist"};

Numbers three(double x, double y, double z) { return {{x, y, z}, 1, Dimension::none}; }

DoubleVector3 column(const Transform::DoubleMatrix& m, size_t i) { return {m[i], m[4 + i], m[8 + i]}; }

/// The transform without scale, which Mitsuba's cameras ignore.
Transform unstretched(const Transform& t) {
  const Transform::DoubleMatrix& m = t.exact();
  Transform::DoubleMatrix r = m;
  for (size_t i = 0; i < 3; ++i) {
    const double l = length(column(m, i));
    for (size_t row = 0; row < 3; ++row) r[4 * row + i] = l > 0 ? m[4 * row + i] / l : m[4 * row + i];
  }
  return Transform(r);
}

}  // namespace

void Converter::place(Component& camera, const Element& e) {
  const TransformValue t = e.transform();
  const Location at = e.location_of("to_world");
  if (t.look_at) {
    set_member(camera, "from", three(t.look_at->from.x, t.look_at->from.y, t.look_at->from.z), at);
    set_member(camera, "to", three(t.look_at->to.x, t.look_at->to.y, t.look_at->to.z), at);
    set_member(camera, "up", three(t.look_at->up.x, t.look_at->up.y, t.look_at->up.z), at);
  } else if (t.transform.animated()) {
    set_member(camera, "transform", t.transform, at);
  } else if (const Transform bare = unstretched(t.transform.still()); !bare.identity()) {
    set_member(camera, "transform", bare, at);
  }
}

Ref<Component> Converter::camera(const Element& e) {
  const Reading reading(e);
  if (const std::vector<const Element*> inner = e.all("sensor"); e.type == "batch" && !inner.empty()) {
    inexact(e, "of the sensors of a 'batch' the first takes the whole picture");
    return camera(*inner.front());
  }
  Ref<Component> made;
  if (e.type == "orthographic" || e.type == "telecentric") {
    made = make("OrthographicCamera", e);
    const Transform::DoubleMatrix m = e.transform().transform.still().exact();
    const double x = length(column(m, 0)), y = length(column(m, 1));
    set_member(*made, "width", 2 * x, e.location_of("to_world"));
    if (std::abs(x - y) > 1e-4 * x)
      importing_.inexact("the picture of an orthographic sensor is not stretched upwards", e.location_of("to_world"));
    if (e.type == "telecentric") inexact(e, "a telecentric lens is taken for a pinhole: all is sharp");
  } else if (e.type == "spherical") {
    made = make("SphericalCamera", e);
  } else {
    if (e.type != "perspective" && e.type != "thinlens") stand_in(e, known_sensors, "a perspective camera stands for it");
    made = make("PerspectiveCamera", e);
    set_view(*made, e);
    if (e.type == "thinlens") {
      set_member(*made, "lens_radius", e.number("aperture_radius", 0), e.location_of("aperture_radius"));
      set_member(*made, "focus_distance", e.number("focus_distance", 0), e.location_of("focus_distance"));
    }
  }
  place(*made, e);
  set_shutter(*made, e);
  set_clip(*made, e);
  e.ignore({"focus_distance", "srf"});
  return made;
}

/// The image side that the field of view refers to, under its name in this program.
std::string Converter::axis_of(const Element& e) {
  const std::string axis = e.string("fov_axis", "x");
  static const std::vector<std::string> axes = {"x", "y", "diagonal", "smaller", "larger"};
  if (std::ranges::find(axes, axis) == axes.end())
    throw Error(fmt::format("there is no axis '{}'{}", axis, suggestion(axis, axes)), e.location_of("fov_axis"));
  return axis == "x" ? "width" : axis == "y" ? "height" : axis;
}

/// The focal length [mm].
double Converter::focal_length(const Element& e) {
  const Property* p = e.find("focal_length");
  if (!p) return 50;
  std::string text = std::holds_alternative<std::string>(p->value) ? e.string("focal_length", "") : "";
  if (text.ends_with("mm")) text.resize(text.size() - 2);
  const double length = text.empty() ? e.number("focal_length", 50) : parse_number({text, p->at});
  if (!(length > 0)) throw Error("a focal length must be more than 0 mm", p->at);
  return length;
}

void Converter::set_view(Component& camera, const Element& e) {
  std::string axis = axis_of(e);
  const double fov = e.number("fov", 0);
  Location at = e.location_of("fov");
  const bool by_length = !e.has("fov");
  if (by_length) {
    at = e.location_of("focal_length");
    set_member(camera, "focal_length", focal_length(e) / 1000, at);  // of a film with the diagonal of 36 x 24 mm
    axis = "diagonal";
  }
  if (!by_length) set_member(camera, "fov", fov, at);
  set_member(camera, "fov_axis", axis, e.location_of("fov_axis"));
  const double x = e.number("principal_point_offset_x", 0), y = e.number("principal_point_offset_y", 0);
  if (x != 0 || y != 0)
    set_member(camera, "principal_point", Numbers{{-x, -y}, 1, Dimension::none}, e.location_of("principal_point_offset_x"));
}

// As here, Mitsuba's rays start at near_clip and end at far_clip. If a file states neither, Mitsuba clips what is nearer than
// 0.01 or farther than 10000; here nothing is clipped (docs/coming-from-mitsuba.md).
void Converter::set_clip(Component& camera, const Element& e) {
  if (!e.has("near_clip") && !e.has("far_clip")) return;
  if (!camera.class_info().find("near_clip")) {
    importing_.inexact(fmt::format("a {} leaves out nothing that is near or far", camera.class_info().name),
                       e.location_of(e.has("near_clip") ? "near_clip" : "far_clip"));
    e.ignore({"far_clip"});
    return;
  }
  double nearest = e.number("near_clip", 0.01), farthest = e.number("far_clip", 1e4);
  if (!(nearest > 0)) throw Error("near_clip must be more than 0", e.location_of("near_clip"));
  if (!(farthest > nearest))
    throw Error("far_clip must be more than near_clip", e.location_of(e.has("far_clip") ? "far_clip" : "near_clip"));
  if (camera.class_info().name == "OrthographicCamera") {  // the transform scales near_clip, but not the depth behind it
    const double stretch = length(column(e.transform().transform.still().exact(), 2));
    farthest += nearest * (stretch - 1);
    nearest *= stretch;
  }
  if (e.has("near_clip")) set_member(camera, "near_clip", nearest, e.location_of("near_clip"));
  if (e.has("far_clip")) set_member(camera, "far_clip", farthest, e.location_of("far_clip"));
}

void Converter::set_shutter(Component& camera, const Element& e) {
  if (e.has("shutter_open")) set_member(camera, "shutter_open", e.number("shutter_open", 0), e.location_of("shutter_open"));
  const double close = e.number("shutter_close", e.number("shutter_open", 0));
  if (e.has("shutter_close")) set_member(camera, "shutter_close", close, e.location_of("shutter_close"));
}

Ref<Component> Converter::image(const Element* film) {
  constexpr int width = 768, height = 576;  // Mitsuba's defaults
  Ref<Component> image = film ? make("ImageBuffer", *film) : importing_.make("ImageBuffer", importing_.at());
  const Location at = film ? film->at : importing_.at();
  if (film) {
    film->read = true;
    const std::int64_t w = film->integer("width", width), h = film->integer("height", height);
    set_member(*image, "width", double(w), film->location_of("width"));
    set_member(*image, "height", double(h), film->location_of("height"));
    if (film->has("crop_width") || film->has("crop_height") || film->has("crop_offset_x") || film->has("crop_offset_y")) {
      const double x = double(film->integer("crop_offset_x", 0)), y = double(film->integer("crop_offset_y", 0));
      set_member(*image, "crop",
                 Numbers{{x, y, x + double(film->integer("crop_width", w)), y + double(film->integer("crop_height", h))},
                         1,
                         Dimension::none},
                 film->location_of("crop_width"));
    }
    if (const Ref<Component> f = filter(*film)) set_member(*image, "filter", f, film->at);
  } else {
    set_member(*image, "width", width, at);
    set_member(*image, "height", height, at);
  }
  if (!image->class_info().find("filter")) return image;
  if (!film || film->all("rfilter").empty()) {
    Ref<Component> gaussian = importing_.make("GaussianFilter", at);
    set_member(*gaussian, "radius", 2, at);
    set_member(*image, "filter", gaussian, at);
  }
  return image;
}

Ref<Component> Converter::filter(const Element& film) {
  const std::vector<const Element*> filters = film.all("rfilter");
  if (filters.empty()) return nullptr;
  const Element& e = *filters.front();
  const Reading reading(e);
  Ref<Component> filter;
  if (e.type == "box") {
    filter = make("BoxFilter", e);
    if (e.has("radius")) set_member(*filter, "radius", e.number("radius", 0.5), e.location_of("radius"));
  } else if (e.type == "tent") {
    filter = make("TriangleFilter", e);
    if (e.has("radius")) set_member(*filter, "radius", e.number("radius", 1), e.location_of("radius"));
  } else if (e.type == "gaussian") {
    filter = make("GaussianFilter", e);
    const double deviation = e.number("stddev", 0.5);
    set_member(*filter, "deviation", deviation, e.location_of("stddev"));
    set_member(*filter, "radius", 4 * deviation, e.location_of("stddev"));
  } else if (e.type == "mitchell" || e.type == "catmullrom") {
    filter = make("MitchellFilter", e);
    const bool mitchell = e.type == "mitchell";
    set_member(*filter, "b", mitchell ? e.number("b", 1. / 3) : 0, e.at);
    set_member(*filter, "c", mitchell ? e.number("c", 1. / 3) : 0.5, e.at);
  } else if (e.type == "lanczos") {
    filter = make("LanczosFilter", e);
    set_member(*filter, "radius", double(e.integer("lobes", 3)), e.location_of("lobes"));
  } else {
    stand_in(e, {"box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"}, "a Gaussian stands for it");
    filter = make("GaussianFilter", e);
    set_member(*filter, "radius", 2, e.at);
  }
  return filter;
}

void Converter::add_outputs(Component& job, const Element* film) {
  static const std::vector<std::string> known_films = {"hdrfilm", "ldrfilm", "specfilm", "mfilm", "tiledhdrfilm"};
  if (!film) return;
  if (std::ranges::find(known_films, film->type) == known_films.end())
    stand_in(*film, known_films, "it is taken for 'hdrfilm'");
  film->ignore({"sample_border", "high_quality_edges", "banner", "label", "attach_log", "compensate", "variable"});
  if (const std::string channels = film->string("pixel_format", "rgb"); channels != "rgb")
    importing_.inexact(channels.ends_with("a")
                           ? "a picture has no alpha: its channels are those of its output, red, green and blue"
                           : fmt::format("a picture in '{}' is written as red, green and blue", channels),
                       film->location_of("pixel_format"));
  Value::List outputs;
  if (film->type == "ldrfilm") {
    Ref<Component> tone_map = make("ExposureToneMap", *film, "");
    if (film->has("exposure")) set_member(*tone_map, "stops", film->number("exposure", 0), film->location_of("exposure"));
    const double gamma = film->number("gamma", -1);
    if (gamma == 2.2)
      set_member(*tone_map, "transfer", "gamma2.2", film->location_of("gamma"));
    else if (gamma == 1)
      set_member(*tone_map, "transfer", "linear", film->location_of("gamma"));
    else if (gamma > 0)
      importing_.inexact(fmt::format("a gamma of {} is taken for sRGB's", gamma), film->location_of("gamma"));
    if (film->string("tonemap_method", "gamma") != "gamma")
      importing_.inexact("the tone map is exposure and gamma alone", film->location_of("tonemap_method"));
    set_member(job, "tone_map", tone_map, film->at);
    const std::string format = film->string("file_format", "png");
    if (format != "png")
      importing_.inexact(fmt::format("a picture in '{}' is written as PNG", format), film->location_of("file_format"));
    outputs.emplace_back(make("PngOutput", *film, ""), film->at);
    film->ignore({"key", "burn"});
  } else {
    if (film->type == "specfilm" || film->type == "mfilm")
      inexact(*film, fmt::format("film '{}' is taken for 'hdrfilm'", film->type));
    const std::string format = film->string("file_format", "openexr");
    if (format != "openexr" && format != "rgbe" && format != "exr")
      importing_.inexact(fmt::format("a picture in '{}' is written as OpenEXR", format), film->location_of("file_format"));
    Ref<Component> output = make(format == "rgbe" ? "HdrOutput" : "ExrOutput", *film, "");
    const std::string component = film->string("component_format", "float16");
    if (component != "float16" && component != "float32")
      importing_.inexact(fmt::format("a component_format of '{}' becomes 32-bit floats", component),
                         film->location_of("component_format"));
    if (format != "rgbe" && component == "float16")
      set_member(*output, "precision", "half", film->location_of("component_format"));
    outputs.emplace_back(output, film->at);
  }
  set(job, "outputs", Value(std::move(outputs), film->at));
}

}  // namespace etendue::mitsuba
