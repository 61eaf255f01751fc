// Measured materials: MERL and RGL files, valid and hostile.

#include <cstring>
#include <functional>

#include "support/component_test_support.h"
#include "support/process.h"

namespace etendue {
namespace {

using test::create;

template <class T>
void put(std::string& to, T value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// f of a rough conductor: GGX normals, correlated Smith shadowing, Schlick's Fresnel reflectance.
double ggx(const Vector3& a, const Vector3& b, double f0, double rough = 0.4) {
  const Vector3 m = normalize(a + b);
  const double q = (double(m.x) * m.x + double(m.y) * m.y) / (rough * rough) + double(m.z) * m.z;
  const auto area = [&](const Vector3& w) {
    return (w.z + std::sqrt(w.z * w.z + rough * rough * (w.x * w.x + w.y * w.y))) / 2;
  };
  const double shape = 1 / (M_PI * rough * rough * q * q) / (4 * (area(a) * b.z + area(b) * a.z - a.z * b.z));
  return shape * (f0 + (1 - f0) * std::pow(1 - double(dot(a, m)), 5));
}

// ---- files ----------------------------------------------------------------------------------------------------------

/// A MERL file with the given numbers of cells; directions below the horizon are marked as not measured.
std::string merl_file(int halves, int differences, int azimuths) {
  const double scales[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500}, f0[3] = {0.9, 0.6, 0.3};
  std::string file;
  for (const int n : {halves, differences, azimuths}) put(file, n);
  for (int c = 0; c < 3; ++c)
    for (int h = 0; h < halves; ++h)
      for (int d = 0; d < differences; ++d)
        for (int p = 0; p < azimuths; ++p) {
          const double th = M_PI / 2 * std::pow((h + 0.5) / halves, 2), td = M_PI / 2 * (d + 0.5) / differences;
          const double pd = M_PI * (p + 0.5) / azimuths;
          const auto around = [&](double sign) {
            const double x = sign * std::sin(td) * std::cos(pd), y = sign * std::sin(td) * std::sin(pd), z = std::cos(td);
            return Vector3{float(std::cos(th) * x + std::sin(th) * z), float(y), float(std::cos(th) * z - std::sin(th) * x)};
          };
          const Vector3 a = around(1), b = around(-1);
          put(file, a.z > 0 && b.z > 0 ? ggx(a, b, f0[c]) / scales[c] : -1.0);
        }
  return file;
}

struct Field {
  std::string name;
  std::uint8_t type;  // 1: uint8, 10: float32
  std::vector<std::uint64_t> shape;
  std::string bytes;
};
Field floats(const std::string& name, std::vector<std::uint64_t> shape, const std::vector<float>& values) {
  return {name, 10, std::move(shape), {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)}};
}
std::string tensor_file(const std::vector<Field>& fields) {
  std::string file("tensor_file\0\1\0", 14), body;
  put(file, std::uint32_t(fields.size()));
  size_t header = file.size();
  for (const Field& f : fields) header += 13 + f.name.size() + 8 * f.shape.size();
  for (const Field& f : fields) {
    put(file, std::uint16_t(f.name.size()));
    file += f.name;
    put(file, std::uint16_t(f.shape.size()));
    put(file, f.type);
    put(file, std::uint64_t(header + body.size()));
    for (const std::uint64_t n : f.shape) put(file, n);
    body += f.bytes;
  }
  return file + body;
}

/// Irregular numbers between 1 and 2 that depend only on their index.
std::vector<float> pattern(int seed, size_t count) {
  std::vector<float> v;
  for (size_t i = 0; i < count; ++i) v.push_back(1 + float((i * 37 + size_t(seed)) % 11) / 10);
  return v;
}

using Tables = std::vector<Field>;
Tables pattern_tables(bool anisotropic) {
  const std::vector<float> phi = anisotropic ? std::vector<float>{-pi, -0.75f * pi, -0.5f * pi} : std::vector<float>{0};
  const std::uint64_t n = phi.size();
  std::vector<float> sigma = pattern(2, 9), spectra = pattern(5, n * 144);
  if (!anisotropic)  // the same at all azimuths
    for (size_t i = 3; i < 9; ++i) sigma[i] = sigma[i - 3];
  for (float& s : spectra) s *= 0.25f;
  return {{"description", 1, {7}, "pattern"},
          {"jacobian", 1, {1}, "\1"},
          floats("phi_i", {n}, phi),
          floats("theta_i", {3}, {0, 0.6f, 1.3f}),
          floats("ndf", {3, 4}, pattern(1, 12)),
          floats("sigma", {3, 3}, sigma),
          floats("vndf", {n, 3, 5, 4}, pattern(3, n * 60)),
          floats("luminance", {n, 3, 4, 4}, pattern(4, n * 48)),
          floats("wavelengths", {3}, {400, 600, 800}),
          floats("spectra", {n, 3, 3, 4, 4}, spectra)};
}

/// The same with the half vectors of a wide distribution: without the peak at the pole that any other table makes.
Tables wide_tables(bool anisotropic) {
  Tables tables = pattern_tables(anisotropic);
  const std::uint64_t n = anisotropic ? 3 : 1;
  std::vector<float> values;
  for (std::uint64_t slice = 0; slice < 3 * n; ++slice)
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 17; ++x) {
        const float u = float(x) / 16, theta = u * u * pi / 2, phi = 2 * pi * float(y) / 8;
        const float lean = anisotropic ? 1 + 0.8f * std::cos(2 * phi) : 1;
        values.push_back(u * std::sin(theta) * std::pow(std::cos(theta) + 1e-3f, 2.0f) * lean);
      }
  tables[6] = floats("vndf", {n, 3, 9, 17}, values);
  return tables;
}

class Measured : public testing::Test {
 protected:
  Ref<Shader> rgl(const Tables& tables, bool symmetric) {
    Ref<Shader> s = ref_cast<Shader>(Registry::instance().create("RglShader"));
    set(*s, "file", Value(folder.write("material.bsdf", tensor_file(tables))));
    set(*s, "symmetric", Value(symmetric));
    prepare_tree(*s);
    return s;
  }
  Ref<Shader> merl() {
    return create<Shader>("MerlShader", {{"file", folder.write("material.binary", merl_file(45, 45, 60))}});
  }

  /// The error with which a file is refused; "" if it is accepted.
  std::string refused(const std::string& shader, const std::string& bytes) {
    const std::string path = folder.write("hostile", bytes);
    try {
      create<Shader>(shader, {{"file", path}});
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_TRUE(what.find(shader + ".file") != what.npos && what.find(path) != what.npos) << what;
      return what;
    }
    return {};
  }

  TemporaryFolder folder;
  Arena arena;
};

// ---- values ---------------------------------------------------------------------------------------------------------

// f cos(in) at four wavelengths and the pdf, from the `measured` plugin of Mitsuba 3.9.1 with the same bytes. Here one
// direction in ten is sampled with the pdf cos / pi.
TEST_F(Measured, RglAgreesWithMitsuba) {
  const Vector3 pairs[4][2] = {{{0.3f, -0.2f, 0.8f}, {-0.5f, 0.4f, 0.7f}},
                               {{-0.6f, 0.5f, 0.5f}, {0.1f, 0.7f, 0.6f}},
                               {{0.1f, 0.9f, 0.3f}, {0.4f, -0.3f, 0.9f}},
                               {{-0.2f, -0.1f, 0.95f}, {-0.3f, -0.2f, 0.9f}}};
  const float expected[2][4][5] = {{{0.0819115f, 0.0754275f, 0.0777131f, 0.0832319f, 0.367468f},
                                    {0.0730717f, 0.0789928f, 0.0764547f, 0.0708049f, 0.0221269f},
                                    {0.069296f, 0.0699467f, 0.0691781f, 0.0678947f, 0.041906f},
                                    {0.108356f, 0.106965f, 0.112124f, 0.119623f, 0.10261f}},
                                   {{0.10176f, 0.105062f, 0.105545f, 0.104964f, 0.319757f},
                                    {0.0911127f, 0.0913313f, 0.0878738f, 0.0831141f, 0.026111f},
                                    {0.109367f, 0.10191f, 0.104569f, 0.110956f, 0.0494821f},
                                    {0.0978114f, 0.0961584f, 0.101324f, 0.10893f, 0.0944517f}}};
  for (const bool anisotropic : {false, true}) {
    const Ref<Shader> shader = rgl(pattern_tables(anisotropic), false);
    EXPECT_FALSE(shader->reciprocal());
    SurfacePoint p = test::surface_point({0, 0, 1});
    p.dpdu = {1, 0, 0};
    p.dpdv = {0, 1, 0};
    Wavelengths four;
    for (int k = 0; k < spectrum_size; ++k) four.place(k, 450 + 117.5f * float(k % 4), 0.002f);
    const Scatter* scatter = shader->bind(p, four, arena);
    for (int i = 0; i < 4; ++i) {
      const Vector3 out = normalize(pairs[i][0]), in = normalize(pairs[i][1]);
      const ScatterValue v = scatter->value_and_pdf(out, in);
      for (int k = 0; k < spectrum_size; ++k)
        EXPECT_NEAR(v.value[k], expected[anisotropic][i][k % 4], 3e-4f * expected[anisotropic][i][k % 4]) << i << " " << k;
      const float pdf = 0.9f * expected[anisotropic][i][4] + 0.1f * in.z / pi;
      EXPECT_NEAR(v.pdf, pdf, 3e-4f * pdf) << i;
    }
  }
}

// The same for the tables of a wide distribution, at angles all around: f cos(in) at 450, 520, 600 and 700 nm and the pdf (0:
// not compared, because in Mitsuba it is lost at a singularity).
TEST_F(Measured, RglOfAWideDistributionAgreesWithMitsuba) {
  // Angles [deg] from the normal and around it, out and in.
  const double pairs[6][4] = {{20, 10, 30, 120}, {50, 200, 15, -40}, {70, -80, 60, 95},
                              {5, 12, 75, 45},   {40, -170, 40, 10}, {60, 135, 65, -60}};
  const float expected[2][6][5] = {{{0.10491686f, 0.10020037f, 0.09481011f, 0.09604055f, 0.10723011f},
                                    {0.08376364f, 0.07977031f, 0.07520651f, 0.08329139f, 0.11098789f},
                                    {0.08185634f, 0.07773853f, 0.07303248f, 0.09078945f, 0.34605125f},
                                    {0.09236918f, 0.09830537f, 0.10508960f, 0.10290927f, 0.07865460f},
                                    {0.05057038f, 0.04796221f, 0.04498144f, 0.05764649f, 0},
                                    {0.08345772f, 0.08054710f, 0.07722069f, 0.08648448f, 0.25172901f}},
                                   {{0.10626600f, 0.10234285f, 0.09785924f, 0.09829089f, 0.04487493f},
                                    {0.09108047f, 0.09019464f, 0.08918227f, 0.09182516f, 0.12060975f},
                                    {0.08887676f, 0.09414776f, 0.10017177f, 0.09719176f, 0.37422907f},
                                    {0.11357462f, 0.11186451f, 0.10991012f, 0.11824761f, 0.08584023f},
                                    {0.09075591f, 0.08668264f, 0.08202747f, 0.08150933f, 0},
                                    {0.08276092f, 0.08655889f, 0.09089943f, 0.08964359f, 0.23232453f}}};
  const float nanometres[4] = {450, 520, 600, 700};
  const auto towards = [](double theta, double phi) {
    const double t = theta * M_PI / 180, p = phi * M_PI / 180;
    return Vector3{float(std::sin(t) * std::cos(p)), float(std::sin(t) * std::sin(p)), float(std::cos(t))};
  };
  for (const bool anisotropic : {false, true}) {
    SurfacePoint p = test::surface_point({0, 0, 1});
    p.dpdu = {1, 0, 0};
    p.dpdv = {0, 1, 0};
    Wavelengths four;
    for (int k = 0; k < spectrum_size; ++k) four.place(k, nanometres[k % 4], 0.002f);
    const Ref<Shader> shader = rgl(wide_tables(anisotropic), false);
    const Scatter* scatter = shader->bind(p, four, arena);
    for (int i = 0; i < 6; ++i) {
      const auto& a = pairs[i];
      const float* wanted = expected[anisotropic][i];
      const Vector3 in = towards(a[2], a[3]);
      const ScatterValue v = scatter->value_and_pdf(towards(a[0], a[1]), in);
      for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(v.value[k], wanted[k % 4], 1e-3f * wanted[k % 4]) << i << " " << k;
      const float pdf = 0.9f * wanted[4] + 0.1f * in.z / pi;
      if (wanted[4] > 0) EXPECT_NEAR(v.pdf, pdf, 1e-3f * pdf) << i;
    }
  }
}

TEST_F(Measured, RglInRgbHasTheColour) {
  Tables tables = pattern_tables(false);
  tables.resize(8);
  std::vector<float> rgb;
  for (int slice = 0; slice < 3; ++slice)
    for (const float level : {0.2f, 0.1f, 0.05f}) rgb.insert(rgb.end(), 16, level);
  tables.push_back(floats("rgb", {1, 3, 3, 4, 4}, rgb));
  const Ref<Shader> shader = rgl(tables, true);
  const SurfacePoint p = test::surface_point({0, 0, 1});
  const Spectrum f = shader->bind(p, test::wavelengths(), arena)->evaluate({0, 0, 1}, {0.6f, 0, 0.8f});
  EXPECT_LT(f[0], 0.4f * f[spectrum_size / 2]);  // blue, red
}

TEST_F(Measured, MerlReproducesItsModel) {
  const Ref<Shader> shader = merl();
  const SurfacePoint p = test::surface_point({0, 0, 1});
  test::Random random(2);
  double sum = 0, worst = 0;
  int count = 0;
  // At the ends of the spectrum, the smooth spectrum of this colour exceeds the range between its red and its blue.
  for (int i = 0; i < 3000; ++i) {
    Vector3 a = random.direction(), b = random.direction();
    a.z = std::abs(a.z);
    b.z = std::abs(b.z);
    if (a.z < 0.15f || b.z < 0.15f) continue;
    const Spectrum f = shader->bind(p, test::wavelengths(650), arena)->evaluate(a, b) / b.z;
    const double red = ggx(a, b, 0.9), blue = ggx(a, b, 0.3);
    EXPECT_LT(double(f[0]), 1.12 * red);
    EXPECT_GT(double(f.minimum()), 0.7 * blue);
    const double error = std::abs(double(f[0]) / red - 1);
    worst = std::max(worst, error);
    sum += error;
    ++count;
  }
  EXPECT_LT(sum / count, 0.08) << "worst " << worst;
}

// ---- sampling -------------------------------------------------------------------------------------------------------

TEST_F(Measured, SamplesFollowDensity) {
  constexpr int rows = 24, columns = 24, count = 40000;
  const std::vector<Ref<Shader>> shaders = {merl(), rgl(wide_tables(false), true), rgl(wide_tables(false), false),
                                            rgl(wide_tables(true), true), rgl(wide_tables(true), false)};
  std::uint32_t seed = 1;
  for (size_t n = 0; n < shaders.size(); ++n)
    for (const double angle : {10.0, 84.0, 125.0}) {
      const SurfacePoint p = test::surface_point();
      const Scatter* scatter = shaders[n]->bind(p, test::wavelengths(), arena);
      const double t = angle * M_PI / 180;
      const Vector3 out = scatter->frame().to_world({float(std::sin(t) * 0.6), float(std::sin(t) * 0.8), float(std::cos(t))});
      std::vector<double> expected = test::integrate_cells(scatter->frame(), rows, columns,
                                                           [&](const Vector3& in) { return double(scatter->pdf(out, in)); });
      double total = 0;
      for (double& e : expected) {
        total += e;
        e *= count;
      }
      EXPECT_LE(total, 1.003) << n << " at " << angle;
      expected.push_back(std::max(0.0, (1 - total) * count));
      std::vector<double> counts(expected.size());
      test::Random random(seed++);
      for (int i = 0; i < count; ++i) {
        const float choice = random();
        const auto s = scatter->sample(out, choice, random.pair());
        ++counts[s ? test::cell_of(scatter->frame(), rows, columns, s->direction) : counts.size() - 1];
        if (!s || i % 100) continue;
        const ScatterValue v = scatter->value_and_pdf(out, s->direction);
        EXPECT_NEAR(v.pdf, s->pdf, 2e-3f * v.pdf);
        EXPECT_NEAR(s->weight[1], v.value[1] / v.pdf, 5e-3f * s->weight[1]);
        const Spectrum back = scatter->evaluate(s->direction, out) * (scatter->cosine(s->direction) / scatter->cosine(out));
        if (shaders[n]->reciprocal()) {
          EXPECT_NEAR(back[0], v.value[0], 1e-3f * v.value[0]);
        }
      }
      EXPECT_GT(test::chi_square(counts, expected), test::each_of(15)) << n << " at " << angle << ", total " << total;
    }
}

// ---- hostile files --------------------------------------------------------------------------------------------------

TEST_F(Measured, HostileMerlFiles) {
  const std::string good = merl_file(4, 4, 4);
  EXPECT_EQ(refused("MerlShader", good), "");
  EXPECT_NE(refused("MerlShader", ""), "");
  EXPECT_NE(refused("MerlShader", good.substr(0, 11)), "");
  EXPECT_NE(refused("MerlShader", good.substr(0, good.size() - 1)), "");
  EXPECT_NE(refused("MerlShader", good + "x"), "");
  for (const std::int32_t n : {0, -1, 2000000000}) {
    std::string bad = good;
    std::memcpy(bad.data() + 4, &n, 4);
    EXPECT_NE(refused("MerlShader", bad), "") << n;
  }
  for (const double x : {std::nan(""), double(INFINITY), 1e30}) {
    std::string bad = good;
    std::memcpy(bad.data() + 12 + 8 * 70, &x, 8);
    EXPECT_NE(refused("MerlShader", bad).find("out of any range"), std::string::npos);
  }
  std::string unmeasured = good;
  const double none = -1;
  for (size_t at = 12; at < unmeasured.size(); at += 8) std::memcpy(unmeasured.data() + at, &none, 8);
  EXPECT_NE(refused("MerlShader", unmeasured), "");
  EXPECT_THROW(create<Shader>("MerlShader", {{"file", folder / "missing"}}), Error);
  EXPECT_THROW(create<Shader>("MerlShader", {{"file", folder.path()}}), Error);
}

TEST_F(Measured, HostileRglFiles) {
  const std::string good = tensor_file(pattern_tables(true));
  EXPECT_EQ(refused("RglShader", good), "");
  for (size_t size = 0; size < good.size(); size += size < 700 ? 13 : 499)
    EXPECT_NE(refused("RglShader", good.substr(0, size)), "") << size;

  // With any byte of the header changed the file is refused or read, without any other failure.
  test::Random random(3);
  for (int i = 0; i < 150; ++i) {
    std::string bad = good;
    bad[size_t(random() * 600)] = char(std::uint8_t(random() * 256));
    refused("RglShader", bad);
  }
  const auto with = [&](const std::function<void(Tables&)>& change) {
    Tables tables = pattern_tables(true);
    change(tables);
    return refused("RglShader", tensor_file(tables));
  };
  const auto broken = [&](size_t field, float value) {
    return with([&](Tables& t) { std::memcpy(t[field].bytes.data() + 4, &value, 4); });
  };
  EXPECT_NE(with([](Tables& t) { t[9].shape = {1ull << 40, 1ull << 40, 3, 4, 4}; }).find("more numbers than"),
            std::string::npos);
  EXPECT_NE(with([](Tables& t) { t[9].shape[2] = 2; }).find("'spectra'"), std::string::npos);
  EXPECT_NE(with([](Tables& t) { t.erase(t.begin() + 6); }).find("no field 'vndf'"), std::string::npos);
  EXPECT_NE(with([](Tables& t) { t[4] = t[5]; }).find("twice"), std::string::npos);
  EXPECT_NE(with([](Tables& t) { t[7].shape = {3, 3, 2, 8}; }), "");
  for (const size_t field : {2, 3, 4, 5, 6, 7, 8, 9})
    EXPECT_NE(broken(field, NAN).find("out of any range"), std::string::npos) << field;
  EXPECT_NE(broken(9, 1e30f).find("out of any range"), std::string::npos);
  EXPECT_NE(broken(6, -1).find("negative"), std::string::npos);
  EXPECT_NE(broken(5, 0).find("'sigma'"), std::string::npos);
  EXPECT_NE(broken(3, -2).find("'theta_i'"), std::string::npos);
  EXPECT_NE(broken(8, 900).find("do not increase"), std::string::npos);
  EXPECT_EQ(broken(9, -0.01f), "");  // noise is accepted
}

}  // namespace
}  // namespace etendue
