// Rows of the table: dictionaries, XML documents that are searched with XPath 1.0, by pugixml.
//
// Each thread keeps the documents and the results of queries. A node of a shader is an index into the results: 0 is no node, -1
// no document.

#include <fmt/format.h>

#include <charconv>
#include <map>
#include <memory>
#include <pugixml.hpp>

#include "choose.h"
#include "parts.h"
#include "services.h"

namespace etendue::osl {

namespace {

/// Documents and results that a thread keeps; beyond that it begins anew, and nodes found before are no longer known.
constexpr std::size_t most_documents = 64, most_results = 1'000'000;

struct Result {
  pugi::xml_node node;
  int next = 0;  ///< the next one of the same query, or 0
};

class Dictionaries {
 public:
  Dictionaries() { clear(); }

  /// The first result of a query from the root of a document, given as text or as the name of a file that ends in .xml.
  int find(const Call& c, const String* document, const String* query) {
    const auto known = queries_.find({document, 0, query});
    if (known != queries_.end()) return known->second;
    if (documents_.size() >= most_documents || results_.size() >= most_results) clear();
    const pugi::xml_document* root = load(c, document);
    return root ? search(c, {document, 0, query}, *root) : -1;
  }

  /// The first result of a query from a node.
  int find(const Call& c, int node, const String* query) {
    const auto known = queries_.find({nullptr, node, query});
    if (known != queries_.end()) return known->second;
    const Result* from = result(node);
    return from ? search(c, {nullptr, node, query}, from->node) : 0;
  }

  const Result* result(int i) const { return i > 0 && std::size_t(i) < results_.size() ? &results_[std::size_t(i)] : nullptr; }

 private:
  struct Query {
    const String* document;
    int node;
    const String* text;
    auto operator<=>(const Query&) const = default;
  };

  void clear() {
    queries_.clear();
    documents_.clear();
    results_.assign(1, {});
  }

  /// Null if it is no document, which is reported the first time.
  const pugi::xml_document* load(const Call& c, const String* document) {
    const auto [at, added] = documents_.try_emplace(document);
    if (!added) return at->second.get();
    auto loaded = std::make_unique<pugi::xml_document>();
    try {
      const bool file = document->view().ends_with(".xml");
      const std::string text = file ? c.services.dictionary(document) : document->text();
      const pugi::xml_parse_result parsed = loaded->load_buffer(text.data(), text.size());
      if (!parsed) throw Error(fmt::format("at byte {}: {}", parsed.offset, parsed.description()));
    } catch (const Error& e) {
      c.services.error(fmt::format("The dictionary \"{}\" cannot be read: {}", document->view().substr(0, 80), e.what()),
                       c.types.place);
      return nullptr;
    }
    at->second = std::move(loaded);
    return at->second.get();
  }

  int search(const Call& c, const Query& query, const pugi::xml_node& from) {
    int first = 0;
    try {
      pugi::xpath_node_set found = from.select_nodes(query.text->text().c_str());
      found.sort();
      for (const pugi::xpath_node& match : found) {
        const pugi::xml_node node = match.node() ? match.node() : match.parent();  // an attribute's element
        if (results_.size() >= most_results) break;
        if (first)
          results_.back().next = int(results_.size());
        else
          first = int(results_.size());
        results_.push_back({node, 0});
      }
    } catch (const pugi::xpath_exception& e) {
      c.services.error(fmt::format("Invalid dict_find query \"{}\": {}", query.text->text(), e.what()), c.types.place);
    }
    queries_[query] = first;
    return first;
  }

  std::map<const String*, std::unique_ptr<pugi::xml_document>> documents_;
  std::map<Query, int> queries_;
  std::vector<Result> results_;
};

Dictionaries& dictionaries() {
  thread_local Dictionaries all;
  return all;
}

void find_in_document(const Call& c) { c.give(dictionaries().find(c, c.string(0), c.string(1))); }
void find_from_node(const Call& c) { c.give(dictionaries().find(c, c.at<int>(0), c.string(1))); }

void next(const Call& c) {
  const Result* r = dictionaries().result(c.at<int>(0));
  c.give(r ? r->next : 0);
}

/// Reads exactly `count` numbers that blanks and commas separate, or fails.
template <class T>
bool read_numbers(std::string_view text, std::vector<T>& numbers, std::size_t count) {
  constexpr std::string_view separators = " \t\r\n,";
  while (numbers.size() < count) {
    text.remove_prefix(std::min(text.find_first_not_of(separators), text.size()));
    T value{};
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault != std::errc()) return false;
    numbers.push_back(value);
    text.remove_prefix(std::size_t(end - text.data()));
  }
  return text.find_first_not_of(separators) == std::string_view::npos;
}

/// Stores a node's text as a value of the type. False if it is none.
bool store(const char* text, const Type& type, bool derivatives, void* to) {
  if (type.is_string()) {
    if (interned_bytes() > interned_limit) return false;
    *static_cast<const String**>(to) = intern_string(text);
    return true;
  }
  if (type.base == Base::int_) {
    std::vector<int> numbers;
    if (!read_numbers(text, numbers, std::size_t(type.elements()))) return false;
    std::copy(numbers.begin(), numbers.end(), static_cast<int*>(to));
    return true;
  }
  if (!type.float_based()) return false;
  const std::size_t count = std::size_t(type.elements() * type.floats());
  std::vector<float> numbers;
  if (!read_numbers(text, numbers, count)) return false;
  std::copy(numbers.begin(), numbers.end(), static_cast<float*>(to));
  if (derivatives) std::fill_n(static_cast<float*>(to) + count, 2 * count, 0.0f);
  return true;
}

/// int dict_value(int node, string attribute, output value); the attribute "" is the node's own text.
void value(const Call& c) {
  const Result* r = dictionaries().result(c.at<int>(0));
  if (!r) return c.give(0);
  const std::string& name = c.string(1)->text();
  const pugi::xml_attribute attribute = r->node.attribute(name.c_str());
  const char* text = nullptr;
  if (name.empty())
    text = *r->node.value() ? r->node.value() : r->node.child_value();
  else if (attribute)
    text = attribute.value();
  c.give(int(text && store(text, c.type(2), c.derivatives(2), c.arguments[2])));
}

constexpr Derivatives none = Derivatives::none;

constexpr Row rows[] = {
    {"int dict_find(string dictionary, string query)", always<find_in_document>, none, 0, nullptr, false},
    {"int dict_find(int node, string query)", always<find_from_node>, none, 0, nullptr, false},
    {"int dict_next(int node)", always<next>, none, 0, nullptr, false},
    {"int dict_value(int node, string attribute, output ANY value)", always<value>, none, 0, nullptr, false},
};

}  // namespace

std::span<const Row> dictionary_rows() { return rows; }

}  // namespace etendue::osl
