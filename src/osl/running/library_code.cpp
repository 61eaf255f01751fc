#include "library_code.h"

#include <algorithm>

#include "coded_numbers.h"

namespace etendue::osl {
namespace {

static_assert(sizeof(Call) == 4 * sizeof(void*), "a Call is four addresses, in the order of its declaration");

/// Larger values are not copied [bytes, with derivatives].
constexpr std::size_t most_copied = 192;
constexpr std::size_t alignment = 32;  ///< of a Spectrum

std::size_t bytes_of(const Memory& m) { return m.type.size() * (m.stride ? 3 : 1); }

bool overlap(const Memory& a, const Memory& b) {
  return a.offset < b.offset + bytes_of(b) && b.offset < a.offset + bytes_of(a);
}

std::size_t rounded(std::size_t bytes) { return (bytes + alignment - 1) / alignment * alignment; }

}  // namespace

bool LentArguments::direct(std::size_t i) const {
  const Memory& m = call_.arguments[i].memory;
  if (call_.outputs[i] || !call_.code.own(m.offset) || bytes_of(m) > most_copied) return true;
  for (std::size_t k = 0; k < call_.arguments.size(); ++k)
    if (call_.outputs[k] && overlap(m, call_.arguments[k].memory)) return true;
  return false;
}

LentArguments::LentArguments(const CodedCall& call) : call_(call) {
  Code& code = call_.code;
  const std::size_t count = call_.arguments.size(), list = sizeof(Call);
  std::size_t size = rounded(list + count * sizeof(void*));
  std::vector<std::size_t> places(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (direct(i)) continue;
    places[i] = size;
    size += rounded(bytes_of(call_.arguments[i].memory));
  }
  const Memory& result = call_.result;
  const std::size_t result_place = size;
  result_copied_ = !result.type.is_void() && code.own(result.offset) && bytes_of(result) <= most_copied;
  if (result_copied_) size += rounded(bytes_of(result));
  memory_ = code.borrow(size);
  const auto at = [&](std::size_t offset) { return Spot{std::uint32_t(offset), memory_}; };
  for (std::size_t i = 0; i < count; ++i) {
    const Memory& m = call_.arguments[i].memory;
    const Spot own{m.offset, {}};
    if (!direct(i))
      emit_copy(code, m.type, at(places[i]), std::uint32_t(m.stride ? m.type.size() : 0), own, m.stride, m.type.size());
    code.store(at(list + i * sizeof(void*)), code.address_of(direct(i) ? own : at(places[i])));
  }
  result_ = at(result_place);
  code.store(at(0), code.address_of(at(list)));
  code.store(at(8), result.type.is_void() ? code.address(nullptr)
                                          : code.address_of(result_copied_ ? result_ : Spot{result.offset, {}}));
  code.store(at(16), code.address(&call_.types));
  code.store(at(24), code.services());
}

void LentArguments::end() {
  const Memory& m = call_.result;
  if (result_copied_)
    emit_copy(call_.code, m.type, {m.offset, {}}, m.stride, result_, std::uint32_t(m.stride ? m.type.size() : 0),
              m.type.size());
  call_.code.give_back(memory_);
}

}  // namespace etendue::osl
