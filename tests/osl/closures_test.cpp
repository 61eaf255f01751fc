// Closures against the shaders of the house that do the same, and mixtures of them against their own pdfs.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <random>
#include <thread>

#include "etendue/core/warp.h"
#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "osl/closures/closure_models.h"

namespace etendue::osl {
namespace {

/// Closures as a shader would make them.
class Maker {
 public:
  template <class... A>
  const ClosureNode* component(const char* name, const A&... arguments) {
    auto* shape = new ClosureShape;
    shape->name = intern_string(name);
    (shape->add(type_of(arguments)), ...);
    auto* bytes = new std::byte[shape->size + 8];
    size_t i = 0;
    ((std::memcpy(bytes + shape->arguments[i++].offset, &arguments, sizeof arguments)), ...);
    auto* c = new ClosureComponent;
    c->kind = ClosureNode::Kind::component;
    c->shape = shape;
    c->arguments = bytes;
    return c;
  }
  const ClosureNode* sum(const ClosureNode* a, const ClosureNode* b) {
    auto* s = new ClosureSum;
    s->kind = ClosureNode::Kind::sum;
    s->a = a;
    s->b = b;
    return s;
  }
  const ClosureNode* product(Triple w, const ClosureNode* c) {
    auto* p = new ClosureProduct;
    p->kind = ClosureNode::Kind::product;
    p->weight = w;
    p->closure = c;
    return p;
  }

 private:
  static Type type_of(float) { return Base::float_; }
  static Type type_of(int) { return Base::int_; }
  static Type type_of(const Triple&) { return Base::vector; }
  static Type type_of(const String*) { return Base::string; }
  static Type type_of(const ClosureNode*) { return Type::closure_color(); }
};

struct Place {
  SurfacePoint p;
  Wavelengths w;
  Arena arena;
  std::string name = "Test";

  Place() {
    p.normal = p.shading_normal = Normal3{0, 0, 1};
    p.dpdu = {1, 0, 0};
    p.dpdv = {0, 1, 0};
    std::array<float, spectrum_size> lambda, pdf;
    for (size_t i = 0; i < spectrum_size; ++i) {
      lambda[i] = 400 + 40 * float(i);
      pdf[i] = 1 / 470.0f;
    }
    w = Wavelengths(lambda, pdf);
  }
  const Scatter* bind(const ClosureNode* c) { return scatter_of(c, {p, w, arena, rgb_space("srgb"), false, name}); }
};

const Triple up{0, 0, 1}, along_u{1, 0, 0};

/// The mean weight of samples against the albedo, and the integral of the pdf against 1 at most; 5 standard deviations of
/// 20,000 samples of weights up to a few.
void expect_consistent(const Scatter& s, float cosine, double albedo_tolerance) {
  const Vector3 out{safe_sqrt(1 - cosine * cosine), 0, cosine};
  std::mt19937 random(7);
  const auto number = [&] { return float(random() >> 8) / float(1 << 24); };
  constexpr int count = 20000;
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const auto sample = s.sample(out, number(), {number(), number()});
    const double x = sample ? double(sample->weight.average()) : 0;
    sum += x;
    squares += x * x;
    if (!sample || sample->specular()) continue;
    const ScatterValue v = s.value_and_pdf(out, sample->direction);
    EXPECT_NEAR(v.pdf, sample->pdf, 2e-3f * sample->pdf + 1e-6f);
    const float expected = sample->weight.average() * sample->pdf;
    EXPECT_NEAR(v.value.average(), expected, 2e-3f * std::abs(expected) + 1e-6f);
  }
  const double mean = sum / count, deviation = std::sqrt(std::max(squares / count - mean * mean, 0.0) / count);
  EXPECT_NEAR(mean, double(s.albedo(out).average()), 5 * deviation + albedo_tolerance);
  double pdf = 0;
  constexpr int grid = 200;
  for (int i = 0; i < grid; ++i)
    for (int k = 0; k < grid; ++k)
      pdf += double(s.pdf(out, warp::sphere({(float(i) + 0.5f) / grid, (float(k) + 0.5f) / grid}))) * 4 * double(pi) /
             (grid * grid);
  EXPECT_LT(pdf, 1.02);
}

TEST(Closures, AreTheShadersOfTheHouse) {
  Place place;
  Maker make;
  const Ref<etendue::Shader> own = ref_cast<etendue::Shader>(Registry::instance().create("Lambertian"));
  set(*own, "color", etendue::Value(Color(rgb_color("srgb", 0.6, 0.3, 0.1))));
  prepare_tree(*own);
  const Scatter* a = own->bind(place.p, place.w, place.arena);
  const Scatter* b = place.bind(make.product({0.6f, 0.3f, 0.1f}, make.component("diffuse", up)));
  ASSERT_TRUE(a && b);
  const Vector3 out = normalize(Vector3{0.3f, 0.2f, 0.9f}), in = normalize(Vector3{-0.5f, 0.1f, 0.6f});
  for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(a->evaluate(out, in)[i], b->evaluate(out, in)[i], 1e-5f);
}

TEST(Closures, MetalsHaveTheirColourAtNormalIncidence) {
  Place place;
  Maker make;
  const Triple n{0.18f, 0.42f, 1.37f}, k{3.42f, 2.35f, 1.77f};
  const Scatter* s = place.bind(make.component("conductor_bsdf", up, along_u, 0.0f, 0.0f, n, k, intern_string("ggx")));
  ASSERT_TRUE(s);
  const auto sample = s->sample({0, 0, 1}, 0.5f, {0.5f, 0.5f});
  ASSERT_TRUE(sample);
  float r[3];
  for (int i = 0; i < 3; ++i) r[i] = (square(n[i] - 1) + square(k[i])) / (square(n[i] + 1) + square(k[i]));
  const Spectrum expected = rgb_spectrum(rgb_space("srgb"), r[0], r[1], r[2], ColorUse::reflectance, place.w);
  for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(sample->weight[i], expected[i], 2e-3f);
}

TEST(Closures, SampleWhatTheyEvaluate) {
  Place place;
  Maker make;
  const String* ggx = intern_string("ggx");
  const ClosureNode* const diffuse = make.component("diffuse", up);
  const ClosureNode* const phong = make.component("phong", up, 20.0f);
  const ClosureNode* const all[] = {
      make.product(Triple(0.7f), diffuse),
      make.component("oren_nayar", up, 0.5f),
      make.component("burley_diffuse_bsdf", up, Triple(0.5f), 0.7f),
      make.component("sheen_bsdf", up, Triple(0.8f), 0.4f),
      phong,
      make.component("translucent", up),
      make.component("conductor_bsdf", up, along_u, 0.3f, 0.2f, Triple(0.2f), Triple(3), ggx),
      make.component("generalized_schlick_bsdf", up, along_u, Triple(1), Triple(0), 0.4f, 0.4f, Triple(0.2f), Triple(1), 5.0f,
                     ggx),
      make.component("dielectric_bsdf", up, along_u, Triple(1), Triple(0), 0.3f, 0.3f, 1.5f, ggx),
      make.sum(make.product(Triple(0.5f), diffuse), make.product(Triple(0.5f), make.component("reflection", up, 0.0f))),
      make.component("layer", make.component("dielectric_bsdf", up, along_u, Triple(1), Triple(0), 0.2f, 0.2f, 1.5f, ggx),
                     make.product(Triple(0.6f), diffuse)),
      make.sum(make.product(Triple(0.4f), make.component("transparent")),
               make.sum(make.product(Triple(0.3f), diffuse), make.product(Triple(0.2f), make.component("phong", up, 50.0f)))),
  };
  for (size_t i = 0; i < std::size(all); ++i) {
    SCOPED_TRACE(i);
    const Scatter* s = place.bind(all[i]);
    ASSERT_TRUE(s);
    // The albedo of Phong's lobe is a line between those of two directions.
    const double tolerance = all[i] == phong ? 0.05 : 0.03;
    for (const float cosine : {0.95f, 0.5f}) expect_consistent(*s, cosine, tolerance);
  }
}

TEST(Closures, TiltedFacetsHaveFinitePdfs) {
  Place place;
  Maker make;
  const Triple tilted{0.2f, -0.15f, 0.968f};
  const ClosureNode* flakes = make.component("generalized_schlick_bsdf", tilted, along_u, Triple(1), Triple(0), 0.15f, 0.15f,
                                             Triple{0.9f, 0.25f, 0.2f}, Triple(1), 5.0f, intern_string("ggx"));
  const Scatter* s = place.bind(flakes);
  ASSERT_TRUE(s);
  const Vector3 out{0, 0, 1};
  for (int i = 0; i < spectrum_size; ++i) EXPECT_TRUE(s->albedo(out)[i] >= 0 && s->albedo(out)[i] <= 1) << s->albedo(out)[i];
  for (const float z : {0.3f, 1e-3f, 3.8e-8f, -3.8e-8f})
    for (int k = 0; k < 16; ++k) {
      const float phi = 0.4f * float(k);
      const ScatterValue v =
          s->value_and_pdf(out, {safe_sqrt(1 - z * z) * std::cos(phi), safe_sqrt(1 - z * z) * std::sin(phi), z});
      EXPECT_TRUE(std::isfinite(v.pdf)) << z << " " << phi;
    }
  // For importance the pdf counts the directions from which the facets are seen, of which rounding may leave none along the
  // surface.
  std::mt19937 random(3);
  const auto number = [&] { return float(random() >> 8) / float(1 << 24); };
  for (int k = 0; k < 20000; ++k) {
    const float phi = 2 * pi * number(), z = 1e-7f * number();
    const Vector3 in{std::cos(phi), std::sin(phi), z};
    const ScatterValue v = s->value_and_pdf(out, in, {.transport = Transport::importance});
    ASSERT_TRUE(std::isfinite(v.pdf) && v.pdf >= 0) << z << " " << phi;
  }
}

TEST(Closures, ACoatSeenFromInsideReflectsTotally) {
  Place place;
  place.p.shading_normal = Normal3(normalize(Vector3{0.4f, 0.1f, 0.9f}));
  Maker make;
  const Triple zero(0);
  for (const ClosureNode* coat :
       {make.component("dielectric_bsdf", zero, along_u, Triple(1), Triple(0), 0.0f, 0.0f, 1.5f, intern_string("ggx")),
        make.component("reflection", zero, 1.5f)}) {
    const ClosurePlace at{place.p, place.w, place.arena, rgb_space("srgb"), false, place.name, false};
    const Scatter* s = scatter_of(coat, at);
    ASSERT_TRUE(s);
    const Vector3 out = normalize(Vector3{0.7f, 0.2f, -0.64f});
    EXPECT_NEAR(s->albedo(out).average(), 1, 1e-5f);
    for (const float choice : {0.1f, 0.9f}) {
      const auto sample = s->sample(out, choice, {0.5f, 0.5f});
      ASSERT_TRUE(sample);
      EXPECT_NEAR(sample->weight.average(), 1, 1e-5f);
    }
    // From outside: ((n - 1) / (n + 1))^2.
    EXPECT_NEAR(s->albedo(Vector3(place.p.shading_normal)).average(), 0.04f, 1e-4f);
  }
}

TEST(Closures, SumsReflectAtMostAllLight) {
  Place place;
  Maker make;
  const ClosureNode* diffuse = make.component("diffuse", up);
  const ClosureNode* metal = make.component("generalized_schlick_bsdf", up, along_u, Triple(1), Triple(0), 0.3f, 0.3f,
                                            Triple(0.8f), Triple(1), 5.0f, intern_string("ggx"));
  const Scatter* s = place.bind(make.sum(diffuse, metal));
  ASSERT_TRUE(s);
  for (const float cosine : {1.0f, 0.7f, 0.3f}) {
    const Vector3 out{safe_sqrt(1 - cosine * cosine), 0, cosine};
    EXPECT_LE(s->albedo(out).maximum(), 1.001f);
    EXPECT_GE(s->albedo(out).minimum(), 0.9f);
    expect_consistent(*s, cosine, 0.03);
  }
  // What sums to less is left as it is.
  const Scatter* half = place.bind(make.sum(make.product(Triple(0.5f), diffuse), make.product(Triple(0.3f), diffuse)));
  EXPECT_NEAR(half->albedo({0, 0, 1}).average(), 0.8f, 1e-4f);
}

// The light that leaves in a direction, of uniform light from everywhere, by a grid of 200 x 200 directions: not by the albedo
// that the scatter states itself.
double reflected(const Scatter& s, float cosine) {
  const Vector3 out{safe_sqrt(1 - cosine * cosine), 0, cosine};
  constexpr int side = 200;
  double sum = 0;
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k) {
      const Vector3 in = warp::sphere({(float(i) + 0.5f) / side, (float(k) + 0.5f) / side});
      sum += double(s.evaluate(out, in).average()) * 4 * double(pi) / (side * side);
    }
  return sum;
}

// At every angle, not only where a sum was looked at.
TEST(Closures, SumsReflectAtMostAllLightAtGrazingAngles) {
  Place place;
  Maker make;
  const ClosureNode* base = make.product(Triple(0.9f), make.component("diffuse", up));
  const ClosureNode* coat =
      make.component("dielectric_bsdf", up, along_u, Triple(1), Triple(0), 0.4f, 0.4f, 1.5f, intern_string("ggx"));
  const ClosurePlace at{place.p, place.w, place.arena, rgb_space("srgb"), false, place.name, false};
  const Scatter* s = scatter_of(make.sum(coat, base), at);
  ASSERT_TRUE(s);
  // 0.9 and 0.04 along the normal: it stays as it is.
  EXPECT_NEAR(reflected(*s, 0.95f), 0.94, 0.015);
  for (const float cosine : {0.5f, 0.2f, 0.1f, 0.05f}) {
    EXPECT_LE(reflected(*s, cosine), 1.01) << cosine;
    EXPECT_LE(s->albedo({safe_sqrt(1 - cosine * cosine), 0, cosine}).maximum(), 1.001f) << cosine;
  }
  // And it stays reciprocal.
  const Vector3 a = normalize(Vector3{0.9f, 0.1f, 0.12f}), b = normalize(Vector3{-0.5f, 0.3f, 0.8f});
  EXPECT_NEAR(s->evaluate(a, b)[0] / b.z, s->evaluate(b, a)[0] / a.z, 1e-4f);
}

// The BSDF of a virtual light is evaluated by all threads at once, from directions of their own.
TEST(Closures, SumsAreTheSameForAllThreads) {
  Place place;
  Maker make;
  const ClosureNode* base = make.product(Triple(0.9f), make.component("diffuse", up));
  const ClosureNode* coat =
      make.component("dielectric_bsdf", up, along_u, Triple(1), Triple(0), 0.4f, 0.4f, 1.5f, intern_string("ggx"));
  const Scatter* s = place.bind(make.sum(coat, base));
  ASSERT_TRUE(s);
  constexpr int threads = 4, directions = 64, rounds = 400;
  const Vector3 to_light = normalize(Vector3{0.3f, -0.2f, 0.4f});
  const auto from = [](int i) { return normalize(Vector3{std::cos(float(i)), std::sin(float(i)), 0.05f + 0.02f * float(i)}); };
  std::vector<Spectrum> alone;
  for (int i = 0; i < directions; ++i) alone.push_back(s->evaluate(from(i), to_light));
  std::atomic<int> different = 0;
  std::vector<std::jthread> all;
  for (int t = 0; t < threads; ++t)
    all.emplace_back([&, t] {
      for (int i = 0; i < rounds * directions; ++i) {
        const int k = (i * (2 * t + 1) + t) % directions;
        if (!(s->evaluate(from(k), to_light) - alone[size_t(k)]).black()) ++different;
      }
    });
  all.clear();
  EXPECT_EQ(different, 0);
}

TEST(Closures, ARoughWhiteBurleySurfaceReflectsAtMostAllLight) {
  Place place;
  Maker make;
  const Scatter* s = place.bind(make.component("burley_diffuse_bsdf", up, Triple(1), 1.0f));
  ASSERT_TRUE(s);
  for (const float cosine : {0.9f, 0.5f, 0.2f, 0.1f, 0.05f}) {
    const double sum = reflected(*s, cosine);
    EXPECT_LE(sum, 1.005) << cosine;
    EXPECT_NEAR(sum, double(s->albedo({safe_sqrt(1 - cosine * cosine), 0, cosine}).average()), 0.05 * sum) << cosine;
  }
}

// Glass in two closures is the dielectric that one closure is, also seen from inside by a tilted normal, where each alone would
// let light out by facets of the opposite tilt in its own way (scatter_corrections.h).
TEST(Closures, ReflectionAndRefractionOfOneBoundaryAreOneDielectric) {
  Place place;
  Maker make;
  const Triple zero(0);
  place.p.shading_normal = Normal3(normalize(Vector3{0.3f, 0.1f, 0.95f}));
  const String* ggx = intern_string("ggx");
  for (const float rough : {0.0f, 0.3f}) {
    const ClosureNode* whole = make.component("microfacet", ggx, zero, rough, 1.5f, 2);
    const ClosureNode* parts = make.sum(make.component("microfacet", ggx, zero, rough, 1.5f, 0),
                                        make.product(Triple(0.5f), make.component("microfacet", ggx, zero, rough, 1.5f, 1)));
    const Scatter *a = place.bind(whole), *b = place.bind(parts);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->lobes(), b->lobes());
    std::mt19937 random(5);
    const auto number = [&] { return float(random() >> 8) / float(1 << 24); };
    for (int i = 0; i < 200; ++i) {
      const Vector3 out = warp::sphere({number(), number()});
      EXPECT_NEAR(a->albedo(out, reflection_lobes).average(), b->albedo(out, reflection_lobes).average(), 1e-5f);
      EXPECT_NEAR(0.5f * a->albedo(out, transmission_lobes).average(), b->albedo(out, transmission_lobes).average(), 1e-5f);
      const Vector3 in = warp::sphere({number(), number()});
      const float share = (dot(Vector3(place.p.normal), out) > 0) == (dot(Vector3(place.p.normal), in) > 0) ? 1 : 0.5f;
      EXPECT_NEAR(share * a->evaluate(out, in).average(), b->evaluate(out, in).average(), 1e-5f);
    }
  }
}

// From inside, where a tilted normal turns reflections to the other side of the surface: all light is scattered once.
TEST(Closures, ReflectionAndRefractionOfOneBoundaryScatterAllLightOnce) {
  Place place;
  Maker make;
  place.p.shading_normal = Normal3(normalize(Vector3{0.5f, 0.1f, 0.85f}));
  const ClosureNode* parts =
      make.sum(make.component("reflection", Triple(0), 1.5f), make.component("refraction", Triple(0), 1.5f));
  const Scatter* s = place.bind(parts);
  const Scatter* whole = place.bind(make.component("microfacet", intern_string("ggx"), Triple(0), 0.0f, 1.5f, 2));
  ASSERT_TRUE(s && whole);
  std::mt19937 random(5);
  const auto number = [&] { return float(random() >> 8) / float(1 << 24); };
  for (int i = 0; i < 40; ++i) {
    const Vector3 out = warp::sphere({number(), number()});
    double sum = 0, expected = 0;
    constexpr int count = 400;
    for (int k = 0; k < count; ++k) {
      const float choice = (float(k) + 0.5f) / count;
      if (const auto sample = s->sample(out, choice, {0.5f, 0.5f})) sum += double(sample->weight.average()) / count;
      if (const auto sample = whole->sample(out, choice, {0.5f, 0.5f})) expected += double(sample->weight.average()) / count;
    }
    EXPECT_NEAR(sum, expected, 0.01) << out.x << ' ' << out.y << ' ' << out.z;
  }
}

// A loop makes sums that are deeper than a stack.
TEST(Closures, SumsMayBeDeep) {
  Place place;
  Maker make;
  const ClosureNode* light = make.component("emission");
  const ClosureNode* sum = make.component("diffuse", up);
  for (int i = 0; i < 300'000; ++i) sum = make.sum(sum, light);
  const Scatter* s = place.bind(sum);
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->albedo({0, 0, 1}).average(), 1, 1e-4f);
  EXPECT_GT(light_of(sum, rgb_space("srgb"), place.w).average(), 1000);
  EXPECT_EQ(refracting_index(sum), 1);
  const ClosureNode* nested = make.component("diffuse", up);
  for (int i = 0; i < 100'000; ++i) nested = make.component("layer", nested, light);
  EXPECT_THROW(place.bind(nested), Error);
}

TEST(Closures, NoLightIsMadeByALayer) {
  Place place;
  Maker make;
  const ClosureNode* white = make.component("diffuse", up);
  const ClosureNode* coat =
      make.component("dielectric_bsdf", up, along_u, Triple(1), Triple(0), 0.0f, 0.0f, 1.5f, intern_string("ggx"));
  const Scatter* s = place.bind(make.component("layer", coat, make.component("layer", coat, white)));
  ASSERT_TRUE(s);
  for (const float cosine : {1.0f, 0.6f, 0.2f}) {
    const float albedo = s->albedo({safe_sqrt(1 - cosine * cosine), 0, cosine}).average();
    EXPECT_NEAR(albedo, 1, 1e-3f);
  }
  // Half of it has half of the albedo.
  const Scatter* half = place.bind(make.product(Triple(0.5f), make.component("layer", coat, white)));
  EXPECT_NEAR(half->albedo({0, 0, 1}).average(), 0.5f, 1e-3f);
}

TEST(Closures, EmitTheColourOfTheWeight) {
  Place place;
  Maker make;
  const Spectrum light = light_of(make.product({2, 1, 0.5f}, make.component("emission")), rgb_space("srgb"), place.w);
  const Spectrum expected = rgb_spectrum(rgb_space("srgb"), 2, 1, 0.5f, ColorUse::radiance, place.w);
  for (int i = 0; i < spectrum_size; ++i) EXPECT_FLOAT_EQ(light[i], expected[i]);
  EXPECT_FALSE(place.bind(make.component("emission")));
}

}  // namespace
}  // namespace etendue::osl
