// Writes camera, film, filter, sampler and integrator.

#include <cmath>
#include <filesystem>

#include "components/cameras/lens_pupils.h"
#include "writer.h"

namespace etendue::pbrt_export {

namespace {
constexpr double exact_pi = 3.14159265358979323846;

/// The distance from the camera to the plane in focus [m].
double focus_of(const Component& camera) {
  const std::vector<double> f = numbers_of(camera, "from"), t = numbers_of(camera, "to");
  const double focus = number_of(camera, "focus_distance");
  return focus > 0 ? focus : std::sqrt(std::pow(t[0] - f[0], 2) + std::pow(t[1] - f[1], 2) + std::pow(t[2] - f[2], 2));
}

/// A LensCamera's surfaces, with the current diameter of its aperture stop [m].
std::vector<LensSurface> lens_of(const Component& camera) {
  const Value file = value_of(camera, "file"), list = value_of(camera, "surfaces");
  const FilePath* path = file.as<FilePath>();
  std::vector<LensSurface> surfaces = lens_surfaces(
      path && !path->empty() ? read_lens_file(path->resolved()) : list.as<Numbers>()->values, number_of(camera, "unit"));
  const double open = number_of(camera, "aperture_diameter");
  for (size_t i = 0; i < surfaces.size(); ++i)
    if (open > 0 && is_stop(surfaces, i)) surfaces[i].diameter = std::min(surfaces[i].diameter, open);
  return surfaces;
}

/// The factor from pbrt's film irradiance to this program's pixel values.
double lens_brightness(const Component& camera) {
  if (camera.class_info().name != "LensCamera" || word_of(camera, "measures") == "irradiance") return 1;
  LensSystem lens;
  lens.set(lens_of(camera));
  lens.focus(focus_of(camera));
  LensPupils pupils;
  pupils.find(lens, number_of(camera, "film_diagonal") / 2);
  return 1 / pupils.solid_angle();
}

/// Lengths in the table are in millimetres.
std::string realistic(Exporting& exporting, const Component& camera) {
  std::string table = "# radius of curvature, thickness, index, diameter\n";
  double stop = 1e3;  // [mm]; pbrt only narrows stops to this diameter, so that a large value changes nothing
  const std::vector<LensSurface> surfaces = lens_of(camera);
  for (size_t i = 0; i < surfaces.size(); ++i) {
    const LensSurface& s = surfaces[i];
    table += fmt::format("{} {} {} {}\n", s.radius * 1e3, s.thickness * 1e3, s.index, s.diameter * 1e3);
    if (is_stop(surfaces, i))
      stop = s.diameter * 1e3;
    else if (s.radius == 0)
      exporting.inexact("pbrt takes a plane of glass for a stop: it does not refract there", &camera);
  }
  return fmt::format("Camera \"realistic\" \"string lensfile\" \"{}\" \"float aperturediameter\" {} \"float focusdistance\" {}",
                     exporting.write_beside("lens", "dat", table), stop, focus_of(camera));
}

}  // namespace

void Writer::camera() {
  const Component& camera = *job.camera;
  const std::string name = camera.class_info().name;
  const bool perspective = name == "PerspectiveCamera", orthographic = name == "OrthographicCamera",
             spherical = name == "SphericalCamera", lens = name == "LensCamera";
  if (!perspective && !orthographic && !spherical && !lens) {
    exporting.inexact(fmt::format("pbrt has no camera like {}: a pinhole is taken", name), &camera);
    out_ += "Camera \"perspective\"\n";
    return;
  }
  const std::vector<double> f = numbers_of(camera, "from"), t = numbers_of(camera, "to"), u = numbers_of(camera, "up");
  const Transform base = Transform::look_at({f[0], f[1], f[2]}, {t[0], t[1], t[2]}, {u[0], u[1], u[2]});
  const Value moved = value_of(camera, "transform");
  std::vector<AnimatedTransform::Key> keys;
  if (const AnimatedTransform* animated = moved.as<AnimatedTransform>())
    keys = animated->keys();
  else
    keys = {{0, moved.as<Transform>() ? *moved.as<Transform>() : Transform()}};
  // +x points to the left in our images, to the right in pbrt's. For pbrt's spherical cameras see its importer.
  using M = Transform::DoubleMatrix;
  const bool square = spherical && word_of(camera, "mapping") == "equal_area";
  const Transform turned = square      ? Transform(M{-1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0})
                           : spherical ? Transform(M{0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0})
                                       : Transform::scale({-1, 1, 1});
  for (auto& key : keys) key.transform = (key.transform * base * turned).inverse();
  out_ += keys.size() == 1 ? fmt::format("Transform {}\n", matrix(keys[0].transform))
                           : transform_of(AnimatedTransform(keys), "Transform");
  const double open = number_of(camera, "shutter_open"), close = number_of(camera, "shutter_close");
  const std::string shutter =
      close > open ? fmt::format(" \"float shutteropen\" {} \"float shutterclose\" {}", open, close) : "";
  if (number_of(camera, "shutter_opening") > 0 || number_of(camera, "shutter_closing") > 0)
    exporting.inexact("a shutter opens and closes at once in pbrt", &camera);
  if (spherical) {
    out_ +=
        fmt::format("Camera \"spherical\" \"string mapping\" \"{}\"{}\n", square ? "equalarea" : "equirectangular", shutter);
    return;
  }
  if (lens) {
    out_ += realistic(exporting, camera) + shutter + "\n";
    return;
  }
  if (number_of(camera, "near_clip") > 0 || number_of(camera, "far_clip") > 0)
    exporting.inexact("pbrt sees what is nearer than near_clip and farther than far_clip", &camera);
  const double aspect = double(job.image->width) / job.image->height;
  if (orthographic) {
    const double half = number_of(camera, "width") / 2;
    out_ += fmt::format("Camera \"orthographic\" \"float screenwindow\" [ {} {} {} {} ]{}\n", -half, half, -half / aspect,
                        half / aspect, shutter);
    return;
  }
  const std::string axis = word_of(camera, "fov_axis");
  const bool across_width = axis == "width" || (axis == "smaller" && aspect <= 1) || (axis == "larger" && aspect > 1);
  const bool shorter_is_width = aspect <= 1;
  double tangent = std::tan(field_of_view(camera) * exact_pi / 360);
  if (axis == "diagonal") tangent /= std::hypot(aspect, 1.0);  // becomes the tangent across the height
  if (across_width && !shorter_is_width) tangent /= aspect;
  if (!across_width && shorter_is_width) tangent *= aspect;
  out_ += fmt::format("Camera \"perspective\" \"float fov\" {}", 2 * std::atan(tangent) * 180 / exact_pi);
  if (const double radius = number_of(camera, "lens_radius"); radius > 0)
    out_ += fmt::format(" \"float lensradius\" {} \"float focaldistance\" {}", radius, focus_of(camera));
  // A shifted lens sees an off-centre window; the shorter side of pbrt's window has length 2.
  if (const std::vector<double> shift = numbers_of(camera, "principal_point"); shift[0] != 0 || shift[1] != 0) {
    const double x = std::max(aspect, 1.0), y = std::max(1 / aspect, 1.0);
    out_ += fmt::format(" \"float screenwindow\" [ {} {} {} {} ]", x * (-1 - 2 * shift[0]), x * (1 - 2 * shift[0]),
                        y * (-1 + 2 * shift[1]), y * (1 + 2 * shift[1]));
  }
  out_ += shutter + "\n";
}

void Writer::film() {
  const ImageBuffer& image = *job.image;
  std::string file = exporting.stem() + ".exr";
  if (!job.outputs.empty())
    if (const std::string named = word_of(*job.outputs[0], "file"); !named.empty())
      file = std::filesystem::path(named).filename().string();
  const double open = number_of(*job.camera, "shutter_open"), close = number_of(*job.camera, "shutter_close");
  out_ += fmt::format("Film \"rgb\" \"integer xresolution\" {} \"integer yresolution\" {} \"string filename\" \"{}\"",
                      image.width, image.height, file);
  // pbrt's image is brighter the longer its shutter is open.
  const double brightness = lens_brightness(*job.camera) / (close > open ? close - open : 1);
  if (brightness != 1) out_ += fmt::format(" \"float iso\" {}", 100 * brightness);
  if (job.camera->class_info().name == "LensCamera")
    out_ += fmt::format(" \"float diagonal\" {}", number_of(*job.camera, "film_diagonal") * 1e3);
  if (const std::vector<double> crop = numbers_of(image, "crop"); crop.size() == 4)
    out_ += fmt::format(" \"integer pixelbounds\" [ {} {} {} {} ]", crop[0], crop[2], crop[1], crop[3]);
  out_ += "\n";
  if (!image.layers.empty()) exporting.inexact("further layers of the picture are left out", &image);
  if (job.tone_map && job.tone_map->class_info().name != "ExposureToneMap" && job.tone_map->class_info().name != "NoToneMap")
    exporting.inexact("pbrt's pictures are not tone mapped", job.tone_map.get());
  const Ref<Component> filter = part_of(image, "filter");
  const std::string name = filter->class_info().name;
  const double radius = number_of(*filter, "radius");
  const char* type = name == "BoxFilter"        ? "box"
                     : name == "TriangleFilter" ? "triangle"
                     : name == "MitchellFilter" ? "mitchell"
                     : name == "LanczosFilter"  ? "sinc"
                                                : "gaussian";
  out_ += fmt::format("PixelFilter \"{0}\" \"float xradius\" {1} \"float yradius\" {1}", type, radius);
  if (name == "GaussianFilter") out_ += fmt::format(" \"float sigma\" {}", number_of(*filter, "deviation"));
  if (name == "MitchellFilter")
    out_ += fmt::format(" \"float B\" {} \"float C\" {}", number_of(*filter, "b"), number_of(*filter, "c"));
  if (name == "LanczosFilter") out_ += fmt::format(" \"float tau\" {}", radius);
  out_ += "\n";
}

namespace {

/// The type of the sampler and its parameters.
std::string sampler_of(const Component* sampler, int samples) {
  const std::string name = sampler ? sampler->class_info().name : "";
  if (name == "StratifiedSampler") {
    const double x = number_of(*sampler, "x"), y = number_of(*sampler, "y");
    if (x * y == samples) return fmt::format("\"stratified\" \"integer xsamples\" {} \"integer ysamples\" {}", x, y);
  }
  const std::pair<const char*, const char*> known[] = {{"IndependentSampler", "independent"},
                                                       {"HaltonSampler", "halton"},
                                                       {"Pmj02Sampler", "pmj02bn"},
                                                       {"ZSobolSampler", "zsobol"}};
  const char* type = "paddedsobol";
  for (const auto& [ours, theirs] : known)
    if (name == ours) type = theirs;
  return fmt::format("\"{}\" \"integer pixelsamples\" {}", type, samples);
}

}  // namespace

void Writer::integrator() {
  const Component& renderer = *job.renderer;
  const std::string name = renderer.class_info().name;
  const Ref<Component> sampler = renderer.class_info().find("sampler") ? part_of(renderer, "sampler") : nullptr;
  out_ += "Sampler " + sampler_of(sampler.get(), job.renderer->samples) + "\n";
  const std::pair<const char*, const char*> known[] = {
      {"PathTracer", "volpath"},           {"BidirectionalPathTracer", "bdpt"},
      {"LightTracer", "lightpath"},        {"PathSpaceMetropolis", "mlt"},
      {"PrimarySampleMetropolis", "mlt"},  {"MultiplexedMetropolis", "mlt"},
      {"ProgressivePhotonMapper", "sppm"}, {"AmbientOcclusionRenderer", "ambientocclusion"},
      {"DirectRenderer", "volpath"}};
  const char* type = nullptr;
  for (const auto& [ours, theirs] : known)
    if (name == ours) type = theirs;
  if (!type) exporting.inexact(fmt::format("pbrt has no {}: paths are traced", name), &renderer);
  out_ += fmt::format("Integrator \"{}\"", type ? type : "volpath");
  // The depth is in segments; pbrt counts the scattering events between them.
  const double depth = name == "DirectRenderer"                  ? 2
                       : renderer.class_info().find("max_depth") ? number_of(renderer, "max_depth")
                                                                 : 0;
  if (depth > 0) out_ += fmt::format(" \"integer maxdepth\" {}", depth - 1);
  if (type && std::string_view(type) == "mlt") out_ += fmt::format(" \"integer mutationsperpixel\" {}", job.renderer->samples);
  out_ += "\n";
}

void Writer::view() {
  camera();
  film();
  integrator();
}

}  // namespace etendue::pbrt_export
