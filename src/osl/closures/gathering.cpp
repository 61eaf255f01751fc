#include "gathering.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <span>

#include "closure_walk.h"
#include "etendue/describe/bands.h"
#include "etendue/transport/medium_stack.h"

namespace etendue::osl {

namespace {

Vector3 vector(const Triple& t) { return {t.x, t.y, t.z}; }

/// A normal that lies so far to the side of the surface that it could hardly be seen is tilted to this cosine with the
/// geometric normal.
constexpr float least_cosine = 0.02f;

/// The same as rgb_coefficients. A shader's colours are often the same at the next point, and a saturated colour's coefficients
/// take longer than all else in a simple shader: so those of this thread are kept, a color at one place of a small table.
RgbCoefficients recent_coefficients(const RgbSpace& space, const Triple& c) {
  struct Entry {
    const RgbSpace* space = nullptr;
    std::array<std::uint32_t, 3> color{};
    RgbCoefficients coefficients{};
  };
  static constexpr std::size_t size = 64;
  thread_local std::array<Entry, size> table;
  const auto bits = std::bit_cast<std::array<std::uint32_t, 3>>(c);
  const std::uint32_t mixed = bits[0] * 0x9e3779b1u + bits[1] * 0x85ebca77u + bits[2] * 0xc2b2ae3du;
  Entry& entry = table[(mixed >> 24) % size];
  if (entry.space != &space || entry.color != bits) entry = {&space, bits, rgb_coefficients(space, c.x, c.y, c.z)};
  return entry.coefficients;
}

}  // namespace

// Most closures take the point's own normal, and most models no tangent.
const SurfacePoint& Gathering::at(const Triple& normal, const Triple& tangent) const {
  const SurfacePoint& own = place_.point;
  Vector3 n(own.shading_normal);
  const Vector3 given = vector(normal);
  if (const float squared = length_squared(given); squared > 0 && squared < infinity) {
    const Vector3 facing = dot(given, own.normal) < 0 ? -given : given;
    if (!(facing == n)) {
      n = facing / std::sqrt(squared);
      const float cosine = dot(n, own.normal);
      if (cosine < least_cosine) n += (least_cosine - cosine) * Vector3(own.normal);
      n = normalize(n);
    }
  }
  const Vector3 along = vector(tangent);
  const float size = length_squared(along);
  const bool turned = size > 0 && size < infinity && !(along == own.dpdu);
  if (!turned && n == Vector3(own.shading_normal)) return own;
  auto* const p = arena().make<SurfacePoint>(own);
  p->shading_normal = Normal3(n);
  if (turned) p->dpdu = along;
  return *p;
}

bool Gathering::points_back(const Triple& normal) const {
  const float side = dot(vector(normal), place_.point.normal);
  return side != 0 ? side < 0 : place_.from_behind;
}

Spectrum Gathering::index_outside() const {
  const SurfacePoint& p = place_.point;
  const SceneObject* outside = p.media && p.object ? p.media->outside_of(*p.object) : nullptr;
  return outside ? MediumStack::index(outside, place_.wavelengths) : Spectrum(1.0f);
}

Spectrum Gathering::reflectance(const Triple& c) const {
  Triple rgb = c * weight_;
  bool cut = false;
  for (int i = 0; i < 3; ++i) {
    if (rgb[i] * spectral_weight_[0] > 1.0005f || !(rgb[i] > -1e-6f)) cut = true;
    rgb[i] = rgb[i] > 0 ? std::min(rgb[i], 1e6f) : 0;
  }
  // Where the color alone exceeds 1 its scale is a factor, too: `2 * color * 0.3 * diffuse(N)`.
  const float scale = std::max({rgb.x, rgb.y, rgb.z, 1.0f});
  const Spectrum all = color(rgb * (1 / scale), ColorUse::reflectance) * scale * spectral_weight_;
  if (cut || all.minimum() < 0) warn("a closure would reflect more than all light, or less than none, and is limited to that");
  return clamp(all, 0, 1);
}

Spectrum Gathering::color(const Triple& c, ColorUse use) const {
  if (c.x == c.y && c.y == c.z && use != ColorUse::radiance) return Spectrum(c.x);
  if (use != ColorUse::reflectance || in_bands(place_.wavelengths))
    return rgb_spectrum(place_.space, c.x, c.y, c.z, use, place_.wavelengths);
  return recent_coefficients(place_.space, c).evaluate(place_.wavelengths);
}

void Gathering::warn(const std::string& text) const { etendue::warn(place_.name + ": " + text); }

void Gathering::add(const Scatter* scatter, Lobes lobes, Spectrum weight) {
  if (!scatter || !scatter->has(lobes) || weight.black()) return;
  constexpr Lobes through = diffuse_transmission | glossy_transmission | specular_transmission;
  if (place_.exits && scatter->has(Lobes(lobes & through))) {
    warn("light is let through beside subsurface scattering, and is lost: a surface has one of them");
    lobes &= Lobes(~through);
    if (!scatter->has(lobes)) return;
  }
  push(scatter, lobes, weight);
}

void Gathering::add_entry(const Scatter* scatter, Spectrum weight) {
  if (!weight.black()) push(scatter, specular_transmission, weight);
}

void Gathering::push(const Scatter* scatter, Lobes lobes, const Spectrum& weight) {
  if (count_ == Mixture::most_parts)
    throw Error(fmt::format("{}: a closure has more than {} components at one point", place_.name, Mixture::most_parts));
  std::construct_at(&parts_[count_++], MixturePart{scatter, weight, lobes, covers_});
}

void Gathering::add(const etendue::Shader& model, const SlotValues& values, const SurfacePoint& p, Lobes lobes,
                    Spectrum weight) {
  const SlotScope scope(values);
  add(model.bind(p, place_.wavelengths, place_.arena), lobes, weight);
}

const Gathering::Half* Gathering::other_half(const Boundary& b) const {
  const auto black = [](const Triple& t) { return !(t.x > 0 || t.y > 0 || t.z > 0); };
  for (const Half& h : std::span(halves_, std::size_t(half_count_)))
    if (h.covers == covers_ && h.boundary.same_place(b) && black(b.reflection_tint) != black(h.boundary.reflection_tint))
      return &h;
  return nullptr;
}

void Gathering::note_half(const Boundary& b, const SlotValues& values) {
  if (half_count_ < most_halves && count_ > 0)
    std::construct_at(&halves_[half_count_++], Half{b, values, count_ - 1, covers_, component_bound_});
}

// The two sides of one boundary never scatter more than the greater of their weights.
void Gathering::join(const Half& half, const etendue::Shader& model, const SlotValues& values, const SurfacePoint& p) {
  const SlotScope scope(values);
  const Scatter* whole = model.bind(p, place_.wavelengths, place_.arena);
  if (!whole) return;
  parts_[half.part].scatter = whole;
  parts_[half.part].lobes = reflection_lobes | transmission_lobes;
  component_bound_ = max(component_bound_ - half.bound, 0);
  const int index = int(&half - halves_);
  std::copy(halves_ + index + 1, halves_ + half_count_--, halves_ + index);
}

/// Layers over layers are gathered by recursion.
constexpr int most_layers = 64;

void Gathering::add_layers(const ClosureNode* top, const ClosureNode* base) {
  if (++layers_ > most_layers) throw Error(fmt::format("{}: more than {} layers at one point", place_.name, most_layers));
  const int begin = count_;
  const Spectrum top_bound = add_closure(top);
  const Cover* const outside = covers_;
  const Spectrum outer = reflectance(Triple(1));
  covers_ = arena().make<Cover>(Cover{begin, count_, outer, outside});
  Lobes through = no_lobes;
  for (int k = begin; k < count_; ++k) through |= parts_[k].present(transmission_lobes);
  const Spectrum base_bound = add_closure(base);
  covers_ = outside;
  --layers_;
  // Of r reflected by the top, at most top_bound, the base gets 1 - r / outer; what the top lets through comes on top of that.
  const Spectrum left = through ? Spectrum(1.0f) : max(Spectrum(1.0f) - top_bound / max(outer, 1e-6f), 0);
  const Spectrum both = top_bound + base_bound * left;
  for (int i = 0; i < spectrum_size; ++i) component_bound_.set(i, std::max(both[i], base_bound[i]));
}

Spectrum Gathering::weight_bound() const {
  const Triple& w = weight_;
  const float scale = std::max({w.x, w.y, w.z, 1.0f});
  if (w.x == w.y && w.y == w.z) return clamp(spectral_weight_ * w.x, 0, 1);
  return clamp(
      color(Triple(std::max(w.x, 0.0f), std::max(w.y, 0.0f), std::max(w.z, 0.0f)) * (1 / scale), ColorUse::reflectance) *
          scale * spectral_weight_,
      0, 1);
}

Spectrum Gathering::add_closure(const ClosureNode* root) {
  const Triple weight = weight_;
  const Spectrum spectral = spectral_weight_;
  Spectrum bound;
  OpenClosures open;  // besides `next`
  WeightedClosure next{root, weight, spectral};
  while (next.node) {
    switch (next.node->kind) {
      case ClosureNode::Kind::component:
        weight_ = next.weight, spectral_weight_ = next.spectral;
        bound += add_component(*static_cast<const ClosureComponent*>(next.node));
        next.node = nullptr;
        if (!open.empty()) next = open.pop();
        break;
      case ClosureNode::Kind::sum:
        open.push({static_cast<const ClosureSum*>(next.node)->b, next.weight, next.spectral});
        next.node = static_cast<const ClosureSum*>(next.node)->a;
        break;
      case ClosureNode::Kind::product: {
        // Weights without colour stay factors of the spectra: then spectra of weights that sum to 1 sum to at most 1.
        const auto& p = *static_cast<const ClosureProduct*>(next.node);
        if (p.weight.x == p.weight.y && p.weight.y == p.weight.z)
          next.spectral *= p.weight.x;
        else
          next.weight = next.weight * p.weight;
        if (p.spectrum) next.spectral *= *p.spectrum;
        next.node = p.closure;
        break;
      }
    }
  }
  weight_ = weight, spectral_weight_ = spectral;
  return bound;
}

Gathering::Gathering(const ClosureNode* node, const ClosurePlace& place) : place_(place) { bound_ = add_closure(node); }

const Scatter* Gathering::scatter() const {
  if (count_ == 0) return nullptr;
  const MixturePart& only = parts_[0];
  const Lobes others = Lobes(only.scatter->lobes() & ~only.lobes);
  if (count_ == 1 && !only.covers && !others && only.weight.minimum() == 1 && only.weight.maximum() == 1) return only.scatter;
  MixturePart* kept = nullptr;
  Mixture::Seen* seen = nullptr;
  const auto keep = [&]<int most>() {
    kept = arena().make<std::array<MixturePart, most>>()->data();
    seen = arena().make<std::array<Mixture::Seen, most>>()->data();
  };
  if (count_ <= 2)
    keep.template operator()<2>();
  else if (count_ <= 8)
    keep.template operator()<8>();
  else
    keep.template operator()<Mixture::most_parts>();
  std::copy(parts_, parts_ + count_, kept);
  // One part alone is limited by its reflectance. Weights that sum to 1 may exceed it by rounding.
  const bool may_exceed = count_ > 1 && bound_.maximum() > 1.0005f;
  auto* const mixture = arena().make<Mixture>(place_.point, kept, seen, count_, may_exceed);
  if (may_exceed && mixture->unlimited_albedo(seen_from()) > 1.01f)
    warn("the closures' sum would reflect more than all light, and is scaled down: the weights should sum to at most 1");
  return mixture;
}

const Scatter* scatter_of(const ClosureNode* node, const ClosurePlace& place) { return Gathering(node, place).scatter(); }

}  // namespace etendue::osl
