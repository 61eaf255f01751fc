#include "etendue/render/photon_beams.h"
#include "transport/medium_interval.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>

namespace etendue {

Spectrum PhotonBeam::light(float s, float t, const VolumeCoefficients& c) const {
  const float by_chance = std::max(0.0f, least_extinction * s - certain_depth);
  return throughput * c.scattering * exp(Spectrum(by_chance) - c.extinction() * (s + t));
}

namespace {

/// The least extinction among the wavelengths that a medium scatters [1/m]; 0: it scatters none.
float least_extinction(const VolumeCoefficients& c) {
  float least = infinity;
  for (int i = 0; i < spectrum_size; ++i)
    if (c.scattering[i] > 0) least = std::min(least, c.scattering[i] + c.absorption[i]);
  return std::isfinite(least) ? least : 0;
}

/// Stores the segments of one light subpath in media as beams.
struct BeamEvents final : SegmentEvents {
  const BeamWalks& of;
  const Wavelengths& wavelengths;
  const std::vector<SubpathVertex>& walk;
  NumberStream chances;
  std::vector<PhotonBeam>& beams;

  BeamEvents(const BeamWalks& b, const Wavelengths& w, const std::vector<SubpathVertex>& v, const NumberStream& numbers,
             std::vector<PhotonBeam>& all)
      : of(b), wavelengths(w), walk(v), chances(numbers), beams(all) {}

  void through(const Medium& medium, const Ray& ray, float reach, const Spectrum& throughput) override {
    const float kept = chances.next(), end = chances.next();
    const PhotonWalks& walks = of.walks;
    if (!medium.volume->homogeneous() || int(walk.size()) < walks.fewest_in_media ||
        (walks.kept < 1 && double(kept) >= walks.kept))
      return;
    const bool caustic =
        walk.size() > 1 && std::all_of(walk.begin() + 1, walk.end(), [](const auto& v) { return v.leaves_specularly; });
    if (walks.kinds != PhotonKinds::all && caustic != (walks.kinds == PhotonKinds::caustics)) return;
    const float least = least_extinction(medium.coefficients(ray.origin, ray.time, wavelengths));
    if (!(least > 0)) return;
    const MediumInterval there = medium_interval(medium, ray, reach);
    if (!(there.length() > 0)) return;
    PhotonBeam& beam = beams.emplace_back();
    beam.throughput = throughput;
    beam.origin = there.within(ray).origin;
    beam.direction = ray.direction;
    beam.least_extinction = least;
    beam.length = std::min(there.length(), (PhotonBeam::certain_depth - std::log1p(-end)) / least);
    beam.volume = medium.volume;
    beam.vertices = std::uint32_t(walk.size()) & vertices_mask;
    beam.hero_only = wavelengths.single();
    beam.caustic = caustic;
    beam.luminaire = walk[0].point.object->luminaire_index();
    if (const PathStates* const states = PathStates::current()) [[unlikely]] {
      const PhotonBeam whole = beam;
      beams.pop_back();
      states->each(walk.back().path, whole.throughput, [&](std::uint32_t state, const Spectrum& part) {
        beams.push_back(whole);
        beams.back().state = std::uint16_t(state);
        beams.back().throughput = part;
      });
    }
  }
};

}  // namespace

void BeamWalks::operator()(std::uint64_t item, std::vector<PhotonBeam>& beams, Arena& arena) const {
  std::vector<SubpathVertex> walk;
  EmittedLight light;
  PathStates states(walks.groups ? &walks.groups->paths() : nullptr);
  for (std::uint64_t n = item * item_size; n < std::min(walks.walks, (item + 1) * item_size); ++n) {
    const ArenaScope memory(arena);
    states.clear();
    Wavelengths w = walks.wavelengths;
    const NumberStream numbers(walks.numbers,
                               SampleKey(walks.context.seed, -8 - int(walks.kinds), int(walks.step), std::uint32_t(n)));
    SampleContext sample{w, numbers, arena, {.abort = walks.abort}};
    BeamEvents listener(*this, w, walk, numbers.fork("beam"), beams);
    generate_light_subpath(walks.context.scene, walks.lights, walks.time, walks.limits, sample, walk, light, walks.targets,
                           &listener);
    if (sample.aborted()) return;
  }
}

void BeamMap::build(std::vector<PhotonBeam>&& beams, float radius) {
  beams_ = std::move(beams);
  radius_ = radius;
  boxes_.clear();
  // Large boxes around slanted beams are mostly empty, many small boxes take memory and time: at most nine pieces per beam on
  // average.
  constexpr double pieces_of_a_beam = 8, radii_of_a_piece = 4;
  double all = 0;
  for (const PhotonBeam& beam : beams_) all += double(beam.length);
  cut(std::max(radii_of_a_piece * double(radius), all / (pieces_of_a_beam * double(std::max<size_t>(beams_.size(), 1)))));
  if (pieces_.empty()) return;

  std::vector<Point3> middles(pieces_.size());
  for (size_t i = 0; i < pieces_.size(); ++i) {
    const PhotonBeam& beam = beams_[pieces_[i].beam];
    middles[i] = beam.origin + (pieces_[i].from + pieces_[i].to) / 2 * beam.direction;
  }
  const std::vector<std::uint32_t> order = PointTree().build(middles);
  std::vector<Piece> sorted(pieces_.size());
  for (size_t i = 0; i < sorted.size(); ++i) sorted[i] = pieces_[order[i]];
  pieces_ = std::move(sorted);
  size_t nodes = 1;
  for (size_t n = pieces_.size(); n > PointTree::leaf; n -= n / 2) nodes = 2 * nodes + 1;
  boxes_.resize(nodes);
  bound(0, pieces_.size(), 0);
}

void BeamMap::cut(double longest) {
  pieces_.clear();
  for (size_t i = 0; i < beams_.size(); ++i) {
    const double length = double(beams_[i].length);
    const double count = std::max(1.0, std::ceil(length / longest));
    for (double k = 0; k < count; ++k)
      pieces_.push_back({std::uint32_t(i), float(k / count * length), float((k + 1) / count * length)});
  }
}

Bounds3 BeamMap::bound(size_t begin, size_t end, size_t node) {
  Bounds3 box;
  if (end - begin <= PointTree::leaf) {
    for (size_t i = begin; i < end; ++i) {
      const PhotonBeam& beam = beams_[pieces_[i].beam];
      for (const float s : {pieces_[i].from, pieces_[i].to}) {
        const Point3 p = beam.origin + s * beam.direction;
        box.add(p - Vector3{radius_, radius_, radius_});
        box.add(p + Vector3{radius_, radius_, radius_});
      }
    }
  } else {
    const size_t middle = begin + (end - begin) / 2;
    Bounds3 upper;
    const auto below = [&] { box = bound(begin, middle, 2 * node + 1); };
    const auto above = [&] { upper = bound(middle, end, 2 * node + 2); };
    if (end - begin > (1 << 15)) {
      tbb::parallel_invoke(below, above);
    } else {
      below();
      above();
    }
    box.add(upper);
  }
  return boxes_[node] = box;
}

BeamMap::Passage BeamMap::passage(const Piece& piece, const Ray& ray, float reach, NumberStream& numbers) const {
  const PhotonBeam& beam = beams_[piece.beam];
  const Vector3 across = cross(ray.direction, beam.direction), between = beam.origin - ray.origin;
  const float squared = length_squared(across);
  constexpr float least_sine = 1e-3f;
  if (squared < square(least_sine)) return passage_of_parallel(piece, ray, reach, numbers);
  const float sine = std::sqrt(squared);
  if (!(std::abs(dot(between, across)) < radius_ * sine)) return {};
  const float t = dot(cross(between, beam.direction), across) / squared;
  const float s = dot(cross(between, ray.direction), across) / squared;
  if (!(t > 0 && t < reach && s >= piece.from && s < piece.to)) return {};
  return {s, t, 2 * radius_ * sine};
}

// Finds where along the ray the vector q(t) = c + t d - o, without its component along e, is shorter than r, and within the
// piece.
BeamMap::Passage BeamMap::passage_of_parallel(const Piece& piece, const Ray& ray, float reach, NumberStream& numbers) const {
  const PhotonBeam& beam = beams_[piece.beam];
  const Vector3 off = ray.origin - beam.origin;
  const float s_0 = dot(off, beam.direction), slope = dot(ray.direction, beam.direction);  // s = s_0 + slope t
  const Vector3 q = off - s_0 * beam.direction, change = ray.direction - slope * beam.direction;
  const float a = length_squared(change), b = dot(q, change), c = length_squared(q) - square(radius_);
  float from = 0, to = reach;
  if (a > 1e-13f) {  // otherwise `change` is a rounding error
    const float discriminant = square(b) - a * c;
    if (!(discriminant > 0)) return {};
    from = std::max(from, (-b - std::sqrt(discriminant)) / a);
    to = std::min(to, (-b + std::sqrt(discriminant)) / a);
  } else if (!(c < 0)) {
    return {};
  }
  const float begins = (piece.from - s_0) / slope, ends = (piece.to - s_0) / slope;
  from = std::max(from, std::min(begins, ends));
  to = std::min(to, std::max(begins, ends));
  if (!(from < to)) return {};
  const float t = lerp(numbers.next(), from, to);
  return {s_0 + slope * t, t, pi * square(radius_) / (to - from)};
}

}  // namespace etendue
