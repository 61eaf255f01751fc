#pragma once
// Walking through a closure's tree: all its components with their weights.

#include "etendue/core/spectrum.h"
#include "osl/values/closure.h"

namespace etendue::osl {

/// Calls f(component, weight, spectral weight) for each component: it counts times the product of both. Those within layer()
/// are walked through as if they were added.
template <class F>
void each_component(const ClosureNode* node, const F& f, const Triple& weight = Triple(1),
                    const Spectrum& spectral = Spectrum(1.0f)) {
  if (!node) return;
  switch (node->kind) {
    case ClosureNode::Kind::sum:
      each_component(static_cast<const ClosureSum*>(node)->a, f, weight, spectral);
      each_component(static_cast<const ClosureSum*>(node)->b, f, weight, spectral);
      return;
    case ClosureNode::Kind::product: {
      const auto& p = *static_cast<const ClosureProduct*>(node);
      each_component(p.closure, f, weight * p.weight, p.spectrum ? spectral * *p.spectrum : spectral);
      return;
    }
    case ClosureNode::Kind::component: break;
  }
  const auto& c = *static_cast<const ClosureComponent*>(node);
  static const String* layers = intern_string("layer");
  if (c.shape->name != layers) {
    f(c, weight, spectral);
    return;
  }
  each_component(c.argument<const ClosureNode*>(0), f, weight, spectral);
  each_component(c.argument<const ClosureNode*>(1), f, weight, spectral);
}

}  // namespace etendue::osl
