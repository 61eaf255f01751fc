#pragma once
// Translations of names in other programs, for users who know those.

#include <span>
#include <string>
#include <string_view>

#include "etendue/describe/registry.h"

namespace etendue {

/// A name in pbrt ("pbrt"), Mitsuba ("Mitsuba"), Blender ("Blender") or many programs (""), and its equivalent here.
struct ForeignWord {
  /// For a member: the class it belongs to; "": any class that has the first member in `here`. For a choice: the member it
  /// belongs to; "": any member that has the first choice in `here`.
  std::string_view where;
  std::string_view word;  ///< in lower case, without '_' and blanks
  std::string_view whose;
  std::string_view here;  ///< 'Names' in quotes are classes, 'names' are members of the last such class, or of `where`
};

std::span<const ForeignWord> foreign_classes();
std::span<const ForeignWord> foreign_members();
/// Choices of members: 'names' in `here` are choices.
std::span<const ForeignWord> foreign_choices();
/// Units, functions, and options of the command line: `here` is their equivalent.
std::span<const ForeignWord> foreign_units();
std::span<const ForeignWord> foreign_functions();
std::span<const ForeignWord> foreign_options();

/// " (Mitsuba's word; here it is 'Conductor' with 'roughness')" for a name in the list, else "".
std::string translation(std::string_view given, std::span<const ForeignWord>);

/// A hint to follow "there is no class 'x'": the name with a similar spelling, or the equivalent of another program's name.
/// Throws Error if there is none, and the library of formats cannot be loaded, which might have the class.
std::string meant_class(const std::string& given, const ClassInfo* of = nullptr);
/// "Sphere has no member 'radus' (did you mean 'radius'?)".
std::string no_member(const ClassInfo&, const std::string& given);

/// A hint to follow "has no choice 'x'" for a member.
std::string meant_choice(const std::string& given, const Member&);

/// The prefix of an open choice, which ends with "…": "light." of "light.…". Empty: the choice is not open.
std::string beginning_of_choice(const std::string& choice);

}  // namespace etendue
