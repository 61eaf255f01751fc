// Writes delta lights and environments.

#include <cmath>

#include "images/image_library.h"
#include "images/linear_image.h"
#include "writer.h"

namespace etendue::pbrt_export {

namespace {

constexpr double exact_pi = 3.14159265358979323846;

/// Converts an image in longitude and latitude to an equal-area square (Clarberg 2008, "Fast equal-area mapping of the
/// (hemi)sphere using SIMD") with the upper pole at the centre, for a light that is rotated so that its z axis is the
/// environment's y axis.
LinearImage squared(const LinearImage& image) {
  LinearImage square;
  // The resolution of the image near its equator.
  square.width = square.height = std::max(image.width / 2, 1);
  const int n = square.width;
  square.rgb.resize(size_t(n) * size_t(n) * 3);
  constexpr int parts = 3;  // samples per pixel, along each side
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      double sum[3]{};
      for (int k = 0; k < parts * parts; ++k) {
        const double a = 2 * (i + (k % parts + 0.5) / parts) / n - 1, b = 2 * (j + (k / parts + 0.5) / parts) / n - 1;
        const double distance = 1 - std::abs(a) - std::abs(b), r = 1 - std::abs(distance);
        const double phi = (r == 0 ? 1 : (std::abs(b) - std::abs(a)) / r + 1) * exact_pi / 4;
        const double ring = r * std::sqrt(2 - r * r), z = std::copysign(1 - r * r, distance);
        const double x = std::copysign(std::cos(phi), a) * ring, y = std::copysign(std::sin(phi), b) * ring;
        // In the environment's space (x, z, -y), where u = atan2(x, -z) / (2 pi).
        double u = std::atan2(x, y) / (2 * exact_pi);
        if (u < 0) u += 1;
        const double px = u * image.width - 0.5, py = std::acos(std::clamp(z, -1.0, 1.0)) / exact_pi * image.height - 0.5;
        const int x0 = int(std::floor(px)), y0 = int(std::floor(py));
        for (int d = 0; d < 4; ++d) {
          const int xx = (x0 + d % 2 + image.width) % image.width, yy = std::clamp(y0 + d / 2, 0, image.height - 1);
          const double part = (d % 2 ? px - x0 : 1 - (px - x0)) * (d / 2 ? py - y0 : 1 - (py - y0)) / (parts * parts);
          for (size_t c = 0; c < 3; ++c)
            sum[c] += part * double(image.rgb[(size_t(yy) * size_t(image.width) + size_t(xx)) * 3 + c]);
        }
      }
      for (size_t c = 0; c < 3; ++c) square.rgb[(size_t(j) * size_t(n) + size_t(i)) * 3 + c] = float(sum[c]);
    }
  return square;
}

}  // namespace

std::string Writer::environment(const SceneObject& object, const Component& emission) {
  const std::string file = word_of(emission, "file");
  const double scale = number_of(emission, "scale");
  if (number_of(emission, "illuminance") > 0)
    exporting.inexact("the illuminance of an environment is left out: it is as strong as its scale says", &emission);
  std::string text = "LightSource \"infinite\"";
  if (file.empty()) {
    const Ref<Component> map = part_of(emission, "radiance");
    const Color c = map ? constant_of(*map) : nullptr;
    if (c)
      text += light("L", scale == 1 ? c : scaled_spectrum(scale, c));
    else
      exporting.inexact("an environment of a map is white of 1", &emission);
  } else {
    if (!truth_of(emission, "illuminant"))
      exporting.inexact("an environment's image has the white of its colour space", &emission);
    const bool square = word_of(emission, "layout") == "equal_area";
    std::string name;
    if (square) {
      name = exporting.copy_beside(file);
    } else {
      const LinearImage image = squared(read_linear_image(file, word_of(emission, "transfer")));
      const std::vector<unsigned char> bytes =
          image_library().encode(".exr", ImageHeader(image.width, image.height, 3, NumberType::single), image.rgb);
      name = exporting.write_beside("environment", "exr", std::string(bytes.begin(), bytes.end()));
      exporting.inexact("an environment's image is unfolded into a square of as many pixels across its equator", &emission);
    }
    text += fmt::format(" \"string filename\" \"{}\" \"float scale\" {}", name, scale);
  }
  // pbrt's z axis points up, the environment's y axis here: (x, y, z) in pbrt is (x, z, -y) here.
  const Transform turn(Transform::DoubleMatrix{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0});
  return "AttributeBegin\n" + transform_of(object.transform, "ConcatTransform") + "ConcatTransform " + matrix(turn) + "\n" +
         text + "\nAttributeEnd\n";
}

std::string Writer::point_light(const SceneObject& object, const Component& emission) {
  const std::vector<double> p = numbers_of(object, "position");
  const std::string from = fmt::format(" \"point3 from\" {}", list(p)), name = emission.class_info().name;
  if (is_spot(emission)) {
    const std::vector<double> axis = numbers_of(emission, "axis");
    const std::vector<double> to{p[0] + axis[0], p[1] + axis[1], p[2] + axis[2]};
    const double inner = number_of(emission, "inner_angle"), outer = number_of(emission, "outer_angle");
    if (part_of(emission, "picture")) exporting.inexact("the picture of a spot is left out", &emission);
    if (spot_edge(emission) != "smooth") exporting.inexact("a spot's edge is smooth in pbrt", &emission);
    return "LightSource \"spot\"" + light_of(emission, "I", object) + from +
           fmt::format(" \"point3 to\" {} \"float coneangle\" {} \"float conedeltaangle\" {}\n", list(to), outer,
                       outer - inner);
  }
  if (name != "DiffuseEmission")
    exporting.inexact(fmt::format("a point light's {} shines alike in all directions", name), &emission);
  return "LightSource \"point\"" + (emission.class_info().find("radiance") ? light_of(emission, "I", object) : std::string()) +
         from + "\n";
}

bool Writer::light_source(const SceneObject& object) {
  const std::string name = object.class_info().name;
  if (name != "Point" && name != "Distant" && name != "Environment") return false;
  const Ref<Component> emission = part_of(object, "emission");
  if (!emission) return true;
  std::string text;
  if (name == "Environment" &&
      (emission->class_info().name == "EnvironmentEmission" || emission->class_info().name == "DiffuseEmission")) {
    if (emission->class_info().name == "DiffuseEmission")
      text = "LightSource \"infinite\"" + light_of(*emission, "L", object) + "\n";
    else
      text = environment(object, *emission);
    out_ += text;
    return true;
  }
  if (name == "Environment") {
    exporting.inexact(fmt::format("the environment's {} is left out", emission->class_info().name), emission.get());
    return true;
  }
  if (name == "Point") {
    text = point_light(object, *emission);
  } else {
    const std::vector<double> way = numbers_of(object, "direction");
    if (emission->class_info().name != "DiffuseEmission")
      exporting.inexact("a distant light is alike everywhere", emission.get());
    text = "LightSource \"distant\"" + light_of(*emission, "L", object) +
           fmt::format(" \"point3 from\" [ 0 0 0 ] \"point3 to\" {}\n", list(way));
  }
  out_ += "AttributeBegin\n" + transform_of(object.transform, "ConcatTransform") + text + "AttributeEnd\n";
  return true;
}

}  // namespace etendue::pbrt_export
