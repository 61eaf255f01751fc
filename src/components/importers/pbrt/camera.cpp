// Converts cameras.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/cameras/lens_system.h"
#include "reader.h"

namespace etendue::pbrt {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Places the camera so that its axes, left, up and forward, have the orientation `inner` in pbrt's camera space, where +x is
/// right, y up and z forward. An unmirrored camera, as in files that begin with "Scale -1 1 1", is given by `from`, `to` and
/// `up`; any other by a transform that mirrors. Returns the length of a unit of camera space in world units.
double set_placement(Reader& reader, Component& camera, const Transform& inner) {
  const Location at = reader.camera.parameters.at;
  std::vector<AnimatedTransform::Key> keys;
  double scale = 1;
  for (AnimatedTransform::Key key : reader.camera_to_world.keys()) {
    Transform::DoubleMatrix m = (key.transform * inner).exact();
    std::array<double, 3> length{};
    for (size_t c = 0; c < 3; ++c) length[c] = std::sqrt(m[c] * m[c] + m[4 + c] * m[4 + c] + m[8 + c] * m[8 + c]);
    const auto [least, most] = std::ranges::minmax(length);
    double skew = 0;
    for (size_t c = 0; c < 3; ++c) {
      const size_t d = (c + 1) % 3;
      skew = std::max(skew, std::abs(m[c] * m[d] + m[4 + c] * m[4 + d] + m[8 + c] * m[8 + d]) / (length[c] * length[d]));
    }
    if (most > least * 1.0005 || skew > 5e-4)
      reader.importing.inexact("the camera's transform stretches or shears, which is left out", at);
    scale = length[2];
    for (size_t r = 0; r < 3; ++r)
      for (size_t c = 0; c < 3; ++c) m[4 * r + c] /= length[c];
    // Makes the axes orthogonal, starting from the viewing direction.
    const DoubleVector3 z{m[2], m[6], m[10]}, up{m[1], m[5], m[9]}, left{m[0], m[4], m[8]};
    DoubleVector3 x = cross(up, z);
    const double l = std::sqrt(x.x * x.x + x.y * x.y + x.z * x.z);
    x = {x.x / l, x.y / l, x.z / l};
    const DoubleVector3 y = cross(z, x);
    if (left.x * x.x + left.y * x.y + left.z * x.z < 0) x = {-x.x, -x.y, -x.z};
    key.transform = Transform(Transform::DoubleMatrix{x.x, y.x, z.x, m[3], x.y, y.y, z.y, m[7], x.z, y.z, z.z, m[11]});
    keys.push_back(key);
  }
  const auto& m = keys[0].transform.exact();
  if (keys.size() == 1 && !keys[0].transform.flips()) {
    const auto set = [&](const char* member, double x, double y, double z) {
      set_member(camera, member, Numbers{{x, y, z}, 1, Dimension::none}, at);
    };
    set("from", m[3], m[7], m[11]);
    set("to", m[3] + m[2], m[7] + m[6], m[11] + m[10]);
    set("up", m[1], m[5], m[9]);
  } else {
    set_member(camera, "transform", AnimatedTransform(std::move(keys)), at);
  }
  return scale;
}

/// For cameras with a planar image.
const Transform to_the_left = Transform::scale({-1, 1, 1});

/// The visible part of the screen. Its units are distances for an orthographic camera; for a perspective camera the screen is
/// at the distance 1 / tan(fov / 2).
struct Window {
  double x = 0, y = 0;  ///< centre
  double half_width = 1, half_height = 1;
  bool plain = true;  ///< the default window: the shorter side has length 2, and the centre is the origin
};
Window window_of(Reader& reader) {
  const Parameters& p = reader.camera.parameters;
  const auto [width, height] = film_size(reader);
  const double pixels = double(width) / height, aspect = p.number("frameaspectratio", pixels);
  if (std::abs(aspect / pixels - 1) > 1e-6)
    reader.importing.inexact("pixels are squares: 'frameaspectratio' is left out", p.place("frameaspectratio"));
  Window w;
  w.half_width = std::max(pixels, 1.0);
  w.half_height = w.half_width / pixels;
  const std::vector<double>& given = p.numbers("screenwindow");
  if (given.empty()) return w;
  if (given.size() != 4 || !(given[0] < given[1] && given[2] < given[3]))
    throw Error("'screenwindow' must be xmin, xmax, ymin, ymax", p.place("screenwindow"));
  w.plain = std::abs((given[1] - given[0]) / 2 - w.half_width) < 1e-6;
  w.half_width = (given[1] - given[0]) / 2;
  w.half_height = (given[3] - given[2]) / 2;
  w.x = (given[0] + given[1]) / 2;
  w.y = (given[2] + given[3]) / 2;
  if (std::abs(w.x) < 1e-6 * w.half_width) w.x = 0;
  if (std::abs(w.y) < 1e-6 * w.half_height) w.y = 0;
  if (std::abs(w.half_width / w.half_height / pixels - 1) > 1e-3)
    reader.importing.inexact("pixels are squares: the screen window's height is left out", p.place("screenwindow"));
  return w;
}

Ref<Component> orthographic(Reader& reader) {
  const Parameters& p = reader.camera.parameters;
  const Ref<Component> camera = reader.make("OrthographicCamera", p.at);
  const Window window = window_of(reader);
  const double scale = set_placement(reader, *camera, Transform::translate({window.x, window.y, 0}) * to_the_left);
  set_member(*camera, "width", 2 * window.half_width * scale, p.at);
  if (p.number("lensradius", 0) > 0)
    reader.importing.inexact("an orthographic camera is sharp everywhere", p.place("lensradius"));
  p.ignore({"focaldistance"});
  return camera;
}

Ref<Component> perspective(Reader& reader) {
  const Parameters& p = reader.camera.parameters;
  const Ref<Component> camera = reader.make("PerspectiveCamera", p.at);
  const double scale = set_placement(reader, *camera, to_the_left);
  const Window window = window_of(reader);
  if (window.x != 0 || window.y != 0)
    set_member(*camera, "principal_point",
               Numbers{{-window.x / (2 * window.half_width), window.y / (2 * window.half_height)}, 1, Dimension::none}, p.at);
  double fov = p.number("fov", 90);
  if (const double half = p.number("halffov", -1); half > 0) fov = 2 * half;
  if (!(fov > 0 && fov < 180)) throw Error("'fov' must be more than 0 and less than 180", p.place("fov"));
  if (!window.plain) {
    fov = 2 * std::atan(std::tan(fov * pi / 360) * window.half_width) * 180 / pi;
    set_member(*camera, "fov_axis", "width", p.at);
  }
  set_member(*camera, "fov", fov, p.at);
  if (const double lens = p.number("lensradius", 0) * scale; lens > 0) {
    set_member(*camera, "lens_radius", lens, p.at);
    set_member(*camera, "focus_distance", p.number("focaldistance", 1e6) * scale, p.at);
  }
  p.ignore({"focaldistance"});
  return camera;
}

// v4's "spherical" with the mapping "equirectangular" and v3's "environment" map the image point (u, v) to the direction
// (sin(pi v) cos(2 pi u), cos(pi v), sin(pi v) sin(2 pi u)): the centre is -x, and the direction a little to the right of it
// turns to -z. v4's default, "equalarea", is Clarberg's equal-area square with y at the centre, x to the right and z downwards.
Ref<Component> spherical(Reader& reader, bool environment) {
  const Parameters& p = reader.camera.parameters;
  const Ref<Component> camera = reader.make("SphericalCamera", p.at);
  const std::string mapping = environment ? "equirectangular" : p.text("mapping", "equalarea");
  if (mapping != "equalarea" && mapping != "equirectangular")
    throw Error(fmt::format("there is no mapping '{}'{}", mapping, suggestion(mapping, {"equalarea", "equirectangular"})),
                p.place("mapping"));
  const bool square = mapping == "equalarea";
  using M = Transform::DoubleMatrix;
  set_placement(reader, *camera,
                Transform(square ? M{-1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0} : M{0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0}));
  if (square) set_member(*camera, "mapping", "equal_area", p.at);
  p.ignore({"lensradius", "focaldistance", "frameaspectratio", "screenwindow"});  // pbrt ignores them too
  return camera;
}

// The film is at the origin, the lens in front of it. A pixel measures the irradiance of the film: v4 weights samples by cos^4
// / (pdf on the exit pupil * its squared distance).
Ref<Component> realistic(Reader& reader) {
  const Parameters& p = reader.camera.parameters;
  const double stop = p.number("aperturediameter", 1), focus = p.number("focusdistance", 10);
  const std::optional<FilePath> file = image_file(reader, p, "lensfile");
  if (!file) {
    const Ref<Component> camera = reader.make("PerspectiveCamera", p.at);
    set_placement(reader, *camera, to_the_left);
    reader.importing.inexact("without its lens the camera is a pinhole of 40 degrees", p.at);
    p.forget();
    return camera;
  }
  const Ref<Component> camera = reader.make("LensCamera", p.at);
  const double scale = set_placement(reader, *camera, to_the_left);
  set_member(*camera, "file", *file, p.place("lensfile"));
  if (scale != 1) set_member(*camera, "unit", 1e-3 * scale, p.at);
  bool stops = false;
  try {
    const std::vector<LensSurface> surfaces = lens_surfaces(read_lens_file(file->resolved()), 1);
    for (size_t i = 0; i < surfaces.size(); ++i) {
      if (is_stop(surfaces, i))
        stops = true;
      else if (surfaces[i].radius == 0)
        reader.importing.inexact("a plane of glass refracts here, which pbrt takes for a stop", p.place("lensfile"));
    }
  } catch (const Error& e) {
    const std::string reason = e.what(), path = file->resolved();
    throw Error(reason.find(path) == std::string::npos ? fmt::format("'{}': {}", path, reason) : reason, p.place("lensfile"));
  }
  if (!(stop > 0 && focus > 0)) throw Error("'aperturediameter' and 'focusdistance' must be more than 0", p.at);
  if (stops) set_member(*camera, "aperture_diameter", stop * 1e-3 * scale, p.at);
  set_member(*camera, "focus_distance", focus * scale, p.at);
  set_member(*camera, "film_diagonal", reader.film.parameters.number("diagonal", 35) * 1e-3 * scale, p.at);
  if (const std::string shape = p.text("aperture"); !shape.empty())
    reader.importing.inexact(fmt::format("the stop is round, not '{}'", shape), p.place("aperture"));
  if (reader.version == 4) {
    set_member(*camera, "measures", "irradiance", p.at);
  } else if (p.boolean("simpleweighting", true)) {
    reader.importing.inexact(
        "the middle of the picture is as bright as what it shows; with 'simpleweighting' pbrt's is darker by the part of a "
        "rectangle "
        "that its exit pupil fills",
        p.at);
  } else {
    set_member(*camera, "measures", "irradiance", p.at);
    if (std::abs(p.number("shutterclose", 1) - p.number("shutteropen", 0) - 1) > 1e-6)
      reader.importing.inexact("the picture is as bright as of a shutter that is open for 1 s", p.at);
  }
  return camera;
}

Ref<Component> camera_of(Reader& reader) {
  const std::string& type = reader.camera.type;
  const Parameters& p = reader.camera.parameters;
  if (type == "perspective") return perspective(reader);
  if (type == "orthographic") return orthographic(reader);
  if (type == "spherical" || type == "environment") return spherical(reader, type == "environment");
  if (type == "realistic") return realistic(reader);
  throw Error(fmt::format("there is no camera '{}'{}", type,
                          suggestion(type, {"perspective", "orthographic", "realistic", "spherical", "environment"})),
              p.at);
}

}  // namespace

void set_camera(Reader& reader, Component& job) {
  Setting& s = reader.camera;
  const Parameters& p = s.parameters;
  if (s.type.empty()) s.type = "perspective";
  const Ref<Component> camera = camera_of(reader);
  set_member(*camera, "shutter_open", p.number("shutteropen", 0), p.at);
  set_member(*camera, "shutter_close", p.number("shutterclose", 1), p.at);
  if (s.given) p.tell_unused(reader.importing);
  set_member(job, "camera", camera, p.at);
}

}  // namespace etendue::pbrt
