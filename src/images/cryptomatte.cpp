#include "cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "etendue/core/error.h"

namespace etendue {
namespace {

using Json = nlohmann::ordered_json;

/// The key of the metadata of one kind begins with 7 hexadecimal digits of the hash of its name.
std::string prefix_of(const std::string& name) {
  return fmt::format("cryptomatte/{:08x}", murmur_hash3(name)).substr(0, 19) + "/";
}

constexpr const char* letters = "RGBA";

}  // namespace

std::uint32_t murmur_hash3(std::string_view text) {
  constexpr std::uint32_t c1 = 0xcc9e2d51u, c2 = 0x1b873593u;
  const auto byte = [&](size_t i) { return std::uint32_t(static_cast<unsigned char>(text[i])); };
  const auto mixed = [&](std::uint32_t k) { return std::rotl(k * c1, 15) * c2; };
  std::uint32_t h = 0;
  const size_t whole = text.size() / 4 * 4;
  for (size_t i = 0; i < whole; i += 4) {
    h ^= mixed(byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24);
    h = std::rotl(h, 13) * 5 + 0xe6546b64u;
  }
  std::uint32_t rest = 0;
  for (size_t i = text.size(); i > whole; --i) rest = (rest << 8) | byte(i - 1);
  h ^= mixed(rest);
  h ^= std::uint32_t(text.size());
  h ^= h >> 16;
  h *= 0x85ebca6bu;
  h ^= h >> 13;
  h *= 0xc2b2ae35u;
  return h ^ (h >> 16);
}

std::uint32_t cryptomatte_identifier(std::string_view name) {
  const std::uint32_t hash = murmur_hash3(name), exponent = (hash >> 23) & 255;
  return exponent == 0 || exponent == 255 ? hash ^ (1u << 23) : hash;
}

void add_cryptomatte(Image& image, const Cryptomatte& kind, size_t ranks) {
  for (size_t rank = 0; rank < ranks; ++rank)
    for (const size_t part : {size_t(0), size_t(1)})
      image.channels.push_back(fmt::format("{}{:02}.{}", kind.name, rank / 2, letters[rank % 2 * 2 + part]));
  const std::string prefix = prefix_of(kind.name);
  image.metadata[prefix + "name"] = kind.name;
  image.metadata[prefix + "hash"] = "MurmurHash3_32";
  image.metadata[prefix + "conversion"] = "uint32_to_float32";
  Json manifest = Json::object();
  for (const auto& [name, identifier] : kind.manifest) manifest[name] = fmt::format("{:08x}", identifier);
  image.metadata[prefix + "manifest"] = manifest.dump(-1, ' ', false, Json::error_handler_t::replace);

  const size_t count = size_t(image.width) * size_t(image.height), after = image.channels.size(), before = after - 2 * ranks;
  std::vector<double> values(count * after);
  for (size_t i = 0; i < count; ++i) {
    double* at = &values[i * after];
    at = std::copy_n(image.values.begin() + std::ptrdiff_t(i * before), before, at);
    for (size_t rank = 0; rank < std::min(ranks, kind.pixels[i].size()); ++rank) {
      *at++ = double(std::bit_cast<float>(kind.pixels[i][rank].identifier));
      *at++ = double(kind.pixels[i][rank].coverage);
    }
  }
  image.values = std::move(values);
}

Image cryptomatte_image(std::span<const Cryptomatte> kinds, int ranks) {
  Image image;
  for (const Cryptomatte& kind : kinds) {
    image.width = kind.width;
    image.height = kind.height;
    size_t most = 1;
    for (const auto& pixel : kind.pixels) most = std::max(most, pixel.size());
    if (ranks > 0) most = std::min(most, size_t(ranks));
    add_cryptomatte(image, kind, (most + 1) / 2 * 2);
  }
  return image;
}

namespace {

/// The channels of the ranks, in their order: identifier, coverage, identifier, ...
std::vector<size_t> channels_of(const Image& image, const std::string& name) {
  std::vector<size_t> found;
  for (size_t rank = 0;; ++rank) {
    const auto channel = fmt::format("{}{:02}.{}", name, rank / 4, letters[rank % 4]);
    const auto at = std::ranges::find(image.channels, channel);
    if (at == image.channels.end()) {
      if (rank % 2) throw Error(fmt::format("the mattes '{}' have no channel '{}'", name, channel));
      return found;
    }
    found.push_back(size_t(at - image.channels.begin()));
  }
}

std::map<std::string, std::uint32_t> manifest_of(const std::string& text, const std::string& name) {
  std::map<std::string, std::uint32_t> manifest;
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) throw Error(fmt::format("the manifest of the mattes '{}' is not JSON", name));
  for (const auto& [key, value] : json.items()) {
    const std::string digits = value.is_string() ? value.get<std::string>() : "";
    if (digits.size() != 8 || digits.find_first_not_of("0123456789abcdefABCDEF") != digits.npos)
      throw Error(fmt::format("the manifest of the mattes '{}' gives '{}' no identifier of 8 hexadecimal digits", name, key));
    manifest[key] = std::uint32_t(std::stoul(digits, nullptr, 16));
  }
  return manifest;
}

}  // namespace

std::vector<Cryptomatte> cryptomattes_of(const Image& image) {
  std::vector<Cryptomatte> kinds;
  for (const auto& [key, value] : image.metadata) {
    if (!key.starts_with("cryptomatte/") || !key.ends_with("/name")) continue;
    const std::string prefix = key.substr(0, key.size() - 4);
    Cryptomatte kind;
    kind.name = value;
    const auto stated = [&](const char* what) {
      const auto found = image.metadata.find(prefix + what);
      return found == image.metadata.end() ? std::string() : found->second;
    };
    if (stated("conversion") != "uint32_to_float32" || stated("hash") != "MurmurHash3_32")
      throw Error(fmt::format("the mattes '{}' are of another kind: their hash is '{}' and their conversion '{}'", kind.name,
                              stated("hash"), stated("conversion")));
    if (const std::string manifest = stated("manifest"); !manifest.empty()) kind.manifest = manifest_of(manifest, kind.name);
    const std::vector<size_t> channels = channels_of(image, kind.name);
    if (channels.empty()) throw Error(fmt::format("the mattes '{}' have no channels", kind.name));
    kind.width = image.width;
    kind.height = image.height;
    kind.pixels.resize(size_t(image.width) * size_t(image.height));
    for (size_t i = 0; i < kind.pixels.size(); ++i) {
      const double* const values = &image.values[i * image.channels.size()];
      for (size_t c = 0; c + 1 < channels.size(); c += 2)
        if (const auto coverage = float(values[channels[c + 1]]); coverage > 0)
          kind.pixels[i].push_back({std::bit_cast<std::uint32_t>(float(values[channels[c]])), coverage});
    }
    kinds.push_back(std::move(kind));
  }
  return kinds;
}

std::vector<float> coverage_of(const Cryptomatte& kind, std::uint32_t identifier) {
  std::vector<float> coverage;
  coverage.reserve(kind.pixels.size());
  for (const auto& pixel : kind.pixels) {
    float sum = 0;
    for (const Cryptomatte::Rank& rank : pixel)
      if (rank.identifier == identifier) sum += rank.coverage;
    coverage.push_back(std::min(sum, 1.0f));
  }
  return coverage;
}

}  // namespace etendue
