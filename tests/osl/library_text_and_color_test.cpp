// The shading language's library: strings, formats, regular expressions, colours, closures and textures' options.

#include "call_library.h"
#include "osl/library/closures.h"
#include "osl/library/conversions.h"

namespace etendue::osl::test {

namespace {

std::string format(std::vector<Value> arguments) { return text("string format(string format, ...)", std::move(arguments)); }
Value color(float r, float g, float b) { return {Base::color, Triple(r, g, b)}; }

void expect_near(const Triple& a, const Triple& b, float tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance * std::max(1.0f, std::abs(b[k]))) << k;
}

}  // namespace

TEST(OslFormats, FollowTheArgumentsTypes) {
  EXPECT_EQ(format({"%g and %6.2f|%-5d|%05d|%x", 0.5f, 3.14159f, 42, -7, 255}), "0.5 and   3.14|42   |-0007|ff");
  EXPECT_EQ(format({"(%g)", color(0.1f, 0.7f, 0.2f)}), "(0.1 0.7 0.2)");
  EXPECT_EQ(format({"%g", Matrix::identity()}), "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  EXPECT_EQ(format({"%d|%s|%d", 1.5f, 3, "text"}), "1.500000|3|text");
  EXPECT_EQ(format({"100%% %s", "sure"}), "100% sure");
  EXPECT_EQ(format({"%d", Value::array(Base::int_, std::vector<int>{1, 2, 3})}), "1 2 3");
  EXPECT_EQ(format({"%d %d", 1}), "1 %d");
  EXPECT_EQ(format({"%", 1}), "%");
  EXPECT_EQ(format({"%5", 1}), "%5");
  EXPECT_LE(format({"%999999999d", 1}).size(), 1000u);
  EXPECT_EQ(format({"%hd %lf", 1, 2.0f}), "1 2.000000");
  EXPECT_EQ(format({"%n%p", 1, 2.0f}), "12.000000");
  World world;
  call(world, "void printf(string format, ...)", Base::void_, {"u = %g\n", 0.25f});
  EXPECT_EQ(world.said, "u = 0.25\n");
}

TEST(OslStrings, Parts) {
  EXPECT_EQ(text("string concat(string a, string b, ...)", {"a", "b", "cd"}), "abcd");
  EXPECT_EQ(text("string substr(string s, int start, int length)", {"abcdef", -4, 2}), "cd");
  EXPECT_EQ(text("string substr(string s, int start)", {"abcdef", 2}), "cdef");
  EXPECT_EQ(text("string substr(string s, int start, int length)", {"abc", -2147483647, 2147483647}), "abc");
  EXPECT_EQ(text("string substr(string s, int start, int length)", {"abc", 5, -1}), "");
  EXPECT_EQ(integer("int getchar(string s, int index)", {"abc", 1}), 'b');
  EXPECT_EQ(integer("int getchar(string s, int index)", {"abc", 3}), 0);
  EXPECT_EQ(integer("int stoi(string s)", {" +12ab"}), 12);
  EXPECT_EQ(integer("int stoi(string s)", {"x"}), 0);
  EXPECT_EQ(integer("int stoi(string s)", {"-99999999999"}), std::numeric_limits<int>::min());
  EXPECT_EQ(number("float stof(string s)", {" 3.5e2xyz"}), 350);
  EXPECT_EQ(integer("int startswith(string s, string prefix)", {"foobar", "foo"}), 1);
  EXPECT_EQ(integer("int endswith(string s, string suffix)", {"foobar", "foo"}), 0);
  EXPECT_EQ(integer("int hash(string s)", {""}), 0);
}

TEST(OslStrings, Split) {
  const auto split = [](std::string_view signature, std::vector<Value> arguments, int room) {
    World world;
    arguments.insert(arguments.begin() + 1, Value(Type(Base::string, room)));
    const int n = call(world, signature, Base::int_, false, arguments).as<int>();
    std::string all;
    for (int i = 0; i < n; ++i) all += "[" + arguments[1].at<const String*>(std::size_t(i))->text() + "]";
    return all;
  };
  EXPECT_EQ(split("int split(string s, output string results[])", {"  a b\tc "}, 5), "[a][b][c]");
  EXPECT_EQ(split("int split(string s, output string results[], string separator)", {"a,,b", ","}, 5), "[a][][b]");
  EXPECT_EQ(split("int split(string s, output string results[], string separator, int most)", {"a,b,c", ",", 2}, 5),
            "[a][b,c]");
  EXPECT_EQ(split("int split(string s, output string results[], string separator, int most)", {"a,b,c", ",", 99}, 2),
            "[a][b,c]");
  EXPECT_EQ(split("int split(string s, output string results[])", {""}, 2), "");
}

TEST(OslStrings, RegularExpressions) {
  EXPECT_EQ(integer("int regex_search(string subject, string pattern)", {"foobar.baz", "bar"}), 1);
  EXPECT_EQ(integer("int regex_search(string subject, string pattern)", {"foobar.baz", "bark"}), 0);
  EXPECT_EQ(integer("int regex_match(string subject, string pattern)", {"foobar.baz", "bar"}), 0);
  EXPECT_EQ(integer("int regex_match(string subject, string pattern)", {"foobar.baz", "f[Oo]{2}.*\\.(baz|foo)"}), 1);
  World world;
  std::vector<Value> arguments{"foobar.baz", Value(Type(Base::int_, 8)), "(f[Oo]{2}).*(.az)"};
  EXPECT_EQ(call(world, "int regex_search(string subject, output int results[], string pattern)", Base::int_, false, arguments)
                .as<int>(),
            1);
  const int expected[8] = {0, 10, 0, 3, 7, 10, 17, 17};
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(arguments[1].at<int>(i), expected[i]) << i;
  call(world, "int regex_search(string subject, string pattern)", Base::int_, {"text", "(un"});
  EXPECT_NE(world.failed, "");
  // A match that would take longer than the universe lasts is given up.
  world.failed.clear();
  const std::string subject(50, 'a');
  call(world, "int regex_match(string subject, string pattern)", Base::int_, {subject.c_str(), "(a|aa|a*)*b|(a+)+$c"});
  call(world, "int regex_match(string subject, string pattern)", Base::int_, {subject.c_str(), "(\\w|a)*(\\w|a)*(\\w|a)*\\d"});
  EXPECT_NE(world.failed, "");
}

TEST(OslColors, SpacesAsTheReferenceHasThem) {
  const auto in = [](const char* space, float a, float b, float c) {
    return triple("color color(string space, float r, float g, float b)", {space, a, b, c});
  };
  expect_near(in("hsv", 0.1f, 0.2f, 0.5f), {0.5f, 0.46f, 0.4f}, 1e-6f);
  expect_near(in("hsl", 0.5f, 1, 0.1f), {0, 0.2f, 0.2f}, 1e-6f);
  expect_near(in("YIQ", 0.5f, 0.25f, 0.25f), {0.8939f, 0.270375f, 0.649225f}, 1e-6f);
  expect_near(in("XYZ", 0.25f, 0.5f, 0.25f), {-0.08315f, 0.7059f, 0.1763f}, 1e-4f);
  EXPECT_NEAR(number("float luminance(color c)", {color(0.5f, 0.75f, 0.75f)}), 0.696873, 1e-6);
  for (const char* space : {"hsv", "hsl", "XYZ", "xyY", "YIQ"}) {
    const Triple there = triple("color transformc(string to, color c)", {space, color(0.3f, 0.6f, 0.45f)});
    expect_near(triple("color transformc(string from, string to, color c)", {space, "rgb", Value(Base::color, there)}),
                {0.3f, 0.6f, 0.45f}, std::string_view(space) == "YIQ" ? 2e-3f : 1e-5f);  // YIQ's two matrices have few decimals
  }
  World world;
  call(world, "color transformc(string from, string to, color c)", Base::color, {"rgb", "nowhere", color(1, 1, 1)});
  EXPECT_EQ(world.failed, "Unknown color space transformation \"rgb\" -> \"nowhere\"");
}

TEST(OslColors, BlackBodiesAndSpectralLines) {
  const ColorSystem& aces = *ColorSystem::named("ACEScg");
  expect_near(aces.to_xyz({0.1f, 0.7f, 0.2f}), {0.191286f, 0.509818f, 0.204353f}, 1e-6f);
  expect_near(aces.blackbody(1500), {75.0559f, 22.3461f, 2.22219f}, 1e-5f);
  expect_near(aces.wavelength(500), {0, 0.207563f, 0.105645f}, 1e-6f);
  EXPECT_EQ(aces.wavelength(1000), Triple(0));
  // Without a jump where the table ends.
  expect_near(aces.blackbody(11999), aces.blackbody(12001), 2e-3f);
  EXPECT_EQ(ColorSystem::named("sRGB")->luminance(1), ColorSystem::rec709().luminance(1));
  EXPECT_EQ(ColorSystem::named("none"), nullptr);
}

TEST(OslColors, DerivativesFollowTheSpaces) {
  World world;
  const auto run = [&](const char* space, float h, bool derivatives) {
    const Dual<Triple> c({0.3f + h, 0.6f - h, 0.45f + 2 * h}, {1, -1, 2}, {0, 0, 0});
    std::vector<Value> arguments{space, Value(Base::color, c)};
    return call(world, "color transformc(string to, color c)", Base::color, derivatives, arguments);
  };
  for (const char* space : {"hsv", "hsl", "XYZ", "xyY", "YIQ"}) {
    SCOPED_TRACE(space);
    const float h = 1e-3f;
    const Triple difference = (run(space, h, false).as<Triple>() - run(space, -h, false).as<Triple>()) * (0.5f / h);
    expect_near(run(space, 0, true).at<Triple>(1), difference, 2e-3f);
  }
}

TEST(OslClosures, AreMadeOfCalls) {
  World world;
  ClosureShape shape;
  shape.name = intern_string("diffuse");
  shape.add(Base::normal);
  shape.add(Base::string, intern_string("label"));
  CallTypes types;
  types.arguments = {{Base::normal}, {Base::string}, {Base::string}};
  const Triple n(0, 0, 1);
  const String *keyword = intern_string("label"), *label = intern_string("first");
  void* addresses[] = {const_cast<Triple*>(&n), const_cast<String**>(&keyword), const_cast<String**>(&label)};
  const ClosureNode* one = make_component({addresses, nullptr, types, world}, shape);
  EXPECT_EQ(to_text(one), "(1, 1, 1) * diffuse ((0, 0, 1), \"label\", \"first\")");
  EXPECT_EQ(make_product(world, Triple(0), one), nullptr);
  EXPECT_EQ(make_sum(world, one, nullptr), one);
  EXPECT_EQ(to_text(make_product(world, Triple(0.5f), make_sum(world, one, one))),
            "(0.5, 0.5, 0.5) * diffuse ((0, 0, 1), \"label\", \"first\")\n\t+ (0.5, 0.5, 0.5) * diffuse ((0, 0, 1), \"label\", "
            "\"first\")");
}

TEST(OslTextures, OptionsReachTheRenderer) {
  struct Textured : World {
    TextureOptions seen;
    bool missing = false;
    std::string_view texture(const String*, const Dual<float>& s, const Dual<float>&, const TextureOptions& o,
                             TextureLookup& found) override {
      seen = o;
      if (missing) return "no such file";
      for (int k = 0; k < 4; ++k) found.value[k] = s.value + float(k), found.by_s[k] = 2;
      return {};
    }
  } world;
  constexpr const char* signature = "TYPE texture(string file, float s, float t, output ...)";
  std::vector<Value> a{"a.png",
                       Value(Dual<float>(0.25f, 1, 3)),
                       0.5f,
                       "blur",
                       0.1f,
                       "twidth",
                       2.0f,
                       "swrap",
                       "mirror",
                       "firstchannel",
                       1,
                       "alpha",
                       Value(Type(Base::float_)),
                       "errormessage",
                       Value(Type(Base::string))};
  *reinterpret_cast<const String**>(a.back().bytes.data()) = empty_string();
  const Value c = call(world, signature, Base::color, true, a);
  EXPECT_EQ(c.as<Triple>(), Triple(0.25f, 1.25f, 2.25f));
  EXPECT_EQ(c.at<Triple>(2), Triple(6));
  EXPECT_EQ(a[12].as<float>(), 3.25f);
  EXPECT_EQ(world.seen.blur[2], 0.1f);
  EXPECT_EQ(world.seen.width[1], 2);
  EXPECT_EQ(world.seen.width[0], 1);
  EXPECT_EQ(world.seen.wrap[0], intern_string("mirror"));
  EXPECT_EQ(world.seen.wrap[1], nullptr);
  EXPECT_EQ(world.seen.first_channel, 1);
  world.missing = true;
  call(world, signature, Base::color, false, a);
  EXPECT_EQ(a[14].as<const String*>()->text(), "no such file");
  EXPECT_EQ(world.failed, "");
  const Value pink = call(world, signature, Base::color, {"a.png", 0.0f, 0.0f, "missingcolor", color(1, 0, 1)});
  EXPECT_EQ(pink.as<Triple>(), Triple(1, 0, 1));
  call(world, signature, Base::color, {"a.png", 0.0f, 0.0f});
  EXPECT_EQ(world.failed, "no such file");
}

TEST(OslDictionaries, AreSearchedWithXPath) {
  World world;
  const char* document = "<shop><cup size='2.5' n='7'>blue</cup><cup c='1, 2 3'/><cup c='1 2'/></shop>";
  const auto find = [&](const char* query) {
    return call(world, "int dict_find(string dictionary, string query)", Base::int_, {document, query}).as<int>();
  };
  constexpr const char* value = "int dict_value(int node, string attribute, output ANY value)";
  const int first = find("//cup");
  ASSERT_GT(first, 0);
  EXPECT_EQ(find("//cup"), first);
  std::vector<Value> a{first, "size", Value(Type(Base::float_))}, b{first, "", Value(Type(Base::string))},
      n{first, "n", Value(Type(Base::int_))}, wrong{first, "", Value(Type(Base::int_))};
  EXPECT_EQ(call(world, value, Base::int_, false, a).as<int>(), 1);
  EXPECT_EQ(a[2].as<float>(), 2.5f);
  EXPECT_EQ(call(world, value, Base::int_, false, b).as<int>(), 1);
  EXPECT_EQ(b[2].as<const String*>()->text(), "blue");
  EXPECT_EQ(call(world, value, Base::int_, false, n).as<int>(), 1);
  EXPECT_EQ(n[2].as<int>(), 7);
  EXPECT_EQ(call(world, value, Base::int_, false, wrong).as<int>(), 0);
  const int second = call(world, "int dict_next(int node)", Base::int_, {first}).as<int>();
  std::vector<Value> color{second, "c", Value(Type(Base::color), true)};
  EXPECT_EQ(call(world, value, Base::int_, false, color).as<int>(), 1);
  EXPECT_EQ(color[2].as<Triple>(), Triple(1, 2, 3));
  const int third = call(world, "int dict_next(int node)", Base::int_, {second}).as<int>();
  std::vector<Value> two{third, "c", Value(Type(Base::color))};
  EXPECT_EQ(call(world, value, Base::int_, false, two).as<int>(), 0);
  EXPECT_EQ(call(world, "int dict_next(int node)", Base::int_, {third}).as<int>(), 0);
  EXPECT_EQ(call(world, "int dict_find(int node, string query)", Base::int_, {third, "../cup"}).as<int>() > 0, true);
  EXPECT_EQ(find("//saucer"), 0);
  EXPECT_EQ(world.failed, "");
  EXPECT_EQ(find("//["), 0);
  EXPECT_NE(world.failed, "");
  EXPECT_EQ(call(world, "int dict_find(string dictionary, string query)", Base::int_, {"<shop", "//cup"}).as<int>(), -1);
  EXPECT_EQ(call(world, "int dict_find(string dictionary, string query)", Base::int_, {"/dev/none.xml", "//cup"}).as<int>(),
            -1);
}

TEST(OslAttributes, AreConverted) {
  const auto convert = [](const Value& from, Value to) {
    const bool done = convert_value(from.type, from.derivatives, from.bytes.data(), to.type, to.derivatives, to.bytes.data());
    return done ? std::optional<Value>(to) : std::nullopt;
  };
  EXPECT_EQ(convert(3, Value(Type(Base::float_)))->as<float>(), 3);
  EXPECT_EQ(convert(-3.7f, Value(Type(Base::int_)))->as<int>(), -3);
  EXPECT_EQ(convert(NAN, Value(Type(Base::int_)))->as<int>(), std::numeric_limits<int>::min());
  EXPECT_EQ(convert(2.0f, Value(Type(Base::normal)))->as<Triple>(), Triple(2));
  EXPECT_EQ(convert(color(1, 2, 3), Value(Type(Base::vector)))->as<Triple>(), Triple(1, 2, 3));
  EXPECT_EQ(convert(Value::array(Base::float_, std::vector<float>{4, 5}), Value(Type(Base::point)))->as<Triple>(),
            Triple(4, 5, 0));
  EXPECT_EQ(convert(5, Value(Type(Base::float_, 2)))->at<float>(1), 5);
  EXPECT_FALSE(convert(color(1, 2, 3), Value(Type(Base::float_))));
  EXPECT_FALSE(convert("text", Value(Type(Base::float_))));
  const auto d = convert(Dual<float>(1, 2, 3), Value(Type(Base::color), true));
  EXPECT_EQ(d->at<Triple>(2), Triple(3));
  EXPECT_EQ(convert(1.0f, Value(Type(Base::color), true))->at<Triple>(1), Triple(0));
}

}  // namespace etendue::osl::test
