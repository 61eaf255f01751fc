// MaterialX documents: what becomes of their materials, and of documents that are damaged or made to harm. They need PyPI's
// `materialx`; without it only the message about it is tested.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "etendue/describe/color.h"
#include "etendue/importer.h"
#include "etendue/object_map.h"
#include "etendue/render/job.h"
#include "etendue/scene.h"
#include "etendue/shader.h"
#include "support/process.h"
#include "usd_support.h"

namespace etendue {
namespace {

const std::string head = "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\" colorspace=\"lin_rec709\">\n";
std::string input(const std::string& name, const std::string& type, const std::string& value) {
  return "<input name=\"" + name + "\" type=\"" + type + "\" value=\"" + value + "\"/>\n";
}
/// A document with the material "M" of a standard surface.
std::string standard_surface(const std::string& inputs, const std::string& before = "") {
  return head + before + "<standard_surface name=\"S\" type=\"surfaceshader\">\n" + inputs +
         "</standard_surface>\n<surfacematerial name=\"M\" type=\"material\">\n"
         "<input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"S\"/>\n</surfacematerial>\n</materialx>\n";
}

/// Sets ETENDUE_PYTHON as long as it lives.
class Python {
 public:
  explicit Python(const std::string& path) {
    if (const char* before = std::getenv("ETENDUE_PYTHON")) before_ = before;
    ::setenv("ETENDUE_PYTHON", path.c_str(), 1);
  }
  ~Python() {
    if (before_)
      ::setenv("ETENDUE_PYTHON", before_->c_str(), 1);
    else
      ::unsetenv("ETENDUE_PYTHON");
  }

 private:
  std::optional<std::string> before_;
};

/// A file of MaterialX as it is imported.
struct Read {
  Ref<Component> job;
  std::string error, notes;

  /// The shader, emission or what else a member of the only ball is; null: none.
  Ref<Component> of_ball(const char* member) const {
    const Ref<Scene> scene = ref_cast<Job>(job)->scene;
    const Value value = get(*scene->objects.back(), member);
    const auto* part = value.as<Ref<Component>>();
    return part ? *part : nullptr;
  }
};
Read read(const std::string& path, ImportOptions options = {}) {
  Read r;
  try {
    Importing importing(path, std::move(options));
    r.job = importer_of(path)->import(importing);
    for (const Error& note : importing.notes()) r.notes += std::string(note.what()) + "\n";
  } catch (const Error& e) {
    EXPECT_STREQ(e.location.file, path.c_str()) << e.what();
    r.error = e.what();
  }
  return r;
}

SurfacePoint at(float u, float v) {
  SurfacePoint p;
  p.normal = p.shading_normal = Normal3{0, 0, 1};
  p.dpdu = {1, 0, 0};
  p.dpdv = {0, 1, 0};
  p.uv = {u, v};
  p.ray_direction = {0, 0, -1};
  return p;
}
/// The albedo at normal incidence, in linear RGB.
std::array<double, 3> albedo(const Ref<Component>& part, float u = 0.5f, float v = 0.5f) {
  const auto shader = ref_cast<Shader>(part);
  prepare_tree(*shader);
  std::array<float, spectrum_size> lambda, pdf;
  for (size_t i = 0; i < spectrum_size; ++i) lambda[i] = 445 + 25 * float(i), pdf[i] = 1 / 200.0f;
  Arena arena;
  const Scatter* s = shader->bind(at(u, v), Wavelengths(lambda, pdf), arena);
  const Spectrum a = s ? s->albedo({0, 0, 1}) : Spectrum();
  return {double(a[7]), double(a[4]),
          double(a[0])};  // 620, 545 and 445 nm: red, green and blue of reflectances that are flat there
}

class MaterialX : public testing::Test {
 protected:
  void SetUp() override {
    const char* python = std::getenv("ETENDUE_PYTHON");
    const std::string check = std::string(python && *python ? python : "python3") + " -c 'import MaterialX' 2>/dev/null";
    if (std::system(check.c_str()) != 0) GTEST_SKIP() << "the Python package materialx is not installed";
  }
  /// A document of a name of its own, as its classes are named after it.
  std::string written(const std::string& text) {
    static int number = 0;
    return folder_.write("mtlx_test_" + std::to_string(++number) + ".mtlx", text);
  }
  std::string error_of(const std::string& text) { return read(written(text)).error; }

  const TemporaryFolder folder_;
};

TEST(MaterialXReader, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  const std::string path = folder.write("none.mtlx", standard_surface(""));
  {
    const Python none(folder / "none");
    EXPECT_NE(read(path).error.find("pip install materialx"), std::string::npos);
  }
  const auto script = [&](const std::string& text) {
    const std::string file = folder.write("python", "#!/bin/sh\n" + text + "\n");
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    return file;
  };
  {
    const Python bare(script("exec python3 -I -S \"$@\""));  // without site-packages
    const std::string error = read(path).error;
    EXPECT_NE(error.find("(MaterialX): pip install materialx"), std::string::npos) << error;
  }
  {
    const Python dies(script("kill -SEGV $$"));
    EXPECT_NE(read(path).error.find("signal 11"), std::string::npos);
  }
  {
    const Python noise(script("echo '{\"materials\": 3'"));
    EXPECT_NE(read(path).error.find("wrote something else"), std::string::npos);
  }
}

TEST_F(MaterialX, AMaterialIsAClassWithItsInputs) {
  const Read r = read(written(standard_surface(input("base", "float", "1") + input("specular", "float", "0") +
                                               input("base_color", "color3", "0.2, 0.4, 0.6"))));
  ASSERT_EQ(r.error, "");
  EXPECT_EQ(r.notes, "");
  const Ref<Component> shader = r.of_ball("shader");
  const ClassInfo& info = shader->class_info();
  EXPECT_TRUE(info.name.starts_with("MtlxTest")) << info.name;
  ASSERT_TRUE(info.find("base_color"));
  EXPECT_EQ(info.find("base_color")->kind, Kind::component) << "a map";
  ASSERT_TRUE(info.find("transmission"));
  EXPECT_EQ(info.find("transmission")->range->high, 1);
  EXPECT_EQ(info.find("transmission")->group, "Transmission");
  EXPECT_FALSE(r.of_ball("emission")) << "its emission is 0";
  // Diffuse reflection alone: the albedo is the base colour.
  set(*shader, "base_color", Value(flat_spectrum(0.4f)));
  for (const double a : albedo(shader)) EXPECT_NEAR(a, 0.4, 1e-3);
  // Reflection at 4 % above it, as its index of 1.5 says: 0.04 + 0.96 * 0.4 for the mirror, by albedo scaling.
  set(*shader, "specular", Value(Number{1}));
  set(*shader, "specular_roughness", Value(Number{0}));
  EXPECT_NEAR(albedo(shader)[1], 0.04 + 0.96 * 0.4, 4e-3);
  // It lets no light through, until its members say so.
  EXPECT_FALSE(ref_cast<Shader>(shader)->possible_lobes() & (specular_transmission | null_scattering));
  EXPECT_FALSE(ref_cast<Shader>(shader)->transmits());
  set(*shader, "transmission", Value(Number{0.5}));
  prepare_tree(*shader);
  EXPECT_TRUE(ref_cast<Shader>(shader)->possible_lobes() & specular_transmission);
  EXPECT_FLOAT_EQ(ref_cast<Shader>(shader)->interior_index({})[0], 1.5f);
}

TEST_F(MaterialX, IsWrittenAsAPluginAndReadAgain) {
  const std::string path = written(standard_surface(input("emission", "float", "2")));
  const Read r = read(path);
  ASSERT_EQ(r.error, "");
  EXPECT_TRUE(r.of_ball("emission"));
  set(*r.of_ball("shader"), "metalness", Value(Number{0.25}));
  const std::string text = write_description(*r.job);
  EXPECT_NE(text.find("plugin \"" + path), std::string::npos) << text;
  EXPECT_NE(text.find("metalness: 0.25"), std::string::npos) << text;
  const Ref<Component> again = parse_component(text);
  EXPECT_EQ(write_description(*again), text);
}

TEST_F(MaterialX, ColorsAreDecodedAndImagesStandUpright) {
  // 188 of 255 is 0.503 of the light in sRGB.
  const std::string pixels = std::string("P6 1 2 255\n") + '\xbc' + '\xbc' + '\xbc' + '\0' + '\0' + '\0';
  folder_.write("halves.ppm", pixels);
  const std::string image =
      "<image name=\"I\" type=\"color3\">\n<input name=\"file\" type=\"filename\" value=\"halves.ppm\" "
      "colorspace=\"srgb_texture\"/>\n<input name=\"filtertype\" type=\"string\" value=\"closest\"/></image>\n";
  const Read r = read(written(standard_surface("<input name=\"base_color\" type=\"color3\" nodename=\"I\"/>" +
                                                   input("base", "float", "1") + input("specular", "float", "0"),
                                               image)));
  ASSERT_EQ(r.error, "");
  EXPECT_NEAR(albedo(r.of_ball("shader"), 0.5f, 0.75f)[1], 0.503, 2e-3) << "v grows upwards";
  EXPECT_NEAR(albedo(r.of_ball("shader"), 0.5f, 0.25f)[1], 0, 1e-3);
  // A colour that is written encoded is a linear one for whoever edits it.
  const Read encoded =
      read(written(standard_surface("<input name=\"base_color\" type=\"color3\" value=\"0.5, 0.5, 0.5\" "
                                    "colorspace=\"srgb_texture\"/>" +
                                    input("base", "float", "1") + input("specular", "float", "0"))));
  EXPECT_NEAR(albedo(encoded.of_ball("shader"))[1], 0.21404, 1e-3);
}

TEST_F(MaterialX, SeveralMaterialsAndLight) {
  const std::string path = written(head +
                                   "<surface_unlit name=\"U\" type=\"surfaceshader\"/>\n<standard_surface name=\"S\" "
                                   "type=\"surfaceshader\"/>\n"
                                   "<surfacematerial name=\"lamp\" type=\"material\"><input name=\"surfaceshader\" "
                                   "type=\"surfaceshader\" nodename=\"U\"/></surfacematerial>\n"
                                   "<surfacematerial name=\"plain\" type=\"material\"><input name=\"surfaceshader\" "
                                   "type=\"surfaceshader\" nodename=\"S\"/></surfacematerial></materialx>\n");
  const Read r = read(path);
  ASSERT_EQ(r.error, "");
  const auto& objects = ref_cast<Job>(r.job)->scene->objects;
  const Ref<SceneObject> lamp = objects[objects.size() - 2], plain = objects.back();
  EXPECT_TRUE(lamp->emission);
  EXPECT_FALSE(plain->emission);
  EXPECT_TRUE(lamp->shader->class_info().name.ends_with("Lamp")) << lamp->shader->class_info().name;
  EXPECT_TRUE(plain->shader->class_info().name.ends_with("Plain"));
  EXPECT_EQ(plain->shader->origin->name, "plain");
}

// Materials that differ in names and values only share a compiled shader, and keep what they are.
TEST_F(MaterialX, ManyMaterialsKeepTheirValues) {
  constexpr int count = 40;
  std::string text = head;
  for (int i = 0; i < count; ++i) {
    const std::string number = std::to_string(i), value = std::to_string(i / double(count));
    text += "<standard_surface name=\"S" + number + "\" type=\"surfaceshader\">" + input("base", "float", "1") +
            input("specular", "float", "0") + input("base_color", "color3", value + "," + value + "," + value) +
            "</standard_surface>\n<surfacematerial name=\"M" + number +
            "\" type=\"material\"><input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"S" + number +
            "\"/></surfacematerial>\n";
  }
  const Read r = read(written(text + "</materialx>"));
  ASSERT_EQ(r.error, "");
  const auto& objects = ref_cast<Job>(r.job)->scene->objects;
  ASSERT_GE(objects.size(), size_t(count));
  for (int i = 0; i < count; ++i) {
    const Ref<SceneObject>& ball = objects[objects.size() - size_t(count) + size_t(i)];
    EXPECT_EQ(ball->shader->origin->name, "M" + std::to_string(i));
    EXPECT_NEAR(albedo(ball->shader)[1], i / double(count), 2e-3) << i;
  }
}

TEST_F(MaterialX, DisplacementIsAMap) {
  const std::string moved =
      head +
      "<standard_surface name=\"S\" type=\"surfaceshader\"/>\n"
      "<displacement name=\"D\" type=\"displacementshader\">" +
      input("displacement", "float", "0.5") + input("scale", "float", "0.25") +
      "</displacement>\n<surfacematerial name=\"M\" type=\"material\">\n"
      "<input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"S\"/>\n"
      "<input name=\"displacementshader\" type=\"displacementshader\" nodename=\"D\"/>\n</surfacematerial></materialx>";
  const Read r = read(written(moved));
  ASSERT_EQ(r.error, "");
  const auto map = ref_cast<ObjectMap>(r.of_ball("displacement"));
  ASSERT_TRUE(map);
  prepare_tree(*map);
  EXPECT_NEAR(map->scalar(at(0.5f, 0.5f)), 0.125, 1e-6);
}

TEST_F(MaterialX, FilesElsewhereNeedPermission) {
  const TemporaryFolder other;
  other.write("white.ppm", std::string("P6 1 1 255\n\xff\xff\xff"));
  const std::string image =
      "<image name=\"I\" type=\"color3\">" + input("file", "filename", other / "white.ppm") + "</image>\n";
  const std::string used = "<input name=\"base_color\" type=\"color3\" nodename=\"I\"/>";
  const std::string path = written(standard_surface(used, image));
  EXPECT_NE(read(path).error.find("--allow-path " + other.path()), std::string::npos) << read(path).error;
  ImportOptions allowed;
  allowed.allowed_folders = {other.path()};
  EXPECT_EQ(read(path, allowed).error, "");
  EXPECT_NE(read(path).error.find("--allow-path"), std::string::npos) << "what others may read is not kept for all";
  const Read missing = read(written(
      standard_surface(used, "<image name=\"I\" type=\"color3\">" + input("file", "filename", "none.png") + "</image>\n")));
  EXPECT_EQ(missing.error, "");
  EXPECT_NE(missing.notes.find("there is no file 'none.png'"), std::string::npos) << missing.notes;
  for (const char* outside : {"/etc/passwd", "../../../../../../etc/passwd"}) {
    const std::string error = error_of(
        "<?xml version=\"1.0\"?><materialx version=\"1.39\" xmlns:xi=\"http://www.w3.org/2001/XInclude\">"
        "<xi:include href=\"" +
        std::string(outside) + "\"/></materialx>");
    EXPECT_NE(error.find("--allow-path /etc"), std::string::npos) << error;
  }
}

TEST_F(MaterialX, DamagedDocumentsAreErrors) {
  EXPECT_NE(error_of(""), "");
  EXPECT_NE(error_of("<materialx version=\"1.39\"><surfacematerial"), "");
  EXPECT_NE(error_of("<html/>"), "");
  EXPECT_NE(error_of(head + "</materialx>").find("no materials"), std::string::npos);
  const std::string itself = folder_ / "itself.mtlx";
  folder_.write("itself.mtlx",
                "<?xml version=\"1.0\"?><materialx version=\"1.39\" xmlns:xi=\"http://www.w3.org/2001/XInclude\">"
                "<xi:include href=\"itself.mtlx\"/></materialx>");
  EXPECT_NE(read(itself).error.find("includes itself"), std::string::npos) << read(itself).error;
  // A graph that runs in a circle.
  const std::string circle =
      "<multiply name=\"A\" type=\"color3\"><input name=\"in1\" type=\"color3\" nodename=\"B\"/></multiply>"
      "<multiply name=\"B\" type=\"color3\"><input name=\"in1\" type=\"color3\" nodename=\"A\"/></multiply>\n";
  const std::string used = "<input name=\"base_color\" type=\"color3\" nodename=\"A\"/>";
  EXPECT_NE(error_of(standard_surface(used, circle)), "");
  EXPECT_NE(error_of(standard_surface(used, "<nothing_like_it name=\"A\" type=\"color3\"/>")), "");
  // Text that would leave the string it stands in, and code that the document brings.
  EXPECT_NE(error_of(standard_surface(used, "<image name=\"A\" type=\"color3\">" +
                                                input("uaddressmode", "string", "&quot;); Ci = 0; //") + "</image>"))
                .find("quotation mark"),
            std::string::npos);
  const std::string code =
      "<nodedef name=\"ND_mine\" node=\"mine\"><output name=\"out\" type=\"color3\"/></nodedef>"
      "<implementation name=\"IM_mine\" nodedef=\"ND_mine\" target=\"genosl\" file=\"/etc/passwd\" function=\"f\"/>"
      "<mine name=\"A\" type=\"color3\"/>";
  const std::string refused = error_of(standard_surface(used, code));
  EXPECT_NE(refused, "");
  EXPECT_EQ(refused.find("root:"), std::string::npos) << refused;
  std::string deep = head;
  for (int i = 0; i < 20000; ++i) deep += "<nodegraph name=\"g" + std::to_string(i) + "\">";
  EXPECT_NE(error_of(deep), "");
}

// A network of MaterialX in a USD scene, and a reference to a document.
class MaterialXInUsd : public test::UsdTest {
 protected:
  void SetUp() override {
    test::UsdTest::SetUp();
    const char* python = std::getenv("ETENDUE_PYTHON");
    has_reader_ =
        std::system((std::string(python && *python ? python : "python3") + " -c 'import MaterialX' 2>/dev/null").c_str()) == 0;
  }
  bool has_reader_ = false;
};

TEST_F(MaterialXInUsd, NetworksAndDocumentsAreRead) {
  folder_.write("mtlx_test_of_usd.mtlx", standard_surface(input("base", "float", "1") + input("specular", "float", "0") +
                                                          input("base_color", "color3", "0.25, 0.25, 0.25")));
  const Ref<Scene> s = scene(
      test::y_up +
      "def Material \"own\" {\ntoken outputs:mtlx:surface.connect = </own/s.outputs:out>\ndef Shader \"s\" {\nuniform token "
      "info:id = \"ND_standard_surface_surfaceshader\"\nfloat inputs:base = 1\nfloat inputs:specular = 0\ncolor3f "
      "inputs:base_color.connect = </own/m.outputs:out>\ntoken outputs:out\n}\ndef Shader \"m\" {\nuniform token info:id = "
      "\"ND_multiply_color3\"\ncolor3f inputs:in1 = (0.5, 0.5, 0.5)\ncolor3f inputs:in2 = (0.75, 0.75, 0.75)\ncolor3f "
      "outputs:out\n}\n}\n"
      "def Material \"other\" ( references = @mtlx_test_of_usd.mtlx@</MaterialX/Materials/M> ) {\n}\n"
      "def Sphere \"a\" ( prepend apiSchemas = [\"MaterialBindingAPI\"] ) {\nrel material:binding = </own>\n}\n"
      "def Sphere \"b\" ( prepend apiSchemas = [\"MaterialBindingAPI\"] ) {\nrel material:binding = </other>\n}\n");
  ASSERT_TRUE(s) << error_;
  ASSERT_EQ(s->objects.size(), 2u);
  if (!has_reader_) {
    EXPECT_TRUE(told("pip install materialx"));
    GTEST_SKIP() << "the Python package materialx is not installed";
  }
  EXPECT_TRUE(notes_.empty()) << notes_.front();
  const auto own = albedo(s->objects[0]->shader), other = albedo(s->objects[1]->shader);
  EXPECT_NEAR(own[1], 0.375, 1e-3);
  EXPECT_NEAR(other[1], 0.25, 1e-3);
}

}  // namespace
}  // namespace etendue
