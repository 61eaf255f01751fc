#include "code.h"

#include "coded_numbers.h"
#include "osl/values/interned_string.h"

namespace etendue::osl {

namespace {

void run_node(RunState* run, const Node* node) { node->run(*run); }

void clear_value(const Type* type, std::byte* value) { MemoryLayout::clear(*type, value); }

/// The kind of the words of a value that is copied word by word; none: it is copied as bytes.
WordKind words_of(const Type& type, std::size_t size) {
  constexpr std::size_t most = 16;  // words
  if (type.is_structure()) return WordKind::none;
  if (type.is_closure() || type.base == Base::string) return size <= most * sizeof(void*) ? WordKind::address : WordKind::none;
  if (size > most * sizeof(float)) return WordKind::none;
  return type.base == Base::int_ ? WordKind::int_ : WordKind::float_;
}

void copy_block(Code& code, const Type& type, const Spot& to, const Spot& from, std::size_t size) {
  if (size == 0) return;
  const WordKind kind = words_of(type, size);
  if (kind == WordKind::none) return code.copy(to, from, size);
  const std::size_t step = kind == WordKind::address ? sizeof(void*) : sizeof(float);
  std::array<Word, 16> words;
  for (std::size_t i = 0; i < size / step; ++i) words[i] = code.load(kind, from + i * step);
  for (std::size_t i = 0; i < size / step; ++i) code.store(to + i * step, words[i]);
}

bool has_strings(const Type& type) {
  if (type.base == Base::string) return true;
  if (!type.is_structure()) return false;
  for (const Field& field : type.structure->fields)
    if (has_strings(field.type)) return true;
  return false;
}

}  // namespace

void Code::interpret(const Node& node) {
  call(reinterpret_cast<const void*>(&run_node), WordKind::none, {run_state(), address(&node)});
}

void emit_copy(Code& code, const Type& type, const Spot& to, std::uint32_t to_stride, const Spot& from,
               std::uint32_t from_stride, std::size_t size) {
  copy_block(code, type, to, from, size);
  if (!to_stride) return;
  for (std::size_t i = 1; i < 3; ++i) {
    if (from_stride)
      copy_block(code, type, to + i * to_stride, from + i * from_stride, size);
    else
      code.clear(to + i * to_stride, size);
  }
}

void emit_clear(Code& code, const Type& type, const Spot& at) {
  if (!has_strings(type)) return code.clear(at, type.size());
  if (type.is_string()) return code.store(at, code.address(empty_string()));
  code.call(reinterpret_cast<const void*>(&clear_value), WordKind::none, {code.address(&type), code.address_of(at)});
}

}  // namespace etendue::osl
