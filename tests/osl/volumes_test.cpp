// Volume shaders: coefficients, phase functions and bounds.

#include <gtest/gtest.h>

#include <fstream>

#include "components/phasefunctions/henyey_greenstein.h"
#include "etendue/describe/color.h"
#include "etendue/volume_shader.h"

namespace etendue::osl {
namespace {

Wavelengths visible() {
  std::array<float, spectrum_size> lambda, pdf;
  for (size_t i = 0; i < spectrum_size; ++i) {
    lambda[i] = 400 + 40 * float(i);
    pdf[i] = 1 / 470.0f;
  }
  return Wavelengths(lambda, pdf);
}

/// The class of a volume shader with a name and a body.
Ref<VolumeShader> volume(const std::string& name, const std::string& parameters, const std::string& body) {
  const std::string path = testing::TempDir() + name + ".osl";
  std::ofstream(path) << "volume " << name << "(" << parameters << ") {" << body << "}";
  Registry::instance().load_plugin(path);
  std::string class_name = name;
  class_name[0] = char(std::toupper(class_name[0]));
  return ref_cast<VolumeShader>(Registry::instance().create(class_name));
}

TEST(OslVolumes, HaveTheCoefficientsOfTheirClosures) {
  const Ref<VolumeShader> v = volume("volvdf", "float k = 2", "Ci = anisotropic_vdf(color(0.25), color(k), 0.5);");
  prepare_tree(*v);
  EXPECT_TRUE(v->homogeneous());
  EXPECT_FALSE(v->emits());
  const VolumeCoefficients c = v->coefficients({1, 2, 3}, 0, visible());
  EXPECT_FLOAT_EQ(c.scattering[3], 0.5f);
  EXPECT_FLOAT_EQ(c.absorption[3], 1.5f);
  EXPECT_FLOAT_EQ(v->majorant(visible())[0], 2);
  const Vector3 out{0, 0, -1}, in{0, 0.6f, 0.8f};  // light travels along z and is turned by acos 0.8
  EXPECT_NEAR(v->phase({}, out, in), henyey_greenstein::value(0.5f, 0.2f), 1e-5f);

  // What is left of light after the depth is the colour.
  const Ref<VolumeShader> depth = volume("voldepth", "", "Ci = medium_vdf(color(0), 3, color(0.5), 0, 1, 0);");
  prepare_tree(*depth);
  EXPECT_NEAR(std::exp(-3 * depth->coefficients({}, 0, visible()).absorption[2]), 0.5f, 1e-5f);

  const Ref<VolumeShader> classic = volume("volclassic", "", "Ci = 3 * absorption() + 2 * isotropic() + 0.5 * emission();");
  prepare_tree(*classic);
  const VolumeCoefficients d = classic->coefficients({}, 0, visible());
  EXPECT_FLOAT_EQ(d.absorption[0], 3);
  EXPECT_FLOAT_EQ(d.scattering[0], 2);
  EXPECT_TRUE(classic->emits());
  EXPECT_GT(d.emission[3], 0.3f);
}

TEST(OslVolumes, PhaseFunctionsMixInProportionToScattering) {
  const Ref<VolumeShader> v = volume("volmix", "", "Ci = 3 * henyey_greenstein(0.7) + 1 * henyey_greenstein(-0.4);");
  prepare_tree(*v);
  const Vector3 out{0, 0, -1};
  double mean = 0, share = 0;
  constexpr int side = 64;
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k) {
      float pdf = 0;
      const Vector3 in = v->sample_phase({}, out, {(float(i) + 0.5f) / side, (float(k) + 0.5f) / side}, pdf);
      EXPECT_FLOAT_EQ(pdf, v->phase({}, out, in));
      mean += double(in.z) / (side * side);
      share += double(henyey_greenstein::value(0.7f, 1 - in.z) / pdf) / (side * side);
    }
  EXPECT_NEAR(mean, 0.75 * 0.7 - 0.25 * 0.4, 2e-3);  // mean cosines add
  EXPECT_NEAR(share, 1, 2e-2);                       // the integral of the first function
}

TEST(OslVolumes, AreBounded) {
  const std::string body = "Ci = anisotropic_vdf(color(1), color(10 * P[0]), 0);";
  const Ref<VolumeShader> unknown = volume("volunknown", "", body);
  EXPECT_THROW(prepare_tree(*unknown), Error);
  set(*unknown, "bound", etendue::Value(Number{5.0}));
  prepare_tree(*unknown);
  EXPECT_FALSE(unknown->homogeneous());
  EXPECT_FLOAT_EQ(unknown->coefficients({0.25f, 0, 0}, 0, visible()).scattering[0], 2.5f);
  EXPECT_FLOAT_EQ(unknown->coefficients({1, 0, 0}, 0, visible()).scattering[0], 5);  // thinned to the bound
  EXPECT_EQ(unknown->coefficients({-1, 0, 0}, 0, visible()).scattering[0], 0);

  const Ref<VolumeShader> says = volume("volsays", "float k = 4, output float bound = 0", "bound = k; " + body);
  prepare_tree(*says);
  EXPECT_NEAR(says->majorant(visible())[0], 4, 1e-3f);
}

}  // namespace
}  // namespace etendue::osl
