// Red, green and blue of Mitsuba's media become the spectra of Mitsuba's spectral variants: the numbers are those that PyPI's
// mitsuba 3.9.1, llvm_ad_spectral, returns from get_scattering_coefficients().

#include "etendue/describe/color.h"
#include "etendue/volume_shader.h"
#include "mitsuba_support.h"

namespace etendue::mitsuba_test {
namespace {

constexpr float places[] = {450, 550, 650};  // [nm]

std::string medium_scene(const std::string& type, const std::string& inside) {
  return scene(sensor() + integrator(2, "volpath") +
               "<shape type=\"cube\"><bsdf type=\"null\"/><medium name=\"interior\" type=\"" + type + "\">" + inside +
               "</medium></shape>");
}
Color member(const Imported& imported, const char* name) {
  EXPECT_EQ(imported.told(), "");
  if (!imported.job) return nullptr;
  const Value value = get(part(imported.object(0), "interior"), name);
  const Color* color = value.as<Color>();
  return color ? *color : nullptr;
}
void expect_spectrum(const Color& color, ColorUse use, const std::array<double, 3>& there, double within) {
  ASSERT_TRUE(color);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(double(color->at(places[i], use)), there[i], within) << places[i] << " nm";
}

TEST(MitsubaMediaColors, CoefficientsWithinOneAreSpectraOfSurfaces) {
  const std::string sigma_t = "<rgb name=\"sigma_t\" value=\"0.9 0.3 0.1\"/>";
  const std::array<double, 3> there{0.12818, 0.32768, 0.90181};
  Imported i = import_text(medium_scene("homogeneous", sigma_t));
  EXPECT_EQ(i.told(), "");
  expect_spectrum(member(i, "extinction"), ColorUse::coefficient, there, 3e-4);
  i = import_text(medium_scene("homogeneous", sigma_t + "<float name=\"scale\" value=\"4\"/>"));
  expect_spectrum(member(i, "extinction"), ColorUse::coefficient, {4 * there[0], 4 * there[1], 4 * there[2]}, 1.2e-3);
  // Also if a volume states the colour, and in a heterogeneous medium.
  const std::string volume =
      "<volume type=\"constvolume\" name=\"sigma_t\"><rgb name=\"value\" value=\"0.9 0.3 0.1\"/></volume>";
  i = import_text(medium_scene("homogeneous", volume));
  expect_spectrum(member(i, "extinction"), ColorUse::coefficient, there, 3e-4);
  i = import_text(medium_scene("heterogeneous", volume));
  expect_spectrum(member(i, "extinction"), ColorUse::coefficient, there, 3e-4);
}

// Mitsuba's spectral variants refuse coefficients above 1: here the spectrum has the shape of the colour scaled to at most 1,
// and its own scale.
TEST(MitsubaMediaColors, CoefficientsAboveOneAreThoseOfEverywhere) {
  const Imported i = import_text(medium_scene("homogeneous", "<rgb name=\"sigma_t\" value=\"1 2 4\"/>"));
  EXPECT_EQ(i.told(), "");
  const Color color = member(i, "extinction"), ours = rgb_color("srgb", 1, 2, 4);
  ASSERT_TRUE(color);
  EXPECT_EQ(color->at(450, ColorUse::coefficient), ours->at(450, ColorUse::coefficient));
}

// Mitsuba's table of spectra is coarse near white, which matters for light that is scattered many times.
TEST(MitsubaMediaColors, AlbedosNearWhiteAreThoseOfItsTable) {
  Imported i = import_text(medium_scene("homogeneous", "<rgb name=\"albedo\" value=\"0.99 0.999 0.99\"/>"));
  EXPECT_EQ(i.told(), "");
  expect_spectrum(member(i, "albedo"), ColorUse::reflectance, {0.9972, 0.9980, 0.9978}, 5e-4);
  EXPECT_NEAR(double(member(i, "albedo")->at(700, ColorUse::reflectance)), 0.9971, 1e-3);
  i = import_text(medium_scene("homogeneous", "<rgb name=\"albedo\" value=\"0.99 0.5 0.5\"/>"));
  expect_spectrum(member(i, "albedo"), ColorUse::reflectance, {0.5077, 0.5376, 0.9453}, 3e-4);
}

// Albedos of a grid become spectra like radiances and coefficients, within twice the largest component, and are clamped to 1.
TEST(MitsubaMediaColors, GridsOfAlbedos) {
  const TemporaryFolder folder;
  std::string grid = "VOL\3";
  for (const std::int32_t number : {1, 1, 1, 1, 3}) grid.append(reinterpret_cast<const char*>(&number), 4);
  for (const float number : {0.f, 0.f, 0.f, 1.f, 1.f, 1.f, 0.9f, 0.3f, 0.1f})
    grid.append(reinterpret_cast<const char*>(&number), 4);
  folder.write("albedo.vol", grid);
  folder.write("density.vol", [] {
    std::string one = "VOL\3";
    for (const std::int32_t number : {1, 1, 1, 1, 1}) one.append(reinterpret_cast<const char*>(&number), 4);
    for (const float number : {0.f, 0.f, 0.f, 1.f, 1.f, 1.f, 2.f}) one.append(reinterpret_cast<const char*>(&number), 4);
    return one;
  }());
  const std::string albedo =
      "<volume type=\"gridvolume\" name=\"albedo\"><string name=\"filename\" value=\"albedo.vol\"/></volume>";
  Wavelengths w;
  for (int k = 0; k < spectrum_size; ++k) w.place(k, places[k % 3], 1);
  // In a medium of constant density, and in one with a density grid of a single value.
  for (const char* sigma_t :
       {"<float name=\"sigma_t\" value=\"2\"/>",
        "<volume type=\"gridvolume\" name=\"sigma_t\"><string name=\"filename\" value=\"density.vol\"/></volume>"}) {
    const Imported i = import_text(folder, medium_scene("heterogeneous", albedo + sigma_t));
    ASSERT_EQ(i.told(), "");
    const Ref<Component> interior = *get(i.object(0), "interior").as<Ref<Component>>();
    prepare_tree(*interior);
    const VolumeCoefficients c = dynamic_cast<const VolumeShader&>(*interior).coefficients({0.25f, 0.25f, 0.25f}, 0, w);
    const double there[] = {0.126472, 0.331720, 1};  // the last is 1.075 in Mitsuba
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(double(c.scattering[k]) / double(c.extinction()[k]), there[k], 5e-4) << sigma_t;
  }
}

// Mitsuba's glass depends on the shading normal only (`folded`); diffuse reflection transmits no light where the shading normal
// would send it through the surface (`clipped`).
TEST(MitsubaMediaColors, GlassOnSmoothMeshesLosesNoLight) {
  const TemporaryFolder folder;
  folder.write("ball.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const auto normals_of = [&](const std::string& bsdf) {
    const Imported i =
        import_text(folder, scene(sensor() + integrator() +
                                  "<shape type=\"obj\"><string name=\"filename\" value=\"ball.obj\"/>" + bsdf + "</shape>"));
    EXPECT_TRUE(i.errors.empty()) << i.told();
    return dynamic_cast<const SceneObject&>(i.object(0)).shading_normals;
  };
  EXPECT_EQ(normals_of("<bsdf type=\"dielectric\"/>"), ShadingNormals::folded);
  EXPECT_EQ(normals_of("<bsdf type=\"principled\"><float name=\"spec_trans\" value=\"1\"/></bsdf>"), ShadingNormals::folded);
  EXPECT_EQ(normals_of("<bsdf type=\"principled\"><float name=\"roughness\" value=\"0.5\"/></bsdf>"), ShadingNormals::clipped);
  EXPECT_EQ(normals_of("<bsdf type=\"diffuse\"/>"), ShadingNormals::clipped);
}

}  // namespace
}  // namespace etendue::mitsuba_test
