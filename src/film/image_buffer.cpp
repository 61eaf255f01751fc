#include "etendue/film/image_buffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "etendue/film/splat_label.h"
#include "etendue/paths/path_expression.h"
#include "filter_window.h"
#include "picture_format.h"
#include "pixel_area.h"

namespace etendue {
namespace {

/// The layers that describe the light by one name each.
constexpr std::array<const char*, 3> light_layers = {"variance", "samples", PictureFormat::stokes_layer};

const std::vector<std::string>& known_layers() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = SurfaceLayers::offered();
    all.insert(all.end(), light_layers.begin(), light_layers.end());
    return all;
  }();
  return names;
}

/// The parts of "path.NAME = EXPRESSION". Throws Error at the image if it is not like this.
PictureFormat::PathLayer path_layer(const ImageBuffer& image, const std::string& layer) {
  const auto trimmed = [](std::string_view s) {
    const size_t first = s.find_first_not_of(' '), last = s.find_last_not_of(' ');
    return first == s.npos ? std::string() : std::string(s.substr(first, last - first + 1));
  };
  const size_t prefix = std::string_view(PictureFormat::path_prefix).size(), equals = layer.find('=');
  if (equals == layer.npos)
    image.fail("layers", fmt::format("'{}' needs a name and a light path expression, as in 'path.caustics = C<RD>S+L'", layer));
  PictureFormat::PathLayer made{trimmed(std::string_view(layer).substr(prefix, equals - prefix)),
                                trimmed(std::string_view(layer).substr(equals + 1))};
  const bool plain = std::ranges::all_of(made.name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (made.name.empty() || !plain)
    image.fail("layers",
               fmt::format("'path.{}' is no name of a layer: letters, digits, '_' and '-' may follow 'path.'", made.name));
  try {
    PathLabelNames names;
    const PathExpression parsed(made.expression, names);
  } catch (const Error& e) {
    image.fail("layers", fmt::format("path.{}: {}", made.name, e.what()));
  }
  return made;
}

/// Whether an entry is a layer of surfaces, which is added to the others. Throws Error at the image if it is not written well.
bool takes_surfaces(const ImageBuffer& image, SurfaceLayers& surfaces, const std::string& entry) {
  try {
    return surfaces.take(entry);
  } catch (const Error& e) {
    image.fail("layers", e.what());
  }
}

/// The known layers, and patterns for light groups and light path expressions of any name.
std::vector<std::string> offered_layers() {
  std::vector<std::string> names = known_layers();
  names.push_back(PictureFormat::light_prefix + std::string("…"));
  names.push_back(PictureFormat::path_prefix + std::string("…"));
  return names;
}

}  // namespace

void ImageBuffer::describe(Description<ImageBuffer>& d) {
  d.summary("The picture to be taken: its pixels, how samples count for them, and which layers it has.")
      .member<&ImageBuffer::width>("width", "1", "pixels in a row", range(1, 65536))
      .member<&ImageBuffer::height>("height", "1", "rows of pixels", range(1, 65536))
      .member<&ImageBuffer::filter>("filter", "", "reconstruction: how much a sample counts for the pixels around it")
      .member<&ImageBuffer::crop>("crop", "1",
                                  "rectangle to render and write, x0, y0, x1, y1 [pixels from the upper left, x1 and y1 "
                                  "excluded]; empty: the whole picture")
      .member<&ImageBuffer::layers>(
          "layers", "",
          "further channels. Of the surfaces that camera rays meet first, the same with every "
          "renderer: albedo, normal and geometric_normal (on the side of the camera), position, "
          "depth (from the camera), uv, roughness, motion (from where a point is seen to where it "
          "was and will be at the ends of the shutter, or 'motion = T' seconds before and after), "
          "coverage; of the sample nearest to the pixel's centre object, material, primitive; and "
          "Cryptomattes crypto_object, crypto_material, crypto_asset, crypto_group, of the six "
          "largest coverages or as many as 'crypto_object = N' says. Of the light: "
          "variance (of the mean of Y), samples (per pixel); stokes (the polarization: S1, S2 and S3 of the "
          "Stokes vector, of which the picture is S0, with the degrees of linear and circular "
          "polarization and the angle); light.NAME for the light of the "
          "luminaires of which the object or the emission has this name, light.NAME+NAME for that "
          "of several together, and then light.rest for all other light; 'path.NAME = EXPRESSION' "
          "for the light whose paths match a light path expression, as in 'path.caustics = "
          "C<RD>S+L'",
          offered_layers())
      .member<&ImageBuffer::path_lengths>("path_lengths", "1",
                                          "further channels length_1.X, … by the number of segments of the paths that "
                                          "brought the light; the last holds all longer ones too",
                                          range(0, 64));
}

static const Register<ImageBuffer> registered;

ImageBuffer::ImageBuffer()
    : filter(ref_cast<Filter>(Registry::instance().create("GaussianFilter"))),
      format_(std::make_shared<const PictureFormat>()) {}
ImageBuffer::~ImageBuffer() = default;

const PixelArea& ImageBuffer::area() const { return format_->area; }
const PixelArea& ImageBuffer::sampled_area() const { return format_->sampled_area; }

bool ImageBuffer::wants(const std::string& layer) const {
  return std::find(layers.begin(), layers.end(), layer) != layers.end();
}

void ImageBuffer::prepare() {
  if (width < 1) fail("width", "must be at least 1");
  if (height < 1) fail("height", "must be at least 1");
  PixelArea area{0, 0, width, height};
  if (!crop.empty()) {
    if (crop.size() != 4) fail("crop", fmt::format("needs four numbers x0, y0, x1, y1, not {}", crop.size()));
    area = {crop[0], crop[1], crop[2], crop[3]};
    if (area.x0 < 0 || area.y0 < 0 || area.x1 > width || area.y1 > height || area.x0 >= area.x1 || area.y0 >= area.y1)
      fail("crop", fmt::format("[{}, {}, {}, {}] is not a rectangle within the picture of {} x {} pixels", crop[0], crop[1],
                               crop[2], crop[3], width, height));
  }
  std::vector<std::string> light_groups;
  std::vector<PictureFormat::PathLayer> path_layers;
  SurfaceLayers surfaces;
  for (size_t i = 0; i < layers.size(); ++i) {
    if (layers[i].starts_with(PictureFormat::light_prefix))
      light_groups.push_back(layers[i].substr(std::string_view(PictureFormat::light_prefix).size()));
    else if (layers[i].starts_with(PictureFormat::path_prefix))
      path_layers.push_back(path_layer(*this, layers[i]));
    else if (!takes_surfaces(*this, surfaces, layers[i]) && std::ranges::find(light_layers, layers[i]) == light_layers.end())
      fail("layers", fmt::format("no layer is called '{}'{}", layers[i], suggestion(layers[i], known_layers())));
    const auto same = [&](const std::string& other) {
      return layers[i] == other || (!layers[i].starts_with(PictureFormat::path_prefix) &&
                                    SurfaceLayers::name_of(layers[i]) == SurfaceLayers::name_of(other));
    };
    if (std::any_of(layers.begin(), layers.begin() + std::ptrdiff_t(i), same))
      fail("layers", fmt::format("'{}' is named twice", SurfaceLayers::name_of(layers[i])));
  }
  for (const std::string& group : light_groups)
    if (group.empty())
      fail("layers", "'light.' needs the name of a luminaire, as in 'light.lamp'");
    else if (group == PictureFormat::rest_group)
      fail("layers", "'light.rest' is kept by itself where there are other light groups");
  if (light_groups.size() >= PictureFormat::most_light_groups)
    fail("layers",
         fmt::format("there may be {} light groups, not {}", PictureFormat::most_light_groups - 1, light_groups.size()));
  if (!light_groups.empty()) light_groups.emplace_back(PictureFormat::rest_group);

  for (size_t i = 0; i < path_layers.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (path_layers[i].name == path_layers[j].name)
        fail("layers", fmt::format("two layers are called 'path.{}'", path_layers[i].name));
  if (const size_t most = SplatLabel::most_expressions(light_groups.size()); path_layers.size() > most)
    fail("layers", fmt::format("there may be {} light path expressions{}, not {}", most,
                               light_groups.empty() ? "" : " beside so many light groups", path_layers.size()));

  if (!filter) fail("filter", "is missing");
  const float radius = filter->radius();
  if (!(radius >= 0.5f && radius <= maximum_filter_radius))
    fail("filter", fmt::format("its radius is {} pixels; it must be from 0.5 to {}", radius, maximum_filter_radius));
  constexpr int table_size = PictureFormat::table_size;
  std::vector<float> table;
  table.reserve(table_size * table_size);
  double sum = 0;
  const float cell = radius / table_size;
  for (int y = 0; y < table_size; ++y)
    for (int x = 0; x < table_size; ++x) {
      table.push_back(filter->weight((float(x) + 0.5f) * cell, (float(y) + 0.5f) * cell));
      sum += double(table.back());
    }
  if (!(sum > 0 && sum < double(std::numeric_limits<float>::max())))
    fail("filter", "its weights do not add up to a positive number");

  PictureFormat format;
  format.width = width;
  format.height = height;
  format.area = area;
  format.cropped = !crop.empty();
  format.layers = layers;
  format.surfaces = std::move(surfaces);
  format.path_lengths = path_lengths;
  format.light_groups = std::move(light_groups);
  format.path_layers = std::move(path_layers);
  format.stokes = wants(PictureFormat::stokes_layer);
  if (const auto* spectral = dynamic_cast<const HasBands*>(this)) format.bands = spectral->make_bands();
  format.set_filter(std::move(table), radius);
  format.sampled_area = intersection(widened(area, format.reach()), {0, 0, width, height});
  format_ = std::make_shared<const PictureFormat>(std::move(format));
}

}  // namespace etendue
