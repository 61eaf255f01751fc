// DonaldsonShader: a matt surface with a measured reradiation matrix.

#include "components/shaders/lambertian_scatter.h"
#include "donaldson_matrix.h"
#include "etendue/describe/bands.h"
#include "etendue/describe/value.h"

namespace etendue {
namespace {

class MatrixReradiation final : public Reradiation {
 public:
  MatrixReradiation(const Scatter& directions, const DonaldsonMatrix& matrix) : Reradiation(directions), matrix_(matrix) {}

  float value(float absorbed, float emitted) const override { return matrix_.value(absorbed, emitted); }
  float received(float emitted) const override { return matrix_.emitted()(emitted); }
  float given(float absorbed) const override { return matrix_.absorbed()(absorbed); }
  float sample_absorbed(float, float u, float& pdf) const override { return matrix_.absorbed().sample(u, pdf); }

 private:
  const DonaldsonMatrix& matrix_;
};

class DonaldsonShader final : public Shader, public FluorescentSurface, public NeedsWavelengths {
 public:
  static void describe(Description<DonaldsonShader>& d) {
    d.summary(
         "A matt surface whose fluorescence was measured: a Donaldson matrix, with the fraction of the light of each "
         "wavelength that leaves at each wavelength. On its diagonal is what is reflected without a change.",
         "Donaldson 1954, Spectrophotometry of fluorescent pigments")
        .member<&DonaldsonShader::file>(
            "file", "",
            "the matrix as a CSV: the first line holds, after a label, the wavelengths of light that leaves, each further "
            "line one of light that arrives [nm] and the fractions of its power, one for each band. None: the numbers below")
        .member<&DonaldsonShader::wavelengths>("wavelengths", "nm", "those of rows and columns, in equal steps", unless("file"))
        .member<&DonaldsonShader::values>("values", "1", "the matrix, row by row: a row for each wavelength that arrives",
                                          unless("file"));
  }

  void prepare() override {
    try {
      matrix_ = file.empty() ? DonaldsonMatrix(wavelengths, values) : read_donaldson_matrix(file.resolved());
    } catch (const Error& e) {
      fail(file.empty() ? "values" : "file", e.what());
    }
    if (const float first = matrix_.first(); first < wavelength_low)
      warn(fmt::format("DonaldsonShader: the matrix begins at {:g} nm, and light below {:g} nm is not computed: what it would "
                       "excite is missing",
                       first, wavelength_low),
           location_of(file.empty() ? "values" : "file"));
  }

  void refuse_bands() const override { fail({}, "fluorescence moves light from one wavelength to others"); }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    Spectrum reflectance;
    for (int i = 0; i < spectrum_size; ++i) reflectance.set(i, matrix_.elastic(w[i]));
    if (reflectance.black()) return nullptr;
    return arena.make<LambertianScatter>(p, reflectance);
  }
  Lobes possible_lobes() const override { return diffuse_reflection; }

  const Reradiation* bind_reradiation(const SurfacePoint& p, Arena& arena) const override {
    if (!(matrix_.absorbed().integral() > 0)) return nullptr;
    return arena.make<MatrixReradiation>(*arena.make<LambertianScatter>(p, Spectrum(1.0f)), matrix_);
  }

  FilePath file;
  std::vector<float> wavelengths{400, 500, 600}, values{0.1f, 0.4f, 0.3f, 0, 0.3f, 0.4f, 0, 0, 0.6f};

 private:
  DonaldsonMatrix matrix_;
};

const Register<DonaldsonShader> registered;

}  // namespace
}  // namespace etendue
