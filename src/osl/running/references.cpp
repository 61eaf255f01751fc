#include "references.h"

#include <fmt/format.h>

#include <algorithm>

#include "coded_numbers.h"

namespace etendue::osl {
namespace {

class ElementLocator final : public Locator {
 public:
  ElementLocator(const Place& base, const Value& index, int count, std::uint32_t step, std::string name, Location at)
      : base_(base), index_(index), count_(count), step_(step), name_(std::move(name)), at_(at) {}
  std::byte* locate(RunState& run) const override {
    if (base_.fetch) base_.fetch->run(run);
    std::byte* begin = base_.find(run);
    index_.evaluate(run);
    int i = load<int>(run, index_.memory);
    if (i < 0 || i >= count_) {
      report(&run, this, i);
      i = std::clamp(i, 0, count_ - 1);
    }
    return begin + std::size_t(i) * step_;
  }
  Word emit(Code& code) const override {
    if (base_.fetch) base_.fetch->emit(code);
    const Word begin = code.address_of(base_.emit(code));
    index_.emit(code);
    const Whole i = load_int(code, index_.memory), zero = whole(code, 0), last = whole(code, count_ - 1);
    const Code::Label outside = code.label(), inside = code.label();
    code.branch((i < zero || i > last).word, outside, inside);
    code.begin(outside);
    code.call(reinterpret_cast<const void*>(&report), WordKind::none, {code.run_state(), code.address(this), i.word});
    code.jump(inside);
    code.begin(inside);
    const Whole near = select(i < zero, zero, select(i > last, last, i));
    return code.element(begin, near.word, step_);
  }

 private:
  static void report(RunState* run, const ElementLocator* self, int i) {
    run->fault(fmt::format("Index [{}] out of range {}[0..{}]", i, self->name_, self->count_ - 1), self->at_);
  }

  Place base_;
  Value index_;
  int count_;
  std::uint32_t step_;
  std::string name_;
  Location at_;
};

class OffsetLocator final : public Locator {
 public:
  OffsetLocator(const Place& base, std::uint32_t offset) : base_(base), offset_(offset) {}
  std::byte* locate(RunState& run) const override {
    if (base_.fetch) base_.fetch->run(run);
    return base_.find(run) + offset_;
  }
  Word emit(Code& code) const override {
    if (base_.fetch) base_.fetch->emit(code);
    return code.address_of(base_.emit(code) + offset_);
  }

 private:
  Place base_;
  std::uint32_t offset_;
};

class Read final : public Node {
 public:
  Read(const Place& from, const Memory& to) : from_(from), to_(to), size_(to.type.size()) {}
  Flow run(RunState& run) const override {
    if (from_.fetch) from_.fetch->run(run);
    copy_value(run.memory + to_.offset, to_.stride, from_.find(run), from_.memory.stride, size_);
    return Flow::next;
  }
  void emit(Code& code) const override {
    if (from_.fetch) from_.fetch->emit(code);
    emit_copy(code, to_.type, {to_.offset, {}}, to_.stride, from_.emit(code), from_.memory.stride, size_);
  }

 private:
  Place from_;
  Memory to_;
  std::size_t size_;
};

class Write final : public Node {
 public:
  Write(const Place& to, const Value& value, const Memory* result)
      : to_(to), value_(value), has_result_(result), size_(std::min(value.type().size(), to.memory.type.size())) {
    if (result) result_ = *result;
  }
  Flow run(RunState& run) const override {
    if (to_.fetch) to_.fetch->run(run);
    std::byte* at = to_.find(run);
    value_.evaluate(run);
    const std::byte* from = run.memory + value_.memory.offset;
    copy_value(at, to_.memory.stride, from, value_.memory.stride, size_);
    if (has_result_) copy_value(run.memory + result_.offset, result_.stride, from, value_.memory.stride, size_);
    return Flow::next;
  }
  void emit(Code& code) const override {
    if (to_.fetch) to_.fetch->emit(code);
    const Spot at = to_.emit(code), from{value_.memory.offset, {}};
    value_.emit(code);
    emit_copy(code, to_.memory.type, at, to_.memory.stride, from, value_.memory.stride, size_);
    if (has_result_) emit_copy(code, result_.type, {result_.offset, {}}, result_.stride, from, value_.memory.stride, size_);
  }

 private:
  Place to_;
  Value value_;
  bool has_result_;
  Memory result_;
  std::size_t size_;
};

class Update final : public Node {
 public:
  Update(const Place& at, const Value& value, const Memory& old, const Node* operation, const Memory& result)
      : at_(at), value_(value), old_(old), operation_(operation), result_(result), size_(old.type.size()) {}
  Flow run(RunState& run) const override {
    if (at_.fetch) at_.fetch->run(run);
    std::byte* at = at_.find(run);
    value_.evaluate(run);
    copy_value(run.memory + old_.offset, old_.stride, at, at_.memory.stride, size_);
    operation_->run(run);
    copy_value(at, at_.memory.stride, run.memory + result_.offset, result_.stride, size_);
    return Flow::next;
  }
  void emit(Code& code) const override {
    if (at_.fetch) at_.fetch->emit(code);
    const Spot at = at_.emit(code);
    value_.emit(code);
    emit_copy(code, old_.type, {old_.offset, {}}, old_.stride, at, at_.memory.stride, size_);
    operation_->emit(code);
    emit_copy(code, old_.type, at, at_.memory.stride, {result_.offset, {}}, result_.stride, size_);
  }

 private:
  Place at_;
  Value value_;
  Memory old_;
  const Node* operation_;
  Memory result_;
  std::size_t size_;
};

template <class T>
class Increment final : public Node {
 public:
  Increment(const Place& at, int by, bool postfix, const Memory& result)
      : at_(at), by_(by), postfix_(postfix), result_(result) {}
  Flow run(RunState& run) const override {
    if (at_.fetch) at_.fetch->run(run);
    std::byte* at = at_.find(run);
    T& value = *reinterpret_cast<T*>(at);
    const T old = value;
    if constexpr (std::is_same_v<T, int>)
      value = int(unsigned(old) + unsigned(by_));
    else
      value = old + T(by_);
    copy_value(run.memory + result_.offset, result_.stride, at, at_.memory.stride, sizeof(T));
    if (postfix_) value_at<T>(run, result_.offset) = old;
    return Flow::next;
  }
  void emit(Code& code) const override {
    constexpr WordKind kind = std::is_same_v<T, int> ? WordKind::int_ : WordKind::float_;
    if (at_.fetch) at_.fetch->emit(code);
    const Spot at = at_.emit(code);
    const Word old = code.load(kind, at);
    Word by;
    if constexpr (std::is_same_v<T, int>)
      by = code.integer(by_);
    else
      by = code.number(float(by_));
    code.store(at, code.arithmetic(Code::Arithmetic::add, old, by));
    emit_copy(code, result_.type, {result_.offset, {}}, result_.stride, at, at_.memory.stride, sizeof(T));
    if (postfix_) code.store({result_.offset, {}}, old);
  }

 private:
  Place at_;
  int by_;
  bool postfix_;
  Memory result_;
};

class Clear final : public Node {
 public:
  explicit Clear(const Memory& m) : memory_(m) {}
  Flow run(RunState& run) const override {
    std::byte* at = run.memory + memory_.offset;
    MemoryLayout::clear(memory_.type, at);
    if (memory_.stride)
      for (int i = 1; i < 3; ++i) std::memset(at + i * std::size_t(memory_.stride), 0, memory_.type.size());
    return Flow::next;
  }
  void emit(Code& code) const override {
    const Spot at{memory_.offset, {}};
    emit_clear(code, memory_.type, at);
    if (memory_.stride)
      for (std::size_t i = 1; i < 3; ++i) code.clear(at + i * memory_.stride, memory_.type.size());
  }

 private:
  Memory memory_;
};

class Both final : public Node {
 public:
  Both(const Node* first, const Node* second) : first_(first), second_(second) {}
  Flow run(RunState& run) const override {
    const Flow flow = first_->run(run);
    return flow == Flow::next ? second_->run(run) : flow;
  }
  void emit(Code& code) const override {
    first_->emit(code);
    second_->emit(code);
  }

 private:
  const Node *first_, *second_;
};

}  // namespace

const Locator* element_locator(NodeStore& nodes, const Place& base, const Value& index, int count, std::uint32_t step,
                               const std::string& name, Location at) {
  return nodes.make<ElementLocator>(base, index, count, step, name, at);
}
const Locator* offset_locator(NodeStore& nodes, const Place& base, std::uint32_t offset) {
  return nodes.make<OffsetLocator>(base, offset);
}
const Node* read_node(NodeStore& nodes, const Place& from, const Memory& to) { return nodes.make<Read>(from, to); }
const Node* write_node(NodeStore& nodes, const Place& to, const Value& value, const Memory* result) {
  return nodes.make<Write>(to, value, result);
}
const Node* update_node(NodeStore& nodes, const Place& at, const Value& value, const Memory& old, const Node* operation,
                        const Memory& result) {
  return nodes.make<Update>(at, value, old, operation, result);
}
const Node* increment_node(NodeStore& nodes, const Place& at, int by, bool postfix, const Memory& result) {
  if (at.memory.type.is_int()) return nodes.make<Increment<int>>(at, by, postfix, result);
  return nodes.make<Increment<float>>(at, by, postfix, result);
}
const Node* clear_node(NodeStore& nodes, const Memory& m) { return nodes.make<Clear>(m); }
const Node* both(NodeStore& nodes, const Node* first, const Node* second) {
  if (!first || !second) return first ? first : second;
  return nodes.make<Both>(first, second);
}

}  // namespace etendue::osl
