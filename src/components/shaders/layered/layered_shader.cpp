// LayeredShader: varnish on wood, glaze on a pot, a sheet of glass: any surface over any other.

#include "components/shaders/scalar_map.h"
#include "etendue/scatter_model.h"
#include "etendue/transport/medium_stack.h"
#include "layered_scatter.h"

namespace etendue {
namespace {

/// Replaces a layer that scatters nothing.
class BlackScatter final : public ScatterModel<BlackScatter> {
 public:
  explicit BlackScatter(const SurfacePoint& p) : ScatterModel(p, no_lobes) {}

  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }
  bool local_sample(const Vector3&, float, Point2, Lobes, LocalSample&) const { return false; }
  Spectrum local_albedo(const Vector3&, Lobes) const { return {}; }
};

/// An object without geometry: represents the space between the layers, or no object, where an object is required.
class Placeholder final : public SceneObject {
 public:
  Bounds3 bounds() const override { return {}; }
  bool intersect(const Ray&, Hit&) const override { return false; }
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const override {}
  void tangents(SurfacePoint&) const override {}
  float area(float) const override { return 0; }
  SurfaceSample sample_area(Point2, float) const override { return {}; }
};

class LayeredShader final : public Shader {
 public:
  static void describe(Description<LayeredShader>& d) {
    d.summary(
         "Any surface over any other, with all the light that goes back and forth between them, and a medium in between. Over "
         "an opaque surface the top is on both sides.",
         "Guo, Hasan & Zhao 2018, Position-free Monte Carlo simulation for arbitrary layered BSDFs")
        .member<&LayeredShader::top>("top", "", "the surface above, such as a Dielectric; its index fills the space between",
                                     required)
        .member<&LayeredShader::bottom>("bottom", "", "the surface below", required)
        .member<&LayeredShader::thickness>("thickness", "m", "of the medium between", Meaning::number, soft(0.00001, 0.1),
                                           logarithmic, when("medium"))
        .member<&LayeredShader::medium>("medium", "", "what absorbs and scatters between the two; nothing: it is clear")
        .member<&LayeredShader::walks>("walks", "1", "how many random walks each value is the mean of", range(1, 16));
  }

  void prepare() override {
    check("top", top);
    check("bottom", bottom);
    require_scalar(*this, "thickness", thickness, 0, thickest);
    if (walks < 1) fail("walks", "at least one is needed");
    if (medium && medium->emits()) fail("medium", "a medium between two layers cannot send out light");
    mean_cosine_ = medium ? mean_cosine(*medium) : 0;
    disperses_ = disperses(*top) || disperses(*bottom);
    mirrored_ = !(bottom->possible_lobes() & transmission_lobes);
    between_ = make<Placeholder>();
    between_->shader = top;
    between_->priority = std::numeric_limits<int>::max();
    nothing_ = make<Placeholder>();
  }

  const Scatter* bind(const SurfacePoint& point, const Wavelengths& w, Arena& arena) const override {
    // Layers are bound without an object of which one side absorbs: light between them may pass through them there too.
    SurfacePoint p = point;
    if (p.object && p.dpdu == Vector3{} && p.dpdv == Vector3{}) p.object->tangents(p);
    if (!p.object || p.object->sides != Sides::both) p.object = nothing_.get();
    SurfacePoint behind = p;
    behind.normal = -p.normal;
    behind.shading_normal = -p.shading_normal;

    const LayerStack* stacks[2][spectrum_size];
    const int count = disperses_ && !w.single() ? spectrum_size : 1;
    for (int i = 0; i < count; ++i) {
      const Wavelengths own = i == 0 ? w : w.alone(i);
      stacks[0][i] = stack(p, own, arena);
      stacks[1][i] = mirrored_ ? stack(behind, own, arena) : stacks[0][i];
    }
    const LayerStack& first = *stacks[0][0];
    const Lobes above = first.face(0).lobes(), below = first.face(1).lobes();
    const bool scatters = first.medium().scatters();
    Lobes lobes = Lobes((above & reflection_lobes) | lobes_between(above, below, scatters));
    if (!mirrored_) lobes |= Lobes((below & reflection_lobes) | lobes_between(below, above, scatters));
    if (lobes == no_lobes) return nullptr;
    HashedRandom seed;
    seed.add(point.position - Point3{}, w.hero());
    return arena.make<LayeredScatter>(point, stacks[0], stacks[1], count, walks, seed.bits(), lobes);
  }

  /// Of light reflected back and forth between the layers only the directions of the first crossings are known.
  float albedo_error() const override { return 0.5f; }
  Lobes possible_lobes() const override {
    const Lobes above = top->possible_lobes(), below = bottom->possible_lobes();
    // A layer that is diffuse at some points may be glossy at others.
    const auto between = [&](Lobes near, Lobes far) {
      return lobes_between(near, far, bool(medium)) | lobes_between(near & ~diffuse_lobes, far & ~diffuse_lobes, false);
    };
    const Lobes lobes = Lobes((above & reflection_lobes) | between(above, below));
    return mirrored_ ? lobes : Lobes(lobes | (below & reflection_lobes) | between(below, above));
  }
  Spectrum interior_index(const Wavelengths& w) const override { return bottom->interior_index(w); }
  bool transmits() const override { return top->transmits() && bottom->transmits(); }
  bool lossless() const override { return top->lossless() && bottom->lossless() && !medium; }
  bool reciprocal() const override { return top->reciprocal() && bottom->reciprocal(); }
  bool stochastic() const override { return true; }

  Ref<Shader> top, bottom;
  Ref<ObjectMap> thickness = constant(0.001f);
  Ref<VolumeShader> medium;
  int walks = 2;

 private:
  static constexpr float thickest = 1e6f;  // [m]

  void check(const char* member, const Ref<Shader>& layer) const {
    if (!layer) fail(member, "a shader is needed");
    if (layer->has_subsurface_exit()) fail(member, "lets light out of the body elsewhere, which a layer cannot");
  }

  /// The mean cosine of a medium's scattering angle.
  static float mean_cosine(const VolumeShader& volume) {
    constexpr int side = 16;
    const Vector3 out{0, 0, 1};
    float sum = 0, pdf = 0;
    for (int i = 0; i < side * side; ++i) {
      const Point2 u{(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side};
      sum -= volume.sample_phase({}, out, u, pdf).z;
    }
    return clamp(sum / (side * side), -1, 1);
  }

  /// Whether a layer is dispersive: found by sampling it, as its interface does not state it.
  static bool disperses(const Shader& layer) {
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i)
      w.place(i, lerp((float(i) + 0.5f) / spectrum_size, 400, 700), 1 / (wavelength_high - wavelength_low));
    SurfacePoint p;
    p.normal = p.shading_normal = p.object_normal = {0, 0, 1};
    p.dpdu = {1, 0, 0};
    p.dpdv = {0, 1, 0};
    Arena arena;
    const Scatter* scatter = layer.bind(p, w, arena);
    HashedRandom random;
    for (int i = 0; scatter && i < 64; ++i) {
      const float z = i % 2 == 0 ? 0.8f : -0.8f, choice = (float(i / 2) + 0.5f) / 32;
      const auto s = scatter->sample({0, 0.6f, z}, choice, random.next_pair());
      if (s && s->dispersive) return true;
    }
    return false;
  }

  const LayerStack* stack(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const {
    // The medium over the bottom is the space between the layers, which has the top's interior index: it is entered into the
    // media around.
    MediumStack* media = arena.make<MediumStack>(p.media ? *p.media : MediumStack());
    media->enter(*between_);
    SurfacePoint inner = p;
    inner.media = media;
    const Scatter* above = top->bind(p, w, arena);
    const Scatter* below = bottom->bind(inner, w, arena);
    LayerStack::Medium filling;
    if (medium) {
      const VolumeCoefficients c = medium->coefficients(p.position, p.time, w);
      const float depth = scalar_at(*thickness, p, 0, thickest);
      filling = {medium.get(), c.absorption * depth, c.scattering * depth, mean_cosine_, p.position};
    }
    return arena.make<LayerStack>(LayerStack::Face{above ? above : arena.make<BlackScatter>(p), top->reciprocal()},
                                  LayerStack::Face{below ? below : arena.make<BlackScatter>(p), bottom->reciprocal()}, p.normal,
                                  p.shading_normal, filling);
  }

  Ref<Placeholder> between_, nothing_;
  float mean_cosine_ = 0;
  bool disperses_ = false, mirrored_ = false;
};

const Register<LayeredShader> registered;

}  // namespace
}  // namespace etendue
