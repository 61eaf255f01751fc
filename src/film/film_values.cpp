// The values of a film as plain numbers.

#include "film_values.h"

#include <algorithm>
#include <functional>

#include "film_members.h"

namespace etendue {

void FilmCounts::require_room_for(const FilmCounts& more) const {
  for (size_t i = 0; i < std::min(samples.size(), more.samples.size()); ++i)
    if (samples[i] > ~more.samples[i]) throw Error("a pixel cannot take more than 2^32 - 1 samples");
}

void FilmCounts::add(const FilmCounts& more) {
  if (samples.empty()) samples.resize(more.samples.size());
  for (size_t i = 0; i < more.samples.size(); ++i) samples[i] += more.samples[i];
  paths += more.paths;
  bad_count += more.bad_count;
  add_bad(more.bad);
}

void FilmCounts::add_bad(const std::vector<BadSample>& more) {
  if (more.empty()) return;
  bad.insert(bad.end(), more.begin(), more.end());
  std::ranges::sort(bad, std::less());
  if (bad.size() > bad_kept) bad.resize(bad_kept);
}

FilmSnapshot::Values Film::values() const {
  const Members& m = *members_;
  const PictureFormat& format = *m.format;
  FilmSnapshot::Values values{m.format, m.estimator, {}, m.totals.counts, m.totals.steps};
  values.counts.add(m.step.counts);
  if (values.counts.samples.empty()) return values;
  if (m.estimator == Estimator::correlated && m.step.begun) {
    FilmSnapshot::Values step{m.format, m.estimator, m.step.lists, m.step.counts, 1};
    m.note_batch(step);
    values.lists[batch_list] = std::move(step.lists[batch_list]);
    ++values.steps;
  }
  std::array<bool, list_count> summed{};
  for (size_t p = 0; p < planes.size(); ++p) summed[planes[p].list] |= !m.totals.sums[p].empty();
  for (size_t l = 0; l < list_count; ++l)
    if (summed[l] || !m.step.lists[l].empty()) values.lists[l].resize(format.pixels() * list_stride(List(l), format));
  over_range(format.pixels(), [&](size_t begin, size_t end) {
    for (size_t l = 0; l < list_count; ++l)
      if (const size_t stride = list_stride(List(l), format); !m.step.lists[l].empty() && m.step.begun && l != batch_list)
        std::copy(m.step.lists[l].begin() + std::ptrdiff_t(begin * stride),
                  m.step.lists[l].begin() + std::ptrdiff_t(end * stride),
                  values.lists[l].begin() + std::ptrdiff_t(begin * stride));
    for (size_t p = 0; p < planes.size(); ++p) {
      const ExactSums& sums = m.totals.sums[p];
      const auto& [list, offset, group] = planes[p];
      if (sums.empty()) continue;
      const size_t groups = groups_per_pixel(planes[p], format), stride = list_stride(list, format) / groups;
      for (size_t i = begin * groups; i < end * groups; ++i)
        for (size_t c = 0; c < group; ++c) values.lists[list][i * stride + offset + c] += sums.value(i, c);
    }
  });
  return values;
}

FilmSnapshot Film::snapshot() const {
  FilmSnapshot snapshot;
  const std::lock_guard lock(members_->mutex);
  snapshot.values_ = std::make_shared<const FilmSnapshot::Values>(values());
  return snapshot;
}

std::uint64_t Film::samples() const {
  const std::lock_guard lock(members_->mutex);
  return members_->totals.counts.paths + members_->step.counts.paths;
}

std::uint64_t Film::bad_samples() const {
  const std::lock_guard lock(members_->mutex);
  return members_->totals.counts.bad_count + members_->step.counts.bad_count;
}

std::vector<BadSample> Film::first_bad_samples() const {
  const std::lock_guard lock(members_->mutex);
  FilmCounts all;
  all.add_bad(members_->totals.counts.bad);
  all.add_bad(members_->step.counts.bad);
  return all.bad;
}

void Film::keep_largest(size_t n) {
  const std::lock_guard lock(members_->mutex);
  members_->largest_wanted = n;
}

size_t Film::largest_kept() const {
  const std::lock_guard lock(members_->mutex);
  return members_->largest_wanted;
}

std::vector<LargeSample> Film::largest_samples() const {
  const std::lock_guard lock(members_->mutex);
  std::vector<LargeSample> all = members_->largest;
  for (const LargeSample& s : members_->step.largest) ImageTile::keep_larger(all, s, members_->largest_wanted);
  std::ranges::stable_sort(all, std::greater(), &LargeSample::luminance);
  return all;
}

}  // namespace etendue
