// Texts in the Open Shading Language to typed trees: what is accepted, what is refused and where, and the bounds of both.

#include "osl/language/advice.h"
#include "osl/language/compile.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

namespace etendue::osl {
namespace {

Compiled compiled(const std::string& text) { return compile_text(text, "test.osl"); }

/// The errors of a body of a shader, one per line, without the file's name.
std::string errors_of(const std::string& text) {
  std::string all;
  for (const Diagnostic& d : compiled(text).diagnostics)
    if (!d.warning) all += std::to_string(d.place.line) + ":" + std::to_string(d.place.column) + " " + d.text + "\n";
  return all;
}
std::string errors_in(const std::string& body) {
  return errors_of("shader s(float a = 1, output float b = 2) {\n" + body + "\n}");
}

std::shared_ptr<const Shader> good(const std::string& text) {
  const Compiled c = compiled(text);
  EXPECT_TRUE(c.shader) << to_text(c.diagnostics);
  return c.shader;
}

/// The value of `x` in a body that declares it with a constant initial value.
template <class T>
T constant(const std::string& declaration) {
  const auto shader = good("shader s() { " + declaration + " }");
  if (!shader) return {};
  for (const auto& s : shader->symbols)
    if (s->name == "x" && s->initial && s->initial->kind == Expression::Kind::constant) return s->initial->constant.at<T>();
  ADD_FAILURE() << "no constant x in: " << declaration;
  return {};
}

/// The name of the row or function that is called to initialize `x`.
std::string called(const std::string& before, const std::string& declaration) {
  const auto shader = good(before + "\nshader s() { " + declaration + " }");
  if (!shader) return {};
  for (const auto& s : shader->symbols) {
    if (s->name != "x" || !s->initial) continue;
    const Expression* e = s->initial.get();
    while (e->kind == Expression::Kind::conversion) e = e->operands[0].get();
    if (e->kind == Expression::Kind::call) return e->function->result.name() + " " + e->function->parameters[0]->type.name();
    if (e->kind == Expression::Kind::library) return e->type.name();
  }
  return "none";
}

TEST(OslLanguage, ParametersHaveTypesDefaultsAndMetadata) {
  const auto shader = good(
      "surface plank [[ string help = \"wood\" ]] (\n"
      "  float ring = 0.25 [[ float min = 0, float max = 1, string label = \"Ring\" ]],\n"
      "  color tint = color(1, 0.5, 0),\n"
      "  string file = \"a\" \"b\",\n"
      "  int pattern[] = { 2, 4, 2 },\n"
      "  color dark = 0.25 * tint,\n"
      "  output float depth = 0) { depth = ring; Ci = tint * diffuse(N); }");
  ASSERT_TRUE(shader);
  EXPECT_EQ(shader->kind, Shader::Kind::surface);
  EXPECT_EQ(shader->name, "plank");
  EXPECT_EQ(shader->metadata.at(0).value.at<const String*>()->text(), "wood");
  ASSERT_EQ(shader->parameters.size(), 6u);
  const Symbol& ring = *shader->find_parameter("ring");
  EXPECT_EQ(ring.initial->constant.at<float>(), 0.25f);
  EXPECT_EQ(ring.find("max")->value.at<float>(), 1.0f);
  EXPECT_EQ(ring.find("label")->value.at<const String*>()->text(), "Ring");
  EXPECT_EQ(shader->find_parameter("tint")->initial->constant.at<float>(1), 0.5f);
  EXPECT_EQ(shader->find_parameter("file")->initial->constant.at<const String*>()->text(), "ab");
  EXPECT_EQ(shader->find_parameter("pattern")->type.array, Type::unsized);
  EXPECT_EQ(shader->find_parameter("pattern")->initial->type.array, 3);
  EXPECT_NE(shader->find_parameter("dark")->initial->kind, Expression::Kind::constant);
  EXPECT_EQ(shader->find_parameter("depth")->role, Symbol::Role::output);
  EXPECT_TRUE(shader->globals[int(Global::N)]);
  EXPECT_FALSE(shader->globals[int(Global::P)]);
  ASSERT_EQ(shader->shapes.size(), 1u);
  EXPECT_EQ(shader->shapes[0]->name->text(), "diffuse");
}

TEST(OslLanguage, ConstantsAreFolded) {
  EXPECT_EQ(constant<int>("int x = 7 / 2 + (1 << 4) - 7 % 4;"), 16);
  EXPECT_EQ(constant<int>("int x = 5 / 0;"), 0);
  EXPECT_EQ(constant<int>("int x = 0xffffffff;"), -1);
  EXPECT_EQ(constant<float>("float x = 1 / 4.0;"), 0.25f);
  EXPECT_EQ(constant<float>("float x = 1.0 / 0;"), 0.0f);
  EXPECT_EQ(constant<int>("int x = (int) -2.7;"), -2);
  EXPECT_EQ(constant<int>("int x = color(1, 2, 3) == color(1, 2, 4);"), 0);
  EXPECT_EQ(constant<int>("int x = \"a\" != \"b\" && !0;"), 1);
  EXPECT_EQ(constant<float>("float x = cos(0);"), 1.0f);
  EXPECT_EQ(constant<float>("float x = max(1, 2.5);"), 2.5f);
  EXPECT_EQ(constant<Triple>("color x = 0.5;"), Triple(0.5f));
  EXPECT_EQ(constant<Triple>("vector x = { 1, 2, 3 };"), Triple(1, 2, 3));
  EXPECT_EQ(constant<float>("float x = color(4, 5, 6)[1] + vector(1, 2, 3).z;"), 8.0f);
  EXPECT_EQ(constant<const String*>("string x = \"tab\\tquote\\\"\";")->text(), "tab\tquote\"");
  EXPECT_EQ(constant<float>("float x = 1.5e2;"), 150.0f);
  EXPECT_EQ(constant<float>("float x = M_PI;"), 3.14159265f);
}

TEST(OslLanguage, PrecedenceIsThatOfC) {
  EXPECT_EQ(constant<int>("int x = 1 + 2 * 3 << 1 == 14 & 1 ^ 2 | 4;"), 7);
  EXPECT_EQ(constant<int>("int x = 10 - 4 - 3;"), 3);
  EXPECT_EQ(constant<int>("int x = -2 * -3 - - 1;"), 7);
  EXPECT_EQ(constant<int>("int x = 1 or 0 and 0;"), 1);
  EXPECT_EQ(constant<int>("int x = not 0 and 3 > 2;"), 1);
}

TEST(OslLanguage, CallsMeanTheFunctionThatFitsBest) {
  const std::string f =
      "int f(int a, float b) { return 1; }\nfloat f(float a, float b) { return 1; }\nint f(color a, float b) { return 1; }\n";
  EXPECT_EQ(called(f, "float x = f(1, 1);"), "int int");
  EXPECT_EQ(called(f, "float x = f(1.0, 1);"), "float float");
  EXPECT_EQ(called(f, "float x = f(P, 1);"), "int color");
  // A point is rather a vector than a color.
  const std::string g = "int g(color c) { return 1; }\nint g(vector v) { return 1; }\n";
  EXPECT_EQ(called(g, "int x = g(P);"), "int vector");
  // By the result.
  const std::string h = "float h(int i) { return 1; }\ncolor h(int i) { return 1; }\nstring h(int i) { return \"\"; }\n";
  EXPECT_EQ(called(h, "color x = h(1);"), "color int");
  EXPECT_EQ(called(h, "string x = h(1);"), "string int");
  EXPECT_EQ(called("", "color x = noise(P);"), "color");
  EXPECT_EQ(called("", "float x = noise(P);"), "float");
  EXPECT_EQ(called("", "vector x = (vector) noise(P, u);"), "vector");
  // In an inner scope and behind the declaration only.
  EXPECT_EQ(errors_of("shader s() { { float f(float q) { return q; } } float y = f(1); }"), "1:59 there is no function 'f'\n");
}

TEST(OslLanguage, FunctionsAreCheckedForEachLengthOfArrays) {
  const auto shader = good(
      "float sum(float x[]) { float s = 0; for (int i = 0; i < arraylength(x); ++i) s += x[i]; return s; }\n"
      "shader s(float p[] = { 1, 2 }) { float a[3] = { 1, 2, 3 }; float b = sum(a) + sum({ 1, 2, 3, 4 }) + sum(p) + sum(a); }");
  ASSERT_TRUE(shader);
  std::vector<int> lengths;
  for (const auto& f : shader->functions) lengths.push_back(f->parameters[0]->type.array);
  std::sort(lengths.begin(), lengths.end());
  EXPECT_EQ(lengths, (std::vector<int>{Type::unsized, 3, 4}));
  for (std::size_t i = 0; i < shader->symbols.size(); ++i) EXPECT_EQ(shader->symbols[i]->index, int(i));
}

TEST(OslLanguage, StructuresHaveConstructorsListsAndOperators) {
  const auto shader = good(
      "struct rgba { color rgb; float a; };\n"
      "rgba __operator__add__(rgba x, rgba y) { return { x.rgb + y.rgb, x.a + y.a }; }\n"
      "shader s(rgba in = { { 1, 2, 3 + u }, 4 }) {\n"
      "  rgba c = rgba(color(1), 2) + in; c.rgb.r = 3; c += in; rgba d[2] = { { 1, 2 }, c }; d[1].a = 4; }");
  ASSERT_TRUE(shader);
  EXPECT_EQ(shader->functions.size(), 1u);
  EXPECT_EQ(errors_of("struct t { float a; float a; }; shader s() {}"), "1:27 the structure has two fields 'a'\n");
  EXPECT_EQ(errors_of("struct t { float a; }; shader s() { t v; v.b = 1; }"),
            "1:43 the structure 't' has no field 'b' (did you mean 'a'?)\n");
}

TEST(OslLanguage, ErrorsHaveTheirPlaces) {
  EXPECT_EQ(errors_in("int i = 1.5;"), "2:9 i: 'int' cannot take a value of type 'float'\n");
  EXPECT_EQ(errors_in("a = 2;"), "2:1 'a' cannot be written: it is a parameter without 'output'\n");
  EXPECT_EQ(errors_in("float depth = 1; b = dpth;"), "2:22 'dpth' was not declared (did you mean 'depth'?)\n");
  EXPECT_EQ(errors_in("b = missing(3);"), "2:5 there is no function 'missing'\n");
  EXPECT_EQ(errors_in("break;"), "2:1 'break' stands outside of a loop\n");
  EXPECT_EQ(errors_in("return 1;"), "2:1 a shader returns no value\n");
  EXPECT_EQ(errors_in("float f = 1.0f;"), "2:11 '1.0f' is no number of this language: 'f' behind it is too much\n");
  EXPECT_EQ(errors_in("float z[1000000000];"), "2:9 the length 1000000000 of the array 'z' is not between 1 and 1000000\n");
  EXPECT_EQ(errors_in("matrix m = 1; m = m + m;"), "2:21 there is no '+' of 'matrix' and 'matrix'\n");
  EXPECT_EQ(errors_in("Ci = color(1);"), "2:12 Ci: 'closure color' cannot take a value of type 'color'\n");
  EXPECT_EQ(errors_in("float while = 1;"), "2:7 'while' is a word of the language and cannot be a name\n");
  EXPECT_EQ(errors_of("shader s(float a) {}"), "1:16 the parameter 'a' has no default\n");
  // Several in one run.
  EXPECT_EQ(errors_in("int i = 1.5;\nstring t = 3;\nfloat q = u +;"),
            "4:14 a value is expected here, not ';'\n2:9 i: 'int' cannot take a value of type 'float'\n"
            "3:12 t: 'string' cannot take a value of type 'int'\n");
}

TEST(OslLanguage, RecursionIsRefused) {
  EXPECT_EQ(
      errors_of("int g(int i);\nint f(int i) { return g(i); }\nint g(int i) { return f(i); }\nshader s() { int k = f(3); }"),
      "3:23 the function 'f' calls itself: recursion is not part of the language\n");
  EXPECT_EQ(errors_of("int f(int i) { return i * f(i - 1); }\nshader s() { int k = f(3); }"),
            "1:27 the function 'f' calls itself: recursion is not part of the language\n");
  const std::string overloaded = errors_of("int f(color c) { return 1; }\nint f(string i) { return f(1, 2); }\nshader s() { }");
  EXPECT_NE(overloaded.find("'f' itself cannot be called here: recursion is not part of the language"), std::string::npos)
      << overloaded;
  // A function of the library's name calls the library's.
  EXPECT_TRUE(good("point abs(point p) { return abs(p); }\nshader s() { point q = abs(P); }"));
}

TEST(OslLanguage, TheExtensionForSpectra) {
  const auto shader = good(
      "surface s() { spectrum n = spectrum(\"metal Au\"); spectrum r = 1 / (1 + n * n) * wavelength(); Ci = r * diffuse(N); }");
  ASSERT_TRUE(shader);
  EXPECT_FALSE(errors_of("surface s() { spectrum n = 1; color c = n; }").empty());
}

// ---- derivatives

std::string derivatives_of(const std::string& text) {
  const auto shader = good(text);
  std::string names;
  if (shader)
    for (const auto& s : shader->symbols)
      if (s->needs_derivatives) names += s->name + " ";
  return names;
}

TEST(OslLanguage, OnlyWhatIsTakenHasDerivatives) {
  EXPECT_EQ(derivatives_of("shader s() { float a = u, b = v; float c = sin(a) + b; }"), "");
  EXPECT_EQ(derivatives_of("shader s() { float a = u, b = v; float c = Dx(sin(a)); }"), "a u ");
  // Through functions, outputs of functions, and what is assigned later.
  EXPECT_EQ(
      derivatives_of(
          "void f(float x, output float y) { y = x; }\nshader s() { float a, b = v; f(b, a); float c = filterwidth(a); }"),
      "x y a b v ");
  EXPECT_EQ(derivatives_of("shader s() { float a = 1; int i = (int) v; a += u * i; float c = Dy(a); }"), "a u ");
  EXPECT_EQ(derivatives_of("shader s() { float a = noise(\"perlin\", u); }"), "");
  EXPECT_EQ(derivatives_of("shader s() { float a = noise(\"gabor\", P); }"), "P ");
  const auto shader = good("shader s(output float o = 0) { o = u * 2; }");
  EXPECT_EQ(find_derivatives(*shader), std::vector<bool>(shader->symbols.size(), false));
  const Symbol* wanted[] = {shader->find_parameter("o")};
  EXPECT_EQ(find_derivatives(*shader, wanted), std::vector<bool>(shader->symbols.size(), true));
}

// ---- the preprocessor

TEST(OslPreprocessor, IncludesComeFromAllowedFoldersOnly) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "etendue_osl_includes";
  std::filesystem::create_directories(folder / "inside");
  std::filesystem::create_directories(folder / "library");
  const auto write = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
  write("inside/own.h", "#define OWN 1\n");
  write("library/shared.h", "#define SHARED 2\n");
  write("outside.h", "#define OUTSIDE 3\n");
  const auto failed = [&](const std::string& include, bool library) {
    const std::string path = (folder / "inside" / "s.osl").string();
    CompileOptions options;
    if (library) options.include_folders.push_back((folder / "library").string());
    return to_text(compile_text("#include " + include + "\nshader s() {}", path, options).diagnostics);
  };
  EXPECT_EQ(failed("\"own.h\"", false), "");
  EXPECT_EQ(failed("<shared.h>", true), "");
  EXPECT_EQ(failed("\"../library/shared.h\"", true), "");
  EXPECT_EQ(failed("\"stdosl.h\"", false), "");
  EXPECT_NE(failed("<shared.h>", false).find("there is no such file"), std::string::npos);
  EXPECT_NE(failed("\"../outside.h\"", true).find("outside the shader's folder"), std::string::npos);
  EXPECT_NE(failed("\"/dev/zero\"", false).find("not a regular file"), std::string::npos);
  EXPECT_NE(failed("\"/etc/passwd\"", false).find("outside the shader's folder"), std::string::npos);
  EXPECT_NE(failed("\"missing.h\"\n", false).find("s.osl:1:"), std::string::npos) << failed("\"missing.h\"", false);
  // An error in an included file has its place there.
  write("inside/wrong.h", "\nint wrong = ;\n");
  EXPECT_NE(failed("\"wrong.h\"", false).find("wrong.h:2:"), std::string::npos) << failed("\"wrong.h\"", false);
  std::filesystem::remove_all(folder);
}

TEST(OslPreprocessor, MacrosAndConditionals) {
  EXPECT_EQ(
      constant<int>("\n#define TWICE(a) ((a) * 2)\n#if OSL_VERSION >= 11000 && defined(M_PI)\nint x = TWICE(3);\n#endif\n"), 6);
  EXPECT_EQ(constant<int>("\n#define GLUE(a, b) a##b\nint GLUE(x, ) = 4;\n"), 4);
  EXPECT_NE(errors_of("#error no\nshader s() {}").find("no"), std::string::npos);
  EXPECT_EQ(errors_of("float f() { return 1; }\n\n  #include <missing.h>\nshader s() {}").substr(0, 2), "3:");
}

TEST(OslPreprocessor, BlanksAroundArgumentsAreNoPartOfThem) {
  const std::string macros = "\n#define TEXT(a, b) #a #b\n#define INNER(f, a) TEXT(f(a),   a)\n#define ALL(...) #__VA_ARGS__\n";
  EXPECT_EQ(constant<const String*>(macros + "string x = TEXT( p  q , r);\n")->view(), "p qr");
  EXPECT_EQ(constant<const String*>(macros + "string x = INNER( g,  h (1) );\n")->view(), "g(h (1))h (1)");
  EXPECT_EQ(constant<const String*>(macros + "string x = ALL( a, b );\n")->view(), "a, b");
}

TEST(OslPreprocessor, HeadersOfOurOwnStandInForMissingOnes) {
  for (const char* type : {"color2", "vector2", "color4", "vector4"}) {
    const std::string t = type;
    const std::string value = t == "color4" ? "color(1), 2" : (t == "vector4" ? "1, 2, 3, 4" : "1, 2");
    good("#include <" + t + ".h>\n#include \"" + t + ".h\"\nshader s() { " + t + " a = " + t + "(" + value +
         "), b = 2 * -a + a / 2.0; if (a != b) b = clamp(pow(min(a, 1), b), 0, 1); }");
  }
  good("#include \"matrix33.h\"\nshader s() { matrix33 m = 2 * matrix44To33(matrix(1)); vector v = transform(m, vector(1)); }");
  EXPECT_EQ(errors_of("#include \"oslutil.h\"\nshader s() {\n float x = wireframe();\n}").substr(0, 2), "3:");
  // A file of the name has precedence.
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "etendue_osl_own_header";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "color2.h") << "struct color2 { float grey; };\n";
  const std::string text = "#include \"color2.h\"\nshader s() { color2 c = color2(1); float x = c.grey; }";
  EXPECT_EQ(to_text(compile_text(text, (folder / "s.osl").string()).diagnostics), "");
  std::filesystem::remove_all(folder);
}

// ---- hostile texts

TEST(OslHostile, WhatNestsTooDeeplyIsRefused) {
  const int n = 3000;
  const auto repeat = [&](const std::string& part) {
    std::string all;
    for (int i = 0; i < n; ++i) all += part;
    return all;
  };
  for (const std::string& body :
       {"float x = " + repeat("(") + "1" + repeat(")") + ";", repeat("{") + repeat("}"), "float x = " + repeat("- ") + "1;",
        "float x = 1" + repeat("+u") + ";", "float x = " + repeat("u ? 1 : ") + "1;", repeat("if (u > 0) ; else ") + ";",
        "float x = P" + repeat("[0]") + ";", repeat("while (1) ") + ";", "float x[3] = " + repeat("{") + repeat("}") + ";",
        "float x = " + repeat("sin(") + "1" + repeat(")") + ";"})
    EXPECT_FALSE(errors_in(body).empty()) << body.substr(0, 40);
  EXPECT_FALSE(errors_of("#if " + repeat("(") + "1" + repeat(")") + "\n#endif\nshader s() {}").empty());
}

TEST(OslHostile, ExpandingMacrosEnd) {
  std::string text = "#define A0 1 1 1 1 1 1 1 1\n";
  for (int i = 1; i < 12; ++i) {
    const std::string p = "A" + std::to_string(i - 1);
    text += "#define A" + std::to_string(i);
    for (int k = 0; k < 8; ++k) text += " " + p;
    text += "\n";
  }
  EXPECT_NE(errors_of(text + "shader s() { A11 }").find("macros expand"), std::string::npos);
}

TEST(OslHostile, LargeShadersCompile) {
  std::string text = "shader s(";
  for (int i = 0; i < 9999; ++i) text += "float p" + std::to_string(i) + " = " + std::to_string(i) + ", ";
  const auto shader = good(text + "output float o = 0) { o = p7; }");
  ASSERT_TRUE(shader);
  EXPECT_EQ(shader->parameters.size(), 10000u);
}

/// Shaders with parts that are exchanged, doubled or dropped are compiled or refused with a place in the text.
TEST(OslHostile, MutantsAreCompiledOrRefused) {
  const std::string text =
      "#define SQ(x) ((x) * (x))\nstruct pair { float a; color c[2]; };\n"
      "float f(float x[], output float y) { y += x[1]; return arraylength(x) > 2 ? x[0] : SQ(y); }\n"
      "surface s [[ string help = \"h\" ]] (float k = 0.5 [[ float min = 0 ]], int n[] = { 1, 2 }, pair p = { 1, { 2, 3 } },\n"
      "  output color o = color(\"hsv\", 0.1, k, 1)) {\n"
      "  float a[3] = { 1, k, u * 2 }, w = 0, q = f(a, w);\n  matrix m = matrix(\"world\", 1); m[0][1] += 2;\n"
      "  for (int i = 0; i < 3; ++i) { if (i == 2) continue; else break; o.r += a[i] ? 1 : 2; }\n"
      "  while (q > 0) q--; do { q += Dx(noise(\"gabor\", P, \"anisotropic\", 1)); } while (q < 1 && !n[0]);\n"
      "  Ci = k * diffuse(N, \"label\", \"x\") + (1 - k) * microfacet(\"ggx\", N, dPdu, k, k, 1.5, 0);\n"
      "  printf(\"%g %s\\n\", q, format(\"%d\", n[1])); normal z = normalize(transform(\"object\", N)); }\n";
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i + 1;
    while (end < text.size() && std::isalnum(static_cast<unsigned char>(text[i])) &&
           std::isalnum(static_cast<unsigned char>(text[end])))
      ++end;
    parts.push_back(text.substr(i, end - i));
    i = end;
  }
  std::mt19937 random(7);
  const auto pick = [&](std::size_t n) { return std::size_t(random() % n); };
  EXPECT_EQ(to_text(compiled(text).diagnostics), "");
  for (int round = 0; round < 500; ++round) {
    std::vector<std::string> mutant = parts;
    for (std::size_t changes = 1 + pick(3); changes > 0; --changes) {
      const std::size_t at = pick(mutant.size());
      switch (pick(4)) {
        case 0: mutant.erase(mutant.begin() + std::ptrdiff_t(at)); break;
        case 1: mutant[at] = parts[pick(parts.size())]; break;
        case 2: mutant.insert(mutant.begin() + std::ptrdiff_t(at), parts[pick(parts.size())]); break;
        default: std::swap(mutant[at], mutant[pick(mutant.size())]);
      }
    }
    std::string all;
    for (const std::string& part : mutant) all += part;
    const Compiled c = compiled(all);
    ASSERT_TRUE(c.shader || !c.diagnostics.empty()) << all;
  }
}

/// The advice on a shader's text, a line each.
std::string advice_on(const std::string& text) {
  const Compiled c = compile_text(text, "test.osl");
  EXPECT_FALSE(c.failed()) << to_text(c.diagnostics);
  return c.failed() ? "" : to_text(advice(*c.shader));
}

TEST(OslAdvice, OnWhatNothingReads) {
  EXPECT_EQ(advice_on("surface s(float a = 1, float b = 2, float c = 3) {\n float x = a;\n float y;\n Ci = diffuse(N); }"),
            "test.osl:1:30: warning: nothing reads the parameters 'b', 'c'\n"
            "test.osl:2:8: warning: 'x' is given a value, but nothing reads it\n"
            "test.osl:3:8: warning: 'y' is never used\n");
}

TEST(OslAdvice, OnWhatHasNoValueYet) {
  EXPECT_EQ(advice_on("surface s() {\n float x;\n Ci = x * diffuse(N); }"), "test.osl:3:7: warning: 'x' has no value yet\n");
  EXPECT_EQ(advice_on("surface s() {\n float x;\n for (int i = 0; i < 3; ++i) { x += i; }\n Ci = x * diffuse(N); }"),
            "test.osl:3:32: warning: 'x' has no value yet\n");
}

TEST(OslAdvice, IsSilentOnWhatIsRight) {
  EXPECT_EQ(advice_on("void both(float k, output float a, output float b) { a = k; b = k + a; }\n"
                      "surface s(float k = 1, output color c = 0) { float x, y, list[2]; both(k, x, y);\n"
                      "  for (int i = 0; i < 2; ++i) list[i] = x + y;\n"
                      "  float z; if (x > 1) z = 1; else z = 2;\n"
                      "  float s1, c1; sincos(z, s1, c1); int found; float r; found = getattribute(\"a\", r);\n"
                      "  do { z += 1; } while (z < 3);\n"
                      "  c = color(list[0], s1 + c1, found ? r : z); Ci = c * diffuse(N); }"),
            "");
}

}  // namespace
}  // namespace etendue::osl
