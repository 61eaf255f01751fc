#pragma once
// Class documentation for users and programs: JSON, JSON Schema, plain text, manual pages. All of it is generated from the
// registry, that is from the descriptions of the classes.

#include <functional>
#include <string>
#include <vector>

#include "etendue/describe/registry.h"

namespace etendue {

/// A JSON Schema (draft 2020-12) of all registered classes, including plugins. A component is an object whose "class" is the
/// name of its class; its members follow by name. `$defs` has one definition for each concrete class, and "<Interface>.any" for
/// the values that are allowed where an interface is expected. Numbers are in the unit "x-unit". User interface panels also use
/// "x-group", "x-slider" (its ends), "x-logarithmic", "x-meaning", "x-when" (conditions, all of which must hold for the member
/// to have an effect: {"member": …, "is": […]}, or "is_not", or "given") and "x-effect".
std::string json_schema();

/// A class as a JSON object: name, parent, summary, source, provider, members (type, unit, default, range, slider, choices,
/// meaning, group, conditions, text, effect of an edit) and its concrete subclasses.
std::string class_json(const ClassInfo&);
/// All classes, by name, as a JSON array of such objects.
std::string classes_json();

/// A class as text for a terminal: summary, members, and concrete subclasses.
std::string class_text(const ClassInfo&);
/// The tree of all classes as text for a terminal, with summaries.
std::string class_tree_text();

/// A page of the manual, in Markdown.
struct ManualPage {
  std::string file;   ///< "PathTracer.md"
  std::string title;  ///< "PathTracer"
  std::string text;   ///< including the heading; links refer to the files of other pages
};
/// The index, then a page for each class: interfaces first, each followed by its subclasses. `more` may return Markdown to be
/// inserted below a class's summary, such as its image.
std::vector<ManualPage> manual_pages(const std::function<std::string(const ClassInfo&)>& more = {});

}  // namespace etendue
