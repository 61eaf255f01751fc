// Lafortune: any number of generalized cosine lobes, as they are fitted to measured materials, over a Lambertian base.

#include "components/shaders/half_vector.h"
#include "components/shaders/joint_scatter.h"
#include "components/shaders/reflectance.h"
#include "components/shaders/tangent_frame.h"
#include "etendue/core/warp.h"

namespace etendue {
namespace {

// Lafortune, Foo, Torrance & Greenberg 1997: a lobe of coefficients cx, cy, cz and exponent n is
//   f = max(cx out.x in.x + cy out.y in.y + cz out.z in.z, 0)^n   [1/sr],
// symmetric in the two directions. cx = cy = -c, cz = c is Phong's lobe of albedo 2 pi c^n / (n + 2) at normal incidence, cx =
// cy = cz a retroreflective lobe, |cx| > |cz| an off-specular one, cx != cy an anisotropic one.
//
// For a given `out` it is a cosine lobe around the vector m a = (cx out.x, cy out.y, cz out.z), with a of unit length: f = m^n
// cos(alpha)^n. Its albedo is m^n H(a.z), where H(c) = integral of cos(alpha)^n max(in.z, 0). With y = cos(alpha)^(n+1)
// uniform, and in.z = c cos(alpha) + sin(a) sin(alpha) cos(psi) integrated over psi in closed form, H is a sum over y,
// tabulated in prepare(). Sampling: the pdf (n + 1) / (2 pi) cos(alpha)^n [1/sr] around a; directions below the surface are
// absorbed.
//
// Energy: the formula does not bound the albedo. prepare() searches the greatest albedo of each lobe over all `out`; where the
// sum of the diffuse colour and of the lobes' colours times these exceeds 1, everything is divided by the sum.
struct CosineLobe {
  static constexpr int size = 65;

  CosineLobe(const Vector3& coefficients, float exponent) : c(coefficients), n(exponent) {
    constexpr int steps = 128;
    for (int i = 0; i < size; ++i) {
      const double z = -1 + 2.0 * i / (size - 1), s = std::sqrt(1 - z * z);
      double sum = 0;
      for (int k = 0; k < steps; ++k) {
        const double cosine = std::pow((k + 0.5) / steps, 1 / (double(n) + 1)), a = z * cosine,
                     b = s * std::sqrt(1 - cosine * cosine);
        // The integral of max(a + b cos(psi), 0) over psi in [0, pi].
        if (a >= b)
          sum += M_PI * a;
        else if (a > -b)
          sum += a * std::acos(-a / b) + std::sqrt(b * b - a * a);
      }
      table[size_t(i)] = float(sum * 2 / (steps * (double(n) + 1)));
    }
    // A quarter turn of azimuths is enough: the albedo does not depend on the signs of out.x and out.y.
    for (int i = 0; i <= 256; ++i)
      for (int k = 0; k <= 16; ++k) {
        const float z = float(i) / 256, s = safe_sqrt(1 - z * z), phi = float(k) / 16 * (pi / 2);
        const float a = albedo({s * std::cos(phi), s * std::sin(phi), z});
        greatest = a < 1e30f ? std::max(greatest, a) : infinity;  // not-a-number counts as infinite
        if (greatest == infinity) return;
      }
  }

  Vector3 turned(const Vector3& out) const { return {c.x * out.x, c.y * out.y, c.z * out.z}; }
  float albedo(const Vector3& out) const {
    const Vector3 m = turned(out);
    const float m2 = length_squared(m);
    if (!(m2 > 0)) return n == 0 ? table[size / 2] : 0;
    const float x = clamp(m.z / std::sqrt(m2), -1, 1) * (size / 2) + size / 2;
    const int i = std::min(int(x), size - 2);
    return std::pow(m2, 0.5f * n) * lerp(x - float(i), table[size_t(i)], table[size_t(i + 1)]);
  }

  Vector3 c;
  float n, greatest = 0;
  std::array<float, size> table;
};

constexpr size_t most_lobes = 8;
using Colors = std::array<Spectrum, most_lobes>;

class LafortuneScatter final : public JointScatter<LafortuneScatter> {
 public:
  LafortuneScatter(const SurfacePoint& p, const Frame& frame, Lobes lobes, const std::vector<CosineLobe>& list,
                   Spectrum diffuse, const Colors& colors)
      : JointScatter(p, frame, lobes), list_(list.data()), count_(list.size()), diffuse_(diffuse), colors_(colors) {}

  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
    if (!(out.z * in.z > 0)) return {};
    return value_and_pdf_of(above(out), above(in), shares(above(out), lobes), lobes);
  }
  bool local_sample(const Vector3& out_, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    const Vector3 out = above(out_);
    const Shares share = shares(out, lobes);
    size_t chosen = 0;
    while (chosen < count_ && choice >= share[chosen]) choice -= share[chosen++];
    if (chosen < count_) {
      const CosineLobe& lobe = list_[chosen];
      const Vector3 m = lobe.turned(out);
      const float m2 = length_squared(m);
      if (!(m2 > 0)) return false;
      // 1 - cos(alpha), which stays precise for sharp lobes.
      const float t = -std::expm1(std::log1p(-std::min(u.x, one_minus_epsilon)) / (lobe.n + 1)), r = safe_sqrt(t * (2 - t));
      float sine = 0, cosine = 0;
      sin_cos_turn(u.y, sine, cosine);
      s.in = Frame(Normal3(m / std::sqrt(m2))).to_world({r * cosine, r * sine, 1 - t});
      s.lobe = glossy_reflection;
    } else {
      if (!(lobes & diffuse_reflection)) return false;  // all shares are 0
      s.in = warp::cosine_hemisphere(u);
      s.lobe = diffuse_reflection;
    }
    if (!(s.in.z > 0)) return false;
    const ScatterValue both = value_and_pdf_of(out, s.in, share, lobes);
    s.value = both.value * s.in.z;
    s.pdf = both.pdf;
    if (out_.z < 0) s.in.z = -s.in.z;
    return s.pdf > 0;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    Spectrum sum;
    if (lobes & diffuse_reflection) sum += diffuse_;
    if (lobes & glossy_reflection)
      for (size_t i = 0; i < count_; ++i) sum += colors_[i] * list_[i].albedo(above(out));
    return sum;
  }

 private:
  /// Probabilities of choosing each lobe, then the diffuse part.
  using Shares = std::array<float, most_lobes + 1>;
  Shares shares(const Vector3& out, Lobes lobes) const {
    Shares share{};
    float sum = share[count_] = lobes & diffuse_reflection ? diffuse_.average() : 0;
    if (lobes & glossy_reflection)
      for (size_t i = 0; i < count_; ++i) sum += share[i] = colors_[i].average() * list_[i].albedo(out);
    if (sum > 0)
      for (size_t i = 0; i <= count_; ++i) share[i] /= sum;
    return share;
  }
  ScatterValue value_and_pdf_of(const Vector3& out, const Vector3& in, const Shares& share, Lobes lobes) const {
    ScatterValue r;
    if (lobes & diffuse_reflection) {
      r.value = diffuse_ * inverse_pi;
      r.pdf = share[count_] * in.z * inverse_pi;
    }
    if (lobes & glossy_reflection)
      for (size_t i = 0; i < count_; ++i) {
        const CosineLobe& lobe = list_[i];
        const Vector3 m = lobe.turned(out);
        const float length_m = length(m);
        if (!(length_m > 0)) continue;
        // cos(alpha) = 1 - d2 / 2 from the squared distance of the unit vectors.
        const float d2 = length_squared(in - m / length_m);
        if (d2 >= 2) continue;
        const float power = std::exp(lobe.n * std::log1p(-0.5f * d2));
        r.value += colors_[i] * (std::pow(length_m, lobe.n) * power);
        r.pdf += share[i] * (lobe.n + 1) / (2 * pi) * power;
      }
    return r;
  }

  const CosineLobe* list_;
  size_t count_;
  Spectrum diffuse_;
  Colors colors_;
};

class LafortuneShader final : public Shader {
 public:
  static void describe(Description<LafortuneShader>& d) {
    d.summary(
         "Generalized cosine lobes over a Lambertian base, as fitted to measured materials: mirror-like, off-specular, "
         "anisotropic and retroreflective ones. Where all together could reflect more than arrives, all are scaled down.",
         "Lafortune, Foo, Torrance & Greenberg 1997, Non-linear approximation of reflectance functions")
        .member<&LafortuneShader::color>("color", "1", "fraction of light reflected diffusely, per wavelength",
                                         Meaning::reflectance)
        .member<&LafortuneShader::coefficients>("coefficients", "1", "cx, cy, cz of each lobe; at most 8 lobes")
        .member<&LafortuneShader::exponents>("exponents", "1", "n of each lobe", range(0, 1e5))
        .member<&LafortuneShader::lobe_colors>(
            "lobe_colors", "1", "what each lobe is multiplied by, per wavelength; 1 where none is given", Meaning::reflectance)
        .member<&LafortuneShader::rotation>("rotation", "turn", "by how many turns the lobes are rotated against u",
                                            Meaning::number, soft(0, 1));
  }

  void prepare() override {
    require_reflectance(*this, "color", color);
    for (const Ref<ObjectMap>& c : lobe_colors) require_reflectance(*this, "lobe_colors", c);
    if (coefficients.size() > most_lobes) fail("coefficients", "at most 8 lobes");
    if (exponents.size() != coefficients.size())
      fail("exponents", "one for each of the " + std::to_string(coefficients.size()) + " lobes is needed");
    if (lobe_colors.size() > coefficients.size()) fail("lobe_colors", "more colours than lobes");
    if (!rotation) fail("rotation", "a map or a number is needed");
    lobes_.clear();
    isotropic_ = true;
    for (size_t i = 0; i < coefficients.size(); ++i) {
      if (!is_finite(coefficients[i])) fail("coefficients", "must be finite");
      const CosineLobe& made = lobes_.emplace_back(coefficients[i], exponents[i]);
      isotropic_ &= made.c.x == made.c.y;
      if (!(made.greatest < 1e6f))
        fail("coefficients", "lobe " + std::to_string(i + 1) + " reflects " + std::to_string(made.greatest) +
                                 " times what arrives: no material's");
    }
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const Spectrum diffuse = reflectance_at(*color, p, w);
    Spectrum glossy;
    Colors colors{};
    for (size_t i = 0; i < lobes_.size(); ++i) {
      colors[i] = i < lobe_colors.size() ? reflectance_at(*lobe_colors[i], p, w) : Spectrum(1.0f);
      glossy += colors[i] * lobes_[i].greatest;
    }
    const Lobes lobes = Lobes((diffuse.black() ? 0 : diffuse_reflection) | (glossy.black() ? 0 : glossy_reflection));
    if (lobes == no_lobes) return nullptr;

    const Spectrum scale = Spectrum(1.0f) / max(diffuse + glossy, 1.0f);
    for (size_t i = 0; i < lobes_.size(); ++i) colors[i] *= scale;
    const Frame frame = isotropic_ ? Frame(p.shading_normal) : tangent_frame(p, rotation->scalar(p));
    return arena.make<LafortuneScatter>(p, frame, lobes, lobes_, diffuse * scale, colors);
  }
  /// Interpolation error of the albedo tables.
  float albedo_error() const override { return 0.02f; }
  Lobes possible_lobes() const override { return diffuse_reflection | glossy_reflection; }

  Ref<ObjectMap> color = constant(0.3f), rotation = constant(0.0f);
  std::vector<Vector3> coefficients{{-0.95f, -0.95f, 0.95f}};
  std::vector<float> exponents{10};
  std::vector<Ref<ObjectMap>> lobe_colors;

 private:
  std::vector<CosineLobe> lobes_;
  bool isotropic_ = true;
};

const Register<LafortuneShader> registered;

}  // namespace
}  // namespace etendue
