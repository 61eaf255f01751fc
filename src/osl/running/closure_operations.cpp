// Sums of closures, and closures times a weight.

#include "etendue/core/spectrum.h"
#include "library_code.h"
#include "operations.h"
#include "osl/library/closures.h"

namespace etendue::osl {
namespace {

class AddClosures final : public Node {
 public:
  AddClosures(const Value& a, const Value& b, const Memory& out) : a_(a), b_(b), out_(out) {}
  Flow run(RunState& run) const override {
    a_.evaluate(run);
    b_.evaluate(run);
    const auto* a = load<const ClosureNode*>(run, a_.memory);
    const auto* b = load<const ClosureNode*>(run, b_.memory);
    value_at<const ClosureNode*>(run, out_.offset) = make_sum(run.services, a, b);
    return Flow::next;
  }
  void emit(Code& code) const override {
    a_.emit(code);
    b_.emit(code);
    constexpr auto sum = static_cast<const ClosureNode* (*)(Services&, const ClosureNode*, const ClosureNode*)>(&make_sum);
    const Word words[] = {code.services(), load_address(code, a_.memory).word, load_address(code, b_.memory).word};
    code.store({out_.offset, {}}, code.call(reinterpret_cast<const void*>(sum), WordKind::address, words));
  }

 private:
  Value a_, b_;
  Memory out_;
};

/// A closure times a float, a color or a spectrum. The operands are evaluated in the order of the text.
class WeighClosure final : public Node {
 public:
  WeighClosure(const Value& closure, const Value& weight, bool weight_first, const Memory& out)
      : closure_(closure), weight_(weight), weight_first_(weight_first), out_(out) {}
  Flow run(RunState& run) const override {
    (weight_first_ ? weight_ : closure_).evaluate(run);
    (weight_first_ ? closure_ : weight_).evaluate(run);
    const auto* closure = load<const ClosureNode*>(run, closure_.memory);
    value_at<const ClosureNode*>(run, out_.offset) = closure ? product(run, closure) : nullptr;
    return Flow::next;
  }
  void emit(Code& code) const override {
    (weight_first_ ? weight_ : closure_).emit(code);
    (weight_first_ ? closure_ : weight_).emit(code);
    const Word closure = load_address(code, closure_.memory).word;
    Word result;
    if (weight_.type().base == Base::spectrum) {
      Lent spectrum(code, weight_.memory);
      result = code.call(reinterpret_cast<const void*>(&spectral_product), WordKind::address,
                         {code.services(), spectrum.in(), closure});
    } else {
      const bool one = weight_.type().is_float();
      const Word x = load_number<Real>(code, weight_.memory, 0).word;
      const Word y = one ? x : load_number<Real>(code, weight_.memory, 1).word;
      const Word z = one ? x : load_number<Real>(code, weight_.memory, 2).word;
      result = code.call(reinterpret_cast<const void*>(&color_product), WordKind::address, {code.services(), x, y, z, closure});
    }
    code.store({out_.offset, {}}, result);
  }

 private:
  const ClosureNode* product(RunState& run, const ClosureNode* closure) const {
    const Type& type = weight_.type();
    if (type.base == Base::spectrum) return make_product(run.services, load<Spectrum>(run, weight_.memory), closure);
    return make_product(
        run.services, type.is_float() ? Triple(load<float>(run, weight_.memory)) : load<Triple>(run, weight_.memory), closure);
  }

  static const ClosureNode* color_product(Services* services, float x, float y, float z, const ClosureNode* closure) {
    return make_product(*services, Triple(x, y, z), closure);
  }
  static const ClosureNode* spectral_product(Services* services, const Spectrum* weight, const ClosureNode* closure) {
    return make_product(*services, *weight, closure);
  }

  Value closure_, weight_;
  bool weight_first_;
  Memory out_;
};

}  // namespace

const Node* closure_sum_node(NodeStore& nodes, const Value& a, const Value& b, const Memory& out) {
  return nodes.make<AddClosures>(a, b, out);
}

const Node* closure_product_node(NodeStore& nodes, const Value& closure, const Value& weight, bool weight_first,
                                 const Memory& out) {
  return nodes.make<WeighClosure>(closure, weight, weight_first, out);
}

}  // namespace etendue::osl
