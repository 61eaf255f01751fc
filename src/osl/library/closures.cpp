// The closures' signatures, as in stdosl.h, and how closures are made.

#include "closures.h"

#include <cstring>
#include <new>

#include "choose.h"
#include "parts.h"
#include "services.h"

namespace etendue::osl {

namespace {

constexpr const char* film = "float thinfilm_thickness, float thinfilm_ior";

constexpr ClosureSignature signatures[] = {
    {"closure color emission()"},
    {"closure color background()"},
    {"closure color diffuse(normal N)"},
    {"closure color oren_nayar(normal N, float sigma)"},
    {"closure color translucent(normal N)"},
    {"closure color phong(normal N, float exponent)"},
    {"closure color ward(normal N, vector T, float ax, float ay)"},
    {"closure color microfacet(string distribution, normal N, vector U, float xalpha, float yalpha, float eta, int refract)"},
    {"closure color microfacet(string distribution, normal N, float alpha, float eta, int refract)"},
    {"closure color reflection(normal N, float eta)"},
    {"closure color reflection(normal N)"},
    {"closure color refraction(normal N, float eta)"},
    {"closure color transparent()"},
    {"closure color debug(string tag)"},
    {"closure color holdout()"},
    {"closure color subsurface(float eta, float g, color mfp, color albedo)"},
    {"closure color isotropic()"},
    {"closure color henyey_greenstein(float g)"},
    {"closure color absorption()"},
    // MaterialX
    {"closure color oren_nayar_diffuse_bsdf(normal N, color albedo, float roughness)", "int energy_compensation"},
    {"closure color burley_diffuse_bsdf(normal N, color albedo, float roughness)"},
    {"closure color dielectric_bsdf(normal N, vector U, color reflection_tint, color transmission_tint, float roughness_x, "
     "float "
     "roughness_y, float ior, string distribution)",
     film},
    {"closure color conductor_bsdf(normal N, vector U, float roughness_x, float roughness_y, color ior, color extinction, "
     "string "
     "distribution)",
     film},
    {"closure color generalized_schlick_bsdf(normal N, vector U, color reflection_tint, color transmission_tint, float "
     "roughness_x, "
     "float roughness_y, color f0, color f90, float exponent, string distribution)",
     film},
    {"closure color translucent_bsdf(normal N, color albedo)"},
    {"closure color transparent_bsdf()"},
    {"closure color subsurface_bssrdf(normal N, color albedo, color radius, float anisotropy)"},
    {"closure color sheen_bsdf(normal N, color albedo, float roughness)"},
    {"closure color chiang_hair_bsdf(normal N, vector curve_direction, color tint_R, color tint_TT, color tint_TRT, float ior, "
     "float "
     "longitudual_roughness_R, float longitudual_roughness_TT, float longitudual_roughness_TRT, float azimuthal_roughness_R, "
     "float "
     "azimuthal_roughness_TT, float azimuthal_roughness_TRT, float cuticle_angle, color absorption_coefficient)"},
    {"closure color uniform_edf(color emittance)"},
    {"closure color anisotropic_vdf(color albedo, color extinction, float anisotropy)"},
    {"closure color medium_vdf(color albedo, float transmission_depth, color transmission_color, float anisotropy, float ior, "
     "int "
     "priority)"},
    {"closure color layer(closure color top, closure color base)"},
};

template <class T>
T* make(Services& services) {
  return new (services.allocate(sizeof(T), alignof(T))) T;
}

/// mix(closure x, closure y, a): x (1 - a) + y a
void mix_closures(const Call& c) {
  const Triple a = c.type(2).is_triple() ? c.at<Triple>(2) : Triple(c.at<float>(2));
  const ClosureNode* x = make_product(c.services, Triple(1) - a, c.at<const ClosureNode*>(0));
  const ClosureNode* y = make_product(c.services, a, c.at<const ClosureNode*>(1));
  *static_cast<const ClosureNode**>(c.result) = make_sum(c.services, x, y);
}

/// void artistic_ior(color reflectivity, color edge_tint, output color ior, output color extinction): Gulbrandsen 2014, "Artist
/// friendly metallic Fresnel", eqs. 8 to 11.
void artistic_ior(const Call& c) {
  const Triple given = c.at<Triple>(0), tint = c.at<Triple>(1);
  Triple ior, extinction;
  for (int i = 0; i < 3; ++i) {
    const float r = std::clamp(given[i], 0.0f, 0.99f), root = std::sqrt(r);
    const float least = (1 - r) / (1 + r), most = (1 + root) / (1 - root);
    const float n = most * (1 - tint[i]) + least * tint[i];
    const float square = ((n + 1) * (n + 1) * r - (n - 1) * (n - 1)) / (1 - r);
    ior[i] = n;
    extinction[i] = std::sqrt(std::max(square, 0.0f));
  }
  c.give(2, ior);
  c.give(3, extinction);
}

constexpr Row rows[] = {
    {"closure color mix(closure color x, closure color y, float a)", always<mix_closures>, Derivatives::none, 0, nullptr,
     false},
    {"closure color mix(closure color x, closure color y, color a)", always<mix_closures>, Derivatives::none, 0, nullptr,
     false},
    {"void artistic_ior(color reflectivity, color edge_tint, output color ior, output color extinction)", always<artistic_ior>,
     Derivatives::none},
};

}  // namespace

std::span<const ClosureSignature> closures() { return signatures; }

std::span<const Row> closure_rows() { return rows; }

const ClosureNode* make_component(const Call& c, const ClosureShape& shape) {
  auto* component = make<ClosureComponent>(c.services);
  component->kind = ClosureNode::Kind::component;
  component->shape = &shape;
  component->arguments = nullptr;
  if (shape.size == 0) return component;
  auto* memory = static_cast<std::byte*>(c.services.allocate(shape.size, alignof(Spectrum)));
  component->arguments = memory;
  int from = 0;
  for (const ClosureShape::Argument& a : shape.arguments) {
    if (a.keyword) ++from;
    std::memcpy(memory + a.offset, c.arguments[from++], a.type.size());
  }
  return component;
}

const ClosureNode* make_sum(Services& services, const ClosureNode* a, const ClosureNode* b) {
  if (!a || !b) return a ? a : b;
  auto* sum = make<ClosureSum>(services);
  sum->kind = ClosureNode::Kind::sum;
  sum->a = a, sum->b = b;
  return sum;
}

const ClosureNode* make_product(Services& services, const Triple& weight, const ClosureNode* closure) {
  if (!closure || weight == Triple(0)) return nullptr;
  if (weight == Triple(1)) return closure;
  auto* product = make<ClosureProduct>(services);
  product->kind = ClosureNode::Kind::product;
  product->weight = weight;
  product->closure = closure;
  return product;
}

const ClosureNode* make_product(Services& services, const Spectrum& weight, const ClosureNode* closure) {
  if (!closure || weight.black()) return nullptr;
  auto* product = make<ClosureProduct>(services);
  product->kind = ClosureNode::Kind::product;
  auto* spectrum = make<Spectrum>(services);
  *spectrum = weight;
  product->spectrum = spectrum;
  product->closure = closure;
  return product;
}

}  // namespace etendue::osl
