// Class descriptions as text: for a terminal, and as the pages of the manual.

#include <fmt/format.h>

#include <algorithm>

#include "etendue/describe/reflection.h"
#include "reflection_values.h"

namespace etendue {

namespace {

/// The number of characters, not bytes.
size_t width_of(const std::string& text) {
  return size_t(std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, size_t width) {
  const size_t has = width_of(text);
  return has < width ? text + std::string(width - has, ' ') : text;
}

/// Breaks a text into lines of at most `width` characters and indents all but the first, which continues a line.
std::string wrapped(const std::string& text, size_t indent, size_t width = 110) {
  std::string result, word;
  size_t column = indent;
  const auto flush = [&] {
    if (word.empty()) return;
    if (column > indent && column + 1 + width_of(word) > width) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += width_of(word);
    word.clear();
  };
  for (const char c : text) {
    if (c == ' ' || c == '\n')
      flush();
    else
      word += c;
  }
  flush();
  return result;
}

std::string range_text(const Member& member) {
  if (!member.choices.empty()) return fmt::format("{}", fmt::join(member.choices, ", "));
  return member.range ? member.range->text() : "";
}

/// The range of a slider; "" without one.
std::string slider_text(const Member& member) {
  return member.soft ? fmt::format("usually {:.6g} to {:.6g}", member.soft->low, member.soft->high) : "";
}

std::string meaning_text(const Member& member) {
  switch (member.meaning) {
    case Meaning::plain: break;
    case Meaning::number: return " (a number)";
    case Meaning::reflectance: return " (a reflectance)";
    case Meaning::radiance: return " (of light)";
    case Meaning::coefficient: return " (a coefficient)";
    case Meaning::index: return " (an index of refraction)";
  }
  return {};
}

/// The condition under which a member has an effect; "" for always.
std::string condition_text(const ClassInfo& info, const Member& member) {
  std::vector<std::string> parts;
  for (const Condition& condition : member.conditions) parts.push_back(condition.text(info));
  return parts.empty() ? "" : fmt::format("Matters only when {}.", fmt::join(parts, " and "));
}

std::string with_blank(const std::string& text) { return text.empty() ? text : " " + text; }

/// The default of a member; empty for an abstract class, whose subclasses have their own defaults.
std::string default_text(const ClassInfo& info, const Member& member) {
  if (member.required) return "must be given";
  return info.abstract() ? "" : value_text(member.default_value, member);
}

std::string sentence(std::string text) {
  if (!text.empty() && text.back() != '.' && text.back() != '?' && text.back() != '!') text += '.';
  return text;
}

void add_tree(const ClassInfo& info, size_t depth, size_t column, std::string& out) {
  const std::string indent(2 * depth, ' ');
  out += padded(indent + info.name, column) + "  " + wrapped(info.summary, column + 2) + "\n";
  for (const ClassInfo* child : children(info)) add_tree(*child, depth + 1, column, out);
}

// ---- Markdown -------------------------------------------------------------------------------------------------------

/// Escapes vertical bars, which would end a cell of a table.
std::string cell(const std::string& text) {
  std::string r;
  for (const char c : text) {
    if (c == '|') r += '\\';
    r += c == '\n' ? ' ' : c;
  }
  return r;
}

std::string code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }
std::string link(const ClassInfo& info) { return fmt::format("[{}]({}.md)", info.name, info.name); }

std::string type_link(const Member& member) {
  if (member.kind != Kind::component || !Registry::instance().find(member.component_class)) return type_text(member);
  return fmt::format("{}[{}]({}.md)", member.list ? "list of " : "", member.component_class, member.component_class);
}

std::string member_row(const ClassInfo& info, const Member& member) {
  std::string range = range_text(member);
  if (member.soft) range += (range.empty() ? "" : "; ") + slider_text(member);
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", code(member.name), type_link(member) + meaning_text(member),
                     unit_text(member), member.required ? "must be given" : cell(code(default_text(info, member))), cell(range),
                     cell(sentence(member.text) + with_blank(condition_text(info, member))), name(member.effect));
}

/// A table for each group of members, in the order of their first members; members without a group come first.
std::string members_tables(const ClassInfo& info) {
  std::vector<std::string> groups;
  if (std::ranges::any_of(info.members, [](const Member& m) { return m.group.empty(); })) groups.emplace_back();
  for (const Member& member : info.members)
    if (std::ranges::find(groups, member.group) == groups.end()) groups.push_back(member.group);
  std::string text;
  for (const std::string& group : groups) {
    if (!text.empty()) text += "\n";
    if (!group.empty()) text += "### " + group + "\n\n";
    text += "| member | type | unit | default | range | what it is | an edit forces |\n|---|---|---|---|---|---|---|\n";
    for (const Member& member : info.members)
      if (member.group == group) text += member_row(info, member);
  }
  return text;
}

std::string page_text(const ClassInfo& info, const std::string& more) {
  std::string text = "# " + info.name + "\n\n" + sentence(info.summary) + "\n";
  if (!more.empty()) text += "\n" + more + "\n";
  if (!info.source.empty()) text += "\nSource: " + sentence(info.source) + "\n";
  if (parent_of(info))
    text += fmt::format("\n{} is {} {}.\n", info.name, info.abstract() ? "a special" : "one kind of", link(*info.parent));
  if (info.abstract()) text += "\nIt is an interface: what is written is one of the classes below.\n";
  if (!info.provider.empty()) text += "\nFrom the plugin " + code(info.provider) + ".\n";
  if (!info.literal.empty()) {
    const ClassInfo* interface = parent_of(info) ? parent_of(info) : &info;
    text += fmt::format("\nA plain value where {} is expected is taken as {} with `{}` set to it.\n", link(*interface),
                        info.name, info.literal);
  }

  text += "\n## Members\n\n";
  if (info.members.empty()) {
    text += "None.\n";
  } else {
    text += members_tables(info);
  }
  const auto made = makeable(info);
  if (std::ranges::any_of(made, [&](const ClassInfo* c) { return c != &info; })) {
    text += "\n## Classes\n\n";
    for (const ClassInfo* other : made)
      if (other != &info) text += fmt::format("- {}: {}\n", link(*other), sentence(other->summary));
  }
  return text;
}

}  // namespace

std::string class_text(const ClassInfo& info) {
  std::string text = info.name;
  for (const ClassInfo* p = parent_of(info); p; p = parent_of(*p)) text += " < " + p->name;
  text += "\n  " + wrapped(sentence(info.summary), 2) + "\n";
  if (!info.source.empty()) text += "  Source: " + wrapped(sentence(info.source), 2) + "\n";
  if (!info.provider.empty()) text += "  From the plugin " + info.provider + ".\n";
  if (info.abstract()) text += "  An interface: what is written is one of its classes.\n";
  if (!info.literal.empty()) text += "  A plain value in its place sets " + info.literal + ".\n";

  text += info.members.empty() ? "\nIt has no members.\n" : "\nMembers\n";
  size_t column = 0;
  for (const Member& member : info.members) column = std::max(column, width_of(member.name) + 4);
  for (const Member& member : info.members) {
    std::string facts = type_text(member) + meaning_text(member);
    if (!unit_text(member).empty()) facts += " [" + member.unit + "]";
    if (!range_text(member).empty()) facts += ", " + range_text(member);
    if (member.soft) facts += ", " + slider_text(member);
    if (const std::string text_of_default = default_text(info, member); !text_of_default.empty())
      facts += (member.required ? "; " : "; default ") + text_of_default;
    text += padded("  " + member.name, column) + wrapped(facts, column) + "\n";
    text += std::string(column, ' ') + wrapped(sentence(member.text) + with_blank(condition_text(info, member)), column) + "\n";
  }

  const auto below = makeable(info);
  size_t widest = 0;
  for (const ClassInfo* other : below)
    if (other != &info) widest = std::max(widest, width_of(other->name) + 4);
  if (widest > 0) text += "\nClasses\n";
  for (const ClassInfo* other : below)
    if (other != &info) text += padded("  " + other->name, widest) + wrapped(sentence(other->summary), widest) + "\n";
  return text;
}

std::string class_tree_text() {
  size_t column = 0;
  const auto all = described_classes();
  for (const ClassInfo* info : all) {
    size_t depth = 0;
    for (const ClassInfo* p = parent_of(*info); p; p = parent_of(*p)) ++depth;
    column = std::max(column, 2 * depth + width_of(info->name));
  }
  std::string text;
  for (const ClassInfo* info : all)
    if (!parent_of(*info)) add_tree(*info, 0, column, text);
  return text;
}

std::vector<ManualPage> manual_pages(const std::function<std::string(const ClassInfo&)>& more) {
  std::vector<const ClassInfo*> interfaces;
  for (const ClassInfo* info : described_classes())
    if (is_interface(*info)) interfaces.push_back(info);

  std::string index = "# Components\n\nEverything that can be written in a render description, by interface.\n";
  for (const ClassInfo* info : interfaces) {
    index += fmt::format("\n## {}\n\n{}\n\n", link(*info), sentence(info->summary));
    for (const ClassInfo* child : children(*info)) index += fmt::format("- {}: {}\n", link(*child), sentence(child->summary));
  }

  std::vector<ManualPage> pages{{"index.md", "Components", index}};
  for (const ClassInfo* info : interfaces) {
    pages.push_back({info->name + ".md", info->name, page_text(*info, more ? more(*info) : "")});
    for (const ClassInfo* child : children(*info))
      if (!is_interface(*child))
        pages.push_back({child->name + ".md", child->name, page_text(*child, more ? more(*child) : "")});
  }
  return pages;
}

}  // namespace etendue
