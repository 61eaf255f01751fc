// Sizes and names of types.

#include "type.h"

#include <algorithm>

#include "etendue/core/spectrum.h"

namespace etendue::osl {

int Type::floats() const {
  if (closure) return 0;
  switch (base) {
    case Base::float_: return 1;
    case Base::color:
    case Base::point:
    case Base::vector:
    case Base::normal: return 3;
    case Base::matrix: return 16;
    case Base::spectrum: return spectrum_size;
    default: return 0;
  }
}

std::size_t Type::size() const {
  std::size_t one = std::size_t(floats()) * sizeof(float);
  if (closure || base == Base::string) one = sizeof(void*);
  if (base == Base::int_) one = sizeof(int);
  if (base == Base::structure) one = structure->size;
  return one * std::size_t(elements());
}

std::size_t Type::alignment() const {
  if (closure || base == Base::string) return alignof(void*);
  if (base == Base::structure) return structure->alignment;
  if (base == Base::spectrum) return alignof(Spectrum);  // one vector register
  return alignof(float);
}

std::string Type::name() const {
  static constexpr const char* names[] = {"void",   "int",    "float",  "color",  "point",   "vector",
                                          "normal", "matrix", "string", "struct", "spectrum"};
  std::string text = base == Base::structure && structure ? structure->name : names[int(base)];
  if (closure) text = "closure " + text;
  if (array == unsized) text += "[]";
  if (array > 0) text += "[" + std::to_string(array) + "]";
  return text;
}

void StructType::add(std::string field, const Type& type) {
  const std::size_t to = type.alignment();
  const std::size_t end = fields.empty() ? 0 : fields.back().offset + fields.back().type.size();
  const std::size_t offset = (end + to - 1) / to * to;
  fields.push_back({std::move(field), type, offset});
  alignment = std::max(alignment, to);
  size = (offset + type.size() + alignment - 1) / alignment * alignment;
}

const Field* StructType::find(std::string_view field) const {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == field; });
  return found == fields.end() ? nullptr : &*found;
}

}  // namespace etendue::osl
