#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "etendue/describe/color.h"
#include "etendue/film/image_tools.h"
#include "etendue/output.h"
#include "files/contained_file.h"
#include "files/regular_file.h"
#include "image_library.h"
#include "numpy_array.h"
#include "stated_encoding.h"

namespace etendue {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw Error(fmt::format("cannot read '{}': {}", path, reason));
}

std::string lower_extension(const std::string& path) {
  std::string e = std::filesystem::path(path).extension().string();
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return e;
}

bool known_space(const std::string& name) {
  const std::vector<std::string> names = rgb_space_names();
  return name == "xyz" || std::find(names.begin(), names.end(), name) != names.end();
}

/// The encoding of the values: as the file's metadata state, else as the image library states.
std::string encoding(const StoredImage& stored) {
  const std::vector<std::string> known = transfer_names();
  const auto said = stored.image.metadata.find("transfer");
  if (said != stored.image.metadata.end() && std::find(known.begin(), known.end(), said->second) != known.end())
    return said->second;
  return stored.transfer;
}

void decode(Image& image, const std::string& transfer) {
  if (transfer == "linear") return;
  for (size_t c = 0; c < image.channels.size(); ++c) {
    const std::string& name = image.channels[c];
    if (name != "R" && name != "G" && name != "B") continue;
    for (size_t i = c; i < image.values.size(); i += image.channels.size())
      image.values[i] = decode_transfer(transfer, image.values[i]);
  }
}

/// A grey image with its grey channel replaced by three equal ones, followed by the other channels.
Image spread_grey(const Image& image, size_t grey) {
  std::vector<std::string> channels = {"R", "G", "B"};
  for (size_t c = 0; c < image.channels.size(); ++c)
    if (c != grey) channels.push_back(image.channels[c]);
  Image out(image.width, image.height, std::move(channels));
  out.metadata = image.metadata;
  for (size_t i = 0, o = 0; i < image.values.size(); i += image.channels.size()) {
    for (int k = 0; k < 3; ++k) out.values[o++] = image.values[i + grey];
    for (size_t c = 0; c < image.channels.size(); ++c)
      if (c != grey) out.values[o++] = image.values[i + c];
  }
  return out;
}

Image read_numpy(const std::string& path, std::uint64_t size) {
  if (size / 8 > NumpyArray::most_numbers + 1024) refuse(path, "it is too large: at most 2^30 numbers are read");
  try {
    const FileContents file(path);
    Image image = parse_numpy_array(file.text());
    return image.channels.size() == 1 ? spread_grey(image, 0) : image;
  } catch (const Error& e) {
    refuse(path, e.what());
  }
}

StoredImage read_stored(const std::string& path) {
  try {
    return image_library().read(path);
  } catch (const Error& e) {
    refuse(path, e.what());
  }
}

/// The size of a file. Throws Error if it does not exist or is empty.
std::uint64_t size_of(const std::string& path) {
  std::error_code code;
  if (std::filesystem::status(file_on_disk(path), code).type() == std::filesystem::file_type::not_found)
    refuse(path, "there is no such file");
  std::uint64_t size = 0;
  try {
    size = RegularFile(path).size();
  } catch (const Error& e) {
    refuse(path, e.what());
  }
  if (size == 0) refuse(path, "it is empty");
  return size;
}

/// `stored_as` is set to the encoding of the file's numbers.
Image read_whole_image(const std::string& path, std::string& stored_as) {
  const std::uint64_t size = size_of(path);
  stored_as = "linear";
  if (lower_extension(path) == ".npy") return read_numpy(path, size);

  StoredImage stored = read_stored(path);
  const std::string transfer = stored_as = encoding(stored);
  Image image = std::move(stored.image);
  const auto has = [&](const char* name) {
    return std::find(image.channels.begin(), image.channels.end(), name) != image.channels.end();
  };
  if (!has("R") && !has("X")) {
    // A single channel of any name, or a luminance with other channels.
    const auto y = std::find(image.channels.begin(), image.channels.end(), "Y");
    if (y != image.channels.end() || image.channels.size() <= 2)
      image = spread_grey(image, y == image.channels.end() ? 0 : size_t(y - image.channels.begin()));
  }
  decode(image, transfer);
  if (has("X") && has("Y") && has("Z")) {
    image.metadata["color_space"] = "xyz";
    image.metadata.erase("transfer");
  } else {
    const auto said = image.metadata.find("color_space");
    if (said == image.metadata.end() || !known_space(said->second)) image.metadata["color_space"] = "srgb";
    image.metadata["transfer"] = "linear";
  }
  return image;
}

Image read_image(const std::string& path, std::string& stored_as) {
  try {
    return read_whole_image(path, stored_as);
  } catch (const std::bad_alloc&) {
    refuse(path, no_memory_to_read);
  }
}

}  // namespace

Image read_image(const std::string& path) {
  std::string ignored;
  return read_image(path, ignored);
}

void write_any(const Image& image, const std::string& path) {
  const ClassInfo* interface = Registry::instance().find("Output");
  std::vector<std::string> known;
  if (interface)
    for (const ClassInfo* c : Registry::instance().subclasses(*interface)) {
      const Ref<Output> output = ref_cast<Output>(Registry::instance().create(c->name));
      known.push_back(output->extension());
      if (output->extension() != lower_extension(path)) continue;
      output->prepare();
      const auto transfer = image.metadata.find("transfer");
      const bool encoded = transfer != image.metadata.end() && transfer->second != "linear";
      const bool rgb = std::find(image.channels.begin(), image.channels.end(), "R") != image.channels.end();
      if (output->for_display() && !(rgb && encoded)) {
        const Ref<ToneMap> encode = ref_cast<ToneMap>(Registry::instance().create("NoToneMap"));
        output->write_image(encode->apply(convert_color_space(image, "xyz")), path);
      } else {
        output->write_image(image, path);
      }
      return;
    }
  std::string list;
  for (const std::string& e : known) list += (list.empty() ? "" : ", ") + e;
  throw Error(fmt::format("cannot write '{}': no output has this ending; known are {}", path, list));
}

std::string describe_image(const std::string& path) {
  std::string stored_as;
  const Image image = read_image(path, stored_as);
  std::string text = path + "\n";
  const std::vector<std::string> said = stated_encoding(path);
  for (const std::string& line : said) text += "  the file says " + line + "\n";
  if (said.empty()) text += "  the file says nothing of its colours' encoding\n";
  text += fmt::format("  stored as {}; the values below are linear\n", stored_as);
  return text + describe_image(image);
}

std::string describe_image(const Image& image) {
  std::string text = fmt::format("  {} x {} pixels, {} channels\n", image.width, image.height, image.channels.size());
  for (const auto& [name, value] : image.metadata) text += fmt::format("  {}: {}\n", name, value);
  size_t width = 8;
  for (const std::string& c : image.channels) width = std::max(width, c.size());
  text += fmt::format("  {:<{}} {:>13} {:>13} {:>13} {:>10}\n", "channel", width, "minimum", "mean", "maximum", "not finite");
  for (size_t c = 0; c < image.channels.size(); ++c) {
    double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0;
    size_t count = 0, bad = 0;
    for (size_t i = c; i < image.values.size(); i += image.channels.size()) {
      const double v = image.values[i];
      if (!std::isfinite(v)) {
        ++bad;
        continue;
      }
      low = std::min(low, v);
      high = std::max(high, v);
      sum += v;
      ++count;
    }
    if (count == 0) low = high = 0;
    text += fmt::format("  {:<{}} {:>13.6g} {:>13.6g} {:>13.6g} {:>10}\n", image.channels[c], width, low,
                        count ? sum / double(count) : 0.0, high, bad);
  }
  return text;
}

}  // namespace etendue
