#include "draw.h"

#include <cmath>

#include "describe/guard.h"
#include "etendue/core/transform.h"
#include "etendue/describe/color.h"
#include "etendue/language/language.h"
#include "etendue/scene.h"
#include "shader_trial.h"

namespace etendue::conform {
namespace {

class Drawer {
 public:
  Drawer(const Fixtures& fixtures, std::mt19937_64& random) : fixtures_(&fixtures), random_(&random) {}

  /// A component with defaults, not prepared.
  Ref<Component> with_defaults(const ClassInfo& info, bool fill_lists, bool with_files) {
    const Ref<Component> c = create(info);
    for (const Member& m : info.members) {
      if (m.required && m.kind == Kind::component)
        set(*c, m.name, m.list ? component_list(m, 2) : component_for(m, 2));
      else if (m.kind == Kind::file && (m.required || with_files))
        set_file(*c, info, m);
      else if (fill_lists && m.list)
        if (const Value v = sample_list(m); !v.none()) set(*c, m.name, v);
    }
    return c;
  }

  Ref<Component> with_random(const ClassInfo& info, int depth, double change) {
    const Ref<Component> c = create(info);
    for (const Member& m : info.members) {
      if (!m.required && !(uniform() < change)) continue;
      if (m.kind == Kind::file) {
        set_file(*c, info, m);
      } else if (m.list) {
        if (m.kind == Kind::component) set(*c, m.name, component_list(m, depth));
      } else if (const Value v = value_for(m, depth); !v.none()) {
        set(*c, m.name, v);
      }
    }
    return c;
  }

  /// A random value for any member, including lists of any length.
  Value any_value(const ClassInfo& info, const Member& m) {
    if (m.kind == Kind::file) {
      const std::string path = fixtures_->file_for(info, m);
      return path.empty() || m.list ? Value() : Value(FilePath{path, ""});
    }
    if (m.kind == Kind::string && !m.choices.empty() && !m.list) return Value(m.choices[index(m.choices.size())]);
    if (!m.list) return value_for(m, 1);
    if (m.kind == Kind::component) return component_list(m, 1);
    Numbers n;
    n.width = m.kind == Kind::vector2 ? 2 : m.kind == Kind::integer || m.kind == Kind::number ? 1 : 3;
    for (size_t i = size_t(n.width) * (1 + index(4)); i > 0; --i)
      n.values.push_back(m.kind == Kind::integer ? whole_number(m) : number(m, plain_default(m, 0)));
    return m.kind == Kind::string ? Value() : Value(std::move(n));
  }

 private:
  double uniform() { return double((*random_)() >> 11) * 0x1p-53; }
  double between(double a, double b) { return a + (b - a) * uniform(); }
  bool coin(double probability) { return uniform() < probability; }
  size_t index(size_t count) { return std::min(size_t(uniform() * double(count)), count - 1); }

  void set_file(Component& c, const ClassInfo& info, const Member& m) {
    const std::string path = fixtures_->file_for(info, m);
    if (!path.empty()) set(c, m.name, Value(FilePath{path, ""}));
  }

  /// Values for lists that must match each other: a square of two triangles.
  static Value sample_list(const Member& m) {
    if (m.kind == Kind::point3) return Value(Numbers{{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3, Dimension::none});
    if (m.kind == Kind::integer && m.name == "triangles") return Value(Numbers{{0, 1, 2, 0, 2, 3}, 3, Dimension::none});
    return {};
  }

  Value value_for(const Member& m, int depth) {
    switch (m.kind) {
      case Kind::boolean: return Value(coin(0.5));
      case Kind::integer: return Value(Number{whole_number(m)});
      case Kind::number: return Value(Number{number(m, plain_default(m, 0))});
      case Kind::choice: return Value(m.choices[index(m.choices.size())]);
      case Kind::vector2: return Value(vector(m, 2));
      case Kind::vector3:
      case Kind::point3: return Value(vector(m, 3));
      case Kind::normal3: return Value(Numbers{{between(-1, 1), between(-1, 1), between(0.2, 1)}, 1, Dimension::none});
      case Kind::color: return Value(color(m));
      case Kind::transform: return Value(transform());
      case Kind::component: return component_for(m, depth);
      case Kind::string:
      case Kind::file: return {};  // the valid values are not known
    }
    return {};
  }

  /// A member's default in its own unit, or one entry of it.
  static double plain_default(const Member& m, size_t entry) {
    const Unit* unit = find_unit(m.unit);
    const double factor = unit ? unit->factor : 1;
    if (const auto* n = m.default_value.as<Number>()) return n->value / (n->dimension == Dimension::none ? 1 : factor);
    if (const auto* n = m.default_value.as<Numbers>(); n && entry < n->values.size())
      return n->values[entry] / (n->dimension == Dimension::none ? 1 : factor);
    return 0;
  }

  double number(const Member& m, double by_default) {
    const Range r = m.range.value_or(Range{});
    const double low = r.open_low ? std::nextafter(float(r.low), infinity) : r.low;
    if (std::isfinite(r.low) && std::isfinite(r.high)) {
      const double kind = uniform();
      if (kind < 0.08 && !r.open_low) return r.low;
      if (kind < 0.16) return r.high;
      // Wide ranges of positive numbers are sampled by order of magnitude.
      const double least = std::max(low, std::max(std::abs(by_default), r.high * 1e-4) / 100);
      if (r.low >= 0 && (kind < 0.4 || r.high > 1000 * std::max(by_default, 1e-3)))
        return std::clamp(double(float(least * std::pow(r.high / least, uniform()))), low, r.high);
      return std::clamp(double(float(between(low, r.high))), low, r.high);
    }
    const double scale = by_default != 0 ? std::abs(by_default) : 1;
    const double size = scale * std::exp(between(-1.5, 1.5));
    if (std::isfinite(r.low)) return coin(0.1) && !r.open_low ? r.low : std::max(low, double(float(r.low + size)));
    if (std::isfinite(r.high)) return double(float(r.high - size));
    return double(float((by_default != 0 ? std::copysign(1.0, by_default) : (coin(0.5) ? 1.0 : -1.0)) * size));
  }

  /// A small integer: many members determine the amount of memory or work.
  double whole_number(const Member& m) {
    const double by_default = plain_default(m, 0), low = m.range ? std::max(m.range->low, -8.0) : -8;
    const double high = std::min(m.range ? m.range->high : 32, std::max(low + 32, 2 * by_default));
    const double x = coin(0.15) ? low : std::floor(between(low, high + 1));
    return std::clamp(x, m.range && m.range->open_low ? low + 1 : low, high);
  }

  Numbers vector(const Member& m, size_t entries) {
    Numbers n;
    for (size_t i = 0; i < entries; ++i) {
      const double by_default = plain_default(m, i);
      double x = double(float(by_default + between(-1, 1) * (1 + std::abs(by_default))));
      if (m.range) x = std::clamp(x, std::max(m.range->low, -1e6), std::min(m.range->high, 1e6));
      n.values.push_back(x);
    }
    return n;
  }

  /// Indices remain indices and reflectances remain reflectances, judged by the default. The class may reject the colour.
  Color color(const Member& m) {
    const auto* given = m.default_value.as<Color>();
    const Color by_default = given ? *given : nullptr;
    if (by_default && by_default->imaginary()) {
      const std::vector<std::string> names = metal_names();
      if (coin(0.5)) return metal_index(names[index(names.size())]);
      return complex_index(flat_spectrum(float(between(0.1, 4))), flat_spectrum(float(between(0, 8))));
    }
    const float middle = by_default ? by_default->at(550, ColorUse::coefficient) : 0;
    if (middle > 1.05f) {
      const std::vector<std::string> names = glass_names();
      if (coin(0.4)) return glass_index(names[index(names.size())]);
      return flat_spectrum(float(coin(0.9) ? between(1.05, 2.5) : between(0.6, 1)));
    }
    const double kind = uniform();
    if (kind < 0.05) return flat_spectrum(coin(0.5) ? 0.0f : 1.0f);
    if (kind < 0.1) return flat_spectrum(float(between(-0.5, 3)));  // often rejected by the class, as it should be
    if (kind < 0.4) return flat_spectrum(float(uniform()));
    if (kind < 0.7) return rgb_color("srgb", uniform(), uniform(), uniform());
    return table_spectrum({400, 500, 600, 700}, {float(uniform()), float(uniform()), float(uniform()), float(uniform())});
  }

  Transform transform() {
    const auto entry = [&](double size) { return float(between(-size, size)); };
    Transform t = Transform::translate({entry(2), entry(2), entry(2)});
    if (coin(0.7)) t = t * Transform::rotate(entry(3), {entry(1), entry(1), 1.5f});
    if (coin(0.5)) {
      const auto s = float(std::exp(between(-1, 1)));
      t = t * Transform::scale(coin(0.5) ? Vector3{s, s, s} : Vector3{s, 1, coin(0.3) ? -s : s});
    }
    return t;
  }

  /// The classes to choose from for a member's interface. No plugin's class, whose faults would be attributed to the component
  /// under test, unless there is no other; and no scenes inside scenes.
  static std::vector<const ClassInfo*> candidates(const Member& m) {
    const Registry& registry = Registry::instance();
    const ClassInfo* wanted = registry.find(m.component_class);
    const ClassInfo* scene = registry.find("Scene");
    std::vector<const ClassInfo*> all = registry.subclasses(*wanted), own;
    for (const ClassInfo* c : all)
      if (c->provider.empty() && (wanted == scene || !c->is_a(*scene))) own.push_back(c);
    return own.empty() ? all : own;
  }

  Value component_for(const Member& m, int depth) {
    const bool optional = m.default_value.none() && !m.required;
    if (optional && coin(depth > 1 ? 0.9 : 0.6)) return {};
    if (m.component_class == "ObjectMap" && (depth > 1 || coin(0.5))) return Value(Number{uniform()});
    const std::vector<const ClassInfo*> classes = candidates(m);
    if (classes.empty()) return {};
    const ClassInfo& info = *classes[index(classes.size())];
    return Value(made(info, depth));
  }

  Value component_list(const Member& m, int depth) {
    Value::List list;
    const std::vector<const ClassInfo*> classes = candidates(m);
    if (!classes.empty())
      for (size_t n = index(4); n > 0; --n) {
        const Ref<Component> part = made(*classes[index(classes.size())], depth);
        // Default discs and rings would be coplanar and overlap, so that rays hit both at the same distance.
        if (dynamic_cast<SceneObject*>(part.get()) && depth > 1)
          set(*part, "transform", Value(AnimatedTransform(Transform::translate(float(n) * Vector3{0.11f, -0.07f, 0.13f}))));
        list.emplace_back(part);
      }
    return Value(std::move(list));
  }

  Ref<Component> made(const ClassInfo& info, int depth) {
    return depth > 1 ? with_defaults(info, true, true) : with_random(info, depth + 1, 0.5);
  }

  const Fixtures* fixtures_;
  std::mt19937_64* random_;
};

/// Creates and prepares a component, and a second one parsed from the first one's text. The second is the one to be tested if
/// all succeeds.
template <class F>
Drawn finished(F&& make) {
  Drawn drawn;
  try {
    const Ref<Component> part = make();
    drawn.text = write_description(*part);
    prepare_tree(*part);
    drawn.part = part;
    const Ref<Component> read = parse_component(drawn.text, "drawn");
    prepare_tree(*read);
    drawn.part = read;
  } catch (const Error& error) {
    drawn.refused = error.what();
  } catch (const Errors& errors) {
    drawn.refused = errors.what();
  } catch (...) {  // a component may throw anything
    drawn.refused = thrown_text();
    drawn.part = {};
  }
  return drawn;
}

}  // namespace

Drawn default_part(const ClassInfo& info, const Fixtures& fixtures, std::mt19937_64& random) {
  Drawer drawer(fixtures, random);
  Drawn first;
  // Required components are random and may be rejected, hence several tries.
  for (int i = 0; i < 8; ++i)
    for (const auto& [lists, files] : {std::pair(false, false), {true, false}, {false, true}}) {
      const Drawn drawn = finished([&, l = lists, f = files] { return drawer.with_defaults(info, l, f); });
      if (drawn.part) return drawn;
      if (first.refused.empty()) first = drawn;
    }
  return first;
}

Value draw_value(const ClassInfo& info, const Member& m, const Fixtures& fixtures, std::mt19937_64& random) {
  try {
    return Drawer(fixtures, random).any_value(info, m);
  } catch (const Error&) {
    return {};  // the class rejects a component that was drawn for the member
  }
}

Drawn part_with_files(const ClassInfo& info, const Fixtures& fixtures, std::mt19937_64& random) {
  Drawer drawer(fixtures, random);
  return finished([&] { return drawer.with_defaults(info, false, true); });
}

namespace {

/// Whether the emission emits from simple objects. Computing its power throws for objects from which it emits nothing, which
/// says nothing about the class. True for other components.
bool emits(const Ref<Component>& part) {
  const Ref<EmissionShader> emission = ref_cast<EmissionShader>(part);
  if (!emission || emission->only_at_infinity()) return true;
  bool all = true;
  for (const char* name : {"Rectangle", "Sphere"}) {
    const Ref<SceneObject> host = ref_cast<SceneObject>(Registry::instance().create(name));
    host->emission = emission;
    try {
      host->prepare();
      emission->power(*host, spread_wavelengths(550));
    } catch (const Error&) {
      all = false;
    }
    emission->prepare();  // discards data of the host, which is deleted
  }
  return all;
}

}  // namespace

Drawn draw_part(const ClassInfo& info, const Fixtures& fixtures, std::mt19937_64& random) {
  Drawer drawer(fixtures, random);
  const std::string defaults = write_description(*create(info));
  Drawn drawn;
  constexpr int tries = 60;
  for (int i = 0; i < tries; ++i) {
    drawn = finished([&] { return drawer.with_random(info, 0, 0.75 - 0.6 * i / tries); });
    // A component with all defaults tests nothing new, but some classes have no others.
    if (drawn.part && emits(drawn.part) && (drawn.text != defaults || i >= 4)) break;
  }
  return drawn;
}

}  // namespace etendue::conform
