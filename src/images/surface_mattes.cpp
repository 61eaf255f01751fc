#include "surface_mattes.h"

#include <algorithm>
#include <functional>

namespace etendue {
namespace {

Cryptomatte mattes_of_kind(const SurfaceSnapshot& surfaces, size_t kind) {
  const PictureFormat& format = surfaces.format();
  Cryptomatte made{matte_layers[kind], {}, format.area.width(), format.area.height(), {}};
  std::map<std::uint64_t, std::uint32_t> identifiers;
  for (const auto& [key, names] : surfaces.names())
    if (const std::string& name = names[kind]; !name.empty())
      identifiers[key] = made.manifest[name] = cryptomatte_identifier(name);
  made.pixels.resize(format.pixels());
  std::vector<std::pair<std::uint32_t, std::int64_t>> weights;
  for (size_t i = 0; i < surfaces.shares().size(); ++i) {
    weights.clear();
    for (const SurfaceShare& share : surfaces.shares()[i])
      if (const auto found = identifiers.find(share.key); found != identifiers.end())
        weights.emplace_back(found->second, share.weight);
    std::ranges::sort(weights);
    const auto whole = double(surfaces.whole(i));
    std::vector<Cryptomatte::Rank>& ranks = made.pixels[i];
    for (size_t first = 0, end = 0; first < weights.size(); first = end) {
      std::int64_t sum = 0;
      for (; end < weights.size() && weights[end].first == weights[first].first; ++end) sum += weights[end].second;
      // Filters with negative weights can give negative sums, and more than the whole.
      if (sum > 0 && whole > 0) ranks.push_back({weights[first].first, float(std::min(double(sum) / whole, 1.0))});
    }
    std::ranges::stable_sort(ranks, std::greater(), &Cryptomatte::Rank::coverage);
  }
  return made;
}

}  // namespace

std::vector<Cryptomatte> mattes_of(const SurfaceSnapshot& surfaces) {
  std::vector<Cryptomatte> kinds;
  for (size_t kind = 0; kind < matte_kinds; ++kind)
    if (surfaces.format().surfaces.ranks[kind] > 0) kinds.push_back(mattes_of_kind(surfaces, kind));
  return kinds;
}

void add_mattes(Image& image, const SurfaceSnapshot& surfaces) {
  for (size_t kind = 0; kind < matte_kinds; ++kind)
    if (const int ranks = surfaces.format().surfaces.ranks[kind]; ranks > 0)
      add_cryptomatte(image, mattes_of_kind(surfaces, kind), size_t(ranks));
}

}  // namespace etendue
