// LayeredShader: varnish on wood, glaze on a pot, a sheet of glass: any surface over any other.

#include "etendue/medium_stack.h"
#include "shaders/layer_stack.h"
#include "shaders/part_choice.h"
#include "shaders/scalar_map.h"

namespace etendue {
namespace {

/// In the place of a layer that scatters nothing.
class BlackScatter final : public Scatter {
 public:
  explicit BlackScatter(const SurfacePoint& p) : Scatter(p, no_lobes) {}

 protected:
  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const override { return {}; }
  float local_density(const Vector3&, const Vector3&, Lobes) const override { return 0; }
  bool local_sample(const Vector3&, float, Point2, Lobes, LocalSample&) const override { return false; }
  Spectrum local_albedo(const Vector3&, Lobes) const override { return {}; }
};

/// What stands for the space between the layers, or for no object at all, where one is asked for.
class Placeholder final : public SceneObject {
 public:
  Bounds3 bounds() const override { return {}; }
  bool intersect(const Ray&, Hit&) const override { return false; }
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const override {}
  void tangents(SurfacePoint&) const override {}
  float area(float) const override { return 0; }
  SurfaceSample sample_area(Point2, float) const override { return {}; }
};

/// The lobes of light that was between the layers, having gone in through a face with the first lobes, with the others on
/// the far side. What is not specular is one lobe a side: diffuse when anything on the way may be, else glossy.
Lobes lobes_between(Lobes near, Lobes far, bool scatters) {
  if (!(near & transmission_lobes)) return no_lobes;
  constexpr Lobes specular_in = specular_transmission | pass_through, smooth_in = smooth_lobes & transmission_lobes;
  constexpr Lobes smooth_back = smooth_lobes & reflection_lobes;
  const bool diffuse = scatters || ((near | far) & diffuse_lobes), both_pass = near & far & pass_through;
  const bool bent = scatters || (near & smooth_in) || ((far & smooth_back) && (near & reflection_lobes)) ||
                    ((far & reflection_lobes) && (near & smooth_back));
  Lobes lobes = no_lobes;
  if (scatters || ((far & reflection_lobes) && (bent || (far & smooth_back))))
    lobes |= diffuse ? diffuse_reflection : glossy_reflection;
  if ((near & specular_in) && (far & specular_reflection)) lobes |= specular_reflection;
  if (far & transmission_lobes) {
    if (bent || (far & smooth_in)) lobes |= diffuse ? diffuse_transmission : glossy_transmission;
    if (both_pass) lobes |= pass_through;
    const bool refracts = ((near | far) & specular_transmission) || (near & far & specular_reflection);
    if ((near & specular_in) && (far & specular_in) && refracts) lobes |= specular_transmission;
  }
  return lobes;
}

// f is what the face on the side of `out` reflects itself, f_E, and what was between, of which LayerStack has estimates.
//
// A sample draws one of E's lobes. When that reflects, it stands for f_E; when not, for what was between, by a walk. The
// weights are unbiased estimates of each part's f |cos| over the true density, for any test function g: the mean of
// weight * g(direction) is the integral of f |cos| g. The true density of walks is not known. The one that `density` gives
// and samples carry is P_E p_E + P_T q, p_E exactly and q about the density of walks, a hashed function of both directions:
// the same wherever it is asked for. Multiple importance sampling with w_1 = p / (p + l) for samples and w_2 = l / (p + l) for
// light sampled with density l uses only that w_1 + w_2 = 1 at each direction: the sum is then the integral of
// (w_1 + w_2) f |cos| g, whatever function p is.
class LayeredScatter final : public ScatterCombination {
 public:
  /// `front`, and `back` where the surface is seen from behind: stacks of the path's wavelengths and, when there is more than
  /// one, of each but the hero alone. A layer that disperses light sends each wavelength another way.
  LayeredScatter(const SurfacePoint& p, const LayerStack* const* front, const LayerStack* const* back, int stacks, int walks,
                 std::uint64_t seed, Lobes lobes)
      : ScatterCombination(p, lobes), stacks_(stacks), walks_(walks), seed_(seed) {
    for (int i = 0; i < stacks; ++i) {
      sides_[0][i] = front[i];
      sides_[1][i] = back[i];
    }
    const Frame &top = front[0]->face(0).frame(), &bottom = front[0]->face(1).frame();
    frame_ = top.n == p.shading_normal ? bottom : top;  // that of the one that was tilted, if one was
  }

  ScatterValue combined_value_and_density(const Vector3& out, const Vector3& in, Transport transport,
                                          Lobes which) const override {
    const LayerStack* const* stacks = seen_from(out);
    const LayerStack& stack = *stacks[0];
    const Scatter& face = stack.face(stack.side(out));
    const Question q(stack, out, which);
    const bool same_side = stack.side(out) == stack.side(in);
    ScatterValue sum;
    if (same_side && face.has(which & reflection_lobes & smooth_lobes)) {
      sum.value = face.evaluate(out, in, transport, which & reflection_lobes) * turned(face, in);
      sum.density = face.density(out, in, transport, q.face);
    }
    if (!(q.between & smooth_lobes & (same_side ? reflection_lobes : transmission_lobes))) return sum;
    Spectrum between;
    for (int i = 0; i < stacks_; ++i) {
      HashedRandom random = numbers(Use::estimate, out, in, transport);
      Spectrum estimate;
      for (int walk = 0; walk < walks_; ++walk) estimate += stacks[i]->estimate(out, in, transport, random);
      if (i == 0)
        between = estimate;
      else
        between.set(i, estimate[0]);
    }
    const float cosine_in = cosine(in);
    if (cosine_in > 0) sum.value += between * (1 / (float(walks_) * cosine_in));
    sum.density += density_between(stack, q.face, out, in, transport);
    if (!sum.value.finite()) sum.value = {};
    return sum;
  }

  std::optional<ScatterSample> combined_sample(const Vector3& out, float choice, Point2 u, Transport transport,
                                               Lobes which) const override {
    const LayerStack& stack = *seen_from(out)[0];
    const int side = stack.side(out);
    const Scatter& face = stack.face(side);
    if (which == pass_through) {  // nothing to choose, as shadow rays rely on
      const Spectrum depth = stack.medium().extinction() * (-1 / std::max(cosine(out), 1e-6f));
      return straight_on(
          out, straight_fraction(&face, out, transport) * exp(depth) * straight_fraction(&stack.face(1 - side), out, transport),
          1);
    }
    const Question q(stack, out, which);
    std::optional<ScatterSample> s = face.sample(out, choice, u, transport, q.face);
    if (!s) return s;
    const bool walked = s->transmitted();
    if (walked) {
      HashedRandom random = numbers(Use::walk, out, {choice, u.x, u.y}, transport);
      LayerWalk walk;
      if (!stack.walk(out, *s, transport, random, walk) || !walk.weight.finite()) return std::nullopt;
      const bool reflected = stack.side(walk.direction) == side;
      const Lobes one_side = reflected ? reflection_lobes : transmission_lobes;
      const Lobes smooth = q.possible & smooth_lobes & one_side;
      const Lobe lobe = walk.smooth     ? Lobe(smooth)
                        : walk.straight ? pass_through
                                        : (reflected ? specular_reflection : specular_transmission);
      if (!(q.between & lobe)) return std::nullopt;
      s = ScatterSample{walk.direction, walk.weight, walk.probability, lobe, walk.eta, walk.dispersive};
    }
    if (!s->specular()) {
      const bool same_side = stack.side(s->direction) == side;
      if (walked) s->density = same_side ? face.density(out, s->direction, transport, q.face) : 0;
      if (q.between & smooth_lobes & (same_side ? reflection_lobes : transmission_lobes))
        s->density += density_between(stack, q.face, out, s->direction, transport);
    }
    return s;
  }

  Spectrum combined_albedo(const Vector3& out, Lobes which) const override {
    const LayerStack& stack = *seen_from(out)[0];
    const Question q(stack, out, which);
    Spectrum sum = stack.face(stack.side(out)).albedo(out, which & reflection_lobes);
    if (q.between == no_lobes) return sum;
    const LayerStack::Albedo a = stack.albedo(out);
    if (q.between & smooth_lobes & reflection_lobes) sum += a.smooth[0];
    if (q.between & smooth_lobes & transmission_lobes) sum += a.smooth[1];
    if (q.between & specular_reflection) sum += a.specular[0];
    // What passes straight on is part of what goes through specularly, unless it is all of it.
    if (q.between & (specular_transmission | pass_through)) {
      Spectrum straight;
      if (q.possible & pass_through) straight = combined_sample(out, 0, {}, Transport::importance, pass_through)->weight;
      if (q.between & pass_through) sum += straight;
      if (q.between & specular_transmission) sum += max(a.specular[1] - straight, 0);
    }
    return sum;
  }

 private:
  /// What is asked of light that comes from `out`.
  struct Question {
    Lobes possible, between;  ///< lobes of light from between the layers: those there are, and those asked for
    Lobes face;               ///< lobes to choose from in the face that light meets first

    Question(const LayerStack& stack, const Vector3& out, Lobes which) {
      const int side = stack.side(out);
      const Scatter& near = stack.face(side);
      possible = lobes_between(near.lobes(), stack.face(1 - side).lobes(), stack.medium().scatters());
      between = possible & which;
      face = Lobes((which & reflection_lobes) | (between ? transmission_lobes : no_lobes));
    }
  };

  const LayerStack* const* seen_from(const Vector3& out) const { return sides_[dot(normal_, out) > 0 ? 0 : 1]; }

  /// Each use has numbers of its own: weights must not depend on what they weigh.
  enum class Use : std::uint8_t { estimate, walk, density };
  HashedRandom numbers(Use use, const Vector3& out, const Vector3& other, Transport transport) const {
    HashedRandom random(seed_ ^ (2 * std::uint64_t(use) + std::uint64_t(transport)));
    random.add(out, other.x);
    random.add(other.y, other.z);
    return random;
  }
  /// Of what goes in, with about the probability that it does, and comes out in direction `in`.
  float density_between(const LayerStack& stack, Lobes asked, const Vector3& out, const Vector3& in,
                        Transport transport) const {
    HashedRandom random = numbers(Use::density, out, in, transport);
    const Scatter& near = stack.face(stack.side(out));
    float goes_in = 1;
    if (near.has(asked & reflection_lobes)) {
      const float all = near.albedo(out, asked).average();
      goes_in = std::max(all > 0 ? near.albedo(out, transmission_lobes).average() / all : 0, 0.01f);
    }
    return goes_in * stack.density(out, in, transport, random);
  }

  const LayerStack* sides_[2][spectrum_size];
  int stacks_, walks_;
  std::uint64_t seed_;
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
        .member<&LayeredShader::thickness>("thickness", "m", "of the medium between")
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
    // Light between may go through the layers also where what is under them absorbs it.
    SurfacePoint p = point;
    if (p.object && p.dpdu == Vector3{} && p.dpdv == Vector3{}) p.object->tangents(p);
    if (!p.object || p.object->sides != Sides::both) p.object = nothing_.get();
    SurfacePoint behind = p;
    behind.normal = -p.normal;
    behind.shading_normal = -p.shading_normal;

    const LayerStack* stacks[2][spectrum_size];
    const int count = disperses_ && !w.single() ? spectrum_size : 1;
    for (int i = 0; i < count; ++i) {
      const Wavelengths own = i == 0 ? w : alone(w, i);
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

  Lobes possible_lobes() const override {
    const Lobes above = top->possible_lobes(), below = bottom->possible_lobes();
    // What may be diffuse somewhere may be glossy elsewhere.
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
    if (layer->moves_exit()) fail(member, "lets light out of the body elsewhere, which a layer cannot");
  }

  /// The mean cosine of the angle by which a medium scatters.
  static float mean_cosine(const VolumeShader& volume) {
    constexpr int side = 16;
    const Vector3 out{0, 0, 1};
    float sum = 0, density = 0;
    for (int i = 0; i < side * side; ++i) {
      const Point2 u{(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side};
      sum -= volume.sample_phase({}, out, u, density).z;
    }
    return clamp(sum / (side * side), -1, 1);
  }

  /// Whether a layer sends wavelengths different ways: found by trying, as nothing else tells.
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

  /// The i-th wavelength as the only one that counts.
  static Wavelengths alone(const Wavelengths& w, int i) {
    Wavelengths only = w;
    only.place(0, w[i], w.density(i));
    only.place(i, w[0], w.density(0));
    only.drop_secondary();
    return only;
  }

  const LayerStack* stack(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const {
    // What lies over the bottom is the layer, which has the top's index: the media around say so.
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
