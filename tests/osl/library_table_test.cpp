// The table of the shading language's library as a whole: each row has code, which takes any values.

#include <random>
#include <set>

#include "call_library.h"

namespace etendue::osl::test {

namespace {

/// A parameter of a signature.
struct Parameter {
  std::string type;
  bool output = false, array = false, more = false;
};

struct Signature {
  std::string result;
  std::vector<Parameter> parameters;

  explicit Signature(std::string_view text) {
    const std::size_t open = text.find('(');
    const std::string_view head = text.substr(0, open);
    result = head.substr(0, head.rfind(' '));
    std::string_view list = text.substr(open + 1, text.size() - open - 2);
    while (!list.empty()) {
      const std::size_t comma = std::min(list.find(','), list.size());
      std::string_view one = list.substr(0, comma);
      list.remove_prefix(std::min(comma + 2, list.size()));
      Parameter p;
      if (one.starts_with("output ")) p.output = true, one.remove_prefix(7);
      p.more = one == "...";
      p.array = one.ends_with("[]");
      p.type = one.starts_with("closure color") ? "closure" : one.substr(0, one.find(' '));
      parameters.push_back(p);
    }
  }
  bool uses(std::string_view type) const {
    return result == type ||
           std::any_of(parameters.begin(), parameters.end(), [&](const Parameter& p) { return p.type == type; });
  }
};

/// Calls rows with values of all kinds, among which are the worst.
class Caller {
 public:
  explicit Caller(unsigned seed) : random_(seed) {}

  Type type(std::string_view name, const Type& family) {
    if (name == "TYPE" || name == "TRIPLE" || name == "PTYPE") return family;
    if (name == "ANY")
      return std::array{Type(Base::float_), Type(Base::color), Type(Base::string), Type(Base::int_, 3)}[random_() % 4];
    if (name.starts_with("closure")) return Type::closure_color();
    for (const Base b : {Base::void_, Base::int_, Base::float_, Base::color, Base::point, Base::vector, Base::normal,
                         Base::matrix, Base::string, Base::spectrum})
      if (Type(b).name() == name) return b;
    ADD_FAILURE() << "no type " << name;
    return {};
  }

  Value value(const Type& t) {
    Value v(t, t.float_based() && random_() % 2);
    if (t.base == Base::string)
      for (int i = 0; i < t.elements(); ++i) reinterpret_cast<const String**>(v.bytes.data())[i] = intern_string(text());
    else if (t.base == Base::int_)
      for (int i = 0; i < t.elements(); ++i) reinterpret_cast<int*>(v.bytes.data())[i] = integer();
    else if (t.float_based())
      for (std::size_t i = 0; i < v.bytes.size() / sizeof(float); ++i) reinterpret_cast<float*>(v.bytes.data())[i] = number();
    return v;
  }

  /// Returns false if the row's derivatives, which are said to be zero, are not.
  bool call(const Row& row, const Signature& s, const Type& family) {
    std::vector<Value> arguments;
    CallTypes types;
    for (const Parameter& p : s.parameters) {
      if (p.more) {
        for (unsigned n = random_() % 6; n > 0; --n)
          arguments.push_back(value(more(s.parameters[s.parameters.size() - 2], family)));
      } else {
        const Type t = type(p.type, family);
        arguments.push_back(value(p.array ? t.as_array(1 + int(random_() % 8)) : t));
      }
    }
    Type result = type(s.result, family);
    Value out(result, result.float_based() && random_() % 2);
    types.result = {result, out.derivatives};
    std::vector<void*> addresses;
    for (Value& v : arguments) {
      types.arguments.push_back({v.type, v.derivatives});
      addresses.push_back(v.bytes.data());
    }
    row.choose(types)({addresses.data(), out.bytes.data(), types, world});
    if (row.derivatives == Derivatives::none && out.derivatives)
      for (std::size_t i = out.bytes.size() / 3 / sizeof(float); i < out.bytes.size() / sizeof(float); ++i)
        if (out.at<float>(i) != 0) return false;
    return true;
  }

  World world;

 private:
  Type more(const Parameter& last, const Type& family) {
    if (last.type == "TYPE") return random_() % 4 ? family : Type(Base::int_);
    return std::array{Type(Base::string), Type(Base::string), Type(Base::float_), Type(Base::int_),
                      Type(Base::color)}[random_() % 5];
  }
  float number() {
    constexpr float special[] = {0,   -0.0f, 1,   -1, 1e-40f, 1e38f, -1e38f, std::numeric_limits<float>::infinity(),
                                 NAN, 0.5f,  3e9f};
    return random_() % 3 ? float(random_() % 2000) * 0.01f - 10 : special[random_() % std::size(special)];
  }
  int integer() {
    constexpr int special[] = {0, -1, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()};
    return random_() % 3 ? int(random_() % 20) - 5 : special[random_() % std::size(special)];
  }
  std::string text() {
    constexpr const char* texts[] = {
        "",         "common",    "shader",           "nowhere", "hsv",    "xyY",      "ACEScg",
        "perlin",   "gabor",     "simplex",          "hash",    "bezier", "constant", "linear",
        "%d %s %g", "%",         "%999.999f%-+ #0x", "blur",    "alpha",  "swrap",    "anisotropic",
        "impulses", "do_filter", "(a*)*b",           "[",       "12",     "-1e99",    "cm",
        "frames",   "a b c"};
    return texts[random_() % std::size(texts)];
  }

  std::mt19937 random_;
};

}  // namespace

TEST(OslTable, HasEachSignatureOnceWithCode) {
  std::set<std::string> seen;
  for (const Row& row : library_rows()) {
    EXPECT_TRUE(seen.insert(row.signature).second) << row.signature;
    const std::string_view s = row.signature;
    const bool language = s.find(" isconnected(") != s.npos || s.find(" isconstant(") != s.npos || s.find(" exit(") != s.npos;
    EXPECT_EQ(row.choose == nullptr, row.refused || language) << row.signature;
    if (row.refused || language) EXPECT_FALSE(row.pure) << row.signature;
  }
  EXPECT_GT(seen.size(), 200u);
}

TEST(OslTable, EachRowTakesAnyValues) {
  Caller caller(7);
  for (const Row& row : library_rows()) {
    if (!row.choose) continue;
    const Signature s(row.signature);
    std::vector<Type> families{Base::float_};
    if (s.uses("TYPE")) families = {Base::float_, Base::color, Base::point, Base::vector, Base::normal};
    if (s.uses("TRIPLE")) families = {Base::color, Base::normal};
    if (s.uses("PTYPE")) families = {Base::point, Base::vector, Base::normal};
    for (const Type& family : families)
      for (int i = 0; i < 50; ++i) EXPECT_TRUE(caller.call(row, s, family)) << row.signature;
  }
}

}  // namespace etendue::osl::test
