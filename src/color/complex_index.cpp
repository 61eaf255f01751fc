// Complex refractive indices n + i k.

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "named.h"
#include "table_spectrum.h"
#include "tables.h"

namespace etendue {

namespace {

class ComplexIndex final : public SpectralFunction {
 public:
  ComplexIndex(Color n, Color k, std::string expression)
      : n_(std::move(n)), k_(std::move(k)), expression_(std::move(expression)) {}
  Spectrum evaluate(const Wavelengths& wavelengths, ColorUse use) const override { return n_->evaluate(wavelengths, use); }
  float at(float wavelength, ColorUse use) const override { return n_->at(wavelength, use); }
  std::string expression() const override { return expression_; }
  bool varies() const override { return n_->varies() || k_->varies(); }
  Color imaginary() const override { return k_; }
  std::vector<float> corners() const override { return n_->corners(); }

 private:
  Color n_, k_;
  std::string expression_;
};

/// The entries of all tables, in their order.
std::span<const tables::Metal> all_metals() {
  static const std::vector<tables::Metal> all = [] {
    std::vector<tables::Metal> list;
    for (const auto& table : {tables::metals, tables::plain_metals, tables::transition_metals, tables::alloys,
                              tables::semiconductors, tables::compounds})
      list.insert(list.end(), table.begin(), table.end());
    return list;
  }();
  return all;
}

}  // namespace

Color complex_index(Color n, Color k) {
  if (!n || !k) throw Error("a complex refractive index needs both n and k");
  if (n->imaginary() || k->imaginary()) throw Error("n and k of a complex refractive index must be real");
  std::string expression = "complex(" + n->expression() + ", " + k->expression() + ")";
  return Color(new ComplexIndex(std::move(n), std::move(k), std::move(expression)));
}

Color metal_index(const std::string& name) {
  const tables::Metal& metal = find_named(all_metals(), "metal", name);
  std::vector<float> wavelengths, n, k;
  for (const auto& row : metal.rows) {
    wavelengths.push_back(float(row[0]));
    n.push_back(float(row[1]));
    k.push_back(float(row[2]));
  }
  return Color(
      new ComplexIndex(table_spectrum(wavelengths, n), table_spectrum(wavelengths, k), "metal(" + quoted(metal.name) + ")"));
}

std::vector<std::string> metal_names() { return names_of(all_metals()); }

}  // namespace etendue
