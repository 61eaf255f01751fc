// RglShader: a material measured by the EPFL laboratory RGL, from its .bsdf file.

#include "components/shaders/tangent_frame.h"
#include "etendue/core/warp.h"
#include "etendue/describe/bands.h"
#include "etendue/describe/value.h"
#include "etendue/scatter_model.h"
#include "rgl_data.h"

namespace etendue {
namespace {

// The file's f(w_i, w_o) is measured and interpolated differently for the two directions, so it is reciprocal only up to the
// noise of both. But camera subpaths, light subpaths and connections of both must agree on f. So unless `symmetric` is false
// and f is taken from the file unchanged, with `out` as w_i, the values of both orders are averaged, each weighted by the
// cosine with which it was measured (the file holds f cos, so f is imprecise where cos is small):
//     f(out, in) = (f_file(out, in) cos(in) + f_file(in, out) cos(out)) / (cos(in) + cos(out)).
//
// Directions are sampled by the file's warps (see rgl_data.h). Their pdf may vanish where f_file(in, out) does not, which
// contributes to the mean and to importance: one direction in ten is sampled with the pdf cos / pi.
class RglScatter final : public ScatterModel<RglScatter> {
 public:
  RglScatter(const SurfacePoint& p, const Frame& frame, const RglData& data, const Wavelengths& w, bool symmetric)
      : ScatterModel(p, frame, glossy_reflection),
        data_(&data),
        wavelengths_(w),
        channels_(data.channels(w)),
        symmetric_(symmetric) {}

  bool reciprocal() const { return symmetric_; }

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? value(upwards(out), upwards(in)) / std::abs(in.z) : Spectrum();
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? pdf_of(upwards(out), upwards(in)) : 0;
  }

  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes, LocalSample& s) const {
    const Vector3 from = upwards(out);
    const Vector3 to = choice < cosine_share ? warp::cosine_hemisphere(u) : data_->sample(from, u);
    if (!(to.z > 0)) return false;
    // Value and pdf are both computed from the rounded direction: where f is steep they must be consistent.
    s.value = value(from, to);
    s.pdf = pdf_of(from, to);
    s.in = out.z > 0 ? to : Vector3{to.x, to.y, -to.z};
    s.lobe = glossy_reflection;
    return s.pdf > 0;
  }

  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    return (lobes & glossy_reflection) ? data_->albedo(upwards(out), channels_, wavelengths_) : Spectrum();
  }

 private:
  /// Mirrors a direction to the front: the material is the same on both sides.
  static Vector3 upwards(const Vector3& v) { return {v.x, v.y, std::abs(v.z)}; }

  /// f cos(to)
  Spectrum value(const Vector3& from, const Vector3& to) const {
    const Spectrum there = data_->evaluate(from, to, channels_, wavelengths_);
    if (!symmetric_) return there;
    return (there + data_->evaluate(to, from, channels_, wavelengths_)) * (to.z / (from.z + to.z));
  }
  float pdf_of(const Vector3& from, const Vector3& to) const {
    return (1 - cosine_share) * data_->pdf(from, to) + cosine_share * warp::cosine_hemisphere_pdf(to.z);
  }

  static constexpr float cosine_share = 0.1f;

  const RglData* data_;
  Wavelengths wavelengths_;
  RglChannels channels_;
  bool symmetric_;
};

class RglShader final : public Shader, public NeedsWavelengths {
 public:
  static void describe(Description<RglShader>& d) {
    d.summary(
         "A measured material from a .bsdf file of the RGL material database: isotropic or anisotropic, with whole spectra or "
         "in "
         "linear sRGB. Anisotropic ones follow the surface coordinates.",
         "Dupuy & Jakob 2018, An adaptive parameterization for efficient material acquisition and rendering")
        .member<&RglShader::file>("file", "", "the .bsdf file", required)
        .member<&RglShader::symmetric>(
            "symmetric", "",
            "averages the measurement over both orders of the two directions, so that all renderers agree; false: as it is "
            "in the file");
  }

  void prepare() override {
    if (file.empty()) fail("file", "a .bsdf file is needed");
    const std::string path = file.resolved();
    try {
      data_ = std::make_shared<const RglData>(path, symmetric);
    } catch (const Error& error) {
      fail("file", "cannot read '" + path + "': " + error.what());
    }
    if (data_->largest_albedo() > 1.02f)
      warn("the material in '" + path + "' reflects up to " + std::to_string(data_->largest_albedo()) +
               " times the light that arrives",
           location_of("file"));
  }

  void refuse_bands() const override {
    if (data_->spectral())
      fail("file", "was measured wavelength by wavelength; the database has a file in RGB of each material");
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    return arena.make<RglScatter>(p, data_->isotropic() ? Frame(p.shading_normal) : tangent_frame(p), *data_, w, symmetric);
  }
  /// Error of the albedo table, from 64 samples for each direction that was measured.
  float albedo_error() const override { return 0.3f; }
  Lobes possible_lobes() const override { return glossy_reflection; }
  /// As measured, f is reciprocal up to noise only.
  bool reciprocal() const override { return symmetric; }

  FilePath file;
  bool symmetric = true;

 private:
  std::shared_ptr<const RglData> data_;
};

const Register<RglShader> registered;

}  // namespace
}  // namespace etendue
