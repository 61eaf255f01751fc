#pragma once
// Common parts of schema and manual: the type and value of a member as text and as JSON.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "etendue/describe/registry.h"

namespace etendue {

/// The parent class, unless it is Component.
const ClassInfo* parent_of(const ClassInfo&);
/// A class that others derive from: abstract, or without a parent.
bool is_interface(const ClassInfo&);
/// All classes except Component, sorted by name.
std::vector<const ClassInfo*> described_classes();
/// The direct subclasses, sorted by name.
std::vector<const ClassInfo*> children(const ClassInfo&);
/// The classes that can be created where the given one is expected, itself included, sorted by name.
std::vector<const ClassInfo*> makeable(const ClassInfo&);

/// "number", "list of integers", "Shader", …
std::string type_text(const Member&);
/// The member's unit as text; "" for pure numbers and members that are no numbers.
std::string unit_text(const Member&);
/// A value of the member in the syntax of render descriptions, with numbers in the member's unit; "none" for none.
std::string value_text(const Value&, const Member&);
/// The value in JSON: components as objects with "class", colours and transforms as text.
nlohmann::ordered_json value_json(const Value&, const Member&);

}  // namespace etendue
