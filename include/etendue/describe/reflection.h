#pragma once
// What is known of classes, told to people and programs: JSON, JSON Schema, plain text, manual pages. All of it is
// derived from the registry; nothing is said here that a description does not say.

#include <functional>
#include <string>
#include <vector>

#include "etendue/describe/registry.h"

namespace etendue {

/// A JSON Schema (draft 2020-12) of every class known, plugins included. A component is an object whose "class" names
/// its class; its members follow by name. `$defs` holds one definition for each class that can be made, and
/// "<Interface>.any" for what may stand where an interface is expected. Numbers are in the unit of "x-unit". What a panel needs
/// besides are "x-group", "x-slider" (its ends), "x-logarithmic", "x-meaning", "x-when" (conditions, all of which must hold for
/// the member to matter: {"member": …, "is": […]}, or "is_not", or "given") and "x-effect".
std::string json_schema();

/// A class as a JSON object: name, parent, summary, source, provider, members (type, unit, default, range, slider, choices,
/// meaning, group, when it matters, text, what an edit forces) and the classes that can be made of it.
std::string class_json(const ClassInfo&);
/// All classes, by name, as a JSON array of such objects.
std::string classes_json();

/// A class for a terminal: what it is, its members, and what can be made of it.
std::string class_text(const ClassInfo&);
/// All classes for a terminal, each below its parent, with summaries.
std::string class_tree_text();

/// A page of the manual, in Markdown.
struct ManualPage {
  std::string file;   ///< "PathTracer.md"
  std::string title;  ///< "PathTracer"
  std::string text;   ///< with its heading; links go to other pages' files
};
/// The index, then a page for each class: interfaces first, each followed by the classes made of it.
/// `more` may give Markdown to stand below what a class is: its picture.
std::vector<ManualPage> manual_pages(const std::function<std::string(const ClassInfo&)>& more = {});

}  // namespace etendue
