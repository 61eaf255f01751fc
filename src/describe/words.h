#pragma once
// The words of other programs, told to those who come from there.

#include <span>
#include <string>
#include <string_view>

#include "etendue/describe/registry.h"

namespace etendue {

/// A word of pbrt ("pbrt"), Mitsuba ("Mitsuba"), Blender ("Blender") or of many programs (""), and what is written here.
struct ForeignWord {
  /// The class a member's word is of; "": of any class that has the first member in `here`. The member a choice's word is of;
  /// "": of any that has the first choice in `here`.
  std::string_view where;
  std::string_view word;  ///< in small letters, without '_' and blanks
  std::string_view whose;
  std::string_view here;  ///< 'Names' in quotes are classes, 'names' members of the class named last, or of `where`
};

std::span<const ForeignWord> foreign_classes();
std::span<const ForeignWord> foreign_members();
/// What members that offer a choice may be: 'names' in `here` are choices.
std::span<const ForeignWord> foreign_choices();
/// Of units, functions, and options of the command line: `here` is what to write.
std::span<const ForeignWord> foreign_units();
std::span<const ForeignWord> foreign_functions();
std::span<const ForeignWord> foreign_options();

/// " (Mitsuba's word; here it is 'Conductor' with 'roughness')" for a word that is in the list, else "".
std::string translation(std::string_view given, std::span<const ForeignWord>);

/// What follows "there is no class 'x'": what was probably meant, by its spelling or in the words of other programs.
std::string meant_class(const std::string& given, const ClassInfo* of = nullptr);
/// "Sphere has no member 'radus' (did you mean 'radius'?)".
std::string no_member(const ClassInfo&, const std::string& given);

/// What follows "has no choice 'x'" of a member.
std::string meant_choice(const std::string& given, const Member&);

/// Of a choice of strings that ends with "…", what all that it stands for begins with: "light." of "light.…". Empty: it stands
/// for itself.
std::string beginning_of_choice(const std::string& choice);

}  // namespace etendue
