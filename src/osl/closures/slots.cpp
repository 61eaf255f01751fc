#include "slots.h"

namespace etendue::osl {

namespace {

/// What slots have outside of any scope: while models are prepared.
const SlotValues at_rest = [] {
  SlotValues v;
  for (Spectrum& c : v.colors) c = Spectrum(0.5f);
  for (float& x : v.numbers) x = 0.5f;
  v.extinction = Spectrum(1.0f);
  return v;
}();

thread_local const SlotValues* current = nullptr;

const SlotValues& values() { return current ? *current : at_rest; }

/// Slots are no class of the description: they are described as the interface is.
const ClassInfo& slot_class() {
  static const ClassInfo& info = *Registry::instance().find("ObjectMap");
  return info;
}

class ColorSlot final : public ObjectMap {
 public:
  const ClassInfo& class_info() const override { return slot_class(); }
  explicit ColorSlot(int i) : index_(i) {}
  Spectrum color(const SurfacePoint&, const Wavelengths&, ColorUse) const override { return values().colors[index_]; }
  float scalar(const SurfacePoint&) const override { return values().colors[index_].average(); }

 private:
  int index_;
};

class NumberSlot final : public ObjectMap {
 public:
  const ClassInfo& class_info() const override { return slot_class(); }
  explicit NumberSlot(int i) : index_(i) {}
  Spectrum color(const SurfacePoint&, const Wavelengths&, ColorUse) const override { return values().numbers[index_]; }
  float scalar(const SurfacePoint&) const override { return values().numbers[index_]; }

 private:
  int index_;
};

template <Spectrum SlotValues::* of>
class SpectrumSlot final : public SpectralFunction {
 public:
  Spectrum evaluate(const Wavelengths&, ColorUse) const override { return values().*of; }
  float at(float, ColorUse) const override { return (values().*of)[0]; }
  std::string expression() const override { return "1"; }
};

class IndexSlot final : public SpectralFunction {
 public:
  explicit IndexSlot(bool complex) {
    if (complex) imaginary_ = Color(new SpectrumSlot<&SlotValues::extinction>);
  }
  Spectrum evaluate(const Wavelengths&, ColorUse) const override { return values().index; }
  float at(float, ColorUse) const override { return values().index[0]; }
  std::string expression() const override { return "1.5"; }
  Color imaginary() const override { return imaginary_; }

 private:
  Color imaginary_;
};

}  // namespace

SlotScope::SlotScope(const SlotValues& v) : before_(current) { current = &v; }
SlotScope::~SlotScope() { current = before_; }

Ref<ObjectMap> color_slot(int i) { return Ref<ObjectMap>(make<ColorSlot>(i)); }
Ref<ObjectMap> number_slot(int i) { return Ref<ObjectMap>(make<NumberSlot>(i)); }
Color index_slot(bool complex) { return Color(new IndexSlot(complex)); }

Color film_slot() { return Color(new SpectrumSlot<&SlotValues::film>); }
Color length_slot() { return Color(new SpectrumSlot<&SlotValues::length>); }

Ref<etendue::Shader> make_model(std::string_view class_name, std::initializer_list<std::pair<const char*, Value>> members) {
  const Ref<Component> made = Registry::instance().create(class_name);
  for (const auto& [name, value] : members) {
    const ClassInfo& info = made->class_info();
    const Member* m = info.find(name);
    if (!m) throw Error(fmt::format("{} has no member '{}'", class_name, name));
    m->store(*made, *m, value);
  }
  made->prepare();
  return ref_cast<Shader>(made);
}

}  // namespace etendue::osl
