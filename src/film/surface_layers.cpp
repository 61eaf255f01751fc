#include "surface_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <optional>

#include "etendue/core/error.h"

namespace etendue {
namespace {

constexpr const char* motion_layer = "motion";

/// A layer of a number, and the ends of its channels' names.
struct NumberLayer {
  const char* name;
  SurfaceNumber number;
  std::array<const char*, 3> ends;
};
constexpr std::array<NumberLayer, 7> number_layers = {
    {{"albedo", SurfaceNumber::albedo, {".R", ".G", ".B"}},
     {"normal", SurfaceNumber::normal, {".X", ".Y", ".Z"}},
     {"geometric_normal", SurfaceNumber::geometric_normal, {".X", ".Y", ".Z"}},
     {"position", SurfaceNumber::position, {".X", ".Y", ".Z"}},
     {"depth", SurfaceNumber::depth, {".Z"}},
     {"uv", SurfaceNumber::uv, {".U", ".V"}},
     {"roughness", SurfaceNumber::roughness, {".R"}}}};

std::string_view trimmed(std::string_view s) {
  const size_t first = s.find_first_not_of(' '), last = s.find_last_not_of(' ');
  return first == s.npos ? std::string_view() : s.substr(first, last - first + 1);
}

/// What follows the '=' of an entry; nothing: there is none.
std::optional<std::string_view> setting_of(const std::string& entry) {
  const size_t equals = entry.find('=');
  if (equals == entry.npos) return std::nullopt;
  return trimmed(std::string_view(entry).substr(equals + 1));
}

template <class T>
std::optional<T> number_in(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The seconds of "0.04" or "0.04 s".
float seconds_in(std::string_view text) {
  std::string_view number = text;
  if (number.ends_with("s")) number = trimmed(number.substr(0, number.size() - 1));
  const std::optional<float> seconds = number_in<float>(number);
  if (!seconds || !(*seconds > 0) || !std::isfinite(*seconds))
    throw Error(fmt::format("'motion = …' needs a duration in seconds, as in 'motion = 0.04', not '{}'", text));
  return *seconds;
}

int ranks_in(const std::string& name, std::string_view text) {
  const std::optional<int> ranks = number_in<int>(text);
  if (!ranks || *ranks < 1 || *ranks > SurfaceLayers::most_ranks)
    throw Error(fmt::format("'{} = …' needs the number of coverages to keep of each pixel, from 1 to {}, not '{}'", name,
                            SurfaceLayers::most_ranks, text));
  return (*ranks + 1) / 2 * 2;  // a layer holds two
}

}  // namespace

std::string SurfaceLayers::name_of(const std::string& entry) {
  return std::string(trimmed(std::string_view(entry).substr(0, entry.find('='))));
}

std::vector<std::string> SurfaceLayers::offered() {
  std::vector<std::string> all;
  for (const NumberLayer& layer : number_layers) all.emplace_back(layer.name);
  for (const char* name : {"coverage", "object", "material", "primitive", motion_layer}) all.emplace_back(name);
  all.emplace_back(motion_layer + std::string(" = …"));
  for (const char* name : matte_layers) all.emplace_back(name);
  for (const char* name : matte_layers) all.emplace_back(name + std::string(" = …"));
  return all;
}

void SurfaceLayers::want(SurfaceNumber number) {
  if (places_[size_t(number)] < 0) places_[size_t(number)] = triples_++;
}

bool SurfaceLayers::take(const std::string& entry) {
  const std::string name = name_of(entry);
  const std::optional<std::string_view> setting = setting_of(entry);
  const auto kind = std::ranges::find_if(matte_layers, [&](const char* layer) { return name == layer; });
  if (kind != matte_layers.end()) {
    ranks[size_t(kind - matte_layers.begin())] = setting ? ranks_in(name, *setting) : usual_ranks;
  } else if (name == motion_layer) {
    if (setting) motion_time = seconds_in(*setting);
    want(SurfaceNumber::motion_previous);
    want(SurfaceNumber::motion_next);
  } else {
    const auto* number = std::ranges::find_if(number_layers, [&](const NumberLayer& layer) { return name == layer.name; });
    bool* const flag = name == "coverage"    ? &coverage
                       : name == "object"    ? &object
                       : name == "material"  ? &material
                       : name == "primitive" ? &primitive
                                             : nullptr;
    if (!flag && number == number_layers.end()) return false;
    if (setting) throw Error(fmt::format("'{}' takes no number: '{}'", name, *setting));
    flag ? void(*flag = true) : want(number->number);
  }
  names.push_back(name);
  return true;
}

bool SurfaceLayers::collects_as(const SurfaceLayers& b) const {
  return places_ == b.places_ && any() == b.any() && identifiers() == b.identifiers() && mattes() == b.mattes() &&
         motion_time == b.motion_time;
}

std::uint64_t SurfaceLayers::hash() const {
  std::uint64_t h = 0xcbf29ce484222325ull;  // FNV-1a
  const auto add = [&](std::uint32_t bits) { h = (h ^ bits) * 0x100000001b3ull; };
  for (const int place : places_) add(std::uint32_t(place + 1));
  add(std::uint32_t(any()) | std::uint32_t(identifiers()) << 1 | std::uint32_t(mattes()) << 2);
  add(std::bit_cast<std::uint32_t>(motion_time));
  return h;
}

std::vector<SurfaceChannel> channels_of(const SurfaceLayers& layers) {
  using enum SurfaceChannel::Source;
  std::vector<SurfaceChannel> channels;
  for (const std::string& name : layers.names) {
    if (const auto* layer = std::ranges::find_if(number_layers, [&](const NumberLayer& l) { return name == l.name; });
        layer != number_layers.end()) {
      for (int i = 0; i < 3 && layer->ends[size_t(i)]; ++i)
        channels.push_back({number, name + layer->ends[size_t(i)], layer->number, i});
    } else if (name == motion_layer) {
      channels.push_back({number, "motion.previous.X", SurfaceNumber::motion_previous, 0});
      channels.push_back({number, "motion.previous.Y", SurfaceNumber::motion_previous, 1});
      channels.push_back({number, "motion.next.X", SurfaceNumber::motion_next, 0});
      channels.push_back({number, "motion.next.Y", SurfaceNumber::motion_next, 1});
    } else if (name == "coverage") {
      channels.push_back({coverage, "coverage.A"});
    } else if (name == "object") {
      channels.push_back({object, "object.ID"});
    } else if (name == "material") {
      channels.push_back({material, "material.ID"});
    } else if (name == "primitive") {
      channels.push_back({primitive, "primitive.ID"});
    }
  }
  return channels;
}

}  // namespace etendue
