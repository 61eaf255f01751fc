#pragma once
// Walking through a closure's tree: all its components with their weights.

#include <memory>
#include <vector>

#include "etendue/core/spectrum.h"
#include "osl/values/closure.h"

namespace etendue::osl {

/// A closure that is still to be visited, with the weights that it has.
struct WeightedClosure {
  const ClosureNode* node = nullptr;
  Triple weight{1};
  Spectrum spectral = Spectrum(1.0f);
};

/// Those that are still to be visited, the next one last. Sums may be as deep as a shader's loops are long, so that recursion
/// would not do. Few need more than what is kept in place.
class OpenClosures {
 public:
  OpenClosures() {}
  bool empty() const { return count_ == 0; }
  void push(const WeightedClosure& c) {
    if (!c.node) return;
    if (count_ < in_place)
      std::construct_at(&first_[count_], c);
    else
      more_.push_back(c);
    ++count_;
  }
  WeightedClosure pop() {
    if (--count_ < in_place) return first_[count_];
    const WeightedClosure c = more_.back();
    more_.pop_back();
    return c;
  }

 private:
  static constexpr std::size_t in_place = 16;
  union {  // made one by one
    WeightedClosure first_[in_place];
  };
  std::size_t count_ = 0;
  std::vector<WeightedClosure> more_;
};

/// Calls f(component, weight, spectral weight) for each component: it counts times the product of both. Those within layer()
/// are walked through as if they were added.
template <class F>
void each_component(const ClosureNode* root, const F& f) {
  static const String* const layers = intern_string("layer");
  OpenClosures open;
  open.push({root});
  while (!open.empty()) {
    const WeightedClosure w = open.pop();
    switch (w.node->kind) {
      case ClosureNode::Kind::sum: {
        const auto& sum = *static_cast<const ClosureSum*>(w.node);
        open.push({sum.b, w.weight, w.spectral});
        open.push({sum.a, w.weight, w.spectral});
        break;
      }
      case ClosureNode::Kind::product: {
        const auto& p = *static_cast<const ClosureProduct*>(w.node);
        open.push({p.closure, w.weight * p.weight, p.spectrum ? w.spectral * *p.spectrum : w.spectral});
        break;
      }
      case ClosureNode::Kind::component: {
        const auto& c = *static_cast<const ClosureComponent*>(w.node);
        if (c.shape->name != layers) {
          f(c, w.weight, w.spectral);
          break;
        }
        open.push({c.argument<const ClosureNode*>(1), w.weight, w.spectral});
        open.push({c.argument<const ClosureNode*>(0), w.weight, w.spectral});
        break;
      }
    }
  }
}

}  // namespace etendue::osl
