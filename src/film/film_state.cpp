// The film's state as bytes, for checkpoints.

#include <fmt/format.h>

#include <mutex>

#include "files/bytes.h"
#include "film_members.h"
#include "film_state.h"

namespace etendue {
namespace {

constexpr std::uint64_t magic = 0x35304d4c49465445;  // "ETFILM05": name and version of the format, little endian
constexpr const char* what = "the film's state";

/// The properties that a state must have in common with the film that loads it.
std::array<std::int32_t, 8> kind_of_film(const PictureFormat& f, Estimator estimator) {
  return {f.width, f.height, f.area.x0, f.area.y0, f.area.x1, f.area.y1, int(f.triples()), int(estimator)};
}

constexpr size_t place_of_estimator = 7;  // index of the estimator in kind_of_film

void write_counts(ByteWriter& w, const FilmCounts& counts) {
  w.list(counts.samples);
  w.value(counts.paths);
  w.value(counts.bad_count);
  w.value(std::uint64_t(counts.bad.size()));
  for (const BadSample& b : counts.bad) {
    w.value(std::int32_t(b.x));
    w.value(std::int32_t(b.y));
    w.value(b.sample);
    w.value(std::uint8_t(b.kind));
  }
}

FilmCounts read_counts(ByteReader& r, const PictureFormat& format) {
  FilmCounts counts;
  counts.samples = r.list<std::uint32_t>(format.pixels());
  counts.paths = r.value<std::uint64_t>();
  counts.bad_count = r.value<std::uint64_t>();
  const auto noted = r.value<std::uint64_t>();
  if (noted > FilmCounts::bad_kept || noted > counts.bad_count)
    throw Error("the film's state holds an impossible number of bad samples");
  for (std::uint64_t i = 0; i < noted; ++i) {
    BadSample b;
    b.x = r.value<std::int32_t>();
    b.y = r.value<std::int32_t>();
    b.sample = r.value<std::uint32_t>();
    const auto kind = r.value<std::uint8_t>();
    if (kind > std::uint8_t(BadSample::Kind::negative)) throw Error("the film's state holds an unknown kind of bad sample");
    b.kind = BadSample::Kind(kind);
    counts.bad.push_back(b);
  }
  return counts;
}

}  // namespace

std::vector<std::byte> Film::save_state() const {
  const Members& m = *members_;
  const std::lock_guard lock(m.mutex);
  const Totals& totals = m.ended();
  size_t size = 1024 + totals.counts.samples.size() * sizeof(std::uint32_t);
  for (const ExactSums& sums : totals.sums) size += sums.digits().size() * sizeof(std::int64_t) + sums.places().size();
  ByteWriter w;
  w.bytes.reserve(size);
  w.value(magic);
  for (const std::int32_t i : kind_of_film(*m.format, m.estimator)) w.value(i);
  w.value(m.format->hash());
  w.value(totals.steps);
  for (const ExactSums& sums : totals.sums) {
    w.list(sums.places());
    w.list(sums.digits());
  }
  write_counts(w, totals.counts);
  return std::move(w.bytes);
}

// Everything is read and checked before anything changes.
Film::Totals Film::read_state(std::span<const std::byte> bytes) const {
  const PictureFormat& format = *members_->format;
  ByteReader r(bytes, what);
  if (r.value<std::uint64_t>() != magic) throw Error("this is not a film's state, or one of another version");
  for (const std::int32_t i : kind_of_film(format, members_->estimator))
    if (r.value<std::int32_t>() != i)
      throw Error("the film's state belongs to a picture of another size, crop or layers, or to another kind of algorithm");
  if (r.value<std::uint64_t>() != format.hash())
    throw Error("the film's state was made with another filter, or with other light groups or bands");
  Totals totals;
  totals.steps = r.value<std::uint32_t>();
  if (totals.steps > ExactSums::most_addends) throw Error("the film's state holds an impossible number of steps");
  std::array<bool, list_count> there{};
  for (size_t p = 0; p < planes.size(); ++p) {
    const size_t groups = format.pixels() * groups_per_pixel(planes[p], format);
    ExactSums& sums = totals.sums[p];
    sums = ExactSums(0, planes[p].group);
    sums.places() = r.list<std::uint8_t>(groups);
    sums.digits() = r.list<std::int64_t>(groups * 2 * planes[p].group);
    if (sums.places().empty() != sums.digits().empty()) throw Error("the film's state lacks a part");
    if (!sums.possible(totals.steps)) throw Error("the film's state holds impossible sums");
    if (!kept(planes[p], members_->estimator)) continue;
    // Either all planes of a list are present or none.
    const bool first = planes[p].offset == 0;
    if (first) there[planes[p].list] = !sums.empty();
    if (!first && there[planes[p].list] == sums.empty()) throw Error("the film's state lacks a part");
  }
  totals.counts = read_counts(r, format);
  if (totals.counts.samples.empty() != (totals.steps == 0)) throw Error("the film's state lacks a part");
  if (!r.at_end()) throw Error("the film's state is longer than it should be");
  return totals;
}

void Film::load_state(std::span<const std::byte> bytes) {
  Members& m = *members_;
  const std::lock_guard lock(m.mutex);
  Totals totals = read_state(bytes);
  m.empty();
  m.totals = std::move(totals);
}

void Film::add_state(std::span<const std::byte> bytes) {
  Members& m = *members_;
  const std::lock_guard lock(m.mutex);
  Totals other = read_state(bytes);
  // The current step continues: the sums before it get the addition, too, so that it stays if the step is dropped.
  std::array<Totals*, 2> all = {&m.totals, m.before_step.get()};
  for (const Totals* totals : all)
    if (totals) totals->require_room_for(other);
  for (Totals* totals : all)
    if (totals) totals->add(other);
}

/// Throws Error if the sums of both would have too many steps or samples.
void Film::Totals::require_room_for(const Totals& other) const {
  if (other.steps > ExactSums::most_addends - steps)
    throw Error(fmt::format("a film cannot take more than {} steps", ExactSums::most_addends));
  counts.require_room_for(other.counts);
}

void Film::Totals::add(const Totals& other) {
  for (size_t p = 0; p < planes.size(); ++p)
    if (sums[p].empty())
      sums[p] = other.sums[p];
    else if (!other.sums[p].empty())
      sums[p].add(other.sums[p]);
  counts.add(other.counts);
  steps += other.steps;
}

Estimator estimator_of(std::span<const std::byte> state) {
  ByteReader r(state, what);
  if (r.value<std::uint64_t>() != magic) throw Error("this is not a film's state, or one of another version");
  for (size_t i = 0; i < place_of_estimator; ++i) r.value<std::int32_t>();
  const auto estimator = r.value<std::int32_t>();
  if (estimator != int(Estimator::independent) && estimator != int(Estimator::correlated))
    throw Error("the film's state is of an unknown kind of algorithm");
  return Estimator(estimator);
}

}  // namespace etendue
