#include "texture_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <numbers>
#include <optional>

#include "components/maps/image_texture.h"
#include "etendue/core/error.h"
#include "images/image_library.h"
#include "images/linear_image.h"
#include "images/udim_files.h"

namespace etendue::osl {

/// What gettextureinfo tells of a file; read when it is first asked for.
struct TextureFiles::Facts {
  std::vector<int> resolution, data_window, display_window;
  std::vector<float> average, constant;  // of each channel; constant is empty if a channel varies
  std::map<std::string, std::string> texts;
};

struct TextureFiles::File {
  std::string path, transfer;
  std::string reason;                         ///< why it cannot be used; empty: it can
  std::vector<std::string> channels;          ///< names, in the file's order
  std::shared_ptr<const ImageTexture> whole;  ///< R, G and B at once
  std::once_flag parts_opened[5];             ///< channels one by one
  std::shared_ptr<const ImageTexture> parts[5];
  std::once_flag facts_read;
  std::unique_ptr<Facts> facts;

  /// One channel alone; null if the file does not have it.
  const ImageTexture* part(int channel) {
    if (channel < 0 || channel >= int(channels.size()) || channel >= 5) return nullptr;
    std::call_once(parts_opened[channel], [&] {
      try {
        parts[channel] = ImageTexture::open(path, transfer, channels[std::size_t(channel)]);
      } catch (const Error&) {
      }
    });
    return parts[channel].get();
  }
};

TextureFiles::TextureFiles(std::vector<std::string> folders) : folders_(std::move(folders)) {}
TextureFiles::~TextureFiles() = default;

/// Where a relative name is searched before the working folder.
std::vector<std::string> TextureFiles::folders_of(const TextureName& name) const {
  std::vector<std::string> folders;
  for (const char* file : {name.shader_file, name.scene_file})
    if (*file) folders.push_back(std::filesystem::path(file).parent_path().string());
  folders.insert(folders.end(), folders_.begin(), folders_.end());
  std::erase(folders, std::string());  // the working folder
  return folders;
}

std::string TextureFiles::found(const TextureName& name) const {
  const std::string& text = name.text->text();
  if (!std::filesystem::path(text).is_relative()) return text;
  std::error_code ignored;
  const bool tiled = text.find(udim_mark) != std::string::npos;
  for (const std::string& folder : folders_of(name)) {
    const std::string path = (std::filesystem::path(folder) / text).string();
    if (tiled ? !udim_files(path).empty() : std::filesystem::exists(path, ignored)) return path;
  }
  return text;
}

TextureFiles::File& TextureFiles::opened(const TextureName& name, const TextureOptions* options) {
  const String* space = options ? options->color_space : nullptr;
  {
    // Each lookup of each thread comes here: readers do not wait for one another.
    const std::shared_lock lock(mutex_);
    if (const auto known = files_.find({name, space}); known != files_.end()) return *known->second;
  }
  const std::unique_lock lock(mutex_);
  std::unique_ptr<File>& file = files_[{name, space}];
  if (file) return *file;
  file = std::make_unique<File>();
  file->path = found(name);
  file->transfer = space && (space->view() == "sRGB" || space->view() == "srgb") ? "srgb" : "linear";
  const std::string& text = name.text->text();
  if (text.empty()) {
    file->reason = "a texture without a file's name";
    return *file;
  }
  std::error_code ignored;
  if (std::filesystem::path(text).is_relative() && !std::filesystem::exists(file->path, ignored)) {
    std::vector<std::string> places = folders_of(name);
    places.erase(std::unique(places.begin(), places.end()), places.end());
    std::string places_text;
    for (const std::string& folder : places) places_text += fmt::format("'{}', ", folder);
    if (!places_text.empty()) places_text.replace(places_text.size() - 2, 2, " or ");
    file->reason = fmt::format("there is no file '{}' in {}the working folder", text, places_text);
    return *file;
  }
  try {
    file->channels = image_channels(file->path);
    file->whole = ImageTexture::open(file->path, file->transfer, "");
  } catch (const Error& e) {
    file->reason = e.what();
  }
  return *file;
}

/// Of "x.<UDIM>.tx" the file that covers the unit square of (s, t).
TextureFiles::File& TextureFiles::tile(const TextureName& pattern, float s, float t, const TextureOptions* options) {
  const std::string& text = pattern.text->text();
  const std::size_t mark = text.find(udim_mark);
  if (mark == std::string::npos) return opened(pattern, options);
  const auto whole = [](float x, float most) { return x > 0 ? int(std::min(std::floor(x), most)) : 0; };
  const int u = whole(s, 9), v = whole(t, 899);
  std::string name = text;
  name.replace(mark, std::string_view(udim_mark).size(), std::to_string(1001 + u + 10 * v));
  return opened({intern_string(name), pattern.shader_file, pattern.scene_file}, options);
}

// ---- lookups
// -----------------------------------------------------------------------------------------------------------------------

namespace {

Wrap wrap_of(const String* name) {
  const std::string_view text = name ? name->view() : "";
  if (text == "periodic") return Wrap::repeat;
  if (text == "mirror") return Wrap::mirror;
  if (text == "clamp") return Wrap::clamp;
  return Wrap::black;
}

/// The filter's ellipse: the picture's pixel in the coordinates (s, t), by the axes of the singular value decomposition of the
/// matrix of derivatives. The blur is a width that is added.
UvFootprint footprint(const Dual<float>& s, const Dual<float>& t, const TextureOptions& o) {
  const float a = s.dx * o.width[0], b = s.dy * o.width[0], c = -t.dx * o.width[1], d = -t.dy * o.width[1];
  // J J^T = (p q; q r) has the squared half axes as its eigenvalues.
  const float p = a * a + b * b, q = a * c + b * d, r = c * c + d * d;
  const float mean = (p + r) / 2, spread = std::sqrt((p - r) * (p - r) / 4 + q * q);
  const float angle = 0.5f * std::atan2(2 * q, p - r);
  const float blur = (o.blur[0] + o.blur[1]) / 2;
  const float longer = std::sqrt(std::max(0.0f, mean + spread)) + blur,
              shorter = std::sqrt(std::max(0.0f, mean - spread)) + blur;
  const float cosine = std::cos(angle), sine = std::sin(angle);
  return {{longer * cosine, longer * sine}, {-shorter * sine, shorter * cosine}};
}

float longest(const UvFootprint& f) { return std::hypot(f.longer.x, f.longer.y); }

struct Sampler {
  UvFootprint ellipse;
  Wraps wraps;
  bool closest, filtered;

  void sample(const ImageTexture& texture, float s, float t, float* out) const {
    const Point2 at{s, 1 - t};
    if (closest)
      texture.nearest(at, wraps, out);
    else if (filtered)
      texture.mean(at, ellipse, wraps, out);
    else
      texture.bilinear(at, wraps, out);
  }
};

}  // namespace

std::string_view TextureFiles::texture(const TextureName& name, const Dual<float>& s, const Dual<float>& t,
                                       const TextureOptions& options, TextureLookup& lookup) {
  File& file = tile(name, s.value, t.value, &options);
  const int count = lookup.channels + (lookup.wants_alpha ? 1 : 0);
  if (!file.reason.empty()) {
    const bool replaced = options.has_missing_color;
    for (int i = 0; i < lookup.channels; ++i) lookup.value[i] = replaced ? options.missing_color[i] : 0;
    lookup.value[lookup.channels] = replaced ? options.missing_alpha : 1;
    return replaced ? std::string_view() : std::string_view(file.reason);
  }
  const bool tiled = name.text->text().find(udim_mark) != std::string::npos;
  const float s0 = tiled ? s.value - std::floor(s.value) : s.value, t0 = tiled ? t.value - std::floor(t.value) : t.value;
  Sampler sampler{footprint(s, t, options),
                  tiled ? Wraps(Wrap::clamp) : Wraps(wrap_of(options.wrap[0]), wrap_of(options.wrap[1])), false, false};
  sampler.closest = options.interpolation && options.interpolation->view() == "closest";
  sampler.filtered = longest(sampler.ellipse) > 0;
  // Derivatives by differences over about the filter's width.
  const float step = std::max(longest(sampler.ellipse), 1.0f / 1024) / 2;
  const auto all = [&](float x, float y, float* out) {
    int first = 0;
    if (options.first_channel == 0 && lookup.channels == 3 && file.channels.size() >= 3 && file.whole->channels() == 3) {
      sampler.sample(*file.whole, x, y, out);
      first = 3;
    }
    for (int i = first; i < count; ++i) {
      const ImageTexture* part = file.part(options.first_channel + i);
      if (part)
        sampler.sample(*part, x, y, out + i);
      else
        out[i] = i == lookup.channels ? 1 : options.fill;  // what has no alpha is opaque
    }
  };
  float buffer[5];
  all(s0, t0, buffer);
  std::copy_n(buffer, count, lookup.value);
  if (!lookup.wants_derivatives) return {};
  float more[5], less[5];
  all(s0 + step, t0, more), all(s0 - step, t0, less);
  for (int i = 0; i < count; ++i) lookup.by_s[i] = (more[i] - less[i]) / (2 * step);
  all(s0, t0 + step, more), all(s0, t0 - step, less);
  for (int i = 0; i < count; ++i) lookup.by_t[i] = (more[i] - less[i]) / (2 * step), lookup.by_r[i] = 0;
  return {};
}

/// Longitude and latitude, y upwards: s = 1/2 in the direction +z, 3/4 in -x; t = 0 at +y.
std::string_view TextureFiles::environment(const TextureName& name, const Dual<Triple>& direction,
                                           const TextureOptions& options, TextureLookup& lookup) {
  const auto coordinates = [](const Triple& d) {
    const float size = length(d);
    const float y = size > 0 ? std::clamp(d.y / size, -1.0f, 1.0f) : 0;
    return std::pair(0.5f + std::atan2(-d.x, d.z) / (2 * std::numbers::pi_v<float>), std::acos(y) / std::numbers::pi_v<float>);
  };
  const auto [s, t] = coordinates(direction.value);
  Dual<float> ds(s), dt(t);
  const auto by = [&](const Triple& change, float& s_change, float& t_change) {
    const auto [s1, t1] = coordinates(direction.value + change);
    s_change = s1 - s, t_change = t1 - t;
    s_change -= std::round(s_change);  // across the seam
  };
  by(direction.dx, ds.dx, dt.dx), by(direction.dy, ds.dy, dt.dy);
  TextureOptions around = options;
  around.wrap[0] = intern_string("periodic"), around.wrap[1] = intern_string("clamp");
  return texture(name, ds, dt, around, lookup);
}

// ---- facts
// -------------------------------------------------------------------------------------------------------------------------

const TextureFiles::Facts& TextureFiles::facts(File& file) {
  std::call_once(file.facts_read, [&] {
    file.facts = std::make_unique<Facts>();
    try {
      const StoredImage stored = image_library().read(file.path);
      const Image& image = stored.image;
      Facts& f = *file.facts;
      const auto number = [&](const char* key, int otherwise) {
        const auto text = image.metadata.find(key);
        return text == image.metadata.end() ? otherwise : std::atoi(text->second.c_str());
      };
      const int x = number("crop_x", 0), y = number("crop_y", 0);
      f.resolution = {image.width, image.height};
      f.data_window = {x, y, x + image.width - 1, y + image.height - 1};
      f.display_window = {0, 0, number("full_width", image.width) - 1, number("full_height", image.height) - 1};
      f.texts = image.metadata;
      const std::size_t channels = image.channels.size(), pixels = std::size_t(image.width) * std::size_t(image.height);
      std::vector<double> sums(channels);
      bool varies = false;
      for (std::size_t i = 0; i < pixels * channels; ++i) {
        sums[i % channels] += image.values[i];
        varies = varies || image.values[i] != image.values[i % channels];
      }
      for (std::size_t c = 0; c < channels; ++c) f.average.push_back(float(sums[c] / double(std::max<std::size_t>(pixels, 1))));
      if (!varies)
        for (std::size_t c = 0; c < channels; ++c) f.constant.push_back(float(image.values[c]));
    } catch (const Error&) {
    }
  });
  return *file.facts;
}

bool TextureFiles::texture_info(const TextureName& name, const float* at, const String* fact, const Type& type, void* out) {
  const std::string_view what = fact->view();
  const bool tiled = name.text->text().find(udim_mark) != std::string::npos;
  File& file = tiled ? tile(name, at ? at[0] : 0, at ? at[1] : 0, nullptr) : opened(name, nullptr);
  const auto whole = [&](const std::vector<int>& values) {
    if (type.base != Base::int_ || values.empty() || type.elements() != int(values.size())) return false;
    std::copy(values.begin(), values.end(), static_cast<int*>(out));
    return true;
  };
  const auto real = [&](const std::vector<float>& values, std::size_t first, std::size_t count) {
    if (type.floats() * type.elements() != int(count) || values.size() < first + count) return false;
    std::copy_n(values.begin() + std::ptrdiff_t(first), count, static_cast<float*>(out));
    return true;
  };
  const auto text = [&](const std::string& value) {
    return type.is_string() && (*static_cast<const String**>(out) = intern_string(value), true);
  };
  if (what == "exists") {
    bool exists = file.reason.empty();
    if (tiled && !at) exists = !udim_files(found(name)).empty();
    return whole({exists});
  }
  if (!file.reason.empty() || (tiled && !at && what == "resolution")) return false;
  if (what == "channels") return whole({int(file.channels.size())});
  if (what == "texturetype" || what == "textureformat") return text("Plain Texture");
  const Facts& f = facts(file);
  if (what == "resolution")
    return whole(type.elements() == 3 ? std::vector<int>{f.resolution[0], f.resolution[1], 1} : f.resolution);
  if (what == "datawindow") return whole(f.data_window);
  if (what == "displaywindow") return whole(f.display_window);
  if (what == "averagecolor") return real(f.average, 0, 3);
  if (what == "averagealpha") return real(f.average, 3, 1);
  if (what == "constantcolor") return real(f.constant, 0, 3);
  if (what == "constantalpha") return real(f.constant, 3, 1);
  const auto entry = f.texts.find(fact->text());
  return entry != f.texts.end() && text(entry->second);
}

}  // namespace etendue::osl
