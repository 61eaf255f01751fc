// Camera, film and filter.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "reader.h"

namespace etendue::pbrt {

namespace {

constexpr double pi = 3.14159265358979323846;

struct Size {
  int width, height;
};
Size resolution(const Reader& reader) {
  const Parameters& p = reader.film.parameters;
  const bool v3 = reader.version == 3;
  Size size{p.integer("xresolution", v3 ? 640 : 1280), p.integer("yresolution", v3 ? 480 : 720)};
  for (const auto& [name, pixels] : {std::pair("xresolution", size.width), std::pair("yresolution", size.height)})
    if (pixels < 1 || pixels > 65536) throw Error(fmt::format("'{}' must be from 1 to 65536", name), p.place(name));
  return size;
}

/// pbrt's camera looks along +z with +x to the right; ours has +x to the left. A camera that is not mirrored against ours, as
/// in files that begin with "Scale -1 1 1", is said by three points, another by a transform that mirrors.
double set_placement(Reader& reader, Component& camera) {
  const Location at = reader.camera.parameters.at;
  std::vector<AnimatedTransform::Key> keys;
  double scale = 1;
  for (AnimatedTransform::Key key : reader.camera_to_world.keys()) {
    Transform::DoubleMatrix m = key.transform.exact();
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
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 3; ++c) m[4 * r + c] /= length[c];
      m[4 * r] = -m[4 * r];
    }
    // At right angles exactly, from the viewing direction on.
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

void set_filter(Reader& reader, Component& image) {
  Setting& s = reader.filter;
  const Parameters& p = s.parameters;
  if (s.type.empty()) s.type = reader.version == 4 ? "gaussian" : "box";
  const auto radius = [&](double otherwise) {
    const char* x = p.has("xwidth") ? "xwidth" : "xradius";
    const char* y = p.has("ywidth") ? "ywidth" : "yradius";
    const double across = p.number(x, otherwise), down = p.number(y, otherwise);
    if (across != down) reader.importing.inexact("a filter as wide as it is high is taken, of the mean radius", p.place(y));
    return std::clamp((across + down) / 2, 0.5, 16.0);
  };
  Ref<Component> filter;
  const auto make = [&](const char* name, double otherwise) {
    filter = reader.make(name, p.at);
    set_member(*filter, "radius", radius(otherwise), p.at);
  };
  const bool v3 = reader.version == 3;
  if (s.type == "box") {
    make("BoxFilter", 0.5);
  } else if (s.type == "triangle") {
    make("TriangleFilter", 2);
  } else if (s.type == "gaussian") {
    make("GaussianFilter", v3 ? 2 : 1.5);
    // v3: exp(-alpha r^2), v4: a normal distribution; both lowered to end at 0.
    const double deviation = v3 ? std::sqrt(1 / (2 * std::max(p.number("alpha", 2), 1e-3))) : p.number("sigma", 0.5);
    set_member(*filter, "deviation", std::clamp(deviation, 0.05, 16.0), p.at);
  } else if (s.type == "mitchell") {
    make("MitchellFilter", 2);
    set_member(*filter, "b", p.number("B", 1.0 / 3), p.at);
    set_member(*filter, "c", p.number("C", 1.0 / 3), p.at);
  } else if (s.type == "sinc") {
    make("LanczosFilter", 4);
    if (const double tau = p.number("tau", 3); tau != radius(4))
      reader.importing.inexact("a sinc filter is windowed by as many lobes as it is wide", p.at);
  } else {
    throw Error(fmt::format("there is no filter '{}'{}", s.type,
                            suggestion(s.type, {"box", "triangle", "gaussian", "mitchell", "sinc"})),
                p.at);
  }
  if (s.given) p.tell_unused(reader.importing);
  set_member(image, "filter", filter, p.at);
}

void set_crop(Reader& reader, Component& image, Size size) {
  const Parameters& p = reader.film.parameters;
  const char* name = p.has("pixelbounds") ? "pixelbounds" : "cropwindow";
  const std::vector<double>& n = p.numbers(name);
  if (n.empty()) return;
  if (n.size() != 4) throw Error(fmt::format("'{}' must be four numbers", name), p.place(name));
  const bool parts = std::string_view(name) == "cropwindow";
  const auto pixel = [&](double x, int most) { return std::clamp(std::ceil(parts ? x * most : x), 0.0, double(most)); };
  const double x0 = pixel(n[0], size.width), x1 = pixel(n[1], size.width), y0 = pixel(n[2], size.height),
               y1 = pixel(n[3], size.height);
  if (!(x0 < x1 && y0 < y1)) throw Error(fmt::format("'{}' leaves nothing of the picture", name), p.place(name));
  set_member(image, "crop", Numbers{{x0, y0, x1, y1}, 1, Dimension::none}, p.at);
}

void set_output(Reader& reader, Component& job) {
  const Parameters& p = reader.film.parameters;
  const std::string named = p.text("filename", "pbrt.exr");
  const Location at = p.place("filename");
  // A scene says what its picture is called, not where on this machine it goes.
  std::filesystem::path path = std::filesystem::path(named).filename();
  if (path != named) reader.importing.inexact(fmt::format("the picture is written as '{}' here", path.string()), at);
  const std::string ending = path.extension().string();
  const char* output = ending == ".png"   ? "PngOutput"
                       : ending == ".tga" ? "TgaOutput"
                       : ending == ".hdr" ? "HdrOutput"
                                          : "ExrOutput";
  if (std::string_view(output) == "ExrOutput" && ending != ".exr") {
    path.replace_extension(".exr");
    reader.importing.inexact(fmt::format("the picture is written as '{}' here", path.string()), at);
  }
  const Ref<Component> written = reader.make(output, at);
  set_member(*written, "file", FilePath{path.string(), {}}, at);
  set_member(job, "outputs", Value::List{Value(written, at)}, at);
}

}  // namespace

double imaging_ratio(Reader& reader) {
  const Parameters &film = reader.film.parameters, &camera = reader.camera.parameters;
  if (reader.version == 3) return film.number("scale", 1);
  const double open = camera.number("shutteropen", 0), close = camera.number("shutterclose", 1);
  if (!(close > open)) throw Error("the shutter does not open", camera.place("shutterclose"));
  const std::string sensor = film.text("sensor", "cie1931");
  if (sensor != "cie1931")
    reader.importing.inexact(fmt::format("the sensor '{}' sees as a standard observer does, without its colours", sensor),
                             film.place("sensor"));
  if (film.number("whitebalance", 0) != 0)
    reader.importing.inexact("the white balance is left out", film.place("whitebalance"));
  return (close - open) * film.number("iso", 100) / 100;
}

void set_film(Reader& reader, Component& job) {
  const Parameters& p = reader.film.parameters;
  const Size size = resolution(reader);
  const Ref<Component> image = reader.make("ImageBuffer", p.at);
  set_member(*image, "width", size.width, p.at);
  set_member(*image, "height", size.height, p.at);
  set_filter(reader, *image);
  set_crop(reader, *image, size);
  if (reader.film.type == "gbuffer") {
    set_member(*image, "layers",
               Value::List{Value(std::string("albedo")), Value(std::string("normal")), Value(std::string("depth"))}, p.at);
    if (p.text("coordinatesystem", "camera") == "camera") reader.importing.inexact("normals are the world's", p.at);
  } else if (reader.film.type == "spectral") {
    reader.importing.inexact("the film of buckets of wavelengths is one of X, Y and Z", p.at);
    p.ignore({"nbuckets", "lambdamin", "lambdamax"});
  }
  p.ignore({"savefp16", "diagonal"});
  for (const char* name : {"maxcomponentvalue", "maxsampleluminance"})
    if (p.has(name)) reader.importing.inexact(fmt::format("'{}' is left out: no light is cut off", name), p.place(name));
  set_output(reader, job);
  if (reader.film.given) p.tell_unused(reader.importing);
  set_member(job, "image", image, p.at);
  // pbrt's pictures are clipped at 1 and encoded as sRGB, nothing else.
  set_member(job, "tone_map", reader.make("ExposureToneMap", p.at), p.at);
}

void set_camera(Reader& reader, Component& job) {
  Setting& s = reader.camera;
  const Parameters& p = s.parameters;
  if (s.type.empty()) s.type = "perspective";
  const bool orthographic = s.type == "orthographic";
  const Ref<Component> camera = reader.make(orthographic ? "OrthographicCamera" : "PerspectiveCamera", p.at);
  const double scale = set_placement(reader, *camera);
  const Size size = resolution(reader);
  const double pixels = double(size.width) / size.height, aspect = p.number("frameaspectratio", pixels);
  if (std::abs(aspect / pixels - 1) > 1e-6)
    reader.importing.inexact("pixels are squares: 'frameaspectratio' is left out", p.place("frameaspectratio"));
  // Half the width of the screen at distance 1 / tan(fov / 2), where the shorter side is 2 long unless it is said otherwise.
  double half_width = std::max(pixels, 1.0);
  if (const std::vector<double>& window = p.numbers("screenwindow"); !window.empty()) {
    if (window.size() != 4 || !(window[0] < window[1] && window[2] < window[3]))
      throw Error("'screenwindow' must be xmin, xmax, ymin, ymax", p.place("screenwindow"));
    half_width = (window[1] - window[0]) / 2;
    const double half_height = (window[3] - window[2]) / 2;
    if (std::abs(window[0] + window[1]) > 1e-6 * half_width || std::abs(window[2] + window[3]) > 1e-6 * half_height) {
      if (s.type == "perspective")
        set_member(
            *camera, "principal_point",
            Numbers{
                {-(window[0] + window[1]) / (4 * half_width), (window[2] + window[3]) / (4 * half_height)}, 1, Dimension::none},
            p.at);
      else
        reader.importing.inexact("a screen window that is not in the middle is put there", p.place("screenwindow"));
    }
    if (std::abs(half_width / half_height / pixels - 1) > 1e-3)
      reader.importing.inexact("pixels are squares: the screen window's height is left out", p.place("screenwindow"));
  }
  if (orthographic) {
    set_member(*camera, "width", 2 * half_width * scale, p.at);
    if (p.number("lensradius", 0) > 0)
      reader.importing.inexact("an orthographic camera is sharp everywhere", p.place("lensradius"));
    p.ignore({"focaldistance"});
  } else if (s.type == "perspective") {
    double fov = p.number("fov", 90);
    if (const double half = p.number("halffov", -1); half > 0) fov = 2 * half;
    if (!(fov > 0 && fov < 180)) throw Error("'fov' must be more than 0 and less than 180", p.place("fov"));
    const bool plain = std::abs(half_width - std::max(pixels, 1.0)) < 1e-6;
    if (!plain) fov = 2 * std::atan(std::tan(fov * pi / 360) * half_width) * 180 / pi;
    set_member(*camera, "fov", fov, p.at);
    if (!plain) set_member(*camera, "fov_axis", "width", p.at);
    const double lens = p.number("lensradius", 0) * scale, focus = p.number("focaldistance", 1e6) * scale;
    if (lens > 0) {
      set_member(*camera, "lens_radius", lens, p.at);
      set_member(*camera, "focus_distance", focus, p.at);
    }
  } else if (s.type == "realistic" || s.type == "spherical" || s.type == "environment") {
    reader.importing.inexact(fmt::format("a '{}' camera is a pinhole of 90 degrees here", s.type), p.at);
    set_member(*camera, "fov", 90, p.at);
    p.forget();
  } else {
    throw Error(fmt::format("there is no camera '{}'{}", s.type,
                            suggestion(s.type, {"perspective", "orthographic", "realistic", "spherical", "environment"})),
                p.at);
  }
  set_member(*camera, "shutter_open", p.number("shutteropen", 0), p.at);
  set_member(*camera, "shutter_close", p.number("shutterclose", 1), p.at);
  if (s.given) p.tell_unused(reader.importing);
  set_member(job, "camera", camera, p.at);
}

}  // namespace etendue::pbrt
