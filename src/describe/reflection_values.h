#pragma once
// What schema and manual both need: a member's type and value in words and in JSON.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "etendue/describe/registry.h"

namespace etendue {

/// The parent, when that is more than Component.
const ClassInfo* parent_of(const ClassInfo&);
/// A class others are made of: abstract, or one without a parent.
bool is_interface(const ClassInfo&);
/// All classes but Component itself, by name.
std::vector<const ClassInfo*> described_classes();
/// The classes that say this one is their parent, by name.
std::vector<const ClassInfo*> children(const ClassInfo&);
/// The classes that can be made where the given one is expected, itself included, by name.
std::vector<const ClassInfo*> makeable(const ClassInfo&);

/// "number", "list of integers", "Shader", …
std::string type_text(const Member&);
/// The member's unit as people write it; "" for pure numbers and what is no number.
std::string unit_text(const Member&);
/// A value of the member as it is written in a render description, numbers in the member's unit; "none" for none.
std::string value_text(const Value&, const Member&);
/// The same in JSON: components as objects with "class", colours and transforms as text.
nlohmann::ordered_json value_json(const Value&, const Member&);

}  // namespace etendue
