#include "etendue/paths/path_automaton.h"

#include <fmt/format.h>

#include <bit>
#include <map>

#include "etendue/core/error.h"

namespace etendue {
namespace {

constexpr size_t most_positions = 1024, most_states = 1024, most_letters = 1024;
/// Of words of 64 positions that the construction may look at: some tenths of a second.
constexpr std::uint64_t most_work = 400'000'000;

[[noreturn]] void too_many(const char* what, size_t most) {
  throw Error(
      fmt::format("the light path expressions together need more than {} {}: fewer or simpler ones are needed, with "
                  "smaller numbers in {{ }}",
                  most, what));
}

/// A set of positions.
using Set = std::vector<std::uint64_t>;

void add(Set& set, size_t i) { set[i / 64] |= std::uint64_t(1) << (i % 64); }
template <class F>
void each(const Set& set, const F& f) {
  for (size_t word = 0; word < set.size(); ++word)
    for (std::uint64_t bits = set[word]; bits; bits &= bits - 1) f(word * 64 + size_t(std::countr_zero(bits)));
}

/// The automaton of Glushkov for all expressions. Each has a position before its first event as well.
class Positions {
 public:
  struct Position {
    const PathExpression::Test* test = nullptr;  ///< null: before the first event
    size_t expression = 0;
    std::vector<size_t> follow;
  };

  void add_expression(const PathExpression& e, size_t index) {
    expression_ = index;
    const size_t start = make(nullptr);
    starts.push_back(start);
    const Part whole = build(e, e.root());
    connect({start}, whole.first);
    for (const size_t p : whole.last) finals.push_back(p);
  }

  std::vector<Position> all;
  std::vector<size_t> starts, finals;  // a path has an event, so that a start is not final

 private:
  struct Part {
    bool empty = true;  ///< whether it matches no events
    std::vector<size_t> first, last;
  };

  size_t make(const PathExpression::Test* test) {
    if (all.size() >= most_positions) too_many("events", most_positions);
    all.push_back({test, expression_, {}});
    return all.size() - 1;
  }
  void connect(const std::vector<size_t>& from, const std::vector<size_t>& to) {
    work_ += from.size() * to.size();
    if (work_ > most_work / 8) too_many("steps", most_work);
    for (const size_t p : from) all[p].follow.insert(all[p].follow.end(), to.begin(), to.end());
  }
  /// Appends b to a.
  void append(Part& a, const Part& b) {
    connect(a.last, b.first);
    if (a.empty) a.first.insert(a.first.end(), b.first.begin(), b.first.end());
    if (!b.empty) a.last.clear();
    a.last.insert(a.last.end(), b.last.begin(), b.last.end());
    a.empty = a.empty && b.empty;
  }
  Part build(const PathExpression& e, int index) {
    if (++built_ > 16 * most_positions) too_many("events", most_positions);
    const PathExpression::Node& node = e.nodes()[size_t(index)];
    Part all_parts;
    switch (node.kind) {
      case PathExpression::Node::Kind::event: {
        const size_t p = make(&e.tests()[size_t(node.test)]);
        return {false, {p}, {p}};
      }
      case PathExpression::Node::Kind::sequence:
        for (const int part : node.parts) append(all_parts, build(e, part));
        return all_parts;
      case PathExpression::Node::Kind::choice:
        all_parts.empty = false;
        for (const int part : node.parts) {
          const Part one = build(e, part);
          all_parts.empty = all_parts.empty || one.empty;
          all_parts.first.insert(all_parts.first.end(), one.first.begin(), one.first.end());
          all_parts.last.insert(all_parts.last.end(), one.last.begin(), one.last.end());
        }
        return all_parts;
      case PathExpression::Node::Kind::repeated:
        for (int i = 0; i < node.least; ++i) append(all_parts, build(e, node.parts[0]));
        for (int i = node.least; i < node.most; ++i) {
          Part one = build(e, node.parts[0]);
          one.empty = true;
          append(all_parts, one);
        }
        if (node.most < 0) {
          Part one = build(e, node.parts[0]);
          connect(one.last, one.first);
          one.empty = true;
          append(all_parts, one);
        }
        return all_parts;
    }
    return all_parts;
  }

  size_t expression_ = 0, built_ = 0;
  std::uint64_t work_ = 0;
};

/// The subset construction: numbers of sets.
class States {
 public:
  std::uint16_t number(Set set) {
    const auto [at, added] = numbers_.emplace(std::move(set), std::uint16_t(sets.size()));
    if (added) {
      if (sets.size() >= most_states) too_many("states", most_states);
      sets.push_back(&at->first);
    }
    return at->second;
  }
  std::vector<const Set*> sets;

 private:
  std::map<Set, std::uint16_t> numbers_;
};

class Construction {
 public:
  Construction(std::span<const PathExpression> expressions, std::span<const PathLabels> classes) {
    for (size_t i = 0; i < expressions.size(); ++i) positions.add_expression(expressions[i], i);
    size = positions.all.size();
    words = (size + 63) / 64;
    follow.assign(size, empty());
    before.assign(size, empty());
    for (size_t p = 0; p < size; ++p)
      for (const size_t next : positions.all[p].follow) {
        add(follow[p], next);
        add(before[next], p);
      }
    find_letters(classes);
  }

  Set empty() const { return Set(words); }
  void spend(size_t steps) {
    work_ += steps;
    if (work_ > most_work) too_many("steps", most_work);
  }

  /// The positions that may follow those of a set.
  Set followed(const Set& set) {
    Set all = empty();
    each(set, [&](size_t p) {
      spend(words);
      for (size_t w = 0; w < words; ++w) all[w] |= follow[p][w];
    });
    return all;
  }
  Set both(const Set& a, const Set& b) {
    spend(words);
    Set all = a;
    for (size_t w = 0; w < words; ++w) all[w] &= b[w];
    return all;
  }
  /// The positions from which an event of this letter leads into a set.
  Set leading(const Set& into, size_t letter) {
    Set all = empty();
    each(both(into, matched[letter]), [&](size_t p) {
      spend(words);
      for (size_t w = 0; w < words; ++w) all[w] |= before[p][w];
    });
    return all;
  }
  std::uint32_t expressions_of(const Set& set) const {
    std::uint32_t found = 0;
    each(set, [&](size_t p) { found |= 1u << positions.all[p].expression; });
    return found;
  }

  Positions positions;
  size_t size = 0, words = 0;
  std::vector<Set> follow, before;
  std::vector<std::uint16_t> letter_of;
  std::vector<Set> matched;       ///< the positions that match each letter
  std::vector<PathEvents> kinds;  ///< the kinds of events of each letter; all of one are scatterings, or ends, or C

 private:
  /// Groups the kinds of events, with each class of labels, by the positions that match them.
  void find_letters(std::span<const PathLabels> classes) {
    std::map<std::pair<int, Set>, std::uint16_t> known;
    for (const PathLabels labels : classes)
      for (int kind = 0; kind < path_event_count; ++kind) {
        const auto event = PathEvent(kind);
        Set set = empty();
        spend(size);
        for (size_t p = 0; p < size; ++p)
          if (positions.all[p].test && positions.all[p].test->matches(event, labels)) add(set, p);
        const int place = event == PathEvent::camera ? 0 : (bit(event) & path_ends) ? 2 : 1;
        const auto [at, added] = known.emplace(std::pair(place, std::move(set)), std::uint16_t(matched.size()));
        if (added) {
          if (matched.size() >= most_letters) too_many("kinds of events", most_letters);
          matched.push_back(at->first.second);
          kinds.push_back(0);
        }
        letter_of.push_back(at->second);
        kinds[at->second] |= bit(event);
      }
  }

  std::uint64_t work_ = 0;
};

}  // namespace

PathAutomaton::PathAutomaton(std::span<const PathExpression> expressions, std::span<const PathLabels> classes) {
  if (expressions.empty()) return;
  Construction c(expressions, classes);
  letters_ = c.matched.size();
  letter_of_ = c.letter_of;
  Set finals = c.empty(), starts = c.empty();
  for (const size_t p : c.positions.finals) add(finals, p);
  for (const size_t p : c.positions.starts) add(starts, p);

  Matches possible = 0;
  States forward;
  const size_t camera = c.letter_of[size_t(PathEvent::camera)];
  forward.number(c.both(c.followed(starts), c.matched[camera]));
  for (size_t s = 0; s < forward.sets.size(); ++s) {
    const Set next = c.followed(*forward.sets[s]);
    for (size_t letter = 0; letter < letters_; ++letter) {
      const bool scatters = c.kinds[letter] & path_scatterings, ends = c.kinds[letter] & path_ends;
      const Set read = scatters || ends ? c.both(next, c.matched[letter]) : c.empty();
      ends_.push_back(ends ? c.expressions_of(c.both(read, finals)) : 0);
      possible |= ends_.back();
      forward_.push_back(scatters ? forward.number(read) : State(0));
    }
  }
  forward_states_ = forward.sets.size();
  for (size_t i = 0; i < expressions.size(); ++i)
    if (!(possible & (1u << i)))
      throw Error(fmt::format("'{}' matches no path: paths begin with C, and end with L, B or O", expressions[i].text()));

  States backward;
  for (size_t letter = 0; letter < letters_; ++letter)
    last_.push_back(c.kinds[letter] & path_ends ? backward.number(c.leading(finals, letter)) : State(0));
  for (size_t s = 0; s < backward.sets.size(); ++s)
    for (size_t letter = 0; letter < letters_; ++letter)
      backward_.push_back(c.kinds[letter] & path_scatterings ? backward.number(c.leading(*backward.sets[s], letter))
                                                             : State(0));
  backward_states_ = backward.sets.size();

  joined_.reserve(forward_states_ * backward_states_);
  for (const Set* first : forward.sets)
    for (const Set* rest : backward.sets) joined_.push_back(c.expressions_of(c.both(*first, *rest)));
}

}  // namespace etendue
