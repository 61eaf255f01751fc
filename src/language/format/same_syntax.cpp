#include "same_syntax.h"

#include <algorithm>

namespace etendue::language {

namespace {

bool same(const Label& a, const Label& b) { return a.text == b.text; }
bool same(const Node& a, const Node& b) { return same_syntax(a, b); }
bool same(const Numbers& a, const Numbers& b) { return a == b; }
bool same(const Parameter&, const Parameter&);
bool same(const Definition&, const Definition&);
bool same(const Inclusion&, const Inclusion&);

template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const T& x, const T& y) { return same(x, y); });
}

template <class T>
bool same(const std::unique_ptr<T>& a, const std::unique_ptr<T>& b) {
  return a && b ? same(*a, *b) : !a && !b;
}

bool same(const Parameter& a, const Parameter& b) { return same(a.name, b.name) && same(a.standard, b.standard); }

bool same(const Definition& a, const Definition& b) {
  return same(a.name, b.name) && a.parameter == b.parameter && a.function == b.function && same(a.parameters, b.parameters) &&
         same(a.value, b.value);
}

bool same(const Inclusion& a, const Inclusion& b) {
  return same(a.path, b.path) && same(a.name, b.name) && same(a.replaced, b.replaced);
}

}  // namespace

bool same_syntax(const Node& a, const Node& b) {
  return a.type == b.type && a.text == b.text && a.json == b.json && a.damaged == b.damaged && a.number == b.number &&
         same(a.numbers, b.numbers) && same(a.labels, b.labels) && same(a.children, b.children);
}

bool same_syntax(const Document& a, const Document& b) {
  return a.whole == b.whole && same(a.includes, b.includes) && same(a.plugins, b.plugins) &&
         same(a.definitions, b.definitions) && same(a.components, b.components);
}

}  // namespace etendue::language
