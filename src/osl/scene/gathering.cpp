#include "gathering.h"

#include <fmt/format.h>

#include <array>
#include <bit>

#include "components/shaders/tangent_frame.h"
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

Frame facet_frame(const SurfacePoint& p, const MicrofacetDistribution& d) {
  return d.isotropic() ? Frame(p.shading_normal) : tangent_frame(p);
}

}  // namespace

SurfacePoint Gathering::at(const Triple& normal, const Triple& tangent) const {
  SurfacePoint p = place_.point;
  const Vector3 given = vector(normal);
  const float squared = length_squared(given);
  if (squared > 0 && squared < infinity) {
    Vector3 n = given;
    if (dot(n, p.normal) < 0) n = -n;
    if (!(n == Vector3(p.shading_normal))) {
      n = n / std::sqrt(squared);
      const float cosine = dot(n, p.normal);
      if (cosine < least_cosine) n += (least_cosine - cosine) * Vector3(p.normal);
      p.shading_normal = Normal3(normalize(n));
    }
  }
  const float along = length_squared(vector(tangent));
  if (along > 0 && along < infinity) p.dpdu = vector(tangent);
  return p;
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

void Gathering::add_facets(const SurfacePoint& p, const MicrofacetDistribution& d, const SchlickFresnel& fresnel) {
  if (d.smooth()) return add(arena().make<MirrorModel>(p, fresnel), specular_reflection);
  add(arena().make<FacetModel<SchlickFresnel>>(p, facet_frame(p, d), d, fresnel), glossy_reflection);
}

void Gathering::add_film_facets(const SurfacePoint& p, const MicrofacetDistribution& d, const FilmFresnel& fresnel) {
  add(arena().make<FacetModel<FilmFresnel>>(p, facet_frame(p, d), d, fresnel), glossy_reflection);
}

void Gathering::add_layers(const ClosureNode* top, const ClosureNode* base) {
  const int begin = count_;
  add_closure(top);
  const Cover* const outside = covers_;
  const Spectrum outer = reflectance(Triple(1));
  covers_ = arena().make<Cover>(Cover{begin, count_, outer, outside});
  add_closure(base);
  covers_ = outside;
}

void Gathering::add_closure(const ClosureNode* node) {
  if (!node) return;
  switch (node->kind) {
    case ClosureNode::Kind::component: add_component(*static_cast<const ClosureComponent*>(node)); return;
    case ClosureNode::Kind::sum:
      add_closure(static_cast<const ClosureSum*>(node)->a);
      add_closure(static_cast<const ClosureSum*>(node)->b);
      return;
    case ClosureNode::Kind::product: {
      const auto& p = *static_cast<const ClosureProduct*>(node);
      const Triple weight = weight_;
      const Spectrum spectral = spectral_weight_;
      // Weights without colour stay factors of the spectra: then spectra of weights that sum to 1 sum to at most 1.
      const Triple w = p.weight;
      if (w.x == w.y && w.y == w.z)
        spectral_weight_ *= w.x;
      else
        weight_ = weight_ * w;
      if (p.spectrum) spectral_weight_ *= *p.spectrum;
      add_closure(p.closure);
      weight_ = weight;
      spectral_weight_ = spectral;
      return;
    }
  }
}

const Scatter* Gathering::scatter() const {
  if (count_ == 0) return nullptr;
  const MixturePart& only = parts_[0];
  const Lobes others = Lobes(only.scatter->lobes() & ~only.lobes);
  if (count_ == 1 && !only.covers && !others && only.weight.minimum() == 1 && only.weight.maximum() == 1) return only.scatter;
  struct Kept {
    MixturePart parts[Mixture::most_parts];
  };
  static_assert(sizeof(Kept) <= Arena::block_size);
  MixturePart* kept = nullptr;
  if (count_ <= 2)
    kept = arena().make<std::array<MixturePart, 2>>()->data();
  else if (count_ <= 8)
    kept = arena().make<std::array<MixturePart, 8>>()->data();
  else
    kept = arena().make<Kept>()->parts;
  std::copy(parts_, parts_ + count_, kept);
  auto* const mixture = arena().make<Mixture>(place_.point, kept, count_);
  // One part alone is limited by its reflectance.
  if (count_ > 1 && mixture->limit() > 1.01f)
    warn("the closures' sum would reflect more than all light, and is scaled down: the weights should sum to at most 1");
  return mixture;
}

const Scatter* scatter_of(const ClosureNode* node, const ClosurePlace& place) {
  Gathering g(place);
  g.add_closure(node);
  return g.scatter();
}

}  // namespace etendue::osl
