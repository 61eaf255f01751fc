// Closures of bodies that light enters and leaves elsewhere, and of fibres.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <mutex>

#include "closure_rows.h"
#include "closure_walk.h"
#include "etendue/describe/color.h"
#include "etendue/scatter_model.h"

namespace etendue::osl {

namespace {

// ---- subsurface scattering

/// What subsurface() and subsurface_bssrdf() say.
struct Body {
  Triple normal, albedo, radius;  ///< radius: the mean free path [m]
};
bool is_body(const ClosureComponent& c, Body& body) {
  static const String *classic = intern_string("subsurface"), *bssrdf = intern_string("subsurface_bssrdf");
  if (c.shape->name == bssrdf)
    body = {c.argument<Triple>(0), c.argument<Triple>(1), c.argument<Triple>(2)};
  else if (c.shape->name == classic)
    body = {Triple(0), c.argument<Triple>(3), c.argument<Triple>(2)};
  else
    return false;
  return true;
}

bool deep(const Body& b) { return b.radius.x > 0 || b.radius.y > 0 || b.radius.z > 0; }

/// Light that enters a body without a boundary of its own: all of it goes straight on, by specular transmission, and leaves by
/// Shader::sample_exit. The albedo is what leaves again.
class EntryModel final : public ScatterModel<EntryModel> {
 public:
  static constexpr bool uses_choice = false;
  EntryModel(const SurfacePoint& p, Spectrum returned) : ScatterModel(p, specular_transmission), returned_(returned) {}
  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }
  bool local_sample(const Vector3& out, float, Point2, Lobes, LocalSample& s) const {
    s.in = -out;
    s.value = Spectrum(1.0f);
    s.pdf = 1;
    s.lobe = specular_transmission;
    return true;
  }
  Spectrum local_albedo(const Vector3&, Lobes lobes) const { return lobes & specular_transmission ? returned_ : Spectrum(); }

 private:
  Spectrum returned_;
};

void subsurface(Gathering& g, const ClosureComponent& c) {
  Body body;
  if (!is_body(c, body)) return;
  if (g.exits() && deep(body)) {
    const Spectrum returned = clamp(g.color(body.albedo, ColorUse::reflectance), 0, 1);
    return g.add_entry(g.arena().make<EntryModel>(g.at(body.normal), returned), g.reflectance(Triple(1)));
  }
  if (deep(body))
    g.warn(
        "subsurface scattering is rendered as diffuse reflection of the same albedo, as the surface lets light through, too, "
        "or "
        "had none where it was looked for when it was prepared");
  rough_diffuse(g, body.normal, body.albedo, 0);
}

const etendue::Shader& body_model() {
  // Without a boundary of its own, as the closures above it are the boundary.
  static const Ref<etendue::Shader> model = make_model("Subsurface", {{"color", Value(Ref<etendue::Component>(color_slot(0)))},
                                                                      {"mean_free_path", Value(length_slot())},
                                                                      {"ior", Value(index_slot(false))}});
  return *model;
}

// ---- hair

/// The roughness of HairFibre whose increasing function is `value`.
template <class F>
float inverse(const F& f, float value) {
  float low = 0, high = 1;
  for (int i = 0; i < 20; ++i) {
    const float middle = (low + high) / 2;
    (f(middle) < value ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// A fibre's index and tilt are one for a shader of the house; closures may have any, of which few occur in a scene.
const etendue::Shader& hair_model(float ior, float degrees) {
  static std::mutex guard;
  static auto* models = new std::map<std::pair<int, int>, Ref<etendue::Shader>>;
  const std::pair<int, int> key{int(std::lround(clamp(ior, 1, 3) * 100)), int(std::lround(clamp(degrees, -15, 15) * 4))};
  const std::lock_guard lock(guard);
  Ref<etendue::Shader>& model = (*models)[key];
  if (!model)
    model = make_model("HairShader", {{"pigment", Value(std::string("absorption"))},
                                      {"absorption", Value(Ref<etendue::Component>(color_slot(0)))},
                                      {"longitudinal_roughness", Value(Ref<etendue::Component>(number_slot(0)))},
                                      {"azimuthal_roughness", Value(Ref<etendue::Component>(number_slot(1)))},
                                      {"ior", Value(Number{key.first / 100.0})},
                                      {"tilt", Value(Number{key.second / 4.0 * double(pi) / 180, Dimension::angle})}});
  return *model;
}

// chiang_hair_bsdf: its roughnesses are the variance of the longitudinal lobes and the scale of the azimuthal ones, which
// HairFibre computes from a roughness of equal steps; those of TT and TRT follow from R's as Chiang et al. 2016 have it. The
// angle of the cuticle goes from 0 to 1, half of it being no tilt, and 1 a right angle.
void hair(Gathering& g, const ClosureComponent& c) {
  const auto white = [](const Triple& t) { return t == Triple(1); };
  if (!white(c.argument<Triple>(2)) || !white(c.argument<Triple>(3)) || !white(c.argument<Triple>(4)))
    g.warn("the tints of chiang_hair_bsdf() have no effect: its absorption gives hair its colour");
  SlotValues v;
  v.colors[0] = max(g.color(c.argument<Triple>(13), ColorUse::coefficient), 0);
  v.numbers[0] = inverse(
      [](float b) {
        const float r = 0.726f * b + 0.812f * b * b + 3.7f * std::pow(b, 20.0f);
        return r * r;
      },
      c.argument<float>(6));
  v.numbers[1] =
      inverse([](float b) { return 0.265f * b + 1.194f * b * b + 5.372f * std::pow(b, 22.0f); }, c.argument<float>(9));
  const float tilt = (c.argument<float>(12) * 2 - 1) * 90;
  g.add(hair_model(c.argument<float>(5), tilt), v, g.at(c.argument<Triple>(0), c.argument<Triple>(1)),
        glossy_reflection | glossy_transmission | null_scattering, g.reflectance(Triple(1)));
}

constexpr ClosureModel rows[] = {
    {"subsurface", subsurface, diffuse_reflection, 0.3f, false},
    {"subsurface_bssrdf", subsurface, diffuse_reflection, 0.3f, false},
    {"chiang_hair_bsdf", hair, glossy_reflection | glossy_transmission | null_scattering, 0.3f, false},
};

}  // namespace

std::span<const ClosureModel> body_closures() { return rows; }

bool has_body(const ClosureNode* node) {
  bool found = false;
  each_component(node, [&](const ClosureComponent& c, const Triple&, const Spectrum&) {
    Body body;
    found |= is_body(c, body) && deep(body);
  });
  return found;
}

// The entry had the weight W = sum of w_k over the bodies k at the point. One of them is chosen with the probability q_k in
// proportion to the mean of w_k, and the weight is w_k / (W q_k). What layers above the bodies let through is that of the
// entry.
std::optional<SubsurfaceExit> exit_of(const ClosureNode* node, const ClosurePlace& place, const Scene& scene,
                                      NumberStream& random) {
  constexpr int most = 8;
  Body bodies[most];
  Spectrum weights[most], all;
  int count = 0;
  each_component(node, [&](const ClosureComponent& c, const Triple& weight, const Spectrum& spectral) {
    if (count == most || !is_body(c, bodies[count])) return;
    const bool grey = weight.x == weight.y && weight.y == weight.z;
    const Spectrum w =
        max(grey ? Spectrum(weight.x)
                 : rgb_spectrum(place.space, weight.x, weight.y, weight.z, ColorUse::reflectance, place.wavelengths),
            0) *
        max(spectral, 0);
    if (!(w.average() > 0)) return;
    all += weights[count] = w;
    ++count;
  });
  if (count == 0) return std::nullopt;
  int k = 0;
  float probability = 1;
  if (count > 1) {
    float u = random.next() * all.average();
    for (; k + 1 < count && u >= weights[k].average(); ++k) u -= weights[k].average();
    probability = weights[k].average() / all.average();
  }
  const Body& body = bodies[k];
  const Gathering g(place);
  SlotValues v;
  v.colors[0] = clamp(g.color(body.albedo, ColorUse::reflectance), 0, 1);
  v.length = max(g.color(body.radius, ColorUse::coefficient), 1e-6f);
  v.index = g.index_outside();
  const Spectrum share = map(all, [](float w) { return w > 0 ? 1 / w : 0; }) * weights[k] / probability;
  const SlotScope scope(v);
  auto exit = body_model().sample_exit(g.at(body.normal), scene, place.wavelengths, random, place.arena);
  if (exit) exit->weight *= share;
  return exit;
}

}  // namespace etendue::osl
