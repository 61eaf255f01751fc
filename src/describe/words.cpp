#include "words.h"

#include <fmt/format.h>

#include <algorithm>

namespace etendue {

namespace {

/// The spelling used in the tables: "roughconductor" for "Rough_Conductor".
std::string bare(std::string_view word) {
  std::string text;
  for (const char c : word)
    if (c != '_' && c != '-' && c != ' ') text += char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string told(const ForeignWord& word) {
  return word.whose.empty() ? fmt::format(" (here it is {})", word.here)
                            : fmt::format(" ({}'s word; here it is {})", word.whose, word.here);
}

/// The first name in quotes in a text.
std::string_view first_quoted(std::string_view text) {
  const size_t begin = text.find('\'') + 1;
  return begin == 0 ? std::string_view() : text.substr(begin, text.find('\'', begin) - begin);
}

bool is_of(const ClassInfo& info, std::string_view ancestor) {
  for (const ClassInfo* c = &info; c; c = c->parent)
    if (c->name == ancestor) return true;
  return false;
}

/// Whether an entry about an interface applies to a class of it: it names another class, or a member of this class.
bool speaks_of(const ForeignWord& entry, const ClassInfo& info) {
  for (size_t at = entry.here.find('\''); at != std::string_view::npos; at = entry.here.find('\'', at + 1))
    if (at + 1 < entry.here.size() && std::isupper(static_cast<unsigned char>(entry.here[at + 1]))) return true;
  return info.find(first_quoted(entry.here)) != nullptr;
}

/// The known name with the same spelling except for case, '_' and blanks; null: there is none.
const std::string* same_but_for_spelling(const std::string& given, const std::vector<std::string>& known) {
  for (const std::string& name : known)
    if (bare(name) == bare(given)) return &name;
  return nullptr;
}

}  // namespace

std::string translation(std::string_view given, std::span<const ForeignWord> words) {
  const std::string word = bare(given);
  const auto found = std::ranges::find(words, word, &ForeignWord::word);
  return found == words.end() ? std::string() : told(*found);
}

namespace {

std::string meant_among(const std::vector<const ClassInfo*>& classes, const std::string& given, const ClassInfo* of) {
  std::vector<std::string> known;
  for (const ClassInfo* c : classes)
    if (!c->abstract() && (!of || c->is_a(*of))) known.push_back(c->name);
  if (const std::string* same = same_but_for_spelling(given, known)) return " (did you mean '" + *same + "'?)";
  if (const std::string elsewhere = translation(given, foreign_classes()); !elsewhere.empty()) return elsewhere;
  return suggestion(given, known);
}

}  // namespace

std::string meant_class(const std::string& given, const ClassInfo* of) {
  const Registry& registry = Registry::instance();
  try {
    return meant_among(registry.all(), given, of);
  } catch (const Error&) {  // the library of formats is missing
    const std::string meant = meant_among(registry.loaded(), given, of);
    if (meant.empty()) throw;
    return meant;
  }
}

std::string no_member(const ClassInfo& info, const std::string& given) {
  const std::string text = fmt::format("{} has no member '{}'", info.name, given);
  for (const AbsentMember& absent : info.absent)
    if (absent.name == given) return text + ": " + absent.why;
  std::vector<std::string> known;
  for (const Member& m : info.members) known.push_back(m.name);
  if (const std::string* same = same_but_for_spelling(given, known)) return text + " (did you mean '" + *same + "'?)";
  const std::string word = bare(given);
  // Entries for the class itself have priority over those for its interface, and these over general ones.
  const ForeignWord *general = nullptr, *of_interface = nullptr;
  for (const ForeignWord& entry : foreign_members()) {
    if (entry.word != word) continue;
    if (entry.where == info.name) return text + told(entry);
    if (!entry.where.empty() && is_of(info, entry.where) && speaks_of(entry, info))
      of_interface = of_interface ? of_interface : &entry;
    if (entry.where.empty() && info.find(first_quoted(entry.here))) general = general ? general : &entry;
  }
  if (of_interface) return text + told(*of_interface);
  if (general) return text + told(*general);
  return text + suggestion(given, known);
}

std::string meant_choice(const std::string& given, const Member& member) {
  if (const std::string* same = same_but_for_spelling(given, member.choices)) return " (did you mean '" + *same + "'?)";
  const std::string word = bare(given);
  // Entries for members with this name have priority over general ones.
  const ForeignWord* general = nullptr;
  for (const ForeignWord& entry : foreign_choices()) {
    if (entry.word != word || std::ranges::find(member.choices, first_quoted(entry.here)) == member.choices.end()) continue;
    if (entry.where == member.name) return told(entry);
    if (entry.where.empty()) general = &entry;
  }
  return general ? told(*general) : suggestion(given, member.choices);
}

std::string beginning_of_choice(const std::string& choice) {
  constexpr std::string_view open = "…";
  return choice.ends_with(open) ? choice.substr(0, choice.size() - open.size()) : std::string();
}

}  // namespace etendue
