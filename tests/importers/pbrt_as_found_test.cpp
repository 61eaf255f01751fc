// Elements of pbrt scenes found in the wild that pbrt's readers accept without a warning.

#include "pbrt_support.h"

namespace etendue::pbrt_test {
namespace {

bool told(const Imported& i, const std::string& what) { return i.told().find(what) != std::string::npos; }

const std::string sphere = " Shape \"sphere\"\n";

const Component& shader(const Imported& i, size_t of = 0) { return part(object(i, of), "shader"); }

TEST(PbrtAsFound, RoughnessHasNoUpperEnd) {
  const Imported tire = import_text(v4("Material \"conductor\" \"float roughness\" 5.8" + sphere));
  ASSERT_TRUE(tire.job) << tire.told();
  EXPECT_EQ(number(shader(tire), "roughness"), 1);
  EXPECT_TRUE(told(tire, "a roughness beyond an alpha of 1")) << tire.told();
  const Imported metal = import_text(v3("Material \"metal\" \"float roughness\" 0.5" + sphere));
  EXPECT_EQ(number(shader(metal), "roughness"), 1);
  const Imported disney = import_text(v3("Material \"disney\" \"float metallic\" 1.5" + sphere));
  EXPECT_EQ(number(shader(disney), "metallic"), 1);
  EXPECT_TRUE(told(disney, "'metallic' of a Disney material is kept")) << disney.told();
}

// In version 3 only glass with roughness 0 along both directions is smooth: elsewhere 0 is read as 0.001, whose alpha is
// 1.62142 + 0.819955 x + 0.1734 x^2 + 0.0171201 x^3 + 0.000640711 x^4 at x = log(0.001), 0.0473.
TEST(PbrtAsFound, NoRoughnessOfVersion3) {
  EXPECT_NEAR(number(shader(import_text(v3("Material \"metal\" \"float roughness\" 0" + sphere))), "roughness"), 0.0473, 1e-3);
  EXPECT_EQ(number(shader(import_text(v3("Material \"glass\"" + sphere))), "roughness"), 0);
  const Imported along = import_text(v3("Material \"glass\" \"float vroughness\" 0.1" + sphere));
  EXPECT_NEAR(number(shader(along), "roughness"), 0.0473, 1e-3);
  // Glass has no parameter "roughness"; uber's v roughness equals that along u if only the latter is given.
  const Imported glass = import_text(v3("Material \"glass\" \"float roughness\" 0.2" + sphere));
  EXPECT_EQ(number(shader(glass), "roughness"), 0);
  EXPECT_TRUE(told(glass, "'roughness' of Material \"glass\" is not used")) << glass.told();
  const Imported uber = import_text(v3("Material \"uber\" \"float uroughness\" 0.01" + sphere));
  EXPECT_LT(number(part(shader(uber), "second"), "roughness_v"), 0);  // as along u
  EXPECT_FALSE(told(uber, "not used")) << uber.told();
}

TEST(PbrtAsFound, MetalsThatReflectAll) {
  const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
  const std::string wall = " Shape \"trianglemesh\" \"point3 P\" [-9 9 5 9 9 5 0 -19 5]\n";
  EXPECT_NEAR(seen(import_text(v4(sky + "Material \"conductor\" \"rgb reflectance\" [1 1 1]" + wall)), 64).y, 0.9996, 1e-3);
  EXPECT_NEAR(seen(import_text(v4(sky +
                                  "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [1 1 1]\n"
                                  "Material \"conductor\" \"texture reflectance\" \"t\"" +
                                  wall)),
                   64)
                  .y,
              0.9996, 1e-3);
}

TEST(PbrtAsFound, OddTransforms) {
  // For directions, only the upper left part of a matrix with perspective is used.
  const Imported turned = import_text(
      v4("AttributeBegin ConcatTransform [-0.224951 0 -0.97437 0 -0.97437 0 0.224951 0 0 1 0 8.87 0 0 0 1] LightSource "
         "\"infinite\" \"rgb L\" [1 1 1] AttributeEnd"));
  EXPECT_TRUE(turned.job && told(turned, "the last row of a matrix")) << turned.told();
  // A transform that cannot be inverted matters only if an object uses it.
  const Imported nothing = import_text(v4("AttributeBegin Scale 1 1 0 AttributeEnd" + sphere));
  EXPECT_TRUE(nothing.job && nothing.told().empty()) << nothing.told();
  const Imported flat = import_text(v4("AttributeBegin Scale 1 1 0" + sphere + "AttributeEnd" + sphere));
  ASSERT_TRUE(flat.job) << flat.told();
  EXPECT_EQ(flat.job->scene->objects.size(), 1u);
  EXPECT_TRUE(told(flat, "Shape \"sphere\" is left out: its transform")) << flat.told();
}

TEST(PbrtAsFound, NarrowSpots) {
  const Imported i = import_text(v4("LightSource \"spot\" \"float coneangle\" 3"));
  ASSERT_TRUE(i.job) << i.told();
  EXPECT_NEAR(number(part(object(i, 0), "emission"), "inner_angle"), 2 * M_PI / 180, 1e-6);
}

TEST(PbrtAsFound, NamedSpectra) {
  const Imported i =
      import_text(v4("Material \"conductor\" \"spectrum eta\" \"metal-CuZn-eta\" \"spectrum k\" \"metal-CuZn-k\"" + sphere +
                     "LightSource \"point\" \"spectrum I\" \"illum-acesD60\""));
  EXPECT_TRUE(i.job && i.told().empty()) << i.told();
  for (const char* metal : {"Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"}) {
    const std::string name = std::string("metal-") + metal;
    const Imported m = import_text(
        v4("Material \"conductor\" \"spectrum eta\" \"" + name + "-eta\" \"spectrum k\" \"" + name + "-k\"" + sphere));
    ASSERT_TRUE(m.job && m.told().empty()) << m.told();
    EXPECT_EQ((*get(shader(m), "ior").as<Color>())->expression(), "metal(\"" + std::string(metal) + "\")");
  }
  for (const auto& [theirs, ours] : {std::pair("BK7", "N-BK7"),
                                     {"BAF10", "N-BAF10"},
                                     {"FK51A", "N-FK51A"},
                                     {"LASF9", "N-LASF9"},
                                     {"F5", "N-SF5"},
                                     {"SF5", "N-SF5"},
                                     {"F10", "N-SF10"},
                                     {"SF10", "N-SF10"},
                                     {"F11", "N-SF11"},
                                     {"SF11", "N-SF11"}}) {
    const Imported g =
        import_text(v4("Material \"dielectric\" \"spectrum eta\" \"glass-" + std::string(theirs) + "\"" + sphere));
    ASSERT_TRUE(g.job && g.told().empty()) << g.told();
    EXPECT_EQ((*get(shader(g), "ior").as<Color>())->expression(), "glass(\"" + std::string(ours) + "\")");
  }
  const Imported unknown = import_text(v4("Material \"dielectric\" \"spectrum eta\" \"glass-BK8\"" + sphere));
  EXPECT_TRUE(told(unknown, "'glass-BK8' is not known here (did you mean 'glass-BK7'?)")) << unknown.told();
  // ACES's D60 between D50 and D65: more blue than the one, less than the other.
  const auto blue = [](const std::string& name) {
    const Value v =
        get(part(object(import_text(v4("LightSource \"point\" \"spectrum I\" \"" + name + "\"")), 0), "emission"), "radiance");
    const Component& map = **v.as<Ref<Component>>();
    const Value inner = get(map, "value");
    const Color& c = *inner.as<Color>();
    return c->at(450, ColorUse::radiance) / c->at(600, ColorUse::radiance);
  };
  EXPECT_GT(blue("illum-acesD60"), blue("stdillum-D50"));
  EXPECT_LT(blue("illum-acesD60"), blue("stdillum-D65"));
}

TEST(PbrtAsFound, CommentsTellNoVersion) {
  const Imported i = import_text("# Film \"image\" was here\n" + v4("Material \"diffuse\"" + sphere));
  ASSERT_TRUE(i.job) << i.told();
  EXPECT_FALSE(told(i, "not used")) << i.told();
  EXPECT_EQ(shader(i).class_info().name, "Lambertian");
}

TEST(PbrtAsFound, LightsDoNotMove) {
  const Imported i = import_text(v4(
      "Translate 0 0 1 ActiveTransform EndTime Translate 0 0 9 ActiveTransform All LightSource \"point\" \"rgb I\" [1 1 1]"));
  ASSERT_TRUE(i.job && told(i, "this light does not move")) << i.told();
  EXPECT_FALSE(i.job->scene->objects.at(0)->transform.animated());
}

TEST(PbrtAsFound, InterfacesDoNotShine) {
  const Imported i =
      import_text(v4("AreaLightSource \"diffuse\" Material \"interface\"" + sphere + "Material \"diffuse\"" + sphere));
  ASSERT_TRUE(i.job && told(i, "whose material is an interface, is left out")) << i.told();
  EXPECT_FALSE(i.job->scene->objects.at(0)->emission);
  EXPECT_TRUE(i.job->scene->objects.at(1)->emission);
}

TEST(PbrtAsFound, ColoursWhereNumbersAreNeeded) {
  const std::string two =
      "MakeNamedMaterial \"a\" \"string type\" \"matte\"\nMakeNamedMaterial \"b\" \"string type\" \"matte\"\n";
  EXPECT_TRUE(
      told(import_text(v3(two +
                          "Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\" \"rgb amount\" "
                          "[.8 .4 .2]" +
                          sphere)),
           "the amount of a mixture that differs between colours is their brightness"));
  EXPECT_TRUE(told(import_text(v3("Material \"matte\" \"rgb Kd\" [1.5 1 1]" + sphere)), "'Kd' is at most 1 here"));
  // An environment's scale of three numbers multiplies its colour; the pixel is that of the product.
  const Xyz sky = seen(import_text(v3("LightSource \"infinite\" \"rgb L\" [1 1 1] \"rgb scale\" [.2 .4 .8]")), 256);
  const Xyz direct = seen(import_text(v3("LightSource \"infinite\" \"rgb L\" [.2 .4 .8]")), 256);
  EXPECT_NEAR(sky.x, direct.x, 0.01 * direct.x);
  EXPECT_NEAR(sky.z, direct.z, 0.01 * direct.z);
}

TEST(PbrtAsFound, FilmsOfOtherColourSpaces) {
  const Imported i = import_text(v4(sphere, "", "\"float fov\" 1", "ColorSpace \"rec2020\"\n"));
  ASSERT_TRUE(i.job) << i.told();
  EXPECT_EQ(*get(*i.job->outputs.at(0), "color_space").as<std::string>(), "rec2020");
  const Imported narrow = import_text(
      "Camera \"perspective\" Film \"rgb\" PixelFilter \"box\" \"float xradius\" 0.3 \"float yradius\" 0.3\n"
      "WorldBegin\n");
  EXPECT_TRUE(narrow.job && told(narrow, "a filter's radius is kept within 0.5")) << narrow.told();
}

TEST(PbrtAsFound, PartsOfMeshesThatDoNotFit) {
  const std::string mesh = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] ";
  const Imported uvs = import_text(v4(mesh + "\"point2 uv\" [0 0 1 1]"));
  EXPECT_TRUE(uvs.job && told(uvs, "has 2 'uv' for 3 vertices: they are left out")) << uvs.told();
  const Imported more = import_text(v4(mesh + "\"integer indices\" [0 1 2 0 1]"));
  EXPECT_TRUE(more.job && told(more, "the last are left out")) << more.told();
  const Imported curve =
      import_text(v4("Shape \"curve\" \"point3 P\" [0 0 0 0 0 0 0 0 0 0 0 0]\nShape \"curve\" \"float width\" 0 "
                     "\"point3 P\" [0 0 0 1 0 0 1 1 0 1 1 1]"));
  ASSERT_TRUE(curve.job) << curve.told();
  EXPECT_TRUE(curve.job->scene->objects.empty());
  EXPECT_TRUE(told(curve, "a curve of no length or no width is left out")) << curve.told();
}

TEST(PbrtAsFound, ImagesThatAreMissing) {
  const Imported i = import_text(v3("LightSource \"infinite\" \"rgb L\" [2 2 2] \"string mapname\" \"gone.exr\""));
  EXPECT_NEAR(seen(i, 64).y, 2, 0.02);
  EXPECT_FALSE(told(i, "not used")) << i.told();
  const Imported t =
      import_text(v4("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"gone.png\" \"float gamma\" 2.2"));
  EXPECT_TRUE(t.job && told(t, "stands for the image that is missing")) << t.told();
}

TEST(PbrtAsFound, PlasticKeepsItsColour) {
  const Imported i = import_text(v3("Material \"plastic\" \"rgb Kd\" [.8 .1 .1] \"rgb Ks\" [.1 .1 .1]" + sphere));
  const Value color = get(part(shader(i), "first"), "color");
  EXPECT_EQ((*color.as<Ref<Component>>())->class_info().name, "ConstantMap");  // which exporters can write
  // Weights of 2/3 and 1/3: a spectrum scaled by 1.5 would exceed 1 in the red, while the spectrum of a colour of 0.9 does not.
  const Imported red = import_text(v3("Material \"plastic\" \"rgb Kd\" [.6 .1 .1] \"rgb Ks\" [.3 .3 .3]" + sphere));
  ASSERT_TRUE(red.job) << red.told();
  EXPECT_NO_THROW(prepare_tree(*red.job));
}

}  // namespace
}  // namespace etendue::pbrt_test
