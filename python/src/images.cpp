// Pictures as arrays: reading, writing, display, comparison.

#include <fmt/format.h>

#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>

#include "arrays.h"
#include "etendue/describe/color.h"
#include "etendue/exposed_tone_map.h"
#include "etendue/film/image_tools.h"
#include "etendue/output.h"
#include "film/relight.h"
#include "live_render.h"
#include "picture.h"

namespace etendue::python {

nb::object pixels_of(const Picture& picture) {
  auto* const kept = new std::shared_ptr<const Image>(picture.image);
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::shared_ptr<const Image>*>(p); });
  const Image& image = **kept;
  const size_t shape[3] = {size_t(image.height), size_t(image.width), image.channels.size()};
  return nb::cast(nb::ndarray<nb::numpy, const double, nb::ndim<3>>(image.values.data(), 3, shape, owner),
                  nb::rv_policy::reference);
}

namespace {

bool has_channel(const Image& image, const char* name) {
  return std::find(image.channels.begin(), image.channels.end(), name) != image.channels.end();
}

/// The picture in a colour space; the picture itself if it is in that space already.
Picture converted(const Picture& picture, const std::string& space) {
  const std::string name = rgb_space(space).name;
  const Image& image = *picture.image;
  const auto known = [&](const char* key, const char* otherwise) {
    const auto found = image.metadata.find(key);
    return found == image.metadata.end() ? std::string(otherwise) : found->second;
  };
  const bool same = name == "xyz" ? has_channel(image, "X")
                                  : !has_channel(image, "X") && has_channel(image, "R") &&
                                        known("color_space", "srgb") == name && known("transfer", "linear") == "linear";
  if (same) return picture;
  return Picture(released([&] { return convert_color_space(image, space); }));
}

/// A prepared copy of a tone map, so that a part of a living render stays as it is.
Ref<ToneMap> prepared_tone_map(nb::handle part) {
  const Ref<ToneMap> map = ref_cast<ToneMap>(copy(*component_as<ToneMap>(part, "a tone map")));
  use_threads();
  released([&] { prepare_tree(*map); });
  return map;
}

/// The picture in R G B, encoded for a display, by a tone map; None: the values as they are.
Picture displayed(const Picture& picture, nb::handle tone_map) {
  use_threads();
  const Picture xyz = converted(picture, "xyz");
  const Ref<ToneMap> map =
      tone_map.is_none() ? ref_cast<ToneMap>(Registry::instance().create("NoToneMap")) : prepared_tone_map(tone_map);
  return Picture(released([&] { return map->apply(*xyz.image); }));
}

/// R, G and B of a displayed picture as PngOutput writes them, shape (height, width, 3).
nb::object eight_bits(const Picture& picture) {
  const Image& image = *picture.image;
  const size_t stride = image.channels.size(), count = size_t(image.width) * size_t(image.height);
  std::vector<std::uint8_t> bytes(3 * count);
  const auto first = size_t(std::find(image.channels.begin(), image.channels.end(), "R") - image.channels.begin());
  if (first + 3 > stride) throw Error("the picture has no channels R G B");
  for (size_t i = 0; i < bytes.size(); ++i) {
    const double v = image.values[i / 3 * stride + first + i % 3];
    bytes[i] = std::uint8_t(255 * (v > 0 ? std::min(v, 1.0) : 0) + 0.5);  // NaN becomes 0
  }
  return array_from(std::move(bytes), {size_t(image.height), size_t(image.width), 3});
}

/// Writes as an output part describes, by a tone map (None: none).
void write_picture(const Picture& picture, nb::handle part, nb::handle tone_map, const std::string& path) {
  const Ref<Output> output = ref_cast<Output>(copy(*component_as<Output>(part, "an output")));
  const bool bare = tone_map.is_none();
  const Picture written = output->for_display() || !bare ? displayed(picture, tone_map) : picture;
  released([&] {
    prepare_tree(*output);
    output->write_image(*written.image, path);
  });
}

/// The classes of outputs by their ending: (ending, class, whether it is for display).
nb::list output_formats() {
  nb::list formats;
  const ClassInfo* interface = Registry::instance().find("Output");
  for (const ClassInfo* c : released([&] { return Registry::instance().subclasses(*interface); })) {
    const Ref<Output> output = ref_cast<Output>(c->create());
    if (c->name != "DenoisedOutput") formats.append(nb::make_tuple(output->extension(), c->name, output->for_display()));
  }
  return formats;
}

nb::dict comparison(const Picture& a, const Picture& b, const std::string& space) {
  const Comparison c = released([&] { return compare(*a.image, *b.image, space); });
  nb::dict d;
  d["root_mean_square_error"] = c.root_mean_square_error;
  d["relative_mean_square_error"] = c.relative_mean_square_error;
  d["symmetric_error"] = c.symmetric_error;
  d["maximum_difference"] = c.maximum_difference;
  d["maximum_x"] = c.maximum_x;
  d["maximum_y"] = c.maximum_y;
  d["maximum_channel"] = c.maximum_channel;
  d["not_finite"] = c.not_finite;
  nb::list channels;
  for (const ChannelComparison& channel : c.channels) {
    nb::dict one;
    one["name"] = channel.name;
    one["mean_a"] = channel.mean_a;
    one["mean_b"] = channel.mean_b;
    one["ratio"] = channel.ratio;
    one["root_mean_square_error"] = channel.root_mean_square_error;
    one["maximum_difference"] = channel.maximum_difference;
    channels.append(one);
  }
  d["channels"] = channels;
  return d;
}

/// Ratios, means of a and means of b, each of shape (rows of tiles, columns of tiles).
nb::tuple ratios(const Picture& a, const Picture& b, int size) {
  const std::vector<TileRatio> tiles = released([&] { return tile_ratios(*a.image, *b.image, size); });
  const size_t columns = size_t((a.image->width + size - 1) / size), rows = size_t((a.image->height + size - 1) / size);
  std::vector<double> ratio, mean_a, mean_b;
  for (const TileRatio& tile : tiles) {
    ratio.push_back(tile.ratio);
    mean_a.push_back(tile.mean_a);
    mean_b.push_back(tile.mean_b);
  }
  return nb::make_tuple(array_from(std::move(ratio), {rows, columns}), array_from(std::move(mean_a), {rows, columns}),
                        array_from(std::move(mean_b), {rows, columns}));
}

using Numbers3 = nb::ndarray<const double, nb::numpy, nb::c_contig, nb::ndim<3>>;

/// A picture of a copy of the numbers.
Picture picture_from(const Numbers3& array, const std::vector<std::string>& channels,
                     const std::map<std::string, std::string>& metadata) {
  Image image(int(array.shape(1)), int(array.shape(0)), channels);
  std::copy_n(array.data(), image.values.size(), image.values.begin());
  image.metadata = metadata;
  return Picture(std::move(image));
}

}  // namespace

void bind_images(nb::module_& m) {
  nb::class_<Picture>(m, "Picture", "An image of the library; etendue.Image is the comfortable one.")
      .def_prop_ro("width", [](const Picture& p) { return p.image->width; })
      .def_prop_ro("height", [](const Picture& p) { return p.image->height; })
      .def_prop_ro("channels", [](const Picture& p) { return p.image->channels; })
      .def_prop_ro("metadata", [](const Picture& p) { return p.image->metadata; })
      .def_prop_ro("pixels", &pixels_of)
      .def_prop_ro("address", [](const Picture& p) { return reinterpret_cast<std::uintptr_t>(p.image->values.data()); });
  m.def("read_picture", [](const std::string& file) { return Picture(released([&] { return read_image(file); })); });
  m.def("picture_from", &picture_from);
  m.def("converted", &converted);
  m.def("displayed", &displayed, nb::arg("picture"), nb::arg("tone_map").none());
  m.def("eight_bits", &eight_bits);
  m.def("write_picture", &write_picture, nb::arg("picture"), nb::arg("output"), nb::arg("tone_map").none(), nb::arg("path"));
  m.def("output_formats", &output_formats);
  m.def("color_spaces", &rgb_space_names);
  m.def("color_space_named", [](const std::string& name) {
    try {
      return rgb_space(name).name;
    } catch (const Error& e) {
      throw Error(e.what(), calling_line());
    }
  });
  m.def("transfers", &transfer_names);
  m.def("decode_transfer", [](const std::string& transfer, const nb::ndarray<const double, nb::numpy, nb::c_contig>& encoded) {
    std::vector<double> linear(encoded.data(), encoded.data() + encoded.size());
    for (double& v : linear) v = decode_transfer(transfer, v);
    return array_from(std::move(linear), {encoded.size()});
  });
  m.def("exposure_factor", [](const Picture& picture, nb::handle part) -> nb::object {
    const Ref<ToneMap> map = prepared_tone_map(part);
    const auto* const exposed = dynamic_cast<const ExposedToneMap*>(map.get());
    if (!exposed) return nb::none();
    const Picture xyz = converted(picture, "xyz");
    return nb::float_(released([&] { return exposed->exposure_factor(*xyz.image); }));
  });
  m.def("describe_picture", [](const Picture& p) { return released([&] { return describe_image(*p.image); }); });
  m.def("compare", &comparison);
  m.def("tile_ratios", &ratios);
  m.def("relight", [](const Picture& picture, const std::map<std::string, std::array<double, 3>>& factors) {
    return Picture(released([&] { return relit(*picture.image, factors); }));
  });
}

}  // namespace etendue::python
