#pragma once
// Nodes that find, read and write parts of values: elements of arrays, components, fields.

#include "nodes.h"

namespace etendue::osl {

/// An element of an array, or a component of a triple: `base` plus index times `step`. An index out of range is reported, and
/// the nearest element taken.
const Locator* element_locator(NodeStore&, const Place& base, const Value& index, int count, std::uint32_t step,
                               const std::string& name, Location);
/// A fixed number of bytes behind what another locator finds.
const Locator* offset_locator(NodeStore&, const Place& base, std::uint32_t offset);

/// Copies what is at a place.
const Node* read_node(NodeStore&, const Place& from, const Memory& to);
/// Finds the place, evaluates the value, then writes it. If `result` is not null, the value is left there, too.
const Node* write_node(NodeStore&, const Place& to, const Value& value, const Memory* result);
/// Finds the place, evaluates `value`, copies what is at the place to `old`, runs `operation` (on `old` and `value`, which
/// leaves `result`), and writes that to the place.
const Node* update_node(NodeStore&, const Place&, const Value& value, const Memory& old, const Node* operation,
                        const Memory& result);
/// ++ and --; `result` gets the new value or the old one.
const Node* increment_node(NodeStore&, const Place&, int by, bool postfix, const Memory& result);
/// Sets to zero or "".
const Node* clear_node(NodeStore&, const Memory&);
/// Runs the first, then the second; either may be null.
const Node* both(NodeStore&, const Node* first, const Node* second);

}  // namespace etendue::osl
