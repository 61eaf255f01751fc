// MerlShader: a measured isotropic material from a file of the MERL database.

#include "etendue/core/warp.h"
#include "etendue/describe/color.h"
#include "etendue/describe/value.h"
#include "etendue/scatter_model.h"
#include "merl_file.h"
#include "warp2d.h"

namespace etendue {
namespace {

// Directions are sampled by the half-vector m, in coordinates u = (sqrt(2 theta / pi), phi / (2 pi)), with phi measured from
// `out`. In these
//     dw_in = 4 (out . m) dw_m,    dw_m = sin(theta) dtheta dphi = 2 pi^2 u_x sin(theta) du,
// and f cos(in) times both Jacobians is tabulated over u at load, for some angles of `out`. Between these angles the tables are
// blended. A share of the samples has the pdf cos / pi, for variation of f between the points of the tables.
class MerlData {
 public:
  explicit MerlData(const std::string& path) : table_(path) {
    std::vector<float> angles;
    for (int i = 0; i < angle_count; ++i) angles.push_back(steepest * float(i) / (angle_count - 1));
    grid_ = ParameterGrid({0}, angles);
    std::vector<float> values;
    values.reserve(size_t(angle_count * width * height));
    for (const float angle : angles) {
      const Vector3 out{std::sin(angle), 0, std::cos(angle)};
      float sum[3] = {0, 0, 0};
      for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
          const float u = float(column) / (width - 1);
          const Vector3 m = half_vector({u, float(row) / (height - 1)}, out);
          const float cosine_m = dot(out, m);
          const Vector3 in = 2 * cosine_m * m - out;
          Rgb f;
          if (cosine_m > 0 && in.z > 0) f = table_.evaluate(out, in);
          const float factor = std::max(in.z, 0.0f) * 4 * std::max(cosine_m, 0.0f) * half_vector_stretch(u, sine(m));
          values.push_back(factor * (f.r + f.g + f.b) / 3);
          // The trapezoid rule: half the weight at the ends.
          const float weight = factor * (column == width - 1 ? 0.5f : 1) * (row == 0 || row == height - 1 ? 0.5f : 1) /
                               ((width - 1) * (height - 1));
          sum[0] += weight * f.r;
          sum[1] += weight * f.g;
          sum[2] += weight * f.b;
        }
      albedo_.push_back({sum[0], sum[1], sum[2]});
    }
    warp_ = Warp2D(width, height, std::move(values));
  }

  const MerlTable& table() const { return table_; }
  TableBlend blend(const Vector3& out) const { return grid_.locate(0, std::acos(clamp(out.z, -1, 1))); }

  Vector3 sample(const Vector3& out, Point2 u) const {
    const Vector3 m = half_vector(warp_.sample(u, blend(out)).point, out);
    return normalize(2 * dot(out, m) * m - out);
  }
  /// [1/sr]
  float pdf(const Vector3& out, const Vector3& in) const {
    const Vector3 sum = out + in, m = normalize(sum);
    const float s = sine(m), u = std::sqrt(std::atan2(s, m.z) * (2 * inverse_pi));
    const float turn = std::atan2(out.x * m.y - out.y * m.x, out.x * m.x + out.y * m.y) * (inverse_pi / 2);
    return warp_.pdf({u, turn - std::floor(turn)}, blend(out)) /
           (4 * std::max(dot(out, m), 1e-10f) * half_vector_stretch(u, s));
  }
  Rgb albedo(const Vector3& out) const {
    const TableBlend b = blend(out);
    Rgb sum;
    for (size_t k = 0; k < size_t(b.count); ++k) {
      const Rgb& a = albedo_[b.table[k]];
      sum = {sum.r + b.weight[k] * a.r, sum.g + b.weight[k] * a.g, sum.b + b.weight[k] * a.b};
    }
    return sum;
  }
  float largest_albedo() const {
    float largest = 0;
    for (const Rgb& a : albedo_) largest = std::max({largest, a.r, a.g, a.b});
    return largest;
  }

 private:
  static constexpr int angle_count = 24, width = 96, height = 33;
  static constexpr float steepest = 1.565f;  // [rad]

  static float sine(const Vector3& v) { return std::sqrt(v.x * v.x + v.y * v.y); }
  static float half_vector_stretch(float u, float sine) { return std::max(2 * pi * pi * u * sine, 1e-20f); }
  static Vector3 half_vector(Point2 u, const Vector3& out) {
    const float theta = u.x * u.x * (pi / 2), r = sine(out), s = std::sin(theta);
    float sin_phi = 0, cos_phi = 0;
    sin_cos_turn(u.y, sin_phi, cos_phi);
    const float x = r > 0 ? out.x / r : 1, y = r > 0 ? out.y / r : 0;
    return {s * (cos_phi * x - sin_phi * y), s * (sin_phi * x + cos_phi * y), std::cos(theta)};
  }

  MerlTable table_;
  ParameterGrid grid_;
  Warp2D warp_;
  std::vector<Rgb> albedo_;
};

class MerlScatter final : public ScatterModel<MerlScatter> {
 public:
  MerlScatter(const SurfacePoint& p, const MerlData& data, const RgbSpace& space, const Wavelengths& w)
      : ScatterModel(p, glossy_reflection), data_(&data), space_(&space), wavelengths_(w) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? value(upwards(out), upwards(in)) : Spectrum();
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? pdf_of(upwards(out), upwards(in)) : 0;
  }

  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes, LocalSample& s) const {
    const Vector3 from = upwards(out);
    const Vector3 to = choice < cosine_share ? warp::cosine_hemisphere(u) : data_->sample(from, u);
    if (!(to.z > 0)) return false;
    s.value = value(from, to) * to.z;
    s.pdf = pdf_of(from, to);
    s.in = out.z > 0 ? to : Vector3{to.x, to.y, -to.z};
    s.lobe = glossy_reflection;
    return s.pdf > 0;
  }

  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    return (lobes & glossy_reflection) ? spectrum(data_->albedo(upwards(out))) : Spectrum();
  }

 private:
  static constexpr float cosine_share = 0.1f;

  /// Mirrors a direction to the front: the material is the same on both sides.
  static Vector3 upwards(const Vector3& v) { return {v.x, v.y, std::abs(v.z)}; }

  // f may exceed 1, so it is not converted as a reflectance; as a coefficient its spectrum has the same shape.
  Spectrum spectrum(const Rgb& c) const { return rgb_spectrum(*space_, c.r, c.g, c.b, ColorUse::coefficient, wavelengths_); }
  Spectrum value(const Vector3& from, const Vector3& to) const { return spectrum(data_->table().evaluate(from, to)); }
  float pdf_of(const Vector3& from, const Vector3& to) const {
    return (1 - cosine_share) * data_->pdf(from, to) + cosine_share * warp::cosine_hemisphere_pdf(to.z);
  }

  const MerlData* data_;
  const RgbSpace* space_;
  Wavelengths wavelengths_;
};

class MerlShader final : public Shader {
 public:
  static void describe(Description<MerlShader>& d) {
    d.summary("A measured isotropic material from a binary file of the MERL BRDF database, in linear sRGB.",
              "Matusik, Pfister, Brand & McMillan 2003, A data-driven reflectance model")
        .member<&MerlShader::file>("file", "", "the .binary file", required);
  }

  void prepare() override {
    if (file.empty()) fail("file", "a .binary file is needed");
    const std::string path = file.resolved();
    try {
      data_ = std::make_shared<const MerlData>(path);
    } catch (const Error& error) {
      fail("file", "cannot read '" + path + "': " + error.what());
    }
    space_ = &rgb_space("srgb");
    if (data_->largest_albedo() > 1.02f)
      warn("the material in '" + path + "' reflects up to " + std::to_string(data_->largest_albedo()) +
               " times the light that arrives",
           location_of("file"));
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    return arena.make<MerlScatter>(p, *data_, *space_, w);
  }
  /// Error of the albedo table, which is finer than the measurement except at grazing angles.
  float albedo_error() const override { return 0.2f; }
  Lobes possible_lobes() const override { return glossy_reflection; }

  FilePath file;

 private:
  std::shared_ptr<const MerlData> data_;
  const RgbSpace* space_ = nullptr;
};

const Register<MerlShader> registered;

}  // namespace
}  // namespace etendue
