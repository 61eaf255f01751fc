// The state of a SurfaceFilm as bytes, for checkpoints.

#include <fmt/format.h>

#include "files/bytes.h"
#include "surface_film.h"

namespace etendue {
namespace {

constexpr std::uint64_t magic = 0x31304d5346525354;  // "TSRFSM01": name and version of the format, little endian
constexpr const char* what = "the state of the layers of surfaces";

static_assert(std::has_unique_object_representations_v<NearestSample>, "written as bytes");

std::array<std::int32_t, 6> size_of(const PictureFormat& f) {
  return {f.width, f.height, f.area.x0, f.area.y0, f.area.x1, f.area.y1};
}

}  // namespace

std::vector<std::byte> SurfaceFilm::save_state() const {
  const std::lock_guard lock(mutex_);
  if (!wants_any()) return {};
  ByteWriter w;
  w.value(magic);
  for (const std::int32_t i : size_of(*format_)) w.value(i);
  w.value(format_->hash());
  w.value(format_->surfaces.hash());
  w.value(sums_->steps);
  w.list(sums_->values.places());
  w.list(sums_->values.digits());
  w.list(sums_->weights);
  w.list(sums_->nearest);
  w.value(std::uint8_t(!sums_->shares.empty()));
  for (const SurfaceShares& shares : sums_->shares) {
    w.value(std::uint64_t(shares.size()));
    for (const SurfaceShare& share : shares) {
      w.value(share.key);
      w.value(share.weight);
    }
  }
  w.value(std::uint64_t(sums_->names.size()));
  for (const auto& [key, names] : sums_->names) {
    w.value(key);
    for (const std::string& name : names) w.text(name);
  }
  return std::move(w.bytes);
}

// Everything is read and checked before anything changes.
SurfaceFilm::Sums SurfaceFilm::read_state(std::span<const std::byte> bytes) const {
  const PictureFormat& format = *format_;
  ByteReader r(bytes, what);
  if (r.value<std::uint64_t>() != magic) throw Error("this is not a state of layers of surfaces, or one of another version");
  for (const std::int32_t i : size_of(format))
    if (r.value<std::int32_t>() != i) throw Error(fmt::format("{} belongs to a picture of another size or crop", what));
  if (const auto filter = r.value<std::uint64_t>(), layers = r.value<std::uint64_t>();
      filter != format.hash() || layers != format.surfaces.hash())
    throw Error(fmt::format("{} was made with another filter or other layers", what));
  Sums sums;
  sums.steps = r.value<std::uint32_t>();
  if (sums.steps > ExactSums::most_addends) throw Error(fmt::format("{} holds an impossible number of steps", what));
  const size_t count = format.pixels(), groups = count * size_t(format.surfaces.triples());
  const bool filled = sums.steps > 0;
  if (filled) sums.values = ExactSums(groups, 3);
  const auto lists = [&](auto& to, size_t expected) {
    using Item = typename std::remove_reference_t<decltype(to)>::value_type;
    to = r.list<Item>(expected);
    if (to.size() != (filled ? expected : 0)) throw Error(fmt::format("{} lacks a part", what));
  };
  lists(sums.values.places(), groups);
  lists(sums.values.digits(), groups * 6);
  if (!sums.values.possible(sums.steps)) throw Error(fmt::format("{} holds impossible sums", what));
  lists(sums.weights, weight_count * count);
  lists(sums.nearest, format.surfaces.identifiers() ? count : 0);
  if ((r.value<std::uint8_t>() != 0) != (filled && format.surfaces.mattes())) throw Error(fmt::format("{} lacks a part", what));
  if (filled && format.surfaces.mattes()) {
    sums.shares.resize(count);
    for (SurfaceShares& shares : sums.shares)
      for (auto n = r.count(2 * sizeof(std::uint64_t)); n > 0; --n) {
        const auto key = r.value<std::uint64_t>();
        if (!shares.empty() && shares.back().key >= key) throw Error(fmt::format("{} holds shares out of order", what));
        shares.push_back({key, r.value<std::int64_t>()});
      }
  }
  for (auto n = r.count(sizeof(std::uint64_t)); n > 0; --n) {
    SurfaceNames& names = sums.names[r.value<std::uint64_t>()];
    for (std::string& name : names) name = r.text();
  }
  if (!r.at_end()) throw Error(fmt::format("{} is longer than it should be", what));
  for (const SurfaceShares& shares : sums.shares)
    for (const SurfaceShare& share : shares)
      if (!sums.names.contains(share.key)) throw Error(fmt::format("{} lacks a name", what));
  return sums;
}

void SurfaceFilm::load_state(std::span<const std::byte> bytes) {
  const std::lock_guard lock(mutex_);
  if (wants_any() == bytes.empty()) throw Error(fmt::format("{} belongs to a picture with other layers", what));
  auto sums = std::make_shared<Sums>(bytes.empty() ? Sums() : read_state(bytes));
  step_.clear();
  sums_ = std::move(sums);
}

void SurfaceFilm::add_state(std::span<const std::byte> bytes) {
  const std::lock_guard lock(mutex_);
  if (wants_any() == bytes.empty()) throw Error(fmt::format("{} belongs to a picture with other layers", what));
  if (!bytes.empty()) own_sums().add(read_state(bytes));
}

}  // namespace etendue
