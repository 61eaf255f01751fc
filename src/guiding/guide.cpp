#include "etendue/guiding/guide.h"

#include <algorithm>
#include <cmath>

#include "guiding/saved_bytes.h"

namespace etendue {
namespace {

// A learned share stays between these: scattering alone finds what the guide does not know of, and must keep a chance.
constexpr float least_share = 0.05f, most_share = 0.75f;
// What a region has from before it was divided counts as no more effective samples than so many.
constexpr double inherited_samples = 8;
// A region is kept for at least so many nodes of directions.
constexpr size_t least_nodes = 64;

/// The axis a normal is nearest to, and which way along it: one of six; without a normal the seventh.
std::uint32_t facing(const Normal3& n) {
  const float x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  if (!(x + y + z > 0)) return 6;
  if (x >= y && x >= z) return n.x > 0;
  return y >= z ? 2 + (n.y > 0) : 4 + (n.z > 0);
}

/// Numbers that follow from a sample's bits: what is made by chance must not depend on who makes it when.
class HashOf {
 public:
  explicit HashOf(const GuideSample& s) {
    for (const float x : {s.position.x, s.position.y, s.position.z, s.direction.x, s.direction.y, s.found})
      bits_ = mix_bits(bits_ * 0x9e3779b97f4a7c15ull + std::bit_cast<std::uint32_t>(x));
  }
  float next() {
    bits_ = mix_bits(bits_ + 0x9e3779b97f4a7c15ull);
    return to_unit_float(std::uint32_t(bits_ >> 32));
  }

 private:
  std::uint64_t bits_ = 0x5851f42d4c957f2dull;
};

}  // namespace

Guide::Guide(const Point3& centre, float radius, const GuideSettings& settings)
    : settings_(settings), low_(centre - Vector3{radius, radius, radius}), side_(2 * radius), cells_(trees), regions_(trees) {
  for (std::uint32_t i = 0; i < trees; ++i) cells_[i].region = i;
  const double share = std::clamp(settings.share, least_share, most_share);
  for (Region& r : regions_) r.logit_ = std::log(share / (1 - share));
}

Guide::Place Guide::region_of(const Point3& position, const Normal3& normal) const {
  float p[3] = {clamp((position.x - low_.x) / side_, 0, one_minus_epsilon),
                clamp((position.y - low_.y) / side_, 0, one_minus_epsilon),
                clamp((position.z - low_.z) / side_, 0, one_minus_epsilon)};
  float size[3] = {side_, side_, side_};
  std::uint32_t cell = facing(normal);
  for (int axis = 0; cells_[cell].child; axis = axis == 2 ? 0 : axis + 1) {
    const bool upper = p[axis] >= 0.5f;
    p[axis] = 2 * p[axis] - float(upper);
    size[axis] /= 2;
    cell = cells_[cell].child + std::uint32_t(upper);
  }
  return {cell, cells_[cell].region, {size[0], size[1], size[2]}};
}

std::uint32_t Guide::region_for(const GuideSample& s) const {
  HashOf random(s);
  const Vector3 size = region_of(s.position, s.normal).size;
  const Vector3 moved{(random.next() - 0.5f) * size.x, (random.next() - 0.5f) * size.y, (random.next() - 0.5f) * size.z};
  return region_of(s.position + moved, s.normal).region;
}

void Guide::learn(std::uint32_t region, std::span<const GuideSample* const> samples, GuideTarget target) {
  Region& r = regions_[region];
  for (const GuideSample* s : samples) {
    if (s->found > 0 && std::isfinite(s->found)) {
      r.sum_ += double(s->found);
      r.squares_ += double(s->found) * double(s->found);
    }
    if (s->guide >= 0 && settings_.learning_rate > 0) adapt(r, *s);
    if (s->specular) continue;
    HashOf random(*s);
    const Point2 jitter{random.next(), random.next()};
    const auto found = double(s->found);
    r.directions_.add(s->direction, target == GuideTarget::mean ? found : found * found * double(s->density), jitter);
  }
}

float Guide::known_share(const Region& r) const {
  if (!(r.known_from_ > 0)) return 0;
  const auto share = float(1 / (1 + std::exp(-r.logit_)));
  return settings_.learning_rate > 0 ? clamp(share, least_share, most_share) : settings_.share;
}

void Guide::adapt(Region& r, const GuideSample& s) const {
  const double a = 1 / (1 + std::exp(-r.logit_));
  const double p = a * double(s.guide) + (1 - a) * double(s.scatter);
  const double gradient = -double(s.found) * (double(s.guide) - double(s.scatter)) * a * (1 - a) / p;
  if (!std::isfinite(gradient)) return;
  constexpr double keep_first = 0.9, keep_second = 0.999;
  ++r.steps_;
  r.first_ = keep_first * r.first_ + (1 - keep_first) * gradient;
  r.second_ = keep_second * r.second_ + (1 - keep_second) * gradient * gradient;
  const auto n = double(std::min<std::uint64_t>(r.steps_, 50000));  // what is kept of the beginning is nothing by then
  const double first = r.first_ / (1 - std::pow(keep_first, n)), second = r.second_ / (1 - std::pow(keep_second, n));
  r.logit_ = std::clamp(r.logit_ - double(settings_.learning_rate) * first / (std::sqrt(second) + 1e-30), -3.0, 3.0);
}

double Guide::effective(const Region& r) { return r.squares_ > 0 ? r.sum_ * r.sum_ / r.squares_ : 0; }

double Guide::parts(const Region& r) const {
  // One round tells little of how samples lie within a region, so it becomes eight at most.
  return std::min(effective(r) / double(settings_.region_samples) / std::exp2(double(round_) / 4), 8.0);
}

void Guide::divide(std::uint32_t cell, int depth, double parts, size_t most_regions) {
  if (parts <= 1 || depth >= deepest || regions_.size() >= most_regions) return;
  const std::uint32_t region = cells_[cell].region;
  // Both halves begin with what the whole knows, and know better soon.
  regions_[region].known_from_ = std::min(regions_[region].known_from_, inherited_samples);
  const auto other = std::uint32_t(regions_.size()), child = std::uint32_t(cells_.size());
  regions_.push_back(Region(regions_[region]));
  cells_.push_back({0, region});
  cells_.push_back({0, other});
  cells_[cell].child = child;
  divide(child, depth + 1, parts / 2, most_regions);
  divide(child + 1, depth + 1, parts / 2, most_regions);
}

void Guide::refine(GuideTarget target) {
  const size_t most_nodes = settings_.memory / DirectionTree::node_bytes();
  const size_t most_regions = std::max<size_t>(most_nodes / least_nodes, trees);
  // How many regions there will be tells how many nodes each may have; so they are counted before trees are copied.
  std::vector<double> divided(regions_.size(), 1);
  size_t later = 0;
  for (size_t i = 0; i < regions_.size(); ++i) {
    const Region& r = regions_[i];
    if (effective(r) > std::max(r.known_from_, 1.0)) divided[i] = std::max(parts(r), 1.0);
    later += size_t(std::exp2(std::ceil(std::log2(divided[i]))));
  }
  const size_t each = std::max<size_t>(most_nodes / std::min(later, most_regions), 1);
  for (Region& r : regions_) {
    const double samples = effective(r);
    if (samples > std::max(r.known_from_, 1.0)) {
      // A cell that holds fewer of them than this says nothing of what is within.
      const auto least = float(settings_.cell_samples / samples);
      if (r.directions_.refine(target, std::max(settings_.fraction, least), each)) r.known_from_ = samples;
      r.logit_ /= 2;  // the share was that of a guide that knew less
      r.sum_ = r.squares_ = 0;
    }
    if (r.directions_.size() > each) {  // nothing new was found there, and the memory is needed elsewhere
      const Region before = std::move(r);
      r = Region();
      r.logit_ = before.logit_;
    }
    r.share_ = known_share(r);
  }
  std::vector<std::pair<std::uint32_t, int>> leaves;  // with their depths
  std::vector<int> depth(cells_.size(), 0);
  for (std::uint32_t i = 0; i < depth.size(); ++i)
    if (const std::uint32_t child = cells_[i].child)
      depth[child] = depth[child + 1] = depth[i] + 1;
    else
      leaves.emplace_back(i, depth[i]);
  for (const auto& [leaf, its_depth] : leaves) divide(leaf, its_depth, divided[cells_[leaf].region], most_regions);
  ++round_;
}

size_t Guide::bytes() const {
  size_t nodes = 0;
  for (const Region& r : regions_) nodes += r.directions_.size();
  return nodes * DirectionTree::node_bytes() + regions_.size() * sizeof(Region) + cells_.size() * sizeof(Cell);
}

// ---- saving -----------------------------------------------------------------------------------------------------------------

std::uint64_t Guide::check(std::span<const std::byte> bytes) {
  std::uint64_t sum = bytes.size();
  for (; !bytes.empty(); bytes = bytes.subspan(std::min<size_t>(8, bytes.size()))) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), std::min<size_t>(8, bytes.size()));
    sum = mix_bits(sum * 0x9e3779b97f4a7c15ull + word);
  }
  return sum;
}

std::vector<std::byte> Guide::save() const {
  std::vector<std::byte> bytes;
  for (const float x : {low_.x, low_.y, low_.z, side_}) append(bytes, x);
  append(bytes, round_);
  append_all(bytes, cells_);
  append(bytes, std::uint64_t(regions_.size()));
  for (const Region& r : regions_) {
    r.directions_.save(bytes);
    append(bytes, r.share_);
    for (const double x : {r.sum_, r.squares_, r.known_from_, r.logit_, r.first_, r.second_}) append(bytes, x);
    append(bytes, r.steps_);
  }
  append(bytes, check(bytes));
  return bytes;
}

void Guide::load(std::span<const std::byte> bytes) {
  const Error damaged("a guide's bytes are damaged");
  if (bytes.size() < sizeof(std::uint64_t)) throw damaged;
  auto last = bytes.last(sizeof(std::uint64_t));
  bytes = bytes.first(bytes.size() - last.size());
  if (take<std::uint64_t>(last) != check(bytes)) throw damaged;
  for (const float x : {low_.x, low_.y, low_.z, side_})
    if (take<float>(bytes) != x) throw Error("a guide's bytes are those of another scene");
  const auto round = take<std::uint32_t>(bytes);
  std::vector<Cell> cells = take_all<Cell>(bytes);
  const auto count = take<std::uint64_t>(bytes);
  if (cells.size() < trees || count < trees || count > bytes.size()) throw damaged;
  for (size_t i = 0; i < cells.size(); ++i) {
    const Cell& c = cells[i];
    if (c.child ? c.child <= i || c.child + size_t(1) >= cells.size() : c.region >= count) throw damaged;
  }
  std::vector<Region> regions(static_cast<size_t>(count));
  for (Region& r : regions) {
    r.directions_.load(bytes);
    r.share_ = take<float>(bytes);
    for (double* x : {&r.sum_, &r.squares_, &r.known_from_, &r.logit_, &r.first_, &r.second_}) *x = take<double>(bytes);
    r.steps_ = take<std::uint64_t>(bytes);
    if (!(r.share_ >= 0 && r.share_ <= 1)) throw damaged;
  }
  if (!bytes.empty()) throw damaged;
  round_ = round;
  cells_ = std::move(cells);
  regions_ = std::move(regions);
}

}  // namespace etendue
