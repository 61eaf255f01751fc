#pragma once
// Nodes of the language's operators and conversions.

#include "nodes.h"
#include "osl/language/tree.h"

namespace etendue::osl {

/// Whether values of the type are computed with derivatives: numbers and triples, arrays of them, and structures, whose fields
/// may be such. Those of matrices and spectra are taken as zero.
inline bool carries_derivatives(const Type& type) {
  return type.is_structure() || (!type.closure && (type.base == Base::float_ || type.triple_based()));
}

/// operands a `operation` b -> out. Derivatives are computed if `out` has them. Null if the operation does not exist for these
/// types, which the checker excludes.
const Node* binary_node(NodeStore&, Operator, const Value& a, const Value& b, const Memory& out);
/// The sum of two closures.
const Node* closure_sum_node(NodeStore&, const Value& a, const Value& b, const Memory& out);
/// A closure times a float, a color or a spectrum. `weight_first`: in the text, which is the order of evaluation.
const Node* closure_product_node(NodeStore&, const Value& closure, const Value& weight, bool weight_first, const Memory& out);
const Node* unary_node(NodeStore&, Operator, const Value& a, const Memory& out);
/// a -> out of out's type.
const Node* conversion_node(NodeStore&, const Value& a, const Memory& out);
/// Whether a is true (`expected` 1) or not (0), an int.
const Node* truth_node(NodeStore&, const Value& a, bool expected, const Memory& out);
/// Copies a value, with derivatives if `to` has them.
const Node* copy_node(NodeStore&, const Value& from, const Memory& to);
/// A triple of three floats.
const Node* triple_node(NodeStore&, const Value& x, const Value& y, const Value& z, const Memory& out);

}  // namespace etendue::osl
