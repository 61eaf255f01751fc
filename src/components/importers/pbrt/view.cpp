// Converts film and filter.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "reader.h"

namespace etendue::pbrt {

FilmSize film_size(const Reader& reader) {
  const Parameters& p = reader.film.parameters;
  const bool v3 = reader.version == 3;
  FilmSize size{p.integer("xresolution", v3 ? 640 : 1280), p.integer("yresolution", v3 ? 480 : 720)};
  for (const auto& [name, pixels] : {std::pair("xresolution", size.width), std::pair("yresolution", size.height)})
    if (pixels < 1 || pixels > 65536) throw Error(fmt::format("'{}' must be from 1 to 65536", name), p.place(name));
  return size;
}

namespace {

void set_filter(Reader& reader, Component& image) {
  Setting& s = reader.filter;
  const Parameters& p = s.parameters;
  if (s.type.empty()) s.type = reader.version == 4 ? "gaussian" : "box";
  const auto radius = [&](double otherwise) {
    const char* x = p.has("xwidth") ? "xwidth" : "xradius";
    const char* y = p.has("ywidth") ? "ywidth" : "yradius";
    const double across = p.number(x, otherwise), down = p.number(y, otherwise);
    if (across != down) reader.importing.inexact("a filter as wide as it is high is taken, of the mean radius", p.place(y));
    const double mean = (across + down) / 2, kept = std::clamp(mean, 0.5, 16.0);
    if (kept != mean) reader.importing.inexact("a filter's radius is kept within 0.5 and 16 pixels", p.place(x));
    return kept;
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
    // v3: exp(-alpha r^2), v4: a normal distribution; both shifted down to reach 0 at the radius.
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

void set_crop(Reader& reader, Component& image, FilmSize size) {
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
  // Only the file name is used: a scene does not decide the folder on this machine.
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
  // Its RGB values are in the colour space that was set before the film.
  if (p.space && p.space->name != "srgb") {
    if (written->class_info().find("color_space"))
      set_member(*written, "color_space", p.space->name, at);
    else
      reader.importing.inexact("the picture has sRGB's colours, not those of the colour space that was stated", at);
  }
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
  const FilmSize size = film_size(reader);
  const Ref<Component> image = reader.make("ImageBuffer", p.at);
  set_member(*image, "width", size.width, p.at);
  set_member(*image, "height", size.height, p.at);
  set_filter(reader, *image);
  set_crop(reader, *image, size);
  if (reader.film.type == "gbuffer") {
    Value::List layers;
    for (const char* layer : {"albedo", "position", "geometric_normal", "normal", "uv", "depth", "variance"})
      layers.emplace_back(std::string(layer));
    set_member(*image, "layers", layers, p.at);
    if (p.text("coordinatesystem", "camera") == "camera")
      reader.importing.inexact("positions and normals are the world's", p.at);
  } else if (reader.film.type == "spectral") {
    reader.importing.inexact("the film of buckets of wavelengths is one of X, Y and Z", p.at);
    p.ignore({"nbuckets", "lambdamin", "lambdamax"});
  }
  p.ignore({"savefp16", "diagonal"});  // "diagonal" matters only to the realistic camera, which has read it already
  for (const char* name : {"maxcomponentvalue", "maxsampleluminance"})
    if (p.has(name)) reader.importing.inexact(fmt::format("'{}' is left out: no light is cut off", name), p.place(name));
  set_output(reader, job);
  if (reader.film.given) p.tell_unused(reader.importing);
  set_member(job, "image", image, p.at);
  // pbrt's images are only clipped at 1 and encoded as sRGB.
  set_member(job, "tone_map", reader.make("ExposureToneMap", p.at), p.at);
}

}  // namespace etendue::pbrt
