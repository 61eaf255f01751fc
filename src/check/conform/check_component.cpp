// Checks of every component: it can be saved, copied and created again, and rejects invalid input with an Error that gives the
// location.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "conformance.h"
#include "describe/guard.h"
#include "draw.h"
#include "etendue/language/language.h"

namespace etendue::conform {
namespace {

constexpr const char* text_name = "hostile";

/// The exception of a call: all errors of an Errors, flattened.
struct Thrown {
  std::vector<Error> errors;
  std::string other;  ///< text of an exception that is neither Error nor Errors

  std::string text() const {
    std::string all = other;
    for (const Error& e : errors) all += fmt::format("{}line {}: {}", all.empty() ? "" : "; ", e.location.line, e.what());
    return all.empty() ? "nothing was thrown" : all;
  }
  const Error* naming(const std::string& name) const {
    for (const Error& e : errors)
      if (std::string_view(e.what()).find(name) != std::string_view::npos) return &e;
    return nullptr;
  }
};

template <class F>
Thrown thrown_by(F&& f) {
  Thrown t;
  try {
    f();
  } catch (const Error& error) {
    t.errors.push_back(error);
  } catch (const Errors& errors) {
    t.errors = errors.errors;
  } catch (...) {  // a component may throw anything
    t.other = thrown_text();
  }
  return t;
}

// ---- saving and copying ---------------------------------------------------------------------------------------------

void check_saving(Trial& trial) {
  const Component& part = trial.part();
  std::string after;
  Thrown t = thrown_by([&] { after = write_description(part); });
  trial.expect(t.errors.empty() && t.other.empty(), "can be saved", [&] { return t.text(); });
  trial.expect(after == trial.text(), "preparing leaves the members as they were written",
               [&] { return "after prepare(): " + after; });

  const Value original{Ref<Component>(&trial.part())};
  for (const bool all : {false, true}) {
    std::string once, twice;
    Ref<Component> read;
    t = thrown_by([&] {
      once = write_description(part, all);
      read = parse_component(once, "saved");
      twice = write_description(*read, all);
    });
    const bool same = read && equal(Value(read), original) && once == twice;
    trial.expect(same, "what is saved reads back as an equal part",
                 [&] { return !read ? t.text() : "written: " + once + "read and written again: " + twice; });
  }
  // The same after preparation, which precedes every use.
  std::string prepared;
  t = thrown_by([&] {
    const Ref<Component> read = parse_component(trial.text(), "saved");
    prepare_tree(*read);
    prepared = write_description(*read);
  });
  trial.expect(prepared == trial.text(), "what was read and prepared is saved as it was",
               [&] { return prepared.empty() ? t.text() : "saved: " + prepared; });
}

void check_copying(Trial& trial) {
  Ref<Component> copied;
  std::string text;
  const Thrown t = thrown_by([&] {
    copied = copy(trial.part());
    prepare_tree(*copied);
    text = write_description(*copied);
  });
  const bool same = copied && equal(Value(copied), Value(Ref<Component>(&trial.part()))) && text == trial.text();
  trial.expect(same && copied.get() != &trial.part(), "a copy is equal",
               [&] { return text.empty() ? t.text() : "the copy: " + text; });
}

// ---- what must be refused -------------------------------------------------------------------------------------------

struct Hostile {
  Value value;
  std::string text;  ///< as an expression; "" if there is none for this value
  std::string what;
};

std::vector<Hostile> hostile_numbers(const Member& m) {
  std::vector<Hostile> list;
  const bool row = m.kind == Kind::vector2 || m.kind == Kind::vector3 || m.kind == Kind::point3 || m.kind == Kind::normal3;
  const size_t entries = row ? (m.kind == Kind::vector2 ? 2 : 3) : 1;
  const auto add = [&](double x, const std::string& what, bool written) {
    const bool packed = row || m.list;
    const Value value = packed
                            ? Value(Numbers{std::vector<double>(entries, x), m.list && row ? int(entries) : 1, Dimension::none})
                            : Value(Number{x, Dimension::none});
    std::string text;
    if (written && !packed) text = fmt::format("{:.17g}", x);
    list.push_back({value, text, what});
  };
  add(std::nan(""), "not-a-number", false);
  add(std::numeric_limits<double>::infinity(), "infinity", false);
  add(-std::numeric_limits<double>::infinity(), "-infinity", false);
  if (m.kind != Kind::integer) add(1e300, "more than a float holds", true);
  if (m.kind == Kind::integer) add(0.5, "a fraction", true);
  if (m.range) {
    const Range& r = *m.range;
    if (std::isfinite(r.low)) add(r.low - std::max(1.0, std::abs(r.low)), "below the range", true);
    if (std::isfinite(r.high)) add(r.high + std::max(1.0, std::abs(r.high)), "above the range", true);
    if (r.open_low) add(r.low, "the open end of the range", true);
  }
  return list;
}

std::vector<Hostile> hostile_values(const Member& m) {
  std::vector<Hostile> list;
  // A boolean accepts nothing else, and no other kind accepts a boolean.
  if (m.kind == Kind::boolean)
    list.push_back({Value(Number{3}), "3", "a number"});
  else
    list.push_back({Value(true), "true", "a truth value"});
  switch (m.kind) {
    case Kind::integer:
    case Kind::number:
    case Kind::vector2:
    case Kind::vector3:
    case Kind::point3:
    case Kind::normal3:
      for (Hostile& h : hostile_numbers(m)) list.push_back(std::move(h));
      list.push_back({Value(std::string("seven")), "\"seven\"", "a string"});
      break;
    case Kind::choice: list.push_back({Value(std::string("no_such_choice")), "\"no_such_choice\"", "an unknown choice"}); break;
    case Kind::color:
      for (Hostile& h : hostile_numbers(m)) list.push_back(std::move(h));
      list.push_back({Value(std::string("no such colour")), "\"no such colour\"", "a string"});
      break;
    case Kind::transform: list.push_back({Value(Number{1}), "1", "a number"}); break;
    case Kind::string:
    case Kind::file: list.push_back({Value(Number{1}), "1", "a number"}); break;
    default: break;
  }
  return list;
}

void check_refusals(Trial& trial) {
  const ClassInfo& info = trial.part().class_info();
  const std::string refused = "wrong values are refused by an Error that names class and member",
                    placed = "errors in a text say their place";
  for (const Member& m : info.members) {
    const std::string name = info.name + "." + m.name;
    for (const Hostile& h : hostile_values(m)) {
      const Thrown t = thrown_by([&] { set(*create(info), m.name, h.value); });
      trial.expect(t.naming(name), refused, [&] { return fmt::format("{} set to {}: {}", name, h.what, t.text()); });
      if (h.text.empty()) continue;
      const std::string text = fmt::format("{} {{\n  {}: {}\n}}\n", info.name, m.name, m.list ? "[" + h.text + "]" : h.text);
      const Thrown read = thrown_by([&] { prepare_tree(*parse_component(text, text_name)); });
      const Error* error = read.naming(name);
      trial.expect(error && error->location.line == 2 && error->location.file == std::string_view(text_name), placed,
                   [&] { return fmt::format("{}: {} in line 2: {}", name, h.what, read.text()); });
    }
  }

  const std::string unknown = "an unknown member is refused by an Error that names class and member";
  const Thrown t = thrown_by([&] { set(*create(info), "no_such_member", Value(Number{1})); });
  trial.expect(t.naming(info.name) && t.naming("no_such_member"), unknown, [&] { return t.text(); });
  const Thrown read = thrown_by([&] { parse_component(info.name + " {\n  no_such_member: 1\n}\n", text_name); });
  const Error* error = read.naming("no_such_member");
  trial.expect(error && error->location.line == 2, placed, [&] { return "an unknown member in line 2: " + read.text(); });
}

/// Checks input files: sample files can be read, and missing files are rejected. An Output's file is written, so it is not
/// checked here.
void check_files(Trial& trial) {
  const ClassInfo& info = trial.part().class_info();
  if (info.is_a(*Registry::instance().find("Output"))) return;
  for (const Member& m : info.members)
    if (m.kind == Kind::file && trial.fixtures().file_for(info, m).empty())
      trial.not_tried("reads a sample file as " + m.name, "no sample file is known that would fit: " + m.text);
  const bool any = std::any_of(info.members.begin(), info.members.end(), [](const Member& m) { return m.kind == Kind::file; });
  const Drawn with_files = any ? part_with_files(info, trial.fixtures(), trial.random) : Drawn{};
  if (any && !with_files.part) trial.not_tried("reads sample files", "they were refused: " + with_files.refused);
  for (const Member& m : info.members) {
    if (m.kind != Kind::file || m.list) continue;
    // The component with only this file changed: in a text of two lines or, if other members are required too, set on a copy.
    const std::string name = info.name + "." + m.name, missing = trial.fixtures().folder() + "/no_such_file.xyz";
    bool alone = true;
    for (const Member& other : info.members) alone = alone && (!other.required || &other == &m);
    const Thrown t = thrown_by([&] {
      Ref<Component> part;
      if (alone) {
        part = parse_component(fmt::format("{} {{\n  {}: \"{}\"\n}}\n", info.name, m.name, missing), text_name);
      } else {
        part = copy(trial.part());
        set(*part, m.name, Value(FilePath{missing, ""}));
      }
      prepare_tree(*part);
    });
    const Error* error = t.naming(name);
    trial.expect(error && t.naming("no_such_file.xyz"),
                 "a missing file is refused by an Error that names class, member and file", [&] { return t.text(); });
    trial.expect(error && (!alone || error->location.line == 2), "errors in a text say their place",
                 [&] { return fmt::format("{}: a missing file in line 2: {}", name, t.text()); });
  }
}

void check_component(Trial& trial) {
  check_saving(trial);
  check_copying(trial);
  if (!trial.by_default()) return;
  check_refusals(trial);
  check_files(trial);
}

const RegisterCheck<Component> registered(check_component);

}  // namespace
}  // namespace etendue::conform
