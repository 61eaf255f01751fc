#include "picture_format.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace etendue {

// Computes the exact integrals of the table, which is constant in each of its cells.
void PictureFormat::set_filter(std::vector<float> weights, float filter_radius) {
  table = std::move(weights);
  radius = filter_radius;
  const float largest = std::ranges::max(table, {}, [](float w) { return std::abs(w); });
  fixed_weights.clear();
  for (const float w : table) fixed_weights.push_back(std::llround(double(w) / double(std::abs(largest)) * 0x1p30));
  box = radius == 0.5f && std::all_of(table.begin(), table.end(), [&](float w) { return w == table[0]; });
  filter_reach = int(std::ceil(radius - 0.5f));
  const int side = filter_reach + 1;
  shares.assign(size_t(side) * size_t(side), {});
  const double cell = double(radius) / table_size;
  // The length of a table cell within the pixel `away` pixels from the filter's own pixel, on one side of the centre.
  const auto covered = [&](int i, int away) {
    const auto up_to = [&](double distance) { return std::clamp(distance / cell - i, 0.0, 1.0) * cell; };
    return away == 0 ? 2 * up_to(0.5) : up_to(away + 0.5) - up_to(away - 0.5);
  };
  whole = {};
  for (int dy = 0; dy < side; ++dy)
    for (int dx = 0; dx < side; ++dx) {
      Integral& share = shares[size_t(dy * side + dx)];
      for (int y = 0; y < table_size; ++y) {
        const double down = covered(y, dy);
        if (down == 0) continue;
        Integral row;
        for (int x = 0; x < table_size; ++x) {
          const double across = covered(x, dx), weight = double(table[size_t(y * table_size + x)]);
          row.filter += across * weight;
          row.square += across * weight * weight;
        }
        share.filter += down * row.filter;
        share.square += down * row.square;
      }
      const int times = (dx ? 2 : 1) * (dy ? 2 : 1);
      whole.filter += times * share.filter;
      whole.square += times * share.square;
    }
}

/// Whether the filter of a pixel lies within the film.
bool PictureFormat::within_reach(int x, int y) const {
  const int r = filter_reach;
  return x - r >= 0 && x + r < width && y - r >= 0 && y + r < height;
}

PictureFormat::Integral PictureFormat::over_film(int x, int y) const {
  if (within_reach(x, y)) return whole;
  Integral sum;
  each_share(x, y, [&](int, int, const Integral& share) {
    sum.filter += share.filter;
    sum.square += share.square;
  });
  return sum;
}

std::uint64_t PictureFormat::hash() const {
  std::uint64_t h = 0xcbf29ce484222325ull;
  const auto add = [&](std::uint32_t bits) { h = (h ^ bits) * 0x100000001b3ull; };
  add(std::bit_cast<std::uint32_t>(radius));
  for (const float w : table) add(std::bit_cast<std::uint32_t>(w));
  const auto add_text = [&](const std::string& text) {
    add(std::uint32_t(text.size()));
    for (const char c : text) add(std::uint32_t(static_cast<unsigned char>(c)));
  };
  for (const std::string& name : light_groups) add_text(name);
  for (const PathLayer& layer : path_layers) {
    add_text(PictureFormat::path_prefix + layer.name);
    add_text(layer.expression);
  }
  if (stokes) add_text(stokes_layer);
  if (bands)
    for (const char c : bands->key()) add(std::uint32_t(static_cast<unsigned char>(c)));
  return h;
}

bool PictureFormat::collects_as(const PictureFormat& other) const {
  return samples_as(other) && path_lengths == other.path_lengths && light_groups == other.light_groups &&
         path_layers == other.path_layers && stokes == other.stokes &&
         (bands ? other.bands && *bands == *other.bands : !other.bands);
}

bool PictureFormat::samples_as(const PictureFormat& other) const {
  return width == other.width && height == other.height && area == other.area && radius == other.radius && table == other.table;
}

}  // namespace etendue
