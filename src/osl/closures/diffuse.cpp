// Closures that scatter diffusely.

#include <array>

#include "closure_rows.h"
#include "lobes.h"

namespace etendue::osl {

void rough_diffuse(Gathering& g, Triple normal, Triple albedo, float roughness) {
  static const Ref<etendue::Shader> model =
      make_model("OrenNayar", {{"color", Value(Ref<etendue::Component>(color_slot(0)))},
                               {"roughness", Value(Ref<etendue::Component>(number_slot(0)))}});
  SlotValues v;
  v.colors[0] = g.reflectance(albedo);
  v.numbers[0] = roughness;
  g.add(*model, v, g.at(normal), diffuse_reflection);
}

namespace {

using Component = ClosureComponent;

void diffuse(Gathering& g, const Component& c) {
  static const Ref<etendue::Shader> model =
      make_model("Lambertian", {{"color", Value(Ref<etendue::Component>(color_slot(0)))}});
  SlotValues v;
  v.colors[0] = g.reflectance(Triple(1));
  g.add(*model, v, g.at(c.argument<Triple>(0)), diffuse_reflection);
}

/// The roughness of the energy-preserving model (eon.h) for the slopes' standard deviation sigma [rad] of Oren & Nayar 1994:
/// f is proportional to A + B s / t there, and to 1 + r s / t here, so r = B / A.
float roughness_of_sigma(float sigma) {
  const float s2 = sigma * sigma, a = 1 - 0.5f * s2 / (s2 + 0.33f), b = 0.45f * s2 / (s2 + 0.09f);
  return clamp(b / a, 0, 1);
}

void oren_nayar(Gathering& g, const Component& c) {
  rough_diffuse(g, c.argument<Triple>(0), Triple(1), roughness_of_sigma(c.argument<float>(1)));
}

void oren_nayar_diffuse_bsdf(Gathering& g, const Component& c) {
  const float roughness = c.argument<float>(2);
  rough_diffuse(g, c.argument<Triple>(0), c.argument<Triple>(1),
                keyword(c, "energy_compensation", 0) != 0 ? clamp(roughness, 0, 1) : roughness_of_sigma(roughness));
}

void burley_diffuse_bsdf(Gathering& g, const Component& c) {
  const SurfacePoint& p = g.at(c.argument<Triple>(0));
  g.add(g.arena().make<BurleyModel>(p, g.reflectance(c.argument<Triple>(1)), clamp(c.argument<float>(2), 0, 1)),
        diffuse_reflection);
}

void transmit_diffusely(Gathering& g, Triple normal, Triple albedo) {
  static const Ref<etendue::Shader> model =
      make_model("DiffuseTransmitter", {{"reflectance", Value(Ref<etendue::Component>(color_slot(0)))},
                                        {"transmittance", Value(Ref<etendue::Component>(color_slot(1)))}});
  SlotValues v;
  v.colors[0] = {};
  v.colors[1] = g.reflectance(albedo);
  g.add(*model, v, g.at(normal), diffuse_transmission);
}
void translucent(Gathering& g, const Component& c) { transmit_diffusely(g, c.argument<Triple>(0), Triple(1)); }
void translucent_bsdf(Gathering& g, const Component& c) { transmit_diffusely(g, c.argument<Triple>(0), c.argument<Triple>(1)); }

void sheen_bsdf(Gathering& g, const Component& c) {
  const SurfacePoint& p = g.at(c.argument<Triple>(0));
  g.add(g.arena().make<SheenModel>(p, g.reflectance(c.argument<Triple>(1)), c.argument<float>(2)), diffuse_reflection);
}

constexpr ClosureModel rows[] = {
    {"diffuse", diffuse, diffuse_reflection},
    {"oren_nayar", oren_nayar, diffuse_reflection, 0.01f},
    {"oren_nayar_diffuse_bsdf", oren_nayar_diffuse_bsdf, diffuse_reflection, 0.01f},
    {"burley_diffuse_bsdf", burley_diffuse_bsdf, diffuse_reflection, 0.05f},
    {"translucent", translucent, diffuse_transmission},
    {"translucent_bsdf", translucent_bsdf, diffuse_transmission},
    {"sheen_bsdf", sheen_bsdf, diffuse_reflection, 0.02f},
};

}  // namespace

std::span<const ClosureModel> diffuse_closures() { return rows; }

}  // namespace etendue::osl
